//! Weights of a whole cloud, as operators.

use std::ops::{Add, Mul};

use rayon::prelude::*;

use crate::functional::Columns;
use crate::report::Report;

/// What weights can act on: numbers, complex numbers, vectors.
pub trait Field: Copy + Default + Add<Output = Self> + Mul<f64, Output = Self> {}

impl<T: Copy + Default + Add<Output = Self> + Mul<f64, Output = Self>> Field for T {}

/// The weights of one operator at one point.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    /// Points, the own one included.
    pub neighbours: &'a [u32],
    /// Their weights, to be multiplied by `factor`.
    pub weights: &'a [f64],
    /// Power of the inverse spacing \[1, 1/m or 1/m2\].
    pub factor: f64,
    shares: &'a [f64],
}

impl<'a> Row<'a> {
    /// Points and their weights.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (usize, f64)> + 'a {
        let factor = self.factor;
        self.neighbours
            .iter()
            .zip(self.weights)
            .map(move |(&j, w)| (j as usize, factor * w))
    }

    /// The operator on a field that is given point by point.
    pub fn apply_with<T: Field>(&self, field: impl Fn(usize) -> T) -> T {
        let mut sum = T::default();
        for (&j, &weight) in self.neighbours.iter().zip(self.weights) {
            sum = sum + field(j as usize) * weight;
        }
        sum * self.factor
    }

    /// The operator on a field with a value per point of the cloud.
    #[must_use]
    pub fn apply<T: Field>(&self, field: &[T]) -> T {
        self.apply_with(|j| field[j])
    }

    /// Weight of point `i`; 0 where it does not stand in the row.
    #[must_use]
    pub fn own(&self, i: usize) -> f64 {
        let all = self.iter().filter(|(j, _)| *j == i);
        all.map(|(_, w)| w).sum()
    }

    /// Weights of the data of the conditions that the row obeys, in their order.
    pub fn conditions(&self) -> impl ExactSizeIterator<Item = f64> + 'a {
        let factor = self.factor;
        self.shares.iter().map(move |w| factor * w)
    }
}

/// Where a row stands in the arrays of [`Stencils`].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Spot {
    /// First neighbour.
    pub(crate) start: usize,
    /// Number of neighbours.
    pub(crate) count: u32,
    /// Number of data of conditions.
    pub(crate) shares: u32,
    /// First weight: operators one after another, then the data's weights, likewise.
    pub(crate) weights: usize,
    pub(crate) inverse_spacing: f64,
    pub(crate) order: u8,
}

/// Weights of the operators wanted at all points of a cloud, or at places.
///
/// All operators of a row share its neighbours; rows with equal supports share weights, which are
/// kept in units of the spacing.
#[derive(Debug, Clone)]
pub struct Stencils<const D: usize> {
    pub(crate) spots: Vec<Spot>,
    pub(crate) neighbours: Vec<u32>,
    pub(crate) weights: Vec<f64>,
    pub(crate) columns: Columns,
    pub(crate) report: Report,
}

impl<const D: usize> Stencils<D> {
    /// The same where point `j` carries the value of point `origin[j]`, as an image beyond a plane of symmetry does;
    /// a row may then have a point more than once. Points that stand for themselves come first, and their rows stay.
    #[must_use]
    pub fn folded(mut self, origin: &[u32]) -> Self {
        let own = |&(i, o): &(usize, &u32)| i == *o as usize;
        let rows = origin.iter().enumerate().take_while(own).count();
        self.spots.truncate(rows);
        for j in &mut self.neighbours {
            *j = origin[*j as usize];
        }
        self
    }

    /// Number of rows, empty ones included.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.spots.len()
    }

    /// Neighbours of row `i`, its own point included, in an order that depends on their offsets.
    #[must_use]
    pub fn neighbours(&self, i: usize) -> &[u32] {
        let spot = &self.spots[i];
        &self.neighbours[spot.start..spot.start + spot.count as usize]
    }

    /// Order of the fit of row `i`; 0 where there is no row.
    #[must_use]
    pub fn order(&self, i: usize) -> u8 {
        self.spots[i].order
    }

    /// What became of the rows.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// The value of the fit.
    ///
    /// # Panics
    /// Where it was not wanted, as all operators do.
    #[must_use]
    pub fn value(&self, i: usize) -> Row<'_> {
        self.row(i, wanted(self.columns.value, "the value"), 0)
    }

    /// The derivative along `axis`.
    #[must_use]
    pub fn derivative(&self, i: usize, axis: usize) -> Row<'_> {
        self.row(i, wanted(self.columns.gradient, "the gradient") + axis, 1)
    }

    /// The second derivative along axes `a` and `b`.
    #[must_use]
    pub fn second(&self, i: usize, a: usize, b: usize) -> Row<'_> {
        let first = wanted(self.columns.hessian, "second derivatives");
        self.row(i, first + Columns::pair::<D>(a, b), 2)
    }

    /// The Laplacian.
    #[must_use]
    pub fn laplacian(&self, i: usize) -> Row<'_> {
        self.row(i, wanted(self.columns.laplacian, "the Laplacian"), 2)
    }

    /// Gradient of `field` at row `i`.
    #[must_use]
    pub fn gradient_of<T: Field>(&self, field: &[T], i: usize) -> [T; D] {
        std::array::from_fn(|axis| self.derivative(i, axis).apply(field))
    }

    /// Gradients of `field` at all rows; zero where there is no row.
    #[must_use]
    pub fn apply_gradient<T: Field + Send + Sync>(&self, field: &[T]) -> Vec<[T; D]> {
        let rows = 0..self.rows();
        rows.into_par_iter()
            .map(|i| self.gradient_of(field, i))
            .collect()
    }

    fn row(&self, i: usize, column: usize, power: i32) -> Row<'_> {
        let spot = &self.spots[i];
        let (count, shares) = (spot.count as usize, spot.shares as usize);
        let start = spot.weights + column * count;
        let share = spot.weights + self.columns.count * count + column * shares;
        Row {
            neighbours: self.neighbours(i),
            weights: &self.weights[start..start + count],
            factor: spot.inverse_spacing.powi(power),
            shares: &self.weights[share..share + shares],
        }
    }
}

/// The first column of an operator.
#[track_caller]
fn wanted(column: Option<usize>, name: &str) -> usize {
    assert!(column.is_some(), "{name} was not among what the plan wants");
    column.unwrap_or(0)
}
