//! `liquid-stretched`: drops that are let go far from the sphere, so that their points crowd.

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::swing::zeros;
use crate::drop::{Series, drift, points};
use crate::em::frames::planned;
use crate::lab::{Lab, LabError};
use crate::norms::Worst as _;

/// The case.
pub(super) struct LiquidStretched;

/// Spacings in the radius of the sphere that is as large, by level.
const PARTS: [f64; 3] = [5.0, 6.0, 7.5];
/// Ohnesorge number.
const OHNESORGE: f64 = 0.02;
/// Periods of small swings.
const PERIODS: f64 = 1.1;

impl Case for LiquidStretched {
    fn name(&self) -> &'static str {
        "liquid-stretched"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Volume, momentum and the sum of the energies, which friction alone lessens"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["2", "2.5"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = self.methods().iter().flat_map(|method| {
            [
                Target::error("energy_back", 1e-3).of(*method),
                Target::error("volume", 1e-4).of(*method),
                Target::error("centre", 1e-3).of(*method),
            ]
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let ratio: f64 = method.parse().unwrap_or(2.0);
        let scene = planned(lab, self.name(), &json!({}))?;
        let number = |pointer: &str| {
            let found = scene.pointer(pointer).and_then(serde_json::Value::as_f64);
            found.unwrap_or(f64::NAN)
        };
        let axes = [0, 1, 2].map(|k| number(&format!("/liquid/shape/ellipsoid/semi_axes_m/{k}")));
        let radius = axes.iter().product::<f64>().cbrt();
        let density = number("/liquid/density_kg_m3");
        let tension = number("/liquid/surface_tension_n_m");
        let time = (density * radius.powi(3) / tension).sqrt();
        let wide = radius / ratio.cbrt();
        let period = 2.0 * PI / 8.0_f64.sqrt() * time;
        let patch = json!({
            "points": {"spacing_m": radius / parts},
            "liquid": {
                "shape": {"ellipsoid": {"semi_axes_m": [wide, wide, ratio * wide]}},
                "viscosity_pa_s": OHNESORGE * (density * tension * radius).sqrt(),
                "march": {"end_s": PERIODS * period}
            }
        });
        let run = lab.run(
            self.tool(),
            self.name(),
            &format!("level{level}-{method}"),
            &patch,
        )?;
        let [kinetic, surface] =
            ["kinetic_energy", "surface_energy"].map(|n| Series::read(&run, n));
        let (kinetic, surface) = (kinetic?.value, surface?.value);
        let energy: Vec<f64> = kinetic.iter().zip(&surface).map(|(k, s)| k + s).collect();
        let centre = ["x", "y", "z"].map(|axis| Series::read(&run, &format!("centre_{axis}")));
        let mut aside = 0.0_f64;
        for series in centre {
            let series = series?.value;
            let most = series.iter().map(|c| (c - series[0]).abs());
            aside = [aside, most.worst() / radius].into_iter().worst();
        }
        let errors = Errors::from([
            ("energy_back".to_owned(), back(&energy)),
            ("volume".to_owned(), drift(&run)?),
            ("centre".to_owned(), aside),
        ]);
        let mode = Series::read(&run, "mode_2")?;
        let zeros = zeros(&mode);
        let half = match zeros[..] {
            [first, second, ..] => 2.0 * (second - first) / period,
            _ => f64::NAN,
        };
        let count = points(&run)?;
        let costs = [("points", count as f64), ("period_over_small", half)];
        Ok(Measurement::of(run, count, radius / parts, errors).at_costs(costs))
    }
}

/// Greatest rise of an energy above what it was before, over the first.
pub(super) fn back(energy: &[f64]) -> f64 {
    let (mut least, mut most) = (energy[0], 0.0_f64);
    for e in energy {
        least = least.min(*e);
        most = most.max((e - least) / energy[0]);
    }
    most
}
