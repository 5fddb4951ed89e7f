//! From conditions on faces to films on patches of surface.

use run::Fault;

use super::part::{Extent, Part, parts, whole};
use super::tangent::tangent;
use super::{Condition, Entry, Film, Held, Surface};
use crate::cloud::{Cloud, Patch};
use shapes::frame::along;

/// A point nearer to its surface than this part of the spacing is on it.
const ON: f64 = 1e-6;

impl Surface {
    /// The surface of a cloud under conditions that are looked at until `end` \[s\].
    pub(super) fn new(entries: Vec<Entry>, cloud: &Cloud, end: f64) -> Result<Self, Vec<Fault>> {
        let (mut faults, mut surface, mut extents) = (Vec::new(), Self::default(), Vec::new());
        for entry in entries {
            surface.conditions.push(entry.condition);
            surface.names.push(entry.name);
            extents.push(entry.extent);
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
        faults.extend(surface.look(end));
        if faults.is_empty() {
            Ok(surface)
        } else {
            Err(faults)
        }
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
