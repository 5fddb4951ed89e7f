//! Sheets of substances: files of properties with their sources, which scenes take by name.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::origin::Document;
use super::patch::{Merged, located};
use super::{Expected, schema, suggest, validate};
use crate::failure::Failure;
use crate::fault::Fault;
use crate::property::Property;

/// Kind and version of a sheet.
pub const SHEET: Expected = Expected {
    kind: "substance",
    version: 1,
    migrations: &[],
};

/// What is known of a substance, each value a number, a table over temperature or a formula. What is not known is absent.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Substance {
    /// What it is, in a line.
    pub title: Option<String>,
    /// Where its values are from; more in `comment`.
    pub source: Option<String>,
    /// Density.
    #[schemars(extend("x-unit" = "kg/m3"))]
    pub density_kg_m3: Option<Property>,
    /// Specific heat without latent heats.
    #[schemars(extend("x-unit" = "J/(kg K)"))]
    pub specific_heat_j_kg_k: Option<Property>,
    /// Thermal conductivity.
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub thermal_conductivity_w_m_k: Option<Property>,
    /// Electric conductivity.
    #[schemars(extend("x-unit" = "S/m"))]
    pub electric_conductivity_s_m: Option<Property>,
    /// Viscosity of the liquid or gas.
    #[schemars(extend("x-unit" = "Pa s"))]
    pub viscosity_pa_s: Option<Property>,
    /// Surface tension of the liquid.
    #[schemars(extend("x-unit" = "N/m"))]
    pub surface_tension_n_m: Option<Property>,
    /// Its slope over temperature.
    #[schemars(extend("x-unit" = "N/(m K)"))]
    pub surface_tension_slope_n_m_k: Option<Property>,
    /// Volume expansion.
    #[schemars(extend("x-unit" = "1/K"))]
    pub expansion_1_k: Option<Property>,
    /// Emissivity of the surface.
    #[schemars(extend("x-unit" = "1"))]
    pub emissivity: Option<Property>,
    /// Work function.
    #[schemars(extend("x-unit" = "V"))]
    pub work_function_v: Option<Property>,
    /// Richardson's constant of thermionic emission.
    #[schemars(extend("x-unit" = "A/(m2 K2)"))]
    pub richardson_a_m2_k2: Option<Property>,
    /// Permittivity over that of empty space.
    #[schemars(extend("x-unit" = "1"))]
    pub relative_permittivity: Option<Property>,
    /// Permeability over that of empty space, in any form that a scene takes.
    #[schemars(extend("x-unit" = "1"))]
    pub relative_permeability: Option<Value>,
    /// Melting.
    pub melting: Option<Melting>,
    /// Evaporation.
    pub evaporation: Option<Evaporation>,
    /// As grains.
    pub granular: Option<Granular>,
    /// Elasticity.
    pub elastic: Option<Elastic>,
    /// Where it breaks.
    pub fracture: Option<Fracture>,
}

/// Melting.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Melting {
    /// Melting point, or the middle of its range.
    #[schemars(extend("x-unit" = "K"))]
    pub point_k: Option<Property>,
    /// Half of the range.
    #[schemars(extend("x-unit" = "K"))]
    pub half_range_k: Option<Property>,
    /// Latent heat.
    #[schemars(extend("x-unit" = "J/kg"))]
    pub latent_heat_j_kg: Option<Property>,
}

/// Evaporation.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evaporation {
    /// Boiling point at one atmosphere.
    #[schemars(extend("x-unit" = "K"))]
    pub boiling_k: Option<Property>,
    /// Latent heat.
    #[schemars(extend("x-unit" = "J/kg"))]
    pub latent_heat_j_kg: Option<Property>,
    /// Molar mass of the vapour.
    #[schemars(extend("x-unit" = "kg/mol"))]
    pub molar_mass_kg_mol: Option<Property>,
}

/// A substance as grains, a flux.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Granular {
    /// Conductivity of its slag over that of its grains.
    #[schemars(extend("x-unit" = "1"))]
    pub slag_conductivity_ratio: Option<Property>,
    /// Share of radiation that it absorbs.
    #[schemars(extend("x-unit" = "1"))]
    pub absorbed_radiation: Option<Property>,
    /// Depth in which its slag absorbs.
    #[schemars(extend("x-unit" = "m"))]
    pub absorption_length_m: Option<Property>,
    /// Refractive index of its slag.
    #[schemars(extend("x-unit" = "1"))]
    pub refractive_index: Option<Property>,
}

/// Elasticity.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Elastic {
    /// Young's modulus.
    #[schemars(extend("x-unit" = "Pa"))]
    pub youngs_modulus_pa: Option<Property>,
    /// Poisson's ratio.
    #[schemars(extend("x-unit" = "1"))]
    pub poisson_ratio: Option<Property>,
}

/// Fracture.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fracture {
    /// Equivalent strain at which it breaks.
    #[schemars(extend("x-unit" = "1"))]
    pub equivalent_strain: Option<Property>,
}

/// The schema of a sheet.
#[must_use]
pub fn sheet_schema() -> Value {
    schema::schema_of::<Substance>(SHEET)
}

/// Reads and checks the sheet that the value at a pointer of a scene names.
pub(super) fn read(scene: &Merged, pointer: &str, file: &str) -> Result<Document, Failure> {
    let path = scene.beside(pointer, file);
    if !path.is_file() {
        let what = format!("there is no file {}{}", path.display(), hint(&path));
        let missing = vec![Fault::at(pointer, what)];
        return Err(Failure::Scene(located(missing, scene)));
    }
    let sheet = Merged::new(Document::read(&path)?);
    super::check_kind(&sheet, SHEET)?;
    let faults = validate::faults(&sheet_schema(), sheet.value());
    if faults.is_empty() {
        Document::read(&path)
    } else {
        Err(Failure::Scene(located(faults, &sheet)))
    }
}

/// The file beside a missing one that has a name like its.
pub(super) fn hint(path: &Path) -> String {
    let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        return format!("; there is no folder {}", folder.display());
    };
    let mut names: Vec<String> = entries
        .flatten()
        .filter_map(|entry| entry.file_name().into_string().ok())
        .collect();
    names.sort();
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    let wanted = path.file_name().and_then(|n| n.to_str()).unwrap_or("");
    suggest::nearest(wanted, &known)
        .map(|meant| format!("; did you mean {meant}?"))
        .unwrap_or_default()
}

/// What is wrong with what a scene itself says of a substance.
pub(super) fn faults(own: &Value) -> Vec<Fault> {
    let mut schema = sheet_schema();
    if let Value::Object(map) = &mut schema {
        map.shift_remove("required");
        if let Some(Value::Object(properties)) = map.get_mut("properties") {
            for key in ["kind", "version", "$schema"] {
                properties.shift_remove(key);
            }
            for (key, what) in [
                ("file", "Its sheet, a file beside the scene."),
                ("from", "The sheet that was read; told by artefacts."),
                ("sha256", "Its hash; told by artefacts."),
            ] {
                properties.insert(
                    key.to_owned(),
                    serde_json::json!({"type": "string", "description": what}),
                );
            }
        }
    }
    validate::faults(&schema, own)
}
