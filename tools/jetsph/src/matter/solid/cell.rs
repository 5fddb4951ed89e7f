//! Forces of one cell of a solid on the derivatives of its deformation.
//!
//! The energy of a cell is that of its middle and of the strain that varies across it,
//!
//! ```text
//! E_i = V [ psi(F) + 1/2 sum_k M_k e_k : C' : e_k ],   e_k = sym(F^T dF/dX_k),   M_k = d_k^2/12
//! ```
//!
//! the second moments M_k of the cell taken exactly (Hillman and Chen 2016, naturally stabilised nodal integration, here
//! with the Green strain, so that turning costs nothing). The second term gives each row its own bending stiffness, so
//! that a bar of few rows is as stiff as it should, and leaves no motion of the lattice without energy, so that nothing
//! is needed against hourglass modes. C' takes the shear modulus, and of the other constant no more than keeps a nearly
//! incompressible solid from locking: volume is then kept per cell, not in every part of it.

use super::law::Law;
use super::quadratic::second;
use super::tensor::{Matrix, UNIT, product, transposed_times};

/// lambda' is at most so many shear moduli.
const LAME_MOST: f64 = 2.0;

/// A cell of the lattice and the law of its solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// The law.
    pub law: Law,
    /// V \[m3\], or \[m2\] in the plane.
    pub volume: f64,
    /// M_k, second moments over the volume along the axes of the lattice \[m2\].
    pub moment: [f64; 3],
    /// lambda' of the varying part \[Pa\].
    pub varying_lame: f64,
}

/// Derivatives of the deformation of a cell: columns of `T` terms, each with `L` components.
pub type Derivatives<const L: usize, const T: usize> = [[f64; L]; T];

/// Terms of a quadratic in the plane have two axes, those in space three.
#[inline(always)]
pub(super) const fn dimensions(terms: usize) -> usize {
    if terms == 5 { 2 } else { 3 }
}

/// F of first derivatives, completed by 1 across the plane.
#[inline(always)]
#[must_use]
pub fn gradient<const L: usize, const T: usize>(derivatives: &Derivatives<L, T>) -> Matrix {
    let mut f = UNIT;
    for i in 0..dimensions(T) {
        for j in 0..dimensions(T) {
            f[i][j] = derivatives[j][i];
        }
    }
    f
}

/// dF/dX_k.
#[inline(always)]
pub(super) fn slope<const L: usize, const T: usize>(
    derivatives: &Derivatives<L, T>,
    k: usize,
) -> Matrix {
    let mut f = [[0.0; 3]; 3];
    for i in 0..dimensions(T) {
        for j in 0..dimensions(T) {
            f[i][j] = derivatives[second(dimensions(T), k, j)][i];
        }
    }
    f
}

impl Cell {
    /// A cell of the given size \[m\].
    #[must_use]
    pub fn new(law: Law, size: [f64; 3], dimensions: usize) -> Self {
        let lame = if law.thin {
            2.0 * law.lame * law.shear / (law.lame + 2.0 * law.shear)
        } else {
            law.lame
        };
        Self {
            law,
            volume: size[..dimensions].iter().product(),
            moment: size.map(|d| d * d / 12.0),
            varying_lame: lame.min(LAME_MOST * law.shear),
        }
    }

    /// e_k and C' : e_k.
    #[inline(always)]
    fn varying(&self, f: &Matrix, slope: &Matrix, d: usize) -> (Matrix, Matrix) {
        let strain = Self::bending(f, slope);
        (strain, self.bent(&strain, d))
    }

    /// e_k = sym(F^T dF/dX_k). In the plane the slope is 0 across it.
    #[inline(always)]
    pub(super) fn bending(f: &Matrix, slope: &Matrix) -> Matrix {
        let both = transposed_times(f, slope);
        let mean = |i: usize, j: usize| 0.5 * (both[i][j] + both[j][i]);
        [
            [mean(0, 0), mean(0, 1), mean(0, 2)],
            [mean(1, 0), mean(1, 1), mean(1, 2)],
            [mean(2, 0), mean(2, 1), mean(2, 2)],
        ]
    }

    /// C' : e_k.
    #[inline(always)]
    pub(super) fn bent(&self, strain: &Matrix, d: usize) -> Matrix {
        let bulk = self.varying_lame * (strain[0][0] + strain[1][1] + strain[2][2]);
        let mut stress = strain.map(|row| row.map(|e| 2.0 * self.law.shear * e));
        (0..d).for_each(|k| stress[k][k] += bulk);
        stress
    }

    /// Slope of the energy with each derivative \[J\], \[J m\], and how many times stiffer the solid is than at rest.
    #[inline(always)]
    #[must_use]
    pub fn answer<const L: usize, const T: usize>(
        &self,
        derivatives: &Derivatives<L, T>,
    ) -> (Derivatives<L, T>, f64) {
        let d = dimensions(T);
        let f = self.law.completed(gradient(derivatives));
        let answer = self.law.answer(&f);
        let varying = std::array::from_fn(|k| {
            if k < d {
                self.varying(&f, &slope(derivatives, k), d).1
            } else {
                [[0.0; 3]; 3]
            }
        });
        let out = self.slopes(derivatives, &f, &answer.stress, &varying);
        (out, answer.stiffer)
    }

    /// Slopes of the energy by the stress P of the middle and the stresses that vary along each axis.
    #[inline(always)]
    pub(super) fn slopes<const L: usize, const T: usize>(
        &self,
        derivatives: &Derivatives<L, T>,
        f: &Matrix,
        middle: &Matrix,
        varying: &[Matrix; 3],
    ) -> Derivatives<L, T> {
        let d = dimensions(T);
        let mut out = [[0.0; L]; T];
        for (j, column) in out.iter_mut().enumerate().take(d) {
            (0..d).for_each(|i| column[i] = middle[i][j]);
        }
        for k in 0..d {
            let slope = slope(derivatives, k);
            let stress = &varying[k];
            let own = product(f, stress);
            let first = product(&slope, stress);
            for (j, column) in out.iter_mut().enumerate().take(d) {
                (0..d).for_each(|i| column[i] += self.moment[k] * first[i][j]);
            }
            for j in 0..d {
                let column = &mut out[second(d, k, j)];
                (0..d).for_each(|i| column[i] += self.moment[k] * own[i][j]);
            }
        }
        for column in &mut out {
            column.iter_mut().for_each(|x| *x *= self.volume);
        }
        out
    }

    /// Energy of the cell \[J\].
    #[must_use]
    pub fn energy<const L: usize, const T: usize>(&self, derivatives: &Derivatives<L, T>) -> f64 {
        let d = dimensions(T);
        let f = self.law.completed(gradient(derivatives));
        let mut energy = self.law.energy(&f);
        for k in 0..d {
            let (strain, stress) = self.varying(&f, &slope(derivatives, k), d);
            energy += 0.5 * self.moment[k] * super::tensor::inner(&strain, &stress);
        }
        self.volume * energy
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::{Elastic, Plane, Young};
    use super::*;

    fn cell(plane: Option<Plane>, dimensions: usize) -> Cell {
        let elastic = Elastic::Young(Young {
            youngs_modulus_pa: 2e6,
            poisson_ratio: 0.4,
        });
        Cell::new(Law::new(&elastic, plane), [0.01, 0.012, 0.009], dimensions)
    }

    fn answers_are_slopes<const L: usize, const T: usize>(cell: &Cell) {
        let d = dimensions(T);
        let mut derivatives = [[0.0; L]; T];
        for (m, column) in derivatives.iter_mut().enumerate() {
            for (i, x) in column.iter_mut().take(d).enumerate() {
                let scale = if m < d { 0.1 } else { 10.0 };
                *x = scale * ((3 * m + i) as f64).sin() + f64::from(u8::from(m == i));
            }
        }
        let (answer, _) = cell.answer(&derivatives);
        for m in 0..T {
            for i in 0..d {
                let step = if m < d { 1e-6 } else { 1e-4 };
                let (mut low, mut high) = (derivatives, derivatives);
                low[m][i] -= step;
                high[m][i] += step;
                let slope = (cell.energy(&high) - cell.energy(&low)) / (2.0 * step);
                let error = (slope - answer[m][i]).abs() / (slope.abs() + cell.volume);
                assert!(error < 1e-4, "{m} {i}: {slope} {}", answer[m][i]);
            }
        }
    }

    #[test]
    fn forces_are_slopes_of_the_energy() {
        answers_are_slopes::<4, 9>(&cell(None, 3));
        answers_are_slopes::<2, 5>(&cell(Some(Plane::Strain), 2));
        answers_are_slopes::<2, 5>(&cell(Some(Plane::Stress), 2));
    }
}
