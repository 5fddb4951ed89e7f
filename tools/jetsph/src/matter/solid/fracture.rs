//! Fracture: particles that break, at once and for good.
//!
//! ```text
//! strain     e  >= limit,    e the equivalent strain of the principal strains         Shinohara et al. (2004), section 2.3
//! stress     s1 >= limit,    s1 the greatest principal stress
//! energy     G  >= limit,    G the energy that would go with the particle, by the area of the crack: see [`super::release`]
//! ```
//!
//! The formula of the equivalent strain is not in the source; it is von Mises' of the logarithmic principal strains. The
//! third makes the energy of a crack the same on any spacing. A broken particle keeps its mass and its motion and loses its links; those that they crossed are lost, too, so
//! that both sides of a crack are free surfaces. From then on it is a contact, which bears compression alone.

use particles::Column;
use schemars::JsonSchema;
use serde::Deserialize;

use super::law::{Law, equivalent_strain};
use super::tensor::{Matrix, eigenvalues, transposed_times};

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
        let volume = super::tensor::determinant(deformation);
        // What is no number is no volume.
        let is_one = volume > 0.0;
        if !is_one {
            return true;
        }
        match *self {
            Self::Strain(limit) => equivalent_strain(deformation) >= limit,
            Self::Stress(limit) => eigenvalues(&law.cauchy(deformation))[0] >= limit,
            Self::Energy(_) => false,
        }
    }
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
    use super::super::law::{Elastic, Young};
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
    fn a_link_over_a_broken_place_is_crossed() {
        let broken = || std::iter::once([1.0, 0.0, 0.0]);
        assert!(crossed([0.0; 3], [2.0, 0.0, 0.0], broken()));
        assert!(!crossed([0.0; 3], [1.0, 1.0, 0.0], broken()));
        assert!(!crossed([0.0; 3], [-1.0, 0.0, 0.0], broken()));
    }
}
