//! What the unit volume of a material stores: density times specific heat, of place and temperature.

use run::Fault;
use run::property::{Arguments, Curve, OutOfRange};

use super::enthalpy::Enthalpy;
use super::volumetric::Volumetric;
use crate::scene::Material;
use shapes::frame::Vector;

/// What a property of place and temperature may depend on.
const ALL: [&str; 5] = ["x", "y", "z", "r", "T"];

/// rho c of a material, as a factor that depends on place and one that depends on temperature.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stored {
    /// Product that depends on place alone \[J/(m3 K)\].
    place: Vec<Curve>,
    /// Number of the function of temperature, where there is one.
    pub(super) temperature: Option<usize>,
    /// Factors that depend on both: each place has its own function.
    both: Vec<Curve>,
}

impl Stored {
    /// What a material of a scene stores; a function of temperature that is not yet among `functions` joins them,
    /// tabulated over `range` \[K\].
    pub(super) fn new(
        material: &Material,
        at: &str,
        range: (f64, f64),
        functions: &mut Vec<Enthalpy>,
    ) -> Result<Self, Fault> {
        let properties = [
            (&material.density_kg_m3, "density_kg_m3", "kg/m3"),
            (
                &material.specific_heat_j_kg_k,
                "specific_heat_j_kg_k",
                "J/(kg K)",
            ),
        ];
        let [mut place, mut both, mut warm] = [const { Vec::new() }; 3];
        let mut blamed = at.to_owned();
        for (property, key, unit) in properties {
            let path = format!("{at}/{key}");
            let curve = property.compile_positive(&path, &ALL, unit)?;
            let here = ALL[..4].iter().any(|name| curve.depends_on(name));
            let of = match (here, curve.depends_on("T")) {
                (_, false) => &mut place,
                (false, true) => &mut warm,
                (true, true) => &mut both,
            };
            if curve.depends_on("T") {
                blamed = path;
            }
            of.push(curve);
        }
        if both.is_empty() && warm.is_empty() {
            return Ok(Self {
                place,
                temperature: None,
                both,
            });
        }
        if !both.is_empty() {
            both.append(&mut warm);
            return Ok(Self {
                place,
                temperature: None,
                both,
            });
        }
        let law = Volumetric {
            factors: warm,
            place: [0.0; 3],
        };
        let table = Enthalpy::new(law, range);
        let table = table.map_err(|error| Fault::at(&blamed, error.to_string()))?;
        let known = functions.iter().position(|known| *known == table);
        let number = known.unwrap_or_else(|| {
            functions.push(table);
            functions.len() - 1
        });
        Ok(Self {
            place,
            temperature: Some(number),
            both,
        })
    }

    /// Whether it depends on temperature.
    pub(super) fn varies(&self) -> bool {
        self.temperature.is_some() || !self.both.is_empty()
    }

    /// The function of temperature at a place that has its own.
    pub(super) fn own(
        &self,
        place: Vector,
        range: (f64, f64),
    ) -> Option<Result<Enthalpy, OutOfRange>> {
        let law = Volumetric {
            factors: self.both.clone(),
            place,
        };
        (!self.both.is_empty()).then(|| Enthalpy::new(law, range))
    }

    /// The factor that depends on place: all of rho c where nothing depends on temperature \[J/(m3 K)\].
    pub(super) fn factor(&self, x: Vector) -> Result<f64, OutOfRange> {
        let at = Arguments::at(x, 0.0);
        let mut curves = self.place.iter();
        let Some(first) = curves.next() else {
            return Ok(1.0);
        };
        let mut value = first.value(&at)?;
        for curve in curves {
            value *= curve.value(&at)?;
        }
        if value > 0.0 {
            Ok(value)
        } else {
            Err(OutOfRange::Formula { value, at })
        }
    }
}
