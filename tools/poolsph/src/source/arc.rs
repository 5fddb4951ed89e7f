//! What the arc does to the metal, read from an arc source: tables over the distance from its axis.

use std::path::Path;

use artefact::{Error, Reader, Table};

/// A quantity over the distance from the axis, linear between its rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Radial {
    radius: Vec<f64>,
    value: Vec<f64>,
}

impl Radial {
    /// From rows of rising radius \[m\].
    #[must_use]
    pub fn new(radius: Vec<f64>, value: Vec<f64>) -> Self {
        Self { radius, value }
    }

    /// The value at the distance `r` \[m\]; that of the first row on the axis, zero beyond the last.
    #[must_use]
    #[inline]
    pub fn at(&self, r: f64) -> f64 {
        let (Some(first), Some(last)) = (self.radius.first(), self.radius.last()) else {
            return 0.0;
        };
        if r <= *first {
            return self.value[0];
        }
        if r > *last {
            return 0.0;
        }
        let k = self.radius.partition_point(|row| *row < r);
        let part = (r - self.radius[k - 1]) / (self.radius[k] - self.radius[k - 1]);
        self.value[k - 1] + part * (self.value[k] - self.value[k - 1])
    }
}

/// A vector over distance from the axis and depth below the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Lorentz {
    radius: Vec<f64>,
    depth: Vec<f64>,
    /// Outwards \[N/m3\], depth fastest.
    radial: Vec<f64>,
    /// Upwards \[N/m3\].
    axial: Vec<f64>,
}

impl Lorentz {
    /// From axes of rising radius and depth \[m\] and force densities \[N/m3\], depth fastest.
    #[must_use]
    pub fn new(axes: [Vec<f64>; 2], radial: Vec<f64>, axial: Vec<f64>) -> Self {
        let [radius, depth] = axes;
        Self {
            radius,
            depth,
            radial,
            axial,
        }
    }

    /// Radius beyond which there is no force \[m\].
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius.last().copied().unwrap_or(0.0)
    }

    /// Force density outwards and upwards \[N/m3\], bilinear (Komen 2019, section 4.2.1); zero
    /// beyond the outer radius and the greatest depth. The radial force falls linearly to zero on
    /// the axis.
    #[must_use]
    pub fn at(&self, r: f64, depth: f64) -> (f64, f64) {
        let (Some(i), Some(j)) = (place(&self.radius, r), place(&self.depth, depth)) else {
            return (0.0, 0.0);
        };
        let rows = self.depth.len();
        let mix = |field: &[f64]| {
            let along = |i: usize| {
                let (low, high) = (field[i * rows + j.0], field[i * rows + j.0 + 1]);
                low + j.1 * (high - low)
            };
            along(i.0) + i.1 * (along(i.0 + 1) - along(i.0))
        };
        let towards_axis = (r / self.radius[0]).min(1.0);
        (towards_axis * mix(&self.radial), mix(&self.axial))
    }
}

/// Interval and part of it at `x`; the first value is held below the first row.
fn place(axis: &[f64], x: f64) -> Option<(usize, f64)> {
    let last = axis.len().checked_sub(2)?;
    if x > axis[last + 1] || x.is_nan() {
        return None;
    }
    let k = axis.partition_point(|row| *row <= x).clamp(1, last + 1) - 1;
    let part = (x - axis[k]) / (axis[k + 1] - axis[k]);
    Some((k, part.max(0.0)))
}

/// An arc source, opened.
#[derive(Debug, Clone)]
pub struct ArcSource {
    surface: Table,
    lorentz: Option<Table>,
}

impl ArcSource {
    /// Reads the tables of an artefact of kind `arc-source`.
    ///
    /// # Errors
    /// When the file is of another kind, damaged, or has no surface table.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let reader = Reader::open_kind(path, "arc-source", 1)?;
        let lorentz = if reader.has("/lorentz") {
            Some(reader.table("/lorentz")?)
        } else {
            None
        };
        Ok(Self {
            surface: reader.table("/surface")?,
            lorentz,
        })
    }

    /// The whole surface table.
    #[must_use]
    pub fn surface(&self) -> &Table {
        &self.surface
    }

    /// A column of the surface table.
    ///
    /// # Errors
    /// When it is absent.
    pub fn radial(&self, column: &str) -> Result<Radial, Error> {
        let radius = self
            .surface
            .values("radius_m")
            .or(self.surface.axis("radius_m"))?;
        Ok(Radial::new(
            radius.to_vec(),
            self.surface.values(column)?.to_vec(),
        ))
    }

    /// A scalar that belongs to the surface table, for example `gas_velocity_height_m`.
    ///
    /// # Errors
    /// When it is absent.
    pub fn scalar(&self, name: &str) -> Result<f64, Error> {
        self.surface.scalar(name)
    }

    /// The Lorentz force in the base metal, if the arc has it.
    ///
    /// # Errors
    /// When an axis or column is absent.
    pub fn lorentz(&self) -> Result<Option<Lorentz>, Error> {
        let Some(table) = &self.lorentz else {
            return Ok(None);
        };
        Ok(Some(Lorentz::new(
            [
                table.axis("radius_m")?.to_vec(),
                table.axis("depth_m")?.to_vec(),
            ],
            table.values("lorentz_radial_n_m3")?.to_vec(),
            table.values("lorentz_axial_n_m3")?.to_vec(),
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radial_tables_are_linear_and_end() {
        let table = Radial::new(vec![1.0, 2.0, 4.0], vec![5.0, 3.0, 7.0]);
        for (r, value) in [
            (0.0, 5.0),
            (1.0, 5.0),
            (1.5, 4.0),
            (3.0, 5.0),
            (4.0, 7.0),
            (4.1, 0.0),
        ] {
            assert!((table.at(r) - value).abs() < 1e-15, "{r}");
        }
    }

    #[test]
    fn the_force_is_bilinear_exact() {
        let (radius, depth) = (vec![0.5, 1.0, 2.0], vec![0.1, 0.3]);
        let field = |a: f64, b: f64, c: f64| -> Vec<f64> {
            radius
                .iter()
                .flat_map(|r| depth.iter().map(move |z| a * r + b * z + c * r * z))
                .collect()
        };
        let (radial, axial) = (field(-1.0, 2.0, 0.5), field(3.0, -1.0, 2.0));
        let lorentz = Lorentz::new([radius.clone(), depth.clone()], radial, axial);
        for (r, z) in [(0.5, 0.1), (0.7, 0.2), (1.9, 0.29), (2.0, 0.3)] {
            let (out, up) = lorentz.at(r, z);
            assert!((out - (-r + 2.0 * z + 0.5 * r * z)).abs() < 1e-12);
            assert!((up - (3.0 * r - z + 2.0 * r * z)).abs() < 1e-12);
        }
        let edge = lorentz.at(0.5, 0.2).0;
        assert!((lorentz.at(0.25, 0.2).0 - 0.5 * edge).abs() < 1e-12);
        assert_eq!(lorentz.at(2.1, 0.2), (0.0, 0.0));
        assert_eq!(lorentz.at(1.0, 0.4), (0.0, 0.0));
        // Above the first row the first row holds.
        assert_eq!(lorentz.at(1.0, -0.2), lorentz.at(1.0, 0.1));
    }
}
