//! From the scene's entries to films on patches of surface.

use run::Fault;
use run::property::{Curve, Property};

use super::part::{Extent, Part, parts, whole};
use super::tangent::tangent;
use super::{Condition, Film, Flux, Held, Surface};
use crate::cloud::{Cloud, Patch};
use crate::scene::{Boundary, Scene};
use shapes::Body;
use shapes::frame::along;

/// What a property of the surface may depend on.
const NAMES: [&str; 5] = ["x", "y", "z", "r", "t"];
/// A point nearer to its surface than this part of the spacing is on it.
const ON: f64 = 1e-6;

/// The surface of a cloud under the conditions of a scene.
///
/// # Errors
/// Faults of the scene: faces that there are not, more or less than one condition in an entry, a temperature
/// beside another condition.
pub fn compile(scene: &Scene, cloud: &Cloud) -> Result<Surface, Vec<Fault>> {
    let mut faults = Vec::new();
    let mut surface = Surface::default();
    let mut extents = Vec::new();
    for (number, entry) in scene.boundaries.iter().enumerate() {
        let at = format!("/boundaries/{number}");
        match condition(entry, &at) {
            Ok(condition) => surface.conditions.push(condition),
            Err(found) => faults.extend(found),
        }
        let name = unlike(entry, &surface.names);
        surface.names.push(name);
        match extent(entry, &at, cloud) {
            Ok(extent) => extents.push(extent),
            Err(found) => faults.extend(found),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    surface.area = vec![0.0; surface.conditions.len()];
    surface.asked.clone_from(&surface.area);
    for patch in &cloud.patches {
        for part in divided(&mut surface, cloud, patch, &extents) {
            if let Err(fault) = cover(&mut surface, cloud, part)
                && !faults.contains(&fault)
            {
                faults.push(fault);
            }
        }
    }
    surface.films.sort_by_key(|film| film.point);
    surround(&mut surface);
    surface.held.sort_by_key(|held| (held.point, held.entry));
    surface.held.dedup_by_key(|held| held.point);
    for (entry, area) in surface.area.iter().enumerate() {
        if *area <= 0.0 && faults.is_empty() {
            let what = "no part of the surface is on these faces and within this shape";
            faults.push(Fault::at(&format!("/boundaries/{entry}"), what));
        }
    }
    faults.extend(surface.look(scene.time.as_ref().map_or(0.0, |time| time.end_s)));
    if faults.is_empty() {
        Ok(surface)
    } else {
        Err(faults)
    }
}

/// The name of an entry, or else its faces; a second one on them has a number.
fn unlike(entry: &Boundary, known: &[String]) -> String {
    let faces = || entry.on.join(" ");
    let name = entry.name.clone().unwrap_or_else(faces);
    let numbered = (2..).map(|n| format!("{name} {n}"));
    let mut names = std::iter::once(name.clone()).chain(numbered);
    let free = names.find(|name| !known.contains(name));
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

/// Whether a patch is the surface of its point, and not some way above it.
fn on(cloud: &Cloud, patch: &Patch) -> bool {
    cloud.depth(patch) < ON * cloud.spacing[patch.point as usize]
}

/// The parts of a patch, and their areas for the entries that ask for them; a point that is held stands for the whole of it.
fn divided(surface: &mut Surface, cloud: &Cloud, patch: &Patch, extents: &[Extent]) -> Vec<Part> {
    let parts = parts(patch, extents, cloud.dimensions);
    for part in &parts {
        for entry in &part.entries {
            surface.asked[*entry as usize] += part.patch.area;
        }
    }
    let of_temperature =
        |e: &u32| matches!(surface.conditions[*e as usize], Condition::Temperature(_));
    let held = parts
        .iter()
        .any(|part| part.entries.iter().any(of_temperature));
    if held && on(cloud, patch) {
        return vec![whole(patch, extents)];
    }
    parts
}

/// Puts the entries of a patch into effect.
fn cover(surface: &mut Surface, cloud: &Cloud, part: Part) -> Result<(), Fault> {
    let Part { patch, entries } = part;
    if entries.is_empty() {
        return Ok(());
    }
    let held = |e: &&u32| matches!(surface.conditions[**e as usize], Condition::Temperature(_));
    let temperature = entries.iter().find(held).copied();
    if let (Some(entry), true) = (temperature, entries.len() > 1) {
        let what = format!(
            "a temperature stands alone, and \"{}\" has another entry on the same face",
            cloud.faces[patch.face as usize]
        );
        return Err(Fault::at(&format!("/boundaries/{entry}"), what));
    }
    for entry in &entries {
        surface.area[*entry as usize] += patch.area;
    }
    let (depth, on) = (cloud.depth(&patch), on(cloud, &patch));
    match temperature {
        Some(entry) if on => surface.held.push(Held {
            point: patch.point,
            entry,
        }),
        _ => surface.films.push(Film {
            point: patch.point,
            depth: if on { 0.0 } else { depth },
            area: patch.area,
            place: patch.place,
            piece: tangent(&patch, cloud.dimensions),
            above: along(cloud.position[patch.point as usize], depth, patch.normal),
            entries,
        }),
    }
    Ok(())
}

/// Tells fluxes that depend on place where their patches are.
fn surround(surface: &mut Surface) {
    for (entry, condition) in surface.conditions.iter_mut().enumerate() {
        let Condition::Flux(flux) = condition else {
            continue;
        };
        let places = ["x", "y", "z", "r"];
        if !places.iter().any(|name| flux.curve.depends_on(name)) {
            continue;
        }
        let own = |film: &&Film| film.entries.contains(&(entry as u32));
        let films = surface.films.iter().filter(own);
        flux.around = films
            .map(|film| film.piece.around())
            .reduce(|[a, b], [c, d]| {
                [
                    std::array::from_fn(|k| a[k].min(c[k])),
                    std::array::from_fn(|k| b[k].max(d[k])),
                ]
            });
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
