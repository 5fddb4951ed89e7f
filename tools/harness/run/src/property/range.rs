//! Bounds of a property over ranges of what it depends on: interval arithmetic (Moore 1966).
//!
//! The bounds hold every value that the formula takes between the least and the greatest arguments; they may be wider
//! than these values where a variable occurs more than once, and become tight as the ranges shrink. Rounding is that of
//! the formula itself. Nothing narrow hides from bounds as it does from samples.

use super::expression::Expression;
use super::operation::{DEPTH, Operation, Trend, Trend2};
use super::{Arguments, Curve, Rows};

/// Least and greatest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Nothing is less.
    pub low: f64,
    /// Nothing is greater.
    pub high: f64,
}

const WHOLE: Bounds = Bounds {
    low: f64::NEG_INFINITY,
    high: f64::INFINITY,
};
const TURN: f64 = 2.0 * std::f64::consts::PI;

impl Bounds {
    /// Bounds of one value.
    #[must_use]
    pub fn at(value: f64) -> Self {
        Self::of(&[value])
    }

    /// Greatest less least value.
    #[must_use]
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// Greatest magnitude.
    #[must_use]
    pub fn most(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Those of some values; everything where one is no number.
    fn of(values: &[f64]) -> Self {
        if values.iter().any(|v| v.is_nan()) {
            return WHOLE;
        }
        let widen = |b: Self, v: &f64| Self {
            low: b.low.min(*v),
            high: b.high.max(*v),
        };
        let none = Self {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        values.iter().fold(none, widen)
    }

    fn union(self, other: Self) -> Self {
        Self::of(&[self.low, self.high, other.low, other.high])
    }

    fn holds(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Those of the magnitude.
    fn magnitude(self) -> Self {
        let least = self.low.abs().min(self.high.abs());
        Self {
            low: if self.holds(0.0) { 0.0 } else { least },
            high: self.most(),
        }
    }

    /// Those of `f` at the corners of two ranges.
    fn corners(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let (a, b) = (self, other);
        Self::of(&[
            f(a.low, b.low),
            f(a.low, b.high),
            f(a.high, b.low),
            f(a.high, b.high),
        ])
    }

    fn power(self, exponent: Self) -> Self {
        let f = super::expression::power;
        let n = exponent.low;
        let whole = exponent.width() == 0.0 && n.fract() == 0.0;
        if whole && n % 2.0 == 0.0 && n > 0.0 {
            let magnitude = self.magnitude();
            return Self::of(&[f(magnitude.low, n), f(magnitude.high, n)]);
        }
        let defined = self.low > 0.0
            || (self.low >= 0.0 && exponent.low > 0.0)
            || (whole && (n > 0.0 || !self.holds(0.0)));
        if defined {
            self.corners(exponent, f)
        } else {
            WHOLE
        }
    }

    /// Whether one of the values `phase + 2 pi n` is inside.
    fn meets(self, phase: f64) -> bool {
        ((self.low - phase) / TURN).ceil() <= ((self.high - phase) / TURN).floor()
    }

    fn call(self, f: fn(f64) -> f64, trend: Trend) -> Self {
        let mut ends = Self::of(&[f(self.low), f(self.high)]);
        match trend {
            Trend::Monotone => {}
            Trend::Even if self.holds(0.0) => ends = ends.union(Self::at(f(0.0))),
            Trend::Even => {}
            Trend::Wave(crest) => {
                if !self.width().is_finite() || self.meets(crest) {
                    ends.high = 1.0;
                }
                if !self.width().is_finite() || self.meets(crest + 0.5 * TURN) {
                    ends.low = -1.0;
                }
            }
            Trend::Poles => {
                let half = |t: f64| (t / std::f64::consts::PI - 0.5).floor();
                if half(self.low) < half(self.high) || !self.width().is_finite() {
                    return WHOLE;
                }
            }
            Trend::Saw => {
                if self.low.floor() < self.high.floor() || !self.width().is_finite() {
                    return Self {
                        low: 0.0,
                        high: 1.0,
                    };
                }
            }
        }
        ends
    }

    fn call2(self, other: Self, f: fn(f64, f64) -> f64, trend: Trend2) -> Self {
        match trend {
            Trend2::Monotone => self.corners(other, f),
            Trend2::Even => self.magnitude().corners(other.magnitude(), f),
            // The angle of (x, y): continuous but across the negative x axis.
            Trend2::Angle if other.low > 0.0 || self.low > 0.0 => self.corners(other, f),
            Trend2::Angle if self.width() + other.width() == 0.0 => {
                Self::at(f(self.low, other.low))
            }
            Trend2::Angle => Self {
                low: -0.5 * TURN,
                high: 0.5 * TURN,
            },
            Trend2::Saw => {
                let n = |t: f64| (t / other.low).floor();
                if other.width() == 0.0 && n(self.low) >= n(self.high) {
                    return Self::of(&[f(self.low, other.low), f(self.high, other.low)]);
                }
                Self {
                    low: 0.0,
                    high: other.most(),
                }
            }
        }
    }

    fn apply(self, operation: Operation, other: Self) -> Self {
        let (a, b) = (self, other);
        match operation {
            Operation::Add => Self::of(&[a.low + b.low, a.high + b.high]),
            Operation::Subtract => Self::of(&[a.low - b.high, a.high - b.low]),
            Operation::Multiply => a.corners(b, |x, y| x * y),
            Operation::Divide if b.holds(0.0) => WHOLE,
            Operation::Divide => a.corners(b, |x, y| x / y),
            Operation::Call2(f, trend) => a.call2(b, f, trend),
            _ => a.power(b),
        }
    }
}

impl Expression {
    /// Bounds of the values between `low` and `high`.
    fn bounds(&self, low: &Arguments, high: &Arguments) -> Bounds {
        let variables = [
            (low.x, high.x),
            (low.y, high.y),
            (low.z, high.z),
            (low.r, high.r),
            (low.temperature, high.temperature),
            (low.time, high.time),
            (low.fraction, high.fraction),
            (low.flux_density, high.flux_density),
        ];
        let mut stack = [Bounds::at(0.0); DEPTH];
        let mut top = 0;
        for operation in self.operations() {
            match *operation {
                Operation::Number(x) => {
                    stack[top] = Bounds::at(x);
                    top += 1;
                }
                Operation::Variable(i) => {
                    stack[top] = Bounds::of(&[variables[i].0, variables[i].1]);
                    top += 1;
                }
                Operation::Negate => {
                    let own = stack[top - 1];
                    stack[top - 1] = Bounds::of(&[-own.low, -own.high]);
                }
                Operation::Call1(f, trend) => stack[top - 1] = stack[top - 1].call(f, trend),
                Operation::Choose => {
                    top -= 2;
                    let (choice, yes, no) = (stack[top - 1], stack[top], stack[top + 1]);
                    stack[top - 1] = if choice.low > 0.0 {
                        yes
                    } else if choice.high <= 0.0 {
                        no
                    } else {
                        yes.union(no)
                    };
                }
                binary => {
                    top -= 1;
                    stack[top - 1] = stack[top - 1].apply(binary, stack[top]);
                }
            }
        }
        stack[0]
    }
}

impl Rows {
    /// Bounds of the values between two temperatures, the ends kept beyond the table.
    fn bounds(&self, low: f64, high: f64) -> Bounds {
        let last = self.t.len() - 1;
        let held = |t: f64| {
            self.value(t.clamp(self.t[0], self.t[last]))
                .unwrap_or(f64::NAN)
        };
        let rows = self.t.iter().zip(&self.value);
        let inside = rows.filter(|(t, _)| **t > low && **t < high);
        inside.fold(Bounds::of(&[held(low), held(high)]), |b, (_, v)| {
            b.union(Bounds::at(*v))
        })
    }
}

impl Curve {
    /// Bounds of the values that are taken between the least and the greatest arguments.
    ///
    /// ```
    /// use run::property::{Arguments, Formula, Property};
    /// let pulse = Property::Formula(Formula { expr: "exp(-((t - 3)/1e-6)^2)".to_owned() });
    /// let curve = pulse.compile("/pulse", &["t"]).unwrap();
    /// let [low, high] = [0.0, 10.0].map(|t| Arguments::at([0.0; 3], t));
    /// assert_eq!(curve.bounds(&low, &high).high, 1.0);
    /// ```
    #[must_use]
    pub fn bounds(&self, low: &Arguments, high: &Arguments) -> Bounds {
        match self {
            Self::Constant(value) => Bounds::at(*value),
            Self::Table(rows) => rows.bounds(low.temperature, high.temperature),
            Self::Formula(expression) => expression.bounds(low, high),
        }
    }

    /// Whether it depends on the variable of that name (x, y, z, r, T, t, ...).
    #[must_use]
    pub fn depends_on(&self, name: &str) -> bool {
        match self {
            Self::Constant(_) => false,
            Self::Table(_) => name == "T",
            Self::Formula(expression) => expression.uses(name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FORMULAS: [&str; 16] = [
        "exp(-((t - 1)/0.1)^2)",
        "if(t - 1, if(1.1 - t, 1e7, 0), 0)",
        "step(t - 1)*step(1.5 - t) + sign(t - 2)",
        "sin(3*t)*cos(t) - tan(0.2*t)",
        "abs(t - 1.3) + fract(2*t) + mod(t, 0.7)",
        "min(t, 1) + max(2*t, x) + hypot(t - 1, x)",
        "t^3 - 2*t^2 + t^-1 + 2^t + (t + 1)^1.5",
        "ln(1 + t)/(2 + sin(5*t)) - sqrt(t)",
        "atan2(t - 1, x - 1) + atan(t)",
        "floor(3*t) + ceil(t) - round(2*t)",
        "cosh(t - 1) - sinh(t) + tanh(t)",
        "asin(0.2*t) + acos(0.3*t)",
        "-(t - 1)^2 + (x - 2)^-2",
        "x*t*(1 - t)*cbrt(t - 1)",
        "log10(t + 0.1) - 3",
        "1/(t - 1)",
    ];

    #[test]
    fn no_value_is_out_of_its_bounds() {
        for text in FORMULAS {
            let expression = Expression::parse(text, &["x", "t"]).unwrap();
            for (from, long) in [(0.0, 3.0), (0.5, 1.0), (0.99, 0.02), (1.0, 0.0), (2.0, 0.3)] {
                let at = |s: f64, q: f64| Arguments::at([0.5 + 2.0 * q, 0.0, 0.0], from + s * long);
                let bounds = expression.bounds(&at(0.0, 0.0), &at(1.0, 1.0));
                for n in 0..=60 {
                    let value =
                        expression.value(&at(f64::from(n) / 60.0, f64::from(n * 7 % 61) / 61.0));
                    let spare = 1e-12 * value.abs();
                    assert!(
                        value.is_nan()
                            || (bounds.low - spare <= value && value <= bounds.high + spare),
                        "{text} from {from} over {long}: {value} of {bounds:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn bounds_become_tight() {
        for text in &FORMULAS[..15] {
            let expression = Expression::parse(text, &["x", "t"]).unwrap();
            let [low, high] = [1.7, 1.7 + 1e-9].map(|t| Arguments::at([0.3, 0.0, 0.0], t));
            let width = expression.bounds(&low, &high).width();
            assert!(width < 1e-6, "{text}: {width}");
        }
    }
}
