//! How far the equations are from holding.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Greatest residual, as a part of its scale, of fields whose figures hold: those of a gas metal arc of 300 A on coarse cells
/// differ by at most 0.5 % from where 1e-6 takes them. With 1e-2 they differ by up to 3 %, with 0.1 by up to 13 %.
pub const HOLDS: f64 = 1e-3;

/// Name and unit of each equation whose residual has a place, in the order of
/// [`Residuals::unbalanced`].
pub const EQUATIONS: [(&str, &str); 4] = [
    ("charge", "A"),
    ("force", "N"),
    ("mass", "kg/s"),
    ("heat", "W"),
];

/// What an equation lacks, and where most of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Unbalanced {
    /// Sum over all cells of what is out of balance, in the unit of the equation.
    pub amount: f64,
    /// Amount of the worst cell.
    pub most: f64,
    /// Radial index of that cell, of its staggered grid for forces.
    pub column: usize,
    /// Axial index of that cell.
    pub row: usize,
}

impl Unbalanced {
    /// Of the residuals of all cells, `columns` in a row.
    #[must_use]
    pub fn of(residual: &[f64], columns: usize) -> Self {
        let (mut amount, mut most, mut worst) = (0.0, 0.0, 0);
        for (k, r) in residual.iter().enumerate() {
            amount += r.abs();
            if r.abs() > most {
                (most, worst) = (r.abs(), k);
            }
        }
        Self {
            amount,
            most,
            column: worst % columns.max(1),
            row: worst / columns.max(1),
        }
    }

    /// Both together, with the place of the worse.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let worse = if other.most > self.most { other } else { self };
        Self {
            amount: self.amount + other.amount,
            ..worse
        }
    }
}

/// What may be out of balance at the end, summed over all cells; an equation without a limit of its
/// own follows the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stop {
    /// Greatest sum of the currents that are not balanced in the cells; absent: the tolerance decides.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub charge_a: Option<f64>,
    /// Greatest sum of the forces that are not balanced; absent: the tolerance decides.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub force_n: Option<f64>,
    /// Greatest sum of the mass flows that are not balanced; absent: the tolerance decides.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub mass_kg_s: Option<f64>,
    /// Greatest sum of the heat flows that are not balanced; absent: the tolerance decides.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub heat_w: Option<f64>,
}

impl Stop {
    fn limits(&self) -> [Option<f64>; 4] {
        [self.charge_a, self.force_n, self.mass_kg_s, self.heat_w]
    }
}

/// Residuals as parts of their scales; absent physics has none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residuals {
    /// Charge: unbalanced over mean current.
    pub charge: Option<f64>,
    /// Momentum: unbalanced force over the sum of forces.
    pub force: Option<f64>,
    /// Mass: unbalanced over mean mass flow.
    pub mass: Option<f64>,
    /// Heat: unbalanced over the power put in and taken out.
    pub heat: Option<f64>,
    /// Iron: unbalanced over what metal gives off and edges exchange.
    pub iron: Option<f64>,
    /// Change that the speed of the wire still wants.
    pub feed: Option<f64>,
    /// Part of the bed of flux that still boils or comes back.
    pub cavity: Option<f64>,
    /// Cells whose temperature step was limited.
    pub limited: usize,
    /// Amounts and places, in the order of [`EQUATIONS`].
    pub unbalanced: [Option<Unbalanced>; 4],
}

impl Residuals {
    /// The residuals that exist, by name.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let all = [
            ("residual_charge", self.charge),
            ("residual_force", self.force),
            ("residual_mass", self.mass),
            ("residual_heat", self.heat),
            ("residual_iron", self.iron),
            ("residual_feed", self.feed),
            ("residual_cavity", self.cavity),
        ];
        all.into_iter()
            .filter_map(|(name, value)| Some((name, value?)))
    }

    /// The greatest residual.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.named().map(|(_, v)| v).fold(0.0, f64::max)
    }

    /// What is to be told of an iteration that ended where its scene wanted it to, and too soon for its figures to hold.
    #[must_use]
    pub fn loose(&self) -> Option<String> {
        let most = self.named().max_by(|a, b| a.1.total_cmp(&b.1));
        let (name, worst) = most.filter(|(_, worst)| *worst > HOLDS)?;
        Some(format!(
            "ended where the scene lets it, but not converged: {name} is {worst:.1e} of its scale, and from {HOLDS:.0e} on figures \
             differ by percents from what smaller ones give: lower \"iterate/tolerance\" or the limits of \"iterate/stop\""
        ))
    }

    fn parts(&self) -> [Option<f64>; 4] {
        [self.charge, self.force, self.mass, self.heat]
    }

    /// The equation that exceeds its limit by the greatest factor, and its residual as a part of its
    /// scale.
    #[must_use]
    pub fn farthest(&self, tolerance: f64, stop: &Stop) -> Option<(usize, f64)> {
        let (parts, limits) = (self.parts(), stop.limits());
        let excess = |n: usize| -> Option<f64> {
            let part = parts[n]?;
            Some(match (limits[n], self.unbalanced[n]) {
                (Some(limit), Some(found)) => found.amount / limit,
                _ => part / tolerance,
            })
        };
        let all = (0..EQUATIONS.len()).filter_map(|n| Some((n, excess(n)?)));
        let (n, _) = all
            .filter(|(_, e)| *e > 1.0)
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((n, parts[n]?))
    }

    /// Whether every equation keeps its limit, what has none is within `tolerance`, and no step was
    /// limited.
    #[must_use]
    pub fn met(&self, tolerance: f64, stop: &Stop) -> bool {
        let others = [self.iron, self.feed, self.cavity].into_iter().flatten();
        self.limited == 0
            && others.fold(0.0, f64::max) <= tolerance
            && self.farthest(tolerance, stop).is_none()
    }

    /// Whether every residual is within `tolerance` and no step was limited.
    #[must_use]
    pub fn within(&self, tolerance: f64) -> bool {
        self.limited == 0 && self.worst() <= tolerance
    }
}

/// `amount / scale`; nothing of nothing is nothing.
#[must_use]
pub fn part(amount: f64, scale: f64) -> f64 {
    if amount == 0.0 {
        0.0
    } else {
        amount / scale.max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_cell_is_found_and_sums_are_of_amounts() {
        let found = Unbalanced::of(&[0.1, -0.5, 0.2, 0.3, 0.0, -0.1], 3);
        assert!((found.amount - 1.2).abs() < 1e-15 && (found.most - 0.5).abs() < 1e-15);
        assert_eq!((found.column, found.row), (1, 0));
        let both = found.and(Unbalanced::of(&[0.0, 0.9], 1));
        assert_eq!((both.column, both.row), (0, 1));
        assert!((both.amount - 2.1).abs() < 1e-15);
    }

    #[test]
    fn what_a_scene_lets_pass_is_told_where_figures_do_not_hold() {
        let of = |force, heat| Residuals {
            force: Some(force),
            heat: Some(heat),
            ..Residuals::default()
        };
        assert_eq!(of(1e-3, 1e-6).loose(), None);
        let told = of(1e-5, 4.2e-2).loose().unwrap();
        assert!(
            told.contains("residual_heat is 4.2e-2") && told.contains("iterate/tolerance"),
            "{told}"
        );
    }

    #[test]
    fn a_limit_in_watts_takes_the_place_of_the_tolerance() {
        let residuals = Residuals {
            heat: Some(1e-3),
            charge: Some(1e-7),
            unbalanced: [
                None,
                None,
                None,
                Some(Unbalanced {
                    amount: 2.0,
                    ..Unbalanced::default()
                }),
            ],
            ..Residuals::default()
        };
        assert_eq!(residuals.farthest(1e-6, &Stop::default()), Some((3, 1e-3)));
        let stop = |heat| Stop {
            heat_w: Some(heat),
            ..Stop::default()
        };
        assert!(residuals.met(1e-6, &stop(3.0)) && !residuals.met(1e-6, &stop(1.0)));
        assert!(!residuals.met(1e-8, &stop(3.0)));
    }
}
