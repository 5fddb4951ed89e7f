//! Which equation does not come to hold, where, and why.

use serde::{Deserialize, Serialize};

use crate::material::Law;
use crate::residual::{EQUATIONS, Residuals, Stop};
use crate::solver::Arc;

/// Iterations that are looked back on.
const LOOK_BACK: usize = 100;
/// Iterations whose mean is compared with that of as many others.
const MEAN: usize = 20;
/// What a residual that falls leaves of itself in [`LOOK_BACK`] iterations.
const FALLING: f64 = 0.8;
/// Part of the temperature within which a property may jump.
const NEAR: f64 = 0.01;
/// What its values then differ by.
const JUMP: f64 = 1.5;
/// Relaxation of a cell that has been calmed as far as it goes.
const CALM: f64 = 0.011;

/// The greatest residual of the last iterations.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Trail {
    values: Vec<f64>,
    next: usize,
}

impl Trail {
    /// Takes the residual of an iteration.
    pub fn push(&mut self, residual: f64) {
        if self.values.len() < LOOK_BACK {
            self.values.push(residual);
        } else {
            self.values[self.next] = residual;
        }
        self.next = (self.next + 1) % LOOK_BACK;
    }

    /// What the last iterations have left of it, as a factor in [`LOOK_BACK`] of them.
    fn trend(&self) -> Option<f64> {
        let n = self.values.len();
        if n < LOOK_BACK {
            return None;
        }
        let at = |k: usize| self.values[(self.next + k) % n];
        let mean = |from: usize| {
            let sum: f64 = (from..from + MEAN)
                .map(|k| at(k).max(f64::MIN_POSITIVE).ln())
                .sum();
            (sum / MEAN as f64).exp()
        };
        Some(mean(n - MEAN) / mean(0))
    }

    /// Whether it is falling now, from wherever it was.
    #[must_use]
    pub fn falls(&self) -> bool {
        self.trend().is_some_and(|trend| trend < FALLING)
    }

    /// How it went, in words.
    #[must_use]
    pub fn told(&self) -> String {
        let Some(trend) = self.trend() else {
            return format!("only {} iterations were made", self.values.len());
        };
        let most = self.values.iter().copied().fold(0.0, f64::max);
        let least = self.values.iter().copied().fold(f64::MAX, f64::min);
        if trend < FALLING {
            let factor = 1.0 / trend;
            format!(
                "it falls by a factor of {factor:.1} in {LOOK_BACK} iterations and needs more of them"
            )
        } else if trend > 1.25 {
            format!("it grew by a factor of {trend:.1} in the last {LOOK_BACK} iterations")
        } else if most > 2.0 * least {
            format!("it swings between {least:.1e} and {most:.1e} of its scale")
        } else {
            format!("it stands still at {most:.1e} of its scale")
        }
    }
}

/// The equation that is farthest from holding, its cell, and why.
#[must_use]
pub fn told(
    arc: &Arc,
    residuals: &Residuals,
    (tolerance, stop): (f64, &Stop),
    trail: &Trail,
) -> String {
    let Some((n, part)) = residuals.farthest(tolerance, stop) else {
        let greatest = residuals.named().max_by(|a, b| a.1.total_cmp(&b.1));
        let (name, worst) = greatest.unwrap_or(("residual", 0.0));
        return format!(
            "{name} {worst:.1e}, wanted {tolerance:.1e}: {}",
            trail.told()
        );
    };
    let (name, unit) = EQUATIONS[n];
    let mut text = format!("{name}: ");
    let mut cell = None;
    if let Some(found) = residuals.unbalanced[n] {
        let k = arc.case.grid.cell(
            found.column.min(arc.case.grid.nr - 1),
            found.row.min(arc.case.grid.nz - 1),
        );
        let own = &arc.case.of(k).name;
        let t = arc.temperature()[k];
        text += &format!(
            "{:.1e} {unit} out of balance ({part:.1e} of the scale), most in {} ({own}, {t:.0} K)",
            found.amount,
            arc.case.place(k)
        );
        cell = Some(k);
    }
    text += &format!(": {}", trail.told());
    if residuals.limited > 0 {
        text += &format!(
            "; {} cells want to change more than an iteration may",
            residuals.limited
        );
    }
    if let Some(why) = cell.and_then(|k| at_cell(arc, k)) {
        text += &format!("; {why}");
    }
    text
}

/// What is special about a cell: a property that jumps, or a temperature that alternates.
fn at_cell(arc: &Arc, k: usize) -> Option<String> {
    let (grid, t) = (&arc.case.grid, arc.temperature()[k]);
    let (r, z) = (grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
    let material = arc.case.of(k);
    let laws: [(&str, &Option<Law>); 5] = [
        ("electric conductivity", &material.electric_conductivity),
        ("thermal conductivity", &material.thermal_conductivity),
        ("density", &material.density),
        ("viscosity", &material.viscosity),
        ("net emission", &material.net_emission),
    ];
    for (name, law) in laws {
        let Some(law) = law else { continue };
        let [below, above] = [1.0 - NEAR, 1.0 + NEAR].map(|f| law.at(r, z, f * t));
        let ratio = (above / below).max(below / above);
        if ratio > JUMP && ratio.is_finite() {
            let part = 100.0 * NEAR;
            return Some(format!(
                "the {name} changes by a factor of {ratio:.1} within {part:.0} % of the temperature there"
            ));
        }
    }
    let calm = arc.heating.as_ref().map_or(1.0, |h| h.energy.calm[k]);
    (calm < CALM)
        .then(|| "its temperature alternates however little of a change is taken".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: impl Fn(usize) -> f64) -> String {
        let mut trail = Trail::default();
        for k in 0..250 {
            trail.push(value(k));
        }
        trail.told()
    }

    #[test]
    fn falling_growing_swinging_and_standing_are_told_apart() {
        assert!(of(|k| 0.98_f64.powi(k as i32)).starts_with("it falls"));
        let falls = |q: f64| {
            let mut trail = Trail::default();
            (0..250).for_each(|k| trail.push(q.powi(k)));
            trail.falls()
        };
        assert!(falls(0.99) && !falls(0.999) && !falls(1.01));
        assert!(of(|k| 1.01_f64.powi(k as i32)).starts_with("it grew"));
        assert!(of(|k| 1.0 + 0.9 * (0.7 * k as f64).sin()).starts_with("it swings"));
        assert!(of(|_| 3e-4).starts_with("it stands still at 3.0e-4"));
        let mut short = Trail::default();
        short.push(1.0);
        assert!(short.told().contains("only 1"));
    }
}
