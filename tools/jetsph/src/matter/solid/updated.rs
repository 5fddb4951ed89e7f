//! An elastic solid in the updated form of Shinohara et al. (2004, section 2.3), by the rates of its present state.
//!
//! ```text
//! d(rho)/dt = -rho tr L,   L = sum V_j (u_j - u_i) grad W_ij                                            (22), (36), (37)
//! dS/dt     = 2 G (D - tr D/3) + w S - S w,   D = sym L,   w = skew L                                             (34)
//! du/dt     = sum m_j (T_i + T_j + f^4 (R_i + R_j)) . grad W_ij,   T = (S - p)/rho^2                               (26)
//! p         = K (rho/rho0 - 1)                                                                                    (32)
//! R         = -s T+,    f = W(r)/W(d)                        Gray, Monaghan and Swift (2001), artificial stress
//! ```
//!
//! T+ is the part of T that pulls along its principal axes. Without R particles clump where the solid is pulled, and it breaks where
//! nothing should: the source does not mention R. The form knows no fit and no faces; it is the control of the other one.

use kernels::Kernel;
use particles::{Column, POSITION, Set, sweep};
use steps::Limit;

use super::elastic::{EQUIVALENT_STRAIN, STRESS};
use super::tensor::{Matrix, eigenvectors, inner, trace};
use crate::matter::meeting::faces::PULL;
use crate::matter::water::near::{LISTED, Near};
use crate::stage::{Entry, Stage, StageError};
use crate::state::{ACCELERATION, DENSITY, DENSITY_RATE, MASS, State, VELOCITY};

/// S \[Pa\].
const DEVIATOR: Column<Matrix> = Column::new("deviator", "Pa", [[0.0; 3]; 3]).saved();
/// Part of h that sound may go in a step.
const COURANT: f64 = 0.3;
/// Nothing.
const NONE: Matrix = [[0.0; 3]; 3];

/// What a scene says of the solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hooke {
    /// rho0 \[kg/m3\].
    pub density: f64,
    /// K \[Pa\].
    pub bulk: f64,
    /// G \[Pa\].
    pub shear: f64,
    /// s, the artificial stress; 0 for none.
    pub artificial: f64,
    /// d, the spacing \[m\].
    pub spacing: f64,
}

/// The stage.
pub struct Updated<const D: usize, K> {
    set: usize,
    law: Hooke,
    kernel: K,
    near: Near,
}

impl<const D: usize, K: Kernel> Updated<D, K> {
    /// The stage of a free body.
    #[must_use]
    pub fn new(set: usize, law: Hooke, kernel: K) -> Self {
        Self {
            set,
            law,
            near: Near::new(0.5 * kernel.support()),
            kernel,
        }
    }

    /// Finds neighbours where that is due.
    fn look(&mut self, set: &mut Set, exchanges: u64) {
        let mut listed = set.take(&LISTED);
        self.near
            .refresh(set.column(&POSITION), &mut listed, exchanges);
        set.put(&LISTED, listed);
    }

    /// Calls `visit` with the others within the support: number, offset \[m\], distance \[m\] and grad W = slope . offset.
    fn around(&self, x: &[[f64; 3]], a: usize, mut visit: impl FnMut(usize, [f64; 3], f64, f64)) {
        for b in self.near.rows.row(a) {
            let b = *b as usize;
            let dx = [0, 1, 2].map(|k| x[a][k] - x[b][k]);
            let r = (dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]).sqrt();
            if r < self.kernel.support() {
                visit(b, dx, r, self.kernel.slope(r));
            }
        }
    }

    /// L.
    fn gradient(&self, set: &Set, a: usize) -> Matrix {
        let (x, u) = (set.column(&POSITION), set.column(&VELOCITY));
        let (mass, density) = (set.column(&MASS), set.column(&DENSITY));
        let mut sum = NONE;
        self.around(x, a, |b, dx, _, slope| {
            let weight = mass[b] / density[b] * slope;
            for i in 0..D {
                (0..D).for_each(|j| sum[i][j] += weight * (u[b][i] - u[a][i]) * dx[j]);
            }
        });
        sum
    }

    /// Pressure \[Pa\] at a density \[kg/m3\].
    fn pressure(&self, density: f64) -> f64 {
        self.law.bulk * (density / self.law.density - 1.0)
    }

    /// Stress \[Pa\].
    fn stress(&self, density: f64, deviator: &Matrix) -> Matrix {
        let mut stress = *deviator;
        let p = self.pressure(density);
        (0..3).for_each(|k| stress[k][k] -= p);
        stress
    }

    /// T and R.
    fn borne(&self, density: f64, deviator: &Matrix) -> [Matrix; 2] {
        let scale = 1.0 / (density * density);
        let whole = self
            .stress(density, deviator)
            .map(|row| row.map(|x| scale * x));
        let mut own = NONE;
        (0..D).for_each(|i| (0..D).for_each(|j| own[i][j] = whole[i][j]));
        if self.law.artificial <= 0.0 {
            return [own, NONE];
        }
        let (values, axes) = eigenvectors(&own);
        let back = |i: usize, j: usize| -> f64 {
            let pulls = (0..3).map(|k| values[k].max(0.0) * axes[i][k] * axes[j][k]);
            -self.law.artificial * pulls.sum::<f64>()
        };
        [own, [0, 1, 2].map(|i| [0, 1, 2].map(|j| back(i, j)))]
    }
}

/// dS/dt \[Pa/s\] at a gradient of velocity.
fn rate(shear: f64, gradient: &Matrix, deviator: &Matrix) -> Matrix {
    let third = trace(gradient) / 3.0;
    let turn = |i: usize, j: usize| 0.5 * (gradient[i][j] - gradient[j][i]);
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            let own = if i == j { third } else { 0.0 };
            let strain = 0.5 * (gradient[i][j] + gradient[j][i]) - own;
            let turned: f64 = (0..3)
                .map(|k| turn(i, k) * deviator[k][j] - deviator[i][k] * turn(k, j))
                .sum();
            2.0 * shear * strain + turned
        })
    })
}

impl<const D: usize, K: Kernel> Stage for Updated<D, K> {
    fn name(&self) -> &'static str {
        "updated_elastic"
    }

    fn declare(&self, state: &mut State) {
        let set = &mut state.sets[self.set];
        set.declare(&DENSITY);
        set.column_mut(&DENSITY).fill(self.law.density);
        set.declare(&DENSITY_RATE);
        set.declare(&DEVIATOR);
        set.declare(&LISTED);
        set.declare(&STRESS);
        set.declare(&EQUIVALENT_STRAIN);
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let velocity = state.sets[self.set].column(&VELOCITY);
        let speed = |a: usize| velocity[a][0].hypot(velocity[a][1]).hypot(velocity[a][2]);
        let speed = sweep::greatest(velocity.len(), speed).map_or(0.0, |(_, most)| most);
        let Hooke {
            bulk,
            shear,
            density,
            ..
        } = self.law;
        let sound = ((bulk + 4.0 / 3.0 * shear) / density).sqrt();
        Some(Limit::dividing(
            "elastic_waves",
            COURANT * 0.5 * self.kernel.support() / (sound + speed),
        ))
    }

    fn flows(&self) -> bool {
        true
    }

    fn flow(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let exchanges = state.exchanges;
        let set = &mut state.sets[self.set];
        self.look(set, exchanges);
        let mut gradients = vec![NONE; set.len()];
        sweep::fill(&mut gradients, |a| self.gradient(set, a));
        let mut deviator = set.take(&DEVIATOR);
        sweep::change(&mut deviator, |a, s| {
            let rate = rate(self.law.shear, &gradients[a], s);
            (0..3).for_each(|i| (0..3).for_each(|j| s[i][j] += dt * rate[i][j]));
        });
        set.put(&DEVIATOR, deviator);
        let mut rates = set.take(&DENSITY_RATE);
        let density = set.column(&DENSITY);
        sweep::change(&mut rates, |a, rate| {
            *rate -= density[a] * trace(&gradients[a]);
        });
        set.put(&DENSITY_RATE, rates);
        Ok(())
    }

    fn act(&mut self, state: &mut State, _: f64) -> Result<(), StageError> {
        let exchanges = state.exchanges;
        let set = &mut state.sets[self.set];
        self.look(set, exchanges);
        let (density, deviator) = (set.column(&DENSITY), set.column(&DEVIATOR));
        let mut borne = vec![[NONE; 2]; set.len()];
        sweep::fill(&mut borne, |a| self.borne(density[a], &deviator[a]));
        let mut acceleration = set.take(&ACCELERATION);
        let (x, mass, pull) = (set.column(&POSITION), set.column(&MASS), set.column(&PULL));
        let beside = self.kernel.value(self.law.spacing);
        sweep::change(&mut acceleration, |a, own| {
            self.around(x, a, |b, dx, r, slope| {
                let near = (self.kernel.value(r) / beside).powi(4);
                for (i, own) in own.iter_mut().enumerate().take(D) {
                    for (j, dx) in dx.iter().enumerate().take(D) {
                        let both = borne[a][0][i][j] + borne[b][0][i][j];
                        let back = borne[a][1][i][j] + borne[b][1][i][j];
                        *own += mass[b] * slope * (both + near * back) * dx;
                    }
                }
            });
            if let Some(pull) = pull.get(a) {
                (0..3).for_each(|k| own[k] += pull[k] / mass[a]);
            }
        });
        set.put(&ACCELERATION, acceleration);
        Ok(())
    }

    fn show(&self, state: &mut State) {
        let set = &mut state.sets[self.set];
        let (density, deviator) = (
            set.column(&DENSITY).to_vec(),
            set.column(&DEVIATOR).to_vec(),
        );
        sweep::fill(set.column_mut(&STRESS), |a| {
            self.stress(density[a], &deviator[a])
        });
        sweep::fill(set.column_mut(&EQUIVALENT_STRAIN), |a| {
            (1.5 * inner(&deviator[a], &deviator[a])).sqrt() / (3.0 * self.law.shear)
        });
    }

    fn entry(&self, state: &State) -> Entry {
        let set = &state.sets[self.set];
        let (density, deviator) = (set.column(&DENSITY), set.column(&DEVIATOR));
        let mass = set.column(&MASS);
        let energy = |a: usize| {
            // Of a kilogram: int p/rho^2 d(rho), and S:S/4 G by volume.
            let part = density[a] / self.law.density;
            let squeezed = self.law.bulk / self.law.density * (part.ln() + 1.0 / part - 1.0);
            let sheared = inner(&deviator[a], &deviator[a]) / (4.0 * self.law.shear * density[a]);
            [mass[a] * (squeezed + sheared)]
        };
        Entry {
            stored: sweep::sum(set.len(), energy)[0],
            ..Entry::default()
        }
    }

    fn bytes(&self) -> usize {
        self.near.bytes()
    }

    fn save(&self) -> Vec<f64> {
        vec![self.near.save()]
    }

    fn restore(&mut self, state: &State, saved: &[f64]) {
        if let [seen] = saved {
            self.near
                .restore(state.sets[self.set].column(&LISTED), *seen);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_turns_the_stress_and_pulling_raises_it() {
        let deviator = [[2.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
        let turn = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]];
        let found = rate(5.0, &turn, &deviator);
        // R S R^T of a small angle: the shear grows by the difference of the diagonal.
        assert!((found[0][1] - 3.0).abs() < 1e-15 && (found[1][0] - 3.0).abs() < 1e-15);
        assert!(found[0][0].abs() < 1e-15);
        let pull = [[0.3, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0; 3]];
        let found = rate(5.0, &pull, &NONE);
        assert!((found[0][0] - 2.0).abs() < 1e-15 && (found[2][2] + 1.0).abs() < 1e-15);
    }
}
