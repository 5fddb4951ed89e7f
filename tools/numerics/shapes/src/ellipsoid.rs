//! Ellipsoids and, in a plane, ellipses, in their own axes.
//!
//! The place of the surface nearest to `y` is `x_k = a_k^2 y_k / (t + a_k^2)` with the largest `t` that puts it on the surface,
//! `sum_k (a_k y_k / (t + a_k^2))^2 = 1`, and the way to it is `t (y_k / (t + a_k^2))` (Eberly 2013). An axis without end
//! plays no part: a plane scene has none along z.

use crate::frame::{Vector, direction, dot, length};

/// Most steps to the nearest place of the surface; about six are taken.
const STEPS: usize = 60;

/// An ellipsoid, or the surface at a distance from one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// Semi-axes \[m\]; infinite along z in a plane scene.
    pub half: Vector,
    /// How far the surface stands out from that of the semi-axes \[m\].
    pub beyond: f64,
}

/// A place of the surface that stands for one of the unit sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spot {
    pub(crate) place: Vector,
    pub(crate) normal: Vector,
    /// Area over that of the unit sphere; length over that of the unit circle in a plane.
    pub(crate) area: f64,
}

impl Ellipsoid {
    /// Signed distance of a place \[m\], negative inside.
    ///
    /// ```
    /// use shapes::Ellipsoid;
    /// let drop = Ellipsoid { half: [1.0, 1.0, 4.0], beyond: 0.0 };
    /// assert_eq!(drop.distance([0.0, 0.0, 7.0]), 3.0);
    /// assert_eq!(drop.distance([0.5, 0.0, 0.0]), -0.5);
    /// ```
    #[must_use]
    pub fn distance(&self, place: Vector) -> f64 {
        let least = self.shortest();
        let square = |k: usize| self.half[k] * self.half[k];
        // How far the pole of an axis is from the last one: what is small there is not a difference of large numbers.
        let gap = |k: usize| (self.half[k] - self.half[least]) * (self.half[k] + self.half[least]);
        // A place without a coordinate along an axis has no pole there, one with has the root behind its pole.
        let used = || (0..3).filter(|k| self.half[*k].is_finite() && place[*k] != 0.0);
        let start = used().map(|k| self.half[k] * place[k].abs() - gap(k));
        // `t` above the last pole.
        let mut above = start.fold(0.0, f64::max);
        for _ in 0..STEPS {
            let (mut sum, mut slope) = (0.0, 0.0);
            for k in used() {
                let over = 1.0 / (above + gap(k));
                let part = self.half[k] * place[k] * over;
                sum += part * part;
                slope += part * part * over;
            }
            // `sum^(-1/2)` is concave in t: its tangents lead to the root from below.
            let next = above + sum * (sum.sqrt() - 1.0) / slope;
            if next.is_nan() || next <= above {
                break;
            }
            above = next;
        }
        let t = above - square(least);
        let ways = || used().map(|k| (k, place[k] / (above + gap(k))));
        let level: f64 = ways().map(|(_, way)| way * way).sum();
        let surface = if above == 0.0 {
            // Between the foci the nearest places lie on either side.
            let filled: f64 = ways().map(|(k, way)| (self.half[k] * way).powi(2)).sum();
            let rest = (1.0 - filled).max(0.0);
            -(t * t * level + rest * square(least)).sqrt()
        } else {
            t * level.sqrt()
        };
        surface - self.beyond
    }

    fn shortest(&self) -> usize {
        (0..3).fold(0, |m, k| if self.half[k] < self.half[m] { k } else { m })
    }

    /// Least radius of curvature of the surface of the semi-axes \[m\]: at the ends of the longest.
    #[must_use]
    pub fn sharpest(&self) -> f64 {
        let ends = self.half.iter().filter(|h| h.is_finite());
        let longest = ends.fold(0.0_f64, |most, h| most.max(*h));
        self.half[self.shortest()].powi(2) / longest
    }

    /// An end of the longest semi-axis, where it bends most \[m\].
    #[must_use]
    pub fn end(&self) -> Vector {
        let length = |k: usize| {
            if self.half[k].is_finite() {
                self.half[k]
            } else {
                0.0
            }
        };
        let longest = (0..3).fold(0, |m, k| if length(k) > length(m) { k } else { m });
        std::array::from_fn(|k| {
            if k == longest {
                self.half[k] + self.beyond
            } else {
                0.0
            }
        })
    }

    /// The surface moved outward by a distance \[m\]; none where it would fold.
    pub(crate) fn grown(self, by: f64) -> Option<Self> {
        let beyond = self.beyond + by;
        (beyond > -self.sharpest()).then_some(Self { beyond, ..self })
    }

    /// The place that stands for one of the unit sphere; of the unit circle in a plane.
    pub(crate) fn spot(&self, unit: Vector) -> Spot {
        let finite = |k: &usize| self.half[*k].is_finite();
        let steep: Vector = std::array::from_fn(|k| unit[k] / self.half[k]);
        let normal = direction(steep);
        let base: Vector = std::array::from_fn(|k| {
            if finite(&k) {
                self.half[k] * unit[k]
            } else {
                0.0
            }
        });
        let product: f64 = (0..3).filter(finite).map(|k| self.half[k]).product();
        let [mean, gauss] = self.bends(base);
        Spot {
            place: std::array::from_fn(|k| base[k] + self.beyond * normal[k]),
            normal,
            area: product * length(steep) * (1.0 + self.beyond * (mean + self.beyond * gauss)),
        }
    }

    /// Sum and product of the principal curvatures at a place of the surface of the semi-axes; in a plane the product is none.
    fn bends(&self, x: Vector) -> [f64; 2] {
        let squares = self.half.map(|h| h * h);
        let support = 1.0 / length(std::array::from_fn(|k| x[k] / squares[k]));
        if squares[2].is_infinite() {
            return [support.powi(3) / (squares[0] * squares[1]), 0.0];
        }
        let all: f64 = squares.iter().product();
        let sum: f64 = squares.iter().sum();
        [
            support.powi(3) * (sum - dot(x, x)) / all,
            support.powi(4) / all,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::difference;

    const SHAPES: [Vector; 6] = [
        [1.0, 1.0, 1.0],
        [1.0, 1.0, 4.0],
        [3.0, 3.0, 0.3],
        [3.0, 2.0, 1.0],
        [2.0, 0.5, f64::INFINITY],
        [1e-6, 1e-5, 1e-5],
    ];

    /// Places about a shape, those on its axes and planes of symmetry among them.
    fn places(half: Vector) -> Vec<Vector> {
        let parts = [-2.3, -1.0, -0.4, 0.0, 1e-9, 0.17, 0.8, 1.6];
        let mut all = Vec::new();
        for x in parts {
            for y in parts {
                for z in parts {
                    let unit = [x, y, z];
                    all.push([0, 1, 2].map(|k| unit[k] * half[k].min(10.0)));
                }
            }
        }
        all
    }

    /// The nearest of many places of the surface.
    fn naive(shape: &Ellipsoid, x: Vector) -> f64 {
        let flat = shape.half[2].is_infinite();
        let rows = if flat { 1 } else { 81 };
        let mut best = f64::INFINITY;
        for i in 0..rows {
            let polar = std::f64::consts::PI * if flat { 0.5 } else { i as f64 / 80.0 };
            for j in 0..160 {
                let angle = std::f64::consts::TAU * f64::from(j) / 160.0;
                let unit = [
                    polar.sin() * angle.cos(),
                    polar.sin() * angle.sin(),
                    polar.cos(),
                ];
                let unit = if flat { [unit[0], unit[1], 0.0] } else { unit };
                best = best.min(length(difference(shape.spot(unit).place, x)));
            }
        }
        best
    }

    #[test]
    fn distances_are_those_of_the_nearest_place() {
        for half in SHAPES {
            let shape = Ellipsoid { half, beyond: 0.0 };
            let size = half
                .iter()
                .filter(|h| h.is_finite())
                .fold(0.0_f64, |m, h| m.max(*h));
            for mut x in places(half) {
                if half[2].is_infinite() {
                    x[2] = 0.0;
                }
                let (found, wanted) = (shape.distance(x), naive(&shape, x));
                let filled: f64 = (0..3).map(|k| (x[k] / half[k]).powi(2)).sum();
                assert!(
                    (found.abs() - wanted).abs() < 4e-2 * size
                        && found.abs() < wanted + 1e-9 * size,
                    "{half:?} {x:?}: {found} {wanted}"
                );
                assert!(
                    found.abs() < 1e-9 * size || (found < 0.0) == (filled < 1.0),
                    "{half:?} {x:?}"
                );
            }
        }
    }

    /// Along a normal the distance is the way, on the surface it vanishes to rounding.
    #[test]
    fn distances_rise_along_normals() {
        for half in SHAPES {
            let shape = Ellipsoid { half, beyond: 0.0 };
            for raw in places([1.0; 3]) {
                let raw = if half[2].is_infinite() {
                    [raw[0], raw[1], 0.0]
                } else {
                    raw
                };
                if length(raw) == 0.0 {
                    continue;
                }
                let spot = shape.spot(direction(raw));
                for part in [-0.9, -0.1, 0.0, 1e-7, 0.3, 20.0] {
                    let way = part * shape.sharpest();
                    let x = std::array::from_fn(|k| spot.place[k] + way * spot.normal[k]);
                    let found = shape.distance(x);
                    assert!(
                        (found - way).abs() < 1e-11 * length(x).max(way.abs()),
                        "{half:?} {way}: {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_grown_ellipsoid_stands_off_by_as_much_everywhere() {
        let shape = Ellipsoid {
            half: [3.0, 2.0, 1.0],
            beyond: 0.0,
        };
        let grown = shape.grown(0.5).unwrap();
        let spot = grown.spot(direction([1.0, -2.0, 0.5]));
        assert!((shape.distance(spot.place) - 0.5).abs() < 1e-13);
        assert!(grown.distance(spot.place).abs() < 1e-13);
        assert!(shape.grown(-0.3).is_some() && shape.grown(-0.4).is_none());
    }
}
