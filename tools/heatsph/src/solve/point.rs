//! How far a point goes with a step of Newton's method, by its own balance.

use crate::system::System;
use crate::system::storage::{self, Storage};

/// Iterations for a temperature from a rise of the integral of conductivity.
const INVERSION: usize = 60;

/// What a point's own balance does with a change of its temperature, as far as that is known without its neighbours.
#[derive(Clone, Copy)]
pub(super) struct Own<'a> {
    /// One over a time \[1/s\].
    pub(super) shift: f64,
    /// \[W/K\], of each point.
    pub(super) stiffness: &'a [f64],
}

impl Own<'_> {
    /// The temperature of point `i` after a change of it.
    pub(super) fn moved(&self, system: &System, i: usize, from: f64, change: f64) -> f64 {
        match &system.storage {
            Storage::Varies(content) if self.shift > 0.0 => {
                self.stored(system, content, i, from, change)
            }
            _ => conducted(system, i, from, change),
        }
    }

    /// The change is one of the heat that the point stores and conducts, `shift E(T) + stiffness theta(T) / k`: where
    /// capacity has a peak, a temperature stops in it as long as there is no heat for more.
    fn stored(
        &self,
        system: &System,
        content: &storage::Content,
        i: usize,
        from: f64,
        change: f64,
    ) -> f64 {
        let (capacity, heat) = content.at(i, from);
        let k = system.conductivity(i, from);
        let stiffness = self.stiffness[i];
        let wanted = (self.shift * capacity + stiffness) * change;
        let of = |t: f64| {
            let (capacity, now) = content.at(i, t);
            let mean = system.mean_conductivity(i, from, t) / k;
            let own = system.conductivity(i, t) / k;
            let value = self.shift * (now - heat) + stiffness * mean * (t - from);
            (self.shift * capacity + stiffness * own, value)
        };
        let to = storage::solve(wanted, from, of);
        if to.is_finite() { to } else { from + change }
    }
}

/// The temperature of point `i` after a change that is a change of the integral of conductivity: with it, the
/// steady state of any k(T) is a linear problem.
fn conducted(system: &System, i: usize, from: f64, change: f64) -> f64 {
    if system.conduction().is_fixed() {
        return from + change;
    }
    let rise = system.conductivity(i, from) * change;
    let mut to = from + change;
    for _ in 0..INVERSION {
        let error = rise - system.mean_conductivity(i, from, to) * (to - from);
        let step = error / system.conductivity(i, to);
        to += step;
        if step.abs() <= 1e-13 * (to.abs() + from.abs()) {
            break;
        }
    }
    if to.is_finite() { to } else { from + change }
}
