//! Friction between particles that approach, as a pressure q_ij beside theirs.
//!
//! ```text
//! artificial  q = rho0 (-A c theta + B theta^2) where theta < 0,   theta = h (u_ij . x_ij)/(r^2 + C h^2)     (38), (39)
//! viscous     q = -2 (D + 2) mu (u_ij . x_ij)/(r^2 + 0.01 h^2)                  Monaghan and Gingold (1983)
//! ```
//!
//! In print (39) has C h for C h^2, which mixes units. Both act along the line of centres, so that momentum and angular
//! momentum stay, and both take energy from all motion.

use kernels::Number;
use schemars::JsonSchema;
use serde::Deserialize;

/// Artificial viscosity in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArtificialViscosity {
    /// A of the linear term; 0.01 in water and 2.5 in solids of the source.
    #[schemars(range(min = 0.0), extend("x-unit" = "1"))]
    pub linear: f64,
    /// B of the quadratic term.
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("x-unit" = "1"))]
    pub quadratic: f64,
    /// C in r^2 + C h^2 (eq. 39), which limits the viscosity of particles that nearly coincide.
    #[serde(default = "ArtificialViscosity::usual_guard")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0.0))]
    pub guard: f64,
}

impl ArtificialViscosity {
    /// The C of the source.
    #[must_use]
    pub fn usual_guard() -> f64 {
        0.1
    }
}

/// A friction.
pub trait Friction: Sync {
    /// q \[Pa\] of a pair, or of several, with u_ij . x_ij \[m2/s\] and r^2 \[m2\].
    fn pressure<N: Number>(&self, approach: N, square: N) -> N;
}

/// None.
impl Friction for () {
    #[inline(always)]
    fn pressure<N: Number>(&self, approach: N, _: N) -> N {
        approach.of(0.0)
    }
}

/// Artificial viscosity between particles of one smoothing length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Artificial {
    /// rho0 A c h \[kg/(m s)\].
    pub linear: f64,
    /// rho0 B h^2 \[kg/m\].
    pub quadratic: f64,
    /// C h^2 \[m2\].
    pub guard: f64,
}

impl Artificial {
    /// For a density \[kg/m3\], a speed of sound \[m/s\] and h \[m\].
    #[must_use]
    pub fn new(of: &ArtificialViscosity, density: f64, sound: f64, h: f64) -> Self {
        Self {
            linear: density * of.linear * sound * h,
            quadratic: density * of.quadratic * h * h,
            guard: of.guard * h * h,
        }
    }
}

impl Friction for Artificial {
    #[inline(always)]
    fn pressure<N: Number>(&self, approach: N, square: N) -> N {
        let rate = approach.least(square.of(0.0)) / (square + square.of(self.guard));
        rate * (square.of(self.quadratic) * rate - square.of(self.linear))
    }
}

/// Artificial viscosity between particles that approach and, with the opposite sign, between those that part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BothWays(pub Artificial);

impl Friction for BothWays {
    #[inline(always)]
    fn pressure<N: Number>(&self, approach: N, square: N) -> N {
        let parting = square.of(0.0) - approach;
        self.0.pressure(approach, square) - self.0.pressure(parting, square)
    }
}

/// True viscosity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscous {
    /// 2 (D + 2) mu \[Pa s\].
    pub scale: f64,
    /// 0.01 h^2 \[m2\].
    pub guard: f64,
}

impl Viscous {
    /// For mu \[Pa s\] and h \[m\].
    #[must_use]
    pub fn new(viscosity: f64, h: f64, dimensions: usize) -> Self {
        Self {
            scale: 2.0 * (dimensions as f64 + 2.0) * viscosity,
            guard: 0.01 * h * h,
        }
    }
}

impl Friction for Viscous {
    #[inline(always)]
    fn pressure<N: Number>(&self, approach: N, square: N) -> N {
        square.of(-self.scale) * approach / (square + square.of(self.guard))
    }
}

impl<A: Friction, B: Friction> Friction for (A, B) {
    #[inline(always)]
    fn pressure<N: Number>(&self, approach: N, square: N) -> N {
        self.0.pressure(approach, square) + self.1.pressure(approach, square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_acts_against_what_moves() {
        let of = ArtificialViscosity {
            linear: 0.5,
            quadratic: 1.0,
            guard: 0.01,
        };
        let both = (
            Artificial::new(&of, 1000.0, 50.0, 1.5e-3),
            Viscous::new(1e-3, 1.5e-3, 2),
        );
        assert!(both.0.pressure(-1e-3, 1e-6) > 0.0);
        assert!(both.0.pressure(1e-3, 1e-6).abs() <= 0.0);
        let tension = BothWays(both.0);
        for approach in [-1e-3, 1e-3] {
            let [one, other] = [approach, -approach].map(|a| tension.pressure(a, 1e-6));
            assert!(one * approach < 0.0 && (one + other).abs() <= 0.0);
        }
        assert!(both.1.pressure(1e-3, 1e-6) < 0.0 && both.pressure(-1e-3, 1e-6) > 0.0);
    }
}
