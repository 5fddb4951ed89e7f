//! `dem-bed`: what a bed conducts under the same load, whatever the spring of its contacts; with gas and without.

use std::f64::consts::PI;

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames, mass};
use crate::lab::{Finished, Lab, LabError};
use crate::norms::Worst as _;
use crate::particles::number;

/// The case.
pub(super) struct DemBed;

/// Layers of the bed.
const LAYERS: usize = 10;
/// Grains along the sides of a layer.
const SIDE: usize = 3;
/// Springs \[N/m\].
const SPRINGS: [f64; 3] = [75.0, 2.7e3, 1e5];

impl Case for DemBed {
    fn name(&self) -> &'static str {
        "dem-bed"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "decay of a cosine in a cubic bed; bounds of layers in series and side by side (Wiener 1912)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["gas", "vacuum"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = |method: &'static str| {
            [
                Target::error("of_spring", 0.01).of(method),
                Target::error("conductivity", 0.01).of(method),
            ]
        };
        let mut targets: Vec<Target> = ["gas", "vacuum"].into_iter().flat_map(each).collect();
        targets.push(Target::error("out_of_bounds", 0.0).of("gas"));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = 100.0 * f64::from(1 << (level.clamp(1, 5) - 1));
        let gas = if method == "gas" {
            json!({})
        } else {
            json!({"grains": {"heat": {"gas_conductivity_w_m_k": null}}})
        };
        let scene = lab.run(
            "poolsph",
            self.name(),
            &format!("{method}-scene{level}"),
            &gas,
        )?;
        let bed = Bed::of(&scene)?;
        let (mut found, mut runs) = (Vec::new(), Vec::new());
        for (n, spring) in SPRINGS.into_iter().enumerate() {
            let patch = bed.patch(spring, parts);
            let run = lab.varied(&scene, &format!("{method}-{n}-level{level}"), &patch)?;
            found.push(bed.conductivity(&run, spring)?);
            runs.push(run);
        }
        let last = found[found.len() - 1];
        let apart = found.iter().map(|k| (k / last - 1.0).abs());
        let [series, parallel] = bed.bounds();
        let exact = bed.conductance() / bed.spacing(SPRINGS[2]);
        let errors = Errors::from([
            ("of_spring".to_owned(), apart.worst()),
            ("conductivity".to_owned(), (last / exact - 1.0).abs()),
            (
                "out_of_bounds".to_owned(),
                (series / last - 1.0).max(last / parallel - 1.0).max(0.0),
            ),
        ]);
        let points = LAYERS * SIDE * SIDE;
        Ok(Measurement::over(
            runs,
            points as u64,
            2.0 * bed.radius / parts,
            errors,
        ))
    }
}

struct Bed {
    radius: f64,
    /// Push of each contact \[N\].
    load: f64,
    solid: f64,
    gas: f64,
    modulus: f64,
    capacity: f64,
    body: Value,
}

impl Bed {
    /// The load is that of the two grains of the scene.
    fn of(run: &Finished) -> Result<Self, LabError> {
        let at = |key: &str| number(run, &format!("/grains/{key}"));
        let radius = at("bodies/0/radius_m")?;
        let apart = at("bodies/0/places_m/1/2")? - at("bodies/0/places_m/0/2")?;
        let nu = at("heat/contact/elastic/poisson_ratio")?;
        Ok(Self {
            radius,
            load: at("contact/law/linear/stiffness_n_m")? * (2.0 * radius - apart),
            solid: at("heat/thermal_conductivity_w_m_k")?,
            gas: at("heat/gas_conductivity_w_m_k").unwrap_or(0.0),
            modulus: 0.5 * at("heat/contact/elastic/youngs_modulus_pa")? / (1.0 - nu * nu),
            capacity: mass(at("density_kg_m3")?, radius) * at("heat/specific_heat_j_kg_k")?,
            body: run.scene["grains"]["bodies"][0].clone(),
        })
    }

    fn spacing(&self, spring: f64) -> f64 {
        2.0 * self.radius - self.load / spring
    }

    /// H of a contact \[W/K\].
    fn conductance(&self) -> f64 {
        let r = self.radius;
        let r_c = (0.75 * self.load * 0.5 * r / self.modulus).cbrt();
        let share = r_c / r;
        let gas = 2.0 * PI * (1.0 - 0.5 * share * share) * (r - r_c) / (1.0 - 0.25 * PI);
        2.0 * self.solid * r_c + self.gas * gas
    }

    /// Conductivities of layers in series and side by side \[W/(m K)\].
    fn bounds(&self) -> [f64; 2] {
        let filled = PI / 6.0;
        let series = 1.0 / (filled / self.solid + (1.0 - filled) / self.gas);
        [series, filled * self.solid + (1.0 - filled) * self.gas]
    }

    /// The bed with a cosine of temperature over its height.
    fn patch(&self, spring: f64, parts: f64) -> Value {
        let d = self.spacing(spring);
        let height = LAYERS as f64 * d;
        let mut places = Vec::new();
        for k in 0..LAYERS {
            for j in 0..SIDE {
                for i in 0..SIDE {
                    places.push([i, j, k].map(|n| (n as f64 + 0.5) * d));
                }
            }
        }
        let mut body = self.body.clone();
        body["places_m"] = json!(places);
        body["temperature_k"] = json!({"expr": format!("900 + 100*cos(pi*z/{height})")});
        // Until the cosine has fallen to a third.
        let end = self.capacity / (self.conductance() * self.rate());
        json!({
            "time": {"step_s": end / parts, "end_s": end},
            "grains": {"bodies": [body], "contact": {"law": {"linear": {"stiffness_n_m": spring}}}},
            "output": {"particles_interval_s": end}
        })
    }

    /// Rate of the cosine over H / C.
    fn rate(&self) -> f64 {
        2.0 * (1.0 - (PI / LAYERS as f64).cos())
    }

    /// Conductivity by the decay \[W/(m K)\].
    fn conductivity(&self, run: &Finished, spring: f64) -> Result<f64, LabError> {
        let frames = frames(&run.artefact)?;
        let height = LAYERS as f64 * self.spacing(spring);
        let mode = |k: usize| -> Result<f64, LabError> {
            let (x, t) = (frames[k].position_vectors()?, frames[k].f64("temperature")?);
            let each = x.iter().zip(t);
            Ok(each
                .map(|(x, t)| (t - 900.0) * (PI * x[2] / height).cos())
                .sum())
        };
        let last = frames.len() - 1;
        if last == 0 {
            return Err(fault(run, "has one frame only"));
        }
        let rate = (mode(0)? / mode(last)?).ln() / frames[last].time_s;
        Ok(rate * self.capacity / self.rate() / self.spacing(spring))
    }
}
