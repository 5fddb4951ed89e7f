//! Flat faces across the axes between which a liquid moves.
//!
//! What leaves through a periodic face enters through the one across. A mirror turns the liquid over: nothing flows through it and
//! nothing drags along it, as along a wall on which a liquid slips. Neither has points: images of the points near them stand
//! beyond, and all fits know them ([`images`]). A wall to which the liquid sticks has points of its own, which follow those of
//! the free surface and stand still; with its normal n out of the liquid the pressure obeys, from (2.38) of Matsuzawa (2017)
//! and with no divergence brought in at the wall (Karniadakis, Israeli and Orszag 1991),
//!
//! ```text
//! dp/dn = rho g_n - mu n . curl curl u,     curl curl u = grad div u - div grad u
//! ```
//!
//! Across axes that are not periodic the walls bear the weight of the liquid: there the pressure is less `rho g . (x - c)`, c
//! the middle of the room, and the surface has that for it, so that a liquid at rest has one pressure throughout.

mod fill;
pub mod images;
pub mod level;

pub use fill::furnish;

use super::vector::{difference, dot};

/// What a face is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Side<const D: usize> {
    /// The free surface, or nothing at all.
    #[default]
    Open,
    /// Goes on at the face across.
    Periodic,
    /// A plane of symmetry.
    Mirror,
    /// A wall that moves at this velocity \[m/s\].
    Wall([f64; D]),
}

impl<const D: usize> Side<D> {
    /// Whether points stand on it.
    #[must_use]
    pub fn bears(&self) -> bool {
        matches!(self, Self::Open | Self::Wall(_))
    }
}

/// A box with its faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Room<const D: usize> {
    /// Lower corner \[m\].
    pub min: [f64; D],
    /// Upper corner \[m\].
    pub max: [f64; D],
    /// The lower and the upper face across each axis.
    pub sides: [[Side<D>; 2]; D],
    /// Normals, out of the liquid, of the points on walls.
    pub held: Vec<[f64; D]>,
}

impl<const D: usize> Default for Room<D> {
    /// None: nothing but the free surface bounds the liquid.
    fn default() -> Self {
        Self {
            min: [0.0; D],
            max: [0.0; D],
            sides: [[Side::Open; 2]; D],
            held: Vec::new(),
        }
    }
}

impl<const D: usize> Room<D> {
    /// Whether there is any face but the free surface.
    #[must_use]
    pub fn bounds(&self) -> bool {
        self.sides.iter().flatten().any(|s| *s != Side::Open)
    }

    /// Length along an axis \[m\].
    #[must_use]
    pub fn length(&self, axis: usize) -> f64 {
        self.max[axis] - self.min[axis]
    }

    /// The axis of the free face, and whether it is the upper one.
    #[must_use]
    pub fn free(&self) -> Option<(usize, bool)> {
        let faces = (0..D).flat_map(|axis| [(axis, false), (axis, true)]);
        let mut free = faces.filter(|(axis, up)| self.sides[*axis][usize::from(*up)] == Side::Open);
        free.next().filter(|_| self.bounds())
    }

    /// The part of gravity that faces bear \[m/s2\].
    #[must_use]
    pub fn borne(&self, gravity: &[f64; D]) -> [f64; D] {
        let bears = |k: usize| self.bounds() && self.sides[k][0] != Side::Periodic;
        std::array::from_fn(|k| if bears(k) { gravity[k] } else { 0.0 })
    }

    /// The part that moves the liquid as a whole \[m/s2\].
    #[must_use]
    pub fn driving(&self, gravity: &[f64; D]) -> [f64; D] {
        difference(gravity, &self.borne(gravity))
    }

    /// `g . (x - c)` of the part that faces bear \[m2/s2\].
    #[must_use]
    pub fn potential(&self, gravity: &[f64; D], x: &[f64; D]) -> f64 {
        let middle: [f64; D] = std::array::from_fn(|k| 0.5 * (self.min[k] + self.max[k]));
        dot(&self.borne(gravity), &difference(x, &middle))
    }

    /// The velocity of the wall with this normal \[m/s\].
    #[must_use]
    pub fn slides(&self, normal: &[f64; D]) -> [f64; D] {
        let axis = (0..D).find(|k| normal[*k] != 0.0).unwrap_or(0);
        match self.sides[axis][usize::from(normal[axis] > 0.0)] {
            Side::Wall(velocity) => velocity,
            _ => [0.0; D],
        }
    }

    /// Brings a place that has left through a periodic face back.
    pub fn wrap(&self, x: &mut [f64; D]) {
        for (k, c) in x.iter_mut().enumerate() {
            if self.sides[k][0] == Side::Periodic {
                *c -= self.length(k) * ((*c - self.min[k]) / self.length(k)).floor();
            }
        }
    }
}
