//! Multigrid-preconditioned Krylov methods for a five-point equation (crate `krylov`).
//!
//! The graph of the matrix and the groups of its hierarchy are kept from one outer iteration to the
//! next; only the coefficients are new. They are formed anew where a coupling appears that was not
//! there before, or where solves have come to need many more iterations than right after forming.
//!
//! Gas that nothing ties to a fixed value (a closed domain, a pocket) has no unique solution: its
//! first cell is tied to zero by a second diagonal. Where the right side adds up to zero, as it does
//! in a closed pocket, nothing flows through this tie and the solution is exact.

use std::sync::Arc;

use krylov::{
    Aggregation, Operator, Pattern, Rule, Scratch, Solved, Sparse, conjugate_gradient, gmres,
};
use relax::FivePoint;

/// Columns that GMRES keeps before it starts again.
const RESTART: usize = 30;
/// Iterations beyond twice those after forming that call for new groups.
const SLACK: usize = 4;
/// What rounding leaves of a row sum, as part of the diagonal.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The matrix of a five-point equation with a hierarchy of groups, kept between solves.
#[derive(Debug, Clone)]
pub struct Aggregated {
    symmetric: bool,
    matrix: Option<Sparse>,
    hierarchy: Option<Aggregation>,
    /// The equation that the groups were formed from.
    formed: FivePoint,
    /// Which connected part each row belongs to.
    part: Vec<u32>,
    /// The first row of each part.
    first: Vec<usize>,
    /// Iterations of the first solve after the groups were formed.
    fresh: Option<usize>,
    scratch: Scratch<f64>,
}

/// The four neighbours of row `k` and the coupling to each.
fn sides(a: &FivePoint, k: usize) -> [(usize, f64); 4] {
    [
        (k + 1, a.east[k]),
        (k.wrapping_sub(1), a.west[k]),
        (k + a.columns, a.north[k]),
        (k.wrapping_sub(a.columns), a.south[k]),
    ]
}

/// The coupling of the neighbours of row `k` back to it.
fn backs(a: &FivePoint, k: usize) -> [f64; 4] {
    let at = |column: &[f64], n: usize| column.get(n).copied().unwrap_or(0.0);
    [
        at(&a.west, k + 1),
        at(&a.east, k.wrapping_sub(1)),
        at(&a.south, k + a.columns),
        at(&a.north, k.wrapping_sub(a.columns)),
    ]
}

fn pattern(a: &FivePoint) -> Pattern {
    let mut offsets = vec![0];
    let mut columns = Vec::with_capacity(4 * a.len());
    for k in 0..a.len() {
        for ((n, own), back) in sides(a, k).into_iter().zip(backs(a, k)) {
            if own != 0.0 || back != 0.0 {
                columns.push(n as u32);
            }
        }
        offsets.push(columns.len());
    }
    Pattern::new(offsets, columns)
}

/// Numbers the connected parts of the graph; returns the part of each row and each part's first row.
fn parts(pattern: &Pattern) -> (Vec<u32>, Vec<usize>) {
    let mut part = vec![u32::MAX; pattern.rows()];
    let (mut first, mut open) = (Vec::new(), Vec::new());
    for k in 0..part.len() {
        if part[k] != u32::MAX {
            continue;
        }
        let name = first.len() as u32;
        first.push(k);
        open.push(k);
        part[k] = name;
        while let Some(at) = open.pop() {
            for next in &pattern.columns()[pattern.row(at)] {
                if part[*next as usize] == u32::MAX {
                    part[*next as usize] = name;
                    open.push(*next as usize);
                }
            }
        }
    }
    (part, first)
}

impl Aggregated {
    /// Nothing yet; `symmetric` equations take conjugate gradients, others GMRES.
    #[must_use]
    pub fn new(symmetric: bool) -> Self {
        Self {
            symmetric,
            matrix: None,
            hierarchy: None,
            formed: FivePoint::new(0, 0),
            part: Vec::new(),
            first: Vec::new(),
            fresh: None,
            scratch: Scratch::default(),
        }
    }

    /// Improves `x`; false where the method breaks down (`x` is then of no use).
    pub fn solve(&mut self, a: &FivePoint, x: &mut [f64], rule: Rule) -> bool {
        let Some(matrix) = self.fit(a) else {
            return false;
        };
        let found = self.solve_with(&matrix, &a.source, x, rule);
        self.matrix = Some(matrix);
        if found.is_none() {
            self.hierarchy = None;
        }
        found.is_some()
    }

    /// What the next solve needs to know of those before: the coefficients that the groups were
    /// formed from, and the iterations that the first solve with them took.
    #[must_use]
    pub fn memory(&self) -> (Vec<f64>, Option<usize>) {
        let formed = &self.formed;
        let columns = [
            &formed.centre,
            &formed.east,
            &formed.west,
            &formed.north,
            &formed.south,
        ];
        let all = columns.iter().flat_map(|c| c.iter().copied());
        let kept = self.hierarchy.as_ref().map_or(0, |_| 5 * formed.len());
        (all.take(kept).collect(), self.fresh)
    }

    /// Forms the groups of [`Self::memory`] again, for an equation of `columns` in a row.
    pub fn restore(&mut self, columns: usize, values: &[f64], fresh: Option<usize>) {
        if values.is_empty() || columns == 0 {
            return;
        }
        let n = values.len() / 5;
        let mut formed = FivePoint::new(columns, n / columns);
        let into = [
            &mut formed.centre,
            &mut formed.east,
            &mut formed.west,
            &mut formed.north,
            &mut formed.south,
        ];
        for (column, values) in into.into_iter().zip(values.chunks(n)) {
            column.copy_from_slice(values);
        }
        self.matrix = self.form(&formed);
        self.fresh = fresh;
    }

    /// The matrix of `a` and a hierarchy that fits it.
    fn fit(&mut self, a: &FivePoint) -> Option<Sparse> {
        let kept = self.matrix.take().filter(|m| m.len() == a.len());
        let kept = kept.and_then(|mut m| copy(a, &mut m).then_some(m));
        let (Some(mut matrix), Some(hierarchy)) = (kept, self.hierarchy.as_mut()) else {
            return self.form(a);
        };
        tie(&mut matrix, &self.part, &self.first);
        match hierarchy.renew(&matrix) {
            Ok(false) => Some(matrix),
            // Formed anew within, or not fit for these coefficients.
            _ => self.form(a),
        }
    }

    fn solve_with(
        &mut self,
        matrix: &Sparse,
        rhs: &[f64],
        x: &mut [f64],
        rule: Rule,
    ) -> Option<Solved> {
        let (hierarchy, scratch) = (self.hierarchy.as_mut()?, &mut self.scratch);
        let found = if self.symmetric {
            conjugate_gradient(matrix, rhs, x, hierarchy, rule, scratch)
        } else {
            gmres(matrix, rhs, x, hierarchy, rule.restarted(RESTART), scratch)
        };
        let found = found.sound().ok()?;
        let fresh = *self.fresh.get_or_insert(found.steps);
        if found.steps > 2 * fresh + SLACK {
            self.hierarchy = None;
        }
        Some(found)
    }

    /// A matrix for the couplings of `a`, the parts it falls into, and a new hierarchy.
    fn form(&mut self, a: &FivePoint) -> Option<Sparse> {
        self.hierarchy = None;
        self.fresh = None;
        let pattern = pattern(a);
        (self.part, self.first) = parts(&pattern);
        let mut matrix = Sparse::zeros(Arc::new(pattern));
        copy(a, &mut matrix);
        tie(&mut matrix, &self.part, &self.first);
        self.hierarchy = Some(Aggregation::new(&matrix, self.symmetric).ok()?);
        self.formed.clone_from(a);
        Some(matrix)
    }
}

/// Ties the first row of each part that nothing else ties.
fn tie(matrix: &mut Sparse, part: &[u32], first: &[usize]) {
    let mut tied = vec![false; first.len()];
    let pattern = Arc::clone(matrix.pattern());
    for (k, part) in part.iter().enumerate() {
        let diagonal = matrix.diagonal()[k];
        let sum: f64 = matrix.values()[pattern.row(k)].iter().sum();
        tied[*part as usize] |= diagonal + sum > ROUNDING * diagonal;
    }
    for (first, _) in first.iter().zip(&tied).filter(|(_, tied)| !**tied) {
        matrix.diagonal_mut()[*first] *= 2.0;
    }
}

/// Takes the coefficients of `a`; false where it has a coupling that the matrix has no place for.
fn copy(a: &FivePoint, matrix: &mut Sparse) -> bool {
    let pattern = Arc::clone(matrix.pattern());
    let (diagonal, values) = matrix.parts_mut();
    diagonal.copy_from_slice(&a.centre);
    for k in 0..a.len() {
        let row = pattern.row(k);
        let (columns, values) = (&pattern.columns()[row.clone()], &mut values[row]);
        let mut at = 0;
        for (n, coupling) in sides(a, k) {
            if columns.get(at).is_some_and(|c| *c as usize == n) {
                values[at] = -coupling;
                at += 1;
            } else if coupling != 0.0 {
                return false;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use relax::Coefficients;

    const RULE: Rule = Rule::to(1e-12, 61);

    /// A square of conductors that jumps by `ratio` in the middle; ground below if `grounded`.
    fn square(n: usize, ratio: f64, grounded: bool) -> FivePoint {
        let mut a = FivePoint::new(n, n);
        let sigma = |j: usize| if j < n / 2 { ratio } else { 1.0 };
        let face = |j: usize| 2.0 / (1.0 / sigma(j) + 1.0 / sigma(j + 1));
        a.fill(|i, j| {
            let inner = |on: bool, value: f64| if on { value } else { 0.0 };
            let mut c = Coefficients {
                east: inner(i + 1 < n, sigma(j)),
                west: inner(i > 0, sigma(j)),
                north: if j + 1 < n { face(j) } else { 0.0 },
                south: if j > 0 { face(j - 1) } else { 0.0 },
                ..Coefficients::default()
            };
            c.centre = c.east + c.west + c.north + c.south;
            c.centre += inner(grounded && j == 0, 2.0 * sigma(0));
            c.source = inner(j + 1 == n, 1.0) - inner(!grounded && j == 0, 1.0);
            c
        });
        a
    }

    #[test]
    fn jumps_of_conductivity_are_no_obstacle() {
        for (ratio, n) in [(1.0, 96), (1e9, 97), (1e-9, 64)] {
            let a = square(n, ratio, true);
            let mut x = vec![0.0; n * n];
            let mut solver = Aggregated::new(true);
            assert!(solver.solve(&a, &mut x, RULE));
            let fresh = solver.fresh.unwrap();
            assert!(fresh < 30, "{ratio}: {fresh}");
            // A current of 1 through every column: resistances in series.
            let exact = (n / 2) as f64 / ratio + (n - n / 2) as f64 - 0.5;
            let top = x[n * n - 1];
            // A weak conductor against ground amplifies what rounding leaves.
            assert!((top - exact).abs() < 1e-4 * exact, "{ratio}: {top} {exact}");
        }
    }

    #[test]
    fn a_closed_box_is_solved_exactly() {
        let (n, a) = (40, square(40, 100.0, false));
        let mut x = vec![0.0; n * n];
        let norm = |x: &[f64]| {
            let mut left = vec![0.0; n * n];
            a.residual(x, &mut left);
            left.iter().map(|r| r * r).sum::<f64>().sqrt()
        };
        let first = norm(&x);
        assert!(Aggregated::new(true).solve(&a, &mut x, RULE));
        assert!(norm(&x) <= 1e-9 * first, "{} of {first}", norm(&x));
    }

    #[test]
    fn what_is_restored_goes_on_to_the_same_bits() {
        let n = 50;
        let mut straight = Aggregated::new(true);
        let mut x = vec![0.0; n * n];
        let loose = Rule {
            decrease: 1e-2,
            ..RULE
        };
        assert!(straight.solve(&square(n, 3.0, true), &mut x, loose));
        let (values, fresh) = straight.memory();
        let mut resumed = Aggregated::new(true);
        resumed.restore(n, &values, fresh);
        let next = square(n, 40.0, true);
        let mut y = x.clone();
        assert!(straight.solve(&next, &mut x, loose) && resumed.solve(&next, &mut y, loose));
        assert!(x.iter().zip(&y).all(|(x, y)| x.to_bits() == y.to_bits()));
    }
}
