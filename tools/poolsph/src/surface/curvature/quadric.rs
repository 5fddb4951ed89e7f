//! The curvature of a piece of surface from places on it and normals there.
//!
//! In axes x, y across the normal of the middle, z along it, with the chord l = |(x, y, z)|, the places and normals around
//! are fitted by weighted least squares to
//!
//! ```text
//! z = c - t.x - x.K x l^2/(2 x.x)        n = t + K x        x = (x, y)
//! ```
//!
//! for the height c, the tilt t and the shape K, whose trace is the mean curvature kappa (both principal curvatures added; positive where the
//! metal bulges). Planes, spheres and, by their normals, cylinders are met exactly at any distance: along a sphere normals turn as
//! chords grow, and -2 z/kappa is the square of the chord, where a paraboloid of that curvature errs by (l/2R)^2.

use shapes::frame::{difference, dot, squared};

use crate::surface::tangents;

/// A place on the surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// x \[m\].
    pub place: [f64; 3],
    /// Unit normal, outwards.
    pub normal: [f64; 3],
    /// How far it is to be believed, 0 to 1.
    pub trust: f64,
}

impl Sample {
    /// Weight of `other` in what is asked of the surface here, out to `reach` \[m\].
    #[must_use]
    #[inline]
    pub fn weight(&self, other: &Self, reach: f64) -> f64 {
        let [from, to] = SAME;
        let same = ((dot(self.normal, other.normal) - from) / (to - from)).clamp(0.0, 1.0);
        let chord = squared(difference(other.place, self.place)) / (reach * reach);
        other.trust * same * (1.0 - chord).max(0.0).powi(2)
    }
}

/// Shape of a piece of surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// kappa, both principal curvatures added \[1/m\].
    pub curvature: f64,
    /// Sum of the squares of the principal curvatures \[1/m2\].
    pub squares: f64,
    /// Places that took part.
    pub places: u32,
}

/// Cosine of the angle between two normals up to which they belong to different pieces of surface, and from which on to one.
const SAME: [f64; 2] = [-0.3, 0.1];
/// Fewest places that tell a shape, the middle included.
const FEWEST: u32 = 6;
/// What is added to the diagonal of the equations, in places of full weight: of K, which few places leave open, and of
/// what they always tell.
const DAMPING: [f64; 2] = [1e-3, 1e-9];

/// Normal equations of the fit in units of the reach: six rows of a matrix of which the lower half is used, the right side
/// behind them, and a column that means nothing: eight numbers are one vector.
#[derive(Default)]
struct Equations([[f64; 8]; 6]);

impl Equations {
    /// Adds a row `f . unknowns = value` with a weight; the `value` stands behind the six numbers of f, of which those of the `places`
    /// are not zero.
    #[inline(always)]
    fn add<const N: usize>(&mut self, weight: f64, f: [f64; 8], places: [usize; N]) {
        for i in places {
            let part = weight * f[i];
            for (entry, f) in self.0[i].iter_mut().zip(f) {
                *entry += part * f;
            }
        }
    }

    /// c, t, K: xx, xy, yy, by Cholesky's factors.
    #[inline(always)]
    fn solve(self) -> [f64; 6] {
        let mut m = self.0;
        let mut x = m.map(|row| row[6]);
        for (i, row) in m.iter_mut().enumerate() {
            row[i] += DAMPING[usize::from(i < 3)];
        }
        for i in 0..6 {
            for j in 0..=i {
                let dot: f64 = (0..j).map(|k| m[i][k] * m[j][k]).sum();
                let rest = m[i][j] - dot;
                m[i][j] = if i == j {
                    rest.max(DAMPING[1]).sqrt()
                } else {
                    rest / m[j][j]
                };
            }
            let dot: f64 = (0..i).map(|k| m[i][k] * x[k]).sum();
            x[i] = (x[i] - dot) / m[i][i];
        }
        for i in (0..6).rev() {
            let dot: f64 = (i + 1..6).map(|k| m[k][i] * x[k]).sum();
            x[i] = (x[i] - dot) / m[i][i];
        }
        x
    }
}

/// Shape of the surface at `middle` from the places `around` within `reach` \[m\]; none from fewer than six.
#[must_use]
#[inline(always)]
pub fn shape<'a>(
    middle: &'a Sample,
    around: impl Iterator<Item = &'a Sample>,
    reach: f64,
) -> Option<Shape> {
    let (u, v) = tangents(middle.normal);
    let (mut equations, mut places) = (Equations::default(), 0);
    let mut take = |sample: &Sample| {
        let weight = middle.weight(sample, reach);
        if weight <= 0.0 {
            return;
        }
        let way = difference(sample.place, middle.place).map(|x| x / reach);
        let [x, y, z] = [u, v, middle.normal].map(|axis| dot(way, axis));
        let flat = x * x + y * y;
        let stretch = if flat > 0.0 { squared(way) / flat } else { 1.0 };
        let bent = [0.5 * x * x, x * y, 0.5 * y * y].map(|x| -stretch * x);
        let [a, b, c] = bent;
        let [p, q] = [u, v].map(|axis| dot(sample.normal, axis));
        equations.add(weight, [1.0, -x, -y, a, b, c, z, 0.0], [0, 1, 2, 3, 4, 5]);
        equations.add(weight, [0.0, 1.0, 0.0, x, y, 0.0, p, 0.0], [1, 3, 4]);
        equations.add(weight, [0.0, 0.0, 1.0, 0.0, x, y, q, 0.0], [2, 4, 5]);
        places += 1;
    };
    take(middle);
    around.for_each(take);
    if places < FEWEST {
        return None;
    }
    let [.., xx, xy, yy] = equations.solve().map(|x| x / reach);
    Some(Shape {
        curvature: xx + yy,
        squares: xx * xx + 2.0 * xy * xy + yy * yy,
        places,
    })
}
