//! Weighted least squares stencils on scattered points.
//!
//! The field u near a point is taken for a polynomial of total degree p in the offsets from it, and
//! the coefficients are those that minimise
//!
//! Q = sum_j w_j (p(s_j)^T a - u_j)^2        (2.15), Matsuzawa (2017), where the `a` is missing
//!
//! over the points of a support, with the weight w = 1 - 6 q^2 + 8 q^3 - 3 q^4 (2.4) of the distance
//! q in units of the support's radius. Value and derivatives of the polynomial at the point are then
//! sums of the u_j with weights that depend on the places alone: the operators.
//!
//! domain ([`Cloud`], [`Metric`]) -> support ([`Reach`], [`Rules`]) -> weights ([`Plan`]) ->
//! operators ([`Stencils`], [`Row`]), which act on known fields or become the rows of a matrix.
//!
//! A fit of order p is exact for polynomials of degree p; on smooth fields the error of the value is
//! of order p + 1 in the spacing, of the gradient p, of second derivatives p - 1, and one better
//! each where the support is symmetric. All sums go in an order that depends on the places alone:
//! results are the same to the bit for any number of threads.
//!
//! Where the points of a support do not determine the polynomial, or determine it so poorly that the
//! weights add up to several times the usual, the support is enlarged; where that does not help, singular values tell whether the wanted operators are determined all the
//! same; and then the order is lowered. [`Report`] counts what happened.
//!
//! ```
//! use wls::{Cloud, Everything, Metric, Plan, Search, Stencils, Wants};
//! // A plane lattice of spacing 0.1 with the field x^2 + 3 y.
//! let points: Vec<[f64; 2]> = (0..100).map(|k| [0.1 * (k % 10) as f64, 0.1 * (k / 10) as f64]).collect();
//! let metrics = vec![Metric::round(0.1); points.len()];
//! let search = Search::new(Cloud { points: &points, metrics: &metrics })?;
//! let plan = Plan::new::<2>(2, Wants { gradient: true, laplacian: true, ..Wants::default() });
//! let stencils = Stencils::build(&search, &plan, &Everything)?;
//! let field: Vec<f64> = points.iter().map(|p| p[0] * p[0] + 3.0 * p[1]).collect();
//! assert!((stencils.laplacian(0).apply(&field) - 2.0).abs() < 1e-10);
//! assert!((stencils.gradient_of(&field, 99)[1] - 3.0).abs() < 1e-11);
//! # Ok::<(), wls::Error>(())
//! ```

mod basis;
mod bench;
mod error;
mod factor;
mod fit;
mod functional;
mod harmonic;
mod judge;
mod ladder;
mod load;
mod memo;
mod metric;
mod moments;
mod moved;
mod plan;
mod positive;
mod report;
mod search;
mod stencils;
mod supports;
mod sweep;
mod weight;

pub use basis::{HIGHEST, terms};
pub use error::Error;
pub use functional::{Condition, Wants};
pub use metric::Metric;
pub use moved::Moved;
pub use plan::{Everything, Plan, Rules};
pub use report::Report;
pub use search::{Cloud, Reach, Search};
pub use stencils::{Field, Row, Stencils};
pub use weight::quartic;
