//! How solids yield to a pressure, within the equation of the pressure.
//!
//! Where the water is not much lighter than the solid, no pressure is stable that takes the velocity of a face as given (Causin,
//! Gerbeau and Nobile 2005): the face must yield in the equation itself (Banks, Henshaw and Schwendeman 2014, part I). The march
//! takes the solid from step to step by impulses, and an impulse J on a face changes its velocity by s J
//! ([`crate::matter::meeting::faces::GIVING`]):
//!
//! ```text
//! u_f = u_f* + s (J - dt F),   J = -sum_a 2 K_a p_a dt
//! ```
//!
//! with u_f* of all forces, the last ones F of the water included, and K_a = sum_p V_a V_p |grad W|.n, the area with which row a of
//! the water meets the part of a face. The equation of row a gets 2 rho K_a.(s sum_b K_b p_b): symmetric, and never negative. With
//! water of a mass M that rides on a face of the true s' the forces F_n of steps keep
//!
//! ```text
//! (s + 1/M) F_n = 2 (s - s') F_(n-1) - (s - s') F_(n-2)
//! ```
//!
//! so that what a wrong s makes dies away, where s is at least s', however dense the water is; the water comes no further into the
//! solid than by (s - s') dt^2 F.

use particles::sweep;
use shapes::frame::dot;

/// Numbers of cells or of rows, each with K \[m2\].
type Areas = Vec<(u32, [f64; 3])>;

/// Rows that meet a solid, and cells that yield.
#[derive(Debug, Clone, Default)]
pub(super) struct Yielding {
    /// Rows, with the cells that they meet and K \[m2\].
    pub(super) rows: Vec<(u32, Areas)>,
    /// The same by cells.
    cells: Vec<Areas>,
    /// 2 rho s of each cell \[1/m3\].
    soft: Vec<f64>,
    /// The diagonal of all rows; nothing where none meets a solid \[m\].
    diagonal: Vec<f64>,
}

impl Yielding {
    /// Of rows of `n` in all, with the cells that they meet.
    pub(super) fn of(n: usize, rows: Vec<(u32, Areas)>, soft: Vec<f64>) -> Self {
        let mut cells = vec![Vec::new(); soft.len()];
        let mut diagonal = vec![0.0; if rows.is_empty() { 0 } else { n }];
        for (row, met) in &rows {
            for (cell, area) in met {
                cells[*cell as usize].push((*row, *area));
                diagonal[*row as usize] += soft[*cell as usize] * dot(*area, *area);
            }
        }
        Self {
            rows,
            cells,
            soft,
            diagonal,
        }
    }

    /// Whether nothing yields.
    pub(super) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// -2 sum of K_a p_a, with which each cell is pushed \[N\].
    pub(super) fn forces(&self, p: &[f64]) -> Vec<[f64; 3]> {
        let mut forces = vec![[0.0; 3]; self.cells.len()];
        sweep::fill(&mut forces, |cell| {
            let mut sum = [0.0; 3];
            for (row, area) in &self.cells[cell] {
                (0..3).for_each(|k| sum[k] -= 2.0 * area[k] * p[*row as usize]);
            }
            sum
        });
        forces
    }

    /// Adds its part of the rows.
    pub(super) fn apply(&self, p: &[f64], out: &mut [f64]) {
        if self.is_empty() {
            return;
        }
        let forces = self.forces(p);
        for (row, met) in &self.rows {
            let each = met.iter().map(|(cell, area)| {
                let cell = *cell as usize;
                0.5 * self.soft[cell] * dot(*area, forces[cell])
            });
            out[*row as usize] -= each.sum::<f64>();
        }
    }

    /// Its part of the diagonal of a row.
    pub(super) fn diagonal(&self, row: usize) -> f64 {
        self.diagonal.get(row).copied().unwrap_or(0.0)
    }
}
