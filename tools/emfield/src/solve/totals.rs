//! Total force and heat, each in ways that share little: their difference is an estimate of the error.

use num_complex::Complex;
use rayon::prelude::*;

use super::eddy::{Fields, cross_mean};
use super::region::Region;
use crate::source::{MU0, Source, cross, minus};

/// A complex number.
type C = Complex<f64>;

/// Totals of all conductors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    /// Force by the volume integral of `J x B` \[N\].
    pub force_volume: [f64; 3],
    /// Force by Maxwell's stress on the surfaces of the conductors \[N\].
    pub force_stress: [f64; 3],
    /// Opposite of the force on the coils in the field of the currents (Biot and Savart) \[N\].
    pub force_coil: [f64; 3],
    /// Heat by the volume integral of `|J|^2 / sigma` \[W\].
    pub heat_volume: f64,
    /// Heat by what Poynting's vector carries through the surfaces \[W\].
    pub heat_surface: f64,
}

/// Pieces of which a loop is made where its force is summed.
const PIECES: usize = 48;

impl Totals {
    /// Totals of the fields of a scene in space; `weights` are those of [`super::quadrature`].
    #[must_use]
    pub fn in_space(
        region: &Region<3>,
        fields: &Fields,
        weights: &[f64],
        (source, conducts): (&Source, &[bool]),
    ) -> Self {
        let (force_volume, heat_volume) = volume(fields, weights);
        let mut found = Self {
            force_volume,
            heat_volume,
            ..Self::default()
        };
        for face in &region.faces {
            let [a, b] = [face.inner, face.outer].map(|m| conducts[m as usize]);
            if a == b {
                continue;
            }
            let sign = if a { face.area } else { -face.area };
            let i = face.point as usize;
            let n = face.normal;
            let b = fields.flux[i];
            let square: f64 = b.iter().map(C::norm_sqr).sum();
            let normal: C = (0..3).map(|k| b[k].conj() * n[k]).sum();
            for k in 0..3 {
                // T n = (B (B* n) - |B|^2 n / 2) / mu.
                let pull = (b[k] * normal).re - 0.5 * square * n[k];
                found.force_stress[k] += sign * pull / MU0;
            }
            // E x H* through the surface.
            let inward = cross_mean(fields.electric[i], b);
            let flow: f64 = (0..3).map(|k| inward[k] * n[k]).sum();
            found.heat_surface -= sign * flow / MU0;
        }
        found.force_coil = coils((region, weights), fields, source);
        found
    }

    /// The largest difference between two of the forces \[N\].
    #[must_use]
    pub fn spread(&self) -> f64 {
        let all = [self.force_volume, self.force_stress, self.force_coil];
        let apart = |a: [f64; 3], b: [f64; 3]| {
            let d = minus(a, b);
            d.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        let pairs = [(0, 1), (0, 2), (1, 2)];
        pairs
            .into_iter()
            .map(|(i, j)| apart(all[i], all[j]))
            .fold(0.0, f64::max)
    }
}

/// Force and heat of all conductors.
#[must_use]
pub fn volume(fields: &Fields, weights: &[f64]) -> ([f64; 3], f64) {
    let mut force = [0.0; 3];
    let mut heat = 0.0;
    for (i, w) in weights.iter().enumerate() {
        for (sum, f) in force.iter_mut().zip(fields.force[i]) {
            *sum += w * f;
        }
        heat += w * fields.heat[i];
    }
    (force, heat)
}

/// Opposite of the force on the coils: `-Re sum I* dl x B` with the field of the currents.
fn coils((region, weights): (&Region<3>, &[f64]), fields: &Fields, source: &Source) -> [f64; 3] {
    let currents: Vec<([f64; 3], [C; 3])> = (0..region.len())
        .filter(|i| weights[*i] != 0.0)
        .map(|i| {
            (
                region.places[i],
                fields.current[i].map(|j| j * (weights[i] * 1e-7)),
            )
        })
        .collect();
    let loops = source.loops.iter().map(|l| (l.pieces(PIECES), l.current));
    let segments = source
        .segments
        .iter()
        .map(|s| (s.pieces(PIECES), s.current));
    let mut force = [0.0; 3];
    for (pieces, current) in loops.chain(segments) {
        let on: Vec<[f64; 3]> = pieces
            .par_iter()
            .map(|(place, along)| {
                let b = biot_savart(&currents, *place);
                cross_mean(along.map(|x| current * x), b)
            })
            .collect();
        for f in on {
            for k in 0..3 {
                force[k] -= f[k];
            }
        }
    }
    force
}

/// `mu0/(4 pi) sum J dV x d / d^3`; `mu0 / 4 pi` is in the moments.
fn biot_savart(currents: &[([f64; 3], [C; 3])], p: [f64; 3]) -> [C; 3] {
    let mut sum = [C::new(0.0, 0.0); 3];
    for (place, moment) in currents {
        let d = minus(p, *place);
        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let inverse = (square * square.sqrt()).recip();
        let re = cross(moment.map(|m| m.re), d);
        let im = cross(moment.map(|m| m.im), d);
        for k in 0..3 {
            sum[k] += C::new(re[k], im[k]) * inverse;
        }
    }
    sum
}
