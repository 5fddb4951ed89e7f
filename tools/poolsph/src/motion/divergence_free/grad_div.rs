//! Damping of the divergence that a step leaves (grad-div stabilisation; Olshanskii and Reusken 2004).
//!
//! The equation of the pressure is compact: its Laplacian is not the divergence of the gradient. In disorder some velocities
//! gain divergence by their own pressure, up to a fifth in each step, and such clouds burst. So each step ends with
//!
//! ```text
//! u <- u - alpha D^T D u        (D u)_a = B_a : sum_b s x_ab (u_b - u_a)
//! ```
//!
//! with the B of the present neighbours, at the surface as well unless tension acts: there the pressure makes another divergence
//! zero (see [`operators`](super::operators)), and damping this one would take it back in each step, and the swing of a drop with it. D is zero for a linear flow without divergence. As D^T D is
//! symmetric and not negative, energy can only fall. Momentum and angular momentum are kept: D of a translation or a
//! rotation is zero.

use kernels::moments::{Moments, times};
use shapes::frame::{along, difference, dot};

use super::interface::Interface;
use super::operators::Sums;
use crate::near::{Near, Role};

/// alpha in d^2. The largest value of D D^T is some 5/d^2 in disorder and at edges; twice its inverse would overshoot.
const STRENGTH: f64 = 0.2;

/// Scratch, in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub(super) struct GradDiv {
    /// u, images included \[m/s\], `[m + images]`.
    moved: Vec<[f64; 3]>,
    /// (D u) B: xx, yy, zz, xy, xz, yz \[m3/s\], `[m + images]`.
    stretched: Vec<Moments>,
    change: Vec<[f64; 3]>,
}

impl GradDiv {
    /// Damps the divergence of `u` by the operators of `rows`, between particles `d` apart \[m\], beside an `interface` by
    /// its own.
    pub(super) fn damp(
        &mut self,
        near: &Near,
        rows: &[Sums],
        d: f64,
        interface: &mut Interface,
        u: &mut [[f64; 3]],
    ) {
        self.change(near, rows, interface, u);
        let part = STRENGTH * d * d;
        for (a, (u, change)) in u.iter_mut().zip(&self.change).enumerate() {
            *u = along(*u, part / near.heaviness(a), *change);
        }
    }

    /// Finds -D^T D u; of two liquids that of D^T rho D u, over the density of the metal.
    fn change(&mut self, near: &Near, rows: &[Sums], interface: &mut Interface, u: &[[f64; 3]]) {
        self.moved.clear();
        self.moved.extend_from_slice(u);
        near.complete(&mut self.moved, |u, _, turn| turn.vector(u));
        let tense = !near.tension.is_empty();
        let counts = |a: usize| !(tense && rows[a].missing > 0.0);
        if near.liquids.is_some() {
            interface.damp(near, &self.moved, counts, &mut self.change);
            return;
        }
        self.diverge(near, rows, counts);
        let stretched = &self.stretched;
        self.change.resize(near.len(), [0.0; 3]);
        near.each_row(
            &mut self.change,
            #[inline(always)]
            |a, row, change| {
                *change = [0.0; 3];
                if near.role[a] != Role::Liquid {
                    return;
                }
                let own = stretched[a];
                for (b, slope) in row.slopes() {
                    // What is solid mirrors the velocity of the particle itself.
                    let other = if near.role[b].flows() {
                        stretched[b]
                    } else {
                        own
                    };
                    let both = std::array::from_fn(|i| own[i] + other[i]);
                    let x = difference(near.position[a], near.position[b]);
                    *change = along(*change, slope, times(both, x));
                }
            },
        );
    }

    /// Finds (D u) B.
    fn diverge(&mut self, near: &Near, rows: &[Sums], counts: impl Fn(usize) -> bool + Sync) {
        let moved = &self.moved;
        self.stretched.resize(near.len(), [0.0; 6]);
        near.each_row(
            &mut self.stretched,
            #[inline(always)]
            |a, row, stretched| {
                *stretched = [0.0; 6];
                if near.role[a] != Role::Liquid || !counts(a) {
                    return;
                }
                let inverse = rows[a].present;
                let mut divergence = 0.0;
                for (b, slope) in row.slopes() {
                    let step = if near.role[b].flows() {
                        difference(moved[b], moved[a])
                    } else {
                        moved[a].map(|u| -2.0 * u)
                    };
                    let x = difference(near.position[a], near.position[b]);
                    divergence += slope * dot(times(inverse, x), step);
                }
                *stretched = inverse.map(|x| divergence * x);
            },
        );
        near.complete(&mut self.stretched, |[a, b, c, d, e, f], _, turn| {
            let [x, y, z] = turn.vector([1.0; 3]);
            [a, b, c, x * y * d, x * z * e, y * z * f]
        });
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        (24 + 48) * self.moved.capacity() + 24 * self.change.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::divergence_free::filled::Filled;
    use crate::motion::tests::{METAL, block};
    use crate::state::phase;
    use shapes::frame::{cross, squared};

    /// A block of disordered particles in mm, its operators, and random velocities.
    fn cloud(cells: i32) -> (Near, Vec<Sums>, Vec<[f64; 3]>) {
        let mut state = block([cells; 3], |_| phase::LIQUID, |_| [0.0; 3]);
        let mut seed = 5_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for x in state
            .metal
            .column_mut(&particles::POSITION)
            .iter_mut()
            .flatten()
        {
            *x += 0.5 * METAL.spacing * random();
        }
        state.gather();
        let near = state.near.clone();
        let u: Vec<[f64; 3]> = near
            .position
            .iter()
            .map(|_| [0; 3].map(|_| random()))
            .collect();
        let mut rows = vec![Sums::default(); near.len()];
        let filled = Filled::of(METAL);
        near.each_row(&mut rows, |a, row, out| {
            *out = Sums::of(&near, a, row, filled);
            out.flow(&near, &u, a, row);
        });
        (near, rows, u)
    }

    fn damped(near: &Near, rows: &[Sums], u: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut damped = u.to_vec();
        GradDiv::default().damp(
            near,
            rows,
            METAL.spacing,
            &mut Interface::default(),
            &mut damped,
        );
        damped
    }

    #[test]
    fn momentum_is_kept_and_energy_falls() {
        let (near, rows, u) = cloud(6);
        let after = damped(&near, &rows, &u);
        let (mut sum, mut turned, mut size) = ([0.0; 3], [0.0; 3], 0.0);
        for (a, (after, before)) in after.iter().zip(&u).enumerate() {
            let change = difference(*after, *before);
            sum = along(sum, 1.0, change);
            turned = along(turned, 1.0 / METAL.spacing, cross(near.position[a], change));
            size += squared(change).sqrt();
        }
        assert!(size > 1.0, "{size}");
        for x in sum.into_iter().chain(turned) {
            assert!(x.abs() < 1e-6 * size, "{sum:?} {turned:?} {size}");
        }
        let energy = |u: &[[f64; 3]]| u.iter().map(|u| squared(*u)).sum::<f64>();
        assert!(energy(&after) < 0.98 * energy(&u));
    }

    #[test]
    fn a_linear_flow_without_divergence_is_left_as_it_is() {
        let (near, rows, _) = cloud(10);
        let turn = [[1.0, 2.0, -3.0], [0.5, -4.0, 2.0], [7.0, 1.0, 3.0]];
        let u: Vec<[f64; 3]> = near
            .position
            .iter()
            .map(|x| turn.map(|line| dot(line, *x)))
            .collect();
        let fastest = u.iter().map(|u| squared(*u)).fold(0.0, f64::max).sqrt();
        // What hangs on neighbours that are few is left out: there B is the lattice's.
        let mut inner = 0;
        for (a, (after, before)) in damped(&near, &rows, &u).iter().zip(&u).enumerate() {
            if near.position[a]
                .iter()
                .all(|x| (3.7..6.3).contains(&(x / METAL.spacing)))
            {
                assert!(squared(difference(*after, *before)).sqrt() < 1e-6 * fastest);
                inner += 1;
            }
        }
        assert!(inner > 4, "{inner}");
    }
}
