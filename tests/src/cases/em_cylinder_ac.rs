//! `em-cylinder-ac`: a conducting cylinder in an axial alternating field.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::cylinder::{Cored, Cylinder};
use crate::em::frames::{Points, flux_along, number, number_or, totals};
use crate::em::{C, MU0};
use crate::heat::frames::greater;
use crate::heat::methods::over;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct EmCylinderAc;

impl Case for EmCylinderAc {
    fn name(&self) -> &'static str {
        "em-cylinder-ac"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "Modified Bessel function, Matsuzawa (2017), eq. 3.12"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[
            "quartic",
            "quadratic",
            "quartic-400-hz",
            "quartic-core",
            "quartic-tube",
        ]
    }

    fn targets(&self) -> Vec<Target> {
        // What the iteration leaves is no error of the points.
        let order = |method| {
            Target::order("field_linf", 3.0)
                .of(method)
                .or_error_below(1e-8)
        };
        let mut targets = vec![Target::error("points", 1645.0).at_level(2)];
        for method in self.methods() {
            targets.push(order(*method));
            targets.push(Target::error("power", 5e-3).at_level(2).of(*method));
            for error in ["field_linf", "field_local"] {
                targets.push(Target::error(error, 5e-3).at_level(2).of(*method));
            }
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = [0.0072, 0.005, 0.0036][level.clamp(1, 3) as usize - 1];
        let layers = json!({"first_m": 0.5 * spacing});
        let mut patch = json!({"points": {"spacing_m": spacing, "wall_layers": layers}});
        for (word, more) in [
            ("quadratic", json!({"method": {"order": 2}})),
            (
                "400",
                json!({"eddy_currents": {"harmonic": {"frequency_hz": 400}}}),
            ),
            ("core", core(spacing, [7.7e6, 7.7e5])),
            ("tube", core(spacing, [0.0, 7.7e6])),
        ] {
            if method.contains(word) {
                patch = over(patch, &more);
            }
        }
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let points = Points::read(&run)?;
        let radii: Vec<f64> = points.position.iter().map(|p| p[0].hypot(p[1])).collect();
        let (wanted, power) = exact(&run, &radii)?;
        let real = points.frame.f64("magnetic_field_real")?;
        let imaginary = points.frame.f64("magnetic_field_imag")?;
        let [mut linf, mut local] = [0.0; 2];
        let applied = cylinder(&run)?.field.abs();
        for (i, wanted) in wanted.iter().enumerate() {
            let far = (C::new(real[i], imaginary[i]) - wanted).norm();
            linf = greater(linf, far / applied);
            local = greater(local, far / wanted.norm());
        }
        let heat = totals(&run)?.get("power_volume")?;
        let errors = Errors::from([
            ("field_linf".to_owned(), linf),
            ("field_local".to_owned(), local),
            ("power".to_owned(), (heat / power - 1.0).abs()),
        ]);
        let count = points.count();
        Ok(Measurement::of(run, count, spacing, errors).at_costs([("points", count as f64)]))
    }
}

/// A core and what is around it, of these conductivities.
fn core(spacing: f64, [core, around]: [f64; 2]) -> Value {
    let disc = json!({"disc": {"centre_m": [0, 0], "radius_m": 0.05}});
    let body = json!({"name": "core", "shape": disc, "conductivity_s_m": core});
    json!({"bodies": [body], "surroundings": {"conductivity_s_m": around},
        "points": {"outward": 0, "layers": {"first_m": 0.5 * spacing}}})
}

/// Field at each of the radii, and the heat.
fn exact(run: &Finished, radii: &[f64]) -> Result<(Vec<C>, f64), LabError> {
    let cylinder = cylinder(run)?;
    let inside = |r: &f64| r.min(cylinder.radius);
    if run.scene.pointer("/bodies/0").is_none() {
        let field = radii.iter().map(|r| cylinder.magnetic(inside(r))).collect();
        return Ok((field, cylinder.power()));
    }
    // The field of a hole is even.
    let least = 1e-9 * cylinder.conductivity;
    let cored = Cored {
        cylinder,
        radius: number(run, "/bodies/0/shape/disc/radius_m")?,
        conductivity: number_or(run, "/bodies/0/conductivity_s_m", 0.0).max(least),
        permeability: number_or(run, "/bodies/0/relative_permeability", 1.0),
    };
    Ok(cored.solve(&radii.iter().map(inside).collect::<Vec<_>>()))
}

fn cylinder(run: &Finished) -> Result<Cylinder, LabError> {
    let peak = run
        .scene
        .pointer("/eddy_currents/amplitude")
        .and_then(Value::as_str);
    let share = if peak == Some("peak") {
        std::f64::consts::FRAC_1_SQRT_2
    } else {
        1.0
    };
    let flux = flux_along(run)?;
    Ok(Cylinder {
        radius: number(run, "/domain/sphere/radius_m")?,
        conductivity: number(run, "/surroundings/conductivity_s_m")?,
        permeability: number_or(run, "/surroundings/relative_permeability", 1.0),
        frequency: number(run, "/eddy_currents/harmonic/frequency_hz")?,
        field: share * flux / MU0,
    })
}
