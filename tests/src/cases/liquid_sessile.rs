//! `liquid-sessile`: a drop at rest on a wall, against the outline integrated along its length, and the balance of forces on the wall.

use std::f64::consts::PI;

use serde_json::{Value, json};

use artefact::Reader;

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::frames::planned;
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct LiquidSessile;

/// Contact angle \[deg\] and gravity over that of the scene, by method.
const METHODS: [(&str, f64, f64); 4] = [
    ("60", 60.0, 1.0),
    ("120", 120.0, 1.0),
    ("120-weightless", 120.0, 0.0),
    ("60-hanging", 60.0, -0.3),
];
/// Steps along the outline of the reference over the radius of a ball of the same volume.
const FINE: f64 = 4000.0;

impl Case for LiquidSessile {
    fn name(&self) -> &'static str {
        "liquid-sessile"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Young (1805), Laplace (1806): gamma kappa = c + rho g z, along the length of the outline; Bashforth and Adams (1883)"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["60", "120", "120-weightless", "60-hanging"]
    }

    fn targets(&self) -> Vec<Target> {
        let each = METHODS.iter().flat_map(|(method, ..)| {
            ["height", "radius_base", "volume", "wall"]
                .map(|name| Target::error(name, 1e-4).of(*method))
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let scene = planned(lab, self.name(), &json!({}))?;
        let found = METHODS.iter().find(|m| m.0 == method);
        let (_, degrees, weight) = found.copied().unwrap_or(METHODS[0]);
        let gravity = weight * number(&scene["liquid"]["gravity_m_s2"][2]);
        let patch = json!({"liquid": {
            "equilibrium": {"contact_angle_deg": degrees}, "gravity_m_s2": [0, 0, gravity]
        }});
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let row = reader.record("/liquid")?;
        let liquid = &run.scene["liquid"];
        let radius = number(&liquid["shape"]["sphere"]["radius_m"]);
        let tension = number(&liquid["surface_tension_n_m"]);
        let heavy = -number(&liquid["density_kg_m3"]) * gravity;
        let angle = degrees.to_radians();
        let volume = 4.0 / 3.0 * PI * radius.powi(3);
        let exact = Drop::of(volume, angle, heavy / tension, radius / FINE);
        let (height, base) = (row.get("height")?, row.get("radius_base")?);
        // The outline as it is written: volume, and what the wall bears.
        let table = reader.table("/outline")?;
        let (r, z) = (table.values("r_m")?, table.values("z_m")?);
        let slices = (1..r.len()).map(|k| {
            let mean = (r[k] * r[k] + r[k] * r[k - 1] + r[k - 1] * r[k - 1]) / 3.0;
            PI * mean * (z[k - 1] - z[k])
        });
        let written: f64 = slices.sum();
        let pressed = PI * base * base * (row.get("pressure")? + heavy * height);
        let drawn = 2.0 * PI * base * tension * angle.sin();
        let errors = Errors::from([
            ("height".to_owned(), (height / exact.height - 1.0).abs()),
            ("radius_base".to_owned(), (base / exact.base - 1.0).abs()),
            ("volume".to_owned(), (written / volume - 1.0).abs()),
            (
                "wall".to_owned(),
                ((pressed - drawn - heavy * volume) / drawn).abs(),
            ),
        ]);
        let count = r.len() as u64;
        Ok(Measurement::of(run, count, radius / r.len() as f64, errors))
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// A drop at rest.
#[derive(Debug, Clone, Copy)]
struct Drop {
    volume: f64,
    height: f64,
    base: f64,
}

impl Drop {
    /// The drop of this volume, with the contact angle and rho g/gamma, by steps of `step`.
    fn of(volume: f64, angle: f64, bond: f64, step: f64) -> Self {
        let ball = (0.75 * volume / PI).cbrt();
        let (mut low, mut high) = (0.05 * ball, 50.0 * ball);
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            if Self::topped(middle, angle, bond, step).volume < volume {
                low = middle;
            } else {
                high = middle;
            }
        }
        Self::topped(low, angle, bond, step)
    }

    /// The drop with the radius `top` at its top: dr = cos(phi) ds, dz = sin(phi) ds, dphi = (2/top + bond z - sin(phi)/r) ds.
    fn topped(top: f64, angle: f64, bond: f64, step: f64) -> Self {
        let slopes = |[phi, r, z, _]: [f64; 4]| {
            let round = if r > 0.0 { phi.sin() / r } else { 1.0 / top };
            let dz = phi.sin();
            [2.0 / top + bond * z - round, phi.cos(), dz, PI * r * r * dz]
        };
        let mut at = [0.0; 4];
        loop {
            let next = |slope: [f64; 4], by: f64| std::array::from_fn(|i| at[i] + by * slope[i]);
            let one = slopes(at);
            let two = slopes(next(one, 0.5 * step));
            let three = slopes(next(two, 0.5 * step));
            let four = slopes(next(three, step));
            let mean: [f64; 4] =
                std::array::from_fn(|i| (one[i] + 2.0 * two[i] + 2.0 * three[i] + four[i]) / 6.0);
            // A hanging drop that turns back before it reaches the wall is too large.
            if mean[0] <= 0.0 {
                at[3] = f64::INFINITY;
                break;
            }
            // The last step ends on the wall.
            let by = step.min((angle - at[0]) / mean[0]);
            at = next(mean, by);
            if by < step {
                break;
            }
        }
        let [_, base, height, volume] = at;
        Self {
            volume,
            height,
            base,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_weight_it_is_a_cap() {
        let angle = 2.0_f64;
        let volume = PI / 3.0 * (2.0 + angle.cos()) * (1.0 - angle.cos()).powi(2);
        let drop = Drop::of(volume, angle, 0.0, 1e-3);
        assert!((drop.height - (1.0 - angle.cos())).abs() < 1e-5, "{drop:?}");
        assert!((drop.base - angle.sin()).abs() < 1e-5, "{drop:?}");
    }
}
