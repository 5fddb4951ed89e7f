//! Conductance of links, in the cheapest form that the materials allow.

use rayon::prelude::*;
use run::property::{Curve, OutOfRange};

use crate::material::{Law, Materials, arguments};
use crate::operator::Links;
use crate::operator::kernel::rows;
use shapes::frame::Vector;

/// Temperatures nearer than this part have the mean of their conductivities.
const NEAR: f64 = 1e-6;
/// Links that one task evaluates.
const EDGES: usize = 1024;
/// Gauss' points on [0, 1].
const TWO: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];

/// A piece of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    part: f64,
    /// What does not depend on temperature \[W/(m K)\].
    constant: f64,
    material: u32,
    /// First of its fractions, or its place.
    first: u32,
}

/// The pieces of links through materials of any kind.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Number of each directed link among the undirected ones.
    edge: Vec<u32>,
    /// Points of each undirected link.
    ends: Vec<[u32; 2]>,
    /// Begin of the pieces of each undirected link.
    begin: Vec<u32>,
    contact: Vec<f64>,
    pieces: Vec<Piece>,
    fractions: Vec<f64>,
    places: Vec<Vector>,
    /// Functions of temperature of each material.
    parts: Vec<Vec<usize>>,
    formulas: Vec<Option<Curve>>,
}

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
    /// Anything else.
    Series(Series),
}

/// Conductivity and its integral at a point, for each function of temperature.
pub type Node = (f64, f64);

/// How the heat through a link depends on the temperatures of its ends \[W/K\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slopes {
    /// By the temperature of the own end, with the sign turned.
    pub own: f64,
    /// By that of the other.
    pub other: f64,
}

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
        Series::new(materials, position, links).map(Self::Series)
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

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Fixed(g) => 8 * g.len() as u64,
            Self::Kirchhoff { .. } => 0,
            Self::Series(s) => {
                let links = 4 * s.edge.len() + 20 * s.begin.len();
                (links + 24 * s.pieces.len() + 8 * s.fractions.len() + 24 * s.places.len()) as u64
            }
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
}

impl Ends<'_> {
    /// One over the difference of temperatures; none where they are equal but for rounding.
    #[inline]
    fn inverse(&self) -> Option<f64> {
        let [a, b] = self.temperature;
        ((b - a).abs() > NEAR * (a.abs() + b.abs())).then(|| 1.0 / (b - a))
    }

    /// Mean of a function of temperature between the ends.
    #[inline]
    fn mean(&self, conductor: usize, inverse: Option<f64>) -> f64 {
        let ((ka, ia), (kb, ib)) = (self.nodes[0][conductor], self.nodes[1][conductor]);
        inverse.map_or(0.5 * (ka + kb), |inverse| (ib - ia) * inverse)
    }
}

impl Conduction {
    /// Slopes of the heat through link `k` of weight `a`, whose mean conductivity is known for a series.
    #[inline]
    #[must_use]
    pub fn slopes(&self, k: usize, a: f64, (ends, mean): (&Ends<'_>, &[f64])) -> Slopes {
        match self {
            Self::Fixed(g) => Slopes {
                own: g[k],
                other: g[k],
            },
            Self::Kirchhoff {
                conductor,
                fraction,
            } => Slopes {
                own: a * fraction * ends.nodes[0][*conductor].0,
                other: a * fraction * ends.nodes[1][*conductor].0,
            },
            Self::Series(series) => series.slopes((k, a), ends, mean),
        }
    }
}

/// Conductance of a link of weight `a` under one function of temperature, over the weight \[W/(m K)\].
#[inline]
#[must_use]
pub fn kirchhoff(ends: &Ends<'_>, conductor: usize) -> f64 {
    ends.mean(conductor, ends.inverse())
}

impl Series {
    fn new(materials: &Materials, position: &[Vector], links: &Links) -> Result<Self, OutOfRange> {
        let mut series = Self {
            edge: vec![0; links.weight.len()],
            begin: vec![0],
            ..Self::default()
        };
        for material in 0..materials.len() {
            let varies = |c: &usize| materials.conductors[*c].constant().is_none();
            let (parts, formula) = match materials.law(material) {
                Law::Sum(parts) => {
                    let all = parts.iter().map(|p| p.conductor);
                    (all.filter(varies).collect(), None)
                }
                Law::Formula(curve) => (Vec::new(), Some(curve.clone())),
            };
            series.parts.push(parts);
            series.formulas.push(formula);
        }
        for i in 0..position.len() {
            for k in links.pattern.row(i) {
                let j = links.pattern.columns()[k] as usize;
                if i < j {
                    series.edge[k] = series.ends.len() as u32;
                    series.ends.push([i as u32, j as u32]);
                    series.add(materials, [position[i], position[j]])?;
                } else {
                    // The other end came first and knows the pieces.
                    let mut row = links.pattern.row(j);
                    let other = row.find(|m| links.pattern.columns()[*m] as usize == i);
                    series.edge[k] = other.map_or(0, |m| series.edge[m]);
                }
            }
        }
        Ok(series)
    }

    fn add(&mut self, materials: &Materials, [a, b]: [Vector; 2]) -> Result<(), OutOfRange> {
        let path = materials.path(a, b);
        for piece in path.pieces {
            let mut constant = 0.0;
            let first = match materials.law(piece.material) {
                Law::Sum(parts) => {
                    let first = self.fractions.len();
                    for part in parts {
                        let at = arguments(piece.place, 0.0, 0.0);
                        let fraction = part.fraction.value(&at)?;
                        match materials.conductors[part.conductor].constant() {
                            Some(k) => constant += fraction * k,
                            None => self.fractions.push(fraction),
                        }
                    }
                    first
                }
                Law::Formula(_) => {
                    self.places.push(piece.place);
                    self.places.len() - 1
                }
            };
            self.pieces.push(Piece {
                part: piece.part,
                constant,
                material: piece.material as u32,
                first: first as u32,
            });
        }
        self.begin.push(self.pieces.len() as u32);
        self.contact.push(path.contact);
        Ok(())
    }

    /// Numbers of the undirected links of a row.
    #[inline]
    #[must_use]
    pub fn edges(&self, row: std::ops::Range<usize>) -> &[u32] {
        &self.edge[row]
    }

    /// Mean conductivity of every undirected link \[W/(m K)\], each reckoned once for both of its ends.
    pub fn means<'a>(&self, ends: impl Fn([u32; 2]) -> Ends<'a> + Sync, means: &mut Vec<f64>) {
        means.resize(self.ends.len(), 0.0);
        means
            .par_iter_mut()
            .enumerate()
            .with_min_len(EDGES)
            .for_each(|(edge, mean)| *mean = self.mean(edge, &ends(self.ends[edge])));
    }

    #[inline]
    fn pieces(&self, edge: usize) -> (&[Piece], f64) {
        let range = self.begin[edge] as usize..self.begin[edge + 1] as usize;
        (&self.pieces[range], self.contact[edge])
    }

    /// Functions of temperature of a piece and their fractions.
    #[inline]
    fn terms(&self, piece: &Piece) -> impl Iterator<Item = (f64, usize)> {
        let conductors = &self.parts[piece.material as usize];
        let fractions = &self.fractions[piece.first as usize..];
        fractions.iter().copied().zip(conductors.iter().copied())
    }

    /// Mean conductivity of a piece between the temperatures of the link's ends.
    #[inline]
    fn between(&self, piece: &Piece, ends: &Ends<'_>, inverse: Option<f64>) -> f64 {
        match &self.formulas[piece.material as usize] {
            None => {
                let means = self.terms(piece).map(|(f, c)| f * ends.mean(c, inverse));
                piece.constant + means.sum::<f64>()
            }
            Some(curve) => {
                let [a, b] = ends.temperature;
                let each = TWO.map(|s| self.formula(curve, piece, a + s * (b - a)));
                0.5 * (each[0] + each[1])
            }
        }
    }

    fn formula(&self, curve: &Curve, piece: &Piece, temperature: f64) -> f64 {
        let place = self.places[piece.first as usize];
        let value = curve.value(&arguments(place, temperature, 0.0));
        // No conductivity is a number that is not positive: who sums it up finds it.
        value.ok().filter(|k| *k > 0.0).unwrap_or(f64::NAN)
    }

    /// Conductivity of a piece at the temperature of one end.
    #[inline]
    fn at_end(&self, piece: &Piece, ends: &Ends<'_>, end: usize) -> f64 {
        match &self.formulas[piece.material as usize] {
            None => {
                let values = self.terms(piece).map(|(f, c)| f * ends.nodes[end][c].0);
                piece.constant + values.sum::<f64>()
            }
            Some(curve) => self.formula(curve, piece, ends.temperature[end]),
        }
    }

    #[inline]
    fn mean(&self, edge: usize, ends: &Ends<'_>) -> f64 {
        let inverse = ends.inverse();
        match self.pieces(edge) {
            ([piece], 0.0) => self.between(piece, ends, inverse),
            (pieces, contact) => {
                let resistance = |p: &Piece| p.part / self.between(p, ends, inverse);
                1.0 / (contact + pieces.iter().map(resistance).sum::<f64>())
            }
        }
    }

    /// With `k = 1 / sum(w/k_p)` the heat is `k dT`, and `d(k dT)/dT_j = sum w (k/k_p)^2 k_p(T_j)`.
    fn slopes(&self, (k, a): (usize, f64), ends: &Ends<'_>, means: &[f64]) -> Slopes {
        let edge = self.edge[k] as usize;
        let (pieces, contact) = self.pieces(edge);
        let mut slopes = Slopes {
            own: 0.0,
            other: 0.0,
        };
        for piece in pieces {
            let weight = if pieces.len() == 1 && contact == 0.0 {
                a
            } else {
                let share = means[edge] / self.between(piece, ends, ends.inverse());
                a * piece.part * share * share
            };
            slopes.own += weight * self.at_end(piece, ends, 0);
            slopes.other += weight * self.at_end(piece, ends, 1);
        }
        slopes
    }
}
