//! Weights with which heat passes from point to point.
//!
//! Both operators have the pair form: with conductivity `k_ij` along the link of points i and j,
//!
//! ```text
//! div(k grad T)_i V_i = sum_j a_ij k_ij (T_j - T_i) + heat through the patches of i
//! ```
//!
//! and `a_ij = a_ji`, so that what leaves one point arrives at the other. They differ in the weights:
//! - [`kernel`]: the second term of Rong and Kisu (2010), eq. 3, which alone is the divergence of the heat flux
//!   (errata), `a_ij = 2 V_i V_j F_ij` with `F = -(dW/dr)/r`. On a plain lattice they are exact for linear fields
//!   up to the surface as long as no link reaches past the next but one point (smoothing 1).
//! - [`balance`]: these, each times a positive factor, such that linear fields are exact at every point of every
//!   cloud and up to the boundary, and quadratic ones nearly so.

pub mod balance;
mod basis;
mod corner;
pub mod kernel;
mod net;

use std::sync::Arc;

use krylov::Pattern;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::cloud::Cloud;
use shapes::frame::Vector;

pub use balance::Balance;

/// The pair form of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pair {
    /// Smoothing length over spacing; when it is absent 1.0 on plain lattices, elsewhere 1.075 in a
    /// plane and 1.05 in space.
    #[schemars(range(min = 0.6, max = 3.0), extend("x-unit" = "1"))]
    pub smoothing: Option<f64>,
}

/// The balanced pair form.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Corrected {
    /// Smoothing length over spacing; when it is absent 1.0 on plain lattices, elsewhere 1.075 in a
    /// plane and 1.05 in space.
    #[schemars(range(min = 0.8, max = 3.0), extend("x-unit" = "1"))]
    pub smoothing: Option<f64>,
}

/// How the divergence of the heat flux is formed.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Operator {
    /// The pair form of Rong and Kisu (2010), eq. 3, with the errata: kernel weights as they are.
    Pair(Pair),
    /// Kernel weights corrected pair by pair, so that linear fields are exact on every cloud and up to the
    /// boundary; heat passes from point to point without loss.
    Corrected(Corrected),
}

impl Default for Operator {
    fn default() -> Self {
        Self::Corrected(Corrected::default())
    }
}

/// Links between points, symmetric.
#[derive(Debug, Clone, PartialEq)]
pub struct Links {
    /// Which points each point is linked with.
    pub pattern: Arc<Pattern>,
    /// Weight of each link \[m^(D-2)\], in the order of the pattern.
    pub weight: Vec<f64>,
    /// Volume of each point \[m3; m2 in a plane scene\].
    pub volume: Vec<f64>,
    /// How the weights were balanced; none of the plain pair form.
    pub balance: Option<Balance>,
}

/// Why weights cannot be had.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OperatorError {
    /// A point has no neighbour.
    #[error("the point at ({}, {}, {}) m has no neighbour within the support of the kernel; a greater \"smoothing\" reaches further", .0[0], .0[1], .0[2])]
    Alone(Vector),
    /// No positive weights are exact.
    #[error(
        "the weights about ({}, {}, {}) m cannot be balanced: linear fields err by {residual:.1e} there; points \
         are missing on one side of it, or the support is too small (\"smoothing\")", place[0], place[1], place[2]
    )]
    Unbalanced {
        /// Where.
        place: Vector,
        /// Error of the gradient of a linear field, relative.
        residual: f64,
    },
}

/// Smoothing length over spacing of clouds that are no plain lattice, in a plane and in space. Long links blur (with
/// 1.2 in a plane the flux between two slabs errs by a half more), short ones are too few to meet the second
/// moments wherever points lie unevenly (with 1.0 a smooth field can err by ten times that of 1.1).
const SMOOTHING: [f64; 2] = [1.075, 1.05];
/// Smoothing length over spacing of plain lattices: all points at less than two spacings are linked.
const LATTICE: f64 = 1.0;

/// Factors of the smoothing length that are tried in turn where the usual one has no balanced weights.
const WIDER: [f64; 3] = [1.15, 1.3, 1.5];

fn usual_smoothing(cloud: &Cloud) -> f64 {
    if cloud.lattice {
        LATTICE
    } else {
        SMOOTHING[cloud.dimensions - 2]
    }
}

impl Links {
    /// The links of a cloud.
    ///
    /// # Errors
    /// [`OperatorError`].
    pub fn new(cloud: &Cloud, operator: Operator) -> Result<Self, OperatorError> {
        match operator {
            Operator::Pair(pair) => {
                let smoothing = pair.smoothing.unwrap_or_else(|| usual_smoothing(cloud));
                let (pattern, weight) = kernel::pair(cloud, smoothing)?;
                Ok(Self {
                    pattern,
                    weight,
                    volume: cloud.share.clone(),
                    balance: None,
                })
            }
            Operator::Corrected(Corrected {
                smoothing: Some(smoothing),
            }) => Self::balanced(cloud, smoothing),
            Operator::Corrected(_) => {
                let usual = usual_smoothing(cloud);
                // Few layers or a sudden change of spacing may want more links than is usual.
                let mut found = Self::balanced(cloud, usual);
                for wider in WIDER {
                    if !matches!(found, Err(OperatorError::Unbalanced { .. })) {
                        break;
                    }
                    found = Self::balanced(cloud, wider * usual);
                }
                found
            }
        }
    }

    /// Balanced links of the given smoothing length over spacing.
    fn balanced(cloud: &Cloud, smoothing: f64) -> Result<Self, OperatorError> {
        let (pattern, mut weight) = kernel::pair(cloud, smoothing)?;
        if cloud.lattice && smoothing <= LATTICE {
            corner::straighten(cloud, &pattern, &mut weight);
        }
        balance::balanced(cloud, pattern, weight)
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.volume.len()
    }

    /// True without points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.volume.is_empty()
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        let links = self.weight.len() as u64;
        (8 + 4) * links + 16 * self.volume.len() as u64
    }
}

#[cfg(test)]
mod tests;
