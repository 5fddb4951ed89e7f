//! What hangs together, and what holds it.
//!
//! The gradient by differences is no sum of pair forces. What touches neither a wall nor a nozzle keeps its momentum: the
//! mean of its accelerations is taken away. What is held gives the whole of it to what holds it: to each wall and nozzle what pairs
//! across it tell, V_a V_b (p_a + p_b) grad W, and of what is left a share by the size of that. So does a solid beside the water;
//! there what is left is shared along the forces f that pairs tell, since water slips along all that holds it:
//!
//! ```text
//! c_h = W_h l + rest |f_h|/sum |f|,   W_h = f_h f_h/|f_h|,   (sum_h W_h + eps sum_h |f_h|) l = left
//! ```

use kernels::Kernel;

use super::operators::is_led;
use crate::matter::solid::tensor::{Matrix, UNIT, cofactor, determinant};
use crate::matter::water::around::Around;

/// Bodies of free water.
#[derive(Debug, Clone, Default)]
pub(super) struct Bodies {
    seen: Vec<bool>,
    /// Particles of one body after the other, in the order in which they were found.
    members: Vec<u32>,
    /// Where each of these ends in `members`.
    ends: Vec<usize>,
    /// Number of solids beside the water.
    solids: usize,
}

/// Force of the water on each wall, on each solid beside it, and on all nozzles last \[N\].
pub(super) type Forces = Vec<[f64; 3]>;

impl Bodies {
    /// None yet, beside a number of solids.
    pub(super) fn beside(solids: usize) -> Self {
        Self {
            solids,
            ..Self::default()
        }
    }

    /// Finds them.
    fn find<K: Kernel>(&mut self, around: &Around<K>) {
        let n = around.seen.len();
        self.seen.clear();
        self.seen.extend(around.seen.iter().map(is_led));
        self.members.clear();
        self.ends.clear();
        for a in 0..n {
            if !self.seen[a] {
                let mut next = self.members.len();
                self.seen[a] = true;
                self.members.push(a as u32);
                while let Some(b) = self.members.get(next).copied() {
                    around.each(b as usize, |c, _, _, _, _| {
                        if !std::mem::replace(&mut self.seen[c], true) {
                            self.members.push(c as u32);
                        }
                    });
                    next += 1;
                }
                self.ends.push(self.members.len());
            }
        }
    }

    /// Balances the `accelerations` by the pressure \[m/s2\] of free water of `density` \[kg/m3\]; `across` tells the forces of each particle on
    /// what it touches \[N\], as [`Forces`]. Gives what acts on each wall and on the nozzles.
    pub(super) fn balance<K: Kernel>(
        &mut self,
        around: &Around<K>,
        density: f64,
        accelerations: &mut [[f64; 3]],
        across: &[(u32, Forces)],
    ) -> Forces {
        self.find(around);
        let holders = around.bodies.len() + self.solids + 1;
        let mut touched = vec![u32::MAX; accelerations.len()];
        for (k, (a, _)) in across.iter().enumerate() {
            touched[*a as usize] = k as u32;
        }
        let mut total = vec![[0.0; 3]; holders];
        let mut begin = 0;
        for end in self.ends.iter().copied() {
            let body = &self.members[begin..end];
            begin = end;
            let (mut sum, mut mass) = ([0.0; 3], 0.0);
            let mut told: Forces = vec![[0.0; 3]; holders];
            let mut is_held = false;
            for a in body.iter().map(|a| *a as usize) {
                let own = density * around.seen[a].volume;
                mass += own;
                (0..3).for_each(|k| sum[k] += own * accelerations[a][k]);
                if let Some((_, forces)) = across.get(touched[a] as usize) {
                    is_held = true;
                    for (told, force) in told.iter_mut().zip(forces) {
                        (0..3).for_each(|k| told[k] += force[k]);
                    }
                }
            }
            let size = |f: &[f64; 3]| f.iter().map(|x| x * x).sum::<f64>().sqrt();
            let whole: f64 = told.iter().map(size).sum();
            // Water that has left a solid, and only seems to touch it, is held by nothing.
            if !is_held || (self.solids > 0 && whole <= 0.0) {
                let mean = sum.map(|x| x / mass);
                for a in body {
                    (0..3).for_each(|k| accelerations[*a as usize][k] -= mean[k]);
                }
                continue;
            }
            let left: [f64; 3] =
                std::array::from_fn(|k| -sum[k] - told.iter().map(|f| f[k]).sum::<f64>());
            let shares = if self.solids > 0 {
                along(&told, left)
            } else {
                let each = told.iter().map(|force| {
                    let share = if whole > 0.0 {
                        size(force) / whole
                    } else {
                        1.0 / holders as f64
                    };
                    left.map(|x| share * x)
                });
                each.collect()
            };
            for ((total, force), share) in total.iter_mut().zip(&told).zip(shares) {
                (0..3).for_each(|k| total[k] += force[k] + share[k]);
            }
        }
        total
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.seen.capacity() + 4 * self.members.capacity() + 8 * self.ends.capacity()
    }
}

/// eps.
const EVENLY: f64 = 1e-3;

/// Shares of what is `left` along the `told` forces, which are not all zero \[N\].
fn along(told: &[[f64; 3]], left: [f64; 3]) -> Forces {
    let size = |f: &[f64; 3]| f.iter().map(|x| x * x).sum::<f64>().sqrt();
    let whole: f64 = told.iter().map(size).sum();
    let mut sum: Matrix = UNIT.map(|row| row.map(|x| EVENLY * whole * x));
    for f in told.iter().filter(|f| size(f) > 0.0) {
        for (row, y) in sum.iter_mut().zip(f) {
            (0..3).for_each(|k| row[k] += y * f[k] / size(f));
        }
    }
    // It is symmetric, and so is what it is cofactor to.
    let (cofactors, scale) = (cofactor(&sum), determinant(&sum));
    let factors = cofactors.map(|row| (0..3).map(|k| row[k] * left[k]).sum::<f64>() / scale);
    let mut shares: Forces = told
        .iter()
        .map(|f| {
            let part: f64 = (0..3).map(|k| f[k] * factors[k]).sum();
            f.map(|x| part * x / size(f).max(f64::MIN_POSITIVE))
        })
        .collect();
    let rest: [f64; 3] =
        std::array::from_fn(|k| left[k] - shares.iter().map(|c| c[k]).sum::<f64>());
    for (share, f) in shares.iter_mut().zip(told) {
        (0..3).for_each(|k| share[k] += size(f) / whole * rest[k]);
    }
    shares
}
