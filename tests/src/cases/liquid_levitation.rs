//! `liquid-levitation`: a drop of metal in the alternating field of four loops.

use serde_json::{Value, json};

use artefact::{Reader, Record};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::coaxial::Coaxial;
use crate::em::frames::planned;
use crate::em::sphere::Solution;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct LiquidLevitation;

/// Spacings per radius, by level.
const PARTS: [f64; 3] = [5.0, 6.5, 8.0];
/// Spacings of the field over those.
const FIELD: f64 = 0.8;

/// The sphere at the start; the shape at rest of a stiff drop, and how many times as stiff; steps of a drop that is released.
const METHODS: &[&str] = &["start", "rest", "released"];
const STIFF: f64 = 20.0;
const STEPS: f64 = 4.0;

impl Case for LiquidLevitation {
    fn name(&self) -> &'static str {
        "liquid-levitation"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Sphere among loops, Smythe (1950); shape of first order in the force over the tension, by Green's identity"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("lift", 1e-2).of("start"),
            Target::error("power", 1e-2).of("start"),
            Target::error("traction", 1e-2).of("start"),
            Target::error("factor", 5e-3).of("rest"),
            Target::error("mode_2", 2e-2).of("rest"),
            Target::error("mode_3", 5e-2).of("rest"),
            Target::error("volume", 1e-4).of("released"),
            Target::error("aside", 1e-3).of("released"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let scene = planned(lab, self.name(), &json!({}))?;
        let radius = number(&scene["liquid"]["shape"]["sphere"]["radius_m"]);
        let spacing = radius / parts;
        let mut patch = json!({
            "points": {"spacing_m": spacing},
            "liquid": {"magnetic": {"spacing_m": FIELD * spacing}}
        });
        let step = number(&scene["liquid"]["march"]["step_s"]);
        match method {
            "rest" => {
                let stiff = STIFF * number(&scene["liquid"]["surface_tension_n_m"]);
                patch["liquid"]["surface_tension_n_m"] = json!(stiff);
                patch["liquid"]["march"] = Value::Null;
                patch["liquid"]["equilibrium"] = json!({});
                patch["liquid"]["magnetic"]["balanced"] = json!(true);
            }
            "released" => {
                let axes = [0.99, 0.99, 1.0203].map(|a| a * radius);
                patch["liquid"]["shape"] = json!({"sphere": null, "ellipsoid":
                    {"centre_m": scene["liquid"]["shape"]["sphere"]["centre_m"], "semi_axes_m": axes}});
                patch["liquid"]["magnetic"]["balanced"] = json!(true);
                patch["liquid"]["march"]["end_s"] = json!(STEPS * step);
            }
            _ => patch["liquid"]["march"]["end_s"] = json!(step),
        }
        let run = lab.run(
            self.tool(),
            self.name(),
            &format!("level{level}-{method}"),
            &patch,
        )?;
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let rows = reader.records("/liquid")?;
        let errors = match method {
            "rest" => rest(&run, &scene, &rows[0].1)?,
            "released" => released(&rows, radius)?,
            _ => start(&run, &reader, &scene, &rows[0].1)?,
        };
        let count = reader.frame("/points", 0)?.len() as u64;
        Ok(Measurement::of(run, count, spacing, errors))
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// The sphere in the loops of a scene whose liquid it is.
fn exact(scene: &Value, run: &Finished) -> Result<Solution, LabError> {
    let (liquid, magnetic) = (&scene["liquid"], &scene["liquid"]["magnetic"]);
    let alone = json!({
        "bodies": [{"shape": liquid["shape"], "conductivity_s_m": magnetic["conductivity_s_m"]}],
        "eddy_currents": {
            "harmonic": {"frequency_hz": magnetic["frequency_hz"]},
            "coils": magnetic["coils"], "amplitude": magnetic["amplitude"]
        }
    });
    let coaxial = Coaxial::of(&alone).map_err(|what| LabError::Content {
        path: run.artefact.clone(),
        what,
    })?;
    Ok(Solution::of(coaxial.body, coaxial.sources))
}

/// Lift and heat at the start, and the harmonics of the traction.
///
/// What the force does to an even liquid is that of a pressure psi on its surface, `- int psi dh/dn dS = int f . grad h dV` for every
/// harmonic h: `psi_l = - (2 l + 1)/(4 pi l R^(l + 1)) int f . grad(r^l P_l) dV`.
fn start(run: &Finished, reader: &Reader, scene: &Value, row: &Record) -> Result<Errors, LabError> {
    let exact = exact(scene, run)?;
    let surface = reader.frame("/surface", 0)?;
    let middle = number(&scene["liquid"]["shape"]["sphere"]["centre_m"][2]);
    let radius = exact.radius();
    let (position, area) = (surface.position_vectors()?, surface.f64("area")?);
    let traction = surface.f64("traction")?;
    let (mut lack, mut most) = (0.0_f64, 0.0_f64);
    for l in 1..=3 {
        let degree = f64::from(l);
        let share = (2.0 * degree + 1.0) / (4.0 * std::f64::consts::PI);
        let wanted = -share * work(&exact, l) / (degree * radius.powi(l + 1));
        let part = |k: usize| -traction[k] * area[k] * solid(l, (position[k][2] - middle) / radius);
        let found: f64 = (0..traction.len()).map(part).sum();
        lack = lack.max((share * found / (radius * radius) - wanted).abs());
        most = most.max(wanted.abs());
    }
    Ok(Errors::from([
        (
            "lift".to_owned(),
            (row.get("force_z")? / exact.lift() - 1.0).abs(),
        ),
        (
            "power".to_owned(),
            (row.get("power")? / exact.power() - 1.0).abs(),
        ),
        ("traction".to_owned(), lack / most),
    ]))
}

/// `P_l` up to l = 3.
fn solid(l: i32, z: f64) -> f64 {
    match l {
        1 => z,
        2 => 1.5 * z * z - 0.5,
        _ => 2.5 * z * z * z - 1.5 * z,
    }
}

/// The shape at rest against that of first order.
///
/// `a = f/rho - grad p/rho` has no sources and p is even on the sphere, so that with `h = r^l P_l` the accelerations of the surface
/// are `int a_n h dS = (1/rho) int f . grad h dV`, and the harmonic that brings them to rest is
/// `c_l = (2 l + 1)/(4 pi) R^(1 - l)/(gamma l (l-1)(l+2)) int f . grad h dV`.
fn rest(run: &Finished, scene: &Value, row: &Record) -> Result<Errors, LabError> {
    let exact = exact(scene, run)?;
    let liquid = &scene["liquid"];
    let radius = exact.radius();
    let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let weight = number(&liquid["density_kg_m3"]) * volume * -number(&liquid["gravity_m_s2"][2]);
    let factor = (weight / exact.lift()).sqrt();
    let tension = number(&run.scene["liquid"]["surface_tension_n_m"]);
    let mut errors = Errors::new();
    for (l, name) in [(2, "mode_2"), (3, "mode_3")] {
        let work = factor * factor * work(&exact, l);
        let f = f64::from(l);
        let stiff = tension * f * (f - 1.0) * (f + 2.0);
        let share = (2.0 * f + 1.0) / (4.0 * std::f64::consts::PI);
        let wanted = share * radius.powi(1 - l) * work / stiff;
        errors.insert(name.to_owned(), (row.get(name)? / wanted - 1.0).abs());
    }
    let found = run.closing("current_factor");
    errors.insert("factor".to_owned(), (found / factor - 1.0).abs());
    Ok(errors)
}

/// `int f . grad(r^l P_l) dV` of the mean force on the exact sphere, l from 1 to 3.
fn work(exact: &Solution, l: i32) -> f64 {
    let radius = exact.radius();
    let (shells, rays) = (400, 200);
    let mut sum = 0.0;
    for shell in 0..shells {
        // Midpoints of depths that grow from the surface inward.
        let at = |k: f64| radius * (1.0 - (k / f64::from(shells)).powi(2));
        let (outer, inner) = (at(f64::from(shell)), at(f64::from(shell + 1)));
        let r = 0.5 * (outer + inner);
        for ray in 0..rays {
            let cosine = (f64::from(ray) + 0.5) / f64::from(rays) * 2.0 - 1.0;
            let (rho, z) = (r * (1.0 - cosine * cosine).sqrt(), r * cosine);
            let [away, along] = exact.flux(rho, z);
            let current = exact.current(rho, z);
            let [f_rho, f_z] = [(current * along.conj()).re, -(current * away.conj()).re];
            let [g_rho, g_z] = match l {
                1 => [0.0, 1.0],
                2 => [-rho, 2.0 * z],
                _ => [-3.0 * z * rho, 3.0 * z * z - 1.5 * rho * rho],
            };
            let volume =
                2.0 * std::f64::consts::PI * r * r * (outer - inner) * 2.0 / f64::from(rays);
            sum += volume * (f_rho * g_rho + f_z * g_z);
        }
    }
    sum
}

/// What a released drop keeps: volume, and its place on the axis over its radius.
fn released(rows: &[(f64, Record)], radius: f64) -> Result<Errors, LabError> {
    let first = rows[0].1.get("volume")?;
    let (mut volume, mut aside) = (0.0_f64, 0.0_f64);
    for (_, row) in rows {
        volume = volume.max((row.get("volume")? / first - 1.0).abs());
        aside = aside.max(row.get("centre_x")?.hypot(row.get("centre_y")?) / radius);
    }
    Ok(Errors::from([
        ("volume".to_owned(), volume),
        ("aside".to_owned(), aside),
    ]))
}
