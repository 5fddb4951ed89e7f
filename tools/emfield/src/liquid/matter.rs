//! What a liquid is made of, and how its steps are taken.

use krylov::Rule;

/// What the liquid is made of and what acts on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matter<const D: usize> {
    /// Density \[kg/m3\].
    pub density: f64,
    /// Viscosity \[Pa s\]; none where it is absent.
    pub viscosity: Option<f64>,
    /// Surface tension \[N/m\].
    pub tension: f64,
    /// Pressure of the gas around \[Pa\].
    pub gas: f64,
    /// Acceleration of gravity \[m/s2\].
    pub gravity: [f64; D],
}

/// Residual of solves of fields over that of the liquid's. With 1e-9 of these the force on a levitated drop of 34,000 points of
/// the field changes by 1e-6.
const FIELDS: f64 = 1e3;

/// How steps are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way {
    /// Distance of points \[m\].
    pub spacing: f64,
    /// Degree of the fits.
    pub order: u8,
    /// Residual of solves.
    pub tolerance: f64,
    /// Most products of a solve.
    pub products: usize,
}

impl Way {
    /// When solves end.
    #[must_use]
    pub fn rule(&self) -> Rule<'static> {
        Rule {
            reduction: self.tolerance,
            products: self.products,
            ..Rule::default()
        }
    }

    /// When those of fields end: what they leave is far below what stencils err by.
    #[must_use]
    pub fn of_fields(&self) -> Rule<'static> {
        Rule {
            reduction: FIELDS * self.tolerance,
            ..self.rule()
        }
    }
}

/// A step in time.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// How it is made.
    pub way: &'a Way,
    /// How long it is \[s\].
    pub dt: f64,
}
