//! Walls in a scene.

use run::Fault;
use run::property::Property;
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::{Shape, check};

use super::faces::Face;
use super::light::LightScene;

/// A wall.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallScene {
    /// What it looks like.
    pub shape: Shape,
    /// The wall is all that lies outside the shape, for example a box in which grains lie; each side of the box is a contact of
    /// its own.
    #[serde(default)]
    pub hollow: bool,
    /// Velocity, numbers or formulas in t; at rest if absent.
    #[schemars(extend("x-unit" = "m/s"))]
    pub velocity_m_s: Option<[Property; 3]>,
    /// Velocity of the surface along itself, in addition to that of the wall: for a wire that is fed. Numbers or formulas in t; none
    /// if absent.
    #[schemars(extend("x-unit" = "m/s"))]
    pub surface_m_s: Option<[Property; 3]>,
    /// Pressure of its surface on the grains beside it: a cavity. Absent: none.
    #[schemars(extend("x-unit" = "Pa"))]
    pub pressure_pa: Option<f64>,
    /// Radiation of an arc that the grains behind this surface absorb, and what they radiate; absent: none.
    pub light: Option<LightScene>,
    /// Coefficient of friction on this wall, if it is another.
    #[schemars(range(min = 0.0), extend("x-unit" = "1"))]
    pub friction: Option<f64>,
    /// The wall, a half space, is a plane of symmetry: a grain meets its own image in it, and what lies beyond is neither lit nor
    /// pressed.
    #[serde(default)]
    pub mirror: bool,
}

impl WallScene {
    /// Every fault of the wall, at keys within it.
    #[must_use]
    pub fn faults(&self) -> Vec<Fault> {
        let mut misfits = Vec::new();
        check::check(&self.shape, "/shape", 3, &mut misfits);
        let mut faults: Vec<Fault> = misfits
            .into_iter()
            .map(|m| Fault::at(&m.path, m.what))
            .collect();
        if self.mirror && faults.is_empty() {
            faults.extend(self.no_mirror());
        }
        faults
    }

    /// What a plane of symmetry cannot be.
    fn no_mirror(&self) -> Option<Fault> {
        let flat = matches!(Face::outside(&self.shape)[..], [Face::Plane(..)]);
        let others = [
            (self.hollow, "hollow"),
            (self.velocity_m_s.is_some(), "velocity_m_s"),
            (self.surface_m_s.is_some(), "surface_m_s"),
            (self.pressure_pa.is_some(), "pressure_pa"),
            (self.light.is_some(), "light"),
            (self.friction.is_some(), "friction"),
        ];
        let other = others.into_iter().find(|(there, _)| *there);
        let what = match other {
            Some((_, key)) => {
                format!("means nothing beside '{key}': a mirror only shows what is before it")
            }
            None if flat => return None,
            None => "needs a shape 'half_space': a mirror is a plane".to_owned(),
        };
        Some(Fault::at("/mirror", what))
    }
}
