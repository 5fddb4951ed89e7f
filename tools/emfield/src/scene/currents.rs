//! Eddy currents in a scene: what drives them, and how they change in time.

use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::check::Misfit;
use steps::Legs;

use super::{Geometry, Output};

/// What the currents and fields of a scene mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Amplitude {
    /// Root mean square.
    #[default]
    Rms,
    /// Greatest value of a period.
    Peak,
}

/// A sinusoidal steady state.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Frequency.
    #[schemars(range(max = 1e12), extend("x-unit" = "Hz", "exclusiveMinimum" = 0.0))]
    pub frequency_hz: f64,
}

/// Fields that stand still.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Static {}

/// A march in time of second order, from rest.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Transient {
    /// End.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub end_s: f64,
    /// Step.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub step_s: f64,
    /// What coils and applied fields are multiplied by, a function of t; 1 when it is absent: switched on at the
    /// start.
    #[schemars(extend("x-unit" = "1"))]
    pub wave: Option<Property>,
    /// Steps that grow where their error allows; absent: all steps have one length.
    pub adaptive: Option<Adaptive>,
}

/// Steps of 1, 2, 4, 8 ... times `step_s`, as long as their error and what drives the currents allow. Frames keep their times. A step
/// of `step_s` itself always stands.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Adaptive {
    /// Estimated error of the vector potential that a step may make, over its greatest value so far; 1e-4 when it is absent. Both are
    /// means over what conducts.
    #[serde(default = "tolerance")]
    #[schemars(range(max = 0.1), extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
    /// Longest step to which they may grow; absent: up to the next frame.
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub greatest_s: Option<f64>,
}

fn tolerance() -> f64 {
    1e-4
}

impl Transient {
    /// Steps that are asked to grow and may not even have their first length.
    pub(super) fn narrow(&self) -> Option<Misfit> {
        let most = self.adaptive?.greatest_s?;
        (most < self.step_s).then(|| {
            let what = format!(
                "{most} s is shorter than the shortest step, {} s",
                self.step_s
            );
            Misfit::at("/eddy_currents/transient/adaptive/greatest_s", what)
        })
    }

    /// Its steps, which end at each instant that is written.
    pub(crate) fn steps(&self, output: &Output) -> Legs {
        Legs::new(self.step_s, output.instants(self.end_s))
    }
}

/// A circular loop.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Loop {
    /// Centre; (r, z) = (0, z) in an axisymmetric scene.
    #[schemars(extend("x-unit" = "m"), length(min = 2, max = 3))]
    pub centre_m: Vec<f64>,
    /// Axis, right-handed with the current; z when it is absent.
    #[schemars(extend("x-unit" = "1"), length(min = 3, max = 3))]
    pub normal: Option<[f64; 3]>,
    /// Radius.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
    /// Radius of the wire, over whose section the current is spread; a thin wire when it is absent.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub wire_radius_m: Option<f64>,
    /// Current.
    #[schemars(extend("x-unit" = "A"))]
    pub current_a: f64,
    /// Phase by which the current leads, in degrees.
    #[serde(default)]
    pub phase_deg: f64,
    /// Number of turns.
    #[serde(default = "one")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub turns: f64,
}

/// A chain of straight segments.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segments {
    /// Ends of the segments, in the direction of the current.
    #[schemars(extend("x-unit" = "m"), length(min = 2))]
    pub points_m: Vec<[f64; 3]>,
    /// Whether the last point is joined to the first.
    #[serde(default = "yes")]
    pub closed: bool,
    /// Current.
    #[schemars(extend("x-unit" = "A"))]
    pub current_a: f64,
    /// Phase by which the current leads, in degrees.
    #[serde(default)]
    pub phase_deg: f64,
}

/// An endless straight wire along z, in a plane scene.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wire {
    /// Place.
    #[schemars(extend("x-unit" = "m"))]
    pub place_m: [f64; 2],
    /// Current along z.
    #[schemars(extend("x-unit" = "A"))]
    pub current_a: f64,
    /// Phase by which the current leads, in degrees.
    #[serde(default)]
    pub phase_deg: f64,
}

/// An axis in space.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// A place on it.
    #[schemars(extend("x-unit" = "m"))]
    pub centre_m: [f64; 3],
    /// Its direction, right-handed with the current.
    #[schemars(extend("x-unit" = "1"))]
    pub normal: [f64; 3],
}

/// A body of the scene as a coil: its points carry a current, spread evenly over the section, and what it makes is
/// computed with everything else. The body does not conduct by itself. A loop or wire costs less, and errs less.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Region")]
pub struct RegionCoil {
    /// Name of the body.
    pub body: String,
    /// Axis around which the current flows, in space; that of the scene where it is axisymmetric. In a plane it flows
    /// along z.
    pub axis: Option<Axis>,
    /// Current of one turn; `turns` times this flows through the section.
    #[schemars(extend("x-unit" = "A"))]
    pub current_a: f64,
    /// Phase by which the current leads, in degrees.
    #[serde(default)]
    pub phase_deg: f64,
    /// Number of turns.
    #[serde(default = "one")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub turns: f64,
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

/// A coil: one whose own field is known exactly, or a region of points.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Coil {
    /// A circular loop, by elliptic integrals.
    Loop(Loop),
    /// Straight segments, by Biot and Savart's law.
    Segments(Segments),
    /// An endless wire along z.
    Wire(Wire),
    /// A body of the scene, by its points.
    Region(RegionCoil),
}

impl Coil {
    /// The region of points that it is, if it is one.
    #[must_use]
    pub fn region(&self) -> Option<&RegionCoil> {
        match self {
            Self::Region(region) => Some(region),
            Self::Loop(_) | Self::Segments(_) | Self::Wire(_) => None,
        }
    }
}

/// What holds for the field of the eddy currents, and of coils of points, at the walls of the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum OuterReaction {
    /// It is zero there: a box far away.
    #[default]
    Zero,
    /// It is that of the multipoles of the currents found inside, and of all that is given in coils of points: no error
    /// of truncation beyond them.
    Multipole,
}

/// What is computed of the charges that a changing field drives to the surfaces of conductors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ElectricPotential {
    /// Nothing: by symmetry no current would leave a conductor without them, as in a ball among coaxial loops.
    None,
    /// Their potential V in all conductors.
    Conductors,
}

/// What a uniform field comes from: where it drives no current, the electric field depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Magnet {
    /// A long round solenoid along the field: A = B x (r - centre) / 2.
    Solenoid {
        /// A place on its axis.
        #[schemars(extend("x-unit" = "m"))]
        centre_m: [f64; 3],
    },
    /// Two wide plane sheets of opposite currents, parallel to the field: A = (n . r) B x n.
    Sheets {
        /// Their normal, square to the field.
        #[schemars(extend("x-unit" = "1"))]
        normal: [f64; 3],
    },
}

/// Currents that a changing magnetic field drives (Matsuzawa 2017, eqs 2.64-2.69).
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EddyCurrents {
    /// A sinusoidal steady state; this, `transient` or `static`.
    pub harmonic: Option<Harmonic>,
    /// A march in time; this, `harmonic` or `static`.
    pub transient: Option<Transient>,
    /// Fields that stand still, which drive no currents; this, `harmonic` or `transient`.
    #[serde(rename = "static")]
    pub standing: Option<Static>,
    /// Coils.
    #[serde(default)]
    pub coils: Vec<Coil>,
    /// A uniform field that acts from far away. In a plane scene a field along z (0, 0, B) drives currents in the
    /// plane, one in the plane drives them along z, through bars whose ends are joined far away: its potential is
    /// counted from the centre of what conducts, so that one bar carries none as a whole, unless a body has a
    /// `net_current_a`; axisymmetric: along z (0, B).
    #[schemars(extend("x-unit" = "T"), length(min = 2, max = 3))]
    pub applied_flux_density_t: Option<Vec<f64>>,
    /// What the uniform field comes from, in space; a solenoid about the origin when it is absent.
    pub magnet: Option<Magnet>,
    /// Whether currents and the applied field of a sinusoidal steady state are given as root mean square or as peak values.
    #[serde(default)]
    pub amplitude: Amplitude,
    /// Condition at the walls of the domain.
    #[serde(default)]
    pub outer: OuterReaction,
    /// Charges on the surfaces of conductors; when it is absent, they are computed in space. In a plane and about an axis there
    /// are none.
    pub potential: Option<ElectricPotential>,
}

impl EddyCurrents {
    /// What a current or field of the scene is as root mean square; unchanged in a march in time.
    #[must_use]
    pub fn rms(&self, value: f64) -> f64 {
        match (self.amplitude, &self.harmonic) {
            (Amplitude::Peak, Some(_)) => value * std::f64::consts::FRAC_1_SQRT_2,
            _ => value,
        }
    }

    /// Whether charges on conductors are computed in a scene of this geometry.
    #[must_use]
    pub fn charged(&self, geometry: Geometry) -> bool {
        let moves = self.standing.is_none();
        moves && geometry == Geometry::Space && self.potential != Some(ElectricPotential::None)
    }

    /// Angular frequency of a sinusoidal steady state \[rad/s\].
    #[must_use]
    pub fn angular_frequency(&self) -> Option<f64> {
        self.harmonic
            .map(|h| std::f64::consts::TAU * h.frequency_hz)
    }
}
