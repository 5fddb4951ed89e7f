//! A conducting sphere among coaxial loops, as a scene in space or about an axis tells it.

use serde_json::Value;

use super::axes::Axes;
use super::sphere::{Body, Loop, Sources};

/// The sphere and what surrounds it.
#[derive(Debug, Clone)]
pub struct Coaxial {
    /// The sphere.
    pub body: Body,
    /// Height of its centre \[m\].
    pub height: f64,
    /// Loops, and a uniform field along the axis.
    pub sources: Sources,
}

impl Coaxial {
    /// What a scene tells.
    ///
    /// # Errors
    /// When its first body is no sphere on the axis, or something else than coaxial loops in phase and a field along the
    /// axis surrounds it.
    pub fn of(scene: &Value) -> Result<Self, String> {
        let height = on_axis(&ball(scene)?["centre_m"]).ok_or("the sphere is not on the axis z")?;
        let mut sources = Sources::default();
        let coils = scene.pointer("/eddy_currents/coils");
        for coil in coils.and_then(Value::as_array).into_iter().flatten() {
            let own = coil.get("loop").ok_or("known are loops alone")?;
            let phase = own["phase_deg"].as_f64().unwrap_or(0.0);
            if own.get("normal").is_some() || phase.abs() > 0.0 {
                return Err("known are coaxial loops in phase".to_owned());
            }
            let level = on_axis(&own["centre_m"]).ok_or("known are loops about z")?;
            let one = Loop {
                radius: number(own, "/radius_m")?,
                height: level - height,
                current: rms(scene)
                    * number(own, "/current_a")?
                    * own["turns"].as_f64().unwrap_or(1.0),
            };
            match own["wire_radius_m"].as_f64().unwrap_or(0.0) {
                0.0 => sources.loops.push(one),
                thick => sources.loops.extend(one.thick(thick)),
            }
        }
        if let Some(field) = scene.pointer("/eddy_currents/applied_flux_density_t") {
            let along = on_axis(field).ok_or("known is a uniform field along z")?;
            sources.uniform = rms(scene) * along;
        }
        Ok(Self {
            body: body(scene)?,
            height,
            sources,
        })
    }

    /// Those in which the centre of the sphere is the origin.
    #[must_use]
    pub fn axes(&self) -> Axes {
        Axes {
            origin: [0.0, 0.0, self.height],
            ..Axes::default()
        }
    }

    /// Distance of the nearest wire from the centre of the sphere \[m\]: its solution holds within.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let far = self.sources.loops.iter();
        far.map(|l| l.radius.hypot(l.height))
            .fold(f64::INFINITY, f64::min)
    }
}

/// The conducting sphere of a scene, its first body.
///
/// # Errors
/// When it is none.
pub fn body(scene: &Value) -> Result<Body, String> {
    Ok(Body {
        radius: number(ball(scene)?, "/radius_m")?,
        conductivity: number(scene, "/bodies/0/conductivity_s_m")?,
        permeability: scene
            .pointer("/bodies/0/relative_permeability")
            .and_then(Value::as_f64)
            .unwrap_or(1.0),
        frequency: number(scene, "/eddy_currents/harmonic/frequency_hz")?,
    })
}

/// The sphere in space, or the disc that stands for it about an axis.
fn ball(scene: &Value) -> Result<&Value, String> {
    let shape = &scene["bodies"][0]["shape"];
    let ball = shape.get("sphere").or_else(|| shape.get("disc"));
    ball.ok_or_else(|| "the first body of the scene is no sphere".to_owned())
}

/// The last of two or three numbers, the others of which are zero.
fn on_axis(vector: &Value) -> Option<f64> {
    let parts: Option<Vec<f64>> = vector.as_array()?.iter().map(Value::as_f64).collect();
    let parts = parts?;
    let (last, across) = parts.split_last()?;
    across.iter().all(|x| x.abs() <= 0.0).then_some(*last)
}

/// What makes an rms value of an amplitude of the scene.
fn rms(scene: &Value) -> f64 {
    let amplitude = scene.pointer("/eddy_currents/amplitude");
    if amplitude.and_then(Value::as_str) == Some("peak") {
        std::f64::consts::FRAC_1_SQRT_2
    } else {
        1.0
    }
}

fn number(scene: &Value, pointer: &str) -> Result<f64, String> {
    let found = scene.pointer(pointer).and_then(Value::as_f64);
    found.ok_or_else(|| format!("the scene has no number at {pointer}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn scene() -> Value {
        json!({
            "bodies": [{"shape": {"sphere": {"centre_m": [0, 0, 2], "radius_m": 1}}, "conductivity_s_m": 5}],
            "eddy_currents": {
                "harmonic": {"frequency_hz": 7},
                "applied_flux_density_t": [0, 0, 0.5],
                "coils": [{"loop": {"centre_m": [0, 0, -1], "radius_m": 4, "current_a": 3, "turns": 2}}]
            }
        })
    }

    #[test]
    fn heights_are_counted_from_the_sphere() {
        let found = Coaxial::of(&scene()).unwrap();
        let coil = found.sources.loops[0];
        for (value, wanted) in [
            (found.height, 2.0),
            (coil.height, -3.0),
            (coil.current, 6.0),
            (found.sources.uniform, 0.5),
            (found.reach(), 5.0),
            (found.axes().place([1.0, 0.0, 2.5])[2], 0.5),
            (found.body.radius, 1.0),
        ] {
            assert!((value - wanted).abs() < 1e-15);
        }
        let mut flat = scene();
        flat["bodies"][0]["shape"] = json!({"disc": {"centre_m": [0, 2], "radius_m": 1}});
        flat["eddy_currents"]["coils"][0]["loop"]["centre_m"] = json!([0, -1]);
        flat["eddy_currents"]["applied_flux_density_t"] = json!([0, 0.5]);
        flat["eddy_currents"]["amplitude"] = json!("peak");
        let flat = Coaxial::of(&flat).unwrap();
        assert!((flat.sources.loops[0].height + 3.0).abs() < 1e-15);
        assert!((flat.sources.loops[0].current - 18.0_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn what_is_not_coaxial_is_refused() {
        for (pointer, value) in [
            ("/bodies/0/shape/sphere/centre_m/0", json!(0.1)),
            ("/eddy_currents/coils/0/loop/centre_m/1", json!(0.1)),
            ("/eddy_currents/applied_flux_density_t/0", json!(0.1)),
            ("/eddy_currents/coils/0", json!({"region": {}})),
        ] {
            let mut other = scene();
            *other.pointer_mut(pointer).unwrap() = value;
            assert!(Coaxial::of(&other).is_err(), "{pointer}");
        }
    }
}
