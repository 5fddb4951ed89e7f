//! Fracture: particles that break, at once and for good.
//!
//! ```text
//! strain     e  >= limit,    e the equivalent strain of the principal strains         Shinohara et al. (2004), section 2.3
//! stress     s1 >= limit,    s1 the greatest principal stress
//! energy     G  >= limit,    G the energy that would go with the particle, by the area of the crack: see [`super::release`]
//! ```
//!
//! The formula of the equivalent strain is not in the source; it is von Mises' of the logarithmic principal strains. At the
//! tip of a crack strain and stress of a cell rise as cells shrink, so what a crack costs falls with the spacing; by their
//! mean over a length (`nonlocal`) it does not. The third makes the energy of a crack the same on any spacing, and begins no
//! crack on a smooth face. A broken particle keeps its mass and its motion and loses its links; those that they crossed are lost, too, so
//! that both sides of a crack are free surfaces. From then on it is a contact, which bears compression alone.

use particles::Column;
use schemars::JsonSchema;
use serde::Deserialize;

use super::law::{Law, strain_of};
use super::tensor::{Matrix, determinant, eigenvalues, inner, transposed_times};

/// Whether a particle is broken.
pub const BROKEN: Column<u8> = Column::new("broken", "1", 0).saved().shown();

/// When a particle breaks.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum Criterion {
    /// At an equivalent strain.
    #[serde(rename = "equivalent_strain")]
    Strain(#[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))] f64),
    /// At a greatest principal stress \[Pa\].
    #[serde(rename = "principal_stress_pa")]
    Stress(#[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0.0))] f64),
    /// At an energy of the crack \[J/m2\].
    #[serde(rename = "energy_release_j_m2")]
    Energy(#[schemars(extend("x-unit" = "J/m2", "exclusiveMinimum" = 0.0))] f64),
}

impl Criterion {
    /// Whether a cell breaks at a completed deformation; one that is turned inside out does. What goes with it is asked of
    /// its neighbours, too, and not here.
    #[must_use]
    pub fn breaks(&self, law: &Law, deformation: &Matrix) -> bool {
        let volume = determinant(deformation);
        // What is no number is no volume.
        let is_one = volume > 0.0;
        if !is_one {
            return true;
        }
        let square = transposed_times(deformation, deformation);
        self.may_break(law, &square) && self.load(law, &square) >= 1.0
    }

    /// Whether [`Self::load`] may be 1 or more of any C that is no further from 1 than this one: no search for principal strains,
    /// and a mean is no further than the furthest.
    #[must_use]
    pub(super) fn may_break(&self, law: &Law, square: &Matrix) -> bool {
        match *self {
            Self::Strain(limit) => (2.0_f64 / 3.0).sqrt() * strain_most(square) >= limit,
            Self::Stress(limit) => stress_most(law, square) >= limit,
            Self::Energy(_) => false,
        }
    }

    /// What a cell bears of what breaks it, by C = F^T F of its completed deformation; nothing by the energy.
    #[must_use]
    pub(super) fn load(&self, law: &Law, square: &Matrix) -> f64 {
        match *self {
            Self::Strain(limit) => strain_of(square) / limit,
            Self::Stress(limit) => law.greatest_stress(square) / limit,
            Self::Energy(_) => 0.0,
        }
    }
}

/// Bounds are taken greater by this part, for the sake of rounding.
const BOUND: f64 = 1.0 + 1e-9;

/// What the length of the logarithmic principal strains e_i is at most, without a search for them: with C = F^T F and D the
/// length of C - 1, `|ln c_i| <= -ln(1 - D) <= D/(1 - D)` and `e_i = ln(c_i)/2`.
fn strain_most(square: &Matrix) -> f64 {
    let length = off_rest(square);
    if length < 1.0 {
        BOUND * 0.5 * length / (1.0 - length)
    } else {
        f64::INFINITY
    }
}

/// D, the length of C - 1.
fn off_rest(square: &Matrix) -> f64 {
    let mut off = *square;
    (0..3).for_each(|k| off[k][k] -= 1.0);
    inner(&off, &off).sqrt()
}

/// What the greatest principal stress is at most \[Pa\]: all |c_i - 1| are at most D, and `lambda ln J` at
/// most `3/2 lambda ln(1 + D)`, or `3/2 lambda ln(1 - D)` where lambda is negative.
fn stress_most(law: &Law, square: &Matrix) -> f64 {
    let length = off_rest(square);
    if length < 1.0 {
        let volume = 1.5 * law.lame * (length * law.lame.signum()).ln_1p();
        BOUND * (law.shear * length + volume) / (1.0 - length).powf(1.5)
    } else {
        f64::INFINITY
    }
}

/// What [`stretched`] is at most \[J/m3\], without a search for principal strains.
#[must_use]
pub fn stretched_most(law: &Law, deformation: &Matrix) -> f64 {
    let strain = strain_most(&transposed_times(deformation, deformation));
    // The sum of three is at most sqrt(3) of their length.
    (law.shear + 1.5 * law.lame.max(0.0)) * strain * strain
}

/// Energy of what is stretched, by the logarithmic principal strains \[J/m3\]: `mu sum <e_i>^2 + lambda/2 <sum e_i>^2`.
#[must_use]
pub fn stretched(law: &Law, deformation: &Matrix) -> f64 {
    let squares = eigenvalues(&transposed_times(deformation, deformation));
    let strains = squares.map(|square| 0.5 * square.max(f64::MIN_POSITIVE).ln());
    let volume: f64 = strains.iter().sum();
    let own: f64 = strains.iter().map(|e| e.max(0.0).powi(2)).sum();
    law.shear * own + 0.5 * law.lame * volume.max(0.0).powi(2)
}

/// Whether what is broken stands between two places, all in cells: nearer than this to the way between them. Slanted links of a
/// straight lattice pass at 0.447 and 0.707, and a little shaking changes neither.
const BETWEEN: f64 = 0.57;

/// Whether a link from `a` to `b` crosses one of the broken places, all in cells of the lattice.
#[must_use]
pub fn crossed(a: [f64; 3], b: [f64; 3], broken: impl Iterator<Item = [f64; 3]>) -> bool {
    let way = [0, 1, 2].map(|k| b[k] - a[k]);
    let length: f64 = way.iter().map(|x| x * x).sum();
    for place in broken {
        let to = [0, 1, 2].map(|k| place[k] - a[k]);
        let along = (0..3).map(|k| to[k] * way[k]).sum::<f64>() / length;
        if along > 0.0 && along < 1.0 {
            let off: f64 = (0..3).map(|k| (to[k] - along * way[k]).powi(2)).sum();
            if off < BETWEEN * BETWEEN {
                return true;
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::super::law::{Elastic, Young, equivalent_strain};
    use super::super::tensor::UNIT;
    use super::*;

    #[test]
    fn each_breaks_where_it_says() {
        let young = Young {
            youngs_modulus_pa: 1e5,
            poisson_ratio: 0.0,
        };
        let law = Law::new(&Elastic::Young(young), None);
        let pulled = |strain: f64| {
            let mut f = UNIT;
            f[0][0] = 1.0 + strain;
            f
        };
        for (criterion, strain) in [
            (Criterion::Strain(2.0 / 3.0 * 0.01), 0.01),
            (Criterion::Stress(1e3), 0.01),
        ] {
            assert!(!criterion.breaks(&law, &pulled(0.97 * strain)));
            assert!(criterion.breaks(&law, &pulled(1.03 * strain)));
            assert!(criterion.breaks(&law, &pulled(-1.5)));
        }
        assert!(!Criterion::Stress(1e3).breaks(&law, &pulled(-0.1)));
        assert!(stretched(&law, &pulled(-0.1)) <= 0.0);
        let energy = 0.5 * 1e5 * 0.01 * 0.01;
        assert!((stretched(&law, &pulled(0.01)) / energy - 1.0).abs() < 0.02);
    }

    #[test]
    fn bounds_hold_and_are_near_where_little_is_strained() {
        let young = Young {
            youngs_modulus_pa: 1e5,
            poisson_ratio: 0.3,
        };
        let law = Law::new(&Elastic::Young(young), None);
        for k in 0..200 {
            let size = 10.0_f64.powi(-(k % 5));
            let mut f = UNIT;
            let entries = f.iter_mut().flatten().enumerate();
            entries.for_each(|(m, x)| *x += 0.3 * size * f64::from(9 * k + m as i32).sin());
            let length = 1.5_f64.sqrt() * equivalent_strain(&f);
            let square = transposed_times(&f, &f);
            assert!(law.greatest_stress(&square) <= stress_most(&law, &square));
            assert!(
                length <= strain_most(&square) && stretched(&law, &f) <= stretched_most(&law, &f)
            );
            // Volume is no part of the equivalent strain.
            assert!(
                size > 0.01 || strain_most(&square) < 5.0 * length,
                "{length} {k}"
            );
        }
    }

    #[test]
    fn a_link_over_a_broken_place_is_crossed() {
        let broken = || std::iter::once([1.0, 0.0, 0.0]);
        assert!(crossed([0.0; 3], [2.0, 0.0, 0.0], broken()));
        assert!(!crossed([0.0; 3], [1.0, 1.0, 0.0], broken()));
        assert!(!crossed([0.0; 3], [-1.0, 0.0, 0.0], broken()));
    }
}
