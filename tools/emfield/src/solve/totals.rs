//! Total force and heat, each in ways that share little: their difference is an estimate of the error.

use num_complex::Complex;

use super::coils;
use super::eddy::{Fields, cross_mean};
use super::region::Region;
use crate::source::{MU0, Source, minus};

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

impl Totals {
    /// Totals of the fields of a scene, in a plane per metre, about an axis of a full turn; `weights` are those of
    /// [`super::quadrature`].
    #[must_use]
    pub fn of<const D: usize>(
        region: &Region<D>,
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
        for (face, beyond) in region.faces.iter().zip(&fields.beyond) {
            let [a, b] = [face.inner, face.outer].map(|m| conducts[m as usize]);
            if a == b {
                continue;
            }
            let sign = if a { face.area } else { -face.area };
            let i = face.point as usize;
            let n = region.raise(face.normal);
            let b = fields.flux[i];
            let square: f64 = b.iter().map(C::norm_sqr).sum();
            let normal: C = (0..3).map(|k| b[k].conj() * n[k]).sum();
            for k in 0..3 {
                // T n = (B (B* n) - |B|^2 n / 2) / mu.
                let pull = (b[k] * normal).re - 0.5 * square * n[k];
                found.force_stress[k] += sign * pull / MU0;
            }
            // E x H* through the surface.
            let electric = if a {
                fields.electric[i]
            } else {
                beyond.electric
            };
            let inward = cross_mean(electric, b);
            let flow: f64 = (0..3).map(|k| inward[k] * n[k]).sum();
            found.heat_surface -= sign * flow / MU0;
        }
        if region.axial {
            // Radial forces of a full turn cancel.
            for force in [&mut found.force_volume, &mut found.force_stress] {
                force[..2].fill(0.0);
            }
        }
        found.force_coil = coils::force(region, weights, fields, source);
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
