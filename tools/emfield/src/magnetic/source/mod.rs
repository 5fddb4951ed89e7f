//! Sources whose field is known exactly, so that only the reaction of the bodies is unknown.
//!
//! Currents and fields are complex: rms phasors of `exp(j w t)`. A source is a sum of parts:
//! circular loops ([`Loop`], complete elliptic integrals), straight segments ([`Segment`], Biot and
//! Savart), endless wires ([`Wire`]) and a uniform field ([`Uniform`]). The vector potential of each is
//! in Coulomb gauge.

mod elliptic;
mod ring;
mod segment;
mod uniform;
mod wire;

pub use ring::Loop;
pub use segment::Segment;
pub use uniform::{Origin, Uniform};
pub use wire::Wire;

use num_complex::Complex;
use rayon::prelude::*;

/// A complex number.
pub type C = Complex<f64>;

/// Permeability of vacuum \[H/m\].
pub const MU0: f64 = 4e-7 * std::f64::consts::PI;

/// A vector of phasors.
pub type Phasor = [C; 3];

/// Zero in all components.
pub const NONE: Phasor = [Complex::new(0.0, 0.0); 3];

/// A sum of parts, each with an exact field.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Source {
    /// Circular loops.
    pub loops: Vec<Loop>,
    /// Straight pieces of wire; closed circuits are made of several.
    pub segments: Vec<Segment>,
    /// Endless wires along z.
    pub wires: Vec<Wire>,
    /// Uniform fields.
    pub uniform: Vec<Uniform>,
}

impl Source {
    /// Nothing at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.loops.is_empty()
            && self.segments.is_empty()
            && self.wires.is_empty()
            && self.uniform.is_empty()
    }

    /// The same with all currents and fields so many times as strong.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let mut all = self.clone();
        let loops = all.loops.iter_mut().map(|part| &mut part.current);
        let segments = all.segments.iter_mut().map(|part| &mut part.current);
        let wires = all.wires.iter_mut().map(|part| &mut part.current);
        let uniform = all.uniform.iter_mut().flat_map(|part| &mut part.flux);
        for strength in loops.chain(segments).chain(wires).chain(uniform) {
            *strength *= factor;
        }
        all
    }

    /// Vector potential at one place \[V s/m\], rms.
    #[must_use]
    pub fn potential_at(&self, p: [f64; 3]) -> Phasor {
        let mut sum = NONE;
        for part in &self.loops {
            add(&mut sum, part.potential(p), part.current);
        }
        for part in &self.segments {
            add(&mut sum, part.potential(p), part.current);
        }
        for part in &self.wires {
            add(&mut sum, part.potential(p), part.current);
        }
        for part in &self.uniform {
            let a = part.potential(p);
            for (sum, a) in sum.iter_mut().zip(a) {
                *sum += a;
            }
        }
        sum
    }

    /// Flux density at one place \[T\], rms.
    #[must_use]
    pub fn flux_at(&self, p: [f64; 3]) -> Phasor {
        let mut sum = NONE;
        for part in &self.loops {
            add(&mut sum, part.flux(p), part.current);
        }
        for part in &self.segments {
            add(&mut sum, part.flux(p), part.current);
        }
        for part in &self.wires {
            add(&mut sum, part.flux(p), part.current);
        }
        for part in &self.uniform {
            for (sum, b) in sum.iter_mut().zip(part.flux) {
                *sum += b;
            }
        }
        sum
    }

    /// Vector potential at many places \[V s/m\].
    #[must_use]
    pub fn potential(&self, places: &[[f64; 3]]) -> Vec<Phasor> {
        places.par_iter().map(|p| self.potential_at(*p)).collect()
    }

    /// Flux density at many places \[T\].
    #[must_use]
    pub fn flux(&self, places: &[[f64; 3]]) -> Vec<Phasor> {
        places.par_iter().map(|p| self.flux_at(*p)).collect()
    }
}

/// Adds what 1 A gives, times a current.
fn add(sum: &mut Phasor, part: [f64; 3], current: C) {
    for k in 0..3 {
        sum[k] += current * part[k];
    }
}

#[cfg(test)]
mod tests;
