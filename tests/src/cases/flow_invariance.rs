//! `flow-invariance`: a flow that is turned, shifted, scaled or taken in half steps is the same flow.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::flow::{apart, layers};
use crate::lab::{Finished, Lab, LabError, Subject};
use crate::norms::Worst as _;
use crate::particles::{Frames, number};

/// The case.
pub(super) struct FlowInvariance;

/// Times the lengths of the scaled flow, whose speeds stay.
const SCALE: f64 = 100.0;

/// Where the shifted flow begins \[m\].
const SHIFT: [f64; 3] = [0.237, -1.41, 3.33];

impl Case for FlowInvariance {
    fn name(&self) -> &'static str {
        "flow-invariance"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "the flow of flow-poiseuille as its scene says"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["turned", "shifted", "scaled", "half-step"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            (1..=2).map(move |level| Target::error("profile", 0.01).at_level(level).of(*method))
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 10, 20 and 30 layers.
        let spacing = 1e-3 / f64::from(level);
        let scene = std::path::Path::new("pipelines/verify/flow-poiseuille/scene.json");
        let label = format!("{method}-level{level}");
        let patch = json!({"spacing_m": spacing});
        let of = Subject::new("poolsph", self.name(), scene);
        let run = lab.run_scene(of, &format!("{label}-base"), &patch, &[])?;
        let other = lab.varied(&run, &label, &changed(&run.scene, method))?;
        let high = number(&run, "/faces/max_m/2")?;
        let n = (high / spacing).round() as usize;
        // Height above the floor and speed along, each in its own axes and units.
        let (axes, scale, floor) = match method {
            "turned" => ([1, 0], 1.0, 0.0),
            "shifted" => ([0, 2], 1.0, SHIFT[2]),
            "scaled" => ([0, 2], SCALE, 0.0),
            _ => ([0, 2], 1.0, 0.0),
        };
        let base = profiles(&run, [0, 2], 1.0, 0.0, (high, n))?;
        let seen = profiles(&other, axes, scale, floor, (high, n))?;
        let points = Frames::read(&run.artefact, "pressure")?.liquid.len() as u64;
        let errors = errors(&base, &seen, (high, n));
        Ok(Measurement::over(vec![run, other], points, spacing, errors))
    }
}

/// The patch that makes another scene of one and the same flow.
fn changed(scene: &Value, method: &str) -> Value {
    let mut other = json!({"bodies": scene["bodies"], "faces": scene["faces"], "flow": scene["flow"],
        "time": scene["time"], "output": scene["output"]});
    match method {
        "turned" => turn(&mut other),
        "shifted" => {
            for corner in ["min_m", "max_m"] {
                add(&mut other["bodies"][0]["shape"]["box"][corner]);
                add(&mut other["faces"][corner]);
            }
        }
        "scaled" => {
            other["spacing_m"] = scene["spacing_m"].clone();
            for at in [
                "/spacing_m",
                "/time/step_s",
                "/time/end_s",
                "/output/particles_interval_s",
                "/flow/viscosity_pa_s",
            ] {
                times(other.pointer_mut(at), SCALE);
            }
            for corner in ["min_m", "max_m"] {
                for k in 0..3 {
                    times(
                        other.pointer_mut(&format!("/bodies/0/shape/box/{corner}/{k}")),
                        SCALE,
                    );
                    times(other.pointer_mut(&format!("/faces/{corner}/{k}")), SCALE);
                }
            }
            (0..3).for_each(|k| {
                times(
                    other.pointer_mut(&format!("/flow/gravity_m_s2/{k}")),
                    1.0 / SCALE,
                )
            });
        }
        _ => times(other.pointer_mut("/time/step_s"), 0.5),
    }
    other
}

fn times(value: Option<&mut Value>, factor: f64) {
    if let Some(value) = value
        && let Some(number) = value.as_f64()
    {
        *value = json!(number * factor);
    }
}

fn add(corner: &mut Value) {
    for (k, shift) in SHIFT.iter().enumerate() {
        corner[k] = json!(corner[k].as_f64().unwrap_or(0.0) + shift);
    }
}

/// x becomes y, y becomes z, z becomes x, in vectors and in the names of axes and faces.
fn turn(value: &mut Value) {
    match value {
        Value::Array(items) if items.len() == 3 && items.iter().all(Value::is_number) => {
            items.rotate_right(1);
        }
        Value::Array(items) => items.iter_mut().for_each(turn),
        Value::Object(map) => map.values_mut().for_each(turn),
        Value::String(name) => {
            let next = match name.as_bytes().first() {
                Some(b'x') if name.len() <= 2 => "y",
                Some(b'y') if name.len() <= 2 => "z",
                Some(b'z') if name.len() <= 2 => "x",
                _ => return,
            };
            name.replace_range(..1, next);
        }
        _ => {}
    }
}

/// Speeds of layers at all times, along the first of `axes` over the second.
fn profiles(
    run: &Finished,
    axes: [usize; 2],
    scale: f64,
    floor: f64,
    across: (f64, usize),
) -> Result<Vec<Vec<[f64; 2]>>, LabError> {
    let frames = Frames::read(&run.artefact, "pressure")?;
    let all = frames.position.iter().zip(&frames.velocity);
    let profile = |(places, speeds): (&Vec<[f64; 3]>, &Vec<[f64; 3]>)| {
        let points = places.iter().zip(speeds);
        let points = points.map(|(x, u)| ((x[axes[1]] - floor) / scale, u[axes[0]]));
        layers(points, across.0, across.1)
    };
    Ok(all.map(profile).collect())
}

/// The greatest difference of all layers and times, over the range.
fn errors(base: &[Vec<[f64; 2]>], other: &[Vec<[f64; 2]>], across: (f64, usize)) -> Errors {
    let speeds = base.iter().flatten().map(|[_, u]| *u);
    let (low, high) = speeds.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| {
        (low.min(u), high.max(u))
    });
    let pairs = base.iter().zip(other);
    let worst = pairs.map(|(one, other)| apart(one, other, across.0, across.1));
    // What ended early is another flow.
    let worst = if base.len() == other.len() {
        worst.worst()
    } else {
        f64::INFINITY
    };
    Errors::from([("profile".to_owned(), worst / (high - low))])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_takes_axes_along() {
        let mut value = json!({"gravity": [1, 2, 3], "faces": {"periodic": ["x", "y"], "wall": [{"face": "z+"}]},
            "state": "liquid"});
        turn(&mut value);
        let expected = json!({"gravity": [3, 1, 2], "faces": {"periodic": ["y", "z"], "wall": [{"face": "x+"}]},
            "state": "liquid"});
        assert_eq!(value, expected);
    }
}
