//! A uniform field.

use shapes::frame::{cross, difference, dot};

use super::Phasor;

/// What a uniform field comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Origin {
    /// A long round solenoid, whose axis goes through a place \[m\]: `A = B x (r - r0) / 2`.
    Solenoid([f64; 3]),
    /// Two wide plane sheets of opposite currents with this unit normal, square to the field:
    /// `A = (n.r) B x n`.
    Sheets([f64; 3]),
}

/// A uniform flux density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uniform {
    /// Flux density \[T\], rms.
    pub flux: Phasor,
    /// What it comes from.
    pub origin: Origin,
}

impl Uniform {
    /// Vector potential \[V s/m\], in Coulomb gauge and harmonic.
    #[must_use]
    pub fn potential(&self, p: [f64; 3]) -> Phasor {
        let (along, size) = match self.origin {
            Origin::Solenoid(place) => (difference(p, place), 0.5),
            Origin::Sheets(normal) => (normal, dot(normal, p)),
        };
        let [re, im] = [self.flux.map(|b| b.re), self.flux.map(|b| b.im)];
        let [re, im] = [cross(re, along), cross(im, along)];
        [0, 1, 2].map(|k| super::C::new(size * re[k], size * im[k]))
    }
}
