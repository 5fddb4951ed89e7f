//! Properties of a scene as the references need them: numbers, formulas, tables, mixtures.

use serde_json::Value;

use super::formula::{At, Formula};
use crate::lab::{Finished, LabError};

/// A property that may depend on place, temperature and time.
#[derive(Debug, Clone)]
pub enum Property {
    /// A number or a formula.
    Formula(Formula),
    /// Linear between the pairs of temperature \[K\] and value.
    Table(Vec<[f64; 2]>),
    /// The sum of parts, each a fraction times a property (Rong and Kisu 2010, eq. 13).
    Mixture(Vec<[Property; 2]>),
}

impl Property {
    /// Reads a property as a scene writes it.
    ///
    /// # Errors
    /// What is not understood.
    pub fn read(value: &Value) -> Result<Self, String> {
        if let Some(number) = value.as_f64() {
            return Ok(Self::Formula(Formula::number(number)));
        }
        if let Some(text) = value["expr"].as_str() {
            return Formula::parse(text).map(Self::Formula);
        }
        let numbers = |key: &str| -> Option<Vec<f64>> {
            value[key].as_array()?.iter().map(Value::as_f64).collect()
        };
        match (numbers("t_k"), numbers("value")) {
            (Some(t), Some(v)) if t.len() == v.len() && t.len() > 1 => Ok(Self::Table(
                t.into_iter().zip(v).map(|(t, v)| [t, v]).collect(),
            )),
            _ => Err(format!("{value} is no number, formula or table")),
        }
    }

    /// Reads the conductivity of a material: its own, or that of its mixture.
    ///
    /// # Errors
    /// What is not understood.
    pub fn conductivity(material: &Value) -> Result<Self, String> {
        let Some(parts) = material["mixture"].as_array() else {
            return Self::read(&material["conductivity_w_m_k"]);
        };
        let part = |p: &Value| {
            Ok([
                Self::read(&p["fraction"])?,
                Self::read(&p["conductivity_w_m_k"])?,
            ])
        };
        let parts: Result<Vec<_>, String> = parts.iter().map(part).collect();
        parts.map(Self::Mixture)
    }

    /// The value.
    #[must_use]
    pub fn value(&self, at: &At) -> f64 {
        match self {
            Self::Formula(formula) => formula.value(at),
            Self::Table(rows) => {
                let t = at.temperature;
                let last = rows.len() - 2;
                let i = rows.partition_point(|r| r[0] <= t).saturating_sub(1);
                let [a, b] = [rows[i.min(last)], rows[i.min(last) + 1]];
                a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0])
            }
            Self::Mixture(parts) => parts
                .iter()
                .map(|[fraction, value]| fraction.value(at) * value.value(at))
                .sum(),
        }
    }
}

/// What was wrong with the scene of a run.
#[must_use]
pub fn fault(run: &Finished, what: String) -> LabError {
    LabError::Content {
        path: run.artefact.clone(),
        what: format!("its scene: {what}"),
    }
}

/// What stands at a JSON pointer of the scene as it was run.
///
/// # Errors
/// When nothing stands there.
pub fn at<'a>(run: &'a Finished, pointer: &str) -> Result<&'a Value, LabError> {
    run.scene
        .pointer(pointer)
        .ok_or_else(|| fault(run, format!("there is nothing at {pointer}")))
}

/// The property at a JSON pointer of the scene.
///
/// # Errors
/// When there is none or it is not understood.
pub fn property(run: &Finished, pointer: &str) -> Result<Property, LabError> {
    Property::read(at(run, pointer)?).map_err(|what| fault(run, format!("{pointer}: {what}")))
}

/// The conductivity of the material with this index.
///
/// # Errors
/// When there is none or it is not understood.
pub fn conductivity(run: &Finished, material: usize) -> Result<Property, LabError> {
    let pointer = format!("/materials/{material}");
    let found = Property::conductivity(at(run, &pointer)?);
    found.map_err(|what| fault(run, format!("{pointer}: {what}")))
}

/// Density times specific heat of the material with this index \[J/(m3 K)\].
///
/// # Errors
/// When one is missing or no number.
pub fn capacity(run: &Finished, material: usize) -> Result<f64, LabError> {
    let density = number(run, &format!("/materials/{material}/density_kg_m3"))?;
    Ok(density * number(run, &format!("/materials/{material}/specific_heat_j_kg_k"))?)
}

/// The number at a JSON pointer of the scene; a formula without variables is a number too.
///
/// # Errors
/// When there is none.
pub fn number(run: &Finished, pointer: &str) -> Result<f64, LabError> {
    let property = property(run, pointer)?;
    let here = At::default();
    let there = At {
        place: [0.3, 0.7, 1.1],
        r: 1.7,
        temperature: 91.0,
        time: 2.3,
    };
    let value = property.value(&here);
    if value.is_finite() && value.to_bits() == property.value(&there).to_bits() {
        Ok(value)
    } else {
        Err(fault(run, format!("{pointer} must be a number here")))
    }
}

/// `A exp(B x + a T)`: the family of conductivities of the closed solutions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponential {
    /// A \[W/(m K)\].
    pub scale: f64,
    /// B \[1/m\].
    pub along_x: f64,
    /// a \[1/K\].
    pub with_temperature: f64,
}

impl Exponential {
    /// Recognises the family from values, however the formula is written.
    ///
    /// # Errors
    /// When the property does not belong to it.
    pub fn recognise(property: &Property) -> Result<Self, String> {
        let value = |x: f64, y: f64, t: f64| {
            property.value(&At {
                place: [x, y, 0.4 * y],
                r: x.hypot(y),
                temperature: t,
                time: y,
            })
        };
        let scale = value(0.0, 0.0, 0.0);
        let found = Self {
            scale,
            along_x: (value(1.0, 0.0, 0.0) / scale).ln(),
            with_temperature: (value(0.0, 0.0, 1.0) / scale).ln(),
        };
        let belongs = [(0.3, 1.0, 0.2), (0.9, 3.0, 0.7), (-0.4, 0.2, -0.3)]
            .iter()
            .all(|(x, y, t)| {
                let wanted = found.value(*x, *t);
                (value(*x, *y, *t) - wanted).abs() <= 1e-12 * wanted.abs()
            });
        if scale > 0.0 && belongs {
            Ok(found)
        } else {
            Err("the conductivity is not of the form A exp(B x + a T) with A > 0".to_owned())
        }
    }

    /// The conductivity at x \[m\] and T \[K\].
    #[must_use]
    pub fn value(&self, x: f64, temperature: f64) -> f64 {
        self.scale * (self.along_x * x + self.with_temperature * temperature).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn properties_are_read() {
        let hot = At {
            temperature: 350.0,
            ..At::place([1.0, 0.0, 0.25])
        };
        let table = Property::read(&json!({"t_k": [300, 400, 500], "value": [1, 3, 4]})).unwrap();
        assert!((table.value(&hot) - 2.0).abs() < 1e-14);
        let mixture = Property::conductivity(&json!({"mixture": [
            {"fraction": {"expr": "1 - z"}, "conductivity_w_m_k": {"expr": "0.02*T"}},
            {"fraction": {"expr": "z"}, "conductivity_w_m_k": 2.8}]}))
        .unwrap();
        assert!((mixture.value(&hot) - (0.75 * 7.0 + 0.25 * 2.8)).abs() < 1e-14);
        assert!(Property::read(&json!({"exp": "x"})).is_err());
    }

    #[test]
    fn an_exponential_is_recognised_however_it_is_written() {
        let read = |text: &str| Property::read(&json!({"expr": text})).unwrap();
        for (text, wanted) in [
            ("2*exp(0.5*x)", [2.0, 0.5, 0.0]),
            ("exp(-3*T)", [1.0, 0.0, -3.0]),
            ("exp(T*8 + ln(3) - x)", [3.0, -1.0, 8.0]),
            ("4", [4.0, 0.0, 0.0]),
        ] {
            let found = Exponential::recognise(&read(text)).unwrap();
            let found = [found.scale, found.along_x, found.with_temperature];
            for (f, w) in found.iter().zip(wanted) {
                assert!((f - w).abs() < 1e-13, "{text}: {found:?}");
            }
        }
        for text in ["1 + x", "exp(y)", "exp(x*T)", "0", "exp(x*x)"] {
            assert!(Exponential::recognise(&read(text)).is_err(), "{text}");
        }
    }
}
