//! The nine-coefficient form of heat capacity, enthalpy and entropy of McBride, Zehe and Gordon,
//! NASA/TP-2002-211556, eqs 1 to 3, and what it says of a particle's inside.
//!
//! With x = T, R the gas constant, and the standard pressure of 1 bar:
//!
//! - cp/R = a1/T^2 + a2/T + a3 + a4 T + a5 T^2 + a6 T^3 + a7 T^4,
//! - H/RT = -a1/T^2 + a2 ln T/T + a3 + a4 T/2 + a5 T^2/3 + a6 T^3/4 + a7 T^4/5 + b1/T,
//! - S/R = -a1/2T^2 - a2/T + a3 ln T + a4 T + a5 T^2/2 + a6 T^3/3 + a7 T^4/4 + b2.
//!
//! From these the internal partition function follows by taking the flight of the particle away:
//! ln Q = S/R - (H - H0)/RT - ln(kT/p (2 pi m kT/h^2)^(3/2)), with H0 the enthalpy of the ground state at rest.
//!
//! Below the first range the first fit is used on. Above the last range a continuation of the same form is laid on:
//! cp/R = limit + (cp/R at the end - limit) (T_end/T)^2, with H, S and cp continuous. It stays bounded, so a
//! molecule's Q grows like a power of T and its share falls as the plasma thins out.

use super::internal::Internal;
use crate::constants::{BOLTZMANN, GAS_CONSTANT, PLANCK};

/// Standard pressure of the fits, Pa.
const STANDARD_PRESSURE: f64 = 1.0e5;

/// One range of a fit.
#[derive(Debug, Clone)]
pub(super) struct Range {
    /// Temperatures from and to which it holds, K.
    pub(super) span: [f64; 2],
    /// a1 to a7.
    pub(super) a: [f64; 7],
    /// b1 and b2.
    pub(super) b: [f64; 2],
}

impl Range {
    /// cp/R.
    pub(super) fn heat_capacity(&self, t: f64) -> f64 {
        let a = &self.a;
        (a[0] / t + a[1]) / t + a[2] + t * (a[3] + t * (a[4] + t * (a[5] + t * a[6])))
    }

    /// H/RT.
    pub(super) fn enthalpy(&self, t: f64) -> f64 {
        let a = &self.a;
        (-a[0] / t + a[1] * t.ln() + self.b[0]) / t
            + a[2]
            + t * (a[3] / 2.0 + t * (a[4] / 3.0 + t * (a[5] / 4.0 + t * a[6] / 5.0)))
    }

    /// S/R.
    pub(super) fn entropy(&self, t: f64) -> f64 {
        let a = &self.a;
        (-a[0] / (2.0 * t) - a[1]) / t
            + a[2] * t.ln()
            + t * (a[3] + t * (a[4] / 2.0 + t * (a[5] / 3.0 + t * a[6] / 4.0)))
            + self.b[1]
    }

    /// The same range with H and S taken on from the end of `before`. The published ranges meet to 1e-6 of RT; sewn
    /// together, enthalpies rise without steps and stay the exact derivatives of free energies.
    fn sewn_to(mut self, before: &Self) -> Self {
        let end = before.span[1];
        self.b[0] += (before.enthalpy(end) - self.enthalpy(end)) * end;
        self.b[1] += before.entropy(end) - self.entropy(end);
        self
    }

    /// The range from the end of this one to any temperature, whose cp/R goes to `limit`.
    fn continued(&self, limit: f64) -> Self {
        let end = self.span[1];
        let next = Self {
            span: [end, f64::INFINITY],
            a: [
                (self.heat_capacity(end) - limit) * end * end,
                0.0,
                limit,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
            b: [0.0; 2],
        };
        next.sewn_to(self)
    }
}

/// Each range sewn to the one before.
fn sewn(ranges: Vec<Range>) -> Vec<Range> {
    let mut done: Vec<Range> = Vec::with_capacity(ranges.len() + 1);
    for range in ranges {
        let next = match done.last() {
            Some(before) => range.sewn_to(before),
            None => range,
        };
        done.push(next);
    }
    done
}

/// A fit of a species over ranges of temperature.
#[derive(Debug, Clone)]
pub(super) struct Nasa9 {
    /// Ranges in ascending order; the last ends at infinity.
    ranges: Vec<Range>,
    /// Enthalpy of the ground state at rest over R, K.
    ground: f64,
    /// ln of kT/p0 (2 pi m kT/h^2)^(3/2) / T^(5/2).
    flight: f64,
}

impl Nasa9 {
    /// A fit with its continuation; `ground` is H0 in J/mol on the fit's scale, `mass` in kg. `table` holds
    /// temperatures and partition functions of another source: where it reaches beyond the fit, the continuation
    /// multiplies Q by as much as the table does from the fit's end to its own; without it, cp stays as it is.
    pub(super) fn new(ranges: Vec<Range>, ground: f64, mass: f64, table: &[(f64, f64)]) -> Self {
        let per_kelvin = 2.0 * std::f64::consts::PI * mass * BOLTZMANN / (PLANCK * PLANCK);
        let mut fit = Self {
            ranges: sewn(ranges),
            ground: ground / GAS_CONSTANT,
            flight: (BOLTZMANN / STANDARD_PRESSURE).ln() + 1.5 * per_kelvin.ln(),
        };
        if let Some(last) = fit.ranges.last().cloned() {
            let constant = last.heat_capacity(last.span[1]);
            let limit = fit.limit_of_table(&last, table).unwrap_or(constant);
            fit.ranges.push(last.continued(limit));
        }
        fit
    }

    /// The limit of cp/R with which the continuation of `last` multiplies Q as `table` does; ln Q is linear in it.
    fn limit_of_table(&self, last: &Range, table: &[(f64, f64)]) -> Option<f64> {
        let start = last.span[1];
        let first = table
            .iter()
            .find(|(t, _)| (t - start).abs() < 1e-9 * start)?;
        let end = table.last().filter(|(t, _)| *t > start)?;
        let gain = |limit| {
            let next = last.continued(limit);
            self.read(&next, end.0).ln_partition - self.read(&next, start).ln_partition
        };
        let (none, one) = (gain(0.0), gain(1.0));
        Some(((end.1 / first.1).ln() - none) / (one - none))
    }

    fn read(&self, range: &Range, t: f64) -> Internal {
        let enthalpy = range.enthalpy(t) - self.ground / t;
        Internal {
            ln_partition: range.entropy(t) - enthalpy - self.flight - 2.5 * t.ln(),
            energy: BOLTZMANN * t * (enthalpy - 2.5),
            heat_capacity: BOLTZMANN * (range.heat_capacity(t) - 2.5),
        }
    }

    fn range(&self, t: f64) -> &Range {
        let after = self.ranges.partition_point(|range| range.span[1] < t);
        &self.ranges[after.min(self.ranges.len() - 1)]
    }

    pub(super) fn internal(&self, t: f64) -> Internal {
        self.read(self.range(t), t)
    }
}
