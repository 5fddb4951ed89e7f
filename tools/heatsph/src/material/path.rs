//! Conductivity along a link.
//!
//! A link is a resistance: pieces in series, each with the mean conductivity between the temperatures of its two
//! ends (Kirchhoff), and the contacts that it crosses,
//!
//! ```text
//! 1/k_ij = sum_p w_p / k_p(T_i, T_j) + sum R / (r cos)
//! ```
//!
//! with `w_p` the part of the length that a piece stands for. On lattices this is the harmonic mean that keeps the
//! flux of layered materials continuous (Cleary and Monaghan 1999; Rong and Kisu 2010, below eq. 4); for
//! conductivities that vary along the flow it is exact in one dimension, wherever interfaces lie.

use quadrature::{THREE, TWO};
use run::property::{Arguments, OutOfRange};

use super::{Law, Materials, arguments};
use shapes::frame::{Vector, along, difference};

/// Two and three points that differ by more than this part call for many.
const ROUGH: f64 = 1e-3;
/// The many.
const PANELS: usize = 64;

/// A piece of a link: its part of the length, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Part of the length.
    pub part: f64,
    /// Material.
    pub material: usize,
    /// Place \[m\].
    pub place: Vector,
}

/// A link through the materials.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// Pieces in series.
    pub pieces: Vec<Piece>,
    /// Resistance of the contacts over the length \[m K/W\].
    pub contact: f64,
}

impl Materials {
    /// The pieces of the link from `a` to `b` for a conductivity that depends on temperature: two per stretch,
    /// one where the material is even.
    #[must_use]
    pub fn path(&self, a: Vector, b: Vector) -> Path {
        let (stretches, contact) = self.stretches(a, b);
        let d = difference(b, a);
        let mut pieces = Vec::new();
        for stretch in stretches {
            let span = stretch.to - stretch.from;
            let place = |t: f64| along(a, stretch.from + span * t, d);
            if self.even(stretch.material, [place(TWO[0].0), place(TWO[1].0)]) {
                pieces.push(Piece {
                    part: span,
                    material: stretch.material,
                    place: place(0.5),
                });
            } else {
                pieces.extend(TWO.map(|(t, weight)| Piece {
                    part: weight * span,
                    material: stretch.material,
                    place: place(t),
                }));
            }
        }
        Path { pieces, contact }
    }

    /// Whether a material is the same at two places.
    fn even(&self, material: usize, places: [Vector; 2]) -> bool {
        match self.law(material) {
            Law::Sum(parts) => parts.iter().all(|part| {
                let [a, b] = places.map(|x| part.fraction.value(&Arguments::at(x, 0.0)));
                part.fraction.constant().is_some() || a == b
            }),
            Law::Formula(_) => false,
        }
    }

    /// Conductivity of the link from `a` to `b` where it depends on place alone \[W/(m K)\].
    ///
    /// # Errors
    /// Where a property has no value, or one that is not positive.
    pub fn fixed(&self, a: Vector, b: Vector) -> Result<f64, OutOfRange> {
        let (stretches, contact) = self.stretches(a, b);
        let d = difference(b, a);
        let mut resistance = contact;
        for stretch in stretches {
            let span = stretch.to - stretch.from;
            let inverse = |t: f64| {
                let x = along(a, stretch.from + span * t, d);
                let k = self.conductivity(stretch.material, x, 0.0)?;
                if k > 0.0 {
                    Ok(1.0 / k)
                } else {
                    Err(OutOfRange::Formula {
                        value: k,
                        at: arguments(x, 0.0, 0.0),
                    })
                }
            };
            let rule = |nodes: &[(f64, f64)]| -> Result<f64, OutOfRange> {
                let mut sum = 0.0;
                for (t, weight) in nodes {
                    sum += weight * inverse(*t)?;
                }
                Ok(sum)
            };
            let constant = match self.law(stretch.material) {
                Law::Sum(parts) => parts.iter().all(|p| p.fraction.constant().is_some()),
                Law::Formula(_) => false,
            };
            let mean = if constant {
                inverse(0.5)?
            } else {
                let (two, three) = (rule(&TWO)?, rule(&THREE)?);
                if (two - three).abs() < ROUGH * three {
                    three
                } else {
                    let many = |i: usize| ((i as f64 + 0.5) / PANELS as f64, 1.0 / PANELS as f64);
                    rule(&std::array::from_fn::<_, PANELS, _>(many))?
                }
            };
            resistance += span * mean;
        }
        Ok(1.0 / resistance)
    }
}
