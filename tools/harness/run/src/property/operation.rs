//! What a formula may say: operations, variables, constants and functions.

/// Deepest stack of a formula.
pub(super) const DEPTH: usize = 32;

#[derive(Debug, Clone, Copy)]
pub(super) enum Operation {
    Number(f64),
    Variable(usize),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Call1(fn(f64) -> f64, Trend),
    Call2(fn(f64, f64) -> f64, Trend2),
    Choose,
}

/// How a function of one argument runs, for its bounds.
#[derive(Debug, Clone, Copy)]
pub(super) enum Trend {
    /// Never falling, or never rising.
    Monotone,
    /// The same at `-x`, and monotone from zero on.
    Even,
    /// Between -1 and 1, with a crest here and at every whole turn from it.
    Wave(f64),
    /// Rising between poles at the odd multiples of a quarter turn.
    Poles,
    /// Rising from 0 to 1 between whole numbers.
    Saw,
}

/// How a function of two arguments runs.
#[derive(Debug, Clone, Copy)]
pub(super) enum Trend2 {
    /// Monotone in each.
    Monotone,
    /// The same with either sign of each, and monotone from zero on.
    Even,
    /// The angle of the point (second, first).
    Angle,
    /// The rest of the first over the second.
    Saw,
}

pub(super) const VARIABLES: [&str; 8] = ["x", "y", "z", "r", "T", "t", "Y", "B"];
pub(super) const CONSTANTS: [(&str, f64); 2] =
    [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];
pub(super) type Function1 = (&'static str, fn(f64) -> f64, Trend);
pub(super) type Function2 = (&'static str, fn(f64, f64) -> f64, Trend2);
pub(super) const ONE: [Function1; 21] = [
    ("sin", f64::sin, Trend::Wave(0.5 * std::f64::consts::PI)),
    ("cos", f64::cos, Trend::Wave(0.0)),
    ("tan", f64::tan, Trend::Poles),
    ("asin", f64::asin, Trend::Monotone),
    ("acos", f64::acos, Trend::Monotone),
    ("atan", f64::atan, Trend::Monotone),
    ("sinh", f64::sinh, Trend::Monotone),
    ("cosh", f64::cosh, Trend::Even),
    ("tanh", f64::tanh, Trend::Monotone),
    ("exp", f64::exp, Trend::Monotone),
    ("ln", f64::ln, Trend::Monotone),
    ("log10", f64::log10, Trend::Monotone),
    ("sqrt", f64::sqrt, Trend::Monotone),
    ("cbrt", f64::cbrt, Trend::Monotone),
    ("abs", f64::abs, Trend::Even),
    (
        "sign",
        |x| {
            if x > 0.0 {
                1.0
            } else if x < 0.0 {
                -1.0
            } else {
                0.0
            }
        },
        Trend::Monotone,
    ),
    (
        "step",
        |x| if x >= 0.0 { 1.0 } else { 0.0 },
        Trend::Monotone,
    ),
    ("floor", f64::floor, Trend::Monotone),
    ("ceil", f64::ceil, Trend::Monotone),
    ("round", f64::round, Trend::Monotone),
    ("fract", |x| x - x.floor(), Trend::Saw),
];
pub(super) const TWO: [Function2; 5] = [
    ("min", f64::min, Trend2::Monotone),
    ("max", f64::max, Trend2::Monotone),
    ("atan2", f64::atan2, Trend2::Angle),
    ("hypot", f64::hypot, Trend2::Even),
    ("mod", f64::rem_euclid, Trend2::Saw),
];
