//! Diffusion of density, which smooths the noise of pressure.
//!
//! ```text
//! D_i = delta h c sum_j psi_ij . grad W_ij V_j
//! Molteni and Colagrossi (2009)   psi = 2 (rho_j - rho_i) x_ji/r^2
//! Antuono et al. (2010)           psi = 2 (rho_j - rho_i) x_ji/r^2 - (g_i + g_j),   g the corrected slope of rho
//! ```
//!
//! The second leaves the slope of water at rest alone and costs one sweep more.

use schemars::JsonSchema;
use serde::Deserialize;

/// Which form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// Molteni and Colagrossi (2009).
    Molteni,
    /// Antuono et al. (2010).
    Antuono,
}

/// Diffusion of density in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DensityDiffusion {
    /// Formula of the diffusion.
    pub form: Form,
    /// Coefficient delta.
    #[serde(default = "usual")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0), range(max = 0.5))]
    pub delta: f64,
}

fn usual() -> f64 {
    0.1
}

/// Solves A x = b for a symmetric matrix in `dimensions` axes, where it is well conditioned; 0 where it is not.
#[must_use]
pub fn corrected(a: [[f64; 3]; 3], b: [f64; 3], dimensions: usize) -> [f64; 3] {
    let mut a = a;
    if dimensions == 2 {
        a[2] = [0.0, 0.0, 1.0];
    }
    let det = crate::matter::solid::tensor::determinant(&a);
    // 1 in the whole, 1/2 beside a flat surface, near 0 where a particle is alone.
    if det.abs() < 0.02 {
        return [0.0; 3];
    }
    let c = crate::matter::solid::tensor::cofactor(&a);
    std::array::from_fn(|i| (c[0][i] * b[0] + c[1][i] * b[1] + c[2][i] * b[2]) / det).map(
        |x: f64| {
            if x.is_finite() { x } else { 0.0 }
        },
    )
}
