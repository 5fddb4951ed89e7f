//! A system of equations made ready for solving: rows scaled and reordered, a method chosen.

use crate::factors::Factors;
use crate::lowrank::{LowRank, Ties};
use crate::operator::Equations;
use crate::scratch::fits;
use crate::{
    Coefficient, Direct, Ending, Error, Grids, Keep, Order, Pair, Rescue, Rows, Rule, Scalar,
    Scratch, Shifted, Sides, Solved, Stagnation, Unknown,
};

/// How a system is solved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Method {
    /// Directly up to [`Options::direct`] unknowns, by multigrid beyond. Where that stands still, by incomplete factors by
    /// size; where these do not serve either and there are not more than [`Options::rescue`] unknowns, directly.
    #[default]
    Chosen,
    /// BiCGStab(2) and algebraic multigrid.
    Multigrid(Grids),
    /// Sparse triangular factors.
    Direct,
    /// BiCGStab(2) and incomplete factors of real coefficients in single precision.
    Incomplete(Keep),
    /// The same with factors of those entries alone that are not below this share of the largest beside the diagonal of their
    /// row; the others are added to the diagonal. Wide rows have many small entries.
    IncompleteOfLarge(f64),
    /// The same with complex factors, where the diagonal is complex and large.
    IncompleteComplex(Keep),
}

/// What is asked of a [`System`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The method.
    pub method: Method,
    /// Most unknowns that are solved directly at once.
    pub direct: usize,
    /// Most unknowns that are solved directly where an iteration fails.
    pub rescue: usize,
    /// Rows are given as fluxes: each in its share of a balance, so that rows of many neighbours add
    /// up to about what passes the border of these. Coarse equations of a multigrid are made of such
    /// sums; where coefficients jump they are right only for fluxes.
    pub fluxes: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Chosen,
            direct: 2000,
            rescue: 20_000,
            fluxes: false,
        }
    }
}

/// `(rows + diag(shift)) x = rhs`, made ready. Each row is divided by its largest coefficient, and
/// residuals are those of the divided rows; rows that hold nothing but their diagonal (given
/// values) are met exactly from the start.
pub struct System<T, S: Scalar> {
    pub(crate) options: Options,
    pub(crate) order: Order,
    pub(crate) rows: Rows<T>,
    pub(crate) shift: Vec<S>,
    /// Factors of the rows, in the new order.
    scale: Vec<f64>,
    pub(crate) factors: Factors<T, S>,
    scratch: Scratch<S>,
    vectors: Scratch<S>,
    pub(crate) rescued: Option<Rescue>,
}

impl<T: Scalar, S: Unknown<T>> System<T, S> {
    /// Scales, reorders and factorises `rows + diag(shift)`; an empty shift is none.
    ///
    /// # Errors
    /// When a coefficient is not finite, a row has none but zeros, or lengths differ.
    pub fn new(rows: Rows<T>, shift: Vec<S>, options: Options) -> Result<Self, Error> {
        S::made(rows, shift, None, options)
    }

    /// The same, preconditioned by the factors of other rows for the same unknowns, each about as
    /// large as its row: stencils of low order serve those of high order, whose own incomplete
    /// factors may be unstable.
    ///
    /// # Errors
    /// As for [`Self::new`], and where the other rows are not as many.
    pub fn with_low_order(
        rows: Rows<T>,
        shift: Vec<S>,
        low: Rows<T>,
        options: Options,
    ) -> Result<Self, Error> {
        if low.len() != rows.len() {
            return Err(Error::Size {
                expected: rows.len(),
                found: low.len(),
            });
        }
        S::made(rows, shift, Some(low), options)
    }

    /// Number of unknowns.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// No unknowns.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// What took the place of multigrid, if that stood still.
    #[must_use]
    pub fn rescued(&self) -> Option<Rescue> {
        self.rescued
    }

    /// Solves for all columns of `rhs`, one or three; `x` is the first guess and becomes the
    /// solution.
    ///
    /// # Panics
    /// When lengths differ.
    pub fn solve<const C: usize>(
        &mut self,
        rhs: &[[S; C]],
        x: &mut [[S; C]],
        rule: Rule,
    ) -> Solved {
        self.solve_with(&[], rhs, x, rule)
    }

    /// Solves with `sum u v^T` added to the matrix, for each pair of columns: a condition that ties
    /// few rows to many. The factors are those without.
    ///
    /// # Panics
    /// When lengths differ.
    pub fn solve_with<const C: usize>(
        &mut self,
        pairs: &[Pair<S>],
        rhs: &[[S; C]],
        x: &mut [[S; C]],
        rule: Rule,
    ) -> Solved {
        fits(self.len(), rhs, x);
        const {
            assert!(
                C == 1 || C == 3,
                "systems are solved for one or three columns"
            )
        };
        let (rhs, x) = (rhs.as_flattened(), x.as_flattened_mut());
        if C == 1 {
            S::one(self, Sides::new(pairs, rhs, x), rule)
        } else {
            S::three(self, Sides::new(pairs, rhs, x), rule)
        }
    }
}

impl<S: Scalar, T> System<T, S>
where
    T: Coefficient<S> + Scalar,
    f32: Coefficient<S> + Coefficient<T>,
{
    pub(crate) fn build(
        rows: Rows<T>,
        mut shift: Vec<S>,
        low: Option<Rows<T>>,
        options: Options,
    ) -> Result<Self, Error> {
        let n = rows.len();
        if shift.is_empty() {
            shift.resize(n, S::ZERO);
        }
        if shift.len() != n {
            return Err(Error::Size {
                expected: n,
                found: shift.len(),
            });
        }
        let direct = match options.method {
            Method::Direct => true,
            Method::Chosen => n <= options.direct,
            _ => false,
        };
        let order = if direct {
            Order::natural(n)
        } else {
            Order::cuthill_mckee(low.as_ref().unwrap_or(&rows))
        };
        let mut rows = if direct {
            rows
        } else {
            rows.into_order(&order)
        };
        let mut mixed = vec![S::ZERO; n];
        order.forth(&shift, &mut mixed);
        let scale = equilibrate(&mut rows, &mut mixed).map_err(|e| located(e, &order))?;
        let factors = if direct {
            Factors::Direct(Box::new(Direct::new(&rows, &mixed)?))
        } else if let Some(low) = low {
            let mut low = low.into_order(&order);
            for (i, scale) in scale.iter().enumerate() {
                for v in low.values_mut(i) {
                    *v = v.times_real(*scale);
                }
            }
            Factors::new(&low, &mixed, &order, &scale, options)?
        } else {
            Factors::new(&rows, &mixed, &order, &scale, options)?
        };
        Ok(Self {
            options,
            order,
            rows,
            shift: mixed,
            scale,
            factors,
            scratch: Scratch::default(),
            vectors: Scratch::default(),
            rescued: None,
        })
    }

    /// Takes other rows for the same unknowns, near those that it was made of: order and factors stay as they are, and
    /// serve the worse the further the rows are from theirs. Not for factors that solve directly.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn renew(&mut self, rows: Rows<T>) -> Result<(), Error> {
        let plain = self.shift.iter().zip(&self.scale);
        let plain: Vec<S> = plain
            .map(|(s, scale)| s.times_real(scale.recip()))
            .collect();
        let mut shift = vec![S::ZERO; plain.len()];
        self.order.back(&plain, &mut shift);
        self.renew_shifted(rows, &shift)
    }

    /// The same with another shift, where what it stands for moves with the rows.
    ///
    /// # Errors
    /// As for [`Self::new`].
    pub fn renew_shifted(&mut self, rows: Rows<T>, shift: &[S]) -> Result<(), Error> {
        let expected = self.rows.len();
        let lengths = [rows.len(), shift.len()];
        if let Some(&found) = lengths.iter().find(|n| **n != expected) {
            return Err(Error::Size { expected, found });
        }
        let (mut rows, mut mixed) = (rows.into_order(&self.order), vec![S::ZERO; expected]);
        self.order.forth(shift, &mut mixed);
        let scale = equilibrate(&mut rows, &mut mixed).map_err(|e| located(e, &self.order))?;
        (self.rows, self.shift, self.scale) = (rows, mixed, scale);
        Ok(())
    }

    pub(crate) fn solve_columns<const C: usize>(
        &mut self,
        sides: Sides<S, C>,
        rule: Rule,
    ) -> Solved {
        let Sides {
            pairs,
            right,
            solution,
        } = sides;
        let n = self.rows.len();
        let mut vectors = std::mem::take(&mut self.vectors);
        let [b, y] = vectors.columns(n * C).map(|v| v.as_chunks_mut::<C>().0);
        self.order.forth(right, b);
        self.order.forth(solution, y);
        for (b, scale) in b.iter_mut().zip(&self.scale) {
            *b = b.map(|b| b.times_real(*scale));
        }
        let ties = Ties::new(pairs, &self.order, &self.scale);
        self.given(&ties, b, y);
        let mut solved = if self.options.method == Method::Chosen {
            self.choose(&ties, b, y, rule)
        } else {
            self.run(&ties, |factors, a, scratch| {
                factors.solve(&Equations { a, b }, y, rule, scratch)
            })
        };
        if matches!(solved.ending, Ending::Stagnated(Stagnation::Plateau { .. })) {
            solved.ending = self.explained(solved.ending);
        }
        self.order.back(y, solution);
        self.vectors = vectors;
        solved
    }

    /// Puts given values where a row holds nothing but its diagonal.
    fn given<const C: usize>(&self, ties: &Ties<S>, b: &[[S; C]], y: &mut [[S; C]]) {
        for (i, y) in y.iter_mut().enumerate() {
            let alone = self.rows.pairs(i).all(|(j, v)| j == i || v == T::ZERO);
            if alone && !ties.reach(i) {
                let diagonal = Coefficient::<S>::widened(self.rows.diagonal(i)) + self.shift[i];
                *y = b[i].map(|b| b / diagonal);
            }
        }
    }

    /// Does `work` with the factors, the matrix and scratch.
    pub(crate) fn run(
        &mut self,
        ties: &Ties<S>,
        work: impl FnOnce(
            &mut Factors<T, S>,
            &LowRank<'_, Shifted<'_, T, S>, S>,
            &mut Scratch<S>,
        ) -> Solved,
    ) -> Solved {
        let sparse = Shifted {
            rows: &self.rows,
            shift: &self.shift,
        };
        let whole = LowRank {
            sparse: &sparse,
            ties,
        };
        work(&mut self.factors, &whole, &mut self.scratch)
    }

    /// Why a residual does not fall.
    fn explained(&self, ending: Ending) -> Ending {
        let growth = match &self.factors {
            Factors::Direct(_) | Factors::Multigrid(_) => return ending,
            Factors::Real(factors) => factors.growth::<S>(),
            Factors::Complex(factors) => factors.growth::<S>(),
        };
        if growth > self.usual_growth() {
            Ending::Stagnated(Stagnation::Preconditioner { growth })
        } else {
            ending
        }
    }

    /// Largest entry of the inverse applied to ones: of a Laplacian with rows of largest entry one, it grows with the points
    /// across.
    pub(crate) fn usual_growth(&self) -> f64 {
        (self.rows.len() as f64).max(10.0)
    }
}

/// Divides each row by its largest coefficient; the factors.
fn equilibrate<S: Scalar, T: Coefficient<S> + Scalar>(
    rows: &mut Rows<T>,
    shift: &mut [S],
) -> Result<Vec<f64>, Error> {
    let mut factors = Vec::with_capacity(shift.len());
    for (i, shift) in shift.iter_mut().enumerate() {
        let largest = rows.values(i).iter().map(|v| v.modulus());
        let diagonal: S = Coefficient::<S>::widened(rows.diagonal(i)) + *shift;
        let largest = largest.fold(
            diagonal.modulus(),
            |m, v| if v > m || v.is_nan() { v } else { m },
        );
        if !largest.is_finite() {
            return Err(Error::NotFinite {
                index: i,
                what: "a coefficient",
            });
        }
        if largest == 0.0 {
            return Err(Error::Singular { index: i });
        }
        let factor = 1.0 / largest;
        for v in rows.values_mut(i) {
            *v = v.times_real(factor);
        }
        *shift = shift.times_real(factor);
        factors.push(factor);
    }
    Ok(factors)
}

/// The same error with the row as the caller knows it.
fn located(error: Error, order: &Order) -> Error {
    match error {
        Error::NotFinite { index, what } => Error::NotFinite {
            index: order.old_of(index),
            what,
        },
        Error::Singular { index } => Error::Singular {
            index: order.old_of(index),
        },
        other => other,
    }
}
