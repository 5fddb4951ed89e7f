//! `dem-wire` and `dem-cavity`: the drag of a wire that is fed, and the pressure of a cavity on the grains around it.

use std::f64::consts::PI;

use serde_json::json;

use crate::case::{Case, Errors, Measurement, Target};
use crate::grains::{fault, frames};
use crate::lab::{Lab, LabError};
use crate::particles::number;

/// The wire.
pub(super) struct DemWire;

impl Case for DemWire {
    fn name(&self) -> &'static str {
        "dem-wire"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Coulomb: a grain that is pressed on a wire is dragged along with mu k times its overlap"
    }

    fn targets(&self) -> Vec<Target> {
        vec![Target::error("drag", 0.02), Target::error("push", 0.02)]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let steps = 20.0 * f64::from(1 << (level.clamp(1, 5) - 1));
        let patch = json!({"grains": {"steps_per_contact": steps}});
        let run = lab.run("poolsph", self.name(), &format!("level{level}"), &patch)?;
        let at = |key: &str| number(&run, &format!("/grains/{key}"));
        let (r, wire) = (
            at("bodies/0/radius_m")?,
            at("walls/0/shape/cylinder/radius_m")?,
        );
        let overlap = r + wire - at("bodies/0/places_m/0/0")?;
        let push = at("contact/law/linear/stiffness_n_m")? * overlap;
        let drag = at("contact/friction")? * push;
        let down = at("walls/0/surface_m_s/2")?.signum();
        let frames = frames(&run.artefact)?;
        let last = frames.last().ok_or_else(|| fault(&run, "has no frame"))?;
        let force = last.vectors("force")?[0];
        let errors = Errors::from([
            ("push".to_owned(), (force[0] / push - 1.0).abs()),
            ("drag".to_owned(), (down * force[2] / drag - 1.0).abs()),
        ]);
        Ok(Measurement::of(run, steps as u64, 2.0 * r / steps, errors))
    }
}

/// The cavity.
pub(super) struct DemCavity;

impl Case for DemCavity {
    fn name(&self) -> &'static str {
        "dem-cavity"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "pressure times projected area of half an ellipsoid: p pi l_x l_y upwards"
    }

    fn targets(&self) -> Vec<Target> {
        vec![Target::error("lift", 0.02), Target::error("sideways", 0.02)]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let finer = f64::from(1 << (level.clamp(1, 4) - 1));
        let scene = lab.run("poolsph", self.name(), &format!("scene{level}"), &json!({}))?;
        let mut body = scene.scene["grains"]["bodies"][0].clone();
        let r = number(&scene, "/grains/bodies/0/radius_m")? / finer;
        body["radius_m"] = json!(r);
        let patch = json!({"grains": {"bodies": [body]}});
        let run = lab.varied(&scene, &format!("level{level}"), &patch)?;
        let at = |key: &str| number(&run, &format!("/grains/walls/0/{key}"));
        let ellipsoid = |k: usize| at(&format!("shape/intersection/0/ellipsoid/semi_axes_m/{k}"));
        let exact = at("pressure_pa")? * PI * ellipsoid(0)? * ellipsoid(1)?;
        let frames = frames(&run.artefact)?;
        let last = frames.last().ok_or_else(|| fault(&run, "has no frame"))?;
        let force = last.vectors("force")?;
        let sum = |k: usize| force.iter().map(|f| f[k]).sum::<f64>();
        let errors = Errors::from([
            ("lift".to_owned(), (sum(2) / exact - 1.0).abs()),
            ("sideways".to_owned(), sum(0).hypot(sum(1)) / exact),
        ]);
        Ok(Measurement::of(run, force.len() as u64, 2.0 * r, errors))
    }
}
