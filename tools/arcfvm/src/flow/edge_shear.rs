//! Shear at an edge of the domain, second order in the cell size.
//!
//! The difference over half a cell is first order at the face, and divided by the size of the cell it
//! leaves an error in the pressure of the last row that no refinement removes. The slope of the
//! parabola through the edge and the next two values does not; it enters the implicit half-cell
//! difference as a correction from the last iteration (Khosla and Rubin 1974).

/// Values along the inward normal of an edge: at the edge, in the first and in the second row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rows {
    /// Velocity along the edge \[m/s\].
    pub velocity: [f64; 3],
    /// Viscosity of the two rows \[Pa s\].
    pub viscosity: [f64; 2],
    /// Distance of the two rows from the edge \[m\].
    pub distance: [f64; 2],
}

impl Rows {
    /// Viscosity at the edge, extrapolated within a factor of two of the first row's \[Pa s\].
    #[must_use]
    pub fn edge_viscosity(&self) -> f64 {
        let ([first, second], [near, far]) = (self.viscosity, self.distance);
        let slope = (second - first) / (far - near);
        (first - slope * near).clamp(0.5 * first, 2.0 * first)
    }

    /// Slope toward the edge of the parabola through the three values \[1/s\].
    #[must_use]
    pub fn slope(&self) -> f64 {
        let ([edge, first, second], [near, far]) = (self.velocity, self.distance);
        edge * (1.0 / near + 1.0 / far) - first * far / (near * (far - near))
            + second * near / (far * (far - near))
    }

    /// What the shear stress exceeds the half-cell difference with the first row's viscosity by
    /// \[Pa\].
    #[must_use]
    pub fn excess(&self) -> f64 {
        let half_cell = (self.velocity[0] - self.velocity[1]) / self.distance[0];
        self.edge_viscosity() * self.slope() - self.viscosity[0] * half_cell
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_has_its_exact_slope_on_uneven_rows() {
        let u = |d: f64| 3.0 - 2.0 * d + 5.0 * d * d;
        let distance = [0.1, 0.45];
        let rows = Rows {
            velocity: [u(0.0), u(distance[0]), u(distance[1])],
            viscosity: [1.1, 1.45],
            distance,
        };
        // Toward the edge is against the distance.
        assert!((rows.slope() - 2.0).abs() < 1e-12);
        assert!((rows.edge_viscosity() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_linear_profile_of_even_viscosity_needs_no_correction() {
        let rows = Rows {
            velocity: [1.0, 1.5, 2.5],
            viscosity: [0.2, 0.2],
            distance: [0.5, 1.5],
        };
        assert!(rows.excess().abs() < 1e-15);
    }
}
