//! Faults that need the body and its points: places outside of it, and mixtures that are more or less than whole.

use run::Fault;
use run::property::{Arguments, Curve};

use crate::cloud::Cloud;
use crate::material::{Materials, PLACE};
use crate::scene::{Material, Scene};
use shapes::Body;

/// Part of the spacing by which a monitor may lie outside of the body, as coordinates are rounded.
const OUTSIDE: f64 = 1e-3;
/// By how much fractions may miss 0, 1 or their sum, as they are rounded.
const WHOLE: f64 = 2e-3;

/// Monitors outside of the body.
pub(super) fn monitors(scene: &Scene, body: &Body) -> Result<(), Vec<Fault>> {
    let monitors = scene.output.monitors.iter().enumerate();
    let faults = monitors.filter_map(|(number, monitor)| {
        let x = std::array::from_fn(|k| monitor.place_m.get(k).copied().unwrap_or(0.0));
        let away = body.distance(x);
        (away > OUTSIDE * scene.points.spacing_m).then(|| {
            let what = format!(
                "({}, {}, {}) m is outside of the body, {away:.4e} m or more away from it: there is no temperature",
                x[0], x[1], x[2]
            );
            Fault::at(&format!("/output/monitors/{number}/place_m"), what)
        })
    });
    none(faults.collect())
}

/// Whether there are no faults.
fn none(faults: Vec<Fault>) -> Result<(), Vec<Fault>> {
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults)
    }
}

/// Mixtures whose fractions are not from 0 to 1, or do not add up to 1, at a point of the material.
pub(super) fn mixtures(
    scene: &Scene,
    materials: &Materials,
    cloud: &Cloud,
) -> Result<(), Vec<Fault>> {
    let each = scene.materials.iter().enumerate();
    let faults = each.filter_map(|(number, material)| {
        let at = format!("/materials/{number}/mixture");
        let fractions = fractions(material, &at)?;
        if fractions.iter().all(|curve| curve.constant().is_some()) {
            return off(&fractions, [0.0; 3], &at);
        }
        let mut own = cloud.position.iter();
        own.find_map(|x| (materials.at(*x) == number).then(|| off(&fractions, *x, &at))?)
    });
    none(faults.collect())
}

/// The fractions of a mixture.
fn fractions(material: &Material, at: &str) -> Option<Vec<Curve>> {
    let constituents = material.mixture.as_ref()?.iter().enumerate();
    let compiled = constituents.map(|(number, constituent)| {
        let at = format!("{at}/{number}/fraction");
        constituent.fraction.compile(&at, &PLACE).ok()
    });
    compiled.collect()
}

/// What is wrong with fractions at a place.
fn off(fractions: &[Curve], x: [f64; 3], at: &str) -> Option<Fault> {
    let value = |curve: &Curve| curve.value(&Arguments::at(x, 0.0)).ok();
    let values: Vec<f64> = fractions.iter().map(value).collect::<Option<_>>()?;
    let there = match fractions.iter().all(|curve| curve.constant().is_some()) {
        true => String::new(),
        false => format!(" at ({}, {}, {}) m", x[0], x[1], x[2]),
    };
    let beyond = |v: &f64| *v < -WHOLE || *v > 1.0 + WHOLE;
    if let Some(number) = values.iter().position(beyond) {
        let what = format!(
            "{}{there} is out of range: from 0 to 1, as a part of a mixture",
            values[number]
        );
        return Some(Fault::at(&format!("{at}/{number}/fraction"), what));
    }
    let sum: f64 = values.iter().sum();
    ((sum - 1.0).abs() > WHOLE).then(|| {
        let what = format!(
            "the fractions add up to {sum}{there}, not to 1: change one, or name the constituent that is missing"
        );
        Fault::at(at, what)
    })
}
