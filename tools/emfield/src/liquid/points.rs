//! Points of a liquid and what they carry.

use std::ops::Range;

use super::borne::Borne;
use super::operators::Fits;
use super::room::Room;
use super::vector::along;

/// Points of the liquid, those of the surface first, then those on walls, and what they carry.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Liquid<const D: usize> {
    /// Places \[m\].
    pub position: Vec<[f64; D]>,
    /// Velocity \[m/s\].
    pub velocity: Vec<[f64; D]>,
    /// Pressure, less the weight that faces bear ([`super::room`]) \[Pa\].
    pub pressure: Vec<f64>,
    /// Rate of the velocity of each point along its way, in the last stage \[m/s2\].
    pub rate: Vec<[f64; D]>,
    /// Velocities of points that follow the surface, in the last stage; nothing where those inside go with the liquid \[m/s\].
    pub follow: Vec<[f64; D]>,
    /// Unit normals of the points of the surface.
    pub normal: Vec<[f64; D]>,
    /// Normal stress of friction on the surface, and what friction adds to its tension within a stage; on walls what it adds to
    /// the slope of the pressure, times the spacing \[Pa\].
    pub stress: Vec<f64>,
    /// Traction of fields on the surface, outward, and how fast it changes \[Pa, Pa/s\]; none where there is no field.
    pub pull: [Vec<f64>; 2],
    /// Traction of a field along the surface \[Pa\]; nothing where there is none.
    pub drag: Vec<[f64; D]>,
    /// Charge of the surface of a conductor \[C/m2\]; nothing where there is none.
    pub charge: Vec<f64>,
    /// Force density of fields beside that traction, which stirs alone (see [`super::stirred`]), by point, and how fast it
    /// changes \[N/m3, N/(m3 s)\]; none where there is none.
    pub force: [Vec<[f64; D]>; 2],
    /// Faces that bound it beside the surface.
    pub room: Room<D>,
    /// Fits that its points take with them; nothing where drops meet and part, whose points crowd in necks.
    pub borne: Option<Borne<D>>,
}

impl<const D: usize> Liquid<D> {
    /// Number of points on the surface.
    #[must_use]
    pub fn surface(&self) -> usize {
        self.normal.len()
    }

    /// Whether its points go with the liquid, those of the surface too: nothing but the surface bounds it, and no field stirs it or
    /// drags along the surface. A stream along a surface that stays would crowd them.
    #[must_use]
    pub fn loose(&self) -> bool {
        self.follow.is_empty() && self.drag.is_empty() && !self.room.bounds()
    }

    /// What fits of derivatives are like: between faces and where points go with the liquid they pass through their own points,
    /// and their values, where they are wanted, are fitted apart.
    #[must_use]
    pub fn fits(&self, value: bool) -> Fits {
        let through = self.room.bounds() || self.loose();
        Fits {
            through,
            value: value && !through,
        }
    }

    /// Points on walls.
    #[must_use]
    pub fn walls(&self) -> Range<usize> {
        self.surface()..self.surface() + self.room.held.len()
    }

    /// The normal of a wall at one of its points.
    pub(super) fn wall(&self, i: usize) -> Option<&[f64; D]> {
        self.room.held.get(i.checked_sub(self.surface())?)
    }

    /// The middle of the points of the surface \[m\].
    #[must_use]
    pub fn middle(&self) -> [f64; D] {
        let share = (self.surface() as f64).recip();
        let surface = self.position[..self.surface()].iter();
        surface.fold([0.0; D], |sum, x| along(&sum, share, x))
    }
}
