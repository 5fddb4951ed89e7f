//! `pool-hydrostatic`: liquid at rest under gravity.

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::norms::Worst;
use crate::particles::{Frames, mean, measurement, number};

/// Komen (2019), section 3.3.4.
const HOMOGENISING: &str = "homogenising";

/// The case.
pub(super) struct PoolHydrostatic;

impl Case for PoolHydrostatic {
    fn name(&self) -> &'static str {
        "pool-hydrostatic"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "p = rho g (H - z), u = 0"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("pressure_l2", 0.01),
            Target::error("speed_residual", 0.005),
            Target::error("pressure_l2", 0.02)
                .at_level(1)
                .of(HOMOGENISING),
            Target::error("pressure_l2", 0.015)
                .at_level(2)
                .of(HOMOGENISING),
            Target::error("speed_residual", 0.005)
                .at_level(2)
                .of(HOMOGENISING),
        ]
    }

    fn methods(&self) -> &'static [&'static str] {
        &["projection", HOMOGENISING]
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        // Homogenising takes three to four times as long, and longer the finer.
        let most = if method == HOMOGENISING { 2 } else { u32::MAX };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = [1e-3, 0.75e-3, 0.5e-3, 0.375e-3][level.clamp(1, 4) as usize - 1];
        let mut patch = serde_json::json!({"spacing_m": spacing});
        if method == HOMOGENISING {
            // The number of sweeps is the stiffness of the liquid, and not only how well it is solved.
            patch["flow"] = serde_json::json!({"method": method, "sweeps_max": 10});
        }
        let name = format!("{method}-level{level}");
        let run = lab.run("poolsph", self.name(), &name, &patch)?;
        let frames = Frames::read(&run.artefact, "pressure")?;
        let liquid = frames.liquid();
        let errors = errors(&run, &frames, &liquid)?;
        measurement(run, liquid.len(), errors)
    }
}

fn errors(run: &Finished, frames: &Frames, liquid: &[usize]) -> Result<Errors, LabError> {
    let density = number(run, "/density_kg_m3")?;
    let gravity = -number(run, "/flow/gravity_m_s2/2")?;
    let [width, length] = [0, 1].map(|k| number(run, &format!("/bodies/1/shape/box/max_m/{k}")));
    // The surface stands where the volume of the liquid puts it.
    let volume = liquid.len() as f64 * frames.volume;
    let height = volume / (width? * length?);
    let bottom = density * gravity * height;
    let late = frames.second_half();
    let miss = |a: &usize| {
        let pressure = mean(late.clone().map(|k| frames.scalar[k][*a]));
        let z = mean(late.clone().map(|k| frames.position[k][*a][2]));
        (pressure - density * gravity * (height - z)) / bottom
    };
    let misses: Vec<f64> = liquid.iter().map(miss).collect();
    let speed = |k: usize| {
        let squares = liquid.iter().map(|a| {
            let u = frames.velocity[k][*a];
            u[0] * u[0] + u[1] * u[1] + u[2] * u[2]
        });
        mean(squares).sqrt()
    };
    let fastest = late.map(speed).worst();
    Ok(Errors::from([
        (
            "pressure_l2".to_owned(),
            mean(misses.iter().map(|m| m * m)).sqrt(),
        ),
        (
            "pressure_linf".to_owned(),
            misses.iter().map(|m| m.abs()).worst(),
        ),
        (
            "speed_residual".to_owned(),
            fastest / (gravity * height).sqrt(),
        ),
    ]))
}
