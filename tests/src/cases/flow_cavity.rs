//! `flow-cavity`: a box of air, heated from one side and cooled from the other.

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::particles::{Frames, mean, measurement, number};

/// The case.
pub(super) struct FlowCavity;

/// Rayleigh number, known Nusselt number, and the end in L^2/alpha of each method.
const KNOWN: [(&str, f64, f64, f64); 6] = [
    ("cube-1e3", 1e3, 1.070, 0.4),
    ("cube-1e4", 1e4, 2.054, 0.4),
    ("cube-1e5", 1e5, 4.337, 0.25),
    ("square-1e3", 1e3, 1.118, 0.4),
    ("square-1e4", 1e4, 2.243, 0.4),
    ("square-1e5", 1e5, 4.519, 0.25),
];

impl Case for FlowCavity {
    fn name(&self) -> &'static str {
        "flow-cavity"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "mean Nusselt numbers at Pr 0.71: Tric, Labrosse and Betrouni (2000), the cube; de Vahl Davis (1983), the square"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[
            "square-1e3",
            "square-1e4",
            "square-1e5",
            "cube-1e3",
            "cube-1e4",
            "cube-1e5",
        ]
    }

    fn targets(&self) -> Vec<Target> {
        let each = KNOWN.iter().flat_map(|(method, rayleigh, ..)| {
            let bounds = if *rayleigh < 5e4 {
                [0.05, 0.02]
            } else {
                [0.1, 0.03]
            };
            let at =
                |level: u32, max: f64| Target::error("nusselt", max).at_level(level).of(*method);
            [at(2, bounds[0]), at(3, bounds[1])]
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let known = KNOWN.iter().find(|(name, ..)| *name == method);
        let Some((_, rayleigh, nusselt, end)) = known else {
            unreachable!("methods are those that are known");
        };
        // 10, 20 and 40 particles an edge.
        let cells = 5.0 * f64::from(1 << level);
        let (edge, density, prandtl) = (0.01_f64, 1000.0, 0.71);
        let diffusivity = (9.81 * 0.1 * edge.powi(3) / (rayleigh * prandtl)).sqrt();
        let time = edge * edge / diffusivity;
        let mut patch = serde_json::json!({
            "spacing_m": edge / cells,
            "time": {"step_s": 5e-3 / cells * time, "end_s": end * time},
            "flow": {"viscosity_pa_s": prandtl * diffusivity * density},
            "heat": {"thermal_conductivity_w_m_k": diffusivity * density * 1000.0},
            "output": {"particles_interval_s": end / 40.0 * time}
        });
        if method.starts_with("cube") {
            let all = ["y-", "y+", "z-", "z+"].map(|face| serde_json::json!({ "face": face }));
            let held = [("x-", 305), ("x+", 295)]
                .map(|(face, kelvin)| serde_json::json!({"face": face, "temperature_k": kelvin}));
            let walls: Vec<_> = held.into_iter().chain(all).collect();
            patch["faces"] =
                serde_json::json!({"max_m": [edge, edge, edge], "mirror": [], "wall": walls});
            patch["bodies"] = serde_json::json!([{
                "shape": {"box": {"min_m": [0, 0, 0], "max_m": [edge, edge, edge]}},
                "state": "liquid",
                "temperature_k": 300
            }]);
        }
        let run = lab.run(
            "poolsph",
            self.name(),
            &format!("{method}-level{level}"),
            &patch,
        )?;
        let frames = Frames::read(&run.artefact, "temperature")?;
        let errors = errors(&run, &frames, *nusselt)?;
        measurement(run, frames.liquid.len(), errors)
    }
}

/// In steady flow every section across x passes the same heat, so that their mean is that of the box:
/// Nu = 1 + mean of u theta over it, u in alpha/L. The last quarter of the run is taken.
fn errors(run: &Finished, frames: &Frames, known: f64) -> Result<Errors, LabError> {
    let edge = number(run, "/faces/max_m/0")?;
    let capacity = number(run, "/density_kg_m3")? * number(run, "/heat/specific_heat_j_kg_k")?;
    let diffusivity = number(run, "/heat/thermal_conductivity_w_m_k")? / capacity;
    let hot = number(run, "/faces/wall/0/temperature_k")?;
    let cold = number(run, "/faces/wall/1/temperature_k")?;
    let end = frames.time.last().copied().unwrap_or(0.0);
    let late = (0..frames.time.len()).filter(|k| frames.time[*k] > 0.75 * end);
    let carried = |k: usize| {
        let points = frames.velocity[k].iter().zip(&frames.scalar[k]);
        mean(points.map(|(u, kelvin)| {
            let theta = (kelvin - 0.5 * (hot + cold)) / (hot - cold);
            u[0] * edge / diffusivity * theta
        }))
    };
    let nusselt = 1.0 + mean(late.map(carried));
    Ok(Errors::from([(
        "nusselt".to_owned(),
        (nusselt / known - 1.0).abs(),
    )]))
}
