//! `heat-exp-t-transient`: a front that runs into a cold plate whose conductivity grows with
//! temperature.

use serde_json::json;

use super::heat_exp_t::material;
use super::heat_exp_x::square_spacing;
use super::heat_exp_x_transient::{range, reference};
use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::bar::Profiles;
use crate::heat::frames::{Frames, greater, worst};
use crate::heat::methods::{self, TRANSIENT, over};
use crate::lab::{Lab, LabError};

/// a of the paper \[1/K\].
const RATES: [f64; 3] = [1.0, 2.0, 4.0];

/// Rises between these parts of the range belong to the front, greater ones to what is behind it.
const FRONT: [f64; 2] = [0.02, 0.2];

/// The case.
pub(super) struct HeatExpTTransient;

impl Case for HeatExpTTransient {
    fn name(&self) -> &'static str {
        "heat-exp-t-transient"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Fine finite volumes in one dimension (Kirchhoff), extrapolated"
    }

    fn methods(&self) -> &'static [&'static str] {
        TRANSIENT
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        // Level 3 is left to what is quick.
        let quick = ["corrected-implicit", "corrected-stabilised"].contains(&method);
        let most = if quick { 3 } else { 2 };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let pair = |rate: &f64| {
            let behind = Target::error(format!("behind_a{rate}"), 5e-3);
            let front = Target::error(format!("front_spacings_a{rate}"), 1.0);
            [behind.at_level(2), front.at_level(2)]
        };
        methods::also_jittered(RATES.iter().flat_map(pair).collect(), TRANSIENT)
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = square_spacing(level);
        let mut all = Vec::new();
        let mut errors = Errors::new();
        let mut points = 0;
        for rate in RATES {
            // Times at which the front is on its way: parts of that of the mean conductivity.
            let unit = rate / rate.exp_m1();
            let at: Vec<f64> = [0.03, 0.1, 0.3].iter().map(|t| t * unit).collect();
            let patch = over(
                json!({"points": {"spacing_m": spacing}, "materials": [material(rate)],
                       "time": {"end_s": at[2]}, "output": {"at_s": at}}),
                &methods::patch(method),
            );
            let label = format!("level{level}-{method}-a{rate}");
            let run = lab.run(self.tool(), self.name(), &label, &patch)?;
            let frames = Frames::read(&run)?;
            let (bar, exact) = reference(&run, &frames, 400)?;
            let (behind, front) = misses(&frames, &exact, bar.start, range(&bar));
            errors.insert(format!("behind_a{rate}"), behind);
            errors.insert(format!("front_spacings_a{rate}"), front / spacing);
            points = frames.points();
            all.push(run);
        }
        Ok(Measurement::over(all, points, spacing, errors))
    }
}

/// Largest error over the range where the plate has warmed beyond the front, and the largest
/// distance along x between a point of the front and the place where the reference is as warm \[m\].
fn misses(frames: &Frames, exact: &Profiles, start: f64, range: f64) -> (f64, f64) {
    let mut misses = (0.0, 0.0);
    for (i, (_, found)) in frames.after_start().enumerate() {
        // Ahead of the front and in it the slope turns a shift into any error.
        let warm: Vec<usize> = (0..found.len())
            .filter(|n| (exact.value(i, frames.position[*n][0]) - start).abs() > FRONT[1] * range)
            .collect();
        let places: Vec<[f64; 3]> = warm.iter().map(|n| frames.position[*n]).collect();
        let values: Vec<f64> = warm.iter().map(|n| found[*n]).collect();
        let behind = worst(&places, &values, range, |p| exact.value(i, p[0]));
        misses.0 = greater(misses.0, behind);
        let front = frames
            .position
            .iter()
            .zip(found)
            .filter_map(|(place, value)| {
                let rise = (value - start).abs() / range;
                let within = rise > FRONT[0] && rise < FRONT[1];
                let x = within.then(|| place_of(exact, i, *value)).flatten()?;
                Some((x - place[0]).abs())
            });
        // No point in the front is no success.
        misses.1 = greater(misses.1, front.reduce(greater).unwrap_or(f64::NAN));
    }
    misses
}

/// Where a profile that rises or falls has this value.
fn place_of(exact: &Profiles, time: usize, value: f64) -> Option<f64> {
    let profile = &exact.temperature[time];
    let between = |w: &[f64]| (w[0] - value) * (w[1] - value) <= 0.0;
    let i = profile.windows(2).position(between)?;
    let step = profile[i + 1] - profile[i];
    let share = if step.abs() > 0.0 {
        (value - profile[i]) / step
    } else {
        0.5
    };
    Some(exact.x[i] + share * (exact.x[i + 1] - exact.x[i]))
}
