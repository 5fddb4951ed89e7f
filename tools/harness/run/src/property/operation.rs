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
    Call1(fn(f64) -> f64),
    Call2(fn(f64, f64) -> f64),
    Choose,
}

pub(super) const VARIABLES: [&str; 8] = ["x", "y", "z", "r", "T", "t", "Y", "B"];
pub(super) const CONSTANTS: [(&str, f64); 2] =
    [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];
pub(super) type Function1 = (&'static str, fn(f64) -> f64);
pub(super) type Function2 = (&'static str, fn(f64, f64) -> f64);
pub(super) const ONE: [Function1; 21] = [
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("log10", f64::log10),
    ("sqrt", f64::sqrt),
    ("cbrt", f64::cbrt),
    ("abs", f64::abs),
    ("sign", |x| {
        if x > 0.0 {
            1.0
        } else if x < 0.0 {
            -1.0
        } else {
            0.0
        }
    }),
    ("step", |x| if x >= 0.0 { 1.0 } else { 0.0 }),
    ("floor", f64::floor),
    ("ceil", f64::ceil),
    ("round", f64::round),
    ("fract", |x| x - x.floor()),
];
pub(super) const TWO: [Function2; 5] = [
    ("min", f64::min),
    ("max", f64::max),
    ("atan2", f64::atan2),
    ("hypot", f64::hypot),
    ("mod", f64::rem_euclid),
];
