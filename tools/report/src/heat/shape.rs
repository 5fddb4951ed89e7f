//! The body and the regions of its materials, as far as a picture needs them: what is inside.

use serde::Deserialize;
use serde_json::Value;

/// Part of a length by which a place on a face counts as inside.
const ROOM: f64 = 1e-6;

/// Body and regions of a scene.
#[derive(Debug, Clone, Default)]
pub(crate) struct Body {
    shape: Option<Shape>,
    /// The first material whose region holds a place is there; one without is everywhere.
    regions: Vec<Option<Shape>>,
    /// Whether materials touch with a resistance, so that the temperature jumps.
    pub(crate) jumps: bool,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Axis {
    X,
    Y,
    Z,
}

fn along_z() -> Axis {
    Axis::Z
}

/// A shape of a scene.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Shape {
    Box {
        min_m: Vec<f64>,
        max_m: Vec<f64>,
    },
    Cylinder {
        centre_m: Vec<f64>,
        #[serde(default = "along_z")]
        axis: Axis,
        radius_m: f64,
        length_m: f64,
    },
    Disc {
        centre_m: Vec<f64>,
        radius_m: f64,
    },
    Sphere {
        centre_m: Vec<f64>,
        radius_m: f64,
    },
    Ellipsoid {
        centre_m: Vec<f64>,
        semi_axes_m: Vec<f64>,
    },
    HalfSpace {
        point_m: Vec<f64>,
        normal: Vec<f64>,
    },
    Turned {
        shape: Box<Shape>,
        #[serde(default = "along_z")]
        axis: Axis,
        angle_deg: f64,
        about_m: Option<Vec<f64>>,
    },
    Union(Vec<Shape>),
    Intersection(Vec<Shape>),
    Difference(Vec<Shape>),
}

/// A number of a place that may have two.
fn part(place: &[f64], k: usize) -> f64 {
    place.get(k).copied().unwrap_or(0.0)
}

fn from(place: &[f64], p: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| p[k] - part(place, k))
}

impl Shape {
    /// Whether a place \[m\] is inside.
    pub(crate) fn holds(&self, p: [f64; 3]) -> bool {
        match self {
            Self::Box { min_m, max_m } => (0..min_m.len().min(3)).all(|k| {
                let room = ROOM * (part(max_m, k) - part(min_m, k));
                p[k] >= min_m[k] - room && p[k] <= part(max_m, k) + room
            }),
            Self::Cylinder {
                centre_m,
                axis,
                radius_m,
                length_m,
            } => {
                let (q, k) = (from(centre_m, p), axis.clone() as usize);
                let r = q[(k + 1) % 3].hypot(q[(k + 2) % 3]);
                r <= radius_m * (1.0 + ROOM) && q[k].abs() <= 0.5 * length_m * (1.0 + ROOM)
            }
            Self::Disc { centre_m, radius_m } => {
                let q = from(centre_m, p);
                q[0].hypot(q[1]) <= radius_m * (1.0 + ROOM)
            }
            Self::Sphere { centre_m, radius_m } => {
                let q = from(centre_m, p);
                q[0].hypot(q[1]).hypot(q[2]) <= radius_m * (1.0 + ROOM)
            }
            Self::Ellipsoid {
                centre_m,
                semi_axes_m,
            } => {
                let q = from(centre_m, p);
                let parts = semi_axes_m.iter().zip(q);
                parts.map(|(half, q)| (q / half).powi(2)).sum::<f64>() <= 1.0 + 2.0 * ROOM
            }
            Self::HalfSpace { point_m, normal } => {
                let q = from(point_m, p);
                (0..3).map(|k| q[k] * part(normal, k)).sum::<f64>() <= 0.0
            }
            Self::Turned {
                shape,
                axis,
                angle_deg,
                about_m,
            } => {
                let about = about_m.clone().unwrap_or_default();
                shape.holds(turn_back(p, axis.clone() as usize, *angle_deg, &about))
            }
            Self::Union(shapes) => shapes.iter().any(|s| s.holds(p)),
            Self::Intersection(shapes) => shapes.iter().all(|s| s.holds(p)),
            Self::Difference(shapes) => match shapes.split_first() {
                Some((first, cut)) => first.holds(p) && !cut.iter().any(|s| s.holds(p)),
                None => false,
            },
        }
    }
}

/// The place that a turn of `degrees` about an axis through `about` brings to `p`.
fn turn_back(p: [f64; 3], axis: usize, degrees: f64, about: &[f64]) -> [f64; 3] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let q = from(about, p);
    let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut out = p;
    out[a] = part(about, a) + cosine * q[a] + sine * q[b];
    out[b] = part(about, b) - sine * q[a] + cosine * q[b];
    out
}

impl Body {
    /// Body and regions of a scene; what cannot be read is unknown.
    pub(crate) fn of_scene(scene: &Value) -> Self {
        let shape = |value: &Value| serde_json::from_value(value.clone()).ok();
        let materials = scene.get("materials").and_then(Value::as_array);
        let contacts = scene.get("contacts").and_then(Value::as_array);
        Self {
            shape: scene.get("body").and_then(shape),
            regions: materials.map_or_else(Vec::new, |all| {
                all.iter()
                    .map(|m| m.get("region").and_then(shape))
                    .collect()
            }),
            jumps: contacts.is_some_and(|c| !c.is_empty()),
        }
    }

    /// Whether a place is inside; `None` where the body is unknown.
    pub(crate) fn holds(&self, p: [f64; 3]) -> Option<bool> {
        self.shape.as_ref().map(|s| s.holds(p))
    }

    /// Number of the material at a place inside.
    pub(crate) fn material(&self, p: [f64; 3]) -> usize {
        let there = |region: &Option<Shape>| region.as_ref().is_none_or(|s| s.holds(p));
        self.regions.iter().position(there).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn body(shape: &Value) -> Body {
        Body::of_scene(&json!({"body": shape}))
    }

    #[test]
    fn shapes_hold_what_is_inside_and_nothing_else() {
        let ring = body(&json!({"difference": [
            {"cylinder": {"centre_m": [0, 0, 1], "axis": "x", "radius_m": 2, "length_m": 4}},
            {"sphere": {"centre_m": [0, 0, 1], "radius_m": 1}}]}));
        assert_eq!(ring.holds([1.9, 1.9, 1.0]), Some(true));
        assert_eq!(ring.holds([2.1, 0.0, 1.0]), Some(false));
        assert_eq!(ring.holds([0.0, 0.5, 1.0]), Some(false));
        let half = body(&json!({"intersection": [
            {"disc": {"centre_m": [0, 0], "radius_m": 1}},
            {"half_space": {"point_m": [0, 0], "normal": [0, 1]}}]}));
        assert_eq!(half.holds([0.5, -0.5, 0.0]), Some(true));
        assert_eq!(half.holds([0.5, 0.5, 0.0]), Some(false));
        assert_eq!(body(&json!({"knot": {}})).holds([0.0; 3]), None);
    }

    #[test]
    fn a_turn_is_right_handed_about_its_place() {
        // A bar along x from (1, 0) to (3, 0), turned by 90 degrees about (1, 0): along y.
        let bar = body(&json!({"turned": {"angle_deg": 90, "about_m": [1, 0],
            "shape": {"box": {"min_m": [1, -0.1], "max_m": [3, 0.1]}}}}));
        assert_eq!(bar.holds([1.0, 1.9, 0.0]), Some(true));
        assert_eq!(bar.holds([1.0, -1.0, 0.0]), Some(false));
        assert_eq!(bar.holds([2.0, 0.0, 0.0]), Some(false));
    }

    #[test]
    fn the_first_region_that_holds_a_place_is_its_material() {
        let scene = json!({"materials": [
            {"region": {"box": {"min_m": [-1, -1, 2], "max_m": [1, 1, 9]}}},
            {"region": {"box": {"min_m": [-1, -1, 1], "max_m": [1, 1, 9]}}}, {}]});
        let body = Body::of_scene(&scene);
        let found = [2.5, 1.5, 0.5].map(|z| body.material([0.0, 0.0, z]));
        assert_eq!(found, [0, 1, 2]);
    }
}
