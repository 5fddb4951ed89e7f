//! Bodies in a scene.

use run::Fault;
use run::property::{Curve, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Lattice;
use crate::domain::bodies::{Body, Cut, Filled};
use crate::domain::round::MISSED;
use crate::domain::shape::Shape;
use crate::state::phase;

/// What a body is at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StartState {
    /// Rests until it melts.
    Solid,
    /// Moves.
    Liquid,
    /// Rests and never melts.
    Wall,
}

/// Which of two liquids a body is of.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Material {
    /// The metal.
    #[default]
    Metal,
    /// The slag of the key `slag`.
    Slag,
}

impl Material {
    fn is_metal(&self) -> bool {
        *self == Self::Metal
    }
}

/// A plane that cuts a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CutScene {
    /// A point of the plane \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub point_m: [f64; 3],
    /// Direction of what is cut off: kept is where (x - point) . normal <= 0.
    pub normal: [f64; 3],
}

/// A shape filled with particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyScene {
    /// What it looks like.
    pub shape: Shape,
    /// Solid, liquid or wall.
    pub state: StartState,
    /// Metal, or the second liquid of the key `slag`.
    #[serde(default, skip_serializing_if = "Material::is_metal")]
    pub material: Material,
    /// u at the start \[m/s\], each component a number or a formula in x, y, z, r; rest if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "m/s"))]
    pub velocity_m_s: Option<[Property; 3]>,
    /// T at the start \[K\], a number or a formula in x, y, z, r; needed where the scene has heat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "K"))]
    pub temperature_k: Option<Property>,
    /// T that the body keeps \[K\], a boundary value: a number or a formula in x, y, z, r, t. Absent: its temperature changes freely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "K"))]
    pub held_temperature_k: Option<Property>,
    /// Planes that cut it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cuts: Vec<CutScene>,
    /// Origin of its lattice \[m\]: points at origin + (i + 1/2) d. The lower corner of the box
    /// around the shape if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "m"))]
    pub lattice_m: Option<[f64; 3]>,
}

impl BodyScene {
    /// What is told of a body whose particles hold another volume, by those of the spacing \[m\].
    #[must_use]
    pub fn rounded(&self, filled: &Filled, spacing: f64) -> Option<String> {
        if filled.left_out > 0 || !self.cuts.is_empty() {
            return None;
        }
        let volume = self.shape.volume()?;
        let off = filled.placed as f64 * spacing.powi(3) / volume - 1.0;
        (off.abs() > MISSED)
            .then(|| format!("its particles hold {:+.1} % of its volume", 100.0 * off))
    }

    /// The body, checked, on its lattice; `at` is its JSON pointer, `heat` whether it needs a temperature.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn body(&self, at: &str, lattice: &Lattice, heat: bool) -> Result<Body, Fault> {
        self.check(at)?;
        let temperature = match (&self.temperature_k, heat) {
            (Some(property), _) => property
                .compile_temperature(&format!("{at}/temperature_k"), &["x", "y", "z", "r"])?,
            (None, false) => Curve::Constant(0.0),
            (None, true) => {
                let what = "has no key 'temperature_k' in K, which a scene with heat needs";
                return Err(Fault::at(at, what));
            }
        };
        let held = match (&self.held_temperature_k, heat) {
            (None, _) => None,
            (Some(property), true) => {
                let at = format!("{at}/held_temperature_k");
                Some(property.compile_temperature(&at, &["x", "y", "z", "r", "t"])?)
            }
            (Some(_), false) => {
                let at = format!("{at}/held_temperature_k");
                return Err(Fault::at(&at, "means nothing without the key 'heat'"));
            }
        };
        let cut = |c: &CutScene| Cut {
            point: c.point_m,
            normal: c.normal,
        };
        Ok(Body {
            shape: self.shape.clone(),
            pitch: lattice.pitch,
            lattice: self.lattice_m,
            round: lattice.round,
            cuts: self.cuts.iter().map(cut).collect(),
            phase: match self.state {
                StartState::Liquid => phase::LIQUID,
                StartState::Solid | StartState::Wall => phase::SOLID,
            },
            wall: self.state == StartState::Wall,
            slag: self.material == Material::Slag,
            velocity: self.velocity(at)?,
            temperature,
            held,
        })
    }

    /// u over x, y, z, r.
    fn velocity(&self, at: &str) -> Result<[Curve; 3], Fault> {
        let mut velocity = [const { Curve::Constant(0.0) }; 3];
        let written = self.velocity_m_s.iter().flatten().enumerate();
        for (k, component) in written {
            let key = format!("{at}/velocity_m_s/{k}");
            velocity[k] = component.compile(&key, &["x", "y", "z", "r"])?;
        }
        Ok(velocity)
    }

    fn check(&self, at: &str) -> Result<(), Fault> {
        let (low, high) = self.shape.bounds();
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            if high[k] <= low[k] {
                let what = format!(
                    "its upper corner in {axis}, {} m, is not above the lower, {} m",
                    high[k], low[k]
                );
                return Err(Fault::at(&format!("{at}/shape"), what));
            }
        }
        if matches!(self.shape, Shape::Container(_)) && self.state != StartState::Wall {
            let what = "a container is made of walls: its state must be \"wall\"";
            return Err(Fault::at(&format!("{at}/state"), what));
        }
        let moves = self
            .velocity_m_s
            .as_ref()
            .is_some_and(|v| v.iter().any(|u| *u != Property::Constant(0.0)));
        if moves && self.state != StartState::Liquid {
            let what = "only a liquid body can have a velocity";
            return Err(Fault::at(&format!("{at}/velocity_m_s"), what));
        }
        match self
            .cuts
            .iter()
            .position(|c| c.normal.iter().all(|n| *n == 0.0))
        {
            Some(i) => Err(Fault::at(
                &format!("{at}/cuts/{i}/normal"),
                "has no direction: all components are zero",
            )),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_whose_particles_hold_another_volume_is_told() {
        let told = |shape: &str, placed| {
            let text = format!(r#"{{"shape": {shape}, "state": "solid"}}"#);
            let body: BodyScene = serde_json::from_str(&text).unwrap();
            let filled = Filled {
                placed,
                left_out: 0,
            };
            body.rounded(&filled, 5e-4)
        };
        let own = r#"{"box": {"min_m": [-0.0039, -0.004, -0.0018], "max_m": [0.0039, 0.004, 0]}}"#;
        assert!(told(own, 16 * 16 * 4).unwrap().contains("+14.0 %"));
        let fit =
            r#"{"box": {"min_m": [-0.0039, -0.004, -0.0018], "max_m": [0.0041, 0.004, 0.0002]}}"#;
        assert_eq!(told(fit, 16 * 16 * 4), None);
        let ball = r#"{"sphere": {"centre_m": [0, 0, 0], "radius_m": 5e-4}}"#;
        assert!(told(ball, 4).unwrap().contains("-4.5 %"));
        // Composed, its volume is measured: 8 x 8 x 4 mm less the bevel of 4 x 4 / 2 x 8 mm3.
        let bevel = r#"{"intersection": [{"box": {"min_m": [-0.004, -0.004, -0.004], "max_m": [0.004, 0.004, 0]}},
            {"half_space": {"point_m": [0, 0, 0], "normal": [1, 0, 1]}}]}"#;
        assert_eq!(told(bevel, 192 * 8), None);
        assert!(told(bevel, 185 * 8).unwrap().contains("-3."));
    }
}
