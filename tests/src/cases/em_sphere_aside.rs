//! `em-sphere-aside`: a sphere beside a loop, with charges of many degrees.

use serde_json::json;

use super::em_sphere_loops::body;
use crate::case::{Case, Errors, Measurement, Target};
use crate::em::axes::{Axes, vector};
use crate::em::frames::{Level, Points, measured, number, number_or, totals};
use crate::em::sphere::anywhere::{Anywhere, Coil};
use crate::heat::frames::greater;
use crate::heat::property::at;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmSphereAside;

/// Points of the sphere are compared one in so many.
const EACH: usize = 40;

impl Case for EmSphereAside {
    fn name(&self) -> &'static str {
        "em-sphere-aside"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Degrees of the radial field on the sphere, after Smythe (1950), chapter XI"
    }

    fn methods(&self) -> &'static [&'static str] {
        &["quartic", "quadratic"]
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("power_poynting", 1e-2),
            Target::error("power_volume", 1e-2),
            Target::error("force_volume", 1e-2),
            Target::error("force_maxwell", 1e-2),
            Target::error("force_coil", 1e-2),
            Target::error("current_linf", 2e-2),
            Target::order("current_linf", 2.0),
            Target::order("current_linf", 1.5).of("quadratic"),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = [5.6e-4, 4e-4, 2.8e-4][level.clamp(1, 3) as usize - 1];
        let order = if method == "quadratic" { 2 } else { 4 };
        let patch = json!({
            "points": {"spacing_m": spacing, "layers": {"first_m": 0.3 * spacing}},
            "method": {"order": order}
        });
        measured(
            lab,
            self,
            Level {
                level,
                method,
                spacing,
            },
            &patch,
            errors,
        )
    }
}

fn errors(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let ball = body(run)?;
    let centre = vector(run, "/bodies/0/shape/sphere/centre_m")?;
    let points = points.seen_from(Axes {
        origin: centre,
        ..Axes::default()
    });
    let exact = Anywhere::of(ball, coils(run, centre)?);
    let found = totals(run)?;
    let mut errors = Errors::new();
    for name in ["power_volume", "power_poynting"] {
        let error = (found.get(name)? / exact.power() - 1.0).abs();
        errors.insert(name.to_owned(), error);
    }
    let wanted = exact.force();
    let size = wanted.iter().map(|f| f * f).sum::<f64>().sqrt();
    for name in ["force_volume", "force_maxwell", "force_coil"] {
        let mut square = 0.0;
        for (axis, wanted) in ["x", "y", "z"].into_iter().zip(wanted) {
            square += (found.get(&format!("{name}_{axis}"))? - wanted).powi(2);
        }
        errors.insert(name.to_owned(), square.sqrt() / size);
    }
    let current = points.phasors("current_density")?;
    let [mut worst, mut most] = [0.0; 2];
    let inside =
        |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>().sqrt() < ball.radius * (1.0 + 1e-9);
    let each = points
        .position
        .iter()
        .zip(&current)
        .filter(|(p, _)| inside(p));
    for (p, j) in each.step_by(EACH) {
        let wanted = exact.current(*p);
        let apart = (0..3).map(|k| (j[k] - wanted[k]).norm_sqr()).sum::<f64>();
        let size = wanted.iter().map(|j| j.norm_sqr()).sum::<f64>();
        worst = greater(worst, apart.sqrt());
        most = greater(most, size.sqrt());
    }
    errors.insert("current_linf".to_owned(), worst / most);
    Ok(errors)
}

/// The loops of a scene, seen from the centre of its sphere.
fn coils(run: &Finished, centre: [f64; 3]) -> Result<Vec<Coil>, LabError> {
    let all = at(run, "/eddy_currents/coils")?;
    let one = |n: usize| {
        let key = |name: &str| format!("/eddy_currents/coils/{n}/loop/{name}");
        let place = vector(run, &key("centre_m"))?;
        let normal = match run.scene.pointer(&key("normal")) {
            Some(_) => vector(run, &key("normal"))?,
            None => [0.0, 0.0, 1.0],
        };
        let size = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        Ok(Coil {
            centre: [0, 1, 2].map(|k| place[k] - centre[k]),
            axis: normal.map(|x| x / size),
            radius: number(run, &key("radius_m"))?,
            current: number(run, &key("current_a"))? * number_or(run, &key("turns"), 1.0),
        })
    };
    (0..all.as_array().map_or(0, Vec::len)).map(one).collect()
}
