//! `dem-pile`: grains that fall into a box come to rest, and heaps stand by their friction.

use std::path::Path;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::heap::{scaled, slopes};
use crate::lab::{Finished, Lab, LabError, Subject, read_json};
use crate::particles::number;

/// Level of the heaps: smaller ones are rough.
const HEAPS: u32 = 3;
/// What passes for flat \[degrees\]: one grain over half of the shelf, which holds twenty.
const FLAT: f64 = 2.9;

/// The case.
pub(super) struct DemPile;

/// Friction of the heaps over that of their scene, and what resists rolling in a last one.
const FRICTION: [f64; 3] = [1.0 / 3.0, 1.0, 3.0];
const ROLLING: f64 = 0.2;

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
        "rest: no kinetic energy, and walls that bear the weight; heaps: flat without friction, and the steeper the more grains rub \
         or resist rolling (Zhou, Xu, Yu and Zulli 2001)"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("kinetic_over_start", 1e-10),
            Target::error("weight", 1e-4),
            Target::error("lost", 0.0),
            Target::error("flat_degrees", FLAT).at_level(HEAPS),
            Target::error("falls_with_friction_degrees", 0.0).at_level(HEAPS),
            Target::error("falls_with_rolling_degrees", 0.0).at_level(HEAPS),
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
        let of = |key: &str| scaled(&scene["grains"][key], part);
        let patch = json!({"grains": {"bodies": of("bodies"), "walls": of("walls")}});
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
        let mut errors = Errors::from([
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
        let mut runs = vec![run];
        let mut angles = Vec::new();
        if level >= HEAPS {
            let heaps = Heaps::of(lab, self.name())?;
            errors.extend(heaps.errors());
            angles = heaps.angles.to_vec();
            runs.extend(heaps.runs);
        }
        let mut measured = Measurement::over(runs, grains, spacing, errors);
        for ([left, right], name) in angles.into_iter().zip(HEAP) {
            let both = [("left", left), ("right", right)];
            let told = both.map(|(side, angle)| (format!("{name}_{side}_degrees"), angle));
            measured.costs.extend(told);
        }
        Ok(measured)
    }
}

/// Heaps: without friction on a smooth shelf, three by friction, and one that resists rolling.
const HEAP: [&str; 5] = ["flat", "third", "scene", "threefold", "rolling"];

/// Heaps that are left on a shelf.
struct Heaps {
    runs: Vec<Finished>,
    /// Slopes of both sides \[degrees\].
    angles: [[f64; 2]; 5],
}

impl Heaps {
    fn of(lab: &Lab, case: &str) -> Result<Self, LabError> {
        let scene = Path::new("pipelines/verify").join(case).join("heap.json");
        let own = read_json(&lab.root.join(&scene))?;
        let subject = Subject::new("poolsph", case, &scene);
        let first = lab.run_scene(subject, "heap-scene", &json!({}), &[])?;
        let mu = number(&first, "/grains/contact/friction")?;
        let mut angles = [angles(&first)?; 5];
        let mut runs = vec![first];
        let mut heap = |place: usize, patch: &Value| -> Result<(), LabError> {
            let run = lab.varied(&runs[0], &format!("heap-{}", HEAP[place]), patch)?;
            angles[place] = self::angles(&run)?;
            runs.push(run);
            Ok(())
        };
        let mut walls = own["grains"]["walls"].clone();
        walls[0]["shape"]["box"]["max_m"][2] = json!(0.0);
        let free = &own["grains"]["bodies"][1];
        let contact = json!({"friction": 0});
        heap(
            0,
            &json!({"grains": {"contact": contact, "bodies": [free], "walls": walls}}),
        )?;
        for (place, factor) in [(1, FRICTION[0]), (3, FRICTION[2])] {
            heap(
                place,
                &json!({"grains": {"contact": {"friction": factor * mu}}}),
            )?;
        }
        let rolling = json!({"rolling": {"coefficient": ROLLING}});
        heap(4, &json!({"grains": {"contact": rolling}}))?;
        Ok(Self { runs, angles })
    }

    fn errors(&self) -> Errors {
        let [flat, third, scene, threefold, rolling] = self.angles.map(|[l, r]| 0.5 * (l + r));
        let falls = (third - scene).max(scene - threefold).max(0.0);
        Errors::from([
            ("flat_degrees".to_owned(), flat.abs()),
            ("falls_with_friction_degrees".to_owned(), falls),
            (
                "falls_with_rolling_degrees".to_owned(),
                (scene - rolling).max(0.0),
            ),
        ])
    }
}

/// Slopes of both sides of the heap at the end of a run \[degrees\].
fn angles(run: &Finished) -> Result<[f64; 2], LabError> {
    let frames = frames(&run.artefact)?;
    let last = frames.last().ok_or_else(|| fault(run, "has no frame"))?;
    let half = number(run, "/grains/walls/0/shape/box/max_m/0")?;
    let d = 2.0 * number(run, "/grains/bodies/0/radius_m")?;
    let above = last.position_vectors()?.into_iter().filter(|x| x[2] > 0.0);
    Ok(slopes(&above.collect::<Vec<_>>(), half, d))
}
