//! Shifting of particles to where they lie evenly (Lind, Xu, Stansby and Rogers 2012).
//!
//! ```text
//! dx_a = -D sum_b V_b grad W_ab        D = d^2 min(8 u dt/d, 0.3)
//! ```
//!
//! with the speed u of neighbours against one another: a cloud is made even as fast as it can be made uneven, and what
//! moves as a whole stays. Near the surface particles are shifted along it alone (Lind et al., eq. 27). Inside, what is shifted gets
//! the velocity of the place to which it comes, u + dx.grad u (Xu, Stansby and Laurence 2009, eq. 22), less the mean of
//! these changes, so that momentum is kept.

use kernels::Kernel;
use particles::sweep;

use super::operators::{Sums, is_led};
use crate::matter::water::around::Around;

/// D in d^2 for a way of one spacing in a step, and its bound (a half would overshoot).
const STRENGTH: [f64; 2] = [8.0, 0.3];
/// Longest shift in spacings.
const FARTHEST: f64 = 0.05;
/// Part of the lattice's weight below which a particle is near the surface.
const RIM: f64 = 0.97;

/// Shifts \[m\] and changes of velocity \[m/s\] of all particles; `way` is how far neighbours go against one another in a
/// step, in spacings of `d` \[m\].
pub(super) fn shifts<K: Kernel>(
    around: &Around<K>,
    rows: &[Sums],
    way: f64,
    d: f64,
) -> Vec<([f64; 3], [f64; 3])> {
    let [gain, most] = STRENGTH;
    let reach = d * d * (gain * way).min(most);
    let mut shifts = vec![([0.0; 3], [0.0; 3]); rows.len()];
    sweep::fill(&mut shifts, |a| {
        if is_led(&around.seen[a]) {
            return ([0.0; 3], [0.0; 3]);
        }
        let mut shift = rows[a].inwards.map(|x| -reach * x);
        let inside = rows[a].fill >= RIM;
        if !inside {
            let normal = normal(around, rows, a);
            let out: f64 = (0..3).map(|k| shift[k] * normal[k]).sum();
            (0..3).for_each(|k| shift[k] -= out * normal[k]);
        }
        let size = shift.iter().map(|x| x * x).sum::<f64>().sqrt();
        let part = (FARTHEST * d / size.max(f64::MIN_POSITIVE)).min(1.0);
        let shift = shift.map(|x| part * x);
        let along = |k: usize| (0..3).map(|i| shift[i] * rows[a].slope[i][k]).sum();
        let change = if inside {
            [0, 1, 2].map(along)
        } else {
            [0.0; 3]
        };
        (shift, change)
    });
    let [count, sums @ ..] = sweep::sum(rows.len(), |a| {
        let (volume, [x, y, z]) = (around.seen[a].volume, shifts[a].1);
        let counts = if is_inside(around, rows, a) {
            volume
        } else {
            0.0
        };
        [counts, volume * x, volume * y, volume * z]
    });
    if count > 0.0 {
        let mean = sums.map(|sum| sum / count);
        sweep::change(&mut shifts, |a, (_, change)| {
            if is_inside(around, rows, a) {
                (0..3).for_each(|k| change[k] -= mean[k]);
            }
        });
    }
    shifts
}

fn is_inside<K>(around: &Around<K>, rows: &[Sums], a: usize) -> bool {
    !is_led(&around.seen[a]) && rows[a].fill >= RIM
}

/// Unit normal of the surface near a particle: the kernel mean of the slopes of the colour around.
fn normal<K: Kernel>(around: &Around<K>, rows: &[Sums], a: usize) -> [f64; 3] {
    let own = around.seen[a].volume * around.kernel.value(0.0);
    let mut sum = rows[a].inwards.map(|x| own * x);
    around.each(a, |b, other, _, square, _| {
        if rows[b].fill < RIM {
            let weight = other.volume * around.kernel.value(square.sqrt());
            (0..3).for_each(|k| sum[k] += weight * rows[b].inwards[k]);
        }
    });
    let size = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
    sum.map(|x| x / size.max(f64::MIN_POSITIVE))
}
