//! How a solve of several columns ended.

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Wanted residual over that of a zero guess, `|b - A x| / |b|`, of each column.
    pub reduction: f64,
    /// Residual below which nothing is gained, in the unit of the right side.
    pub floor: f64,
    /// Most products with the matrix.
    pub products: usize,
}

impl Default for Rule {
    fn default() -> Self {
        Self {
            reduction: 1e-8,
            floor: 0.0,
            products: 2000,
        }
    }
}

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ending {
    /// Every column has the wanted residual, evaluated anew.
    Converged,
    /// The residual has not fallen for long.
    Stagnated(Stagnation),
    /// A divisor vanished or a number left the numbers.
    BrokenDown(Breakdown),
    /// The products allowed are spent.
    Spent,
}

/// Why a residual stays where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stagnation {
    /// It is as small as rounding lets it be: the wanted reduction is too small for this matrix.
    Rounding {
        /// Residual that rounding leaves, about, over that of a zero guess.
        level: f64,
    },
    /// The right side has a part which the matrix cannot make: it is singular, or nearly so, as
    /// where nothing fixes a constant.
    Singular {
        /// Norm of the correction that the preconditioner makes, over that of the residual.
        correction: f64,
    },
    /// The factors of the preconditioner amplify: they suit the matrix ill.
    Preconditioner {
        /// Largest entry of the inverse applied to ones.
        growth: f64,
    },
    /// The space found so far does not lower it: the method or its preconditioner is too weak.
    Plateau {
        /// Products since the residual last fell by a tenth.
        products: usize,
    },
}

/// What vanished or overflowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breakdown {
    /// The residual is orthogonal to the shadow residual, again after a new one was chosen.
    Shadow,
    /// The minimising polynomial has no solution.
    Polynomial,
    /// A product or a preconditioned vector is not finite.
    NotFinite,
    /// A pivot of the factors is zero.
    Pivot,
}

impl std::fmt::Display for Ending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Converged => write!(f, "converged"),
            Self::Spent => write!(f, "the products allowed are spent"),
            Self::Stagnated(why) => write!(f, "stagnated: {why}"),
            Self::BrokenDown(what) => write!(f, "broken down: {what}"),
        }
    }
}

impl std::fmt::Display for Stagnation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Rounding { level } => {
                write!(f, "rounding leaves a residual of about {level:.1e}")
            }
            Self::Singular { correction } => write!(
                f,
                "the matrix is singular or nearly so (corrections are {correction:.1e} times the residual)"
            ),
            Self::Preconditioner { growth } => write!(
                f,
                "the preconditioner amplifies {growth:.1e} times and suits the matrix ill"
            ),
            Self::Plateau { products } => {
                write!(f, "no decrease within {products} products with the matrix")
            }
        }
    }
}

impl std::fmt::Display for Breakdown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Shadow => "the residual is orthogonal to its shadow",
            Self::Polynomial => "the minimising polynomial has no solution",
            Self::NotFinite => "a number is not finite",
            Self::Pivot => "a pivot is zero",
        })
    }
}

/// What came of a solve.
#[derive(Debug, Clone, PartialEq)]
pub struct Solved {
    /// How it ended.
    pub ending: Ending,
    /// Products with the matrix (and as many preconditioned vectors) of all columns together.
    pub products: usize,
    /// True residual at the end over that of a zero guess, of each column.
    pub residuals: Vec<f64>,
    /// Largest of the columns' residuals over that of a zero guess: at the start, then after each
    /// step of the method, as it is known there.
    pub history: Vec<f64>,
}

impl Solved {
    /// Did every column reach what was wanted?
    #[must_use]
    pub fn converged(&self) -> bool {
        self.ending == Ending::Converged
    }

    /// Largest true residual of the columns.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.residuals.iter().copied().fold(0.0, f64::max)
    }
}
