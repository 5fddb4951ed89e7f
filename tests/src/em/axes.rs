//! The axes in which an exact solution stands, found from what a scene says.

use serde_json::Value;

use crate::heat::property::at;
use crate::lab::{Finished, LabError};

/// A place and three unit vectors square to each other, right-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axes {
    /// Where the solution has its origin \[m\].
    pub origin: [f64; 3],
    /// Its directions x, y and z.
    pub unit: [[f64; 3]; 3],
}

impl Axes {
    /// The applied flux density of a scene in space \[T\], and axes with z along it, the origin in the middle of the sphere
    /// and, where the field is made by sheets, x along their normal.
    ///
    /// # Errors
    /// When the scene has no such vectors, or none that are square to each other.
    pub fn of_applied(run: &Finished) -> Result<(f64, Self), LabError> {
        let field = vector(run, "/eddy_currents/applied_flux_density_t")?;
        let sheets = "/eddy_currents/magnet/sheets/normal";
        let sheets = run.scene.pointer(sheets).map(|_| vector(run, sheets));
        let unit = square(field, sheets.transpose()?).map_err(|what| LabError::Content {
            path: run.artefact.clone(),
            what: what.to_owned(),
        })?;
        let axes = Self {
            origin: vector(run, "/bodies/0/shape/sphere/centre_m")?,
            unit,
        };
        Ok((dot(field, unit[2]), axes))
    }

    /// Components of a vector along the axes.
    #[must_use]
    pub fn components(&self, v: [f64; 3]) -> [f64; 3] {
        self.unit.map(|u| dot(u, v))
    }

    /// A place seen from the axes \[m\].
    #[must_use]
    pub fn place(&self, p: [f64; 3]) -> [f64; 3] {
        self.components([0, 1, 2].map(|k| p[k] - self.origin[k]))
    }
}

impl Default for Axes {
    /// Those of a scene.
    fn default() -> Self {
        Self {
            origin: [0.0; 3],
            unit: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        }
    }
}

/// Directions x, y and z with z along `field` and x along `sheets`.
fn square(field: [f64; 3], sheets: Option<[f64; 3]>) -> Result<[[f64; 3]; 3], &'static str> {
    let z = direction(field).ok_or("it has no applied field")?;
    let x = match sheets {
        Some(normal) => direction(normal).filter(|x| dot(*x, z).abs() < 1e-9),
        None => direction(cross(least(z), z)),
    };
    let x = x.ok_or("its sheets are not square to its field")?;
    Ok([x, cross(z, x), z])
}

/// Three numbers of a scene.
///
/// # Errors
/// When it has none.
pub fn vector(run: &Finished, pointer: &str) -> Result<[f64; 3], LabError> {
    let found = at(run, pointer)?.as_array().into_iter().flatten();
    let found: Option<Vec<f64>> = found.map(Value::as_f64).collect();
    found
        .and_then(|v| v.try_into().ok())
        .ok_or_else(|| LabError::Content {
            path: run.artefact.clone(),
            what: format!("{pointer} of its scene is no vector in space"),
        })
}

/// The axis that leans away most.
fn least(v: [f64; 3]) -> [f64; 3] {
    let axis = (0..3).min_by(|a, b| v[*a].abs().total_cmp(&v[*b].abs()));
    [0, 1, 2].map(|k| if Some(k) == axis { 1.0 } else { 0.0 })
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

fn direction(v: [f64; 3]) -> Option<[f64; 3]> {
    let size = dot(v, v).sqrt();
    (size > 0.0).then(|| v.map(|x| x / size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_square_and_right_handed() {
        for (field, sheets) in [
            ([0.0, 0.0, 0.01], None),
            ([0.0, 0.0, -2.0], Some([1.0, 0.0, 0.0])),
            ([3.0, -6.0, 2.0], Some([2.0, 1.0, 0.0])),
            ([1e-3, 1e-3, 1e-3], None),
        ] {
            let [x, y, z] = square(field, sheets).unwrap();
            for (a, b, wanted) in [
                (x, x, 1.0),
                (y, y, 1.0),
                (z, z, 1.0),
                (x, y, 0.0),
                (y, z, 0.0),
                (z, x, 0.0),
                (cross(x, y), z, 1.0),
            ] {
                assert!((dot(a, b) - wanted).abs() < 1e-14);
            }
            assert!((dot(field, z) - dot(field, field).sqrt()).abs() < 1e-14);
        }
        assert!(square([0.0; 3], None).is_err());
        assert!(square([0.0, 0.0, 1.0], Some([0.0, 0.1, 1.0])).is_err());
    }

    #[test]
    fn places_and_vectors_turn_about_the_origin() {
        let axes = Axes {
            origin: [1.0, 2.0, 3.0],
            unit: square([0.0, 5.0, 0.0], Some([0.0, 0.0, 1.0])).unwrap(),
        };
        // z along y, x along z, so y along x.
        for (found, wanted) in [
            (axes.components([7.0, 8.0, 9.0]), [9.0, 7.0, 8.0]),
            (axes.place([2.0, 4.0, 6.0]), [3.0, 1.0, 2.0]),
            (Axes::default().place([1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]),
        ] {
            assert!((0..3).all(|k| (found[k] - wanted[k]).abs() < 1e-15));
        }
    }
}
