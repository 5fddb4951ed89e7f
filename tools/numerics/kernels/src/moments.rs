//! Moments of a kernel's slopes about a particle, whose inverse corrects gradients.
//!
//! With `w_ab = -(dW/dr)/r >= 0` and `x = x_a - x_b`,
//!
//! ```text
//! M_a = sum_b V_b w_ab x x^T,      grad f = M_a^-1 sum_b V_b w_ab (f_a - f_b) x
//! ```
//!
//! is exact for linear fields, however the neighbours lie (Bonet and Lok 1999). Where they lie in a plane or on a line
//! no inverse exists, and that of the filled lattice stands in.

/// A symmetric matrix: xx, yy, zz, xy, zx, yz.
pub type Moments = [f64; 6];

/// Determinant of the moments, over that of the lattice's, up to which they span no space, and from which on they do.
const SPANNED: [f64; 2] = [0.05, 0.20];

/// M x.
#[inline(always)]
#[must_use]
pub fn times([a, b, c, d, e, f]: Moments, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        a * x + d * y + e * z,
        d * x + b * y + f * z,
        e * x + f * y + c * z,
    ]
}

/// The inverse of moments that are a row's own in `part`, and those of the lattice for the rest; the lattice's, too, where
/// the row's own are those of a plane or line. `lattice` is the moment of the filled lattice along each axis, in the unit of the
/// row's own.
///
/// ```
/// let own = [2.0, 2.0, 1.0, 0.5, 0.0, 0.0];
/// let inverse = kernels::moments::inverse(own, 1.0, 1.0);
/// let back = kernels::moments::times(inverse, kernels::moments::times(own, [1.0, -2.0, 3.0]));
/// assert!((back[0] - 1.0).abs() + (back[1] + 2.0).abs() + (back[2] - 3.0).abs() < 1e-14);
/// ```
#[inline]
#[must_use]
pub fn inverse(own: Moments, lattice: f64, part: f64) -> Moments {
    let spanned = determinant(own, minors(own)) / lattice.powi(3);
    let part = part * within(spanned, SPANNED);
    let filled = |i: usize| if i < 3 { lattice } else { 0.0 };
    let mixed = std::array::from_fn(|i| part * own[i] + (1.0 - part) * filled(i));
    let minors = minors(mixed);
    let determinant = determinant(mixed, minors);
    minors.map(|x| x / determinant)
}

/// Adds the moments of neighbours that are missing, of weight `missing`: all of them at the distance `d`, along `open` as far as
/// that tells, evenly around in `D` axes for the rest. `open` is the sum of weight times x that they would have had.
#[inline]
pub fn beyond<const D: usize>(moments: &mut Moments, open: [f64; 3], missing: f64, d: f64) {
    let [x, y, z] = open;
    let size = (x * x + y * y + z * z).sqrt();
    let across = if size > 0.0 { d / size } else { 0.0 };
    let around = ((missing * d - size) * d).max(0.0) / D as f64;
    let added = [x * x, y * y, z * z, x * y, x * z, y * z];
    for (i, (moment, added)) in moments.iter_mut().zip(added).enumerate() {
        *moment += across * added + if i < D { around } else { 0.0 };
    }
}

fn minors([a, b, c, d, e, f]: Moments) -> Moments {
    [
        b * c - f * f,
        a * c - e * e,
        a * b - d * d,
        e * f - d * c,
        d * f - e * b,
        d * e - a * f,
    ]
}

fn determinant([a, _, _, d, e, _]: Moments, minors: Moments) -> f64 {
    a * minors[0] + d * minors[3] + e * minors[4]
}

/// How far `x` is on its way through a range, 0 to 1.
#[inline]
#[must_use]
pub fn within(x: f64, [from, to]: [f64; 2]) -> f64 {
    ((x - from) / (to - from)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CubicSpline;

    /// Sums over a lattice of spacing 1, cut at `z <= top`, with places moved by up to 0.1: moments about its middle, and of a
    /// field of slope `g`.
    fn sums(top: i32, g: [f64; 3]) -> (Moments, [f64; 3]) {
        let kernel = CubicSpline::<3>::new(1.3);
        let (mut moments, mut sum) = ([0.0; 6], [0.0; 3]);
        let axis = || -3..=3_i32;
        let all = axis().flat_map(|i| axis().flat_map(move |j| (-3..=top).map(move |k| [i, j, k])));
        for at in all.filter(|at| *at != [0; 3]) {
            let moved =
                |c: usize| 0.1 * (7.3 * f64::from(at[0] + 3 * at[1] + 5 * at[2]) + c as f64).sin();
            let x: [f64; 3] = std::array::from_fn(|c| f64::from(at[c]) + moved(c));
            let w = -kernel.slope(x.map(|c| c * c).iter().sum::<f64>().sqrt());
            let pairs = [[0, 0], [1, 1], [2, 2], [0, 1], [2, 0], [1, 2]];
            for (moment, [i, j]) in moments.iter_mut().zip(pairs) {
                *moment += w * x[i] * x[j];
            }
            let rise: f64 = g.iter().zip(x).map(|(g, x)| g * x).sum();
            sum = std::array::from_fn(|c| sum[c] + w * rise * x[c]);
        }
        (moments, sum)
    }

    fn close(found: Moments, exact: Moments) {
        let miss: f64 = found.iter().zip(exact).map(|(f, e)| (f - e).abs()).sum();
        assert!(miss < 1e-14, "{found:?} {exact:?}");
    }

    #[test]
    fn gradients_of_linear_fields_are_exact_inside_and_at_a_face() {
        let g = [1.0, -2.0, 0.5];
        let (filled, _) = sums(3, g);
        let lattice = (filled[0] + filled[1] + filled[2]) / 3.0;
        for top in [3, 0] {
            let (own, sum) = sums(top, g);
            let found = times(inverse(own, lattice, 1.0), sum);
            let miss: f64 = found.iter().zip(g).map(|(f, g)| (f - g).abs()).sum();
            assert!(miss < 1e-12, "{top}: {found:?}");
        }
    }

    #[test]
    fn what_is_missing_has_the_moments_of_where_it_was() {
        let (d, mut moments) = (2.0, [0.0; 6]);
        beyond::<3>(&mut moments, [0.0, 0.0, d * 1.5], 1.5, d);
        close(moments, [0.0, 0.0, 1.5 * d * d, 0.0, 0.0, 0.0]);
        let mut moments = [0.0; 6];
        beyond::<2>(&mut moments, [0.0; 3], 1.0, d);
        close(moments, [0.5 * d * d, 0.5 * d * d, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn where_neighbours_span_no_space_the_lattice_stands_in() {
        let of_lattice = [0.5, 0.5, 0.5, 0.0, 0.0, 0.0];
        for (own, part) in [
            ([2.0, 2.0, 0.0, 0.3, 0.0, 0.0], 1.0),
            ([3.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1.0),
            ([3.0, 1.0, 2.0, 0.3, 0.0, 0.0], 0.0),
        ] {
            close(inverse(own, 2.0, part), of_lattice);
        }
    }
}
