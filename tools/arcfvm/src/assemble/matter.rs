//! Materials of the gas and of the bodies.

use props::Table;
use run::property::{Arguments, Curve, Extrapolate, Property, TemperatureTable};

use crate::assemble::Faults;
use crate::assemble::bed::conductivity;
use crate::assemble::gas_file::GasFile;
use crate::material::{Enthalpy, Law, Material, Melting, REFERENCE_K, Strict};
use crate::scene::{Body, Gas, GivenGas, Metal, Scene, SpecificHeat};

/// Names that a material law may use.
const NAMES: [&str; 3] = ["r", "z", "T"];
/// Names that a law of the gas may use.
const GAS_NAMES: [&str; 4] = ["r", "z", "T", "Y"];

/// The gas, then the bodies in the order of their names.
pub(crate) fn materials(
    scene: &Scene,
    gas: Option<&GasFile>,
    faults: &mut Faults,
) -> Vec<Material> {
    let mut all = vec![gas_material(scene, gas, faults)];
    for (name, body) in &scene.bodies {
        all.push(body_material(scene, name, body, faults));
    }
    all
}

fn gas_material(scene: &Scene, file: Option<&GasFile>, faults: &mut Faults) -> Material {
    match (&scene.gas, file) {
        (Gas::Table(table), Some(file)) => {
            let made = match &scene.vapour {
                Some(vapour) => file.mixture(table.beyond_table, vapour.diffusion),
                None => file.material(table.beyond_table),
            };
            made.unwrap_or_else(|e| {
                faults.add("/gas/table", e.to_string());
                Material::default()
            })
        }
        (Gas::Table(_), None) => {
            faults.add("/gas/table", "wants the input \"gas\": --input gas=FILE");
            Material::default()
        }
        (Gas::Given(given), _) => {
            let (flow, heat) = (scene.flow.is_some(), scene.heat.is_some());
            let vapour = scene.vapour.is_some();
            let names = if vapour { &GAS_NAMES[..] } else { &NAMES };
            let mut law = |property: &Option<Property>, name: &str, needed: bool| {
                let at = format!("/gas/given/{name}");
                read(property.as_ref(), &at, names, needed, faults)
            };
            Material {
                name: "gas".to_owned(),
                density: law(&given.density_kg_m3, "density_kg_m3", flow || vapour),
                viscosity: law(&given.viscosity_pa_s, "viscosity_pa_s", flow),
                thermal_conductivity: law(
                    &given.thermal_conductivity_w_m_k,
                    "thermal_conductivity_w_m_k",
                    heat,
                ),
                electric_conductivity: law(
                    &given.electric_conductivity_s_m,
                    "electric_conductivity_s_m",
                    scene.current.is_some(),
                ),
                net_emission: law(&given.net_emission_w_m3, "net_emission_w_m3", false),
                electron_density: None,
                iron_diffusion: law(&given.iron_diffusion_m2_s, "iron_diffusion_m2_s", vapour),
                enthalpy: enthalpy(
                    given.specific_heat_j_kg_k.as_ref(),
                    None,
                    "/gas/given/specific_heat_j_kg_k",
                    heat,
                    faults,
                ),
                melting: None,
                table: None,
                strict: strict(&gas_tables(given)),
            }
        }
    }
}

/// A property with its path.
type Placed<'a> = (String, Option<&'a TemperatureTable>);

/// The tables that are not to be taken beyond their ends.
fn strict(tables: &[Placed<'_>]) -> Vec<Strict> {
    let ends = |(path, table): &Placed<'_>| {
        let table = table.filter(|t| t.extrapolate == Extrapolate::Error)?;
        Some(Strict {
            path: path.clone(),
            temperature: [*table.t_k.first()?, *table.t_k.last()?],
        })
    };
    tables.iter().filter_map(ends).collect()
}

fn table_of(property: Option<&Property>) -> Option<&TemperatureTable> {
    match property {
        Some(Property::Table(table)) => Some(table),
        _ => None,
    }
}

fn heat_table(heat: Option<&SpecificHeat>) -> Option<&TemperatureTable> {
    match heat {
        Some(SpecificHeat::Table(table)) => Some(table),
        _ => None,
    }
}

fn gas_tables(gas: &GivenGas) -> Vec<Placed<'_>> {
    let own = [
        ("density_kg_m3", &gas.density_kg_m3),
        ("viscosity_pa_s", &gas.viscosity_pa_s),
        (
            "thermal_conductivity_w_m_k",
            &gas.thermal_conductivity_w_m_k,
        ),
        ("electric_conductivity_s_m", &gas.electric_conductivity_s_m),
        ("net_emission_w_m3", &gas.net_emission_w_m3),
        ("iron_diffusion_m2_s", &gas.iron_diffusion_m2_s),
    ];
    let placed = own.map(|(name, own)| (format!("/gas/given/{name}"), table_of(own.as_ref())));
    let heat = heat_table(gas.specific_heat_j_kg_k.as_ref());
    let heat = ("/gas/given/specific_heat_j_kg_k".to_owned(), heat);
    placed.into_iter().chain([heat]).collect()
}

fn body_tables<'a>(at: &str, metal: &'a Metal) -> Vec<Placed<'a>> {
    let own = [
        (
            "thermal_conductivity_w_m_k",
            &metal.thermal_conductivity_w_m_k,
        ),
        (
            "electric_conductivity_s_m",
            &metal.electric_conductivity_s_m,
        ),
    ];
    let placed = own.map(|(name, own)| (format!("{at}/{name}"), table_of(own.as_ref())));
    let heat = heat_table(metal.specific_heat_j_kg_k.as_ref());
    let heat = (format!("{at}/specific_heat_j_kg_k"), heat);
    placed.into_iter().chain([heat]).collect()
}

fn body_material(scene: &Scene, name: &str, body: &Body, faults: &mut Faults) -> Material {
    let (current, heat) = (scene.current.is_some(), scene.heat.is_some());
    let metal = &body.material;
    let at = format!("/bodies/{name}/material");
    let density = metal.density_kg_m3.map(Law::Constant);
    if density.is_none() && body.moving.is_some() && heat {
        faults.add(&at, "a moving body wants density_kg_m3");
    }
    let melting = metal.melting.as_ref().map(|m| Melting {
        point: m.point_k,
        half_range: m.half_range_k,
        latent_heat: m.latent_heat_j_kg,
    });
    let path = format!("{at}/specific_heat_j_kg_k");
    let own = metal.thermal_conductivity_w_m_k.as_ref();
    let thermal = read(
        own,
        &format!("{at}/thermal_conductivity_w_m_k"),
        &NAMES,
        heat,
        faults,
    );
    let thermal = match &body.granular {
        Some(granular) => thermal.map(|law| conductivity(law, granular, melting)),
        None => thermal,
    };
    Material {
        name: name.to_owned(),
        density,
        viscosity: None,
        thermal_conductivity: thermal,
        electric_conductivity: read(
            metal.electric_conductivity_s_m.as_ref(),
            &format!("{at}/electric_conductivity_s_m"),
            &NAMES,
            current,
            faults,
        ),
        net_emission: None,
        electron_density: None,
        iron_diffusion: None,
        melting,
        enthalpy: enthalpy(
            metal.specific_heat_j_kg_k.as_ref(),
            melting,
            &path,
            heat,
            faults,
        ),
        table: None,
        strict: strict(&body_tables(&at, metal)),
    }
}

/// A law in `names` at the path `at` that may be absent unless the physics needs it; its constants are
/// not negative.
fn read(
    property: Option<&Property>,
    at: &str,
    names: &[&str],
    needed: bool,
    faults: &mut Faults,
) -> Option<Law> {
    let Some(property) = property else {
        if needed {
            faults.add(at, "is missing; the physics of this scene needs it");
        }
        return None;
    };
    match faults.keep(property.compile(at, names))? {
        Curve::Constant(value) if value < 0.0 => {
            faults.add(at, format!("{value} is below 0"));
            None
        }
        Curve::Constant(value) => Some(Law::Constant(value)),
        Curve::Table(rows) => {
            if let Some(n) = rows.values().iter().position(|v| *v < 0.0) {
                faults.add(
                    &format!("{at}/value/{n}"),
                    format!("{} is below 0", rows.values()[n]),
                );
                return None;
            }
            match Table::new(rows.temperatures().to_vec(), rows.values().to_vec()) {
                Ok(table) => Some(Law::Table(table)),
                Err(e) => {
                    faults.add(at, e.to_string());
                    None
                }
            }
        }
        Curve::Formula(formula) => Some(Law::formula(move |r, z, t, y| {
            let at = Arguments {
                x: r,
                r,
                z,
                temperature: t,
                fraction: y,
                ..Arguments::default()
            };
            formula.value(&at)
        })),
    }
}

fn enthalpy(
    heat: Option<&SpecificHeat>,
    melting: Option<Melting>,
    at: &str,
    needed: bool,
    faults: &mut Faults,
) -> Option<Enthalpy> {
    let Some(heat) = heat else {
        if needed {
            faults.add(at, "is missing; heat needs it");
        }
        return None;
    };
    let table = match (heat, melting) {
        (SpecificHeat::Constant(value), None) => return Some(Enthalpy::Linear(*value)),
        (SpecificHeat::Constant(value), Some(_)) => {
            Table::new(vec![REFERENCE_K, 2.0 * REFERENCE_K], vec![*value; 2])
        }
        (SpecificHeat::Table(t), _) => Table::new(t.t_k.clone(), t.value.clone()),
    };
    match table.and_then(|t| Enthalpy::new(&t, melting)) {
        Ok(enthalpy) => Some(enthalpy),
        Err(e) => {
            faults.add(at, e.to_string());
            None
        }
    }
}
