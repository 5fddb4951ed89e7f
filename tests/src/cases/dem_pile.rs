//! `dem-pile`: grains that fall into a box come to rest.

use std::path::Path;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::lab::{Lab, LabError, read_json};
use crate::particles::number;

/// The case.
pub(super) struct DemPile;

/// Sides of box and heap over those of the scene, by level.
const SIDES: [f64; 3] = [0.5, 0.7, 1.0];

impl Case for DemPile {
    fn name(&self) -> &'static str {
        "dem-pile"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "rest: no kinetic energy, and walls that bear the weight"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("kinetic_over_start", 1e-10),
            Target::error("weight", 1e-4),
            Target::error("lost", 0.0),
        ]
    }

    fn levels(&self, _: &str, asked: &[u32]) -> Vec<u32> {
        // Heaps of the eighth part, of the third and of all grains: it is no convergence that is asked for.
        asked.iter().copied().filter(|level| *level <= 3).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let scene = Path::new("pipelines/verify").join(self.name());
        let scene = read_json(&lab.root.join(scene).join("scene.json"))?;
        let part = SIDES[level.clamp(1, 3) as usize - 1];
        let smaller = |shape: &Value| {
            let mut shape = shape.clone();
            for corner in ["min_m", "max_m"] {
                for x in shape["box"][corner].as_array_mut().into_iter().flatten() {
                    *x = json!(part * x.as_f64().unwrap_or(0.0));
                }
            }
            shape
        };
        let mut body = scene["grains"]["bodies"][0].clone();
        let mut wall = scene["grains"]["walls"][0].clone();
        (body["shape"], wall["shape"]) = (smaller(&body["shape"]), smaller(&wall["shape"]));
        let patch = json!({"grains": {"bodies": [body], "walls": [wall]}});
        let run = lab.run("poolsph", self.name(), &format!("level{level}"), &patch)?;
        let reader = artefact::Reader::open_kind(&run.artefact, "particle-frames", 1)?;
        let records = reader.records("/grains_balance")?;
        let energy = |k: usize| {
            let record = &records[k].1;
            Ok::<f64, LabError>(
                record.get("kinetic_energy_j")? + record.get("rotational_energy_j")?,
            )
        };
        // The most on the way: the start is at rest.
        let mut most = 0.0_f64;
        for k in 0..records.len() {
            most = most.max(energy(k)?);
        }
        let (first, last) = (&records[0].1, &records[records.len() - 1].1);
        let g = -number(&run, "/grains/gravity_m_s2/2")?;
        let weight = g * last.get("mass_kg")?;
        let errors = Errors::from([
            (
                "kinetic_over_start".to_owned(),
                energy(records.len() - 1)? / most,
            ),
            (
                "weight".to_owned(),
                (last.get("contact_force_z")? / weight - 1.0).abs(),
            ),
            (
                "lost".to_owned(),
                first.get("grains")? - last.get("grains")?,
            ),
        ]);
        let frames = frames(&run.artefact)?;
        let grains = frames
            .last()
            .ok_or_else(|| fault(&run, "has no frame"))?
            .len() as u64;
        let spacing = 2.0 * number(&run, "/grains/bodies/0/radius_m")?;
        Ok(Measurement::of(run, grains, spacing, errors))
    }
}
