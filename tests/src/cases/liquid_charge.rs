//! `liquid-charge`: a charged drop that swings the slower the more charge it has, and grows beyond Rayleigh's limit.

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::drop::{Series, Sphere, drift, points};
use crate::lab::{Lab, LabError};

/// The case.
pub(super) struct LiquidCharge;

/// Spacings per radius, by level.
const PARTS: [f64; 3] = [5.0, 6.5, 8.0];
const EPS0: f64 = 8.854_187_812_8e-12;
/// Amplitude over the radius that the start gives an uncharged drop.
const AMPLITUDE: f64 = 2e-3;
/// omega^2 of mode 2 without charge, in gamma/(rho R^3).
const BARE: f64 = 8.0;
/// Half of a run over the inverse of the uncharged frequency, and the steps in it.
const HALF: f64 = 2.0;
const STEPS: u32 = 20;

/// Charges over the greatest of a drop at rest.
const METHODS: [(&str, f64); 3] = [("q-0.7", 0.7), ("q-0.95", 0.95), ("q-1.05", 1.05)];

impl Case for LiquidCharge {
    fn name(&self) -> &'static str {
        "liquid-charge"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Rayleigh (1882): omega^2 = 8 gamma/(rho R^3) (1 - Q^2/Q_R^2), Q_R^2 = 64 pi^2 eps0 gamma R^3"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["q-0.7", "q-0.95", "q-1.05"]
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = vec![Target::error("volume", 1e-6)];
        for (method, _) in METHODS {
            targets.push(Target::error("limit", 3e-2).of(method));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let parts = PARTS[level.clamp(1, 3) as usize - 1];
        let sphere = Sphere::planned(lab, self.name())?;
        let (radius, time) = (sphere.radius, sphere.time());
        let found = METHODS.iter().find(|m| m.0 == method);
        let (_, share) = found.copied().unwrap_or(METHODS[0]);
        let limit = 8.0 * PI * (EPS0 * sphere.tension * radius.powi(3)).sqrt();
        let frequency = BARE.sqrt() / time;
        // u = A grad (r^2 P_2), so that u_n = 2 A R P_2 is the speed of the amplitude.
        let a = 0.5 * AMPLITUDE * frequency;
        let along = ["-x", "-y", "2*z"].map(|e| json!({"expr": format!("{a:e}*({e})")}));
        let end = 2.0 * HALF / frequency;
        let patch = json!({
            "points": {"spacing_m": radius / parts},
            "liquid": {
                "velocity_m_s": along,
                "electric": {"charge_c": share * limit},
                "march": {"end_s": end, "step_s": end / f64::from(2 * STEPS)}
            }
        });
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        // Of sin(omega t) and sinh(sigma t) the value after the whole time is that after the half, times 2 cos(omega t/2) or
        // 2 cosh(sigma t/2).
        let mode = Series::read(&run, "mode_2")?.value;
        let last = mode.len() - 1;
        let ratio = 0.5 * mode[last] / mode[last / 2];
        let square = if ratio < 1.0 {
            ratio.acos().powi(2)
        } else {
            -ratio.acosh().powi(2)
        };
        // The charge that omega^2 would let be the greatest, over Rayleigh's.
        let greatest = share / (1.0 - square / (HALF * HALF)).sqrt();
        let errors = Errors::from([
            ("limit".to_owned(), (greatest - 1.0).abs()),
            ("volume".to_owned(), drift(&run)?),
        ]);
        let count = points(&run)?;
        Ok(Measurement::of(run, count, radius / parts, errors))
    }
}
