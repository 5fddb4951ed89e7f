//! Plastic flow of metals: J2 with linear isotropic hardening, at large strains.
//!
//! ```text
//! b_e = F G F^T = sum exp(2 e_k) n_k n_k,      G = C_p^-1, the plastic strain so far
//! tau_k = 2 mu dev e_k + K tr e,                q = sqrt(3/2) |dev tau| <= Y + H a
//! dev e -> r dev e,   r = 1 - 3 mu da/q,        da = (q - Y - H a)/(3 mu + H)        where q is more
//! ```
//!
//! Logarithmic strains, and a radial return of their deviator that keeps the plastic volume exactly (Simo 1992; Simo and
//! Hughes 1998, box 9.1). The strain that varies across a cell flows with its middle: its deviator returns by the same r.
//! What flow takes is Y a + H a^2/2 by volume, and what the varying part takes beside it.

use schemars::JsonSchema;
use serde::Deserialize;

use super::law::Law;
use super::tensor::{Matrix, UNIT, determinant, eigenvectors, product, times_transposed};

/// Yield stress and hardening.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plasticity {
    /// Yield stress Y in uniaxial tension.
    #[schemars(extend("x-unit" = "Pa", "exclusiveMinimum" = 0.0))]
    pub yield_stress_pa: f64,
    /// Hardening H: increase of the yield stress per plastic strain.
    #[serde(default)]
    #[schemars(range(min = 0.0), extend("x-unit" = "Pa"))]
    pub hardening_pa: f64,
}

/// What a cell has suffered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct History {
    /// G.
    pub inverse: Matrix,
    /// Plastic parts of the strains that vary along each axis \[1/m\].
    pub bent: [Matrix; 3],
    /// a, the equivalent plastic strain.
    pub strain: f64,
    /// What the varying part has taken \[J/m3\].
    pub lost: f64,
}

/// Numbers of a history.
const NUMBERS: usize = 9 + 27 + 2;

impl History {
    /// Nothing yet.
    pub const NONE: Self = Self {
        inverse: UNIT,
        bent: [[[0.0; 3]; 3]; 3],
        strain: 0.0,
        lost: 0.0,
    };

    /// The numbers that a checkpoint keeps.
    #[must_use]
    pub fn save(&self) -> Vec<f64> {
        let bent = self.bent.as_flattened().as_flattened();
        [self.inverse.as_flattened(), bent, &[self.strain, self.lost]].concat()
    }

    /// Takes them back, one history after another.
    #[must_use]
    pub fn restored(saved: &[f64]) -> Vec<Self> {
        let matrix = |x: &[f64]| -> Matrix { [0, 1, 2].map(|i| [0, 1, 2].map(|j| x[3 * i + j])) };
        let one = |x: &[f64]| Self {
            inverse: matrix(&x[..9]),
            bent: [0, 1, 2].map(|k| matrix(&x[9 + 9 * k..18 + 9 * k])),
            strain: x[36],
            lost: x[37],
        };
        saved.chunks_exact(NUMBERS).map(one).collect()
    }
}

/// Stress of a cell whose solid flows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flowing {
    /// tau \[Pa\].
    pub kirchhoff: Matrix,
    /// Energy that the elastic strain stores \[J/m3\].
    pub energy: f64,
    /// r: 1 where nothing flows.
    pub kept: f64,
}

impl Plasticity {
    /// Stress at a deformation after a history, which flows on.
    #[must_use]
    pub fn flow(&self, law: &Law, deformation: &Matrix, history: &mut History) -> Flowing {
        let elastic = times_transposed(&product(deformation, &history.inverse), deformation);
        let (squares, axes) = eigenvectors(&elastic);
        let strain = squares.map(|square| 0.5 * square.ln());
        let volume = strain[0] + strain[1] + strain[2];
        let deviator = strain.map(|e| e - volume / 3.0);
        let length = deviator.iter().map(|e| e * e).sum::<f64>().sqrt();
        let stress = 2.0 * law.shear * 1.5_f64.sqrt() * length;
        let beyond = stress - self.yield_stress_pa - self.hardening_pa * history.strain;
        let mut kept = 1.0;
        if beyond > 0.0 {
            let more = beyond / (3.0 * law.shear + self.hardening_pa);
            kept = 1.0 - 3.0 * law.shear * more / stress;
            history.strain += more;
        }
        let left = deviator.map(|e| kept * e);
        if kept < 1.0 {
            let squares = left.map(|e| (2.0 * (e + volume / 3.0)).exp());
            let back = inverse(deformation);
            let plastic = times_transposed(&product(&back, &spread(squares, &axes)), &back);
            history.inverse = symmetric(&plastic);
        }
        let bulk = law.lame + 2.0 / 3.0 * law.shear;
        let own: f64 = left.iter().map(|e| e * e).sum();
        Flowing {
            kirchhoff: spread(left.map(|e| 2.0 * law.shear * e + bulk * volume), &axes),
            energy: law.shear * own + 0.5 * bulk * volume * volume,
            kept,
        }
    }

    /// What flow has taken by volume \[J/m3\].
    #[must_use]
    pub fn taken(&self, history: &History) -> f64 {
        let a = history.strain;
        self.yield_stress_pa * a + 0.5 * self.hardening_pa * a * a + history.lost
    }
}

/// A^-1.
pub(super) fn inverse(a: &Matrix) -> Matrix {
    let cofactor = super::tensor::cofactor(a);
    let det = determinant(a);
    [0, 1, 2].map(|i| [0, 1, 2].map(|j: usize| cofactor[j][i] / det))
}

/// sum x_k n_k n_k, the axes n as columns.
fn spread(values: [f64; 3], axes: &Matrix) -> Matrix {
    [0, 1, 2].map(|i: usize| {
        [0, 1, 2].map(|j: usize| (0..3).map(|k| values[k] * axes[i][k] * axes[j][k]).sum())
    })
}

fn symmetric(a: &Matrix) -> Matrix {
    [0, 1, 2].map(|i: usize| [0, 1, 2].map(|j: usize| 0.5 * (a[i][j] + a[j][i])))
}

#[cfg(test)]
mod tests {
    use super::super::law::{Elastic, Young};
    use super::*;

    const STEEL: Plasticity = Plasticity {
        yield_stress_pa: 2e8,
        hardening_pa: 2e9,
    };

    fn law() -> Law {
        let young = Young {
            youngs_modulus_pa: 2e11,
            poisson_ratio: 0.3,
        };
        Law::new(&Elastic::Young(young), None)
    }

    /// Pulls along x with free sides: the stretch across that leaves no stress there, by bisection.
    fn pulled(history: &History, stretch: f64) -> (f64, History) {
        let (mut low, mut high) = (0.8, 1.2);
        let at = |side: f64| {
            let mut own = *history;
            let f = [[stretch, 0.0, 0.0], [0.0, side, 0.0], [0.0, 0.0, side]];
            let found = STEEL.flow(&law(), &f, &mut own);
            (found.kirchhoff, own)
        };
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if at(middle).0[1][1] > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let (tau, own) = at(low);
        (tau[0][0], own)
    }

    #[test]
    fn a_pull_follows_the_yield_stress_and_comes_back_elastically() {
        let mut history = History::NONE;
        let mut last = 0.0;
        for k in 1..=50 {
            (last, history) = pulled(&history, (0.002 * f64::from(k)).exp());
        }
        // e = tau/E + a, tau = Y + H a.
        let strain = 0.1;
        let exact = (2e8 + 2e9 * strain) / (1.0 + 2e9 / 2e11);
        assert!((last / exact - 1.0).abs() < 1e-6, "{last} {exact}");
        let (back, same) = pulled(&history, (0.1_f64 - 0.5e-3).exp());
        assert!((back - (last - 1e8)).abs() < 1e-4 * last, "{back}");
        assert!((same.strain - history.strain).abs() <= 0.0);
        assert!((determinant(&history.inverse) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn turning_flows_nothing_and_turns_the_stress() {
        let (_, mut history) = pulled(&History::NONE, 1.05);
        let (tau, before) = (pulled(&history, 1.05).0, history);
        let (s, c) = 0.8_f64.sin_cos();
        let turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
        let side = {
            // Volume of the elastic part alone changes.
            let sides = times_transposed(&UNIT, &history.inverse);
            (1.0 / sides[1][1].sqrt()) * (-0.3 * tau / 2e11).exp()
        };
        let f = [[1.05, 0.0, 0.0], [0.0, side, 0.0], [0.0, 0.0, side]];
        let found = STEEL
            .flow(&law(), &product(&turn, &f), &mut history)
            .kirchhoff;
        let exact = [tau * c * c, tau * s * s, tau * s * c];
        for (found, exact) in [found[0][0], found[1][1], found[0][1]].iter().zip(exact) {
            assert!((found - exact).abs() < 1e-3 * tau, "{found} {exact}");
        }
        assert!((history.strain - before.strain).abs() < 1e-6);
    }
}
