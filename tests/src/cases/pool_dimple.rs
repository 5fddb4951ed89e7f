//! `pool-dimple`: a pool at rest under a pressure that dents it.

use run::property::{Arguments, Property};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::meniscus::{Meniscus, Pool};
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct PoolDimple;

/// Windows through which the hollow is seen, as parts of the radius of the pool.
const WINDOWS: [(&str, f64); 2] = [("hollow", 0.4), ("tip", 0.2)];

impl Case for PoolDimple {
    fn name(&self) -> &'static str {
        "pool-dimple"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Young (1805), Laplace (1806): gamma kappa = p + rho g eta - c, integrated"
    }

    fn targets(&self) -> Vec<Target> {
        // No order: the packing of the skin and the slowness of what is not stirred err against each other.
        vec![
            Target::error("hollow", 0.15).at_level(1),
            Target::error("hollow", 0.1).at_level(2),
            Target::error("hollow", 0.1).at_level(3),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = [5e-4, 3.75e-4, 2.5e-4][level.clamp(1, 3) as usize - 1];
        let patch = serde_json::json!({"spacing_m": spacing});
        let run = lab.run("poolsph", self.name(), &format!("level{level}"), &patch)?;
        let frames = Frames::read(&run.artefact, "pressure")?;
        let liquid = frames.liquid();
        let errors = errors(&run, &frames, &liquid)?;
        measurement(run, liquid.len(), errors)
    }
}

/// What the hollow holds, seen through a window (1 - (r/a)^2)^2, beside what it holds at rest.
fn errors(run: &Finished, frames: &Frames, liquid: &[usize]) -> Result<Errors, LabError> {
    let radius = number(run, "/bodies/0/shape/cylinder/radius_m")?;
    let exact = at_rest(run, radius)?;
    let particle = number(run, "/spacing_m")?.powi(3);
    let mut errors = Errors::new();
    for (name, part) in WINDOWS {
        let window = |r: f64| (1.0 - (r / (part * radius)).powi(2)).max(0.0).powi(2);
        // As it stands, the lattice has the surface at zero but for its own unevenness.
        let seen = |k: usize| -> f64 {
            let share = |a: &usize| {
                let [x, y, _] = frames.position[k][*a];
                particle * window(x.hypot(y))
            };
            liquid.iter().map(share).sum()
        };
        let held = mean(frames.second_half().map(seen)) - seen(0);
        let asked = exact.volume(window);
        errors.insert(name.to_owned(), (held / asked - 1.0).abs());
    }
    Ok(errors)
}

/// The surface at rest.
fn at_rest(run: &Finished, radius: f64) -> Result<Meniscus, LabError> {
    let wrong = |what: String| LabError::Content {
        path: run.artefact.clone(),
        what,
    };
    let density = number(run, "/density_kg_m3")?;
    let pool = Pool {
        radius,
        tension: number(run, "/tension/surface_tension_n_m")?,
        weight: -density * number(run, "/flow/gravity_m_s2/2")?,
    };
    let written = run.scene["arc_pressure"]["pressure_pa"].clone();
    let property: Property = serde_json::from_value(written).map_err(|e| wrong(e.to_string()))?;
    let curve = property
        .compile("/arc_pressure/pressure_pa", &["r", "t"])
        .map_err(|fault| wrong(fault.to_string()))?;
    let time = number(run, "/time/end_s")?;
    let pressure = |r: f64| {
        let at = Arguments {
            r,
            time,
            ..Arguments::default()
        };
        curve.value(&at).unwrap_or(f64::NAN)
    };
    let rest = pool.under(pressure);
    rest.ok_or_else(|| wrong("no surface is at rest under its pressure".to_owned()))
}
