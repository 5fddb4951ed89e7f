//! What the scene of a field says that pictures need: bodies, coils, lines.

use serde_json::Value;

use crate::heat::shape::Shape;

/// How the places of a scene lie in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Geometry {
    /// Nothing changes along z.
    Plane,
    /// Nothing changes about z; points lie in the half plane y = 0.
    Axisymmetric,
    /// Three coordinates.
    Space,
}

/// A circular loop.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Loop {
    /// Centre \[m\].
    pub(crate) centre: [f64; 3],
    /// Whether its axis is z.
    pub(crate) upright: bool,
    /// Radius \[m\].
    pub(crate) radius: f64,
    /// Radius of its wire \[m\]; 0 where it is thin.
    pub(crate) wire: f64,
}

/// A body.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    /// Name.
    pub(crate) name: String,
    shape: Option<Shape>,
}

/// Bodies, coils, lines.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    /// How places lie in space.
    pub(crate) geometry: Geometry,
    /// Bodies; medium 0 is around them, medium k the body k - 1.
    pub(crate) bodies: Vec<Body>,
    /// Which media conduct.
    conducts: Vec<bool>,
    /// Circular loops.
    pub(crate) loops: Vec<Loop>,
    /// Names of lines.
    pub(crate) lines: Vec<String>,
    /// Whether fields alternate.
    pub(crate) alternating: bool,
    ball: Option<Shape>,
}

impl Scene {
    /// Reads a scene; what is unknown in it is left out.
    pub(crate) fn of(scene: &Value) -> Self {
        let list = |pointer: &str| -> Vec<Value> {
            let found = scene.pointer(pointer).and_then(Value::as_array);
            found.cloned().unwrap_or_default()
        };
        let shape = |value: Option<&Value>| serde_json::from_value(value?.clone()).ok();
        let conducts = |medium: Option<&Value>| {
            let sigma = medium.and_then(|m| m["conductivity_s_m"].as_f64());
            sigma.is_some_and(|s| s > 0.0)
        };
        let bodies = list("/bodies");
        let mut conductors = vec![conducts(scene.get("surroundings"))];
        conductors.extend(bodies.iter().map(|b| conducts(Some(b))));
        let body = |b: &Value| Body {
            name: b["name"].as_str().unwrap_or_default().to_owned(),
            shape: shape(b.get("shape")),
        };
        let name = |l: &Value| l["name"].as_str().map(str::to_owned);
        Self {
            geometry: match scene["geometry"].as_str() {
                Some("plane") => Geometry::Plane,
                Some("axisymmetric") => Geometry::Axisymmetric,
                _ => Geometry::Space,
            },
            bodies: bodies.iter().map(body).collect(),
            conducts: conductors,
            loops: list("/eddy_currents/coils")
                .iter()
                .filter_map(round)
                .collect(),
            lines: list("/output/lines").iter().filter_map(name).collect(),
            alternating: scene.pointer("/eddy_currents/harmonic").is_some(),
            ball: match scene.pointer("/domain/sphere") {
                None => None,
                Some(ball) => shape(Some(&serde_json::json!({ "sphere": ball }))),
            },
        }
    }

    /// Coordinates of a place in space as shapes have them.
    fn own(&self, p: [f64; 3]) -> [f64; 3] {
        match self.geometry {
            Geometry::Axisymmetric => [p[0].hypot(p[1]), p[2], 0.0],
            Geometry::Plane => [p[0], p[1], 0.0],
            Geometry::Space => p,
        }
    }

    /// The medium of a place: of the first body that holds it; 0 outside of all.
    pub(crate) fn medium(&self, p: [f64; 3]) -> u8 {
        let own = self.own(p);
        let holds = |b: &Body| b.shape.as_ref().is_some_and(|s| s.holds(own));
        let found = self.bodies.iter().position(holds);
        found.map_or(0, |k| (k + 1).min(255) as u8)
    }

    /// Whether a place is within a round domain; a box is as its points are.
    pub(crate) fn within(&self, p: [f64; 3]) -> bool {
        self.ball.as_ref().is_none_or(|b| b.holds(self.own(p)))
    }

    /// Whether a medium conducts.
    pub(crate) fn conducts(&self, medium: u8) -> bool {
        self.conducts.get(usize::from(medium)).copied() == Some(true)
    }

    /// The axis that points upwards in pictures.
    pub(crate) fn upward(&self) -> usize {
        match self.geometry {
            Geometry::Plane => 1,
            Geometry::Axisymmetric | Geometry::Space => 2,
        }
    }

    /// Name of a medium.
    pub(crate) fn name(&self, medium: u8) -> &str {
        let body = usize::from(medium).checked_sub(1);
        body.and_then(|k| self.bodies.get(k))
            .map_or("surroundings", |b| b.name.as_str())
    }
}

fn round(coil: &Value) -> Option<Loop> {
    let own = coil.get("loop")?;
    let part = |k: usize| own["centre_m"][k].as_f64();
    // (r, z) in an axisymmetric scene.
    let centre = match part(2) {
        Some(z) => [part(0)?, part(1)?, z],
        None => [0.0, 0.0, part(1)?],
    };
    let normal = own.get("normal").and_then(Value::as_array);
    let level = |n: &Vec<Value>| n[..2].iter().all(|v| v.as_f64() == Some(0.0));
    Some(Loop {
        centre,
        upright: normal.is_none_or(|n| n.len() > 2 && level(n)),
        radius: own["radius_m"].as_f64()?,
        wire: own["wire_radius_m"].as_f64().unwrap_or(0.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_first_body_that_holds_a_place_is_its_medium() {
        let scene = Scene::of(&json!({"geometry": "axisymmetric",
            "bodies": [
                {"name": "core", "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}}, "conductivity_s_m": 5},
                {"name": "shell", "shape": {"disc": {"centre_m": [0, 0], "radius_m": 2}}}],
            "eddy_currents": {"coils": [{"loop": {"centre_m": [0, -3], "radius_m": 2}}]}}));
        let at = |p| scene.medium(p);
        assert_eq!(at([0.5, 0.0, 0.5]), 1);
        assert_eq!(at([0.0, 1.5, 0.0]), 2);
        assert_eq!(at([1.5, 0.0, 1.5]), 0);
        assert!(scene.conducts(1) && !scene.conducts(2) && !scene.conducts(9));
        assert_eq!((scene.name(2), scene.name(0)), ("shell", "surroundings"));
        assert!(
            (scene.loops[0].centre[2] + 3.0).abs() < 1e-15
                && scene.loops[0].centre[0].abs() < 1e-15
        );
        assert!(scene.loops[0].upright && scene.within([9.0; 3]));
    }
}
