//! Which medium is where, how far the surfaces are, and how fine points should be.
//!
//! All places here are coordinates of the scene: (x, y, 0), (r, z, 0) or (x, y, z).

use shapes::Body;
use shapes::frame::{Vector, difference, length};

use super::points::{Points, Refinement, Steps};
use crate::geometry::{self, Geometry};

/// Name of the medium around all bodies.
pub const SURROUNDINGS: &str = "surroundings";

/// The wall of the domain.
#[derive(Debug, Clone, PartialEq)]
pub enum Wall {
    /// Corners \[m\]; `open` tells that the first coordinate begins on the axis, where there is no wall.
    Box {
        /// Lower corner.
        low: Vector,
        /// Upper corner.
        high: Vector,
        /// Whether `low[0]` is the axis.
        axis: bool,
    },
    /// Centre and radius \[m\].
    Ball {
        /// Centre.
        centre: Vector,
        /// Radius.
        radius: f64,
    },
}

impl Wall {
    /// Names of its faces.
    #[must_use]
    pub fn faces(&self, geometry: Geometry) -> Vec<&'static str> {
        match self {
            Self::Box { .. } => geometry.walls(),
            Self::Ball { .. } => vec![geometry::BALL],
        }
    }

    /// Least extent of what it holds \[m\].
    fn least(&self, dimensions: usize) -> f64 {
        match self {
            Self::Box { low, high, .. } => (0..dimensions)
                .map(|k| high[k] - low[k])
                .fold(f64::INFINITY, f64::min),
            Self::Ball { radius, .. } => 2.0 * radius,
        }
    }
}

/// A body with its points' spacing.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Name.
    pub name: String,
    /// Shape.
    pub body: Body,
    /// Distance of points along the surface \[m\].
    pub spacing: f64,
    /// How far its layers reach inside and outside \[m\].
    pub reach: [f64; 2],
    /// Rise of the spacing of the lattice per distance from it, inside and outside.
    growth: [f64; 2],
}

impl Solid {
    /// A body before it stands among others, without layers.
    #[must_use]
    pub fn new(name: String, body: Body, spacing: f64) -> Self {
        Self {
            name,
            body,
            spacing,
            reach: [0.0; 2],
            growth: [0.0; 2],
        }
    }

    /// Its extents over its spacing.
    pub(super) fn widths(&self, dimensions: usize) -> impl Iterator<Item = f64> + Clone {
        let [low, high] = self.body.bounds();
        let spacing = self.spacing;
        (0..dimensions).map(move |a| (high[a] - low[a]) / spacing)
    }
}

/// A region with finer points.
#[derive(Debug, Clone, PartialEq)]
struct Finer {
    body: Body,
    spacing: f64,
    /// Rise of the spacing of the lattice per distance from it.
    growth: f64,
}

/// Fastest rise of spacings outward that nobody asked for.
const STEEPEST: f64 = 0.25;

/// The rise of the spacing outward from a body that makes points as dense, seen from its middle, everywhere: over half its least
/// width, so that refining it refines all.
fn proportional(body: &Body, spacing: f64, dimensions: usize) -> f64 {
    let [low, high] = body.bounds();
    let widths = (0..dimensions).map(|a| high[a] - low[a]);
    let half = 0.5 * widths.fold(f64::INFINITY, f64::min);
    (spacing / half).min(STEEPEST)
}

/// Domain, bodies and wanted spacing.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// What its coordinates are.
    pub geometry: Geometry,
    /// 2 or 3.
    pub dimensions: usize,
    /// The wall.
    pub wall: Wall,
    /// Bodies; where two overlap, the first counts.
    pub solids: Vec<Solid>,
    /// Regions with finer points.
    finer: Vec<Finer>,
    /// Finest spacing of the lattice \[m\].
    pub spacing: f64,
    /// Spacing where there is neither body nor refinement \[m\].
    plain: f64,
    /// Greatest spacing \[m\].
    pub largest: f64,
    /// How many times as far apart as usual points of lattices far from bodies are.
    wider: f64,
    /// Whether there are lattices between those of single and of double spacing.
    pub smooth: bool,
}

/// Coordinates, filled up with zeros.
#[must_use]
pub fn vector(coordinates: &[f64]) -> Vector {
    std::array::from_fn(|k| coordinates.get(k).copied().unwrap_or(0.0))
}

impl Layout {
    /// A ball in space without bodies, with lattices from one spacing to a greater one \[m\].
    pub(crate) fn ball(centre: Vector, radius: f64, [spacing, largest]: [f64; 2]) -> Self {
        Self {
            geometry: Geometry::Space,
            dimensions: 3,
            wall: Wall::Ball { centre, radius },
            finer: Vec::new(),
            spacing,
            plain: largest,
            largest,
            wider: 1.0,
            smooth: true,
            solids: Vec::new(),
        }
    }

    /// Bodies within a wall, and how fine points are about them.
    #[must_use]
    pub fn new(geometry: Geometry, wall: Wall, mut solids: Vec<Solid>, points: &Points) -> Self {
        let dimensions = geometry.dimensions();
        let outward = |body: &Body, spacing: f64| {
            let own = || proportional(body, spacing, dimensions);
            points.outward.unwrap_or_else(own)
        };
        for solid in &mut solids {
            solid.growth = [points.inward, outward(&solid.body, solid.spacing)];
        }
        let finer = |refinement: &Refinement| {
            let (body, spacing) = (
                Body::new(&refinement.shape, dimensions),
                refinement.spacing_m,
            );
            Finer {
                growth: outward(&body, spacing),
                body,
                spacing,
            }
        };
        let finer: Vec<Finer> = points.refinements.iter().map(finer).collect();
        let eighth = || wall.least(dimensions) / 8.0;
        let largest = points
            .largest_m
            .unwrap_or_else(eighth)
            .max(points.spacing_m);
        let all = solids.iter().map(|s| s.spacing);
        let finest = all
            .chain(finer.iter().map(|f| f.spacing))
            .fold(points.spacing_m, f64::min);
        Self {
            geometry,
            dimensions,
            wall,
            finer,
            spacing: finest,
            plain: if solids.is_empty() {
                points.spacing_m
            } else {
                largest
            },
            largest,
            wider: 1.0,
            smooth: points.steps == Steps::Smooth,
            solids,
        }
    }

    /// Whether r = x is a distance from the axis.
    #[must_use]
    pub fn axisymmetric(&self) -> bool {
        self.geometry == Geometry::Axisymmetric
    }

    /// The same with points of lattices far from bodies so many times as far apart; those of surfaces, layers and beside them
    /// stay.
    #[must_use]
    pub(super) fn wider(mut self, by: f64) -> Self {
        if !self.solids.is_empty() {
            (self.plain, self.largest) = (by * self.plain, by * self.largest);
        }
        self.wider = by;
        self
    }

    /// Distance to the wall \[m\], positive within the domain.
    #[must_use]
    pub fn depth(&self, x: Vector) -> f64 {
        match &self.wall {
            Wall::Box { low, high, axis } => (0..self.dimensions)
                .map(|k| {
                    let left = if k == 0 && *axis {
                        f64::INFINITY
                    } else {
                        x[k] - low[k]
                    };
                    left.min(high[k] - x[k])
                })
                .fold(f64::INFINITY, f64::min),
            Wall::Ball { centre, radius } => radius - length(difference(x, *centre)),
        }
    }

    /// Whether a body of whose surface nothing lies in the domain lies outside: neither does it fill the domain, nor is it hidden
    /// by others within.
    #[must_use]
    pub fn leaves_out(&self, k: usize) -> bool {
        let body = &self.solids[k].body;
        let between = |low: Vector, high: Vector| -> Vector {
            std::array::from_fn(|a| {
                if a < self.dimensions {
                    0.5 * (low[a] + high[a])
                } else {
                    0.0
                }
            })
        };
        let [low, high] = body.bounds();
        let centre = match &self.wall {
            Wall::Box { low, high, .. } => between(*low, *high),
            Wall::Ball { centre, .. } => *centre,
        };
        self.depth(between(low, high)) < 0.0 && body.distance(centre) > 0.0
    }

    /// Least extent of the domain over the finest spacing of its lattice.
    #[must_use]
    pub fn across(&self) -> f64 {
        self.wall.least(self.dimensions) / self.spacing
    }

    /// The medium at a place: 0 the surroundings, `k + 1` body `k`; the first body that holds it counts.
    #[must_use]
    pub fn medium(&self, x: Vector) -> u16 {
        let inside = self.solids.iter().position(|s| s.body.distance(x) < 0.0);
        inside.map_or(0, |k| k as u16 + 1)
    }

    /// Distance of the nearest surface of a body \[m\], and its number; infinite without bodies.
    #[must_use]
    pub fn nearest(&self, x: Vector) -> (f64, usize) {
        let mut best = (f64::INFINITY, 0);
        for (k, solid) in self.solids.iter().enumerate() {
            let d = solid.body.distance(x);
            if d.abs() < best.0.abs() {
                best = (d, k);
            }
        }
        best
    }

    /// Spacing of points on the surface of body `k` that those of finer bodies and regions leave at a place \[m\]: as the
    /// lattice grows away from these, so does what stands among its points.
    #[must_use]
    pub fn beside(&self, x: Vector, k: usize) -> f64 {
        self.beside_near(x, k, 0.0)
    }

    /// The least of [`Self::beside`] within `reach` of a place.
    pub(super) fn beside_near(&self, x: Vector, k: usize, reach: f64) -> f64 {
        let own = self.solids[k].spacing;
        let finer = self.solids.iter().filter(|other| other.spacing < own);
        let bodies = finer.fold(own, |spacing, other| {
            let d = other.body.distance(x);
            let growth = other.growth[usize::from(d > 0.0)];
            spacing.min(other.spacing + growth * (d.abs() - reach).max(0.0))
        });
        self.finer.iter().fold(bodies, |spacing, finer| {
            let away = (finer.body.distance(x) - reach).max(0.0);
            spacing.min(finer.spacing + finer.growth * away)
        })
    }

    /// The fastest that wanted spacings change per distance.
    #[must_use]
    pub fn steepest(&self) -> f64 {
        let solids = self.solids.iter().flat_map(|solid| solid.growth);
        let finer = self.finer.iter().map(|finer| finer.growth);
        self.wider * solids.chain(finer).fold(0.0, f64::max)
    }

    /// The largest spacing that is wanted anywhere \[m\].
    pub(super) fn widest(&self) -> f64 {
        let solids = self.solids.iter().map(|solid| solid.spacing);
        solids.fold(self.plain, f64::max)
    }

    /// Wanted spacing of the lattice at a place \[m\]; `nearer` is how much nearer to everything a place within a
    /// cell may be.
    #[must_use]
    pub fn wanted(&self, x: Vector, nearer: f64) -> f64 {
        let mut spacing = self.plain;
        let mut widen = |from: f64, growth: f64, away: f64| {
            spacing = spacing.min(from + growth * (away - nearer).max(0.0));
        };
        for solid in &self.solids {
            let d = solid.body.distance(x);
            let side = usize::from(d > 0.0);
            // A cell that the surface may cross has the finest points of both sides.
            let away = d.abs()
                - if d.abs() > nearer {
                    solid.reach[side]
                } else {
                    0.0
                };
            widen(solid.spacing, self.wider * solid.growth[side], away);
        }
        for finer in &self.finer {
            widen(
                finer.spacing,
                self.wider * finer.growth,
                finer.body.distance(x),
            );
        }
        spacing
    }
}
