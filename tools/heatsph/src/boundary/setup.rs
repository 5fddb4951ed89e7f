//! From the scene's entries to conditions and where they hold.

use run::Fault;
use run::property::{Curve, Property};

use super::part::Extent;
use super::{Condition, Entry, Flux, Surface};
use crate::cloud::Cloud;
use crate::scene::{Boundary, Scene};
use shapes::Body;

/// What a property of the surface may depend on.
const NAMES: [&str; 5] = ["x", "y", "z", "r", "t"];

/// The surface of a cloud under the conditions of a scene.
///
/// # Errors
/// Faults of the scene: faces that there are not, more or less than one condition in an entry, a temperature
/// beside another condition.
pub fn surface(scene: &Scene, cloud: &Cloud) -> Result<Surface, Vec<Fault>> {
    let (mut faults, mut entries) = (Vec::new(), Vec::new());
    for (number, entry) in scene.boundaries.iter().enumerate() {
        let at = format!("/boundaries/{number}");
        let (condition, extent) = (condition(entry, &at), extent(entry, &at, cloud));
        match (condition, extent) {
            (Ok(condition), Ok(extent)) => entries.push(Entry {
                name: unlike(entry, &entries),
                condition,
                extent,
            }),
            (condition, extent) => {
                faults.extend(condition.err().into_iter().chain(extent.err()).flatten());
            }
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let end = scene.time.as_ref().map_or(0.0, |time| time.end_s);
    Surface::new(entries, cloud, end)
}

/// The name of an entry, or else its faces; a second one on them has a number.
fn unlike(entry: &Boundary, known: &[Entry]) -> String {
    let faces = || entry.on.join(" ");
    let name = entry.name.clone().unwrap_or_else(faces);
    let numbered = (2..).map(|n| format!("{name} {n}"));
    let mut names = std::iter::once(name.clone()).chain(numbered);
    let free = names.find(|name| known.iter().all(|entry| entry.name != *name));
    free.unwrap_or(name)
}

/// Where an entry holds.
fn extent(entry: &Boundary, at: &str, cloud: &Cloud) -> Result<Extent, Vec<Fault>> {
    let mut faults = Vec::new();
    let mut faces = Vec::new();
    for (place, face) in entry.on.iter().enumerate() {
        match cloud.faces.iter().position(|known| known == face) {
            Some(found) => faces.push(found as u32),
            None => faults.push(Fault::at(
                &format!("{at}/on/{place}"),
                format!(
                    "the body has no face \"{face}\"; it has {}",
                    cloud.faces.join(", ")
                ),
            )),
        }
    }
    let within = entry.within.as_ref();
    let within = within.map(|shape| Body::new(shape, cloud.dimensions));
    if faults.is_empty() {
        Ok(Extent { faces, within })
    } else {
        Err(faults)
    }
}

/// The one condition of an entry.
fn condition(entry: &Boundary, at: &str) -> Result<Condition, Vec<Fault>> {
    let given = [
        entry.temperature_k.is_some(),
        entry.heat_flux_w_m2.is_some(),
        entry.convection.is_some(),
        entry.radiation.is_some(),
    ];
    if given.iter().filter(|g| **g).count() != 1 {
        let what = "exactly one of \"temperature_k\", \"heat_flux_w_m2\", \"convection\" and \"radiation\" \
                    is wanted; several fluxes on one face are several entries";
        return Err(vec![Fault::at(at, what)]);
    }
    let curve = |property: &Property, key: &str| -> Result<Curve, Vec<Fault>> {
        property
            .compile(&format!("{at}/{key}"), &NAMES)
            .map_err(|fault| vec![fault])
    };
    let kelvin = |property: &Property, key: &str| -> Result<Curve, Vec<Fault>> {
        property
            .compile_temperature(&format!("{at}/{key}"), &NAMES)
            .map_err(|fault| vec![fault])
    };
    if let Some(property) = &entry.temperature_k {
        return Ok(Condition::Temperature(kelvin(property, "temperature_k")?));
    }
    if let Some(property) = &entry.heat_flux_w_m2 {
        return Ok(Condition::Flux(Flux::new(curve(
            property,
            "heat_flux_w_m2",
        )?)));
    }
    if let Some(robin) = &entry.convection {
        let coefficient = curve(&robin.coefficient_w_m2_k, "convection/coefficient_w_m2_k")?;
        positive(
            &coefficient,
            &format!("{at}/convection/coefficient_w_m2_k"),
            "W/(m2 K)",
            f64::INFINITY,
        )?;
        let ambient = kelvin(&robin.ambient_k, "convection/ambient_k")?;
        return Ok(Condition::Convection(coefficient, ambient));
    }
    let Some(radiation) = &entry.radiation else {
        unreachable!("one of the four is given");
    };
    let emissivity = curve(&radiation.emissivity, "radiation/emissivity")?;
    positive(&emissivity, &format!("{at}/radiation/emissivity"), "", 1.0)?;
    let surroundings = kelvin(&radiation.surroundings_k, "radiation/surroundings_k")?;
    Ok(Condition::Radiation(emissivity, surroundings))
}

/// Refuses a number below zero or above `most`.
fn positive(curve: &Curve, at: &str, unit: &str, most: f64) -> Result<(), Vec<Fault>> {
    match curve.constant() {
        Some(value) if value < 0.0 || value > most => {
            let range = if most.is_finite() {
                format!("from 0 to {most}")
            } else {
                "at least 0".to_owned()
            };
            let what = format!("{value} {unit} is out of range: {range} {unit}");
            Err(vec![Fault::at(at, what)])
        }
        _ => Ok(()),
    }
}
