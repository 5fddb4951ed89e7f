//! `fracture-energy`: the energy of a crack does not depend on the spacing, by a criterion of the energy and by the mean
//! stress over a length.

use artefact::Reader;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::solid::{changed, fault};

/// Way of the crack \[m\].
const LENGTH: f64 = 0.032;

/// Length over which the stress of `length` counts, four spacings at the first level \[m\], and the end of its runs \[s\].
const OVER: f64 = 0.008;
const END: f64 = 0.06;
/// G E/(sigma^2 l (1 - nu^2)) of a crack in a large plate that breaks by the mean stress over a length l (`solid/nonlocal.rs`).
const IRWIN: f64 = 2.17;

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

    fn methods(&self) -> &'static [&'static str] {
        &["straight", "shaken", "length"]
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        let most = if method == "shaken" { 2 } else { 3 };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let of = |method: &'static str, most: u32| {
            (1..=most).flat_map(move |level| {
                let spread = (level > 1).then_some(("spread", 0.1));
                // The plate is a few lengths high; the stress is told for a large one.
                let energy = (method != "length").then_some(("crack_energy", 0.1));
                let all = [("energy_unclosed", 0.02)].into_iter();
                let all = all.chain(energy).chain(spread);
                all.map(move |(what, most)| Target::error(what, most).at_level(level).of(method))
            })
        };
        of("straight", 3)
            .chain(of("shaken", 2))
            .chain(of("length", 3))
            .collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let mut told = f64::NAN;
        let mut at = |level: u32| -> Result<(Finished, f64, f64), LabError> {
            let by = f64::from(1 << (level.clamp(1, 4) - 1));
            let mut patch = changed(lab, self.name(), |plate| {
                told = number(&plate["fracture"]["energy_release_j_m2"]);
                let spacing = number(&plate["spacing_m"]) / by;
                plate["spacing_m"] = json!(spacing);
                // A notch as sharp as the lattice has: two rows, so that no link bridges it.
                let notch = &mut plate["body"]["difference"][1]["box"];
                notch["min_m"][1] = json!(-spacing);
                notch["max_m"][1] = json!(spacing);
                if method == "shaken" {
                    plate["lattice"] = json!({"jitter": 0.05});
                }
                if method == "length" {
                    by_length(plate, told);
                }
            })?;
            if method == "length" {
                patch["time"] = json!({"end_s": END});
            }
            let label = format!("{method}-{level}");
            let run = lab.run("jetsph", self.name(), &label, &patch)?;
            let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
            let records = reader.records("/balance")?;
            let (_, last) = records
                .last()
                .ok_or_else(|| fault(&run, "has no balance"))?;
            if last.get("plate_largest_piece")? > 0.6 {
                return Err(fault(&run, "does not part"));
            }
            let energy = last.get("spent_energy_j")? / LENGTH;
            let mut unclosed = 0.0_f64;
            for (_, record) in &records {
                unclosed = unclosed.max(record.get("energy_error")?.abs());
            }
            Ok((run, energy, unclosed))
        };
        let (_, first, _) = at(1)?;
        let (run, energy, unclosed) = at(level)?;
        let spacing = number(&run.scene["solids"][0]["spacing_m"]);
        let points = Reader::open_kind(&run.artefact, "jet-frames", 1)?
            .frame("/plate", 0)?
            .len() as u64;
        let errors = Errors::from([
            ("crack_energy".to_owned(), (energy / told - 1.0).abs()),
            ("spread".to_owned(), (energy / first - 1.0).abs()),
            ("energy_unclosed".to_owned(), unclosed),
        ]);
        Ok(Measurement::of(run, points, spacing, errors))
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// The plate breaks by the stress over [`OVER`] that takes as much energy \[J/m2\].
fn by_length(plate: &mut Value, energy: f64) {
    let elastic = &plate["elastic"];
    let (modulus, ratio) = (
        number(&elastic["youngs_modulus_pa"]),
        number(&elastic["poisson_ratio"]),
    );
    let stress = (energy * modulus / (IRWIN * OVER * (1.0 - ratio * ratio))).sqrt();
    plate["fracture"] = json!({ "principal_stress_pa": stress });
    plate["fracture_length_m"] = json!(OVER);
}
