//! One fit: from offsets to the weights of functionals.

use nalgebra::{DMatrix, DVector};

use crate::basis::{Basis, TERMS};
use crate::factor::{self, Factor};
use crate::harmonic::{Over, Reduction};
use crate::moments::{Coefficients, Points, ROWS};

/// Up to this condition number the normal equations with one correction are exact to rounding.
const NORMAL: f64 = 3e3;
/// Corrections at most.
const CORRECTIONS: usize = 4;
/// What may be missing of a moment condition, as a part of the functional; monomials are at most 1
/// on a support.
const EXACT: f64 = 1e-13;
/// With this much missing after all corrections the points do not determine the functional.
const DETERMINED: f64 = 1e-10;
/// Singular values of the conditions' matrix below this part of the greatest belong to conditions
/// that repeat others.
const REPEATED: f64 = 1e-10;

/// A condition shorter than this part of what it asks of monomials asks nothing.
const NOTHING: f64 = 1e-12;

/// How a fit was solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    Normal,
    Orthogonal,
    Spectrum,
}

/// Points of a support.
pub(crate) struct Offsets<'a, const D: usize> {
    /// From the point, in the unit of `radius`.
    pub(crate) s: &'a [[f64; D]],
    /// What the weight of each is multiplied by; nothing where it is nothing.
    pub(crate) rooms: &'a [f64],
    /// Of the support.
    pub(crate) radius: f64,
}

/// Weighted least squares at one point,
///
/// min_a sum_j w_j (p(s_j)^T a - u_j)^2   subject to   C a = g,
///
/// so that a functional e^T a is sum_j W_j u_j + sum_k L_k g_k with
///
/// W_j = w_j p(s_j)^T c,   c = G^-1 (e - C^T L),   C c = 0,   G = sum_j w_j p p^T + C^T C.
///
/// The last term of G changes nothing, as C a is given, but lets conditions stand in for points
/// that are missing. Columns are scaled to length 1. What rounding leaves of the moment conditions
/// e = sum_j W_j p(s_j) + C^T L is corrected by the same factor.
#[derive(Debug, Clone)]
pub(crate) struct Fit<const D: usize> {
    pub(crate) points: Points<D>,
    /// The polynomials that are fitted.
    reduction: Reduction,
    gram: Box<[Coefficients; TERMS]>,
    spare: Box<[Coefficients; TERMS]>,
    scale: Coefficients,
    factor: Factor,
    /// Conditions, with scaled columns and length 1; their lengths; G^-1 C^T by columns.
    conditions: Vec<Coefficients>,
    lengths: Vec<f64>,
    answers: Vec<Coefficients>,
    schur: Option<DMatrix<f64>>,
    /// Condition number found.
    pub(crate) condition: f64,
    pub(crate) way: Way,
    /// Weights, functional after functional.
    pub(crate) weights: Vec<f64>,
    /// Weights of the conditions' data, functional after functional.
    pub(crate) shares: Vec<f64>,
}

impl<const D: usize> Fit<D> {
    pub(crate) fn new() -> Self {
        Self {
            points: Points::default(),
            reduction: Reduction::default(),
            gram: Box::new([[0.0; TERMS]; TERMS]),
            spare: Box::new([[0.0; TERMS]; TERMS]),
            scale: [1.0; TERMS],
            factor: Factor::Triangle(Box::new([[0.0; TERMS]; TERMS])),
            conditions: Vec::new(),
            lengths: Vec::new(),
            answers: Vec::new(),
            schur: None,
            condition: f64::INFINITY,
            way: Way::Normal,
            weights: Vec::new(),
            shares: Vec::new(),
        }
    }

    /// Takes offsets, the rows of the conditions, and which polynomials are fitted.
    pub(crate) fn load(
        &mut self,
        basis: &Basis<D>,
        offsets: Offsets<'_, D>,
        conditions: &[Coefficients],
        over: Over<'_, D>,
    ) {
        self.points.load(offsets.s, offsets.radius);
        self.points.weigh(offsets.rooms);
        self.reduction.choose(basis, over);
        self.assemble(basis, conditions);
    }

    /// Number of unknowns.
    pub(crate) fn many(&self, basis: &Basis<D>) -> usize {
        self.reduction.many(basis.len())
    }

    /// Factors that give the columns length 1.
    pub(crate) fn scale(&self) -> &Coefficients {
        &self.scale
    }

    /// Normal equations of the points that are loaded.
    pub(crate) fn assemble(&mut self, basis: &Basis<D>, conditions: &[Coefficients]) {
        let many = self.many(basis);
        self.points.gram(basis, &mut self.gram);
        self.reduction
            .square(basis.len(), &mut self.gram, &mut self.spare);
        let reduced = conditions.iter().map(|row| self.reduction.forth(row));
        let conditions: &[Coefficients] = &reduced.collect::<Vec<_>>();
        for k in 0..many {
            let mut square = self.gram[k][k];
            for row in conditions {
                square += row[k] * row[k];
            }
            self.scale[k] = if square > 0.0 {
                square.sqrt().recip()
            } else {
                1.0
            };
        }
        for k in 0..many {
            for l in 0..=k {
                self.gram[k][l] *= self.scale[k] * self.scale[l];
            }
        }
        self.conditions.clear();
        self.lengths.clear();
        for row in conditions {
            let mut scaled = [0.0; TERMS];
            for k in 0..many {
                scaled[k] = row[k] * self.scale[k];
            }
            let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
            // One that the polynomials obey by themselves is none.
            let length = if length > NOTHING {
                length
            } else {
                f64::INFINITY
            };
            scaled.iter_mut().for_each(|x| *x /= length);
            for k in 0..many {
                for l in 0..=k {
                    self.gram[k][l] += scaled[k] * scaled[l];
                }
            }
            self.lengths.push(length);
            self.conditions.push(scaled);
        }
    }

    /// Factors by Cholesky or, where that would lose too many digits, by rotations; false where the
    /// condition number is above `limit`.
    pub(crate) fn factor(&mut self, basis: &Basis<D>, limit: f64) -> bool {
        let many = self.many(basis);
        self.way = Way::Normal;
        self.condition = f64::INFINITY;
        if factor::cholesky(&self.gram, many, &mut self.spare) {
            self.condition = factor::condition(&self.spare, many);
        }
        if self.condition > NORMAL {
            self.way = Way::Orthogonal;
            if !factor::triangular(self.matrix(basis), &mut self.spare) {
                return false;
            }
            self.condition = factor::condition(&self.spare, many);
        }
        if self.condition.is_nan() || self.condition > limit {
            return false;
        }
        if let Factor::Triangle(upper) = &mut self.factor {
            std::mem::swap(upper, &mut self.spare);
        } else {
            self.factor = Factor::Triangle(self.spare.clone());
        }
        self.join(many);
        true
    }

    /// Factors by singular values, with zeros left out.
    pub(crate) fn factor_spectrum(&mut self, basis: &Basis<D>) -> bool {
        self.way = Way::Spectrum;
        let Some((factor, condition)) = factor::spectrum(self.matrix(basis)) else {
            return false;
        };
        self.factor = factor;
        self.condition = condition;
        self.join(self.many(basis));
        true
    }

    /// The matrix of the fit: weighted monomials by points, then the conditions.
    fn matrix(&self, basis: &Basis<D>) -> DMatrix<f64> {
        let (points, many) = (self.points.len(), self.many(basis));
        let mut a = DMatrix::zeros(points + self.conditions.len(), many);
        for j in 0..points {
            let (s, weight) = self.points.point(j);
            let root = weight.sqrt();
            let mut values = [0.0; TERMS];
            for (k, value) in values.iter_mut().enumerate().take(basis.len()) {
                *value = basis.derivative(k, &[], s);
            }
            let values = self.reduction.forth(&values);
            for k in 0..many {
                a[(j, k)] = root * self.scale[k] * values[k];
            }
        }
        for (row, condition) in self.conditions.iter().enumerate() {
            for k in 0..many {
                a[(points + row, k)] = condition[k];
            }
        }
        a
    }

    /// G^-1 C^T and the inverse of C G^-1 C^T.
    fn join(&mut self, many: usize) {
        self.answers.clear();
        self.schur = None;
        if self.conditions.is_empty() {
            return;
        }
        for condition in &self.conditions {
            let mut answer = *condition;
            self.factor.solve(many, &mut answer);
            self.answers.push(answer);
        }
        let count = self.conditions.len();
        let schur = DMatrix::from_fn(count, count, |i, j| {
            dot(&self.conditions[i], &self.answers[j], many)
        });
        self.schur = schur.pseudo_inverse(REPEATED).ok();
    }

    /// Coefficients c and shares L that answer the functional `e` (scaled columns), in place of it.
    fn answer(&self, many: usize, e: &mut Coefficients, shares: &mut [f64]) {
        self.factor.solve(many, e);
        let Some(schur) = &self.schur else { return };
        let count = self.conditions.len();
        let right = DVector::from_fn(count, |k, _| dot(&self.conditions[k], e, many));
        let found = schur * right;
        for (k, answer) in self.answers.iter().enumerate() {
            shares[k] += found[k];
            for (c, a) in e[..many].iter_mut().zip(answer) {
                *c -= found[k] * a;
            }
        }
    }

    /// Weights of the `functionals`, rows over the monomials; true where all moment conditions hold.
    pub(crate) fn solve(&mut self, basis: &Basis<D>, functionals: &[Coefficients]) -> bool {
        let (many, points, count) = (self.many(basis), self.points.len(), self.conditions.len());
        let rows = functionals.len();
        self.weights.clear();
        self.weights.resize(rows * points, 0.0);
        self.shares.clear();
        self.shares.resize(rows * count, 0.0);
        // What is missing over the monomials, and what the conditions have given over the polynomials.
        let mut rest = [[0.0; TERMS]; ROWS];
        let mut given = [[0.0; TERMS]; ROWS];
        let mut sizes = [0.0; ROWS];
        rest[..rows].copy_from_slice(functionals);
        for (size, e) in sizes.iter_mut().zip(functionals) {
            let e = self.reduction.forth(e);
            *size = e[..many].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        }
        let mut missing = f64::INFINITY;
        for _ in 0..=CORRECTIONS {
            let before = missing;
            let mut change = [[0.0; TERMS]; ROWS];
            for f in 0..rows {
                let left = self.left(many, &rest[f], &given[f]);
                change[f] = self.correction(many, f, left, &mut given[f]);
            }
            self.points
                .spread(basis, &change[..rows], &mut self.weights, &mut rest[..rows]);
            missing = 0.0;
            for f in 0..rows {
                let left = self.left(many, &rest[f], &given[f]);
                for r in &left[..many] {
                    missing = f64::max(missing, r.abs() / sizes[f]);
                }
            }
            if missing <= EXACT || missing >= 0.5 * before {
                break;
            }
        }
        for shares in self.shares.chunks_mut(count.max(1)) {
            for (share, length) in shares.iter_mut().zip(&self.lengths) {
                *share /= length;
            }
        }
        missing <= DETERMINED
    }

    /// What is missing of a functional over the polynomials.
    fn left(&self, many: usize, rest: &Coefficients, given: &Coefficients) -> Coefficients {
        let mut left = self.reduction.forth(rest);
        for (l, g) in left[..many].iter_mut().zip(given) {
            *l -= g;
        }
        left
    }

    /// Coefficients over the monomials that answer what is `left` of functional `f`; adds to its shares of the conditions.
    fn correction(
        &mut self,
        many: usize,
        f: usize,
        left: Coefficients,
        given: &mut Coefficients,
    ) -> Coefficients {
        let count = self.conditions.len();
        let mut change = [0.0; TERMS];
        for (x, (r, scale)) in change.iter_mut().zip(left.iter().zip(&self.scale)) {
            *x = r * scale;
        }
        let mut shares = std::mem::take(&mut self.shares);
        let own = &mut shares[f * count..(f + 1) * count];
        let known = own.to_vec();
        self.answer(many, &mut change, own);
        for (k, condition) in self.conditions.iter().enumerate() {
            let share = own[k] - known[k];
            for l in 0..many {
                given[l] += share * condition[l] / self.scale[l];
            }
        }
        self.shares = shares;
        for (x, scale) in change[..many].iter_mut().zip(&self.scale) {
            *x *= scale;
        }
        change[many..].fill(0.0);
        self.reduction.back(&change)
    }
}

fn dot(a: &Coefficients, b: &Coefficients, many: usize) -> f64 {
    a[..many].iter().zip(&b[..many]).map(|(x, y)| x * y).sum()
}
