//! Currents that grow while sources stand still.
//!
//! Sources that do not change drive no currents: those that are left decay, and so does their heat,
//! `d/dt int sigma E^2 dV = -2 int |curl E|^2 / mu dV`. Points that do not carry a field make it grow instead, a little
//! in each step and in the end without bound.

use run::Failure;

use crate::cloud::Cloud;
use crate::solve::broken::point;

/// Rise of the heat in a step that counts.
const RISE: f64 = 1.01;
/// So many rises, one after the other, are no chance.
const RISES: u32 = 4;
/// Heat below this part of the largest is what solves leave.
const REST: f64 = 1e-8;

/// Watches the heat of currents, step by step.
pub(crate) struct Growth {
    /// Conductivity times volume by point, up to a factor.
    weights: Vec<f64>,
    /// Unknowns of a point.
    components: usize,
    /// Heat of the last step, the largest heat, and how many steps it has risen.
    pub(crate) seen: (f64, f64, u32),
}

impl Growth {
    pub(crate) fn new(weights: Vec<f64>, components: usize) -> Self {
        Self {
            weights,
            components,
            seen: (0.0, 0.0, 0),
        }
    }

    /// Takes in the rates of a step, by unknown, that ends at `time` \[s\] and in which sources stood `still`.
    ///
    /// # Errors
    /// The point where currents are largest, where they have grown for several steps of that kind.
    pub(crate) fn watch(
        &mut self,
        rates: &[f64],
        still: bool,
        step: u64,
        time: f64,
        cloud: &Cloud,
    ) -> Result<(), Failure> {
        let heat = |i: usize| -> f64 {
            let own = &rates[self.components * i..self.components * (i + 1)];
            self.weights[i] * own.iter().map(|r| r * r).sum::<f64>()
        };
        let whole: f64 = (0..self.weights.len()).map(heat).sum();
        let (last, largest, rises) = self.seen;
        let rose = still && whole > RISE * last && whole > REST * largest;
        let rises = if rose { rises + 1 } else { 0 };
        self.seen = (whole, largest.max(whole), rises);
        if rises < RISES {
            return Ok(());
        }
        let worst = (0..self.weights.len()).max_by(|a, b| heat(*a).total_cmp(&heat(*b)));
        Err(Failure::Diverged {
            step,
            time_s: time,
            place: worst.map_or_else(|| "nowhere".to_owned(), |i| point(cloud, i)),
            quantity: "Joule heat, W".to_owned(),
            what: format!(
                "it has grown for {rises} steps, by {:.3} in the last, while sources stood still: points there do not carry the field; take other spacings or \"order\": 2",
                whole / last
            ),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> Cloud {
        let scene = r#"{"geometry": "plane", "domain": {"box": {"min_m": [0, 0], "max_m": [1, 1]}},
            "points": {"spacing_m": 0.5}, "electrostatics": {"outer": [{"potential_v": 0}]}}"#;
        crate::cloud::setup::cloud(&serde_json::from_str(scene).unwrap()).unwrap()
    }

    /// The step at which heats, the roots of which are given, are found to grow.
    fn ends(rates: &[f64], still: bool) -> Option<u64> {
        let cloud = cloud();
        let mut growth = Growth::new(vec![1.0; 2], 1);
        (0..).zip(rates).find_map(|(step, rate)| {
            let found = growth.watch(&[0.0, *rate], still, step, 0.0, &cloud);
            let Err(Failure::Diverged { place, .. }) = found else {
                return None;
            };
            assert!(place.starts_with("point 1 at"), "{place}");
            Some(step)
        })
    }

    #[test]
    fn what_grows_while_sources_stand_still_is_found_and_nothing_else() {
        let grows = [1.0, 0.3, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45];
        assert_eq!(ends(&grows, true), Some(6));
        assert_eq!(ends(&grows, false), None);
        let decays: Vec<f64> = (0..60).map(|n| 0.8_f64.powi(n)).collect();
        assert_eq!(ends(&decays, true), None);
        // What solves leave may rise.
        let rest: Vec<f64> = std::iter::once(1e6).chain((1..20).map(f64::from)).collect();
        assert_eq!(ends(&rest, true), None);
    }
}
