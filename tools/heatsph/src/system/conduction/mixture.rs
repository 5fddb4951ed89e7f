//! Links through materials that share one function of temperature, as the layers of a graded material do.
//!
//! With `m` the mean of that function between the temperatures of the ends, a piece p conducts with
//! `k_p = c_p + f_p m`, and the link with `1/k = sum w_p / k_p + contacts`.

use run::property::OutOfRange;

use super::Ends;
use super::edges::Edges;
use crate::material::{Law, Materials, arguments};
use crate::operator::Links;
use shapes::frame::Vector;

/// A piece of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Share {
    /// Part of the length.
    part: f64,
    /// What does not depend on temperature \[W/(m K)\].
    constant: f64,
    /// Factor of the function of temperature.
    fraction: f64,
}

impl Share {
    #[inline]
    fn at(&self, m: f64) -> f64 {
        self.constant + self.fraction * m
    }
}

/// Links through shares of one function of temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixture {
    pub(super) edges: Edges,
    /// Begin of the shares of each undirected link.
    begin: Vec<u32>,
    contact: Vec<f64>,
    shares: Vec<Share>,
    conductor: usize,
}

/// The one function of temperature that all materials share, if there is no other.
pub(super) fn sole(materials: &Materials) -> Option<usize> {
    let varies = |c: usize| materials.conductors[c].constant().is_none();
    let mut sole = None;
    for material in 0..materials.len() {
        let Law::Sum(parts) = materials.law(material) else {
            return None;
        };
        for c in parts.iter().map(|p| p.conductor).filter(|c| varies(*c)) {
            if *sole.get_or_insert(c) != c {
                return None;
            }
        }
    }
    sole
}

impl Mixture {
    /// The links of points in the materials, whose function of temperature is `conductor`.
    ///
    /// # Errors
    /// Where a property has no value.
    pub(super) fn new(
        conductor: usize,
        materials: &Materials,
        position: &[Vector],
        links: &Links,
    ) -> Result<Self, OutOfRange> {
        let (mut begin, mut contact, mut shares) = (vec![0], Vec::new(), Vec::new());
        let edges = Edges::new(&links.pattern, |i, j| {
            let path = materials.path(position[i], position[j]);
            for piece in path.pieces {
                let mut share = Share {
                    part: piece.part,
                    constant: 0.0,
                    fraction: 0.0,
                };
                if let Law::Sum(parts) = materials.law(piece.material) {
                    for part in parts {
                        let fraction = part.fraction.value(&arguments(piece.place, 0.0, 0.0))?;
                        match materials.conductors[part.conductor].constant() {
                            Some(k) => share.constant += fraction * k,
                            None => share.fraction += fraction,
                        }
                    }
                }
                shares.push(share);
            }
            begin.push(shares.len() as u32);
            contact.push(path.contact);
            Ok(())
        })?;
        Ok(Self {
            edges,
            begin,
            contact,
            shares,
            conductor,
        })
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> u64 {
        self.edges.bytes() + (12 * self.begin.len() + 24 * self.shares.len()) as u64
    }

    #[inline]
    fn shares(&self, edge: usize) -> (&[Share], f64) {
        let range = self.begin[edge] as usize..self.begin[edge + 1] as usize;
        (&self.shares[range], self.contact[edge])
    }

    /// Mean conductivity of a link \[W/(m K)\].
    #[inline]
    pub(super) fn mean(&self, edge: usize, ends: &Ends<'_>) -> f64 {
        let m = ends.mean(self.conductor, ends.inverse());
        match self.shares(edge) {
            ([share], 0.0) => share.at(m),
            (shares, contact) => {
                let resistance = |share: &Share| share.part / share.at(m);
                1.0 / (contact + shares.iter().map(resistance).sum::<f64>())
            }
        }
    }

    /// Derivatives of `k (T_j - T_i)` by the temperatures of the ends, the lower one's with the sign turned:
    /// `sum w (k/k_p)^2 (c_p + f_p k(T))`.
    #[inline]
    pub(super) fn slopes(&self, edge: usize, ends: &Ends<'_>, mean: f64) -> [f64; 2] {
        let at = |k: f64, f: f64| ends.nodes.map(|nodes| k + f * nodes[self.conductor].0);
        match self.shares(edge) {
            ([share], 0.0) => at(share.constant, share.fraction),
            (shares, _) => {
                let m = ends.mean(self.conductor, ends.inverse());
                let (mut constant, mut fraction) = (0.0, 0.0);
                for share in shares {
                    let ratio = mean / share.at(m);
                    let weight = share.part * ratio * ratio;
                    constant += weight * share.constant;
                    fraction += weight * share.fraction;
                }
                at(constant, fraction)
            }
        }
    }
}
