//! Normals of the free surface that do not turn with the spacing along it.
//!
//! The gradient of the colour, averaged over the particles of the surface around, gives a first normal; the plane through their
//! places, by least squares about it, the final one. The gradient alone turns to where neighbours stand closer along
//! the surface, and what acts along or across it drives these further together: a layer that its surface pulls along broke
//! up within some ten turns of its shear.

use kernels::CubicSpline;
use particles::Matter;
use shapes::frame::{along, difference, dot, squared};

use crate::motion::lattice::Lattice;
use crate::near::{Near, Role, Row};
use crate::surface::tangents;

/// Lack of neighbours, in parts of the lattice's, from which on a particle lies at the surface, and at which it does so
/// wholly. A particle of a plane surface lacks 0.22.
const LACKS: [f64; 2] = [0.08, 0.16];
/// Least determinant of the moments of places along the surface, over the square of their mean, that tells a plane.
const FLAT: f64 = 1e-3;

/// The normals with their scratch.
#[derive(Debug, Clone)]
pub(super) struct Normals {
    /// V \[m3\].
    volume: f64,
    /// Sum of W over the neighbours in the lattice \[1/m3\].
    full: f64,
    /// grad C of each particle of the surface \[1/m\], and how far it is one, `[m + images]`.
    sides: Vec<[f64; 4]>,
    /// Unit normal, outwards, and |grad C| \[1/m\], `[m]`; zero off the surface.
    found: Vec<[f64; 6]>,
}

impl Normals {
    /// Those of surfaces of `metal`.
    pub(super) fn new(metal: Matter) -> Self {
        let own = CubicSpline::<3>::new(metal.smoothing_length).value(0.0);
        Self {
            volume: metal.volume(),
            full: Lattice::of(metal).number - own,
            sides: Vec::new(),
            found: Vec::new(),
        }
    }

    /// Finds them.
    pub(super) fn find(&mut self, near: &Near) {
        self.look(near);
        let (sides, own, volume) = (&self.sides, near.kernel.value(0.0), self.volume);
        self.found.resize(near.len(), [0.0; 6]);
        near.each_row(&mut self.found, |a, row, found| {
            let [x, y, z, part] = sides[a];
            *found = [0.0; 6];
            if part > 0.0 {
                let mut side = [x, y, z].map(|x| own * x);
                for (b, value) in row.index.iter().zip(row.value) {
                    let [x, y, z, _] = sides[*b as usize];
                    side = along(side, *value, [x, y, z]);
                }
                let size = squared(side).sqrt();
                if size > 0.0 {
                    let first = side.map(|x| -x / size);
                    let [x, y, z] = levelled(near, a, row, sides, first);
                    let steep = (volume * part * -dot(near.gradient[a], first)).max(0.0);
                    let [p, q, r] = first.map(|x| steep * x);
                    *found = [x, y, z, p, q, r];
                }
            }
        });
    }

    /// Which particles lie at the surface, and the gradient of the colour there.
    fn look(&mut self, near: &Near) {
        let (volume, full, own) = (self.volume, self.full, near.kernel.value(0.0));
        let [from, to] = LACKS;
        let columns = near.role.iter().zip(&near.number).zip(&near.gradient);
        self.sides.clear();
        self.sides.extend(columns.map(|((role, number), gradient)| {
            let lack = 1.0 - (number - own) / full;
            let part = ((lack - from) / (to - from)).clamp(0.0, 1.0);
            let [x, y, z] = gradient.map(|x| part * volume * x);
            if *role == Role::Liquid {
                [x, y, z, part]
            } else {
                [0.0; 4]
            }
        }));
        near.complete(&mut self.sides, |[x, y, z, part], _, turn| {
            let [x, y, z] = turn.vector([x, y, z]);
            [x, y, z, part]
        });
    }

    /// Unit normal at `a`, outwards, and |grad C| \[1/m\]; zero off the surface.
    #[inline]
    pub(super) fn at(&self, a: usize) -> [f64; 3] {
        let [x, y, z, ..] = self.found[a];
        [x, y, z]
    }

    /// -grad C at `a` \[1/m\], along the mean gradient of the surface around; zero off the surface.
    #[inline]
    pub(super) fn steep(&self, a: usize) -> [f64; 3] {
        let [.., x, y, z] = self.found[a];
        [x, y, z]
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        32 * (self.sides.capacity() + self.found.capacity())
    }
}

/// The normal of the plane through the places of the surface around `a`, by least squares about a first `normal`.
fn levelled(near: &Near, a: usize, row: Row<'_>, sides: &[[f64; 4]], normal: [f64; 3]) -> [f64; 3] {
    let (p, q) = tangents(normal);
    let own = near.kernel.value(0.0) * sides[a][3];
    // Sums of weight, x, y, z, and of xx, xy, yy, xz, yz.
    let mut sums = [own, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for (b, value) in row.index.iter().map(|b| *b as usize).zip(row.value) {
        let weight = value * sides[b][3];
        if weight > 0.0 {
            let way = difference(near.position[b], near.position[a]);
            let [x, y, z] = [p, q, normal].map(|axis| dot(way, axis));
            let terms = [1.0, x, y, z, x * x, x * y, y * y, x * z, y * z];
            sums = std::array::from_fn(|i| sums[i] + weight * terms[i]);
        }
    }
    let [n, x, y, z, ..] = sums;
    let [xx, xy, yy, xz, yz] = [
        sums[4] - x * x / n,
        sums[5] - x * y / n,
        sums[6] - y * y / n,
        sums[7] - x * z / n,
        sums[8] - y * z / n,
    ];
    let (determinant, size) = (xx * yy - xy * xy, 0.5 * (xx + yy));
    if determinant <= FLAT * size * size {
        return normal;
    }
    let rise = [
        (yy * xz - xy * yz) / determinant,
        (xx * yz - xy * xz) / determinant,
    ];
    let level = along(along(normal, -rise[0], p), -rise[1], q);
    let size = squared(level).sqrt();
    level.map(|x| x / size)
}
