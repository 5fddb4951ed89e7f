//! Whether the flow that a force stirs is resolved by the points that it passes.
//!
//! Points that follow the surface are passed by the liquid at u - w. Over one spacing h friction takes away
//! `nu |u - w|/h^2` of a difference that `|u - w|^2/h` brings: where the cell Reynolds number `|u - w| h/nu` is large, what
//! becomes shorter than a spacing is not rubbed away.

use super::points::Liquid;
use super::vector::{difference, length};

/// Cell Reynolds number up to which a flow counts as resolved. Levitated drops (`levitation`) swung for three periods at 5,
/// and broke up after 44 ms at 47, after 24 ms at 97 and more.
pub const RESOLVED: f64 = 20.0;

/// The greatest cell Reynolds number so far.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Passing {
    /// It.
    pub greatest: f64,
    /// When it first passed [`RESOLVED`] \[s\].
    pub since: Option<f64>,
}

impl Passing {
    /// Looks at a liquid of kinematic viscosity `diffusion` \[m2/s\] at a time \[s\].
    pub fn look<const D: usize>(
        &mut self,
        liquid: &Liquid<D>,
        diffusion: f64,
        spacing: f64,
        time: f64,
    ) {
        let passed = liquid.velocity.iter().zip(&liquid.follow);
        let fastest = passed.map(|(u, w)| length(&difference(u, w)));
        let number = fastest.fold(0.0, f64::max) * spacing / diffusion;
        self.greatest = self.greatest.max(number);
        if number > RESOLVED {
            self.since.get_or_insert(time);
        }
    }

    /// What a reader must be told.
    #[must_use]
    pub fn doubt(&self) -> Option<String> {
        self.since.map(|since| {
            format!(
                "the stirred flow is not resolved from {since:.3e} s on: it passes points at a cell Reynolds number |u| h/nu of up to {:.3}, \
                 {RESOLVED} is resolved; take a smaller spacing or, where the flow is turbulent, its effective viscosity",
                self.greatest
            )
        })
    }

    /// As numbers for a checkpoint.
    #[must_use]
    pub fn save(&self) -> Vec<f64> {
        [self.greatest].into_iter().chain(self.since).collect()
    }

    /// What [`Passing::save`] gave.
    #[must_use]
    pub fn restored(saved: &[f64]) -> Self {
        Self {
            greatest: saved.first().copied().unwrap_or(0.0),
            since: saved.get(1).copied(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::liquid::room::Room;

    fn passed_at(speed: f64) -> Liquid<2> {
        Liquid {
            position: vec![[0.0; 2]],
            velocity: vec![[speed, 0.0]],
            pressure: vec![0.0],
            rate: vec![[0.0; 2]],
            follow: vec![[0.0; 2]],
            normal: Vec::new(),
            stress: Vec::new(),
            pull: [Vec::new(), Vec::new()],
            drag: Vec::new(),
            charge: Vec::new(),
            force: [Vec::new(), Vec::new()],
            room: Room::default(),
            borne: None,
        }
    }

    #[test]
    fn what_passes_points_too_fast_is_told_with_the_time() {
        let mut passing = Passing::default();
        passing.look(&passed_at(0.1), 1e-6, 1e-4, 1e-3);
        assert!((passing.greatest - 10.0).abs() < 1e-12);
        assert_eq!(passing.doubt(), None);
        passing.look(&passed_at(0.3), 1e-6, 1e-4, 2e-3);
        passing.look(&passed_at(0.2), 1e-6, 1e-4, 3e-3);
        let doubt = passing.doubt().unwrap();
        assert!(
            doubt.contains("from 2.000e-3 s") && doubt.contains("up to 30"),
            "{doubt}"
        );
        assert_eq!(Passing::restored(&passing.save()), passing);
        assert_eq!(
            Passing::restored(&Passing::default().save()),
            Passing::default()
        );
    }
}
