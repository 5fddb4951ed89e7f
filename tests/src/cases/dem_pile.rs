//! `dem-pile`: grains that fall into a box come to rest.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::lab::{Lab, LabError};
use crate::particles::number;

/// The case.
pub(super) struct DemPile;

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
        // It is no convergence that is asked for.
        asked.iter().copied().filter(|level| *level <= 2).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let steps = 10.0 * f64::from(1 << (level.clamp(1, 5) - 1));
        let patch = json!({"grains": {"steps_per_contact": steps}});
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
