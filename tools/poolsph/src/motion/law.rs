//! The viscosity of the liquid: a number, or a table or an expression of its temperature.

use props::Table;
use run::Fault;
use run::property::{Curve, Property};

use crate::heat::{Caloric, table};
use crate::stage::StageError;

/// No metal is hotter \[K\].
const HOTTEST: f64 = 6000.0;

/// mu of the liquid.
#[derive(Debug, Clone)]
pub enum Law {
    /// The same for all liquid \[Pa s\].
    Uniform(f64),
    /// That of its temperature.
    OfTemperature {
        /// Over the temperature of liquid \[Pa s\], held beyond the ends.
        mu: Table,
        /// Temperatures between which the scene has it \[K\].
        range: (f64, f64),
    },
}

impl Law {
    /// The law of a `property` at the key `at`, for liquid metal of the properties `caloric`.
    ///
    /// # Errors
    /// A fault at the key: a viscosity below zero, a formula without a value, a temperature where there is none.
    pub fn of(property: &Property, at: &str, caloric: Option<&Caloric>) -> Result<Self, Fault> {
        // Of the solid none is asked for.
        let span = caloric.map(|caloric| {
            let (from, to) = caloric.range();
            (caloric.melting_point().unwrap_or(from), to)
        });
        Self::over(property, at, span)
    }

    /// The law of a `property` at the key `at`, for what flows between two temperatures \[K\].
    ///
    /// # Errors
    /// Those of [`Law::of`].
    pub fn over(property: &Property, at: &str, span: Option<(f64, f64)>) -> Result<Self, Fault> {
        let refuse = |at: &str, value: f64, where_: &str| {
            let what = format!("{value} Pa s{where_} is out of range: at least 0 Pa s");
            Fault::at(at, what)
        };
        if let Curve::Constant(value) = property.compile(at, &["T"])? {
            return if value >= 0.0 {
                Ok(Self::Uniform(value))
            } else {
                Err(refuse(at, value, ""))
            };
        }
        let Some((first, last)) = span else {
            let what = "depends on the temperature, which means nothing without the key 'heat'";
            return Err(Fault::at(at, what));
        };
        let span = (first, last.min(HOTTEST).max(first + 1.0));
        let (all, range) = table(property, at, span)?;
        let inner = all.nodes().iter().filter(|t| **t > span.0 && **t < span.1);
        let nodes: Vec<f64> = [span.0]
            .into_iter()
            .chain(inner.copied())
            .chain([span.1])
            .collect();
        let values: Vec<f64> = nodes.iter().map(|t| all.held(*t)).collect();
        if let Some((t, value)) = nodes.iter().zip(&values).find(|row| *row.1 < 0.0) {
            return Err(refuse(at, *value, &format!(" at {t} K")));
        }
        let mu = Table::new(nodes, values).map_err(|fault| Fault::at(at, fault.to_string()))?;
        Ok(Self::OfTemperature { mu, range })
    }

    /// The largest that there is \[Pa s\].
    #[must_use]
    pub fn largest(&self) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::OfTemperature { mu, .. } => mu.values().iter().copied().fold(0.0, f64::max),
        }
    }

    /// That of particle `a`, of the temperatures of all \[K\]; one for all asks for none.
    #[must_use]
    #[inline]
    pub fn at(&self, temperature: &[f64], a: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::OfTemperature { mu, .. } => mu.held(temperature[a]),
        }
    }

    /// Refuses a temperature \[K\] for which the scene has none of `what`.
    ///
    /// # Errors
    /// [`StageError::Data`] with both sides.
    pub fn covers(&self, temperature: f64, what: &str) -> Result<(), StageError> {
        match self {
            Self::OfTemperature {
                range: (from, to), ..
            } if !(*from..=*to).contains(&temperature) => Err(StageError::Data(format!(
                "{what}: temperature {temperature} K is outside of the table, {from} K to {to} K"
            ))),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use run::property::{Extrapolate, Formula, TemperatureTable};

    use super::*;
    use crate::heat::caloric::{Melting, tests::plain};

    fn formula(expr: &str) -> Property {
        Property::Formula(Formula {
            expr: expr.to_owned(),
        })
    }

    fn told(property: &Property, caloric: Option<&Caloric>) -> String {
        Law::of(property, "/viscosity_pa_s", caloric)
            .unwrap_err()
            .to_string()
    }

    fn steel() -> Caloric {
        let melting = Melting {
            point: 1800.0,
            latent_heat: 2.5e5,
        };
        plain(700.0, 30.0, Some(melting))
    }

    #[test]
    fn only_what_liquid_can_have_bounds_the_step() {
        let rows = Property::Table(TemperatureTable {
            t_k: vec![300.0, 1800.0, 2800.0],
            value: vec![1e6, 6e-3, 2e-3],
            extrapolate: Extrapolate::Constant,
        });
        let law = Law::of(&rows, "", Some(&steel())).unwrap();
        assert!((law.largest() - 6e-3).abs() < 1e-15);
        assert!((law.at(&[2300.0], 0) - 4e-3).abs() < 1e-15);
        let law = Law::of(&formula("1e-2*exp(-T/1800)"), "", Some(&steel())).unwrap();
        assert!((law.largest() / 1e-2 - (-1.0_f64).exp()).abs() < 1e-9);
    }

    #[test]
    fn one_viscosity_for_all_needs_no_heat() {
        for property in [Property::Constant(0.004), formula("0.002 + 0.002")] {
            let law = Law::of(&property, "", None).unwrap();
            assert!(matches!(law, Law::Uniform(mu) if (mu - 0.004).abs() < 1e-18));
        }
    }

    #[test]
    fn faults_tell_the_value() {
        assert!(told(&Property::Constant(-1.0), None).contains("-1 Pa s is out of range"));
        assert!(told(&formula("1e-3*T"), None).contains("without the key 'heat'"));
        let cold = told(&formula("2 - 1e-3*T"), Some(&steel()));
        assert!(
            cold.contains("Pa s at") && cold.contains("out of range"),
            "{cold}"
        );
    }

    #[test]
    fn a_table_that_ends_is_told_where_liquid_leaves_it() {
        let rows = Property::Table(TemperatureTable {
            t_k: vec![1700.0, 2000.0],
            value: vec![6e-3, 5e-3],
            extrapolate: Extrapolate::Error,
        });
        let law = Law::of(&rows, "", Some(&steel())).unwrap();
        assert!(law.covers(1900.0, "viscosity").is_ok());
        let told = law
            .covers(2100.0, "viscosity of slag")
            .unwrap_err()
            .to_string();
        assert!(told.contains("2100 K") && told.contains("2000 K"), "{told}");
    }
}
