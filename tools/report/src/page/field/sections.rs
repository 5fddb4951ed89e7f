//! Fields in planes through the bodies.

use run::Failure;

use super::Run;
use crate::draw::axes::number;
use crate::draw::colour::Map;
use crate::field::Points;
use crate::field::columns::{Part, QUANTITIES, Quantity, prefixed};
use crate::field::plane::{Plane, View};
use crate::field::scene::Geometry;
use crate::html::{figure, picture, side_by_side};
use crate::page::encoding;
use crate::picture::field::{Over, Shown, section as draw, symbol};

/// The section.
pub(super) fn section(run: &Run) -> Result<String, Failure> {
    let points = &run.points;
    let upright = Plane::new(points, View::near(points, 1));
    let mut pictures = Vec::new();
    for quantity in QUANTITIES.iter().filter(|q| !q.conductors) {
        pictures.extend(one(points, &upright, quantity)?);
    }
    if points.columns.values(&QUANTITIES[5]).is_some() {
        let upright = Plane::new(points, View::close(points, 1));
        for quantity in QUANTITIES.iter().filter(|q| q.conductors) {
            pictures.extend(one(points, &upright, quantity)?);
        }
    }
    // Currents about z lie across the upright section: they are seen from above.
    let above = points.scene.geometry == Geometry::Space;
    if above && points.columns.values(&QUANTITIES[5]).is_some() {
        let level = Plane::new(points, View::close(points, 2));
        for quantity in &QUANTITIES[5..7] {
            pictures.extend(one(points, &level, quantity)?);
        }
    }
    Ok(side_by_side(&pictures))
}

fn one(points: &Points, plane: &Plane, quantity: &Quantity) -> Result<Option<String>, Failure> {
    let (map, over) = look(points, quantity);
    let Some(shown) = draw(points, plane, quantity, map, over) else {
        return Ok(None);
    };
    let words = caption(points, plane, quantity, over, &shown);
    let image = picture(&shown.canvas, &words).map_err(|e| encoding(&e))?;
    Ok(Some(figure(&image, &words)))
}

/// Colours of a quantity, and what is drawn over them.
fn look(points: &Points, quantity: &Quantity) -> (Map, Over) {
    let plane = points.scene.geometry == Geometry::Plane;
    match quantity.stem {
        "potential" => (Map::Viridis, Over::Lines),
        "vector_potential" | "magnetic_field" if plane => (Map::Viridis, Over::Lines),
        "vector_potential" | "magnetic_field" => (Map::Viridis, Over::Nothing),
        "joule_heat" => (Map::Inferno, Over::Nothing),
        "current_density" => (Map::Inferno, Over::Arrows(Part::Imaginary)),
        "force_density" => (Map::Inferno, Over::Arrows(Part::Real)),
        _ => (Map::Viridis, Over::Arrows(Part::Real)),
    }
}

fn caption(
    points: &Points,
    plane: &Plane,
    quantity: &Quantity,
    over: Over,
    shown: &Shown,
) -> String {
    let mut letters = quantity.title.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    let mut text = first.unwrap_or_default() + letters.as_str();
    let sized = points.columns.is_size(quantity);
    let alternates = points.scene.alternating;
    // A force and heat are means over a period.
    let mean = matches!(quantity.stem, "force_density" | "joule_heat");
    if sized && alternates && !mean {
        text += &format!(", root mean square |{}|", symbol(quantity));
    } else if alternates && mean {
        text += ", mean over a period";
    }
    if points.time > 0.0 {
        let (unit, factor) = prefixed("s", points.time);
        text += &format!(", after {} {unit}", number(factor * points.time));
    }
    match plane.view.cut {
        Some((axis, at)) => {
            let at = number((1e6 * at).round() * 1e-3);
            text += &format!(", at {} = {at} mm.", ["x", "y", "z"][axis.min(2)]);
        }
        None => text += ".",
    }
    if let Some((step, unit)) = &shown.step {
        text += &format!(" Lines every {} {unit}.", number(*step));
    }
    if shown.arrows {
        text += match over {
            Over::Arrows(Part::Imaginary) if alternates && !mean => {
                " Arrows of one length show the direction while the current of the coils rises through zero."
            }
            _ if alternates && !mean => {
                " Arrows of one length show the direction at the greatest current of the coils."
            }
            _ => " Arrows of one length show its direction.",
        };
    }
    if shown.above {
        text += " A few places lie above the colours.";
    }
    text
}
