//! How the field in a medium follows its flux density: `H(B)`, along B, without hysteresis.
//!
//! Of a curve are wanted the reluctivity `nu = H/B`, that of small changes along B, `dH/dB`, and the energy `int H dB`. Media
//! of one permeability answer with numbers that do not depend on B.

use props::Odd;

use crate::magnetic::source::{C, MU0};
use crate::stencils::region::Face;

/// Part of the first interval of a curve below which its reluctivity is that of an odd cubic to rounding.
const SMALL: f64 = 1e-4;
/// Steps of Newton's method for the flux density on the other side of an interface, and where they end.
const STEPS: (usize, f64) = (100, 1e-14);

/// How the field of a medium follows its flux density.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// One permeability \[H/m\].
    Constant(f64),
    /// A curve.
    Curve(Curve),
}

/// A curve of magnetisation; beyond its end as in vacuum.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve(Odd);

/// A medium at a flux density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// Field \[A/m\].
    pub field: f64,
    /// `H/B` \[m/H\].
    pub reluctivity: f64,
    /// `dH/dB` \[m/H\].
    pub slope: f64,
    /// `d(H/B)/dB / B` \[m/H/T2\].
    pub bend: f64,
    /// `int H dB` \[J/m3\].
    pub energy: f64,
}

impl Curve {
    /// Through flux densities \[T\] and fields \[A/m\] that rise from zero; none where they do not.
    #[must_use]
    pub fn new(b: Vec<f64>, h: Vec<f64>) -> Option<Self> {
        Odd::new(b, h, 1.0 / MU0).ok().map(Self)
    }

    /// The medium at a flux density \[T\].
    #[must_use]
    pub fn at(&self, flux: f64) -> Local {
        // Below this the curve is an odd cubic, whose bend does not depend on B.
        let b = flux.max(SMALL * self.0.first());
        let end = self.0.end();
        let known = self.0.at(b.min(end));
        let (mut field, mut slope, mut energy) = (known.value, known.slope, known.area);
        if b > end {
            energy += (b - end) * (field + 0.5 * (b - end) / MU0);
            field += (b - end) / MU0;
            slope = 1.0 / MU0;
        }
        let reluctivity = field / b;
        let near = flux / b;
        Local {
            field: reluctivity * flux,
            reluctivity,
            slope,
            bend: (slope - reluctivity) / (b * b),
            energy: energy * near * near,
        }
    }

    /// The flux density t along an interface at which `(nu_0 + nu) t` is `wanted`, where through it there is `through`.
    #[must_use]
    pub fn along(&self, through: f64, level: f64, wanted: f64) -> f64 {
        if wanted == 0.0 {
            return 0.0;
        }
        // It rises with t: Newton's steps, halved towards what is known to be beyond. With vacuum's reluctivity, the
        // greatest, it is the least.
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut t = wanted / (level + 1.0 / MU0);
        for _ in 0..STEPS.0 {
            let local = self.at(through.hypot(t));
            let own = level + local.reluctivity;
            let off = own * t - wanted;
            if off > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let mut next = t - off / (own + local.bend * t * t);
            if next <= low || next >= high {
                next = if high.is_finite() {
                    0.5 * (low + high)
                } else {
                    2.0 * t
                };
            }
            let moved = (next - t).abs();
            t = next;
            if moved <= STEPS.1 * t {
                break;
            }
        }
        t
    }
}

impl Law {
    /// The one permeability, if it is one \[H/m\].
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        match self {
            Self::Constant(mu) => Some(*mu),
            Self::Curve(_) => None,
        }
    }

    /// The permeability at a flux density \[H/m\].
    #[must_use]
    pub fn permeability(&self, flux: f64) -> f64 {
        match self {
            Self::Constant(mu) => *mu,
            Self::Curve(curve) => 1.0 / curve.at(flux).reluctivity,
        }
    }

    /// `B H - int H dB` \[J/m3\].
    fn coenergy(&self, flux: f64) -> f64 {
        match self {
            Self::Constant(mu) => 0.5 * flux * flux / mu,
            Self::Curve(curve) => {
                let local = curve.at(flux);
                flux * local.field - local.energy
            }
        }
    }

    /// The flux density along an interface at which the field along it is `field`, where through it there is `through`.
    fn along(&self, through: f64, field: f64) -> f64 {
        match self {
            Self::Constant(mu) => mu * field,
            Self::Curve(curve) => curve.along(through, 0.0, field),
        }
    }
}

fn size(b: &[C; 3]) -> f64 {
    b.iter().map(C::norm_sqr).sum::<f64>().sqrt()
}

/// The media on both sides of a face.
fn sides<'a, const D: usize>(laws: &'a [Law], face: &Face<D>) -> [&'a Law; 2] {
    [face.inner, face.outer].map(|m| &laws[m as usize])
}

/// Whether the media on both sides of a face differ.
#[must_use]
pub fn jumps<const D: usize>(laws: &[Law], face: &Face<D>) -> bool {
    match sides(laws, face) {
        [Law::Constant(a), Law::Constant(b)] => a.to_bits() != b.to_bits(),
        _ => face.inner != face.outer,
    }
}

/// The flux density beyond a face with the unit normal `normal`, from that on its inner side: its normal part is continuous,
/// and the field along it.
#[must_use]
pub fn beyond<const D: usize>(
    laws: &[Law],
    face: &Face<D>,
    flux: [C; 3],
    normal: [f64; 3],
) -> [C; 3] {
    let [own, other] = sides(laws, face);
    if let [Law::Constant(a), Law::Constant(b)] = [own, other] {
        return beyond_one(flux, normal, [*a, *b]);
    }
    let (through, along) = parts(flux, normal);
    let here = own.permeability(size(&flux));
    let field = size(&along) / here;
    let ratio = if field > 0.0 {
        other.along(through.norm(), field) / (field * here)
    } else {
        1.0
    };
    std::array::from_fn(|k| through * normal[k] + along[k] * ratio)
}

/// Parts of a vector along a unit normal and across it.
fn parts(flux: [C; 3], normal: [f64; 3]) -> (C, [C; 3]) {
    let through: C = flux.iter().zip(normal).map(|(b, n)| b * n).sum();
    let along = std::array::from_fn(|k| flux[k] - through * normal[k]);
    (through, along)
}

/// Traction on a face \[Pa\] from the flux density on its inner side: the jump of the stress `B H - w` along the normal, with
/// the coenergy density `w = int B dH`.
#[must_use]
pub fn traction<const D: usize>(
    laws: &[Law],
    face: &Face<D>,
    flux: [C; 3],
    normal: [f64; 3],
) -> [f64; 3] {
    let both = sides(laws, face);
    if let [Law::Constant(a), Law::Constant(b)] = both {
        return traction_one(flux, normal, [*a, *b]);
    }
    let outside = beyond(laws, face, flux, normal);
    let stress = |law: &Law, b: [C; 3]| {
        let (through, _) = parts(b, normal);
        let whole = size(&b);
        through.norm_sqr() / law.permeability(whole) - law.coenergy(whole)
    };
    let pull = stress(both[1], outside) - stress(both[0], flux);
    normal.map(|n| n * pull)
}

/// The flux density beyond an interface of media with these permeabilities, from that on this side: its normal part is
/// continuous, along the interface `B / mu` is.
fn beyond_one(flux: [C; 3], normal: [f64; 3], [own, other]: [f64; 2]) -> [C; 3] {
    if own.to_bits() == other.to_bits() {
        return flux;
    }
    let through: C = flux.iter().zip(normal).map(|(b, n)| b * n).sum();
    let ratio = other / own;
    std::array::from_fn(|k| {
        let across = through * normal[k];
        across + (flux[k] - across) * ratio
    })
}

/// Mean traction on an interface \[Pa\] from the flux density on its inner side, with the unit normal outward: the jump of
/// Maxwell's stress, `((mu_i - mu_o) / 2) (B_n^2 / (mu_i mu_o) + H_t^2)` along the normal.
fn traction_one(flux: [C; 3], normal: [f64; 3], [inner, outer]: [f64; 2]) -> [f64; 3] {
    let through: C = flux.iter().zip(normal).map(|(b, n)| b * n).sum();
    let square: f64 = flux.iter().map(C::norm_sqr).sum();
    let along = (square - through.norm_sqr()) / (inner * inner);
    let size = 0.5 * (inner - outer) * (through.norm_sqr() / (inner * outer) + along);
    normal.map(|n| n * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steel() -> Curve {
        let b = vec![0.0, 0.2, 0.6, 1.0, 1.3, 1.5, 1.7, 2.0];
        let h = vec![0.0, 60.0, 110.0, 190.0, 420.0, 1600.0, 8000.0, 90_000.0];
        Curve::new(b, h).unwrap()
    }

    fn face() -> Face<3> {
        Face {
            point: 0,
            inner: 1,
            outer: 0,
            normal: [0.0, 0.0, 1.0],
            area: 1.0,
        }
    }

    #[test]
    fn slope_bend_and_energy_belong_to_the_field() {
        let curve = steel();
        for b in [1e-6, 0.01, 0.3, 1.1, 1.45, 1.95, 2.5, 9.0] {
            let step = 1e-5 * b;
            let [low, here, high] = [b - step, b, b + step].map(|b| curve.at(b));
            let slope = (high.field - low.field) / (2.0 * step);
            assert!((slope / here.slope - 1.0).abs() < 1e-3, "{b}");
            let bend = (high.reluctivity - low.reluctivity) / (2.0 * step) / b;
            assert!((bend - here.bend).abs() * b * b < 2e-3 * here.slope, "{b}");
            let field = (high.energy - low.energy) / (2.0 * step);
            assert!((field / here.field - 1.0).abs() < 1e-3, "{b}");
        }
        assert!((curve.at(0.2).field - 60.0).abs() < 1e-9);
        assert!((curve.at(3.0).field - (90_000.0 + 1.0 / MU0)).abs() < 1e-3);
    }

    /// Through a face the normal part of B and the field along it are continuous, into steel as out of it.
    #[test]
    fn fields_pass_a_face_both_ways() {
        let out = [Law::Constant(MU0), Law::Curve(steel())];
        let into = [out[1].clone(), out[0].clone()];
        let n = [0.0, 0.0, 1.0];
        for flux in [
            [0.3, 0.0, 0.1],
            [1.2, 0.5, 0.9],
            [0.0, 2.4, 0.0],
            [0.0, 0.0, 1.0],
        ] {
            let inside = flux.map(C::from);
            let air = beyond(&out, &face(), inside, n);
            assert!((air[2] - inside[2]).norm() < 1e-12);
            let mu = out[1].permeability(size(&inside));
            assert!((air[0] - inside[0] * (MU0 / mu)).norm() < 1e-12);
            let back = beyond(&into, &face(), air, n);
            for k in 0..3 {
                assert!((back[k] - inside[k]).norm() < 1e-9, "{flux:?} {back:?}");
            }
        }
    }

    /// A straight curve pulls as a number does.
    #[test]
    fn the_traction_of_a_straight_curve_is_that_of_its_permeability() {
        let mu = 50.0 * MU0;
        let line = Curve::new(vec![0.0, 5.0], vec![0.0, 5.0 / mu]).unwrap();
        let flux = [0.4, -0.1, 0.8].map(C::from);
        let n = [0.6, 0.0, 0.8];
        let laws = [Law::Constant(MU0), Law::Curve(line)];
        let numbers = [Law::Constant(MU0), Law::Constant(mu)];
        let curved = traction(&laws, &face(), flux, n);
        let plain = traction(&numbers, &face(), flux, n);
        for k in 0..3 {
            assert!((curved[k] - plain[k]).abs() < 1e-9 * plain[0].abs());
        }
    }
}
