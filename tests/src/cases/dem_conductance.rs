//! `dem-conductance`: two grains that touch, and a chain of grains between two temperatures.

use artefact::Frame;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames, mass};
use crate::lab::{Finished, Lab, LabError};
use crate::norms::Worst as _;
use crate::particles::number;

/// The case.
pub(super) struct DemConductance;

const METHODS: [&str; 5] = ["elastic", "overlap", "printed", "wetted", "chain"];
/// Conductivity of slag over that of powder.
const SLAG: f64 = 3.0;
/// Grains of the chain.
const CHAIN: usize = 8;

impl Case for DemConductance {
    fn name(&self) -> &'static str {
        "dem-conductance"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "two heat capacities and a conductance: exp(-H t (1/C_a + 1/C_b)); a straight line between kept ends"
    }

    fn methods(&self) -> &'static [&'static str] {
        &METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let pair = |method: &&'static str| {
            [
                Target::error("difference", 1e-3).of(*method),
                Target::error("energy", 1e-10).of(*method),
            ]
        };
        let mut targets: Vec<Target> = METHODS[..4].iter().flat_map(pair).collect();
        targets.push(Target::error("line", 1e-3).of("chain"));
        targets.push(Target::error("heat", 1e-3).of("chain"));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = 400.0 * f64::from(1 << (level.clamp(1, 5) - 1));
        let label = |kind: &str| format!("{method}-{kind}-level{level}");
        let contact = match method {
            "overlap" | "printed" => json!({"grains": {"heat": {"contact": method}}}),
            // Slag from the start.
            "wetted" => json!({"grains": {"heat": {"slag_wets": true, "melting":
                {"point_k": 300, "latent_heat_j_kg": 0, "slag_conductivity_ratio": SLAG}}}}),
            _ => json!({}),
        };
        let scene = lab.run("poolsph", self.name(), &label("scene"), &contact)?;
        let exact = Exact::of(&scene, method)?;
        let time = if method == "chain" { 40.0 } else { 1.0 } * exact.capacity / exact.conductance;
        let step = time / parts;
        let times = json!({"time": {"step_s": step, "end_s": time}, "output": {"particles_interval_s": time / 4.0}});
        let mut patch = times;
        if method == "chain" {
            patch["grains"] = json!({"bodies": exact.chain()});
        }
        let run = lab.varied(&scene, &label("run"), &patch)?;
        let frames = frames(&run.artefact)?;
        let last = frames.last().ok_or_else(|| fault(&run, "has no frame"))?;
        let errors = if method == "chain" {
            exact.line(&run, last)?
        } else {
            exact.pair(&run, last, time)?
        };
        Ok(Measurement::of(
            run,
            parts as u64,
            exact.radius / parts,
            errors,
        ))
    }
}

struct Exact {
    radius: f64,
    distance: f64,
    conductance: f64,
    capacity: f64,
    ends: [f64; 2],
    body: Value,
}

impl Exact {
    fn of(run: &Finished, method: &str) -> Result<Self, LabError> {
        let at = |key: &str| number(run, &format!("/grains/{key}"));
        let (r, k) = (
            at("bodies/0/radius_m")?,
            at("heat/thermal_conductivity_w_m_k")?,
        );
        let distance = at("bodies/1/places_m/0/0")? - at("bodies/0/places_m/0/0")?;
        let by_overlap = (r * r - 0.25 * distance * distance).sqrt();
        let (r_c, factor) = match method {
            "overlap" => (by_overlap, 1.0),
            "printed" => (by_overlap, 0.5),
            // As a cell of slag of the diameter.
            "wetted" => (r, SLAG),
            _ => {
                let push = at("contact/law/linear/stiffness_n_m")? * (2.0 * r - distance);
                let nu = at("heat/contact/elastic/poisson_ratio")?;
                let modulus = 0.5 * at("heat/contact/elastic/youngs_modulus_pa")? / (1.0 - nu * nu);
                ((0.75 * push * 0.5 * r / modulus).cbrt(), 1.0)
            }
        };
        let share = r_c / r;
        let gas = at("heat/gas_conductivity_w_m_k")?
            * 2.0
            * std::f64::consts::PI
            * (1.0 - 0.5 * share * share)
            * (r - r_c)
            / (1.0 - std::f64::consts::FRAC_PI_4);
        Ok(Self {
            radius: r,
            distance,
            conductance: factor * 2.0 * k * r_c + gas,
            capacity: mass(at("density_kg_m3")?, r) * at("heat/specific_heat_j_kg_k")?,
            ends: [at("bodies/0/temperature_k")?, at("bodies/1/temperature_k")?],
            body: run.scene["grains"]["bodies"][0].clone(),
        })
    }

    /// Bodies of a chain whose ends keep their temperatures.
    fn chain(&self) -> Vec<Value> {
        let one = |k: usize| {
            let mut body = self.body.clone();
            body["places_m"] = json!([[k as f64 * self.distance, 0.0, 0.0]]);
            let held = if k == 0 { self.ends[0] } else { self.ends[1] };
            if k == 0 || k == CHAIN - 1 {
                body["held_temperature_k"] = json!(held);
            }
            body["temperature_k"] = json!(held);
            body
        };
        (0..CHAIN).map(one).collect()
    }

    fn pair(&self, run: &Finished, last: &Frame, time: f64) -> Result<Errors, LabError> {
        let found = last.f64("temperature")?;
        let first = self.ends[0] - self.ends[1];
        let exact = first * (-2.0 * self.conductance * time / self.capacity).exp();
        let records = artefact::Reader::open(&run.artefact)?.records("/grains_balance")?;
        let enthalpy = |k: usize| records[k].1.get("enthalpy_j");
        let energy = (enthalpy(records.len() - 1)? - enthalpy(0)?).abs();
        Ok(Errors::from([
            (
                "difference".to_owned(),
                ((found[0] - found[1] - exact) / first).abs(),
            ),
            ("energy".to_owned(), energy / (self.capacity * first.abs())),
        ]))
    }

    fn line(&self, run: &Finished, last: &Frame) -> Result<Errors, LabError> {
        let found = last.f64("temperature")?;
        let [hot, cold] = self.ends;
        let share = |k: usize| k as f64 / (CHAIN - 1) as f64;
        let off = (0..CHAIN).map(|k| (found[k] - hot - share(k) * (cold - hot)).abs());
        // What the ends bring goes into the chain.
        let records = artefact::Reader::open(&run.artefact)?.records("/grains_balance")?;
        let record = |k: usize, name: &str| records[k].1.get(name);
        let end = records.len() - 1;
        let stored = record(end, "enthalpy_j")? - record(0, "enthalpy_j")?;
        let brought = record(end, "grain_heat_held_j")? - record(0, "grain_heat_held_j")?;
        Ok(Errors::from([
            ("line".to_owned(), off.worst() / (hot - cold).abs()),
            ("heat".to_owned(), (brought / stored - 1.0).abs()),
        ]))
    }
}
