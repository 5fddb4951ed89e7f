//! An aggregation multigrid cycle, used as a preconditioner.
//!
//! Two by two cells form one coarse cell; the correction is constant over it. Summing the fine
//! equations gives a coarse coupling that is too stiff by the number of cells across, since the
//! distance between coarse cells doubles: the symmetric (diffusive) part of a coupling is
//! therefore halved along a coarsened direction, the one-sided (convective) part is not. What the
//! central coefficient exceeds its neighbours by (boundaries, sources, relaxation) is summed as
//! it stands. A direction whose coupling is weak by a factor of four is not coarsened.

use crate::sor::{Colour, sweep};
use crate::{Error, FivePoint, Precondition};

/// Coarsest level: at most this many cells.
const COARSEST: usize = 16;
/// Smoothing sweeps on the coarsest level.
const COARSEST_SWEEPS: usize = 12;
/// A direction weaker than the other by this factor is not coarsened.
const ANISOTROPY: f64 = 4.0;

#[derive(Debug, Clone)]
struct Level {
    equation: FivePoint,
    x: Vec<f64>,
    scratch: Vec<f64>,
    /// Cells of this level per cell of the next coarser one, along a row and across rows.
    step: (usize, usize),
}

/// A hierarchy of ever coarser equations.
#[derive(Debug, Clone, Default)]
pub struct Multigrid {
    levels: Vec<Level>,
    visits: usize,
}

impl Multigrid {
    /// Builds the hierarchy for `equation`. `visits` is 1 for a V cycle, 2 for a W cycle.
    ///
    /// # Errors
    /// When the equation is not usable.
    pub fn new(equation: &FivePoint, visits: usize) -> Result<Self, Error> {
        let mut grid = Self {
            levels: Vec::new(),
            visits,
        };
        grid.rebuild(equation)?;
        Ok(grid)
    }

    /// Takes the coefficients of `equation`, keeping the memory where sizes are as before.
    ///
    /// # Errors
    /// When the equation is not usable.
    pub fn rebuild(&mut self, equation: &FivePoint) -> Result<(), Error> {
        equation.check()?;
        let same = self.levels.first().is_some_and(|l| {
            l.equation.columns == equation.columns && l.equation.rows == equation.rows
        });
        if !same {
            self.levels.clear();
            self.levels
                .push(Level::new(equation.columns, equation.rows));
        }
        self.levels[0].equation.clone_from(equation);
        let mut k = 0;
        while self.levels[k].equation.len() > COARSEST {
            let step = coarsening(&self.levels[k].equation);
            if step == (1, 1) {
                break;
            }
            self.levels[k].step = step;
            let fine = &self.levels[k].equation;
            let size = (fine.columns.div_ceil(step.0), fine.rows.div_ceil(step.1));
            let fits = self
                .levels
                .get(k + 1)
                .is_some_and(|l| (l.equation.columns, l.equation.rows) == size);
            if !fits {
                self.levels.truncate(k + 1);
                self.levels.push(Level::new(size.0, size.1));
            }
            let (fine, coarse) = self.levels.split_at_mut(k + 1);
            aggregate(&fine[k].equation, step, &mut coarse[0].equation);
            k += 1;
        }
        self.levels.truncate(k + 1);
        self.levels[k].step = (1, 1);
        Ok(())
    }
}

impl Precondition for Multigrid {
    /// One cycle.
    fn precondition(&mut self, rhs: &[f64], out: &mut [f64]) {
        let visits = self.visits;
        if let Some(top) = self.levels.first_mut() {
            top.equation.source.copy_from_slice(rhs);
            top.x.fill(0.0);
            cycle(&mut self.levels, visits);
            out.copy_from_slice(&self.levels[0].x);
        }
    }
}

impl Level {
    fn new(columns: usize, rows: usize) -> Self {
        let zeros = vec![0.0; columns * rows];
        Self {
            equation: FivePoint::new(columns, rows),
            x: zeros.clone(),
            scratch: zeros,
            step: (1, 1),
        }
    }

    fn smooth(&mut self, order: [Colour; 2]) {
        for colour in order {
            sweep(&self.equation, &mut self.x, 1.0, colour, &mut self.scratch);
        }
    }
}

const FORWARD: [Colour; 2] = [Colour::Red, Colour::Black];
/// The reverse order after the coarse correction keeps the cycle symmetric, as the conjugate
/// gradient method asks.
const BACKWARD: [Colour; 2] = [Colour::Black, Colour::Red];

fn cycle(levels: &mut [Level], visits: usize) {
    let Some((fine, rest)) = levels.split_first_mut() else {
        return;
    };
    if rest.is_empty() {
        for _ in 0..COARSEST_SWEEPS {
            fine.smooth(FORWARD);
            fine.smooth(BACKWARD);
        }
        return;
    }
    fine.smooth(FORWARD);
    for _ in 0..visits {
        fine.equation.residual(&fine.x, &mut fine.scratch);
        restrict(fine, &mut rest[0]);
        rest[0].x.fill(0.0);
        cycle(rest, visits);
        prolong(&rest[0], fine);
    }
    fine.smooth(BACKWARD);
}

fn restrict(fine: &Level, coarse: &mut Level) {
    let n = fine.equation.columns;
    let wide = coarse.equation.columns;
    coarse.equation.source.fill(0.0);
    for j in 0..fine.equation.rows {
        let to = j / fine.step.1 * wide;
        for i in 0..n {
            coarse.equation.source[to + i / fine.step.0] += fine.scratch[j * n + i];
        }
    }
}

fn prolong(coarse: &Level, fine: &mut Level) {
    let n = fine.equation.columns;
    let wide = coarse.equation.columns;
    for j in 0..fine.equation.rows {
        let from = j / fine.step.1 * wide;
        for i in 0..n {
            fine.x[j * n + i] += coarse.x[from + i / fine.step.0];
        }
    }
}

/// How many cells to join along a row and across rows.
fn coarsening(equation: &FivePoint) -> (usize, usize) {
    let (mut along, mut across) = (0.0, 0.0);
    for k in 0..equation.len() {
        let scale = 1.0 / equation.centre[k];
        along += (equation.east[k] + equation.west[k]) * scale;
        across += (equation.north[k] + equation.south[k]) * scale;
    }
    let step = |size: usize, own: f64, other: f64| {
        if size > 1 && own * ANISOTROPY >= other {
            2
        } else {
            1
        }
    };
    let found = (
        step(equation.columns, along, across),
        step(equation.rows, across, along),
    );
    if found == (1, 1) {
        (equation.columns.min(2), equation.rows.min(2))
    } else {
        found
    }
}

fn aggregate(fine: &FivePoint, step: (usize, usize), coarse: &mut FivePoint) {
    coarse.clear();
    let (n, wide) = (fine.columns, coarse.columns);
    let (soften_row, soften_column) = (1.0 / step.0 as f64, 1.0 / step.1 as f64);
    for j in 0..fine.rows {
        for i in 0..n {
            let k = j * n + i;
            let c = j / step.1 * wide + i / step.0;
            let sides = fine.east[k] + fine.west[k] + fine.north[k] + fine.south[k];
            coarse.centre[c] += fine.centre[k] - sides;
            if i + 1 < n && i / step.0 != (i + 1) / step.0 {
                let both = fine.east[k].min(fine.west[k + 1]) * (1.0 - soften_row);
                coarse.east[c] += fine.east[k] - both;
                coarse.west[c + 1] += fine.west[k + 1] - both;
            }
            if j + 1 < fine.rows && j / step.1 != (j + 1) / step.1 {
                let both = fine.north[k].min(fine.south[k + n]) * (1.0 - soften_column);
                coarse.north[c] += fine.north[k] - both;
                coarse.south[c + wide] += fine.south[k + n] - both;
            }
        }
    }
    for c in 0..coarse.len() {
        coarse.centre[c] += coarse.east[c] + coarse.west[c] + coarse.north[c] + coarse.south[c];
        if coarse.centre[c] <= 0.0 {
            // A singular (all-insulated) equation shrunk to one cell: any positive number will do,
            // its right side being zero.
            coarse.centre[c] = 1.0;
        }
    }
}
