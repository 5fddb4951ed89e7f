//! `em-transient-gauge`: charges that turn one electric field into another while a field rises.

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::axes::Axes;
use crate::em::frames::{Level, Points, measured, number};
use crate::em::switched::Switched;
use crate::heat::frames::greater;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmTransientGauge;

/// Switched on at once; levels halve the step.
const ON: &str = "switched-on";
/// Rising as `1 - exp(-t/s)`; levels halve the step.
const RISING: &str = "rising";
/// Rising, by points: steps are so short that they hardly matter.
const POINTS: &str = "rising-by-points";

impl Case for EmTransientGauge {
    fn name(&self) -> &'static str {
        "em-transient-gauge"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Series of modes of free decay, after Landau and Lifshitz (1960), section 45"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[ON, RISING, POINTS]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("current_linf", 2.5e-2),
            Target::error("flux_linf", 5e-3),
            Target::order("current_linf", 1.8),
            Target::error("current_linf", 1e-2).of(RISING),
            Target::error("voltage_linf", 2e-2).of(RISING),
            Target::order("current_linf", 1.8).of(RISING),
            Target::order("voltage_linf", 1.8).of(RISING),
            Target::error("flux_linf", 5e-3).of(POINTS),
            Target::error("potential_linf", 3e-3).of(POINTS),
            Target::order("flux_linf", 2.5).of(POINTS),
            Target::order("potential_linf", 2.5).of(POINTS),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let of_level = |all: [f64; 3]| all[level.clamp(1, 3) as usize - 1];
        let rise = (method != ON).then_some(8e-6);
        let (spacing, steps) = match method {
            POINTS => (of_level([8e-4, 5.6e-4, 4.4e-4]), 8.0),
            _ => (5.6e-4, of_level([2.0, 4.0, 8.0])),
        };
        let end = 1.6e-5;
        let step = end / steps;
        let wave = rise.map(|s| json!({"expr": format!("1 - exp(-t / {s})")}));
        let patch = json!({
            "points": {"spacing_m": spacing, "layers": {"first_m": 0.3 * spacing}},
            "eddy_currents": {"transient": {"end_s": end, "step_s": step, "wave": wave}}
        });
        // Where the order is that in time, the step takes the place of the spacing.
        let size = if method == POINTS { spacing } else { step };
        let errors = |run: &Finished, points: &Points| errors(run, points, rise);
        measured(
            lab,
            self,
            Level {
                level,
                method,
                spacing: size,
            },
            &patch,
            errors,
        )
    }
}

fn errors(run: &Finished, points: &Points, rise: Option<f64>) -> Result<Errors, LabError> {
    let (flux, axes) = Axes::of_applied(run)?;
    let points = points.seen_from(axes);
    // The sheets have A = B (x + aside) along y.
    let aside = axes.components(axes.origin)[0];
    let exact = Switched {
        radius: number(run, "/bodies/0/shape/sphere/radius_m")?,
        conductivity: number(run, "/bodies/0/conductivity_s_m")?,
        flux,
        rise,
    };
    let time = points.time;
    let [wave, rate] = exact.wave(time);
    let voltage = points.frame.f64("electric_potential")?;
    let current = points.vectors("current_density")?;
    let potential = points.vectors("vector_potential")?;
    let flux = points.vectors("magnetic_flux_density")?;
    let [mut most, mut off, mut far, mut turned, mut bent] = [0.0; 5];
    for (i, p) in points.position.iter().enumerate() {
        let rho = p[0].hypot(p[1]);
        let share = |k: usize| if rho > 0.0 { p[k] / rho } else { 0.0 };
        let around = |size: f64| [-size * share(1), size * share(0), 0.0];
        // That is A of the solenoid and the gradient of B (x/2 + aside) y.
        let gauge = [p[1], p[0] + 2.0 * aside, 0.0].map(|x| 0.5 * exact.flux * wave * x);
        let a = around(exact.potential(rho, p[2], time));
        let wanted = [0, 1, 2].map(|k| a[k] + gauge[k]);
        far = greater(far, distance(potential[i], wanted));
        let [away, along] = exact.field(rho, p[2], time);
        let b = [away * share(0), away * share(1), along];
        bent = greater(bent, distance(flux[i], b));
        if rho.hypot(p[2]) > exact.radius * (1.0 + 1e-9) {
            continue;
        }
        let j = around(exact.current(rho, p[2], time));
        most = greater(most, distance(j, [0.0; 3]));
        off = greater(off, distance(current[i], j));
        let v = -exact.flux * rate * (0.5 * p[0] + aside) * p[1];
        turned = greater(turned, (voltage[i] - v).abs());
    }
    let scale = exact.flux.abs() * exact.radius;
    let mut errors = Errors::from([
        ("current_linf".to_owned(), off / most),
        ("potential_linf".to_owned(), far / scale),
        ("flux_linf".to_owned(), bent / exact.flux.abs()),
    ]);
    if rise.is_some() {
        let largest = exact.flux * exact.radius * (0.25 * exact.radius + aside.abs()) * rate.abs();
        errors.insert("voltage_linf".to_owned(), turned / largest);
    }
    Ok(errors)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}
