//! The surface and fields on it near one of its points, as polynomials over a part of a sphere.
//!
//! A sphere of curvature k touches the surface at the point, its centre c on the normal. A neighbour x stands in the direction
//! `e = (x - c)/|x - c|` at the height `f = |x - c| - 1/k` (a circle in a plane; a plane where k = 0). Height and fields are fitted
//! over `(e . t1, e . t2)/k`, with tangents t1 and t2. At the point itself derivatives over these are derivatives along the
//! surface, and its second derivatives are those of f less k. What is left of a drop beside the sphere is small, and smooth as
//! far as a quarter of the way round: over the tangent plane a drop has a height with a root.

use nalgebra::{DMatrix, DVector};

use super::vector::{difference, dot, length};

/// Degree of the fit: curvature is then right to order 3, on even points to order 4.
const DEGREE: i32 = 4;

/// Exponents of the monomials of a fit in one or two variables, by degree.
pub(super) fn exponents(variables: usize) -> Vec<[i32; 2]> {
    let mut all = Vec::new();
    for degree in 0..=DEGREE {
        let last = if variables == 1 { 0 } else { degree };
        all.extend((0..=last).map(|second| [degree - second, second]));
    }
    all
}

/// Powers of a number up to that of the degree.
fn powers(x: f64) -> [f64; DEGREE as usize + 1] {
    let square = x * x;
    [1.0, x, square, x * square, square * square]
}

/// Points of a fit and the radius that holds them.
pub(super) struct Near {
    pub(super) points: Vec<u32>,
    pub(super) radius: f64,
    /// How far points of the surface stand apart, about \[m\].
    pub(super) spacing: f64,
}

/// The axes of a point: its normal, and those along the surface; the sphere that touches it there.
#[derive(Clone, Copy)]
pub(super) struct Frame<const D: usize> {
    pub(super) normal: [f64; D],
    pub(super) axes: [[f64; D]; 2],
    /// Curvature of the sphere, 1/R \[1/m\].
    pub(super) bow: f64,
}

/// Neighbours of a point over the sphere.
pub(super) struct Chart {
    bow: f64,
    /// Above the sphere \[m\].
    heights: Vec<f64>,
    /// Weights of the value, of d/dx, d/dy, d2/dx2, d2/dx dy and d2/dy2; zeros where there is no y.
    pub(super) weights: [Vec<f64>; 6],
}

impl Chart {
    /// The surface about `place`, where one of its points may stand.
    pub(super) fn new<const D: usize>(
        place: &[f64; D],
        points: &[[f64; D]],
        frame: Frame<D>,
        near: &Near,
        exponents: &[[i32; 2]],
    ) -> Self {
        let Frame { normal, axes, bow } = frame;
        let (many, terms) = (near.points.len(), exponents.len());
        let scale = near.radius.recip();
        let mut basis = DMatrix::<f64>::zeros(terms, many);
        let mut share = vec![0.0; many];
        let mut heights = vec![0.0; many];
        for (m, &j) in near.points.iter().enumerate() {
            let d = difference(&points[j as usize], place);
            let (x, y, z) = (dot(&d, &axes[0]), dot(&d, &axes[1]), dot(&d, &normal));
            // |x - c| k, without a difference of large numbers where k is small.
            let far = (bow * bow * (x * x + y * y) + (1.0 + bow * z).powi(2)).sqrt();
            heights[m] = (bow * dot(&d, &d) + 2.0 * z) / (1.0 + far);
            let (x, y) = (x * scale / far, y * scale / far);
            share[m] = wls::quartic(length(&d) * scale).max(1e-12);
            let (x, y) = (powers(x), powers(y));
            for (k, e) in exponents.iter().enumerate() {
                basis[(k, m)] = x[e[0] as usize] * y[e[1] as usize];
            }
        }
        let mut weighted = basis.clone();
        for (m, w) in share.iter().enumerate() {
            weighted.column_mut(m).scale_mut(*w);
        }
        let gram = &weighted * basis.transpose();
        let inverse = gram.clone().cholesky().map(|c| c.inverse());
        let inverse = inverse.or_else(|| gram.pseudo_inverse(1e-12).ok());
        let inverse = inverse.unwrap_or_else(|| DMatrix::zeros(terms, terms));
        let row = |exponent: [i32; 2], factor: f64| {
            let Some(k) = exponents.iter().position(|e| *e == exponent) else {
                return vec![0.0; many];
            };
            let coefficients: DVector<f64> = inverse.column(k) * factor;
            (weighted.tr_mul(&coefficients)).as_slice().to_vec()
        };
        let weights = [
            row([0, 0], 1.0),
            row([1, 0], scale),
            row([0, 1], scale),
            row([2, 0], 2.0 * scale * scale),
            row([1, 1], scale * scale),
            row([0, 2], 2.0 * scale * scale),
        ];
        Self {
            bow,
            heights,
            weights,
        }
    }

    /// Height of the surface along the normal at the point and its derivatives d/dx, d/dy, d2/dx2, d2/dx dy, d2/dy2 \[m, 1, 1/m\].
    pub(super) fn derivatives(&self, has_y: bool) -> [f64; 6] {
        let own = [
            0.0,
            0.0,
            0.0,
            self.bow,
            0.0,
            if has_y { self.bow } else { 0.0 },
        ];
        std::array::from_fn(|k| {
            let terms = self.heights.iter().zip(&self.weights[k]);
            terms.map(|(z, w)| z * w).sum::<f64>() - own[k]
        })
    }
}
