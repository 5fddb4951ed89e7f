//! `liquid-heat`: a ball that currents heat, and one that melts in a furnace.

use serde_json::{Value, json};

use artefact::{Reader, Record};
use wls::{Cloud, Everything, Metric, Plan, Search, Stencils, Wants};

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::radial::{Ball, Instant};
use crate::em::coaxial::Coaxial;
use crate::em::frames::planned;
use crate::em::sphere::Solution;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct LiquidHeat;

/// Spacings per radius, by level: of a ball that currents heat, and of one that melts, within 0.15 of its radius.
const PARTS: [f64; 3] = [5.0, 6.5, 8.0];
const MELTED: [f64; 3] = [8.0, 13.0, 20.0];
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// A ball of oxide in a furnace: conduction inside is as slow as radiation outside.
const DENSITY: f64 = 3000.0;
const SPECIFIC: f64 = 1300.0;
const CONDUCTIVITY: f64 = 3.0;
const MELTING: [f64; 2] = [2300.0, 1.07e6];
const START: f64 = 2200.0;
const FURNACE: f64 = 4000.0;
const EMISSIVITY: f64 = 0.9;
/// End of the melting over the time in which the furnace as hot as it is would melt all, and steps.
const END: f64 = 0.8;
const STEPS: f64 = 80.0;

impl Case for LiquidHeat {
    fn name(&self) -> &'static str {
        "liquid-heat"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Heat of the exact sphere among loops, P t/(m c), and the ball of the radius alone by finite volumes; Stefan's problem in that ball"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["currents", "melting"]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("rate", 5e-3).of("currents"),
            Target::error("power", 1e-2).of("currents"),
            Target::error("spread", 5e-2).of("currents"),
            Target::error("molten", 2e-2).of("melting"),
            Target::error("surface", 2e-2).of("melting"),
            Target::error("put_back", 2e-2).of("melting"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let all = if method == "melting" { MELTED } else { PARTS };
        let parts = all[level.clamp(1, 3) as usize - 1];
        let scene = planned(lab, self.name(), &json!({}))?;
        let radius = number(&scene["liquid"]["shape"]["sphere"]["radius_m"]);
        let spacing = radius / parts;
        let mut patch = json!({"points": {"spacing_m": spacing}});
        if method == "melting" {
            // The heat of melting of the ball over what its surface takes.
            let all = radius * DENSITY * MELTING[1] / (3.0 * flux());
            let step = END * all / STEPS;
            patch["liquid"] = json!({
                "density_kg_m3": DENSITY, "magnetic": null,
                "heat": {
                    "specific_heat_j_kg_k": SPECIFIC, "thermal_conductivity_w_m_k": CONDUCTIVITY,
                    "temperature_k": START,
                    "radiation": {"emissivity": EMISSIVITY, "surroundings_k": FURNACE},
                    "melting": {"melting_point_k": MELTING[0], "latent_heat_j_kg": MELTING[1]}
                },
                "march": {"end_s": STEPS * step, "step_s": step}
            });
        }
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let rows = reader.records("/liquid")?;
        let errors = if method == "melting" {
            melting(&run, &reader, &rows, radius)?
        } else {
            currents(&run, &reader, &rows, radius)?
        };
        let count = reader.frame("/points", 0)?.len() as u64;
        Ok(Measurement::of(run, count, spacing, errors))
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// What the furnace gives a surface at the melting point \[W/m2\].
fn flux() -> f64 {
    EMISSIVITY * STEFAN_BOLTZMANN * (FURNACE.powi(4) - MELTING[0].powi(4))
}

/// Temperature in the middle, and the mean over the surface \[K\], in the last frame of points that stand so far apart \[m\]. That of
/// the nearest point would not do: from one side of the ball to the other the temperature rises more than along the radius.
fn ends(reader: &Reader, spacing: f64) -> Result<[f64; 2], LabError> {
    let frame = reader.frame("/points", reader.count("/points") - 1)?;
    let (place, t) = (frame.position_vectors()?, frame.f64("temperature")?);
    let kind = frame.f64("kind")?;
    let bad = |what: String| LabError::Content {
        path: reader.path().to_owned(),
        what,
    };
    let metrics = vec![Metric::round(spacing); place.len()];
    let cloud = Cloud {
        points: &place,
        metrics: &metrics,
    };
    let search = Search::new(cloud).map_err(|e| bad(e.to_string()))?;
    let wants = Wants {
        value: true,
        ..Wants::default()
    };
    let plan = Plan::new::<3>(2, wants);
    let fit = Stencils::at(&search, &plan, &[[0.0; 3]], &Everything);
    let middle = fit.map_err(|e| bad(e.to_string()))?.value(0).apply(&t);
    let on: Vec<f64> = (0..t.len())
        .filter(|k| kind[*k] > 0.5)
        .map(|k| t[k])
        .collect();
    let mean = on.iter().sum::<f64>() / on.len() as f64;
    Ok([middle, mean])
}

/// Rise of the mean, and of the surface over the middle, of a ball that currents heat.
fn currents(
    run: &Finished,
    reader: &Reader,
    rows: &[(f64, Record)],
    radius: f64,
) -> Result<Errors, LabError> {
    let liquid = &run.scene["liquid"];
    let alone = json!({
        "bodies": [{"shape": liquid["shape"], "conductivity_s_m": liquid["magnetic"]["conductivity_s_m"]}],
        "eddy_currents": {
            "harmonic": {"frequency_hz": liquid["magnetic"]["frequency_hz"]},
            "coils": liquid["magnetic"]["coils"], "amplitude": liquid["magnetic"]["amplitude"]
        }
    });
    let coaxial = Coaxial::of(&alone).map_err(|what| LabError::Content {
        path: run.artefact.clone(),
        what,
    })?;
    let exact = Solution::of(coaxial.body, coaxial.sources);
    let heat = &liquid["heat"];
    let ball = Ball {
        radius,
        density: number(&liquid["density_kg_m3"]),
        specific: number(&heat["specific_heat_j_kg_k"]),
        conductivity: number(&heat["thermal_conductivity_w_m_k"]),
        radiation: [0.0, 0.0],
        melting: [f64::INFINITY, 1.0],
    };
    let sigma = number(&liquid["magnetic"]["conductivity_s_m"]);
    // The mean over directions: heat flows linearly, so that means over shells see no other.
    let source = |r: f64| {
        let rays = 200;
        let sum: f64 = (0..rays)
            .map(|k| {
                let z = (f64::from(k) + 0.5) / f64::from(rays) * 2.0 - 1.0;
                let j = exact.current(r * (1.0 - z * z).sqrt(), r * z);
                0.5 * j.norm_sqr() / sigma
            })
            .sum();
        sum / f64::from(rays)
    };
    let (end, last) = rows
        .last()
        .map(|(t, r)| (*t, r))
        .ok_or_else(|| LabError::Content {
            path: run.artefact.clone(),
            what: "no rows".to_owned(),
        })?;
    let start = rows[0].1.get("temperature")?;
    let told = ball.at(&[end], start, source)[0];
    let mass = ball.density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let rise = last.get("temperature")? - start;
    // Amplitudes may be peaks or root mean squares: the power tells which.
    let share = exact.power() / (mass * ball.specific * (told.mean - start) / end);
    let wanted = share * (told.surface - told.middle);
    let [middle, surface] = ends(reader, number(&run.scene["points"]["spacing_m"]))?;
    let power = last.get("power")?;
    Ok(Errors::from([
        (
            "rate".to_owned(),
            (rise * mass * ball.specific / (power * end) - 1.0).abs(),
        ),
        ("power".to_owned(), (power / exact.power() - 1.0).abs()),
        (
            "spread".to_owned(),
            ((surface - middle) / wanted - 1.0).abs(),
        ),
    ]))
}

/// Share that is molten over time, and how far the surface is above the melting point at the end.
fn melting(
    run: &Finished,
    reader: &Reader,
    rows: &[(f64, Record)],
    radius: f64,
) -> Result<Errors, LabError> {
    let ball = Ball {
        radius,
        density: DENSITY,
        specific: SPECIFIC,
        conductivity: CONDUCTIVITY,
        radiation: [EMISSIVITY * STEFAN_BOLTZMANN, FURNACE],
        melting: MELTING,
    };
    let times: Vec<f64> = rows[1..].iter().map(|r| r.0).collect();
    let told: Vec<Instant> = ball.at(&times, START, |_| 0.0);
    let mut molten = 0.0_f64;
    for ((_, row), told) in rows[1..].iter().zip(&told) {
        molten = molten.max((row.get("molten")? - told.molten).abs());
    }
    let [_, surface] = ends(reader, number(&run.scene["points"]["spacing_m"]))?;
    let last = told[told.len() - 1];
    let closing = |name: &str| run.closing(name);
    Ok(Errors::from([
        ("molten".to_owned(), molten),
        (
            "surface".to_owned(),
            ((surface - last.surface) / (last.surface - MELTING[0])).abs(),
        ),
        (
            "put_back".to_owned(),
            closing("heat_put_back") / closing("heat_passed"),
        ),
    ]))
}
