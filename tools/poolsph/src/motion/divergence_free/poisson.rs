//! Conjugate gradients with the diagonal for the equation of the pressure, in single precision.

use rayon::prelude::*;

use neighbours::ROWS;

use crate::motion::step::{Solved, Tolerance};
use crate::near::{Liquids, Near, Role};
use crate::sweep::GRAIN;

/// Chunks of rows per unit of parallel work.
const CHUNKS: usize = GRAIN / ROWS;

/// Rows of sum of w (p_a - p_b) + ... = right; zero for solid particles.
#[derive(Debug, Clone, Default)]
pub(super) struct Poisson {
    /// Diagonal \[1/m5\] and right side \[Pa/m5\], `[m]`.
    pub(super) equations: Vec<[f32; 2]>,
    /// No particle lies at a surface.
    pub(super) closed: bool,
    /// Change of volume within a step for a residual of 1 \[m5/Pa\].
    scale: f64,
    residual: Vec<f32>,
    direction: Vec<f32>,
    product: Vec<f32>,
    /// Sums over chunks of rows.
    partial: Vec<[f64; 2]>,
}

impl Poisson {
    /// Room for `n` rows.
    pub(super) fn resize(&mut self, n: usize, scale: f64) {
        self.scale = scale;
        self.equations.resize(n, [0.0; 2]);
        for column in [&mut self.residual, &mut self.direction, &mut self.product] {
            column.resize(n, 0.0);
        }
        self.partial.resize(n.div_ceil(ROWS), [0.0; 2]);
    }

    /// Improves `p` until the mean change of volume that is left is within the tolerance.
    pub(super) fn solve(&mut self, near: &Near, p: &mut Vec<f32>, tolerance: Tolerance) -> Solved {
        let liquid = near.liquid_count().max(1) as f64;
        if self.closed {
            self.level(liquid, p);
        }
        near.complete(p, |p, _, _| p);
        multiply(near, &self.equations, p, &mut self.product);
        let rows = self.residual.par_iter_mut().zip(&self.equations);
        rows.zip(&self.product)
            .with_min_len(GRAIN)
            .for_each(|((residual, [_, right]), product)| *residual = right - product);
        self.direction.fill(0.0);
        let mut solved = Solved::default();
        let mut last = 0.0;
        let [mut left, mut square] = self.go(0.0, p);
        loop {
            solved.density_error = self.scale * left / liquid;
            let enough =
                solved.sweeps >= tolerance.sweeps_min && solved.density_error <= tolerance.density;
            if enough || solved.sweeps >= tolerance.sweeps_max || square <= 0.0 {
                break;
            }
            self.turn(if last > 0.0 { square / last } else { 0.0 });
            last = square;
            near.complete(&mut self.direction, |p, _, _| p);
            multiply(near, &self.equations, &self.direction, &mut self.product);
            let bend = self.bend();
            if bend <= 0.0 {
                break;
            }
            [left, square] = self.go((last / bend) as f32, p);
            solved.sweeps += 1;
        }
        near.complete(p, |p, _, _| p);
        solved
    }

    /// Without a surface the pressure is known but for a constant, and what the right sides sum to cannot be met: their
    /// mean is taken away, and that of the pressure.
    fn level(&mut self, liquid: f64, p: &mut [f32]) {
        let rights = self.equations.chunks(ROWS);
        let rights =
            rights.map(|rows| rows.iter().map(|[_, right]| f64::from(*right)).sum::<f64>());
        let mean = (rights.sum::<f64>() / liquid) as f32;
        for [diagonal, right] in &mut self.equations {
            if *diagonal > 0.0 {
                *right -= mean;
            }
        }
        let rows = self.equations.iter().zip(p);
        let mut p: Vec<&mut f32> = rows
            .filter(|([d, _], _)| *d > 0.0)
            .map(|(_, p)| p)
            .collect();
        let sum: f64 = p.iter().map(|p| f64::from(**p)).sum();
        p.iter_mut().for_each(|p| **p -= (sum / liquid) as f32);
    }

    /// direction = residual/diagonal + part direction.
    fn turn(&mut self, part: f64) {
        let part = part as f32;
        let rows = self.direction.par_iter_mut().zip(&self.equations);
        rows.zip(&self.residual).with_min_len(GRAIN).for_each(
            |((direction, [diagonal, _]), residual)| {
                let steep = if *diagonal > 0.0 {
                    residual / diagonal
                } else {
                    0.0
                };
                *direction = steep + part * *direction;
            },
        );
    }

    /// p + way direction, and the residual there. Gives the sums of its magnitudes and of its squares over the diagonal.
    fn go(&mut self, way: f32, p: &mut [f32]) -> [f64; 2] {
        let rows = self.partial.par_iter_mut();
        let rows = rows.zip(self.residual.par_chunks_mut(ROWS));
        rows.zip(p.par_chunks_mut(ROWS))
            .zip(self.equations.par_chunks(ROWS))
            .zip(self.direction.par_chunks(ROWS))
            .zip(self.product.par_chunks(ROWS))
            .with_min_len(CHUNKS)
            .for_each(
                |(((((sums, residual), p), equations), direction), product)| {
                    let columns = residual.iter_mut().zip(p).zip(equations);
                    let columns = columns.zip(direction).zip(product);
                    *sums = [0.0; 2];
                    for ((((residual, p), [diagonal, _]), direction), product) in columns {
                        *p += way * direction;
                        *residual -= way * product;
                        let r = f64::from(*residual);
                        sums[0] += r.abs();
                        if *diagonal > 0.0 {
                            sums[1] += r * r / f64::from(*diagonal);
                        }
                    }
                },
            );
        let sums = self.partial.iter();
        sums.fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]])
    }

    /// Sum of direction times product.
    fn bend(&mut self) -> f64 {
        let rows = self.partial.par_iter_mut();
        rows.zip(self.direction.par_chunks(ROWS))
            .zip(self.product.par_chunks(ROWS))
            .with_min_len(CHUNKS)
            .for_each(|((sum, direction), product)| {
                let terms = direction.iter().zip(product);
                sum[0] = terms.map(|(d, p)| f64::from(*d) * f64::from(*p)).sum();
            });
        self.partial.iter().map(|sum| sum[0]).sum()
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        (8 + 3 * 4) * self.equations.capacity()
    }
}

/// diagonal p_a - sum of w beta p_b of two liquids.
fn multiply_both(near: &Near, both: &Liquids, equations: &[[f32; 2]], p: &[f32], out: &mut [f32]) {
    near.each_row(out, |a, row, out| {
        *out = 0.0;
        if near.role[a] == Role::Liquid {
            let shares = both.shares(a);
            let rows = row.index.iter().map(|b| *b as usize).zip(row.slope);
            let sum = rows.fold(0.0_f32, |sum, (b, slope)| {
                sum + slope * shares[usize::from(both.is_slag(b))] * p[b]
            });
            *out = equations[a][0] * p[a] + sum;
        }
    });
}

/// diagonal p_a - sum of w p_b; `p` is zero for solid particles.
fn multiply(near: &Near, equations: &[[f32; 2]], p: &[f32], out: &mut [f32]) {
    if let Some(both) = &near.liquids {
        return multiply_both(near, both, equations, p, out);
    }
    near.each_row(
        out,
        #[inline(always)]
        |a, row, out| {
            *out = 0.0;
            if near.role[a] == Role::Liquid {
                let mut parts = [0.0_f32; 4];
                let ((fours, rest), (slopes, last)) =
                    (row.index.as_chunks::<4>(), row.slope.as_chunks::<4>());
                for (b, s) in fours.iter().zip(slopes) {
                    for k in 0..4 {
                        parts[k] += s[k] * p[b[k] as usize];
                    }
                }
                for (b, s) in rest.iter().zip(last) {
                    parts[0] += s * p[*b as usize];
                }
                *out = equations[a][0] * p[a] + ((parts[0] + parts[1]) + (parts[2] + parts[3]));
            }
        },
    );
}
