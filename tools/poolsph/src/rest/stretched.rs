//! Lattices whose spacings differ along the axes.
//!
//! Sizes that are no multiple of the spacing make the spacings of the axes differ by up to a twentieth. A sum over such a lattice conducts
//! up to a percent more along one axis than along another. With e the direction of a pair, its weight becomes
//!
//! ```text
//! W_ab (1 + sum_k c_k e_k^2)
//! ```
//!
//! where c makes all three sums of W r_k^2 over the whole lattice a third of sum r^2 W of the even one.

use kernels::CubicSpline;
use shapes::frame::{Vector, cross, dot, squared};

/// c of a lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretched {
    more: Vector,
}

impl Stretched {
    /// That of a lattice with spacings `cell` \[m\] where the even one has the sum `second` of r^2 W \[1/m\]; none for even ones.
    pub(super) fn of(cell: Vector, kernel: CubicSpline<3>, second: f64) -> Option<Self> {
        if cell[0].to_bits() == cell[1].to_bits() && cell[1].to_bits() == cell[2].to_bits() {
            return None;
        }
        let (mut rows, mut lacks) = ([[0.0; 3]; 3], [second / 3.0; 3]);
        let reach = cell.map(|spacing| (kernel.support() / spacing).ceil() as i32);
        for (i, j, k) in within(reach) {
            let way = [
                f64::from(i) * cell[0],
                f64::from(j) * cell[1],
                f64::from(k) * cell[2],
            ];
            let r = squared(way);
            let weight = kernel.value(r.sqrt());
            for (row, own) in rows.iter_mut().zip(way) {
                for (sum, other) in row.iter_mut().zip(way) {
                    *sum += weight * own * own * other * other / r;
                }
            }
            for (lack, own) in lacks.iter_mut().zip(way) {
                *lack -= weight * own * own;
            }
        }
        // The rows are symmetric: Cramer's rule by columns.
        let [a, b, c] = rows;
        let whole = dot(a, cross(b, c));
        let parts = [
            dot(lacks, cross(b, c)),
            dot(a, cross(lacks, c)),
            dot(a, cross(b, lacks)),
        ];
        Some(Self {
            more: parts.map(|part| part / whole),
        })
    }

    /// Factor on the weight of a pair at a distance `way`.
    pub(super) fn factor(&self, way: Vector) -> f64 {
        let squares = way.map(|x| x * x);
        1.0 + dot(self.more, squares) / squared(way)
    }
}

/// Places of a lattice about the origin, which is none of them.
fn within(reach: [i32; 3]) -> impl Iterator<Item = (i32, i32, i32)> {
    let [x, y, z] = reach.map(|n| -n..=n);
    let all = x.flat_map(move |i| y.clone().map(move |j| (i, j)));
    let all = all.flat_map(move |(i, j)| z.clone().map(move |k| (i, j, k)));
    all.filter(|place| *place != (0, 0, 0))
}
