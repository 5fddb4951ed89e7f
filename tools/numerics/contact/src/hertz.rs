//! Elastic spheres.
//!
//! ```text
//! N   = K d^(3/2) + alpha sqrt(m K) d^(1/4) d',     K = 4/3 E* sqrt(R*)        (Hertz 1881; Tsuji et al. 1992)
//! k_t = 8 G* sqrt(R* d)                                                        (Mindlin 1949)
//! 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b,   1/G* = 2(2 - nu_a)(1 + nu_a)/E_a + 2(2 - nu_b)(1 + nu_b)/E_b
//! ```
//!
//! With alpha = sqrt(5) zeta the restitution is that of a linear contact of the damping ratio zeta, at any speed (Antypov and
//! Elliott 2011).

use crate::meeting::Meeting;
use crate::normal::Normal;
use crate::restitution::Ending;

/// What a grain or wall is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Young's modulus E \[Pa\].
    pub youngs_modulus: f64,
    /// Poisson's ratio nu, between -1 and 1/2.
    pub poisson_ratio: f64,
}

/// The contact of two elastic spheres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    modulus: f64,
    shear: f64,
    damping_ratio: f64,
    ending: Ending,
}

impl Hertz {
    /// The contact of materials a and b, whose `restitution` is above 0 and at most 1.
    #[must_use]
    pub fn new([a, b]: [Elastic; 2], restitution: f64, ending: Ending) -> Self {
        let flat = |s: Elastic| (1.0 - s.poisson_ratio * s.poisson_ratio) / s.youngs_modulus;
        let across =
            |s: Elastic| 2.0 * (2.0 - s.poisson_ratio) * (1.0 + s.poisson_ratio) / s.youngs_modulus;
        Self {
            modulus: 1.0 / (flat(a) + flat(b)),
            shear: 1.0 / (across(a) + across(b)),
            damping_ratio: ending.damping_ratio(restitution),
            ending,
        }
    }

    /// Effective modulus E* \[Pa\].
    #[must_use]
    pub fn modulus(&self) -> f64 {
        self.modulus
    }

    /// Greatest overlap \[m\] of an elastic impact of effective mass m and radius R at speed v: `(15 m v^2 / (16 E* sqrt(R)))^(2/5)`.
    #[must_use]
    pub fn deepest(&self, mass: f64, radius: f64, speed: f64) -> f64 {
        (15.0 * mass * speed * speed / (16.0 * self.modulus * radius.sqrt())).powf(0.4)
    }

    /// Duration \[s\] of an elastic impact: 2.943275 times the greatest overlap over the speed.
    #[must_use]
    pub fn elastic_duration(&self, mass: f64, radius: f64, speed: f64) -> f64 {
        // 4 sqrt(pi) Gamma(2/5) / (5 Gamma(9/10))
        2.943_275_105_6 * self.deepest(mass, radius, speed) / speed
    }

    #[inline(always)]
    fn spring(&self, meeting: &Meeting) -> f64 {
        4.0 / 3.0 * self.modulus * meeting.radius.sqrt()
    }
}

impl Normal for Hertz {
    const STIFFENS: bool = true;

    #[inline(always)]
    fn push(&self, meeting: &Meeting) -> f64 {
        let spring = self.spring(meeting);
        let root = meeting.overlap.sqrt();
        let damping = 5.0_f64.sqrt() * self.damping_ratio * (meeting.mass * spring * root).sqrt();
        let push = spring * meeting.overlap * root + damping * meeting.approach;
        match self.ending {
            Ending::ZeroForce => push.max(0.0),
            Ending::ZeroOverlap => push,
        }
    }

    #[inline(always)]
    fn stiffness(&self, meeting: &Meeting) -> f64 {
        1.5 * self.spring(meeting) * meeting.overlap.sqrt()
    }

    #[inline(always)]
    fn tangential(&self, meeting: &Meeting) -> f64 {
        8.0 * self.shear * (meeting.radius * meeting.overlap).sqrt()
    }

    #[inline(always)]
    fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }
}
