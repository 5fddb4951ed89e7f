//! How offsets are measured at a point.

use crate::error::Error;

/// The local spacing, and how it differs between directions.
///
/// An offset dx becomes s = M dx / L with the spacing L and a symmetric matrix M: s = 1 is one
/// spacing away. The metric decides which points are near, how much they weigh, and in which
/// coordinates the polynomial is fitted; the polynomials themselves are the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metric<const D: usize> {
    pub(crate) spacing: f64,
    pub(crate) stretch: Option<[[f64; D]; D]>,
    /// Greatest distance of a point at |s| = 1, in spacings.
    pub(crate) widest: f64,
    /// Least one.
    pub(crate) narrowest: f64,
}

impl<const D: usize> Metric<D> {
    /// The same in all directions: `spacing` L_i \[m\].
    #[must_use]
    pub fn round(spacing: f64) -> Self {
        Self {
            spacing,
            stretch: None,
            widest: 1.0,
            narrowest: 1.0,
        }
    }

    /// Thin layers along a surface: spacing `along_normal` \[m\] along the unit `normal`, and
    /// `along_surface` \[m\] across it.
    #[must_use]
    pub fn layered(normal: [f64; D], along_normal: f64, along_surface: f64) -> Self {
        let ratio = along_surface / along_normal;
        let stretch = std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                f64::from(u8::from(a == b)) + (ratio - 1.0) * normal[a] * normal[b]
            })
        });
        Self {
            spacing: along_surface,
            stretch: Some(stretch),
            widest: 1.0_f64.max(ratio.recip()),
            narrowest: 1.0_f64.min(ratio.recip()),
        }
    }

    /// The same beyond a plane across `axis`.
    #[must_use]
    pub fn mirrored(mut self, axis: usize) -> Self {
        if let Some(rows) = &mut self.stretch {
            for (a, row) in rows.iter_mut().enumerate() {
                for (b, entry) in row.iter_mut().enumerate() {
                    if (a == axis) != (b == axis) {
                        *entry = -*entry;
                    }
                }
            }
        }
        self
    }

    /// Spacing \[m\]; along the surface, where there are layers.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Volume of the cell of a point, about \[m^D\].
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.spacing.powi(D as i32) * self.widest * self.narrowest
    }

    /// s = M dx / L.
    #[inline]
    #[must_use]
    pub fn scaled(&self, dx: [f64; D]) -> [f64; D] {
        let inverse = self.spacing.recip();
        match &self.stretch {
            None => dx.map(|x| x * inverse),
            Some(rows) => {
                std::array::from_fn(|a| (0..D).map(|b| rows[a][b] * dx[b]).sum::<f64>() * inverse)
            }
        }
    }

    /// Row `a` of M: the derivative along physical axis `a` is, M being symmetric, the sum of
    /// `row[b] / L` times the derivative along s_b.
    #[inline]
    pub(crate) fn row(&self, a: usize) -> [f64; D] {
        self.stretch.map_or_else(
            || std::array::from_fn(|b| f64::from(u8::from(a == b))),
            |rows| rows[a],
        )
    }

    pub(crate) fn check(&self, point: usize) -> Result<(), Error> {
        let stretch = self
            .stretch
            .as_ref()
            .map_or(0.0, |m| m.as_flattened().iter().sum());
        let sound = self.spacing > 0.0
            && self.spacing.is_finite()
            && self.widest > 0.0
            && self.widest.is_finite()
            && stretch.is_finite();
        sound.then_some(()).ok_or(Error::BadSpacing {
            point,
            spacing: self.spacing,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_measure_across_and_along() {
        let root = 0.5_f64.sqrt();
        let metric = Metric::layered([root, root, 0.0], 0.04, 0.25);
        let across = metric.scaled([0.04 * root, 0.04 * root, 0.0]);
        let along = metric.scaled([0.25 * root, -0.25 * root, 0.0]);
        let length = |s: [f64; 3]| s.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length(across) - 1.0).abs() < 1e-12);
        assert!((length(along) - 1.0).abs() < 1e-12);
        assert!((length(metric.scaled([0.0, 0.0, 0.25])) - 1.0).abs() < 1e-12);
        assert!((metric.volume() / (0.04 * 0.25 * 0.25) - 1.0).abs() < 1e-12);
    }
}
