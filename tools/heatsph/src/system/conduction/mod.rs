//! Conductance of links, in the cheapest form that the materials allow.

mod edges;
mod mixture;
mod series;

use std::ops::Range;

use run::property::OutOfRange;

use crate::material::{Law, Materials};
use crate::operator::Links;
use crate::operator::kernel::rows;
use mixture::Mixture;
use series::Series;
use shapes::frame::Vector;

/// Temperatures nearer than this part have the mean of their conductivities.
const NEAR: f64 = 1e-6;

/// How links conduct.
#[derive(Debug, Clone, PartialEq)]
pub enum Conduction {
    /// Conductivity depends on place alone: each link has its conductance \[W/K\].
    Fixed(Vec<f64>),
    /// One function of temperature for the whole body: Kirchhoff's transform at the points is all.
    Kirchhoff {
        /// Number of the function.
        conductor: usize,
        /// Its factor.
        fraction: f64,
    },
    /// One function of temperature, of which each material has its share.
    Mixture(Mixture),
    /// Anything else.
    Series(Series),
}

/// Conductivity and its integral at a point, for each function of temperature.
pub type Node = (f64, f64);

impl Conduction {
    /// The links of points in the materials.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn new(
        materials: &Materials,
        position: &[Vector],
        links: &Links,
    ) -> Result<Self, OutOfRange> {
        if !materials.nonlinear() {
            return Self::fixed(materials, position, links);
        }
        if let (1, Law::Sum(parts)) = (materials.len(), materials.law(0))
            && let [part] = parts.as_slice()
            && let Some(fraction) = part.fraction.constant()
        {
            return Ok(Self::Kirchhoff {
                conductor: part.conductor,
                fraction,
            });
        }
        match mixture::sole(materials) {
            Some(conductor) => {
                Mixture::new(conductor, materials, position, links).map(Self::Mixture)
            }
            None => Series::new(materials, position, links).map(Self::Series),
        }
    }

    fn fixed(
        materials: &Materials,
        position: &[Vector],
        links: &Links,
    ) -> Result<Self, OutOfRange> {
        let mut conductance = links.weight.clone();
        rows(&links.pattern, &mut conductance, |i, columns, row| {
            for (a, j) in row.iter_mut().zip(columns) {
                // The same order of ends for both directions gives the same bits.
                let (low, high) = (i.min(*j as usize), i.max(*j as usize));
                let k = materials.fixed(position[low], position[high]);
                *a *= k.unwrap_or(f64::NAN);
            }
        });
        match conductance.iter().position(|g| g.is_nan()) {
            None => Ok(Self::Fixed(conductance)),
            Some(link) => {
                let i = links.pattern.offsets().partition_point(|o| *o <= link) - 1;
                let j = links.pattern.columns()[link] as usize;
                materials.fixed(position[i.min(j)], position[i.max(j)])?;
                Ok(Self::Fixed(conductance))
            }
        }
    }

    /// Whether conductances are the same at all temperatures.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        matches!(self, Self::Fixed(_))
    }

    /// Whether the matrix of a Newton step is symmetric, or is so with Kirchhoff's transform as the unknown.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        matches!(self, Self::Fixed(_) | Self::Kirchhoff { .. })
    }

    /// Numbers of the undirected links of a row, where both ends share what is reckoned of them.
    #[inline]
    pub(super) fn edges_of(&self, row: Range<usize>) -> &[u32] {
        match self {
            Self::Fixed(_) | Self::Kirchhoff { .. } => &[],
            Self::Mixture(mixture) => mixture.edges.of(row),
            Self::Series(series) => series.edges.of(row),
        }
    }

    /// Mean conductivity of every undirected link \[W/(m K)\].
    pub(super) fn means<'a>(
        &self,
        ends: impl Fn([u32; 2]) -> Ends<'a> + Sync,
        means: &mut Vec<f64>,
    ) {
        match self {
            Self::Fixed(_) | Self::Kirchhoff { .. } => means.clear(),
            Self::Mixture(mixture) => {
                let mean = |edge, between| mixture.mean(edge, &ends(between));
                mixture.edges.each(means, mean);
            }
            Self::Series(series) => {
                let mean = |edge, between| series.mean(edge, &ends(between));
                series.edges.each(means, mean);
            }
        }
    }

    /// How the heat through every undirected link of unit weight depends on the temperatures of its ends
    /// \[W/(m K)\], by that of the lower end with the sign turned.
    pub(super) fn slopes<'a>(
        &self,
        ends: impl Fn([u32; 2]) -> Ends<'a> + Sync,
        means: &[f64],
    ) -> Vec<[f64; 2]> {
        let mut slopes = Vec::new();
        match self {
            Self::Fixed(_) | Self::Kirchhoff { .. } => {}
            Self::Mixture(mixture) => mixture.edges.each(&mut slopes, |edge, between| {
                mixture.slopes(edge, &ends(between), means[edge])
            }),
            Self::Series(series) => series.edges.each(&mut slopes, |edge, between| {
                series.slopes(edge, &ends(between), means[edge])
            }),
        }
        slopes
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Fixed(g) => 8 * g.len() as u64,
            Self::Kirchhoff { .. } => 0,
            Self::Mixture(mixture) => mixture.bytes(),
            Self::Series(series) => series.bytes(),
        }
    }
}

/// What a link is evaluated with.
#[derive(Clone, Copy)]
pub struct Ends<'a> {
    /// Temperatures of the own and the other end \[K\].
    pub temperature: [f64; 2],
    /// Values of all functions of temperature at both ends.
    pub nodes: [&'a [Node]; 2],
    /// Difference of temperatures below which they are equal \[K\]: near 0 K none is small beside the temperatures.
    pub blur: f64,
}

impl Ends<'_> {
    /// One over the difference of temperatures; none where they are equal but for rounding.
    #[inline]
    fn inverse(&self) -> Option<f64> {
        let [a, b] = self.temperature;
        ((b - a).abs() > NEAR * (a.abs() + b.abs()) + self.blur).then(|| 1.0 / (b - a))
    }

    /// Mean of a function of temperature between the ends.
    #[inline]
    fn mean(&self, conductor: usize, inverse: Option<f64>) -> f64 {
        let ((ka, ia), (kb, ib)) = (self.nodes[0][conductor], self.nodes[1][conductor]);
        inverse.map_or(0.5 * (ka + kb), |inverse| (ib - ia) * inverse)
    }
}

/// Conductance of a link of weight `a` under one function of temperature, over the weight \[W/(m K)\].
#[inline]
#[must_use]
pub fn kirchhoff(ends: &Ends<'_>, conductor: usize) -> f64 {
    ends.mean(conductor, ends.inverse())
}
