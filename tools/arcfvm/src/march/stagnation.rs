//! Which equation does not come to hold, where, and why.

use serde::{Deserialize, Serialize};

use crate::material::{Law, Material};
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
/// Part of the greatest value of a property below which a jump does no harm.
const COUNTS: f64 = 0.01;
/// Number of laws that are looked at.
const LAWS: usize = 5;
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
    tolerance: f64,
    stop: &Stop,
    trail: &Trail,
) -> String {
    let Some((n, part)) = residuals.farthest(tolerance, stop) else {
        let most = residuals.named().max_by(|a, b| a.1.total_cmp(&b.1));
        let (name, worst) = most.unwrap_or(("residual", 0.0));
        let why = elsewhere(arc, &greatest(arc));
        let why = why.unwrap_or_else(|| others(residuals, name, tolerance));
        return format!(
            "{name} {worst:.1e}, wanted {tolerance:.1e}: {}; {why}",
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
    let greatest = greatest(arc);
    let why = cell.and_then(|k| at_cell(arc, k, &greatest));
    let why = why.or_else(|| elsewhere(arc, &greatest));
    let why = why.unwrap_or_else(|| others(residuals, &format!("residual_{name}"), tolerance));
    text + &format!("; {why}")
}

/// Where nothing stands out: the equations beside the one called `name` that do not hold either.
fn others(residuals: &Residuals, name: &str, tolerance: f64) -> String {
    let also: Vec<String> = residuals
        .named()
        .filter(|(other, part)| *other != name && *part > tolerance)
        .map(|(other, part)| format!("{} {part:.1e}", other.trim_start_matches("residual_")))
        .collect();
    let also = match also.as_slice() {
        [] => "every other equation holds".to_owned(),
        some => format!(
            "of their scales are out of balance too: {}",
            some.join(", ")
        ),
    };
    format!("no property jumps in any cell, and {also}")
}

/// What a jump is looked for in.
fn laws(material: &Material) -> [(&'static str, &Option<Law>); LAWS] {
    [
        ("electric conductivity", &material.electric_conductivity),
        ("thermal conductivity", &material.thermal_conductivity),
        ("density", &material.density),
        ("viscosity", &material.viscosity),
        ("net emission", &material.net_emission),
    ]
}

/// Values of a law at the temperature of cell `k`, and as far below and above as counts as near.
fn around(arc: &Arc, k: usize, law: &Law) -> [f64; 3] {
    let (grid, t) = (&arc.case.grid, arc.temperature()[k]);
    let (r, z) = (grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
    [1.0, 1.0 - NEAR, 1.0 + NEAR].map(|part| law.at(r, z, part * t))
}

/// The greatest value of each law of each material.
fn greatest(arc: &Arc) -> Vec<[f64; LAWS]> {
    let mut greatest = vec![[0.0_f64; LAWS]; arc.case.materials.len()];
    for (k, material) in arc.case.material.iter().enumerate() {
        let found = greatest[*material].iter_mut();
        for (most, (_, law)) in found.zip(laws(arc.case.of(k))) {
            if let Some(law) = law {
                *most = most.max(around(arc, k, law)[0]);
            }
        }
    }
    greatest
}

/// The property that changes most near the temperature of cell `k`, and by which factor; properties that
/// are negligible there do not count.
fn jump(arc: &Arc, k: usize, greatest: &[[f64; LAWS]]) -> Option<(&'static str, f64)> {
    let most = greatest[arc.case.material[k]];
    let jumps = laws(arc.case.of(k))
        .into_iter()
        .zip(most)
        .filter_map(|((name, law), most)| {
            let [_, below, above] = around(arc, k, law.as_ref()?);
            let ratio = (above / below).max(below / above);
            let counts = below.max(above) > COUNTS * most;
            (ratio > JUMP && ratio.is_finite() && counts).then_some((name, ratio))
        });
    jumps.max_by(|a, b| a.1.total_cmp(&b.1))
}

/// What is special about a cell: a property that jumps, or a temperature that alternates.
fn at_cell(arc: &Arc, k: usize, greatest: &[[f64; LAWS]]) -> Option<String> {
    if let Some((name, ratio)) = jump(arc, k, greatest) {
        let part = 100.0 * NEAR;
        return Some(format!(
            "the {name} changes by a factor of {ratio:.1} within {part:.0} % of the temperature there"
        ));
    }
    let calm = arc.heating.as_ref().map_or(1.0, |h| h.energy.calm[k]);
    (calm < CALM)
        .then(|| "its temperature alternates however little of a change is taken".to_owned())
}

/// The property that jumps most in any cell.
fn elsewhere(arc: &Arc, greatest: &[[f64; LAWS]]) -> Option<String> {
    let jumps = (0..arc.case.grid.len()).filter_map(|k| Some((k, jump(arc, k, greatest)?)));
    let (k, (name, ratio)) = jumps.max_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
    let (own, t, part) = (&arc.case.of(k).name, arc.temperature()[k], 100.0 * NEAR);
    Some(format!(
        "in {} ({own}, {t:.0} K) the {name} changes by a factor of {ratio:.1} within {part:.0} % of the temperature",
        arc.case.place(k)
    ))
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
    fn where_nothing_stands_out_the_other_equations_are_told() {
        let residuals = Residuals {
            charge: Some(2e-9),
            force: Some(3e-4),
            heat: Some(5e-3),
            feed: Some(2e-4),
            ..Residuals::default()
        };
        let told = others(&residuals, "residual_heat", 1e-5);
        assert!(told.ends_with("too: force 3.0e-4, feed 2.0e-4"), "{told}");
        let told = others(&residuals, "residual_heat", 1e-3);
        assert!(told.ends_with("every other equation holds"), "{told}");
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
