//! Points of the domain: on surfaces, on walls, in layers, on lattices.
//!
//! A cloud is all that the equations know of geometry: where points are, how far apart, to which medium they belong or
//! which media they part, how much of a conductor each stands for. See [`Cloud`].
//!
//! - [`layout`]: which medium is where; [`points`]: which points are wanted; [`setup`]: both from a scene;
//! - `build`: from these to points, step by step; `doubts`: bodies that they do not resolve;
//! - `lattice`: nested lattices; `occupied`: points already placed; `jitter`: random shifts.

mod build;
mod doubts;
pub(crate) mod jitter;
pub(crate) mod lattice;
pub mod layout;
pub(crate) mod occupied;
pub mod points;
pub mod setup;

pub use build::surface::Curvature;
pub(crate) use build::surface::seeds;

use crate::geometry::Geometry;
use layout::Layout;
use points::Points;
use run::Fault;
use shapes::frame::{Vector, difference, dot};

/// Where a point stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Inside a medium: 0 the surroundings, `k + 1` body `k`.
    Inside(u16),
    /// On the surface of a body.
    Interface {
        /// The body's medium.
        inner: u16,
        /// The medium around it.
        outer: u16,
    },
    /// On the wall of the domain.
    Outer {
        /// The medium there.
        medium: u16,
        /// Number of the wall, in [`Cloud::faces`].
        face: u8,
    },
}

/// How offsets from a point are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Metric {
    /// Alike in all directions, over the point's spacing.
    Round,
    /// Flat beside a surface.
    Layered {
        /// Normal of the surface.
        normal: Vector,
        /// Spacing along it \[m\].
        across: f64,
        /// Spacing along the surface \[m\].
        along: f64,
        /// Where it stands on the surface, in [`Cloud::feet`].
        foot: u32,
    },
}

/// Where a column of layers stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Place on the surface \[m\].
    pub place: Vector,
    /// How the surface bends there.
    pub curvature: Curvature,
    /// Its thinnest layer is so thin that offsets follow the surface.
    pub thin: bool,
}

/// What a surface point knows of its surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// The point.
    pub point: u32,
    /// Medium of the body.
    pub inner: u16,
    /// Medium around it.
    pub outer: u16,
    /// From the inner medium to the outer one.
    pub normal: Vector,
    /// Area \[m2\]; length per metre of depth in a plane; of the full turn where the scene is axisymmetric. In space, where
    /// points stand closer here than there, the weight of the point in sums over the surface.
    pub area: f64,
}

/// The part of a conductor that a point stands for: volume, with moments about the point in coordinates of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cell {
    /// Volume \[m3; m2 in a plane; full turn where axisymmetric\].
    pub volume: f64,
    /// First moments \[m4\].
    pub first: Vector,
    /// Second moments \[m5\].
    pub second: [Vector; 3],
}

impl Cell {
    /// Adds a piece by its volume, the way to its middle, and its second moments about that over its volume.
    fn add(&mut self, volume: f64, way: Vector, own: [Vector; 3]) {
        self.volume += volume;
        for a in 0..3 {
            self.first[a] += volume * way[a];
            for b in 0..3 {
                self.second[a][b] += volume * (way[a] * way[b] + own[a][b]);
            }
        }
    }

    fn scale(&mut self, by: f64) {
        self.volume *= by;
        self.first = self.first.map(|m| m * by);
        self.second = self.second.map(|row| row.map(|m| m * by));
    }
}

/// Points by kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// On surfaces of bodies.
    pub interface: usize,
    /// On walls.
    pub outer: usize,
    /// In layers.
    pub layers: usize,
    /// On lattices.
    pub lattice: usize,
}

/// Points of a domain, in this order: on interfaces, on walls, in layers, on lattices.
///
/// Places are those in space: (x, y, 0) in a plane, (r, 0, z) where the scene is axisymmetric; see
/// [`Geometry::flat`].
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    /// Geometry.
    pub geometry: Geometry,
    /// Names of media, the surroundings first.
    pub media: Vec<String>,
    /// The wall of the domain, in coordinates of the scene.
    pub wall: layout::Wall,
    /// Names of its faces.
    pub faces: Vec<&'static str>,
    /// The spacing where nothing asks for another \[m\].
    pub pitch: f64,
    /// How many points are given one by one: the last ones.
    pub further: usize,
    /// Places \[m\].
    pub position: Vec<Vector>,
    /// Distance to the neighbours, along the surface where points are layered \[m\].
    pub spacing: Vec<f64>,
    /// Where points stand.
    pub class: Vec<Class>,
    /// How offsets are measured.
    pub metric: Vec<Metric>,
    /// Where layered points stand.
    pub feet: Vec<Foot>,
    /// One entry for each interface point, in their order.
    pub surface: Vec<SurfacePoint>,
    /// What each point in or on a conductor stands for; a point on an interface stands for its inner medium. Empty
    /// where none does.
    pub cells: Vec<Cell>,
    /// Points by kind.
    pub counts: Counts,
}

/// What fills a layout.
#[derive(Debug, Clone, PartialEq)]
pub struct Filling<'a> {
    /// The points.
    pub points: &'a Points,
    /// Whether points stand for parts of each medium, see [`Cloud::cells`]; empty where they do so of none.
    pub shares: Vec<bool>,
    /// Radius of supports over the spacing, by which the memory of stencils is told.
    pub support: f64,
}

impl Cloud {
    /// The points of a layout.
    ///
    /// # Errors
    /// Too many points, a body without points.
    pub fn new(layout: Layout, filling: &Filling<'_>) -> Result<Self, Vec<Fault>> {
        build::cloud(layout, filling)
    }

    /// How many points a layout has at least, and the memory of these and of their stencils \[byte\].
    #[must_use]
    pub fn least(layout: &Layout, filling: &Filling<'_>) -> [f64; 2] {
        let least = build::count::least(layout, filling);
        [least.points, least.bytes]
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Whether a point lies in a medium or on its edge: whether a stencil of that medium may use it.
    #[must_use]
    pub fn touches(&self, point: usize, medium: u16) -> bool {
        match self.class[point] {
            Class::Inside(m) | Class::Outer { medium: m, .. } => m == medium,
            Class::Interface { inner, outer } => inner == medium || outer == medium,
        }
    }

    /// How the level of a layered point bends where layers are thin, `foot` and `normal` being those of its metric.
    #[must_use]
    pub fn curvature(&self, point: usize, foot: u32, normal: Vector) -> Option<Curvature> {
        let foot = &self.feet[foot as usize];
        let away = dot(difference(self.position[point], foot.place), normal);
        foot.thin.then(|| foot.curvature.beside(away))
    }

    /// Memory \[byte\].
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let each =
            size_of::<Vector>() + size_of::<f64>() + size_of::<Class>() + size_of::<Metric>();
        let more = self.surface.len() * size_of::<SurfacePoint>()
            + self.feet.len() * size_of::<Foot>()
            + self.cells.len() * size_of::<Cell>();
        (self.len() * each + more) as u64
    }
}

#[cfg(test)]
mod tests;
