//! What a scene says of the heat in the metal.

use std::sync::Arc;

use props::Table;
use run::Fault;
use run::property::{Arguments, Curve, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::Face;

use super::caloric::{Caloric, Melting};
use crate::rest::Plane;

/// Temperatures \[K\] that a metal can have; a run that leaves them has diverged.
const POSSIBLE: (f64, f64) = (0.0, 1e5);
/// Temperatures \[K\] between which a formula is taken as meant.
const FORMULA_RANGE: (f64, f64) = (200.0, 6000.0);
/// Rows by which a formula is tabulated, one per kelvin.
const FORMULA_ROWS: usize = 5801;

/// Heat conduction and melting (key `heat`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// kappa(T).
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub thermal_conductivity_w_m_k: Property,
    /// c(T).
    #[schemars(extend("x-unit" = "J/(kg K)"))]
    pub specific_heat_j_kg_k: Property,
    /// Melting; absent: the metal never melts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub melting: Option<MeltingParameters>,
    /// Metal at rest conducts heat only once in this number of steps, over the time of all of them.
    #[serde(default = "every_step")]
    #[schemars(range(min = 1, max = 64))]
    pub rest_interval_steps: u32,
    /// Two particles at rest whose temperatures differ by no more than this exchange no heat; a particle that has only such
    /// neighbours is skipped.
    #[serde(default = "exchange_tolerance")]
    #[schemars(extend("x-unit" = "K"), range(min = 0.0, max = 1.0))]
    pub exchange_tolerance_k: f64,
    /// Flat faces of the plate; absent: every face is that of a particle cloud.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<Faces>,
}

fn every_step() -> u32 {
    1
}

fn room() -> f64 {
    300.0
}

fn exchange_tolerance() -> f64 {
    1e-4
}

/// The change between solid and liquid.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeltingParameters {
    /// T_m.
    #[schemars(extend("x-unit" = "K"), range(min = 1.0, max = 1e4))]
    pub point_k: f64,
    /// L.
    #[schemars(extend("x-unit" = "J/kg"), range(min = 0.0, max = 1e8))]
    pub latent_heat_j_kg: f64,
}

/// The box whose faces are flat, and what its faces are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Faces {
    /// Lower corner.
    #[schemars(extend("x-unit" = "m"))]
    pub min_m: [f64; 3],
    /// Upper corner.
    #[schemars(extend("x-unit" = "m"))]
    pub max_m: [f64; 3],
    /// Faces through which nothing flows, completed by mirror images.
    #[serde(default)]
    pub mirror: Vec<Face>,
    /// Faces through which heat leaves as if the plate went on (Komen 2019, section 4.3).
    #[serde(default)]
    pub open: Vec<Face>,
    /// Temperature of the plate far beyond its open faces; nothing beyond them is colder.
    #[serde(default = "room")]
    #[schemars(extend("x-unit" = "K"), range(min = 0.0, max = 1e4))]
    pub surroundings_k: f64,
}

impl Faces {
    /// The plane of a face.
    #[must_use]
    pub fn plane(&self, face: Face) -> Plane {
        let (axis, upper) = face.side();
        Plane {
            axis,
            at: if upper { self.max_m } else { self.min_m }[axis],
            outward: if upper { 1.0 } else { -1.0 },
        }
    }
}

/// Thermal properties alone: those of slag.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Properties {
    /// kappa(T).
    #[schemars(extend("x-unit" = "W/(m K)"))]
    pub thermal_conductivity_w_m_k: Property,
    /// c(T).
    #[schemars(extend("x-unit" = "J/(kg K)"))]
    pub specific_heat_j_kg_k: Property,
    /// Melting, which takes up the latent heat; absent: none is taken up.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub melting: Option<MeltingParameters>,
}

impl Properties {
    /// What follows from them.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn caloric(&self) -> Result<Arc<Caloric>, Fault> {
        let span = FORMULA_RANGE;
        let property = &self.thermal_conductivity_w_m_k;
        let at = "/thermal_conductivity_w_m_k";
        let (conductivity, first) = positive(property, at, "W/(m K)", span)?;
        let property = &self.specific_heat_j_kg_k;
        let at = "/specific_heat_j_kg_k";
        let (specific_heat, second) = positive(property, at, "J/(kg K)", span)?;
        let range = (first.0.max(second.0), first.1.min(second.1));
        if range.0 >= range.1 {
            let what = "has no temperature in common with the thermal conductivity";
            return Err(Fault::at("/specific_heat_j_kg_k", what));
        }
        let melting = self.melting.map(|m| Melting {
            point: m.point_k,
            latent_heat: m.latent_heat_j_kg,
        });
        Caloric::new(conductivity, &specific_heat, melting, range)
            .map(Arc::new)
            .map_err(|fault| Fault::at("", format!("thermal properties: {fault}")))
    }
}

impl Parameters {
    /// The thermal properties.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn caloric(&self) -> Result<Arc<Caloric>, Fault> {
        let properties = Properties {
            thermal_conductivity_w_m_k: self.thermal_conductivity_w_m_k.clone(),
            specific_heat_j_kg_k: self.specific_heat_j_kg_k.clone(),
            melting: self.melting,
        };
        properties.caloric()
    }

    /// Planes of the mirrored and of the open faces.
    #[must_use]
    pub fn planes(&self) -> (Vec<Plane>, Vec<Plane>) {
        let Some(faces) = &self.faces else {
            return (Vec::new(), Vec::new());
        };
        let planes = |names: &[Face]| names.iter().map(|face| faces.plane(*face)).collect();
        (planes(&faces.mirror), planes(&faces.open))
    }
}

/// As [`table`], for a property above zero; told are its key and unit.
fn positive(
    property: &Property,
    at: &str,
    unit: &str,
    span: (f64, f64),
) -> Result<(Table, (f64, f64)), Fault> {
    property.compile_positive(at, &["T"], unit)?;
    let (table, range) = table(property, at, span)?;
    let rows = table.nodes().iter().zip(table.values());
    match rows.into_iter().find(|(_, value)| **value <= 0.0) {
        // Numbers and rows were refused at their own places: a formula is left.
        Some((t, value)) => {
            let what = format!("gives {value} {unit} at {t} K, out of range: above 0 {unit}");
            Err(Fault::at(&format!("{at}/expr"), what))
        }
        None => Ok((table, range)),
    }
}

/// A property of the temperature as a table, and where it holds \[K\]; a formula is taken over `span`.
pub(crate) fn table(
    property: &Property,
    at: &str,
    span: (f64, f64),
) -> Result<(Table, (f64, f64)), Fault> {
    let curve = property.compile(at, &["T"])?;
    let everywhere = POSSIBLE;
    let (nodes, values, range) = match &curve {
        Curve::Constant(value) => (vec![0.0, 1.0], vec![*value; 2], everywhere),
        Curve::Table(rows) => (
            rows.temperatures().to_vec(),
            rows.values().to_vec(),
            curve.range_k().unwrap_or(everywhere),
        ),
        Curve::Formula(_) => {
            let step = (span.1 - span.0) / (FORMULA_ROWS - 1) as f64;
            let nodes: Vec<f64> = (0..FORMULA_ROWS)
                .map(|row| span.0 + row as f64 * step)
                .collect();
            let values: Result<Vec<f64>, _> = nodes
                .iter()
                .map(|t| curve.value(&Arguments::at_temperature(*t)))
                .collect();
            let values = values.map_err(|fault| Fault::at(at, fault.to_string()))?;
            if let Some(t) = hidden(&curve, &nodes, &values) {
                let what = format!(
                    "varies within {step:.3} K about {t} K by more than its table shows, which has a row each {step:.3} K: \
                     a wider peak, or \"melting\" for a latent heat"
                );
                return Err(Fault::at(&format!("{at}/expr"), what));
            }
            (nodes, values, span)
        }
    };
    Table::new(nodes, values)
        .map(|table| (table, range))
        .map_err(|fault| Fault::at(at, fault.to_string()))
}

/// How much more a formula may vary between two rows than they do, in parts of its values and of their difference.
const HIDDEN: [f64; 2] = [0.05, 2.0];

/// A temperature \[K\] about which the formula varies between two rows by more than these tell.
fn hidden(curve: &Curve, nodes: &[f64], values: &[f64]) -> Option<f64> {
    let rows = nodes.windows(2).zip(values.windows(2));
    let hides = |(t, v): &(&[f64], &[f64])| {
        let [from, to] = [t[0], t[1]].map(Arguments::at_temperature);
        let most = v[0].abs().max(v[1].abs());
        let allowed = HIDDEN[0] * most + HIDDEN[1] * (v[1] - v[0]).abs();
        curve.bounds(&from, &to).width() > allowed
    };
    rows.into_iter().find(hides).map(|(t, _)| t[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_gives_properties_and_faults_name_their_key() {
        let text = r#"{"thermal_conductivity_w_m_k": {"expr": "73 - 0.01*T"},
            "specific_heat_j_kg_k": {"t_k": [300, 1800], "value": [440, 800]},
            "melting": {"point_k": 1750, "latent_heat_j_kg": 250e3},
            "faces": {"min_m": [-0.01, -0.005, -0.005], "max_m": [0.01, 0.06, 0], "mirror": ["z+"]}}"#;
        let parameters: Parameters = serde_json::from_str(text).unwrap();
        let caloric = parameters.caloric().unwrap();
        assert!((caloric.conductivity(1000.5) - 62.995).abs() < 1e-9);
        assert_eq!(caloric.range(), (300.0, 1800.0));
        let (mirrors, open) = parameters.planes();
        assert_eq!((mirrors.len(), open.len()), (1, 0));
        assert_eq!((mirrors[0].axis, mirrors[0].outward), (2, 1.0));
        let faulty = Parameters {
            specific_heat_j_kg_k: Property::Constant(-1.0),
            ..parameters
        };
        assert!(faulty.caloric().unwrap_err().to_string().contains("-1"));
    }

    #[test]
    fn unknown_keys_are_refused() {
        let text =
            r#"{"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 600, "latent": 1}"#;
        assert!(serde_json::from_str::<Parameters>(text).is_err());
    }

    #[test]
    fn a_peak_between_two_rows_is_refused() {
        let given = |expr: &str| {
            let text = format!(
                r#"{{"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": {{"expr": "{expr}"}}}}"#
            );
            let parameters: Parameters = serde_json::from_str(&text).unwrap();
            parameters.caloric()
        };
        let narrow = given("700 + 1.4e6*exp(-((T - 1750.5)/0.1)^2)").unwrap_err();
        assert!(narrow.to_string().contains("1750 K"), "{narrow}");
        assert!(given("700 + 1.4e4*exp(-((T - 1750.5)/10)^2)").is_ok());
        assert!(given("if(T - 1000, 800, 500 + 0.2*T)").is_ok());
    }
}
