//! What is written.

use run::scene::FloatWidth;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::Shape;
use steps::instants::{Instant, every, merged};

/// A place whose fields are written.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name.
    pub name: String,
    /// Place.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub place_m: Vec<f64>,
}

/// A straight line along which fields are written.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Name.
    pub name: String,
    /// First place.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub from_m: Vec<f64>,
    /// Last place.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub to_m: Vec<f64>,
    /// Number of places on the line, both ends included.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub points: usize,
}

/// The surface of a body, moved outward.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Around {
    /// Name of the body.
    pub body: String,
    /// How far each of its faces is moved outward.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub distance_m: f64,
}

/// A closed surface.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Closed {
    /// That of a shape; in an axisymmetric scene the section in r and z: a disc on the axis is a ball.
    Shape(Shape),
    /// That of a body, moved outward.
    Around(Around),
}

/// A closed surface around bodies, in a medium that does not conduct: the total force on what it encloses is the
/// integral of Maxwell's stress over it.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Enclosure {
    /// Name, in front of its totals: `NAME.force_z`.
    pub name: String,
    /// The surface.
    pub surface: Closed,
    /// Distance of the places at which fields are evaluated; that of `points` when it is absent.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: Option<f64>,
}

/// What is written: the fields of all points at the end, in a march at its start too, and what is asked for here.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Width of the floats.
    #[serde(default)]
    pub precision: FloatWidth,
    /// Whether the points on interfaces are written as a frame of their own, with normal, area and traction.
    #[serde(default = "yes")]
    pub surface: bool,
    /// Places whose fields are written.
    #[serde(default)]
    pub probes: Vec<Probe>,
    /// Lines along which fields are written.
    #[serde(default)]
    pub lines: Vec<Line>,
    /// Closed surfaces around bodies whose total force is written: of electrostatics, and of eddy currents (with the
    /// heat within them in a sinusoidal steady state), each with the largest difference from the force found at the
    /// bodies themselves.
    #[serde(default)]
    #[schemars(length(max = 100))]
    pub enclosures: Vec<Enclosure>,
    /// Times of frames and probes of a march in time, rising, beside its start and end: steps end there.
    #[serde(default)]
    #[schemars(extend("x-unit" = "s"))]
    pub at_s: Vec<f64>,
    /// Interval of frames and probes of a march in time: steps end at its multiples.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub every_s: Option<f64>,
}

fn yes() -> bool {
    true
}

impl Output {
    /// Instants of frames after the start of a march up to `end` \[s\], rising, the end last.
    pub(crate) fn instants(&self, end: f64) -> Vec<f64> {
        let typed = self.at_s.iter().copied();
        let often = self.every_s.into_iter().flat_map(|s| every(s, end));
        let all = typed.chain(often).map(Instant::whole).collect();
        let after = merged(all, end, artefact::one_time).into_iter().skip(1);
        let after: Vec<f64> = after.map(|instant| instant.time).collect();
        // A march that is shorter than times of frames are apart still has an end.
        if after.is_empty() { vec![end] } else { after }
    }
}

impl Default for Output {
    fn default() -> Self {
        Self {
            precision: FloatWidth::default(),
            surface: true,
            probes: Vec::new(),
            lines: Vec::new(),
            enclosures: Vec::new(),
            at_s: Vec::new(),
            every_s: None,
        }
    }
}
