//! What coils and applied fields are multiplied by in a march, and whether its steps follow it.
//!
//! A step sees the wave at its start, at an instant within and at its end. What lies between is a straight line to a method of
//! second order: of a sine a tenth of a period long it leaves that line by a twentieth of the amplitude. A switch within a step
//! is seen as one of that step, which is as well as a step can tell; a peak between two instants is not seen at all.

use run::Failure;
use run::property::{Arguments, Curve, Property};
use steps::Legs;

use super::scheme::GAMMA;
use crate::scene::currents::Transient;

/// Part of its greatest value by which a wave may leave the straight line over a step, and what the step sees.
const BENT: f64 = 0.05;
/// Part of all steps over which it may leave the straight line by more: switches.
const FEW: f64 = 0.1;
/// Parts of a step in each of which the wave is bounded.
const PARTS: usize = 64;

/// The wave.
pub(crate) struct Wave {
    curve: Curve,
    /// Greatest size of it at starts and middles of steps.
    greatest: f64,
}

impl Wave {
    pub(crate) fn new(transient: &Transient, steps: &Legs) -> Result<Self, Failure> {
        let on = Property::Constant(1.0);
        let wave = transient.wave.as_ref().unwrap_or(&on);
        let mut wave = Self {
            curve: wave.compile("/eddy_currents/transient/wave", &["t"])?,
            greatest: 0.0,
        };
        let count = if wave.curve.depends_on("t") {
            steps.count()
        } else {
            0
        };
        for step in 0..count {
            let (from, length) = steps.step(step);
            let seen = [wave.at(from)?, wave.at(from + 0.5 * length)?];
            wave.greatest = seen.iter().fold(wave.greatest, |most, w| most.max(w.abs()));
        }
        Ok(wave)
    }

    /// Whether it has one value at start, middle and end of a step.
    pub(crate) fn stands(&self, from: f64, to: f64) -> Result<bool, Failure> {
        let start = self.at(from)?;
        let others = [self.at(0.5 * (from + to))?, self.at(to)?];
        Ok(others.iter().all(|w| w.to_bits() == start.to_bits()))
    }

    pub(crate) fn at(&self, time: f64) -> Result<f64, Failure> {
        let value = self.curve.value(&Arguments::at([0.0; 3], time));
        value.map_err(|error| Failure::Other(format!("wave at {time:.6e} s: {error}")))
    }

    /// Its values at even parts of a step of `length` \[s\], between which it is taken as a line: at the ends alone where it does not
    /// vary.
    pub(crate) fn lines(&self, from: f64, length: f64) -> Result<Vec<f64>, Failure> {
        let parts = if self.curve.depends_on("t") { PARTS } else { 1 };
        let part = |k: usize| self.at(from + length * k as f64 / parts as f64);
        (0..=parts).map(part).collect()
    }

    /// Whether a step of `length` \[s\] from an instant \[s\] on sees its peaks and meets no bend.
    pub(crate) fn follows(&self, from: f64, length: f64) -> Result<bool, Failure> {
        if !self.curve.depends_on("t") {
            return Ok(true);
        }
        let Strayed { beyond, line } = self.strays(from, length)?;
        Ok(beyond.max(line) <= BENT * self.greatest)
    }

    /// How long it takes to change by its greatest value, in the mean over all steps from rest on \[s\]: 1/omega of a sine.
    pub(crate) fn lasts(&self, steps: &Legs) -> Result<f64, Failure> {
        let (mut before, mut most, mut way) = (0.0, 0.0_f64, 0.0);
        let count = if self.curve.depends_on("t") {
            steps.count()
        } else {
            0
        };
        for step in 0..=count {
            let time = if step == 0 { 0.0 } else { steps.end(step).0 };
            let value = self.at(time)?;
            most = most.max(value.abs());
            way += (value - before).abs();
            before = value;
        }
        let end = steps.end(steps.count()).0;
        Ok(if most > 0.0 {
            std::f64::consts::FRAC_2_PI * end * most / way
        } else {
            f64::INFINITY
        })
    }

    /// What to tell where steps do not follow it.
    pub(crate) fn doubt(&self, steps: &Legs) -> Result<Option<String>, Failure> {
        if !self.curve.depends_on("t") {
            return Ok(None);
        }
        let most = self.greatest;
        let (mut unseen, mut bent, mut worst) = (0_u64, 0_u64, (0.0, 0.0));
        for step in 0..steps.count() {
            let (from, length) = steps.step(step);
            let Strayed { beyond, line } = self.strays(from, length)?;
            unseen += u64::from(beyond > BENT * most);
            bent += u64::from(line > BENT * most);
            if line > worst.0 {
                worst = (line, from);
            }
        }
        if unseen == 0 && bent as f64 <= FEW * steps.count() as f64 {
            return Ok(None);
        }
        Ok(Some(format!(
            "unresolved: within {} of {} steps of up to {:.3e} s the wave leaves the straight line by more than {BENT} of its \
             greatest value, most from {:.4e} s on, and {unseen} steps do not see its peaks: take a smaller 'step_s', of a \
             sine at most a tenth of its period",
            bent.max(unseen),
            steps.count(),
            steps.longest(),
            worst.1
        )))
    }

    /// How far it strays within a step.
    fn strays(&self, from: f64, length: f64) -> Result<Strayed, Failure> {
        let [start, early, late] = [0.0, GAMMA, 1.0].map(|part| self.at(from + part * length));
        let seen = [start?, early?, late?];
        let (low, high) = seen
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), w| {
                (low.min(*w), high.max(*w))
            });
        let mut strayed = Strayed::default();
        for part in 0..PARTS {
            let [a, b] = [part, part + 1].map(|k| k as f64 / PARTS as f64);
            let [before, after] = [a, b].map(|part| Arguments::at([0.0; 3], from + part * length));
            let bounds = self.curve.bounds(&before, &after);
            let found = if bounds.width().is_finite() {
                [bounds.low, bounds.high]
            } else {
                [self.at(before.time)?; 2]
            };
            strayed.beyond = strayed.beyond.max(found[1] - high).max(low - found[0]);
            let line = |part: f64| seen[0] + part * (seen[2] - seen[0]);
            let off = (found[1] - line(a).max(line(b))).max(line(a).min(line(b)) - found[0]);
            strayed.line = strayed.line.max(off);
        }
        Ok(strayed)
    }
}

/// How far a wave strays within a step.
#[derive(Debug, Clone, Copy, Default)]
struct Strayed {
    /// Beyond what the step sees.
    beyond: f64,
    /// From the straight line between its ends.
    line: f64,
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may fail")]
mod tests {
    use super::*;
    use crate::scene::Output;

    fn march(wave: &str, step_s: f64) -> (Wave, Legs) {
        let transient = Transient {
            end_s: 1.0,
            step_s,
            wave: serde_json::from_str(&format!(r#"{{"expr": "{wave}"}}"#)).unwrap(),
            adaptive: None,
        };
        let steps = transient.steps(&Output::default());
        (Wave::new(&transient, &steps).unwrap(), steps)
    }

    fn doubt(wave: &str, step_s: f64) -> Option<String> {
        let (wave, steps) = march(wave, step_s);
        wave.doubt(&steps).unwrap()
    }

    #[test]
    fn steps_that_meet_a_sine_at_one_phase_are_told() {
        for step in [0.02, 0.019, 0.04, 0.0025] {
            assert!(doubt("sin(2*pi*50*t)", step).is_some(), "{step}");
        }
        // Twelve steps a period, and no wave at all.
        assert_eq!(doubt("sin(2*pi*50*t)", 0.02 / 12.0), None);
        assert_eq!(doubt("3", 0.1), None);
    }

    #[test]
    fn a_peak_between_two_instants_is_told_and_a_switch_is_not() {
        assert!(doubt("exp(-((t - 0.553)/1e-4)^2)", 0.01).is_some());
        assert_eq!(doubt("step(t - 0.553)", 0.01), None);
        assert_eq!(doubt("1 - exp(-t/0.1)", 0.01), None);
    }

    #[test]
    fn a_sine_lasts_its_inverse_angular_frequency_and_a_switch_the_march() {
        let (wave, steps) = march("sin(2*pi*5*t)", 0.005);
        let lasts = wave.lasts(&steps).unwrap();
        assert!(
            (lasts * 10.0 * std::f64::consts::PI - 1.0).abs() < 1e-9,
            "{lasts}"
        );
        let (wave, steps) = march("1", 0.1);
        let lasts = wave.lasts(&steps).unwrap();
        assert!(
            (lasts - std::f64::consts::FRAC_2_PI).abs() < 1e-12,
            "{lasts}"
        );
    }
}
