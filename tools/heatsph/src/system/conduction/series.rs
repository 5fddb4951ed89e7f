//! Links through materials of any kind.

use quadrature::TWO;
use run::property::{Curve, OutOfRange};

use super::Ends;
use super::edges::Edges;
use crate::material::{Law, Materials, arguments};
use crate::operator::Links;
use shapes::frame::Vector;

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
    pub(super) edges: Edges,
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

impl Series {
    /// The links of points in the materials.
    ///
    /// # Errors
    /// Where a property has no value.
    pub(super) fn new(
        materials: &Materials,
        position: &[Vector],
        links: &Links,
    ) -> Result<Self, OutOfRange> {
        let mut series = Self {
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
        series.edges = Edges::new(&links.pattern, |i, j| {
            series.add(materials, [position[i], position[j]])
        })?;
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

    /// Bytes held.
    pub(super) fn bytes(&self) -> u64 {
        let pieces = 12 * self.begin.len() + 24 * self.pieces.len();
        self.edges.bytes() + (pieces + 8 * self.fractions.len() + 24 * self.places.len()) as u64
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
                let each = TWO.map(|(s, _)| self.formula(curve, piece, a + s * (b - a)));
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

    /// Mean conductivity of a link \[W/(m K)\].
    #[inline]
    pub(super) fn mean(&self, edge: usize, ends: &Ends<'_>) -> f64 {
        let inverse = ends.inverse();
        match self.pieces(edge) {
            ([piece], 0.0) => self.between(piece, ends, inverse),
            (pieces, contact) => {
                let resistance = |p: &Piece| p.part / self.between(p, ends, inverse);
                1.0 / (contact + pieces.iter().map(resistance).sum::<f64>())
            }
        }
    }

    /// Derivatives of `k (T_j - T_i)` by the temperatures of the ends, the lower one's with the sign turned: with
    /// `k = 1 / sum(w/k_p)` they are `sum w (k/k_p)^2 k_p(T)`.
    pub(super) fn slopes(&self, edge: usize, ends: &Ends<'_>, mean: f64) -> [f64; 2] {
        let (pieces, contact) = self.pieces(edge);
        if let ([piece], 0.0) = (pieces, contact) {
            return [0, 1].map(|end| self.at_end(piece, ends, end));
        }
        let (mut slopes, inverse) = ([0.0; 2], ends.inverse());
        for piece in pieces {
            let share = mean / self.between(piece, ends, inverse);
            let weight = piece.part * share * share;
            for (end, slope) in slopes.iter_mut().enumerate() {
                *slope += weight * self.at_end(piece, ends, end);
            }
        }
        slopes
    }
}
