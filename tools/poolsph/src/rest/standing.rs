//! What stands opposite the neighbours of a particle at rest, and what its sums would be if something always did.

use std::collections::BTreeMap;
use std::ops::Deref;

use shapes::frame::{Vector, along, difference, squared, unit};

use super::{Link, Plane, around, cell};

/// Particles by cells as wide as the kernel reaches.
type Cells = BTreeMap<[i32; 3], Vec<u32>>;

/// A particle stands at a place within this part of a spacing: beyond a face none is nearer than one.
const STANDS: f64 = 0.8;
/// Part of its greatest size up to which a sum of r W is none.
const EVEN: f64 = 1e-9;

/// What stands where at the start.
pub(super) struct Standing<'a> {
    pub(super) places: &'a [Vector],
    /// Named faces, beyond which nothing lacks.
    pub(super) faces: &'a [Plane],
    /// Reach of the kernel, and spacing of the particles \[m\].
    pub(super) reach: f64,
    pub(super) spacing: f64,
}

/// A sum that is complete as far as opposite places tell: what has nothing opposite counts twice.
#[derive(Debug, Clone, Copy)]
pub(super) struct Whole {
    /// Sum of W, and of W r r along xx, yy, zz, yz, zx, xy.
    pub(super) sum: f64,
    pub(super) moment: [f64; 6],
    /// Whether a named face completes it.
    pub(super) named: bool,
}

/// Neighbours of a particle that have nothing opposite.
#[derive(Default)]
pub(super) struct Lacks {
    pub(super) each: Vec<bool>,
    /// Whether a named face makes good for others.
    pub(super) named: bool,
}

impl Standing<'_> {
    pub(super) fn cells(&self) -> Cells {
        let mut cells = Cells::new();
        for (a, place) in self.places.iter().enumerate() {
            let own = cells.entry(cell(*place, self.reach)).or_default();
            own.push(a as u32);
        }
        cells
    }

    /// Whether neighbours stand evenly all around, as they do inside of a body.
    fn is_even(&self, a: usize, row: &[Link]) -> bool {
        let (mut sum, mut size) = ([0.0; 3], 0.0);
        for link in row {
            let way = difference(self.places[link.to as usize], self.places[a]);
            sum = along(sum, link.weight, way);
            size += link.weight * self.reach;
        }
        squared(sum) <= (EVEN * size).powi(2)
    }

    /// Which neighbours of `a` have nothing opposite; none of them where all stand evenly around.
    pub(super) fn lacks(
        &self,
        a: usize,
        row: &[Link],
        cells: &impl Deref<Target = Cells>,
    ) -> Lacks {
        if self.is_even(a, row) {
            return Lacks::default();
        }
        let at = self.places[a];
        let near = (STANDS * self.spacing).powi(2);
        let stands =
            |place: Vector, b: u32| squared(difference(self.places[b as usize], place)) < near;
        let mut named = false;
        let mut lacks = |link: &Link| {
            let to = self.places[link.to as usize];
            let place: Vector = std::array::from_fn(|k| 2.0 * at[k] - to[k]);
            // Most are of the row itself.
            if row.iter().any(|link| stands(place, link.to)) {
                return false;
            }
            let beyond = |face: &Plane| face.outward * (place[face.axis] - face.at) > 0.0;
            if self.faces.iter().any(beyond) {
                named = true;
                return false;
            }
            let mut beside = around(cell(place, self.reach)).filter_map(|cell| cells.get(&cell));
            !beside.any(|own| own.iter().any(|b| stands(place, *b)))
        };
        let each = row.iter().map(&mut lacks).collect();
        Lacks { each, named }
    }

    pub(super) fn whole(&self, a: usize, row: &[Link], lacks: &Lacks) -> Whole {
        let mut whole = Whole {
            sum: 0.0,
            moment: [0.0; 6],
            named: lacks.named,
        };
        for (place, link) in row.iter().enumerate() {
            let lacks = lacks.each.get(place).is_some_and(|lacks| *lacks);
            let weight = if lacks { 2.0 } else { 1.0 } * link.weight;
            let [x, y, z] = difference(self.places[link.to as usize], self.places[a]);
            whole.sum += weight;
            let products = [x * x, y * y, z * z, y * z, z * x, x * y];
            for (sum, product) in whole.moment.iter_mut().zip(products) {
                *sum += weight * product;
            }
        }
        whole
    }

    /// Direction of the sum of r W over what has nothing opposite; none where all has, or where the sum has no direction.
    pub(super) fn normal(&self, a: usize, row: &[Link], lacks: &Lacks) -> Option<Vector> {
        let (mut sum, mut size) = ([0.0; 3], 0.0);
        for (link, lacks) in row.iter().zip(&lacks.each) {
            let way = difference(self.places[link.to as usize], self.places[a]);
            size += link.weight * self.reach;
            if *lacks {
                sum = along(sum, link.weight, way);
            }
        }
        // What stands at the very reach of the kernel weighs nothing but rounding.
        unit(sum).filter(|_| squared(sum) > (EVEN * size).powi(2))
    }
}
