//! How much of what an arc offers falls on the metal.

use super::super::flux::Flux;
use super::super::skin::Skin;
use super::offered::Ground;
use super::stands::Stand;
use super::{Arc, Spot};
use crate::rest::Plane;
use crate::stage::StageError;
use crate::state::State;

/// Steps between two looks.
pub(super) const EVERY: u64 = 64;
/// Part of its heat that an arc may give too little or too much, untold.
const APART: f64 = 0.01;
/// Part of its heat on the ground that is computed, below which it is told.
const LITTLE: f64 = 0.5;

/// What an arc has offered and put in, summed over the looks \[W\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Reached {
    /// By its tables and formulas, wherever it falls.
    pub(super) whole: f64,
    /// Of that on the ground that is computed.
    pub(super) offered: f64,
    /// Of that on the metal.
    pub(super) put: f64,
    /// On the metal, by all of its fluxes.
    pub(super) taken: f64,
    /// The same with the means of the fluxes over the particles, in place of their values in the middle.
    pub(super) even: f64,
    /// Number of looks at which it burned.
    pub(super) looks: f64,
}

impl Reached {
    /// What a reader of the run must be told of arc `number`.
    pub(super) fn warning(&self, number: usize) -> Option<String> {
        if self.offered < LITTLE * self.whole {
            return Some(self.aside(number));
        }
        let part = self.put / self.offered;
        if self.offered <= 0.0 || (part - 1.0).abs() <= APART {
            return self.unresolved(number);
        }
        let what = match part {
            _ if self.is_narrow() => "it is too narrow for this spacing",
            part if part < 1.0 => "the rest falls beside it, or is narrower than the particles",
            _ => {
                "its surface is steep and takes the heat by its area, or parts of it lie one above the other"
            }
        };
        let [put, offered] = [self.put, self.offered].map(|sum| sum / self.looks);
        Some(format!(
            "arc {number}: of {offered:.4e} W of its tables and formulas {put:.4e} W, {:.1} %, fall on the metal, in the mean: {what}",
            100.0 * part
        ))
    }

    /// What is told of heat that falls where the plate goes on and is not computed.
    pub(super) fn note(&self, number: usize) -> Option<String> {
        let beyond = self.whole - self.offered;
        let told = self.offered >= LITTLE * self.whole && beyond > APART * self.whole;
        told.then(|| self.aside(number))
    }

    fn aside(&self, number: usize) -> String {
        let [beyond, whole] = [self.whole - self.offered, self.whole].map(|sum| sum / self.looks);
        format!(
            "arc {number}: of {whole:.4e} W of its tables and formulas {beyond:.4e} W fall beyond the open faces in the mean, where \
             the plate goes on and is not computed"
        )
    }

    fn is_narrow(&self) -> bool {
        self.even > 0.0 && (self.taken / self.even - 1.0).abs() > APART
    }

    /// What is told where values in the middles of particles are not the means over them.
    fn unresolved(&self, number: usize) -> Option<String> {
        self.is_narrow().then(|| {
            let [taken, even] = [self.taken, self.even].map(|sum| sum / self.looks);
            format!(
                "arc {number}: in the middles of the particles its fluxes give {taken:.4e} W, and {even:.4e} W as means over them, \
                 where {:.0} % apart may be: they are too narrow for this spacing",
                100.0 * APART
            )
        })
    }

    pub(super) fn save(self) -> [f64; 6] {
        [
            self.whole,
            self.offered,
            self.put,
            self.taken,
            self.even,
            self.looks,
        ]
    }

    pub(super) fn restored([whole, offered, put, taken, even, looks]: [f64; 6]) -> Self {
        Self {
            whole,
            offered,
            put,
            taken,
            even,
            looks,
        }
    }
}

/// How far below its first row a table may be asked \[K\]: as far as a start temperature is rounded.
const BELOW: f64 = 1.0;

impl Arc {
    /// What to tell where metal was colder than the gas film is known for.
    pub(super) fn cold(&self) -> Option<String> {
        let fluxes = self.arcs.iter().flat_map(|arc| &arc.fluxes);
        let lowest = fluxes.map(Flux::lowest).fold(0.0, f64::max);
        (self.coldest < lowest - BELOW).then(|| {
            format!(
                "the conductivity of the gas is known from {lowest} K on, and metal of {:.0} K was heated: its first row was held",
                self.coldest
            )
        })
    }

    /// The same with faces beyond which the plate goes on.
    #[must_use]
    pub fn within(mut self, open: &[Plane]) -> Self {
        self.ground = Ground::within(open);
        self
    }

    /// What to tell of arcs that burn.
    pub(super) fn beside(&self, tell: impl Fn(&Reached, usize) -> Option<String>) -> Vec<String> {
        let arcs = self.arcs.iter().enumerate();
        let told = arcs.filter_map(|(number, arc)| tell(&arc.reached, number));
        told.collect()
    }

    /// Compares what each arc offers in a step from the first of `times` over the second \[s\] with what of it falls on the metal.
    pub(super) fn compare(
        &mut self,
        skin: &Skin<'_>,
        state: &State,
        times: [f64; 2],
    ) -> Result<(), StageError> {
        let mut found = vec![[0.0; 3]; self.arcs.len()];
        for &a in &state.exposed {
            if let Some(spot) = self.lit(skin, a as usize, self.metal.spacing) {
                let kelvin = skin.temperature[a as usize];
                self.falls(spot, kelvin, times, &mut found)?;
            }
        }
        let spacing = self.metal.spacing;
        for stand in self.stands.iter().filter(|stand| stand.level > 0.0) {
            let arc = &mut self.arcs[stand.arc];
            let (axis, upon) = (
                [stand.axis[0], stand.axis[1]],
                state.faces.mirrors_upon(stand.axis, spacing),
            );
            let here = [Ground::WHOLE, self.ground].map(|ground| ground.before(axis, upon));
            let takes = |flux: &Flux| {
                let on = |ground: Ground| ground.takes(flux, axis, spacing, times);
                Some([on(here[0])?, on(here[1])?])
            };
            for [whole, offered] in arc.fluxes.iter().filter_map(takes) {
                arc.reached.whole += stand.level * whole;
                arc.reached.offered += stand.level * offered;
            }
        }
        for (arc, [put, taken, even]) in self.arcs.iter_mut().zip(found) {
            arc.reached.put += put;
            arc.reached.taken += taken;
            arc.reached.even += even;
            let burns = |stand: &Stand| stand.level > 0.0;
            arc.reached.looks += f64::from(u8::from(self.stands.iter().any(burns)));
        }
        Ok(())
    }

    /// Adds what of each arc falls on a spot of `kelvin` \[K\]: of its tables and formulas, of all fluxes, and of their means over it \[W\].
    fn falls(
        &self,
        spot: Spot,
        kelvin: f64,
        times: [f64; 2],
        found: &mut [[f64; 3]],
    ) -> Result<(), StageError> {
        let spacing = self.metal.spacing;
        for stand in &self.stands {
            let (from, power) = (
                [0, 1].map(|k| spot.at[k] - stand.axis[k]),
                stand.level * spot.area,
            );
            for flux in &self.arcs[stand.arc].fluxes {
                let taken = flux.over(from, spacing, kelvin, times)?.0.abs();
                // The mean of a formula is taken already.
                let even = if flux.is_formula() {
                    taken
                } else {
                    flux.even(from, spacing, kelvin, times)?.0.abs()
                };
                let sums = &mut found[stand.arc];
                if flux.is_formula() || flux.table().is_some() {
                    sums[0] += power * taken;
                }
                (sums[1], sums[2]) = (sums[1] + power * taken, sums[2] + power * even);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reached(put: f64) -> Reached {
        Reached {
            whole: 200.0,
            offered: 200.0,
            put,
            taken: put,
            even: put,
            looks: 2.0,
        }
    }

    #[test]
    fn an_arc_that_misses_the_metal_by_a_hundredth_is_told_with_both_figures() {
        for put in [198.1, 200.0, 201.9] {
            assert_eq!(reached(put).warning(0), None, "{put}");
        }
        let told = reached(197.0).warning(1).unwrap();
        assert!(
            told.starts_with("arc 1: of 1.0000e2 W") && told.contains("9.8500e1 W, 98.5 %"),
            "{told}"
        );
        assert!(reached(203.0).warning(0).unwrap().contains("101.5 %"));
        assert!(reached(0.0).warning(0).unwrap().contains("0.0 %"));
        assert_eq!(Reached::default().warning(0), None);
        let narrow = Reached {
            even: 195.0,
            ..reached(198.5)
        };
        let told = narrow.warning(0).unwrap();
        assert!(told.contains("9.9250e1 W, and 9.7500e1 W"), "{told}");
    }

    #[test]
    fn heat_beyond_open_faces_is_noted_and_most_of_it_is_a_warning() {
        let beyond = |offered| Reached {
            offered,
            ..reached(offered)
        };
        assert_eq!(beyond(199.0).note(0), None);
        let told = beyond(160.0).note(0).unwrap();
        assert!(
            told.contains("of 1.0000e2 W") && told.contains("2.0000e1 W fall"),
            "{told}"
        );
        assert_eq!(beyond(160.0).warning(0), None);
        assert!(beyond(90.0).note(0).is_none() && beyond(90.0).warning(0).is_some());
    }
}
