//! The lattice of a scene, fitted to its bodies.
//!
//! Boxes and bars of metal share spacings along the axes with which whole numbers of layers fill them; a body that none do is
//! refused. A round body without another beside it takes the lattice whose particles hold its volume.

use run::Fault;

use super::{BodyScene, Scene, StartState};
use crate::domain::pitch::pitch;
use crate::domain::round::Round;
use crate::domain::shape::edge;

/// Where the particles of bodies stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Spacings along the axes, before any stretch \[m\].
    pub pitch: [f64; 3],
    /// How it lies in the only body, where that is round.
    pub round: Round,
}

impl Lattice {
    /// Sides of a particle's cell along the axes \[m\].
    #[must_use]
    pub fn cell(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.pitch[k] * self.round.stretch[k])
    }

    /// Spacing d, the edge of the cube of a particle's volume \[m\].
    #[must_use]
    pub fn spacing(&self) -> f64 {
        edge(self.cell())
    }
}

impl Scene {
    /// The lattice of its bodies.
    #[must_use]
    pub fn lattice(&self) -> Lattice {
        let pitch = pitch(&self.sides(), self.spacing_m).unwrap_or([self.spacing_m; 3]);
        let round = match self.bodies.as_slice() {
            [alone] if alone.lattice_m.is_none() && alone.cuts.is_empty() => {
                Round::of(&alone.shape, pitch)
            }
            _ => Round::default(),
        };
        Lattice { pitch, round }
    }

    /// Sides that whole numbers of layers have to fill \[m\]: those of metal, or of walls where there is nothing else.
    fn sides(&self) -> [Vec<f64>; 3] {
        let any = self.bodies.iter().any(BodyScene::is_metal);
        let mut sides = [const { Vec::new() }; 3];
        let own = self.bodies.iter().filter(|body| body.is_metal() == any);
        for body in own.filter(|body| body.lattice_m.is_none()) {
            for (axis, side) in body.shape.sides().into_iter().enumerate() {
                // A body turned inside out is refused on its own.
                sides[axis].extend(side.filter(|side| *side > 0.0));
            }
        }
        sides
    }
}

impl BodyScene {
    /// Whether it is metal, and no wall.
    pub(super) fn is_metal(&self) -> bool {
        self.state != StartState::Wall
    }
}

/// Bodies that no spacings near the one of the scene fill.
pub(super) fn faults(scene: &Scene) -> Vec<Fault> {
    let (sides, d) = (scene.sides(), scene.spacing_m);
    let walls = !scene.bodies.iter().any(BodyScene::is_metal);
    if walls || pitch(&sides, d).is_some() {
        return Vec::new();
    }
    let layers = |side: f64| (side / d).round().max(1.0);
    // The body whose sides are farthest from whole numbers of layers.
    let off = |body: &BodyScene| {
        let sides = body.shape.sides().into_iter().flatten();
        let off = sides.map(|side| (side / d / layers(side) - 1.0).abs());
        off.fold(0.0, f64::max)
    };
    let metal = scene.bodies.iter().enumerate();
    let free = metal.filter(|(_, body)| body.is_metal() && body.lattice_m.is_none());
    let Some((i, body)) = free.max_by(|a, b| off(a.1).total_cmp(&off(b.1))) else {
        return Vec::new();
    };
    let alone = pitch(&body.shape.sides().map(Vec::from_iter), d).is_some();
    let what = if alone {
        format!(
            "has no spacing along each axis in common with the other bodies, near {d} m and in all axes alike to 5 %: sides of all \
             bodies that are whole numbers of one spacing would be filled"
        )
    } else {
        let fit = body.shape.sides().into_iter().zip(["x", "y", "z"]);
        let fit = fit.filter_map(|(side, axis)| Some((layers(side?), axis)));
        let fit: Vec<String> = fit
            .map(|(n, axis)| format!("{:.6e} in {axis}", d * n))
            .collect();
        format!(
            "is filled by no whole numbers of layers about {d} m apart, in all axes alike to 5 %: sides of {} m would be",
            fit.join(", ")
        )
    };
    vec![Fault::at(&format!("/bodies/{i}/shape"), what).or_at("/spacing_m")]
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn scene(bodies: &Value) -> Scene {
        let scene = json!({"spacing_m": 8e-4, "time": {"step_s": 1e-4, "end_s": 1.0}, "density_kg_m3": 7850,
            "bodies": bodies, "output": {"particles_interval_s": 0.1}});
        serde_json::from_value(scene).unwrap()
    }

    fn body(state: &str, low: [f64; 3], high: [f64; 3]) -> Value {
        json!({"shape": {"box": {"min_m": low, "max_m": high}}, "state": state})
    }

    #[test]
    fn particles_weigh_what_boxes_do() {
        let side = [0.0116, 0.03, 0.0093];
        let scene = scene(&json!([
            body("solid", [0.0; 3], side),
            body("liquid", [0.0, 0.0, 0.0093], [0.0116, 0.03, 0.0186]),
        ]));
        assert_eq!(faults(&scene), []);
        let lattice = scene.lattice();
        let mut points = 0;
        for body in &scene.bodies {
            points += body.shape.points(lattice.pitch, None).len();
        }
        let held = points as f64 * scene.metal().volume();
        let exact = 2.0 * side.iter().product::<f64>();
        assert!((held / exact - 1.0).abs() < 1e-12, "{held} {exact}");
    }

    #[test]
    fn a_box_that_no_layers_fill_is_refused_with_sizes_that_fit() {
        let thin = |thick: f64| {
            let scene = scene(&json!([
                body("solid", [0.0; 3], [0.0116, 0.03, 0.0093]),
                body("solid", [0.0, 0.0, 0.02], [0.0116, 0.03, 0.02 + thick]),
            ]));
            faults(&scene).first().map(ToString::to_string)
        };
        let told = thin(0.0019).unwrap();
        assert!(
            told.contains("/bodies/1/shape") && told.contains("1.600000e-3 in z"),
            "{told}"
        );
        // Each alone is filled, both together are not.
        let apart = scene(&json!([
            body("solid", [0.0; 3], [0.0103, 0.0077, 0.0052]),
            body("solid", [0.0, 0.0, 0.0052], [0.0103, 0.0061, 0.0082]),
        ]));
        let told = faults(&apart)[0].to_string();
        assert!(told.contains("in common with the other bodies"), "{told}");
        // Twice as thick as it is thin: layers of 0.775 mm fill both.
        assert_eq!(thin(0.0031), None);
        // A wall is no metal, and takes the layers of the others.
        let wall = scene(&json!([
            body("liquid", [0.0; 3], [0.0116, 0.03, 0.0093]),
            body("wall", [0.0, 0.0, -0.0019], [0.0116, 0.03, 0.0]),
        ]));
        assert_eq!(faults(&wall), []);
    }
}
