//! Reads the fields of an arc and compares them with exact ones.

use artefact::{Reader, Table};
use run::property::{Arguments, Property};

use crate::case::{Errors, Measurement, Target};
use crate::lab::{Finished, LabError};
use crate::norms;

/// The fields on (radius, height) that `arcfvm` wrote.
#[derive(Debug, Clone)]
pub struct Plasma {
    table: Table,
    /// Radii of the cell centres \[m\].
    pub radius: Vec<f64>,
    /// Heights of the cell centres \[m\].
    pub height: Vec<f64>,
}

impl Plasma {
    /// Reads channel `/plasma`.
    ///
    /// # Errors
    /// When the artefact has no such channel or no such axes.
    pub fn read(run: &Finished) -> Result<Self, LabError> {
        let table = Reader::open_kind(&run.artefact, "arc-source", 1)?.table("/plasma")?;
        let radius = table.axis("radius_m")?.to_vec();
        let height = table.axis("height_m")?.to_vec();
        Ok(Self {
            table,
            radius,
            height,
        })
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> u64 {
        (self.radius.len() * self.height.len()) as u64
    }

    /// Index of cell `(i, j)` in a field.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> usize {
        i * self.height.len() + j
    }

    /// A field, radius by radius, height fastest.
    ///
    /// # Errors
    /// When the field is absent.
    pub fn field(&self, name: &str) -> Result<&[f64], LabError> {
        Ok(self.table.values(name)?)
    }

    /// The exact field `f(r, z)` in the order of [`Plasma::field`].
    pub fn sample(&self, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        self.radius
            .iter()
            .flat_map(|r| self.height.iter().map(|z| f(*r, *z)).collect::<Vec<_>>())
            .collect()
    }

    /// Relative L2 and Linf error of a field against the exact one.
    ///
    /// # Errors
    /// When the field is absent.
    pub fn compare(
        &self,
        name: &str,
        exact: impl Fn(f64, f64) -> f64,
    ) -> Result<(f64, f64), LabError> {
        Ok(norms::relative(self.field(name)?, &self.sample(exact)))
    }

    /// As [`Plasma::compare`] for a field that is known up to a constant: the volume means of both
    /// are taken off first.
    ///
    /// # Errors
    /// When the field is absent.
    pub fn compare_shifted(
        &self,
        name: &str,
        exact: impl Fn(f64, f64) -> f64,
    ) -> Result<(f64, f64), LabError> {
        let weight = self.sample(|r, _| r);
        let found = centred(self.field(name)?, &weight);
        Ok(norms::relative(
            &found,
            &centred(&self.sample(exact), &weight),
        ))
    }
}

/// `values` less their weighted mean.
fn centred(values: &[f64], weight: &[f64]) -> Vec<f64> {
    let total: f64 = weight.iter().sum();
    let mean = values.iter().zip(weight).map(|(v, w)| v * w).sum::<f64>() / total;
    values.iter().map(|v| v - mean).collect()
}

/// A number of the scene as it was run.
///
/// # Errors
/// When the scene has no number at `path`.
pub fn number(run: &Finished, path: &str) -> Result<f64, LabError> {
    run.scene
        .pointer(path)
        .and_then(serde_json::Value::as_f64)
        .ok_or_else(|| LabError::Content {
            path: run.artefact.clone(),
            what: format!("its scene has no number at {path}; the exact solution needs one there"),
        })
}

/// The property at `path` of the scene that ran, at a radius \[m\] and a temperature \[K\].
///
/// # Errors
/// When there is none, or it has no value there.
pub fn property(
    run: &Finished,
    path: &str,
    radius: f64,
    temperature: f64,
) -> Result<f64, LabError> {
    let wrong = |what: String| LabError::Content {
        path: run.artefact.clone(),
        what: format!("its scene at {path}: {what}"),
    };
    let found = run.scene.pointer(path).cloned().unwrap_or_default();
    let property: Property = serde_json::from_value(found).map_err(|e| wrong(e.to_string()))?;
    let curve = property.compile(path, &["x", "y", "z", "r", "T", "t"]);
    let at = Arguments {
        temperature,
        ..Arguments::at([radius, 0.0, 0.0], 0.0)
    };
    let value = curve.map_err(|e| wrong(e.to_string()))?.value(&at);
    value.map_err(|e| wrong(e.to_string()))
}

/// The slope a of the property `a (T - wall)` at `path` of the scene that ran.
///
/// # Errors
/// When the property is none such: the exact solution wants it.
pub fn slope(run: &Finished, path: &str, wall: f64) -> Result<f64, LabError> {
    const STEP: f64 = 1e3;
    let at = |steps: f64| property(run, path, 0.0, wall + steps * STEP);
    let [none, one, seven] = [at(0.0)?, at(1.0)?, at(7.0)?];
    if none.abs() > 1e-9 * one.abs() || (seven / one - 7.0).abs() > 1e-9 {
        return Err(LabError::Content {
            path: run.artefact.clone(),
            what: format!("its scene at {path}: the exact solution wants a (T - {wall})"),
        });
    }
    Ok(one / STEP)
}

/// A bound `max` on the error and `order` on the order of each quantity.
#[must_use]
pub fn targets(quantities: &[&'static str], max: f64, order: f64) -> Vec<Target> {
    quantities
        .iter()
        .flat_map(|quantity| {
            [
                Target::error(*quantity, max),
                Target::order(*quantity, order),
            ]
        })
        .collect()
}

/// The measurement of a run with these errors.
#[must_use]
pub fn measurement(run: Finished, fields: &Plasma, spacing_m: f64, errors: Errors) -> Measurement {
    Measurement::of(run, fields.cells(), spacing_m, errors)
}
