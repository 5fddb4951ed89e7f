//! From a scene to the alternating field about its liquid.

use run::Failure;

use crate::cloud;
use crate::liquid::air::Place;
use crate::liquid::magnetic::{Applied, Ball, Magnetic, outline};
use crate::liquid::step::{Liquid, Matter};
use crate::liquid::vector::{dot, length};
use crate::magnetic::setup::source;
use crate::scene::{MagneticField, Scene};
use crate::solve::setup::numerics;
use crate::stencils::quadrature::{self, Moments};
use crate::stencils::region::Region;
use crate::stencils::setup::region;
use crate::stencils::sides::Form;

/// The field of a scene on points about a ball as large as the liquid is.
///
/// # Errors
/// Where the liquid has no outline, or the points cannot be made.
pub(crate) fn alternating(
    scene: &Scene,
    given: &MagneticField,
    liquid: &Liquid<3>,
) -> Result<Magnetic, Failure> {
    let skin = Place::of(&liquid.position, &liquid.normal, scene.points.spacing_m).skin;
    let about = outline(skin, liquid.middle())?;
    let (volume, middle) = about.volume();
    let radius = (0.75 * volume / std::f64::consts::PI).cbrt();
    let own = given.about(scene, middle, radius);
    let cloud = cloud::setup::cloud(&own)?;
    let region: Region<3> = region(&own, &cloud, &|_| false);
    let form: Form = numerics(&own).form;
    let cells: Vec<Moments<3>> = cloud.cells.iter().map(Moments::of).collect();
    let failed = |e: wls::Error| Failure::Other(format!("magnetic field: {e}"));
    let weights = quadrature::weights(&region, &cells, &form).map_err(failed)?;
    let Some(currents) = &own.eddy_currents else {
        return Err(Failure::Other("magnetic field: no currents".to_owned()));
    };
    let applied = Applied {
        source: source(&own, currents),
        omega: std::f64::consts::TAU * given.frequency_hz,
        conductivity: given.conductivity_s_m,
    };
    let ball = Ball::new(region, weights, middle, radius, &form).map_err(failed)?;
    Ok(Magnetic::new(applied, ball, form))
}

/// By what currents are multiplied so that the lift is the weight: it grows with their square.
///
/// # Errors
/// Where the field does not lift.
pub(crate) fn hold(magnetic: &Magnetic, matter: &Matter<3>, volume: f64) -> Result<f64, Failure> {
    let gravity = length(&matter.gravity);
    let lift = -dot(&magnetic.force(), &matter.gravity) / gravity;
    let weight = matter.density * volume * gravity;
    if lift > 0.0 {
        Ok((weight / lift).sqrt())
    } else {
        Err(Failure::Other(format!(
            "the field does not lift the liquid: its force against the weight of {weight:.3e} N is {lift:.3e} N"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::super::matter::way;
    use super::super::{filled, start};
    use super::*;
    use crate::liquid::effort::Effort;
    use crate::liquid::vector::along;

    /// A drop above a loop, `stretched` along z.
    fn scene(stretched: f64) -> Scene {
        let (wide, long) = (0.0025 / stretched.sqrt(), 0.0025 * stretched);
        let scene = format!(
            r#"{{"geometry": "space", "points": {{"spacing_m": 5e-4}}, "liquid": {{
                "shape": {{"ellipsoid": {{"centre_m": [0, 0, 1e-4], "semi_axes_m": [{wide}, {wide}, {long}]}}}},
                "density_kg_m3": 7000, "gravity_m_s2": [0, 0, -9.81], "magnetic": {{"conductivity_s_m": 1e7,
                "frequency_hz": 3e4, "coils": [{{"loop": {{"centre_m": [0, 0, -0.005], "radius_m": 0.004,
                "wire_radius_m": 5e-4, "current_a": 200}}}}]}}, "march": {{"end_s": 1}}}}}}"#
        );
        serde_json::from_str(&scene).unwrap()
    }

    /// Volume integral of the force, that of the pull with the magnetic pressure on the surface, and that of all pressure on it.
    fn forces(stretched: f64) -> [[f64; 3]; 3] {
        let scene = scene(stretched);
        let part = scene.liquid.as_ref().unwrap();
        let liquid = start(part, filled(&scene, part).unwrap()).unwrap();
        let mut magnetic = alternating(&scene, part.magnetic.as_ref().unwrap(), &liquid).unwrap();
        let skin = Place::of(&liquid.position, &liquid.normal, 5e-4).skin;
        let about = outline(skin, liquid.middle()).unwrap();
        let stood = magnetic.stand(&about, about.origin);
        let sides = magnetic.fit(&stood).unwrap();
        let (on, inside, areas, volumes) = stood.parts();
        let own = [on.clone(), inside].concat();
        let normals: Vec<[f64; 3]> = areas.iter().map(|(n, _)| *n).collect();
        let at = Place::of(&own, &normals, 5e-4);
        let (way, mut effort) = (way(&scene, part), Effort::default());
        let act = magnetic.act(&stood, &sides, at, way.rule(), &mut effort);
        let act = act.unwrap();
        let (mut split, mut pressed) = ([0.0; 3], [0.0; 3]);
        for (k, (n, area)) in areas.iter().enumerate() {
            split = along(&split, -act.pressure[k] * area, n);
            pressed = along(&pressed, -(act.pressure[k] + act.phi[k]) * area, n);
        }
        for (f, volume) in act.pull.iter().zip(&volumes) {
            split = along(&split, *volume, f);
        }
        assert!(magnetic.out < 2e-2, "{}", magnetic.out);
        [magnetic.totals.force_volume, split, pressed]
    }

    #[test]
    fn pressure_and_pull_together_are_the_force_of_the_currents() {
        for stretched in [1.0, 1.1] {
            let [whole, split, pressed] = forces(stretched);
            assert!(whole[2] > 1e-4);
            for sum in [split, pressed] {
                let lack = (sum[2] / whole[2] - 1.0).abs();
                assert!(lack < 2e-2, "{stretched}: {whole:?} {sum:?}");
                assert!(sum[0].hypot(sum[1]) < 2e-2 * whole[2]);
            }
        }
    }

    #[test]
    fn fits_that_points_take_with_them_give_the_field_of_fits_made_anew() {
        let scene = scene(1.1);
        let part = scene.liquid.as_ref().unwrap();
        let liquid = start(part, filled(&scene, part).unwrap()).unwrap();
        let skin = Place::of(&liquid.position, &liquid.normal, 5e-4).skin;
        let about = outline(skin, liquid.middle()).unwrap();
        let (way, mut effort) = (way(&scene, part), Effort::default());
        let totals = [true, false].map(|carries| {
            let given = part.magnetic.as_ref().unwrap();
            let mut magnetic = alternating(&scene, given, &liquid).unwrap();
            let stood = magnetic.stand(&about, about.origin);
            let fitted = if carries {
                magnetic.fit(&stood)
            } else {
                magnetic.fit_anew(&stood)
            };
            let fitted = fitted.unwrap();
            assert_eq!(fitted.carries() > 1000, carries, "{}", fitted.carries());
            let place = Place::of(&liquid.position, &liquid.normal, 5e-4);
            let act = magnetic.act(&stood, &fitted, place, way.rule(), &mut effort);
            act.unwrap();
            magnetic.totals
        });
        let apart = |of: fn(&crate::magnetic::totals::Totals) -> f64| {
            (of(&totals[0]) / of(&totals[1]) - 1.0).abs()
        };
        assert!(apart(|t| t.force_coil[2]) < 1e-3);
        assert!(apart(|t| t.heat_volume) < 5e-3);
    }
}
