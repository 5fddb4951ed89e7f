//! The pressure at walls, and the one that pushes.
//!
//! A projection takes |dt/rho grad p|^2 from the square of the velocity in each step: a flow that turns loses its energy with
//! the first order of the step. A reflection takes nothing, and (1 - r)/(1 + r) of that with a rest. Without a surface
//! the velocity is reflected (Zehnder, Narain and Thomaszewski 2018):
//!
//! ```text
//! u = u* - (1 + r) dt/rho grad p
//! ```
//!
//! What p has in common with that of the last step pushes twice, so that an impact pushes once. What presses upon a surface is
//! no part of what keeps the volume, and would act twice: there the velocity is projected.

use shapes::frame::{difference, dot};

use super::DivergenceFree;
use crate::motion::step::Step;
use crate::near::{Near, Role};

/// r: part of the pressure that pushes once more without a surface.
const REFLECTED: f64 = 0.9;

impl DivergenceFree {
    /// p + rho f.(x_w - x_b) at solid particles w, the mean over their liquid neighbours b (Adami, Hu and Adams 2012,
    /// eq. 27), with the acceleration f of the prediction; beyond faces that mirror, from each particle to its image.
    pub(super) fn reach_walls(&mut self, near: &Near, step: Step) {
        let mut total = std::mem::take(&mut self.total);
        let mut beyond = std::mem::take(&mut self.interface.beyond);
        let own = |a: usize| f64::from(self.pressure[a]);
        self.reach(near, step, own, false, &mut total);
        if near.liquids.is_some() {
            self.reach(near, step, own, true, &mut beyond);
        }
        (self.total, self.interface.beyond) = (total, beyond);
    }

    /// Whether the velocity is reflected.
    pub(super) fn reflects(&self, near: &Near) -> bool {
        self.poisson.closed && near.tension.is_empty() && near.liquids.is_none()
    }

    /// The pressure that pushes: p, and once more what it has in common with that of the last step. Impacts push once.
    pub(super) fn reflect(&mut self, near: &Near, step: Step) {
        let (pressure, last) = (&self.pressure, &self.last);
        let mut pushing = std::mem::take(&mut self.pushing);
        let push = |a: usize| {
            let [now, before] = [pressure[a], last[a]].map(f64::from);
            now + REFLECTED * common(now, before)
        };
        self.reach(near, step, push, false, &mut pushing);
        self.pushing = pushing;
    }

    /// What `pressure` of the liquid makes at walls, as [`DivergenceFree::reach_walls`] says; of two liquids what `slag`, or else the
    /// metal, sees there, by the other only where a wall touches none of its own.
    fn reach(
        &self,
        near: &Near,
        step: Step,
        pressure: impl Fn(usize) -> f64 + Sync,
        slag: bool,
        total: &mut Vec<f64>,
    ) {
        let change = &self.change;
        let inertia = |a: usize| near.density(a) / step.dt;
        let both = near.liquids.as_ref();
        let alike = |b: usize| both.is_none_or(|both| both.is_slag(b) == slag);
        total.resize(near.len(), 0.0);
        near.each_row(total, |a, row, out| {
            *out = pressure(a);
            if near.role[a] == Role::Wet {
                let (mut own, mut other) = ([0.0; 2], [0.0; 2]);
                for (b, slope) in row.slopes().filter(|(b, _)| near.role[*b].flows()) {
                    let way = difference(near.position[a], near.position[b]);
                    let original = near.images().original(b);
                    let p = pressure(original) + inertia(original) * dot(change[b], way);
                    if alike(b) {
                        own = [own[0] - slope * p, own[1] - slope];
                    } else {
                        let p = p + self.seen(near, original, near.position[a]);
                        other = [other[0] - slope * p, other[1] - slope];
                    }
                }
                let [sum, weight] = if own[1] > 0.0 { own } else { other };
                *out = if weight > 0.0 { sum / weight } else { 0.0 };
            }
        });
        near.complete(total, |p, image, turn| {
            let of = near.images().original(image);
            p + inertia(of) * dot(change[of], turn.across(near.position[of]))
        });
    }

    /// What the other liquid than that of the particle `b` has more of p' at the place `x` for the same p.
    fn seen(&self, near: &Near, b: usize, x: [f64; 3]) -> f64 {
        let Some(both) = &near.liquids else {
            return 0.0;
        };
        let [metal, slag] = both
            .densities()
            .map(|density| density / both.densities()[0]);
        let other = if both.is_slag(b) { metal } else { slag };
        (near.heaviness(b) - other) * self.weight.of_metal(&self.islands, b, x)
    }
}

/// What two values have in common: the smaller one of the same sign.
fn common(a: f64, b: f64) -> f64 {
    if a * b <= 0.0 {
        0.0
    } else if a.abs() < b.abs() {
        a
    } else {
        b
    }
}

#[cfg(test)]
mod tests {
    use super::common;

    #[test]
    fn what_changes_its_sign_has_nothing_in_common() {
        for (a, b, asked) in [
            (2.0, 3.0, 2.0),
            (-3.0, -2.0, -2.0),
            (2.0, -1.0, 0.0),
            (0.0, 5.0, 0.0),
        ] {
            assert!((common(a, b) - asked).abs() <= 0.0);
        }
    }
}
