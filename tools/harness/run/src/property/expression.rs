//! Compiled formulas: a list of operations on a small stack, evaluated without allocation.

use super::operation::{DEPTH, Operation, VARIABLES};
use super::{Arguments, parser};

/// A compiled formula.
#[derive(Debug, Clone)]
pub struct Expression {
    text: String,
    operations: Vec<Operation>,
}

/// Two formulas are equal when they are written alike.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Expression {
    /// Compiles a formula that may use the variables in `names` (of x, y, z, r, T, t, Y, B), `pi`, `e`
    /// and the functions of the usual names, `min`, `max`, `atan2`, `hypot`, `mod`, `step`, and
    /// `if(c, a, b)`: a where c > 0, else b.
    ///
    /// # Errors
    /// What is wrong, with its column.
    pub fn parse(text: &str, names: &[&str]) -> Result<Self, String> {
        Ok(Self {
            text: text.to_owned(),
            operations: parser::parse(text, names)?,
        })
    }

    /// The value at `at`; NaN or infinite where the formula has none.
    #[must_use]
    #[inline]
    pub fn value(&self, at: &Arguments) -> f64 {
        let variables = [
            at.x,
            at.y,
            at.z,
            at.r,
            at.temperature,
            at.time,
            at.fraction,
            at.flux_density,
        ];
        let mut stack = [0.0; DEPTH];
        let mut top = 0;
        for operation in &self.operations {
            match *operation {
                Operation::Number(x) => {
                    stack[top] = x;
                    top += 1;
                }
                Operation::Variable(i) => {
                    stack[top] = variables[i];
                    top += 1;
                }
                Operation::Negate => stack[top - 1] = -stack[top - 1],
                Operation::Call1(f, _) => stack[top - 1] = f(stack[top - 1]),
                Operation::Choose => {
                    top -= 2;
                    stack[top - 1] = if stack[top - 1] > 0.0 {
                        stack[top]
                    } else {
                        stack[top + 1]
                    };
                }
                binary => {
                    top -= 1;
                    stack[top - 1] = apply(binary, stack[top - 1], stack[top]);
                }
            }
        }
        stack[0]
    }

    /// What it does, in order.
    pub(super) fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// Whether a variable occurs.
    pub(super) fn uses(&self, name: &str) -> bool {
        let named = |o: &Operation| matches!(o, Operation::Variable(i) if VARIABLES[*i] == name);
        self.operations.iter().any(named)
    }

    /// The value, if no variable occurs.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        let fixed = !self
            .operations
            .iter()
            .any(|o| matches!(o, Operation::Variable(_)));
        fixed
            .then(|| self.value(&Arguments::default()))
            .filter(|x| x.is_finite())
    }
}

#[inline]
fn apply(operation: Operation, a: f64, b: f64) -> f64 {
    match operation {
        Operation::Add => a + b,
        Operation::Subtract => a - b,
        Operation::Multiply => a * b,
        Operation::Divide => a / b,
        Operation::Call2(f, _) => f(a, b),
        _ => power(a, b),
    }
}

/// Small whole exponents by multiplication: exact, and the same on every machine.
pub(super) fn power(a: f64, b: f64) -> f64 {
    if b.fract().abs() < f64::MIN_POSITIVE && b.abs() <= 8.0 {
        #[allow(
            clippy::cast_possible_truncation,
            reason = "a whole number of at most 8"
        )]
        return a.powi(b as i32);
    }
    a.powf(b)
}
