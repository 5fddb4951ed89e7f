//! `flow-poiseuille` and `flow-couette`: liquid between two plates, from rest on.

use crate::case::{Case, Errors, Measurement, Target};
use crate::flow::{Channel, METHODS, layers};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, measurement, number};

/// A flow between plates.
pub(super) struct FlowChannel {
    name: &'static str,
    reference: &'static str,
}

impl FlowChannel {
    /// Driven by a force.
    pub(super) const POISEUILLE: Self = Self {
        name: "flow-poiseuille",
        reference: "u_t = nu u_zz + g from rest, by sines; Morris, Fox and Zhu (1997), eq. 22",
    };
    /// Driven by a plate.
    pub(super) const COUETTE: Self = Self {
        name: "flow-couette",
        reference: "u_t = nu u_zz from rest beside a moving plate, by sines; Morris, Fox and Zhu (1997), eq. 21",
    };
}

impl Case for FlowChannel {
    fn name(&self) -> &'static str {
        self.name
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        self.reference
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("profile", 0.01).at_level(2),
            Target::error("profile", 0.01).at_level(3),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 10, 20 and 30 layers.
        let spacing = 1e-3 / f64::from(level);
        let patch = serde_json::json!({"spacing_m": spacing, "flow": {"method": method}});
        let run = lab.run(
            "poolsph",
            self.name,
            &format!("{method}-level{level}"),
            &patch,
        )?;
        let frames = Frames::read(&run.artefact, "pressure")?;
        let errors = errors(&run, &frames)?;
        measurement(run, frames.liquid.len(), errors)
    }
}

/// Speeds of layers, and of single particles, beside the exact ones, over the greatest speed; the worst of all times.
fn errors(run: &Finished, frames: &Frames) -> Result<Errors, LabError> {
    let high = number(run, "/faces/max_m/2")?;
    let density = number(run, "/density_kg_m3")?;
    let nu = number(run, "/flow/viscosity_pa_s")? / density;
    let along = number(run, "/flow/gravity_m_s2/0").unwrap_or(0.0);
    let flow = Channel {
        plate: number(run, "/faces/wall/1/velocity_m_s/0").unwrap_or(0.0),
        force: along * high * high / (8.0 * nu),
    };
    let greatest = flow.plate.abs().max(flow.force.abs());
    let n = (high / number(run, "/spacing_m")?).round() as usize;
    let (mut profile, mut single): (f64, f64) = (0.0, 0.0);
    let all = frames
        .time
        .iter()
        .zip(&frames.position)
        .zip(&frames.velocity);
    for ((time, places), speeds) in all.skip(1) {
        let exact = |z: f64| flow.speed(z / high, nu * time / (high * high));
        let points = places.iter().zip(speeds).map(|(x, u)| (x[2], u[0]));
        for (z, u) in points.clone() {
            single = single.max((u - exact(z)).abs() / greatest);
        }
        for [z, u] in layers(points, high, n) {
            profile = profile.max((u - exact(z)).abs() / greatest);
        }
    }
    let errors = [("profile", profile), ("single", single)];
    Ok(errors.map(|(name, error)| (name.to_owned(), error)).into())
}
