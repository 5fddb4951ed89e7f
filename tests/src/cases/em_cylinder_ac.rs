//! `em-cylinder-ac`: a conducting cylinder in an axial alternating field.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::em::cylinder::Cylinder;
use crate::em::frames::{Points, flux_along, number, number_or};
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
        &["quartic", "quadratic", "quartic-400-hz"]
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = vec![
            Target::error("points", 1645.0).at_level(2),
            Target::error("field_local", 5e-3).at_level(2),
            Target::order("field_linf", 1.0).of("quadratic"),
            Target::order("field_linf", 3.0),
        ];
        for method in ["quartic", "quartic-400-hz"] {
            targets.push(Target::error("field_linf", 5e-3).at_level(2).of(method));
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
        ] {
            if method.contains(word) {
                patch = over(patch, &more);
            }
        }
        let label = format!("level{level}-{method}");
        let run = lab.run(self.tool(), self.name(), &label, &patch)?;
        let exact = exact(&run)?;
        let points = Points::read(&run)?;
        let real = points.frame.f64("magnetic_field_real")?;
        let imaginary = points.frame.f64("magnetic_field_imag")?;
        let [mut linf, mut local] = [0.0; 2];
        for (i, p) in points.position.iter().enumerate() {
            let wanted = exact.magnetic(p[0].hypot(p[1]).min(exact.radius));
            let far = (C::new(real[i], imaginary[i]) - wanted).norm();
            linf = greater(linf, far / exact.field.abs());
            local = greater(local, far / wanted.norm());
        }
        let errors = Errors::from([
            ("field_linf".to_owned(), linf),
            ("field_local".to_owned(), local),
            ("points".to_owned(), points.count() as f64),
        ]);
        Ok(Measurement::of(run, points.count(), spacing, errors))
    }
}

fn exact(run: &Finished) -> Result<Cylinder, LabError> {
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
