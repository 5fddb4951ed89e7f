//! How much of what the tables of an arc hold falls on the metal.

use super::super::flux::Flux;
use super::super::skin::Skin;
use super::Arc;
use crate::stage::StageError;
use crate::state::State;

/// Steps between two looks.
pub(super) const EVERY: u64 = 64;
/// Part of its heat below which an arc is told to miss the metal, and above which to give more than it holds.
const LITTLE: f64 = 0.5;
const MUCH: f64 = 1.5;
/// Part by which values in the middles of particles may differ from the means over them.
const APART: f64 = 0.02;

/// What an arc has offered and put in, summed over the looks \[W\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Reached {
    pub(super) offered: f64,
    pub(super) put: f64,
    /// The same with the means of the tables over the particles, in place of their values in the middle.
    pub(super) even: f64,
}

impl Reached {
    /// What a reader of the run must be told of arc `number`.
    pub(super) fn warning(&self, number: usize) -> Option<String> {
        let part = self.put / self.offered;
        let percent = 100.0 * part;
        let what = match part {
            _ if self.offered <= 0.0 => return None,
            part if part < LITTLE => "the rest falls beside it, or is narrower than the particles",
            part if part > MUCH => {
                "the tables are narrower than the particles, or the surface is steep"
            }
            _ => return self.unresolved(number),
        };
        Some(format!(
            "arc {number}: {percent:.1} % of the heat that its tables hold falls on the metal: {what}"
        ))
    }
}

impl Reached {
    /// What is told where values in the middles of particles are not the means over them.
    fn unresolved(&self, number: usize) -> Option<String> {
        let part = self.put / self.even;
        ((part - 1.0).abs() > APART).then(|| {
            format!(
                "arc {number}: in the middles of the particles the tables give {:.1} % of what they hold over them, where {:.0} % \
                 apart may be: they are too narrow for this spacing",
                100.0 * part,
                100.0 * APART
            )
        })
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

    /// Compares what the tables of each arc hold with what of it falls on the metal now.
    pub(super) fn compare(&mut self, skin: &Skin<'_>, state: &State) -> Result<(), StageError> {
        let exposed = &state.exposed;
        let mut found = vec![[0.0; 2]; self.arcs.len()];
        for &a in exposed {
            let Some(spot) = self.lit(skin, a as usize, self.metal.spacing) else {
                continue;
            };
            for stand in &self.stands {
                let from = [0, 1].map(|k| spot.at[k] - stand.axis[k]);
                let tables = self.arcs[stand.arc].fluxes.iter();
                for flux in tables.filter(|flux| flux.table().is_some()) {
                    let (spacing, times) = (self.metal.spacing, [0.0, 1.0]);
                    let (taken, _) = flux.over(from, spacing, 0.0, times)?;
                    let (even, _) = flux.even(from, spacing, 0.0, times)?;
                    let sums = &mut found[stand.arc];
                    let power = stand.level * spot.area;
                    *sums = [sums[0] + power * taken.abs(), sums[1] + power * even.abs()];
                }
            }
        }
        for stand in &self.stands {
            let arc = &mut self.arcs[stand.arc];
            let here = (state.faces).part_here(stand.axis, [0.0, 0.0, 1.0], self.metal.spacing);
            arc.reached.offered += here * stand.level * arc.held;
        }
        for (arc, [put, even]) in self.arcs.iter_mut().zip(found) {
            arc.reached.put += put;
            arc.reached.even += even;
        }
        Ok(())
    }
}

/// What the tables among `fluxes` hold \[W\]: 2 pi times the integral of |q| r, exact between rows.
pub(super) fn held(fluxes: &[Flux]) -> f64 {
    let tables = fluxes.iter().filter_map(Flux::table);
    let power = |table: &props::Table| {
        let rows = table.nodes().windows(2).zip(table.values().windows(2));
        let ring = rows.map(|(r, q)| {
            let (a, b) = (r[0], r[1]);
            // q is linear in r: the mean of q r over the row, by Simpson's rule, is exact.
            let middle = 0.5 * (a + b) * 0.5 * (q[0] + q[1]);
            (b - a) / 6.0 * (a * q[0] + 4.0 * middle + b * q[1])
        });
        let first = 0.5 * table.nodes()[0].powi(2) * table.values()[0];
        2.0 * std::f64::consts::PI * (first + ring.sum::<f64>())
    };
    tables.map(|table| power(table).abs()).sum()
}

#[cfg(test)]
mod tests {
    use super::super::super::flux::Law;
    use super::*;

    #[test]
    fn a_cone_holds_its_volume() {
        let nodes = vec![0.0, 5.0, 10.0, 15.0];
        let values = vec![3.0, 2.0, 1.0, 0.0];
        let table = props::Table::new(nodes, values).unwrap();
        let flux = Flux::new("heat", Law::Table(table));
        let exact = std::f64::consts::PI * 15.0 * 15.0;
        assert!((held(&[flux]) / exact - 1.0).abs() < 1e-12);
    }

    #[test]
    fn an_arc_that_misses_the_metal_is_told_by_its_number() {
        let reached = |put| Reached {
            offered: 100.0,
            put,
            even: put,
        };
        assert_eq!(reached(60.0).warning(0), None);
        assert!(reached(160.0).warning(0).unwrap().contains("160.0 %"));
        assert!(reached(0.0).warning(1).unwrap().starts_with("arc 1: 0.0 %"));
        assert_eq!(Reached::default().warning(0), None);
        let narrow = Reached {
            even: 90.0,
            ..reached(93.0)
        };
        assert!(narrow.warning(0).unwrap().contains("give 103.3 %"));
    }
}
