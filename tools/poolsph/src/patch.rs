//! What the surface is at a particle.

use particles::{Column, Set};
use shapes::frame::along;

use crate::faces::Turn;

/// A wall whose normal points down by this much is out of reach of the arc. It is above zero for the scatter of
/// normals: half of the patches of an upright wall look down a little.
const LEAN: f64 = 0.2;

/// Outward unit normal; zero deep inside.
pub const NORMAL: Column<[f64; 3]> = Column::new("normal", "1", [0.0; 3]).saved();
/// Area that a particle owns \[m2\]; zero off the surface.
pub const AREA: Column<f64> = Column::new("area", "m2", 0.0).saved();
/// Area as seen from above \[m2\].
pub const SEEN: Column<f64> = Column::new("seen", "m2", 0.0).saved();
/// Distance to the surface along the normal \[m\].
pub const DEPTH: Column<f64> = Column::new("depth", "m", 0.0).saved();
/// What a particle claims of the plan before its columns are shared \[m2\].
const CLAIM: Column<f64> = Column::new("claim", "m2", 0.0).saved();
/// Sides at which the metal ends, a bit each.
const SIDES: Column<u8> = Column::new("sides", "1", 0).saved();
/// grad C \[1/m\].
const GRADIENT: Column<[f64; 3]> = Column::new("colour_gradient", "1/m", [0.0; 3]).saved();

/// What the surface is at a particle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Patch {
    /// [`NORMAL`].
    pub normal: [f64; 3],
    /// [`AREA`].
    pub area: f64,
    /// [`SEEN`].
    pub seen: f64,
    /// [`DEPTH`].
    pub depth: f64,
    /// [`CLAIM`].
    pub(crate) claim: f64,
    /// [`SIDES`].
    pub(crate) sides: u8,
    /// [`GRADIENT`].
    pub(crate) gradient: [f64; 3],
}

impl Patch {
    /// The patch of an image.
    #[must_use]
    #[inline]
    pub(crate) fn turned(self, turn: &Turn) -> Self {
        Self {
            normal: turn.vector(self.normal),
            gradient: turn.vector(self.gradient),
            ..self
        }
    }

    /// The place on the surface that belongs to a particle at `x` \[m\]: tables of what acts on the area are read there.
    #[must_use]
    #[inline]
    pub fn foot(&self, x: [f64; 3]) -> [f64; 3] {
        along(x, self.depth, self.normal)
    }

    /// The part of the area that the arc reaches from above: all of what looks upwards, nothing of what looks down.
    #[must_use]
    #[inline]
    pub fn reached(&self) -> f64 {
        (1.0 + self.normal[2] / LEAN).clamp(0.0, 1.0)
    }
}

/// The surface at all particles.
#[derive(Debug, Clone, Copy)]
pub struct Patches<'a> {
    /// [`NORMAL`].
    pub normal: &'a [[f64; 3]],
    /// [`AREA`].
    pub area: &'a [f64],
    /// [`SEEN`].
    pub seen: &'a [f64],
    /// [`DEPTH`].
    pub depth: &'a [f64],
    claim: &'a [f64],
    sides: &'a [u8],
    gradient: &'a [[f64; 3]],
}

impl<'a> Patches<'a> {
    /// The surface of a set.
    #[must_use]
    pub fn of(metal: &'a Set) -> Self {
        Self {
            normal: metal.column(&NORMAL),
            area: metal.column(&AREA),
            seen: metal.column(&SEEN),
            depth: metal.column(&DEPTH),
            claim: metal.column(&CLAIM),
            sides: metal.column(&SIDES),
            gradient: metal.column(&GRADIENT),
        }
    }

    /// The surface at each particle.
    pub fn iter(self) -> impl Iterator<Item = Patch> + 'a {
        (0..self.area.len()).map(move |a| self.at(a))
    }

    /// The surface at particle `a`.
    #[must_use]
    #[inline]
    pub fn at(&self, a: usize) -> Patch {
        Patch {
            normal: self.normal[a],
            area: self.area[a],
            seen: self.seen[a],
            depth: self.depth[a],
            claim: self.claim[a],
            sides: self.sides[a],
            gradient: self.gradient[a],
        }
    }
}

/// Declares the columns of the surface.
pub fn declare(metal: &mut Set) {
    metal.declare(&NORMAL);
    metal.declare(&AREA);
    metal.declare(&SEEN);
    metal.declare(&DEPTH);
    metal.declare(&CLAIM);
    metal.declare(&SIDES);
    metal.declare(&GRADIENT);
}

/// Gives particles their patches.
pub(crate) fn put(metal: &mut Set, patches: impl Iterator<Item = (usize, Patch)>) {
    let columns = (&NORMAL, &AREA, &SEEN, &DEPTH, &CLAIM, &SIDES, &GRADIENT);
    let (normal, area, seen, depth, claim, sides, gradient) = metal.columns_mut(columns);
    for (a, patch) in patches {
        normal[a] = patch.normal;
        (area[a], seen[a], depth[a]) = (patch.area, patch.seen, patch.depth);
        (claim[a], sides[a]) = (patch.claim, patch.sides);
        gradient[a] = patch.gradient;
    }
}
