//! Elastic stress: a compressible neo-Hookean solid, which is Hooke's at small strains.
//!
//! ```text
//! psi = mu/2 (F:F - 3 - 2 ln J) + lambda/2 ln^2 J          energy per reference volume
//! P   = mu (F - F^-T) + lambda ln J F^-T                   first Piola-Kirchhoff stress
//! ```
//!
//! (Bonet and Wood 2008, eqs 6.27 and 6.28.) Turning the solid turns the stress along, and nothing else: P(RF) = R P(F).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::tensor::{
    Matrix, cofactor, determinant, eigenvalues, inner, times_transposed, transposed_times,
};

/// What happens across the plane of a scene of two dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Plane {
    /// No strain across the plane: a long body.
    #[default]
    Strain,
    /// No stress across the plane: a thin sheet.
    Stress,
}

/// Elastic constants.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Elastic {
    /// Young's modulus and Poisson's ratio.
    Young(Young),
    /// Bulk and shear modulus.
    Bulk(Bulk),
}

/// Elastic constants of engineers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Young {
    /// E \[Pa\].
    #[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0.0))]
    pub youngs_modulus_pa: f64,
    /// nu.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = -1.0, "exclusiveMaximum" = 0.5))]
    pub poisson_ratio: f64,
}

/// Elastic constants of continuum mechanics.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bulk {
    /// K \[Pa\].
    #[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0.0))]
    pub bulk_modulus_pa: f64,
    /// G \[Pa\].
    #[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0.0))]
    pub shear_modulus_pa: f64,
}

impl Elastic {
    /// K and G \[Pa\].
    #[must_use]
    pub fn moduli(&self) -> (f64, f64) {
        match *self {
            Self::Young(young) => {
                let (e, nu) = (young.youngs_modulus_pa, young.poisson_ratio);
                (e / (3.0 * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu)))
            }
            Self::Bulk(bulk) => (bulk.bulk_modulus_pa, bulk.shear_modulus_pa),
        }
    }
}

/// The law with its constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// lambda \[Pa\].
    pub lame: f64,
    /// mu \[Pa\].
    pub shear: f64,
    /// Whether the stretch across the plane follows from the absence of stress there.
    pub thin: bool,
}

/// Answer of the solid to a deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// P \[Pa\].
    pub stress: Matrix,
    /// How many times stiffer than at rest, at least 1 near rest.
    pub stiffer: f64,
}

impl Law {
    /// The law of elastic constants; `plane` is that of a scene of two dimensions.
    #[must_use]
    pub fn new(elastic: &Elastic, plane: Option<Plane>) -> Self {
        let (bulk, shear) = elastic.moduli();
        Self {
            lame: bulk - 2.0 / 3.0 * shear,
            shear,
            thin: plane == Some(Plane::Stress),
        }
    }

    /// Speed of compression waves at rest \[m/s\], for a density \[kg/m3\].
    #[must_use]
    pub fn wave_speed(&self, density: f64) -> f64 {
        ((self.lame + 2.0 * self.shear) / density).sqrt()
    }

    /// Stretch across a thin sheet: mu (s^2 - 1) + lambda ln(J s) = 0, J being that in the plane.
    #[inline(always)]
    fn across(&self, in_plane: f64) -> f64 {
        let Self { lame, shear, .. } = *self;
        let mut s = 1.0 - lame / (lame + 2.0 * shear) * (in_plane - 1.0).clamp(-0.5, 0.5);
        for _ in 0..6 {
            let error = shear * (s * s - 1.0) + lame * (in_plane * s).ln();
            s -= error / (2.0 * shear * s + lame / s);
        }
        s
    }

    /// The deformation with the stretch across the plane put in.
    #[inline(always)]
    #[must_use]
    pub fn completed(&self, mut deformation: Matrix) -> Matrix {
        if self.thin {
            let [a, b, _] = deformation;
            deformation[2][2] = self.across(a[0] * b[1] - a[1] * b[0]);
        }
        deformation
    }

    /// Stress of a completed deformation; not a number where it is turned inside out.
    #[inline(always)]
    #[must_use]
    pub fn answer(&self, deformation: &Matrix) -> Answer {
        let cofactor = cofactor(deformation);
        let volume = determinant(deformation);
        let rate = volume.ln();
        let scale = (self.lame * rate - self.shear) / volume;
        let stress = std::array::from_fn(|i| {
            std::array::from_fn(|j| self.shear * deformation[i][j] + scale * cofactor[i][j])
        });
        // The tangent grows as F^-T x F^-T, and with the pressure.
        let inverse = inner(&cofactor, &cofactor) / (volume * volume);
        let stiffer = (inverse - 2.0).max(1.0) * (1.0 - rate.min(0.0));
        Answer { stress, stiffer }
    }

    /// psi \[J/m3\] of a completed deformation.
    #[must_use]
    pub fn energy(&self, deformation: &Matrix) -> f64 {
        let rate = determinant(deformation).ln();
        let stretch = inner(deformation, deformation) - 3.0;
        0.5 * self.shear * (stretch - 2.0 * rate) + 0.5 * self.lame * rate * rate
    }

    /// Cauchy stress \[Pa\] of a completed deformation.
    #[must_use]
    pub fn cauchy(&self, deformation: &Matrix) -> Matrix {
        let volume = determinant(deformation);
        let scaled = times_transposed(&self.answer(deformation).stress, deformation);
        scaled.map(|row| row.map(|x| x / volume))
    }

    /// Greatest principal Cauchy stress \[Pa\] by C = F^T F of a completed deformation: (mu (c - 1) + lambda ln J)/J.
    #[must_use]
    pub(super) fn greatest_stress(&self, square: &Matrix) -> f64 {
        let volume = determinant(square).sqrt();
        let [most, ..] = eigenvalues(square);
        (self.shear * (most - 1.0) + self.lame * volume.ln()) / volume
    }
}

/// Equivalent strain of the principal logarithmic strains: sqrt(2/3) times the length of their deviator.
#[must_use]
pub fn equivalent_strain(deformation: &Matrix) -> f64 {
    strain_of(&transposed_times(deformation, deformation))
}

/// The same by C = F^T F.
#[must_use]
pub(super) fn strain_of(square: &Matrix) -> f64 {
    let stretches = eigenvalues(square);
    let strain = stretches.map(|square| 0.5 * square.max(f64::MIN_POSITIVE).ln());
    let mean = (strain[0] + strain[1] + strain[2]) / 3.0;
    let squares: f64 = strain.iter().map(|e| (e - mean) * (e - mean)).sum();
    (2.0 / 3.0 * squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::tensor::UNIT;
    use super::*;

    const RUBBER: Elastic = Elastic::Young(Young {
        youngs_modulus_pa: 2e6,
        poisson_ratio: 0.3975,
    });

    #[test]
    fn small_strains_obey_hooke() {
        let law = Law::new(&RUBBER, None);
        let mut deformation = UNIT;
        deformation[0][0] += 1e-7;
        deformation[0][1] += 2e-7;
        let stress = law.answer(&deformation).stress;
        let exact = (law.lame + 2.0 * law.shear) * 1e-7;
        assert!((stress[0][0] / exact - 1.0).abs() < 1e-6);
        assert!((stress[1][0] / (law.shear * 2e-7) - 1.0).abs() < 1e-6);
        assert!((stress[1][1] / (law.lame * 1e-7) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_stress_is_the_slope_of_the_energy() {
        let law = Law::new(&RUBBER, None);
        let deformation = [[1.1, 0.2, 0.0], [-0.1, 0.9, 0.05], [0.0, 0.1, 1.05]];
        let stress = law.answer(&deformation).stress;
        for i in 0..3 {
            for j in 0..3 {
                let (mut low, mut high) = (deformation, deformation);
                low[i][j] -= 1e-6;
                high[i][j] += 1e-6;
                let slope = (law.energy(&high) - law.energy(&low)) / 2e-6;
                assert!((slope - stress[i][j]).abs() < 1e-3 * law.shear);
            }
        }
    }

    #[test]
    fn a_thin_sheet_bears_nothing_across() {
        let law = Law::new(&RUBBER, Some(Plane::Stress));
        for stretch in [0.7, 1.0, 1.4] {
            let mut deformation = UNIT;
            deformation[0][0] = stretch;
            let answer = law.answer(&law.completed(deformation));
            assert!(answer.stress[2][2].abs() < 1e-9 * law.shear);
        }
    }

    #[test]
    fn a_pull_without_change_of_volume_strains_as_it_says() {
        let deformation = [
            [1.1, 0.0, 0.0],
            [0.0, 1.1_f64.powf(-0.5), 0.0],
            [0.0, 0.0, 1.1_f64.powf(-0.5)],
        ];
        assert!((equivalent_strain(&deformation) - 1.1_f64.ln()).abs() < 1e-12);
    }
}
