//! `flow-spot`: a spot weld with a flat surface, beside finite elements.

use std::path::Path;

use serde_json::Value;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError, read_json};
use crate::particles::{Frames, number};
use crate::spot_pool::{Pool, Seen};

/// The case.
pub(super) struct FlowSpot;

/// Where the reference lies, from the root on.
const REFERENCE: &str = "pipelines/verify/flow-spot/reference.json";
/// Which way each method pulls the surface: the sign of the slope of the tension.
const SIGNS: [(&str, f64); 2] = [("outward", -1.0), ("inward", 1.0)];
/// Keys of a scene that say how it is computed, and not what.
const NUMERICS: [&str; 8] = [
    "rest_interval_steps",
    "exchange_tolerance_k",
    "method",
    "density_tolerance",
    "sweeps_min",
    "sweeps_max",
    "title",
    "slope_n_m_k",
];

impl Case for FlowSpot {
    fn name(&self) -> &'static str {
        "flow-spot"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "finite elements in r and z (scikit-fem): pipelines/bench/others/skfem_spot.py, reference.json"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["outward", "inward"]
    }

    fn targets(&self) -> Vec<Target> {
        let bounds = [("depth", 0.05), ("half_width", 0.05), ("speed", 0.1)];
        let each = self.methods().iter().flat_map(|method| {
            bounds.map(|(quantity, max)| Target::error(quantity, max).at_level(3).of(*method))
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let Some((_, sign)) = SIGNS.iter().find(|(name, _)| *name == method) else {
            unreachable!("methods are those that have a sign");
        };
        let reference = lab.root.join(REFERENCE);
        let told = Reference::read(&reference, method)?;
        // 0.5, 0.35 and 0.25 mm; steps as the square of the spacing.
        let along = [32.0, 46.0, 64.0][level.clamp(1, 3) as usize - 1];
        let steps = (2000.0 * (along / 32.0_f64).powi(2)).round();
        let patch = serde_json::json!({
            "spacing_m": 0.016 / along,
            "time": {"step_s": told.end_s / steps},
            "marangoni": {"slope_n_m_k": sign * told.slope}
        });
        let run = lab.run(
            "poolsph",
            self.name(),
            &format!("{method}-level{level}"),
            &patch,
        )?;
        if let Some(what) = told.differs(&run.scene) {
            let path = run.artefact.clone();
            let what = format!(
                "not judged: {what}; make the reference anew by `make flow-spot-reference`"
            );
            return Err(LabError::Content { path, what });
        }
        compared(run, &told.seen)
    }
}

/// What a run has at its end beside the reference.
fn compared(run: Finished, known: &Seen) -> Result<Measurement, LabError> {
    let spacing = number(&run, "/spacing_m")?;
    let melting = number(&run, "/heat/melting/point_k")?;
    let frames = Frames::read(&run.artefact, "temperature")?;
    let Some(seen) = (Pool { spacing, melting }).at_end(&frames) else {
        return Err(LabError::Content {
            path: run.artefact.clone(),
            what: "has no pool that can be measured at its end".to_owned(),
        });
    };
    let off = |found: f64, known: f64| (found / known - 1.0).abs();
    let errors = Errors::from([
        ("depth".to_owned(), off(seen.depth, known.depth)),
        (
            "half_width".to_owned(),
            off(seen.half_width, known.half_width),
        ),
        ("speed".to_owned(), off(seen.speed, known.speed)),
    ]);
    let count = frames.liquid.len() as u64;
    let costs = [
        ("depth_m", seen.depth),
        ("half_width_m", seen.half_width),
        ("speed_m_s", seen.speed),
    ];
    Ok(Measurement::of(run, count, spacing, errors).at_costs(costs))
}

/// What the finite elements found, and for which scene.
struct Reference {
    scene: Value,
    end_s: f64,
    /// Size of the slope of the tension \[N/(m K)\].
    slope: f64,
    seen: Seen,
}

impl Reference {
    fn read(path: &Path, method: &str) -> Result<Self, LabError> {
        let data = read_json(path)?;
        let at = |pointer: &str| {
            let found = data.pointer(pointer).and_then(Value::as_f64);
            found.ok_or_else(|| LabError::Content {
                path: path.to_owned(),
                what: format!("has no number at {pointer}"),
            })
        };
        let end = |key: &str| at(&format!("/methods/{method}/at_end/{key}"));
        Ok(Self {
            end_s: at("/scene/end_s")?,
            slope: at("/scene/marangoni/slope_n_m_k")?.abs(),
            seen: Seen {
                depth: end("depth_m")?,
                half_width: end("half_width_m")?,
                speed: end("speed_m_s")?,
            },
            scene: data["scene"].clone(),
        })
    }

    /// The first number in which a scene is another than that of the reference.
    fn differs(&self, scene: &Value) -> Option<String> {
        let beside = [
            "$schema",
            "kind",
            "version",
            "title",
            "comment",
            "spacing_m",
            "time",
            "output",
        ];
        let mut physics = scene.clone();
        if let Some(keys) = physics.as_object_mut() {
            keys.retain(|key, _| !beside.contains(&key.as_str()));
            let end = scene.pointer("/time/end_s").cloned();
            keys.insert("end_s".to_owned(), end.unwrap_or_default());
        }
        difference(&self.scene, &physics, "")
    }
}

/// Where two scenes differ, and how.
fn difference(known: &Value, found: &Value, at: &str) -> Option<String> {
    match (known, found) {
        (Value::Object(one), Value::Object(other)) => {
            let keys: std::collections::BTreeSet<_> = one.keys().chain(other.keys()).collect();
            let mut keys = keys
                .into_iter()
                .filter(|key| !NUMERICS.contains(&key.as_str()));
            keys.find_map(|key| {
                let none = Value::Null;
                let [one, other] = [one, other].map(|all| all.get(key).unwrap_or(&none));
                difference(one, other, &format!("{at}/{key}"))
            })
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() => {
            let mut pairs = one.iter().zip(other).enumerate();
            pairs.find_map(|(k, (one, other))| difference(one, other, &format!("{at}/{k}")))
        }
        _ if known.as_f64().is_some() && known.as_f64() == found.as_f64() => None,
        _ if known == found => None,
        _ => Some(format!(
            "the reference has {known} at {at}, the scene {found}"
        )),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn reference() -> Reference {
        Reference {
            scene: json!({"end_s": 2.0, "density_kg_m3": 7000, "marangoni": {"slope_n_m_k": -1e-4}, "bodies": [{"temperature_k": 300}]}),
            end_s: 2.0,
            slope: 1e-4,
            seen: Seen::default(),
        }
    }

    #[test]
    fn a_reference_holds_for_its_own_numbers_alone() {
        let own = json!({
            "kind": "poolsph.scene", "spacing_m": 1e-3, "time": {"step_s": 1e-3, "end_s": 2},
            "density_kg_m3": 7000.0, "marangoni": {"slope_n_m_k": 1e-4}, "bodies": [{"temperature_k": 300}]
        });
        assert_eq!(reference().differs(&own), None);
        for (at, value) in [
            ("/density_kg_m3", json!(7001)),
            ("/time/end_s", json!(2.5)),
            ("/bodies/0/temperature_k", json!(301)),
        ] {
            let mut other = own.clone();
            *other.pointer_mut(at).unwrap() = value.clone();
            let told = reference().differs(&other).unwrap();
            assert!(told.contains(&value.to_string()), "{told}");
        }
        let mut more = own;
        more["losses"] = json!({"emissivity": 0.5});
        assert!(reference().differs(&more).unwrap().contains("/losses"));
    }
}
