//! What can be wrong with a cloud.

/// Why stencils cannot be made; the place is told in \[m\].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// Two points share a place.
    #[error(
        "points {a} and {b} coincide at {place:?} m: their distance is {distance:.3e} m, below {least:.3e} m"
    )]
    Coincident {
        /// One point.
        a: usize,
        /// The other.
        b: usize,
        /// Where \[m\].
        place: Vec<f64>,
        /// How far apart \[m\].
        distance: f64,
        /// How far apart points must be \[m\].
        least: f64,
    },
    /// A point has too few neighbours.
    #[error(
        "point {point} at {place:?} m is alone: {found} points that may serve it lie within {radius:.3e} m, {needed} are needed"
    )]
    Lone {
        /// The point.
        point: usize,
        /// Where \[m\].
        place: Vec<f64>,
        /// Points found, its own included.
        found: usize,
        /// Points needed for the lowest order that serves.
        needed: usize,
        /// Distance of the search \[m\].
        radius: f64,
    },
    /// The neighbours of a point lie in a plane, on a line, or on a curve of low degree.
    #[error(
        "point {point} at {place:?} m: its {found} neighbours lie so (in a plane, on a line, on a surface of low degree) that no fit of order {order} has the derivatives asked for (condition {condition:.1e})"
    )]
    Flat {
        /// The point.
        point: usize,
        /// Where \[m\].
        place: Vec<f64>,
        /// Points in the support, its own included.
        found: usize,
        /// Lowest order that was tried.
        order: u8,
        /// Condition number of its fit.
        condition: f64,
    },
    /// A coordinate is no number.
    #[error("point {point} has the place {place:?} m, which is no place")]
    NotFinite {
        /// The point.
        point: usize,
        /// Its coordinates \[m\].
        place: Vec<f64>,
    },
    /// A spacing is not positive.
    #[error("point {point} has the spacing {spacing:e} m, which must be positive")]
    BadSpacing {
        /// The point.
        point: usize,
        /// Its spacing \[m\].
        spacing: f64,
    },
    /// Points and spacings do not belong together, or there are none.
    #[error("{points} points have {metrics} spacings")]
    BadCloud {
        /// Number of points.
        points: usize,
        /// Number of metrics.
        metrics: usize,
    },
    /// A plan that cannot be carried out.
    #[error("a plan of order {order}: {reason}")]
    BadPlan {
        /// Order asked for.
        order: u8,
        /// What is wrong.
        reason: &'static str,
    },
}
