//! What the liquid brings to points that do not move with it: `((w - u) . grad) f` of a field f.
//!
//! The liquid that passes a point brings what is smooth: as much of f as passes of a spacing in a second goes over into the value of
//! the fit. Sums without a side would let ripples grow that fits do not see.

use std::ops::Range;

use rayon::prelude::*;
use wls::Stencils;

use super::surface::Patch;
use super::vector::{across, along, dot, length};

/// At the points of a surface, past which the liquid slides at `-back`; of one field f or several at once.
#[must_use]
pub fn along_surface<const D: usize, const C: usize>(
    patches: &[Patch<D>],
    f: &[[f64; C]],
    back: impl Fn(usize) -> [f64; D],
) -> Vec<[f64; C]> {
    let at = |(i, patch): (usize, &Patch<D>)| {
        let back = across(&back(i), &patch.normal);
        let width = patch.area.powf(((D - 1) as f64).recip());
        let passed = length(&back) / width;
        let mut sum = f[i].map(|c| -passed * c);
        for (m, &j) in patch.neighbours.iter().enumerate() {
            let weight = dot(&back, &patch.slope[m]) + passed * patch.value[m];
            sum = along(&sum, weight, &f[j as usize]);
        }
        sum
    };
    patches.iter().enumerate().map(at).collect()
}

/// At a range of points inside that follow the surface, by rows of slopes and of values of fits.
#[must_use]
pub fn inside<const D: usize, const C: usize>(
    (rows, fits): (&Stencils<D>, &Stencils<D>),
    f: &[[f64; C]],
    back: impl Fn(usize) -> [f64; D] + Sync,
    (range, spacing): (Range<usize>, f64),
) -> Vec<[f64; C]> {
    range
        .into_par_iter()
        .map(|i| {
            let back = back(i);
            let passed = length(&back) / spacing;
            let mut sum = f[i].map(|c| -passed * c);
            for (j, weight) in fits.value(i).iter() {
                sum = along(&sum, passed * weight, &f[j]);
            }
            for (a, part) in back.iter().enumerate() {
                for (j, weight) in rows.derivative(i, a).iter() {
                    sum = along(&sum, part * weight, &f[j]);
                }
            }
            sum
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::liquid::operators::{Fits, derivatives, values};

    /// A cube of points a unit apart, and the one in its middle.
    fn cube() -> (Vec<[f64; 3]>, usize) {
        let each = (0..343).map(|k| [k / 49, k / 7 % 7, k % 7].map(f64::from));
        (each.collect(), 171)
    }

    #[test]
    fn a_smooth_field_comes_as_its_slope_says() {
        let (points, middle) = cube();
        let (cloud, how) = ((&points[..], points.len()), (1.0, 3));
        let rows = derivatives(
            cloud,
            how,
            Fits {
                through: true,
                value: false,
            },
        )
        .unwrap();
        let fits = values(cloud, how).unwrap();
        let f: Vec<[f64; 1]> = points.iter().map(|x| [x[0] + 0.1 * x[1] * x[1]]).collect();
        let found = inside(
            (&rows, &fits),
            &f,
            |_| [0.2, -0.1, 0.0],
            (middle..middle + 1, 1.0),
        );
        let [_, y, _] = points[middle];
        assert!((found[0][0] - (0.2 - 0.02 * y)).abs() < 1e-9, "{found:?}");
    }
}
