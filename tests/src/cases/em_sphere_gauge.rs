//! `em-sphere-gauge`: charges that turn one electric field into another.

use serde_json::json;

use super::em_sphere_loops::{body, flux_error};
use crate::case::{Case, Errors, Measurement, Target};
use crate::em::C;
use crate::em::axes::Axes;
use crate::em::frames::{Level, Points, measured, totals};
use crate::em::sphere::{Solution, Sources};
use crate::heat::frames::greater;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmSphereGauge;

/// At 1 MHz with quadratics; layers get thinner by level, on the same surface.
const THIN: &str = "1-mhz-thin-layers";
/// Quartics at two frequencies, and quadratics at the higher one and above.
const METHODS: &[&str] = &["100-khz", "100-hz", "100-khz-quadratic", THIN];

impl Case for EmSphereGauge {
    fn name(&self) -> &'static str {
        "em-sphere-gauge"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Spherical Bessel functions, Smythe (1950), chapter XI"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("power_poynting", 1e-2),
            Target::error("power_volume", 1e-2),
            Target::error("flux_linf", 1e-2),
            Target::error("current_linf", 1e-2),
            Target::error("potential_linf", 1e-2),
            Target::order("flux_linf", 3.0),
            Target::order("current_linf", 3.0),
            Target::order("current_linf", 1.5).of("100-khz-quadratic"),
            Target::error("power_volume", 1e-3).of("100-hz"),
            Target::error("flux_linf", 1e-3).of("100-hz"),
            Target::error("current_linf", 1e-3).of("100-hz"),
            Target::error("potential_linf", 1e-3).of("100-hz"),
            Target::order("flux_linf", 3.0).of("100-hz"),
            Target::order("current_linf", 3.0).of("100-hz"),
            Target::error("power_volume", 2e-2).of(THIN),
            Target::error("power_poynting", 2e-2).of(THIN),
            Target::error("current_linf", 2e-2).of(THIN),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let of_level = |all: [f64; 3]| all[level.clamp(1, 3) as usize - 1];
        let (spacing, first) = match method {
            THIN => (4e-4, of_level([3e-5, 1e-5, 3e-6])),
            _ => {
                let spacing = of_level([5.6e-4, 4e-4, 2.8e-4]);
                (spacing, 0.3 * spacing)
            }
        };
        let (frequency, order) = match method {
            "100-hz" => (1e2, 4),
            "100-khz-quadratic" => (1e5, 2),
            THIN => (1e6, 2),
            _ => (1e5, 4),
        };
        let patch = json!({
            "points": {"spacing_m": spacing, "layers": {"first_m": first}},
            "eddy_currents": {"harmonic": {"frequency_hz": frequency}},
            "method": {"order": order}
        });
        let size = if method == THIN { first } else { spacing };
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

fn errors(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let (applied, axes) = Axes::of_applied(run)?;
    let points = &points.seen_from(axes);
    let sources = Sources {
        loops: Vec::new(),
        uniform: applied,
    };
    let ball = body(run)?;
    let exact = Solution::of(ball, sources);
    let found = totals(run)?;
    let power = |name: &str| Ok::<_, LabError>((found.get(name)? / exact.power() - 1.0).abs());
    let mut errors = Errors::from([
        ("power_volume".to_owned(), power("power_volume")?),
        ("power_poynting".to_owned(), power("power_poynting")?),
    ]);
    let flux = flux_error(points, &exact, 1.2 * ball.radius)? / applied;
    errors.insert("flux_linf".to_owned(), flux);
    let omega = std::f64::consts::TAU * ball.frequency;
    // The sheets have A = B (x + aside) along y, of which the solenoid has B (-y, x)/2.
    let aside = axes.components(axes.origin)[0];
    let voltage = |p: &[f64; 3]| {
        let far = 0.5 * p[0] + aside;
        C::new(0.0, -omega * applied * far * p[1])
    };
    let [re, im] = ["real", "imag"].map(|part| format!("electric_potential_{part}"));
    let (re, im) = (points.frame.f64(&re)?, points.frame.f64(&im)?);
    let current = points.phasors("current_density")?;
    let [mut worst, mut off] = [0.0; 2];
    for (i, p) in points.position.iter().enumerate() {
        let rho = p[0].hypot(p[1]);
        if rho.hypot(p[2]) > ball.radius * (1.0 + 1e-9) {
            continue;
        }
        worst = greater(worst, (C::new(re[i], im[i]) - voltage(p)).norm());
        let around = exact.current(rho, p[2]);
        let share = |k: usize| if rho > 0.0 { p[k] / rho } else { 0.0 };
        let wanted = [around * -share(1), around * share(0), C::new(0.0, 0.0)];
        let apart = (0..3).map(|k| (current[i][k] - wanted[k]).norm_sqr());
        off = greater(off, apart.sum::<f64>().sqrt());
    }
    let most = omega * applied * ball.radius * (0.25 * ball.radius + aside.abs());
    errors.insert("potential_linf".to_owned(), worst / most);
    errors.insert("current_linf".to_owned(), off / exact.largest_current().0);
    Ok(errors)
}
