//! Total force and heat, each in ways that share little: their difference is an estimate of the error.

use shapes::frame::difference;

use crate::magnetic::driven::force;
use crate::magnetic::driven::winding::Windings;
use crate::magnetic::fields::{Fields, cross_mean};
use crate::magnetic::medium::interface::Acting;
use crate::magnetic::medium::law::{jumps, traction};
use crate::magnetic::source::{C, Source};
use crate::stencils::region::Region;

/// Totals of all conductors and magnets.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Totals {
    /// Force by the volume integral of `J x B` and tractions where permeability jumps \[N\].
    pub force_volume: [f64; 3],
    /// Force by Maxwell's stress on the surfaces of the bodies, from without \[N\].
    pub force_stress: [f64; 3],
    /// Opposite of the force on the coils in the field of the currents (Biot and Savart) \[N\].
    pub force_coil: [f64; 3],
    /// Heat by the volume integral of `|J|^2 / sigma` \[W\].
    pub heat_volume: f64,
    /// Heat by what Poynting's vector carries through the surfaces \[W\].
    pub heat_surface: f64,
    /// What Poynting's vector comes to without direction and phase \[W\].
    pub heat_gross: f64,
}

/// Share of a force from which the stress of the sources alone, which comes to nothing, is taken off it.
const ALONE: f64 = 0.01;

impl Totals {
    /// Totals of the fields of a scene, in a plane per metre, about an axis of a full turn; `weights` are those of
    /// [`crate::stencils::quadrature`].
    #[must_use]
    pub fn of<const D: usize>(
        region: &Region<D>,
        fields: &Fields,
        weights: &[f64],
        source: &Source,
        windings: Option<&Windings>,
        acting: Acting<'_>,
    ) -> Self {
        Self {
            force_coil: force::force(region, weights, fields, source, windings, acting),
            ..Self::bodies(region, fields, weights, acting, |_| true)
        }
    }

    /// The same where all fields are stronger, so many times in their squares.
    #[must_use]
    pub fn times(self, square: f64) -> Self {
        let times = |force: [f64; 3]| force.map(|f| square * f);
        Self {
            force_volume: times(self.force_volume),
            force_stress: times(self.force_stress),
            force_coil: times(self.force_coil),
            heat_volume: square * self.heat_volume,
            heat_surface: square * self.heat_surface,
            heat_gross: square * self.heat_gross,
        }
    }

    /// The same of those bodies whose points are `kept`, but for the force on coils.
    #[must_use]
    pub fn bodies<const D: usize>(
        region: &Region<D>,
        fields: &Fields,
        weights: &[f64],
        acting: Acting<'_>,
        kept: impl Fn(usize) -> bool,
    ) -> Self {
        let (force_volume, heat_volume) = volume(fields, weights, &kept);
        let mut found = Self {
            force_volume,
            heat_volume,
            ..Self::default()
        };
        let mut alone = [0.0; 3];
        for (face, beyond) in region.faces.iter().zip(&fields.beyond) {
            let [a, b] = [face.inner, face.outer].map(|m| acting.acts[m as usize]);
            let i = face.point as usize;
            if !kept(i) {
                continue;
            }
            let n = region.raise(face.normal);
            if jumps(acting.laws, face) {
                let pull = traction(acting.laws, face, fields.flux[i], n);
                for (sum, pull) in found.force_volume.iter_mut().zip(pull) {
                    *sum += face.area * pull;
                }
            }
            if a == b {
                continue;
            }
            let sign = if a { face.area } else { -face.area };
            // On the side of what does not act.
            let (b, other) = if a {
                (beyond.flux, face.outer)
            } else {
                (fields.flux[i], face.inner)
            };
            let square: f64 = b.iter().map(C::norm_sqr).sum();
            let mu = acting.laws[other as usize].permeability(square.sqrt());
            let source: [C; 3] = std::array::from_fn(|k| fields.flux[i][k] - fields.reaction[i][k]);
            let (both, own) = (stress(&b, n), stress(&source, n));
            for k in 0..3 {
                found.force_stress[k] += sign * both[k] / mu;
                alone[k] += sign * own[k] / mu;
            }
            // E x H* through the surface.
            let electric = if a {
                fields.electric[i]
            } else {
                beyond.electric
            };
            let inward = cross_mean(electric, b);
            let flow: f64 = (0..3).map(|k| inward[k] * n[k]).sum();
            found.heat_surface -= sign * flow / mu;
            let strength: f64 = electric.iter().map(C::norm_sqr).sum();
            found.heat_gross += (sign * (strength * square).sqrt() / mu).abs();
        }
        found.force_stress = without(found.force_stress, alone);
        if region.axial {
            // Radial forces of a full turn cancel.
            for force in [&mut found.force_volume, &mut found.force_stress] {
                force[..2].fill(0.0);
            }
        }
        found
    }

    /// The largest difference between two of the forces \[N\].
    #[must_use]
    pub fn spread(&self) -> f64 {
        spread(&[self.force_volume, self.force_stress, self.force_coil])
    }
}

/// Maxwell's stress on a surface with a unit normal, times the permeability: `B (B* n) - |B|^2 n / 2`.
fn stress(b: &[C; 3], n: [f64; 3]) -> [f64; 3] {
    let square: f64 = b.iter().map(C::norm_sqr).sum();
    let normal: C = (0..3).map(|k| b[k].conj() * n[k]).sum();
    std::array::from_fn(|k| (b[k] * normal).re - 0.5 * square * n[k])
}

/// A force over closed surfaces without what the sources beyond them give of it, where that matters. Of exact fields they give
/// nothing: what they do give is an error of the sums, larger than the force itself where currents are weak.
fn without(force: [f64; 3], alone: [f64; 3]) -> [f64; 3] {
    let less = difference(force, alone);
    let square = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
    if square(alone) > ALONE * ALONE * square(less) {
        less
    } else {
        force
    }
}

/// The largest difference between two of several forces \[N\].
#[must_use]
pub fn spread(forces: &[[f64; 3]]) -> f64 {
    let apart = |a: &[f64; 3], b: &[f64; 3]| {
        let d = difference(*a, *b);
        d.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    let pairs = forces.iter().enumerate();
    pairs
        .flat_map(|(k, a)| forces[..k].iter().map(move |b| apart(a, b)))
        .fold(0.0, f64::max)
}

/// Force and heat of the conductors whose points are `kept`.
#[must_use]
fn volume(fields: &Fields, weights: &[f64], kept: impl Fn(usize) -> bool) -> ([f64; 3], f64) {
    let mut force = [0.0; 3];
    let mut heat = 0.0;
    for (i, w) in weights.iter().enumerate().filter(|(i, _)| kept(*i)) {
        for (sum, f) in force.iter_mut().zip(fields.force[i]) {
            *sum += w * f;
        }
        heat += w * fields.heat[i];
    }
    (force, heat)
}
