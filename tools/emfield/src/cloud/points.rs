//! How points fill the domain.

use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;

/// Layers of points along the normals of a surface. Gaps between bodies narrower than three of the first layers have points
/// at their quarters instead.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layers {
    /// Distance of the first layer from the surface; that of points along the surface when it is absent.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub first_m: Option<f64>,
    /// Ratio of the distance between layers to the one before it (Matsuzawa 2017, eq. 2.70), until it is that of
    /// points along the surface.
    #[serde(default = "growth")]
    #[schemars(range(min = 1.0, max = 2.0), extend("x-unit" = "1"))]
    pub growth: f64,
    /// Number of layers inside; when it is absent, as many as are needed until their distance is that of points along the surface,
    /// at least 2.
    #[schemars(range(max = 200))]
    pub inside: Option<usize>,
    /// Number of layers outside; when it is absent, as many as are needed until their distance is that of points along the surface,
    /// at least 2.
    #[schemars(range(max = 200))]
    pub outside: Option<usize>,
}

fn growth() -> f64 {
    1.15
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            first_m: None,
            growth: growth(),
            inside: None,
            outside: None,
        }
    }
}

/// Arrangement of points inside bodies, beyond the layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Arrangement {
    /// The lattice of the surroundings.
    #[default]
    Lattice,
    /// Closest packing: triangles in a plane, face-centred cubes in space.
    Hexagonal,
}

/// How lattices follow each other outward.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Steps {
    /// Spacing grows by the square root of 2: every second point of a lattice stays, chessboard fashion
    /// (face-centred in space), then the lattice of twice the spacing.
    #[default]
    Smooth,
    /// Spacing doubles, as in the paper.
    Doubling,
}

/// A region with points of its own spacing.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Refinement {
    /// Region.
    pub shape: Shape,
    /// Greatest distance of points there.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: f64,
}

/// How points fill the domain.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Points {
    /// Distance of points along the surfaces of bodies, and of the lattice beside them.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: f64,
    /// Layers along the surfaces of bodies.
    #[serde(default)]
    pub layers: Layers,
    /// Layers within the wall of a sphere, for a domain that conducts; none when it is absent.
    pub wall_layers: Option<Layers>,
    /// Arrangement inside bodies.
    #[serde(default)]
    pub arrangement: Arrangement,
    /// Growth of the spacing of the lattice per distance from the bodies, outside of them. When it is absent: the spacing of each
    /// body over half its least width, at most 0.25, and likewise for regions with finer points; then a smaller `spacing_m` refines
    /// the points far away as well.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub outward: Option<f64>,
    /// The same inside bodies.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub inward: f64,
    /// Greatest spacing of a lattice; an eighth of the domain when it is absent.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub largest_m: Option<f64>,
    /// By which steps the spacing grows from one lattice to the next, away from the bodies.
    #[serde(default)]
    pub steps: Steps,
    /// Regions with finer points.
    #[serde(default)]
    pub refinements: Vec<Refinement>,
    /// Further points at given places inside the domain.
    #[serde(default)]
    #[schemars(extend("x-unit" = "m"))]
    pub extra_m: Vec<Vec<f64>>,
    /// Random shift of points that lie neither on interfaces nor on walls, at most this part of the spacing along
    /// each axis.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.45), extend("x-unit" = "1"))]
    pub jitter: f64,
    /// Seed of the random shifts.
    #[serde(default)]
    pub seed: u64,
}
