//! `em-planar-az`: a conducting cylinder in an alternating field across it, by the potential along it.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::C;
use crate::em::frames::{Level, Points, measured, number, totals};
use crate::em::transverse::Transverse;
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError, read_json};

/// The case.
pub(super) struct EmPlanarAz;

impl Case for EmPlanarAz {
    fn name(&self) -> &'static str {
        "em-planar-az"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Modified Bessel functions, Smythe (1950), chapter XI"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[
            "quartic",
            "quadratic",
            "quartic-aside",
            "quartic-iron",
            "iron",
        ]
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for quantity in [
            "potential_linf",
            "flux_linf",
            "current_linf",
            "power_volume",
            "power_poynting",
        ] {
            targets.push(Target::error(quantity, 5e-3));
            targets.push(Target::error(quantity, 2e-3).of("quartic-iron"));
        }
        for quantity in ["flux_linf", "current_linf", "power_volume"] {
            targets.push(Target::error(quantity, 5e-3).of("quartic-aside"));
        }
        for quantity in ["flux_linf", "potential_linf"] {
            for series in ["quartic", "quartic-iron"] {
                targets.push(Target::order(quantity, 2.7).of(series));
            }
            for series in ["quadratic", "iron"] {
                targets.push(Target::order(quantity, 1.0).of(series));
            }
        }
        for quantity in ["power_volume", "power_poynting"] {
            targets.push(Target::error(quantity, 5e-3).of("iron"));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = [0.001, 0.0007, 0.0005][level.clamp(1, 3) as usize - 1];
        let order = if method.starts_with("quartic") { 4 } else { 2 };
        let layers = json!({"first_m": 0.5 * spacing});
        let mut patch = json!({
            "points": {"spacing_m": spacing, "layers": layers},
            "method": {"order": order}
        });
        if method.ends_with("iron") {
            let mut bodies = scene(lab)?["bodies"].clone();
            bodies[0]["relative_permeability"] = json!(100.0);
            patch = over(
                patch,
                &json!({"bodies": bodies, "eddy_currents": {"harmonic": {"frequency_hz": 20}}}),
            );
        }
        if method == "quartic-aside" {
            patch = over(patch, &aside(lab)?);
        }
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

fn scene(lab: &Lab) -> Result<Value, LabError> {
    let folder = lab.root.join("pipelines/verify/em-planar-az");
    read_json(&folder.join("scene.json"))
}

/// Everything moved off the origin.
fn aside(lab: &Lab) -> Result<Value, LabError> {
    let mut bodies = scene(lab)?["bodies"].clone();
    bodies[0]["shape"]["disc"]["centre_m"] = json!([0.05, 0.03]);
    Ok(json!({"bodies": bodies, "domain": {"sphere": {"centre_m": [0.05, 0.03]}}}))
}

fn errors(run: &Finished, points: &Points) -> Result<Errors, LabError> {
    let at = |k: u32| number(run, &format!("/eddy_currents/applied_flux_density_t/{k}"));
    let [bx, by] = [at(0)?, at(1)?];
    let exact = Transverse {
        radius: number(run, "/bodies/0/shape/disc/radius_m")?,
        conductivity: number(run, "/bodies/0/conductivity_s_m")?,
        permeability: number(run, "/bodies/0/relative_permeability").unwrap_or(1.0),
        frequency: number(run, "/eddy_currents/harmonic/frequency_hz")?,
        flux: bx.hypot(by),
    };
    let centre = |k: u32| number(run, &format!("/bodies/0/shape/disc/centre_m/{k}"));
    let [left, low] = [centre(0)?, centre(1)?];
    // The field acts along y of the exact solution.
    let [s, c] = [bx / exact.flux, by / exact.flux];
    let potential = points.phasors("vector_potential")?;
    let flux = points.phasors("magnetic_flux_density")?;
    let current = points.phasors("current_density")?;
    let [mut a, mut b, mut j, mut most] = [0.0; 4];
    for (i, p) in points.position.iter().enumerate() {
        let (across, up) = (p[0] - left, p[1] - low);
        let (x, y) = (c * across - s * up, s * across + c * up);
        let far = (potential[i][2] - exact.potential(x, y)).norm();
        a = greater(a, far / (exact.flux * exact.radius));
        // On the surface from within.
        let r = x.hypot(y);
        let on = (r - exact.radius).abs() < 1e-9 * exact.radius;
        let inward = if on { 1.0 - 1e-9 } else { 1.0 };
        let [u, v] = exact.field(x * inward, y * inward);
        let wanted: [C; 2] = [u * c + v * s, v * c - u * s];
        let far: f64 = (0..2).map(|k| (flux[i][k] - wanted[k]).norm_sqr()).sum();
        b = greater(b, far.sqrt() / exact.flux);
        if r <= exact.radius * (1.0 + 1e-9) {
            let wanted = exact.current(x, y);
            j = greater(j, (current[i][2] - wanted).norm());
            most = greater(most, wanted.norm());
        }
    }
    let found = totals(run)?;
    let power = |name: &str| Ok::<_, LabError>((found.get(name)? / exact.power() - 1.0).abs());
    Ok(Errors::from([
        ("potential_linf".to_owned(), a),
        ("flux_linf".to_owned(), b),
        ("current_linf".to_owned(), j / most),
        ("power_volume".to_owned(), power("power_volume")?),
        ("power_poynting".to_owned(), power("power_poynting")?),
    ]))
}
