//! `fracture-energy`: the energy of a crack does not depend on the spacing.

use artefact::Reader;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::solid::{fault, finer};

/// Way of the crack \[m\].
const LENGTH: f64 = 0.032;

/// The case.
pub(super) struct FractureEnergy;

impl Case for FractureEnergy {
    fn name(&self) -> &'static str {
        "fracture-energy"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "the energy of the crack that the scene tells; the same at all spacings"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("spread", 0.1).at_level(2),
            Target::error("spread", 0.1).at_level(3),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let at = |level: u32| -> Result<(Finished, f64), LabError> {
            let by = f64::from(1 << (level.clamp(1, 4) - 1));
            let patch = finer(lab, self.name(), by)?;
            let run = lab.run("jetsph", self.name(), &format!("level{level}"), &patch)?;
            let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
            let records = reader.records("/balance")?;
            let (_, last) = records
                .last()
                .ok_or_else(|| fault(&run, "has no balance"))?;
            if last.get("plate_largest_piece")? > 0.6 {
                return Err(fault(&run, "does not part"));
            }
            let energy = last.get("plate_fracture_energy")? / LENGTH;
            Ok((run, energy))
        };
        let (_, first) = at(1)?;
        let (run, energy) = at(level)?;
        let told = run.scene["solids"][0]["fracture"]["energy_release_j_m2"]
            .as_f64()
            .unwrap_or(f64::NAN);
        let spacing = run.scene["solids"][0]["spacing_m"]
            .as_f64()
            .unwrap_or(f64::NAN);
        let points = Reader::open_kind(&run.artefact, "jet-frames", 1)?
            .frame("/plate", 0)?
            .len() as u64;
        let errors = Errors::from([
            ("crack_energy".to_owned(), (energy / told - 1.0).abs()),
            ("spread".to_owned(), (energy / first - 1.0).abs()),
        ]);
        Ok(Measurement::of(run, points, spacing, errors))
    }
}
