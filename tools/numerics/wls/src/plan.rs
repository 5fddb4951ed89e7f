//! What stencils are to be made of.

use crate::basis::{HIGHEST, terms};
use crate::error::Error;
use crate::functional::{Condition, Wants};
use crate::search::Reach;

/// Radius of a support in spacings: r_e of (2.1), Matsuzawa (2017).
const RADIUS: f64 = 2.5;
/// Points of a support per monomial, for orders 3 and 4.
const POINTS_PER_TERM: f64 = 2.3;

/// Order, support and operators of a set of stencils.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// Total degree p of the polynomials, 1 to 4: the value is exact to order p + 1 of the spacing,
    /// the gradient to p, the Laplacian to p - 1.
    pub order: u8,
    /// How far the support of a point reaches.
    pub reach: Reach,
    /// Operators whose weights are kept.
    pub wants: Wants,
    /// Make the Laplacian's weights of other points nonnegative, where they are not and where the
    /// support allows it. All operators but the Laplacian stay as they are.
    pub positive: bool,
    /// The fit passes through the point's own value.
    pub interpolating: bool,
    /// Points weigh by the room that each has, where no layers are near: those of a fine lattice beside a coarse one no more
    /// than their share.
    pub by_room: bool,
}

impl Plan {
    /// A plan of order `order` in `D` dimensions with the usual support: 2.5 spacings for orders 1
    /// and 2, the nearest 2.3 points per monomial for orders 3 and 4.
    #[must_use]
    pub fn new<const D: usize>(order: u8, wants: Wants) -> Self {
        let reach = if order <= 2 {
            Reach::Radius(RADIUS)
        } else {
            let count = POINTS_PER_TERM * terms::<D>(order.min(HIGHEST)) as f64;
            Reach::Nearest(count.ceil() as usize + 1)
        };
        Self {
            order,
            reach,
            wants,
            positive: false,
            interpolating: false,
            by_room: false,
        }
    }

    /// The lowest order that has the operators that are wanted.
    pub(crate) fn lowest(&self) -> u8 {
        if self.wants.hessian || self.wants.laplacian {
            2
        } else {
            1
        }
    }

    pub(crate) fn check<const D: usize>(&self) -> Result<(), Error> {
        let wants = self.wants;
        let reach = match self.reach {
            Reach::Radius(radius) => radius > 0.0 && radius < 16.0,
            Reach::Nearest(count) => count > D && count < 1024,
        };
        let reason = if D != 2 && D != 3 {
            "there are fits in two and in three dimensions only"
        } else if self.order < 1 || self.order > HIGHEST {
            "an order is 1, 2, 3 or 4"
        } else if self.order < self.lowest() {
            "second derivatives need order 2"
        } else if !reach {
            "a support has a radius of 0 to 16 spacings, or D + 1 to 1023 points"
        } else if !(wants.value || wants.gradient || wants.hessian || wants.laplacian) {
            "no operator is wanted"
        } else if self.positive && !wants.laplacian {
            "positive weights are those of the Laplacian, which is not wanted"
        } else {
            return Ok(());
        };
        Err(Error::BadPlan {
            order: self.order,
            reason,
        })
    }
}

/// Which rows are made, from which points, under which conditions.
///
/// A closure of (row, point) is a rule on the points of supports:
///
/// ```
/// use wls::Rules;
/// let side = [true, true, false];
/// let rules = |i: usize, j: usize| side[i] == side[j];
/// assert!(!Rules::<3>::allowed(&rules, 0, 2));
/// assert!(Rules::<3>::wanted(&rules, 0));
/// ```
pub trait Rules<const D: usize>: Sync {
    /// Whether row `i` is made.
    fn wanted(&self, i: usize) -> bool {
        let _ = i;
        true
    }

    /// Whether point `j` may stand in row `i`; a point may always stand in its own.
    fn allowed(&self, i: usize, j: usize) -> bool {
        let _ = (i, j);
        true
    }

    /// The direction in which the points of row `i` lie, if it is one-sided: its derivative that way should be a
    /// difference to the own point, not lean on it with the sign of the others.
    fn side(&self, i: usize) -> Option<[f64; D]> {
        let _ = i;
        None
    }

    /// Whether weights of the Laplacian of row `i` may have to be made positive. On the hull of its points none are: a weighted
    /// mean of places on one side is no place on the edge.
    fn surrounded(&self, i: usize) -> bool {
        let _ = i;
        true
    }

    /// Pushes the conditions that the fit of row `i` obeys.
    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<D>>) {
        let _ = (i, conditions);
    }
}

/// Every row, from every point, without conditions.
#[derive(Debug, Clone, Copy, Default)]
pub struct Everything;

impl<const D: usize> Rules<D> for Everything {}

impl<const D: usize, F: Fn(usize, usize) -> bool + Sync> Rules<D> for F {
    fn allowed(&self, i: usize, j: usize) -> bool {
        self(i, j)
    }
}
