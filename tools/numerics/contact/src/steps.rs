//! How long an explicit step may be.
//!
//! Leap-frog steps of an undamped oscillator are stable below 2/omega. Two equal grains swing along the normal with
//! `omega^2 = 2 k / m` and across it, where the springs also turn them, with `omega^2 = 2 k_t / m (1 + 1/c)`; c is the inertia
//! factor I / (m r^2), 2/5 for a solid sphere. A grain with n contacts is held by n springs: by Gershgorin's circles no mode is
//! faster than n times the square of the pair's, and `sqrt(n)` divides the step.
//!
//! The dashpot shortens the step: with the share zeta of critical damping, by `sqrt(1 + zeta^2) - zeta`.

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
    /// Bound of the normal spring alone \[s\], with `contacts` on a grain.
    #[must_use]
    pub fn normal_bound(&self, contacts: f64) -> f64 {
        self.bound(2.0 * self.stiffness / self.mass * contacts)
    }

    /// Bound of the tangential spring, which turns the grains \[s\]; without end where there is no friction.
    #[must_use]
    pub fn tangential_bound(&self, contacts: f64) -> f64 {
        let square = 2.0 * self.tangential / self.mass * (1.0 + 1.0 / self.inertia_factor);
        self.bound(square * contacts)
    }

    fn bound(&self, omega_squared: f64) -> f64 {
        let zeta = self.damping_ratio;
        2.0 / omega_squared.sqrt() * (zeta.hypot(1.0) - zeta)
    }
}
