//! Shapes of bodies, regions and parts of faces, as a scene writes them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
}

impl Axis {
    /// 0, 1, 2 for x, y, z.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }
}

/// A face of a box, by the direction that it looks to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Face {
    /// Towards lesser x.
    #[serde(rename = "x-")]
    XLow,
    /// Towards greater x.
    #[serde(rename = "x+")]
    XHigh,
    /// Towards lesser y.
    #[serde(rename = "y-")]
    YLow,
    /// Towards greater y.
    #[serde(rename = "y+")]
    YHigh,
    /// Towards lesser z.
    #[serde(rename = "z-")]
    ZLow,
    /// Towards greater z.
    #[serde(rename = "z+")]
    ZHigh,
}

impl Face {
    /// Number of the axis across it, and whether it is the upper one of that axis.
    #[must_use]
    pub fn side(self) -> (usize, bool) {
        match self {
            Self::XLow => (0, false),
            Self::XHigh => (0, true),
            Self::YLow => (1, false),
            Self::YHigh => (1, true),
            Self::ZLow => (2, false),
            Self::ZHigh => (2, true),
        }
    }
}

/// A box along the axes; faces `x-`, `x+`, `y-`, `y+`, `z-`, `z+`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxShape {
    /// Name, put before the names of its faces: `plate.x-`; none if absent.
    pub name: Option<String>,
    /// Lower corner; two numbers in a plane scene.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub min_m: Vec<f64>,
    /// Upper corner.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub max_m: Vec<f64>,
}

/// A round bar along an axis; faces `side`, `bottom`, `top`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Name, put before the names of its faces; none if absent.
    pub name: Option<String>,
    /// Centre of the bar.
    #[schemars(extend("x-unit" = "m"), length(min = 3, max = 3))]
    pub centre_m: Vec<f64>,
    /// Direction of the bar.
    #[serde(default = "along_z")]
    pub axis: Axis,
    /// Radius.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
    /// Length.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub length_m: f64,
}

fn along_z() -> Axis {
    Axis::Z
}

/// A disc of a plane scene; face `rim`. In space: an endless bar along z.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Name, put before the names of its faces; none if absent.
    pub name: Option<String>,
    /// Centre.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub centre_m: Vec<f64>,
    /// Radius.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
}

/// A ball; face `surface`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Name, put before the names of its faces; none if absent.
    pub name: Option<String>,
    /// Centre.
    #[schemars(extend("x-unit" = "m"), length(min = 3, max = 3))]
    pub centre_m: Vec<f64>,
    /// Radius.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
}

/// An ellipsoid with axes along those of the scene, or turned; face `surface`. An ellipse in a plane scene, face `rim`; about an
/// axis, and centred on it, the section of a spheroid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EllipsoidShape {
    /// Name, put before the names of its faces; none if absent.
    pub name: Option<String>,
    /// Centre; two numbers in a plane scene.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub centre_m: Vec<f64>,
    /// Half its length along each axis, above zero; two numbers in a plane scene.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub semi_axes_m: Vec<f64>,
}

/// All that lies behind a plane; face `plane`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HalfSpace {
    /// Name, put before the names of its faces; none if absent.
    pub name: Option<String>,
    /// A place on the plane.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub point_m: Vec<f64>,
    /// Direction out of the half space.
    #[schemars(extend("x-unit" = "1"), length(min = 2, max = 3))]
    pub normal: Vec<f64>,
}

/// Unit of the lengths in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LengthUnit {
    /// Millimetres.
    Mm,
    /// Centimetres.
    Cm,
    /// Metres.
    M,
    /// Inches.
    Inch,
}

/// A closed surface of triangles from a file (STL, text or binary); face `surface`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stl {
    /// Name, put before the name of its face; none if absent.
    pub name: Option<String>,
    /// The file, beside the scene.
    pub file: String,
    /// Unit of the lengths in the file; the file itself does not say it.
    pub unit: LengthUnit,
    /// Place of the origin of the file; the origin of the scene when it is absent.
    #[schemars(extend("x-unit" = "m"), length(min = 3, max = 3))]
    pub at_m: Option<Vec<f64>>,
    /// Hash of the file as it was read; only in artefacts.
    pub sha256: Option<String>,
    /// Corners of its triangles as they were read; only in artefacts, which can be run again without the file.
    #[schemars(extend("x-unit" = "m"))]
    pub vertices_m: Option<Vec<[f64; 3]>>,
    /// Its triangles, by numbers of corners; only in artefacts.
    pub triangles: Option<Vec<[usize; 3]>>,
}

/// A shape turned about an axis through a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turned {
    /// The shape that is turned.
    pub shape: Box<Shape>,
    /// Axis of the turn.
    #[serde(default = "along_z")]
    pub axis: Axis,
    /// Angle, right-handed about the axis.
    pub angle_deg: f64,
    /// A place on the axis of the turn; the origin when it is absent.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub about_m: Option<Vec<f64>>,
}

/// A shape, named after what it is: `{"box": {...}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A box along the axes.
    Box(BoxShape),
    /// A round bar.
    Cylinder(Cylinder),
    /// A disc of a plane scene.
    Disc(Disc),
    /// A ball.
    Sphere(Sphere),
    /// An ellipsoid, an ellipse of a plane scene.
    Ellipsoid(EllipsoidShape),
    /// All behind a plane.
    HalfSpace(HalfSpace),
    /// A closed surface from a file.
    Stl(Stl),
    /// A shape turned.
    Turned(Turned),
    /// What is in any of the shapes.
    Union(Vec<Shape>),
    /// What is in all of the shapes.
    Intersection(Vec<Shape>),
    /// What is in the first shape and in none of the others.
    Difference(Vec<Shape>),
}
