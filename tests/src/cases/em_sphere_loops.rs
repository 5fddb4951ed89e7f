//! `em-sphere-loops`: lift and heat of a sphere among coaxial loops.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::coaxial::{self, Coaxial};
use crate::em::frames::{Level, Points, measured, totals};
use crate::em::sphere::{Body, Solution};
use crate::heat::frames::greater;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmSphereLoops;

/// Frequencies, and layers beside the surface over those at 100 kHz.
const METHODS: &[&str] = &["100-khz", "30-khz", "1-mhz"];

impl Case for EmSphereLoops {
    fn name(&self) -> &'static str {
        "em-sphere-loops"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Spherical harmonics and Bessel functions, Smythe (1950), chapter XI"
    }

    fn methods(&self) -> &'static [&'static str] {
        METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for method in METHODS {
            for (quantity, bound) in [
                ("points", 6e4),
                ("seconds", 12.0),
                ("bytes", 1.5e9),
                ("lift_volume", 1e-2),
                ("lift_maxwell", 1e-2),
                ("lift_coil", 1e-2),
                ("lift_enclosed", 1e-2),
                ("power_volume", 1e-2),
                ("power_poynting", 1e-2),
                ("power_enclosed", 1e-2),
            ] {
                targets.push(Target::error(quantity, bound).of(*method));
            }
        }
        targets.push(Target::error("largest_current", 2e-2));
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = [5.6e-4, 4e-4, 2.8e-4][level.clamp(1, 3) as usize - 1];
        let (frequency, first) = match method {
            "30-khz" => (3e4, 0.3),
            "1-mhz" => (1e6, 0.15),
            _ => (1e5, 0.3),
        };
        let patch = json!({
            "points": {"spacing_m": spacing, "layers": {"first_m": first * spacing}},
            "eddy_currents": {"harmonic": {"frequency_hz": frequency}},
            "output": {"enclosures": [{"name": "around", "spacing_m": 2.0 * spacing,
                "surface": {"around": {"body": "drop", "distance_m": 7e-4}}}]}
        });
        let found = measured(
            lab,
            self,
            Level {
                level,
                method,
                spacing,
            },
            &patch,
            |run, points| errors(run, points, coaxial(&run.scene, run)?),
        )?;
        let run = &found.runs[0];
        let costs = [
            ("points", found.points as f64),
            ("seconds", run.solver_s()?),
            ("bytes", run.peak_memory_bytes().unwrap_or(0) as f64),
        ];
        Ok(found.at_costs(costs))
    }
}

/// Errors of force, heat, currents and flux density.
pub(super) fn errors(run: &Finished, points: &Points, scene: Coaxial) -> Result<Errors, LabError> {
    let points = points.seen_from(scene.axes());
    let radius = scene.body.radius;
    let exact = Solution::of(scene.body, scene.sources);
    let found = totals(run)?;
    let mut errors = Errors::new();
    for (name, total, wanted) in [
        ("lift_volume", "force_volume_z", exact.lift()),
        ("lift_maxwell", "force_maxwell_z", exact.lift()),
        ("lift_coil", "force_coil_z", exact.lift()),
        ("lift_enclosed", "around.force_z", exact.lift()),
        ("power_volume", "power_volume", exact.power()),
        ("power_poynting", "power_poynting", exact.power()),
        ("power_enclosed", "around.power", exact.power()),
    ] {
        let error = (found.get(total)? / wanted - 1.0).abs();
        errors.insert(name.to_owned(), error);
    }
    let current = points.phasors("current_density")?;
    let size = |j: &[crate::em::C; 3]| j.iter().map(|c| c.norm_sqr()).sum::<f64>().sqrt();
    // Coils of points have a current too.
    let inside = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>().sqrt() < 1.01 * radius;
    let own = points
        .position
        .iter()
        .zip(&current)
        .filter(|(p, _)| inside(p));
    let largest = own.map(|(_, j)| size(j)).fold(0.0, f64::max);
    let (wanted, _) = exact.largest_current();
    errors.insert("largest_current".to_owned(), (largest / wanted - 1.0).abs());
    // Within 1.2 radii: no loop is nearer.
    let scale = exact.flux(0.0, -radius)[1].norm();
    let flux = flux_error(&points, &exact, 1.2 * radius)? / scale;
    errors.insert("flux_linf".to_owned(), flux);
    Ok(errors)
}

/// Largest error of the flux density within a radius \[T\].
pub(super) fn flux_error(points: &Points, exact: &Solution, within: f64) -> Result<f64, LabError> {
    let found = points.phasors("magnetic_flux_density")?;
    let mut worst = 0.0;
    for (p, b) in points.position.iter().zip(&found) {
        let rho = p[0].hypot(p[1]);
        if rho.hypot(p[2]) > within {
            continue;
        }
        // On the surface from within.
        let on = (rho.hypot(p[2]) / exact.radius() - 1.0).abs() < 1e-9;
        let inward = if on { 1.0 - 1e-9 } else { 1.0 };
        let [away, along] = exact.flux(rho * inward, p[2] * inward);
        let share = |k: usize| if rho > 0.0 { p[k] / rho } else { 0.0 };
        let wanted = [away * share(0), away * share(1), along];
        let far = (0..3).map(|k| (b[k] - wanted[k]).norm_sqr()).sum::<f64>();
        worst = greater(worst, far.sqrt());
    }
    Ok(worst)
}

/// The sphere of a scene.
pub(super) fn body(run: &Finished) -> Result<Body, LabError> {
    coaxial::body(&run.scene).map_err(|what| unknown(run, what))
}

/// The sphere and the loops of a scene, whatever became of them in a run.
pub(super) fn coaxial(scene: &Value, run: &Finished) -> Result<Coaxial, LabError> {
    Coaxial::of(scene).map_err(|what| unknown(run, what))
}

fn unknown(run: &Finished, what: String) -> LabError {
    LabError::Content {
        path: run.artefact.clone(),
        what,
    }
}
