//! How long an explicit step may be.
//!
//! Leap-frog steps of an undamped oscillator are stable below 2/omega. Two equal grains swing along the normal with
//! `omega^2 = 2 k / m` and across it, where the springs also turn them, with `omega^2 = 2 k_t / m (1 + 1/c)`; c is the inertia
//! factor I / (m r^2), 2/5 for a solid sphere. A grain with n contacts is held by n springs: by Gershgorin's circles no mode is
//! faster than n times the square of the pair's, and `sqrt(n)` divides the step.
//!
//! The dashpot shortens the step. Where it feels the velocities at the end of the step as the last forces predict them,
//! `h^2 w^2 + 8 z h w <= 4`: the step is 2/w times `sqrt(1 + 4 z^2) - 2 z`. A contact alone has z = zeta, its share of critical
//! damping; n contacts on a grain, each turning it too, have `z = zeta sqrt(n (1 + 1/c))`.

/// Inertia factor of a solid sphere, I / (m r^2).
pub const SOLID_SPHERE: f64 = 0.4;

/// What bounds a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Mass of the lighter grain \[kg\].
    pub mass: f64,
    /// Normal stiffness \[N/m\].
    pub stiffness: f64,
    /// Tangential stiffness \[N/m\]; zero without friction.
    pub tangential: f64,
    /// Inertia factor I / (m r^2).
    pub inertia_factor: f64,
    /// Share of critical damping.
    pub damping_ratio: f64,
}

impl Pair {
    /// Bound along the normal \[s\], with `contacts` on a grain.
    #[must_use]
    pub fn normal_bound(&self, contacts: f64) -> f64 {
        self.bound(self.stiffness, contacts)
    }

    /// Bound of the tangential spring, which turns the grains \[s\]; without end where there is no friction.
    #[must_use]
    pub fn tangential_bound(&self, contacts: f64) -> f64 {
        self.bound(
            self.tangential,
            contacts * (1.0 + 1.0 / self.inertia_factor),
        )
    }

    /// The bound of a spring and its dashpot that act `times` as strongly as those of one contact alone.
    fn bound(&self, stiffness: f64, times: f64) -> f64 {
        let omega = (2.0 * stiffness / self.mass * times).sqrt();
        let twice = 2.0 * self.damping_ratio * times.sqrt();
        2.0 / omega * (twice.hypot(1.0) - twice)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether two grains on `springs` springs and dashpots side by side swing ever more at steps of `h` \[s\].
    fn grows(pair: &Pair, springs: f64, h: f64) -> bool {
        let mass = 0.5 * pair.mass;
        let (k, eta) = (
            springs * pair.stiffness,
            springs * 2.0 * pair.damping_ratio * (mass * pair.stiffness).sqrt(),
        );
        let force = |x: f64, u: f64| -(k * x + eta * u) / mass;
        let (mut x, mut u) = (1e-6, 0.0);
        let mut a = force(x, u);
        for _ in 0..4000 {
            x += h * u + 0.5 * h * h * a;
            u += h * a;
            let new = force(x, u);
            u += 0.5 * h * (new - a);
            a = new;
        }
        let bounded = x.abs() < 1e-5;
        !bounded
    }

    #[test]
    fn predicted_dashpots_are_stable_up_to_the_bound_and_not_beyond() {
        for zeta in [0.0, 0.05, 0.3, 1.0, 3.0] {
            for springs in [1.0, 4.0, 12.0] {
                let pair = Pair {
                    mass: 2e-7,
                    stiffness: 75.0,
                    tangential: 0.0,
                    inertia_factor: SOLID_SPHERE,
                    damping_ratio: zeta,
                };
                let bound = pair.normal_bound(springs);
                assert!(!grows(&pair, springs, 0.999 * bound), "{zeta} {springs}");
                assert!(grows(&pair, springs, 1.01 * bound), "{zeta} {springs}");
            }
        }
    }
}
