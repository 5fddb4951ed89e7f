//! Azimuthal magnetic field from the enclosed current (Komen 2019, eq. 5.3) and Lorentz force.
//!
//! The integral form of eq. 5.3 needs no quadrature: `B = mu0 I / (2 pi r)` with I the discrete
//! current through the axial faces within r, exact for the discrete currents. The force density is
//! `F_r = -j_z B` (the sign of eq. 5.1; eq. 2.3 of the source prints the other) and `F_z = j_r B`.

use std::f64::consts::PI;

use crate::current::potential::Potential;
use crate::grid::Grid;

/// Permeability of free space \[H/m\].
pub const MU0: f64 = 1.256_637_062_12e-6;

/// Enclosed current and what follows from it.
#[derive(Debug, Clone)]
pub struct Magnetic {
    /// Current upward within radial face `i` at axial face `j` \[A\], at `j * (nr + 1) + i`.
    enclosed: Vec<f64>,
    /// Lorentz force density at radial faces \[N/m3\].
    pub force_radial: Vec<f64>,
    /// Lorentz force density at axial faces \[N/m3\].
    pub force_axial: Vec<f64>,
}

/// Fields at cell centres, for output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtCentre {
    /// Radial current density \[A/m2\].
    pub current_radial: f64,
    /// Axial current density \[A/m2\].
    pub current_axial: f64,
    /// Azimuthal flux density \[T\].
    pub field: f64,
    /// Radial force density \[N/m3\].
    pub force_radial: f64,
    /// Axial force density \[N/m3\].
    pub force_axial: f64,
}

impl Magnetic {
    /// All zero.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        Self {
            enclosed: vec![0.0; (grid.nr + 1) * (grid.nz + 1)],
            force_radial: vec![0.0; grid.radial_faces()],
            force_axial: vec![0.0; grid.axial_faces()],
        }
    }

    /// Works out field and force of the currents.
    pub fn update(&mut self, grid: &Grid, potential: &Potential) {
        let wide = grid.nr + 1;
        for j in 0..=grid.nz {
            for i in 0..grid.nr {
                let at = j * wide + i;
                self.enclosed[at + 1] = self.enclosed[at] + potential.axial[grid.axial_face(i, j)];
            }
        }
        for j in 0..grid.nz {
            for i in 1..grid.nr {
                let west = axial_density(grid, potential, i - 1, j);
                let east = axial_density(grid, potential, i, j);
                let enclosed =
                    0.5 * (self.enclosed[j * wide + i] + self.enclosed[(j + 1) * wide + i]);
                let field = MU0 * enclosed / (2.0 * PI * grid.rf[i]);
                self.force_radial[grid.radial_face(i, j)] = -0.5 * (west + east) * field;
            }
        }
        for j in 1..grid.nz {
            for i in 0..grid.nr {
                let below = radial_density(grid, potential, i, j - 1);
                let above = radial_density(grid, potential, i, j);
                let enclosed = self.within_centre(grid, i, j);
                let field = MU0 * enclosed / (2.0 * PI * grid.rc[i]);
                self.force_axial[grid.axial_face(i, j)] = 0.5 * (below + above) * field;
            }
        }
    }

    /// Current within the centre of column `i` at axial face `j` \[A\], the density being uniform
    /// over the face.
    fn within_centre(&self, grid: &Grid, i: usize, j: usize) -> f64 {
        let at = j * (grid.nr + 1) + i;
        let part = PI * (grid.rc[i] * grid.rc[i] - grid.rf[i] * grid.rf[i]) / grid.ring[i];
        self.enclosed[at] + part * (self.enclosed[at + 1] - self.enclosed[at])
    }

    /// Everything at the centre of cell `(i, j)`.
    #[must_use]
    pub fn at_centre(&self, grid: &Grid, potential: &Potential, i: usize, j: usize) -> AtCentre {
        let current_radial = radial_density(grid, potential, i, j);
        let current_axial = axial_density(grid, potential, i, j);
        let enclosed = 0.5 * (self.within_centre(grid, i, j) + self.within_centre(grid, i, j + 1));
        let field = MU0 * enclosed / (2.0 * PI * grid.rc[i]);
        AtCentre {
            current_radial,
            current_axial,
            field,
            force_radial: -current_axial * field,
            force_axial: current_radial * field,
        }
    }
}

/// Axial current density at the centre of cell `(i, j)` \[A/m2\].
#[must_use]
pub fn axial_density(grid: &Grid, potential: &Potential, i: usize, j: usize) -> f64 {
    let below = potential.axial[grid.axial_face(i, j)];
    let above = potential.axial[grid.axial_face(i, j + 1)];
    0.5 * (below + above) / grid.ring[i]
}

/// Radial current density at the centre of cell `(i, j)` \[A/m2\]: the mean of its two faces, exact
/// for the linear rise from the axis.
#[must_use]
pub fn radial_density(grid: &Grid, potential: &Potential, i: usize, j: usize) -> f64 {
    let at = |face: usize| {
        let area = grid.area(face, j);
        if area > 0.0 {
            potential.radial[grid.radial_face(face, j)] / area
        } else {
            0.0
        }
    };
    0.5 * (at(i) + at(i + 1))
}
