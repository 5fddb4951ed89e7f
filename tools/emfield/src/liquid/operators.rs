//! Gradients and Laplacians at all points of the liquid, by weighted least squares.

use wls::{Cloud, Condition, Error, Metric, Plan, Rules, Search, Stencils, Wants};

use super::matter::Way;
use super::surface::Patch;

/// Points with their images behind them.
#[derive(Debug, Clone, Copy)]
pub struct Points<'a, const D: usize> {
    /// All \[m\].
    pub all: &'a [[f64; D]],
    /// Those that are no images.
    pub own: usize,
}

/// Gradient and Laplacian rows of a cloud of points with one spacing.
///
/// # Errors
/// Where points coincide or no fit has the derivatives.
pub fn operators<const D: usize>(points: &[[f64; D]], way: &Way) -> Result<Stencils<D>, Error> {
    let points = Points {
        all: points,
        own: points.len(),
    };
    derivatives(points, way, Fits::default())
}

/// Rows are made at the first of the points; the others are images.
struct First(usize);

impl<const D: usize> Rules<D> for First {
    fn wanted(&self, i: usize) -> bool {
        i < self.0
    }
}

/// What fits are like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Fits {
    /// They pass through the value of their own point: no wave of the field is then without a Laplacian.
    pub through: bool,
    /// Rows of their values are wanted too.
    pub value: bool,
}

/// The same at the first `own` of the points.
///
/// # Errors
/// As [`operators`].
pub fn derivatives<const D: usize>(
    points: Points<'_, D>,
    way: &Way,
    fits: Fits,
) -> Result<Stencils<D>, Error> {
    let wants = Wants {
        value: fits.value,
        gradient: true,
        laplacian: true,
        ..Wants::default()
    };
    made(points, way, fits.through, wants)
}

/// Fits of all derivatives at all points, through their own values, which points that go with the liquid take with them.
///
/// # Errors
/// As [`operators`].
pub fn bearing<const D: usize>(points: &[[f64; D]], way: &Way) -> Result<Stencils<D>, Error> {
    let wants = Wants {
        value: false,
        gradient: true,
        hessian: true,
        laplacian: true,
    };
    let points = Points {
        all: points,
        own: points.len(),
    };
    made(points, way, true, wants)
}

fn made<const D: usize>(
    points: Points<'_, D>,
    way: &Way,
    through: bool,
    wants: Wants,
) -> Result<Stencils<D>, Error> {
    let metrics = vec![Metric::round(way.spacing); points.all.len()];
    let search = Search::new(Cloud {
        points: points.all,
        metrics: &metrics,
    })?;
    let plan = Plan {
        interpolating: through,
        ..Plan::new::<D>(way.order, wants)
    };
    Stencils::build(&search, &plan, &First(points.own))
}

/// Values of fits that do not pass through their points, at the first `own` of them.
///
/// # Errors
/// Where points coincide.
pub fn values<const D: usize>(points: Points<'_, D>, way: &Way) -> Result<Stencils<D>, Error> {
    let metrics = vec![Metric::round(way.spacing); points.all.len()];
    let search = Search::new(Cloud {
        points: points.all,
        metrics: &metrics,
    })?;
    let wants = Wants {
        value: true,
        ..Wants::default()
    };
    let plan = Plan::new::<D>(way.order, wants);
    Stencils::build(&search, &plan, &First(points.own))
}

/// Rows at the points of a surface, which know the slope along its normal.
struct Sloped<'a, const D: usize> {
    points: &'a [[f64; D]],
    patches: &'a [Patch<D>],
}

impl<const D: usize> Rules<D> for Sloped<'_, D> {
    fn wanted(&self, i: usize) -> bool {
        i < self.patches.len()
    }

    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<D>>) {
        conditions.push(Condition::Flux {
            at: self.points[i],
            normal: self.patches[i].normal,
        });
    }
}

/// Laplacians at the points of the surface, which come first, with the slope along its normal as a datum.
///
/// # Errors
/// Where points coincide or no fit has the derivatives.
pub fn sloped<const D: usize>(
    points: &[[f64; D]],
    patches: &[Patch<D>],
    way: &Way,
    through: bool,
) -> Result<Stencils<D>, Error> {
    let metrics = vec![Metric::round(way.spacing); points.len()];
    let search = Search::new(Cloud {
        points,
        metrics: &metrics,
    })?;
    let wants = Wants {
        laplacian: true,
        ..Wants::default()
    };
    let plan = Plan {
        interpolating: through,
        ..Plan::new::<D>(way.order, wants)
    };
    Stencils::build(&search, &plan, &Sloped { points, patches })
}

/// Divergence of a velocity at point `i` \[1/s\].
#[must_use]
pub fn divergence<const D: usize>(rows: &Stencils<D>, velocity: &[[f64; D]], i: usize) -> f64 {
    (0..D)
        .map(|k| rows.derivative(i, k).apply_with(|j| velocity[j][k]))
        .sum()
}

/// `d_i u_j d_j u_i` at point `i`: what the divergence of a liquid without forces would grow by \[1/s2\].
#[must_use]
pub fn stretching<const D: usize>(rows: &Stencils<D>, velocity: &[[f64; D]], i: usize) -> f64 {
    let mut gradient = [[0.0; D]; D];
    for (a, row) in gradient.iter_mut().enumerate() {
        for (j, w) in rows.derivative(i, a).iter() {
            *row = super::vector::along(row, w, &velocity[j]);
        }
    }
    let products = (0..D).flat_map(|a| (0..D).map(move |b| (a, b)));
    products.map(|(a, b)| gradient[a][b] * gradient[b][a]).sum()
}
