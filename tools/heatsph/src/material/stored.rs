//! What the unit volume of a material stores: density times specific heat, of place and temperature.

use run::property::{Arguments, Curve, OutOfRange};

use super::PLACE;
use super::enthalpy::Enthalpy;
use super::volumetric::Volumetric;
use shapes::frame::Vector;

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
    /// What a material stores, from density \[kg/m3\] and specific heat \[J/(kg K)\]; a function of temperature that is
    /// not yet among `functions` joins them, tabulated over `range` \[K\].
    pub(super) fn new(
        factors: [Curve; 2],
        range: (f64, f64),
        functions: &mut Vec<Enthalpy>,
    ) -> Result<Self, OutOfRange> {
        let [mut place, mut both, mut warm] = [const { Vec::new() }; 3];
        for curve in factors {
            let here = PLACE.iter().any(|name| curve.depends_on(name));
            let of = match (here, curve.depends_on("T")) {
                (_, false) => &mut place,
                (false, true) => &mut warm,
                (true, true) => &mut both,
            };
            of.push(curve);
        }
        let mut temperature = None;
        if !both.is_empty() {
            both.append(&mut warm);
        } else if !warm.is_empty() {
            let law = Volumetric {
                factors: warm,
                place: [0.0; 3],
            };
            let table = Enthalpy::new(law, range)?;
            let known = functions.iter().position(|known| *known == table);
            temperature = Some(known.unwrap_or_else(|| {
                functions.push(table);
                functions.len() - 1
            }));
        }
        Ok(Self {
            place,
            temperature,
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
