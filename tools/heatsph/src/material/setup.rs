//! From the materials of a scene to what they store and how they conduct.

use run::Fault;
use run::property::{Curve, Property};

use super::conductor::Conductor;
use super::stored::Stored;
use super::{Kind, Law, Materials, PLACE, Part};
use crate::scene::{Material, Scene};
use shapes::Body;

/// What a property of place and temperature may depend on.
const ALL: [&str; 5] = ["x", "y", "z", "r", "T"];

/// The materials of a scene whose temperatures lie within `range` \[K\] at the start.
///
/// # Errors
/// Faults of the scene.
pub fn materials(scene: &Scene, range: (f64, f64)) -> Result<Materials, Vec<Fault>> {
    let mut materials = Materials {
        kinds: Vec::new(),
        conductors: Vec::new(),
        enthalpies: Vec::new(),
        range,
        contact: Vec::new(),
        dimensions: scene.dimensions,
    };
    let mut faults = Vec::new();
    for (number, material) in scene.materials.iter().enumerate() {
        match kind(material, &format!("/materials/{number}"), &mut materials) {
            Ok(kind) => materials.kinds.push(kind),
            Err(fault) => faults.push(fault),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let count = materials.len();
    materials.contact = vec![0.0; count * count];
    for (number, resistance) in scene.contacts.iter().enumerate() {
        let mut sides = [0; 2];
        for (side, name) in resistance.between.iter().enumerate() {
            match scene.materials.iter().position(|m| m.name == *name) {
                Some(found) => sides[side] = found,
                None => faults.push(Fault::at(
                    &format!("/contacts/{number}/between/{side}"),
                    format!("there is no material \"{name}\""),
                )),
            }
        }
        let [a, b] = sides;
        materials.contact[a * count + b] = resistance.resistance_m2_k_w;
        materials.contact[b * count + a] = resistance.resistance_m2_k_w;
    }
    if faults.is_empty() {
        Ok(materials)
    } else {
        Err(faults)
    }
}

/// A material; its functions of temperature join those of all.
fn kind(material: &Material, at: &str, all: &mut Materials) -> Result<Kind, Fault> {
    let stored = stored(material, at, all)?;
    let law = match (&material.conductivity_w_m_k, &material.mixture) {
        (Some(property), None) => law(property, &format!("{at}/conductivity_w_m_k"), all)?,
        (None, Some(constituents)) => {
            let mut parts = Vec::new();
            for (number, constituent) in constituents.iter().enumerate() {
                let at = format!("{at}/mixture/{number}");
                let fraction = &constituent.fraction;
                let fraction = fraction.compile(&format!("{at}/fraction"), &PLACE)?;
                let at = format!("{at}/conductivity_w_m_k");
                let property = &constituent.conductivity_w_m_k;
                let curve = property.compile_positive(&at, &["T"], "W/(m K)")?;
                let conductor = tabulate(curve, &at, all)?;
                parts.push(Part {
                    fraction,
                    conductor,
                });
            }
            Law::Sum(parts)
        }
        (Some(_), Some(_)) => {
            let what = "\"conductivity_w_m_k\" and \"mixture\" exclude each other";
            return Err(Fault::at(&format!("{at}/mixture"), what));
        }
        (None, None) => {
            let what = "a conductivity is missing: give \"conductivity_w_m_k\" or \"mixture\"";
            return Err(Fault::at(at, what));
        }
    };
    let region = material.region.as_ref();
    Ok(Kind {
        region: region.map(|shape| Body::new(shape, all.dimensions)),
        stored,
        law,
    })
}

/// What a material stores.
fn stored(material: &Material, at: &str, all: &mut Materials) -> Result<Stored, Fault> {
    let (density, heat) = (&material.density_kg_m3, &material.specific_heat_j_kg_k);
    let mut blamed = at.to_owned();
    let mut factor = |property: &Property, key: &str, unit: &str| -> Result<Curve, Fault> {
        let path = format!("{at}/{key}");
        let curve = property.compile_positive(&path, &ALL, unit)?;
        if curve.depends_on("T") {
            blamed = path;
        }
        Ok(curve)
    };
    let factors = [
        factor(density, "density_kg_m3", "kg/m3")?,
        factor(heat, "specific_heat_j_kg_k", "J/(kg K)")?,
    ];
    Stored::new(factors, all.range, &mut all.enthalpies)
        .map_err(|error| Fault::at(&blamed, error.to_string()))
}

/// The law of a property: a function of place, or of temperature, or of both.
fn law(property: &Property, at: &str, all: &mut Materials) -> Result<Law, Fault> {
    let whole = property.compile_positive(at, &ALL, "W/(m K)")?;
    let (fraction, conductor) = if property.compile(at, &["T"]).is_ok() {
        (Curve::Constant(1.0), whole)
    } else if let Ok(fraction) = property.compile(at, &PLACE) {
        (fraction, Curve::Constant(1.0))
    } else {
        return Ok(Law::Formula(whole));
    };
    let conductor = tabulate(conductor, at, all)?;
    Ok(Law::Sum(vec![Part {
        fraction,
        conductor,
    }]))
}

/// Number of the table of a function of temperature, which joins the others unless it is known.
fn tabulate(curve: Curve, at: &str, all: &mut Materials) -> Result<usize, Fault> {
    let conductor = Conductor::new(curve, all.range.0, all.range.1)
        .map_err(|error| Fault::at(at, error.to_string()))?;
    let place = all.conductors.iter().position(|known| *known == conductor);
    Ok(place.unwrap_or_else(|| {
        all.conductors.push(conductor);
        all.conductors.len() - 1
    }))
}
