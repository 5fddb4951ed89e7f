//! What the liquid brings to points that do not move with it: `((w - u) . grad) f` of a field f.
//!
//! The liquid that passes a point brings what is smooth: as much of f as passes of a spacing in a second goes over into the value of
//! the fit. Sums without a side would let ripples grow that fits do not see.

use std::ops::Range;

use rayon::prelude::*;
use wls::Stencils;

use super::surface::Patch;
use super::vector::{across, along, difference, dot, length};

/// Rows of slopes and of values of fits.
#[derive(Debug, Clone, Copy)]
pub struct Fitted<'a, const D: usize> {
    /// Rows of slopes.
    pub slopes: &'a Stencils<D>,
    /// Rows of the values of fits that need not pass through their points.
    pub values: &'a Stencils<D>,
}

/// Spacings within which a point has its neighbours.
const NEAR: f64 = 2.0;

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

/// At a range of points inside that follow the surface.
#[must_use]
pub fn inside<const D: usize, const C: usize>(
    fitted: Fitted<'_, D>,
    f: &[[f64; C]],
    back: impl Fn(usize) -> [f64; D] + Sync,
    range: Range<usize>,
    spacing: f64,
) -> Vec<[f64; C]> {
    range
        .into_par_iter()
        .map(|i| {
            let back = back(i);
            let passed = length(&back) / spacing;
            let mut sum = f[i].map(|c| -passed * c);
            for (j, weight) in fitted.values.value(i).iter() {
                sum = along(&sum, passed * weight, &f[j]);
            }
            for (a, part) in back.iter().enumerate() {
                for (j, weight) in fitted.slopes.derivative(i, a).iter() {
                    sum = along(&sum, part * weight, &f[j]);
                }
            }
            sum
        })
        .collect()
}

/// Shortens what the liquid brings in a time to points that follow the surface, until it is no more than a neighbour has of it.
///
/// Where streams meet, slopes across the place where they do would drive each on, faster than either comes; what is carried lies
/// between what is around (Bermejo and Staniforth 1992). Velocities count along the change, so that no axis is preferred.
pub fn bound<const D: usize>(
    drift: &mut [[f64; D]],
    values: &Stencils<D>,
    place: &[[f64; D]],
    u: &[[f64; D]],
    time: f64,
    spacing: f64,
) {
    drift.par_iter_mut().enumerate().for_each(|(i, own)| {
        let size = length(own);
        if size <= 0.0 {
            return;
        }
        let way = own.map(|c| c / size);
        let near = values.value(i).iter().map(|(j, _)| j);
        let near = near.filter(|j| length(&difference(&place[*j], &place[i])) < NEAR * spacing);
        let most = near.map(|j| dot(&way, &difference(&u[j], &u[i])));
        let most = most.fold(0.0, f64::max);
        if time * size > most {
            *own = way.map(|c| c * most / time);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::liquid::matter::Way;
    use crate::liquid::operators::{Fits, Points, derivatives, values};

    const WAY: Way = Way {
        spacing: 1.0,
        order: 3,
        tolerance: 1e-9,
        products: 100,
    };
    const THROUGH: Fits = Fits {
        through: true,
        value: false,
    };

    /// A cube of points a unit apart, and the one in its middle.
    fn cube() -> (Vec<[f64; 3]>, usize) {
        let each = (0..343).map(|k| [k / 49, k / 7 % 7, k % 7].map(f64::from));
        (each.collect(), 171)
    }

    #[test]
    fn a_smooth_field_comes_as_its_slope_says() {
        let (points, middle) = cube();
        let own = points.len();
        let all = Points { all: &points, own };
        let slopes = &derivatives(all, &WAY, THROUGH).unwrap();
        let values = &values(all, &WAY).unwrap();
        let f: Vec<[f64; 1]> = points.iter().map(|x| [x[0] + 0.1 * x[1] * x[1]]).collect();
        let fitted = Fitted { slopes, values };
        let back = |_| [0.2, -0.1, 0.0];
        let found = inside(fitted, &f, back, middle..middle + 1, 1.0);
        let [_, y, _] = points[middle];
        assert!((found[0][0] - (0.2 - 0.02 * y)).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn streams_that_meet_drive_neither_on() {
        let (points, middle) = cube();
        let own = points.len();
        let all = Points { all: &points, own };
        let slopes = &derivatives(all, &WAY, THROUGH).unwrap();
        let values = &values(all, &WAY).unwrap();
        // Both sides go against the plane x = 3.5, half a spacing beyond the middle of the cube.
        let u: Vec<[f64; 3]> = points
            .iter()
            .map(|x| [if x[0] < 3.5 { 1.0 } else { -1.0 }, 0.0, 0.0])
            .collect();
        let fitted = Fitted { slopes, values };
        let mut drift = inside(fitted, &u, |i| u[i].map(|c| -c), 0..own, 1.0);
        assert!(drift[middle][0] > 0.1, "{:?}", drift[middle]);
        bound(&mut drift, values, &points, &u, 0.5, 1.0);
        let after = drift.iter().zip(&u).map(|(d, u)| u[0] + 0.5 * d[0]);
        assert!(after.fold(0.0, |most, u| f64::max(most, u.abs())) <= 1.0 + 1e-12);
        // What turns one into the other stays.
        let mut turned = vec![[-0.5, 0.0, 0.0]; points.len()];
        bound(&mut turned, values, &points, &u, 0.5, 1.0);
        assert!((turned[middle][0] + 0.5).abs() < 1e-12);
    }
}
