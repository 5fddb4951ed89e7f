//! Damping from the coefficient of restitution.
//!
//! A linear contact `m x'' + 2 zeta w m x' + m w^2 x = 0` with w = sqrt(k/m) that begins with x = 0 and speed v ends
//!
//! - where the overlap is zero again: `e = exp(-pi zeta / sqrt(1 - zeta^2))` after `pi / (w sqrt(1 - zeta^2))`; in its last
//!   part the dashpot pulls; or
//! - where the force is zero, so that nothing ever pulls (Schwager and Poeschel 2007): `e = exp(-zeta w t)` with
//!   `w_d t = atan2(2 zeta sqrt(1 - zeta^2), 2 zeta^2 - 1)`, `w_d = w sqrt(1 - zeta^2)`, and beyond critical damping
//!   `W t = ln((zeta + s) / (zeta - s))`, `s = sqrt(zeta^2 - 1)`, `W = w s`.
//!
//! The Hertz contact with damping of the power 1/4 of the overlap obeys the same relations: with y = x^(5/4) the equation of
//! v(y) is that of the linear contact (Antypov and Elliott 2011).

use std::f64::consts::PI;

/// Where a contact ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ending {
    /// Where the force is zero: grains never pull.
    #[default]
    ZeroForce,
    /// Where the overlap is zero: the dashpot pulls at the end (Komen 2019, eq. 3.108).
    ZeroOverlap,
}

impl Ending {
    /// Share of critical damping that makes a linear contact bounce with restitution e, above 0 and at most 1.
    #[must_use]
    pub fn damping_ratio(self, e: f64) -> f64 {
        let loss = -e.ln();
        match self {
            Self::ZeroOverlap => loss / PI.hypot(loss),
            // e falls from 1 to 0 as the ratio grows without bound, as (2 zeta)^-2 at last.
            Self::ZeroForce => {
                let (mut low, mut high) = (0.0, 1.0 + 1.0 / e.sqrt());
                for _ in 0..200 {
                    let middle = 0.5 * (low + high);
                    if self.restitution(middle) > e {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                0.5 * (low + high)
            }
        }
    }

    /// Restitution of a linear contact of this share of critical damping.
    #[must_use]
    pub fn restitution(self, zeta: f64) -> f64 {
        match self {
            Self::ZeroOverlap if zeta >= 1.0 => 0.0,
            _ => (-zeta * self.duration(zeta)).exp(),
        }
    }

    /// Duration of a linear contact times w = sqrt(k/m); without end where a critically damped overlap only creeps to zero.
    #[must_use]
    pub fn duration(self, zeta: f64) -> f64 {
        let below = 1.0 - zeta * zeta;
        match self {
            Self::ZeroOverlap if below > 0.0 => PI / below.sqrt(),
            Self::ZeroOverlap => f64::INFINITY,
            Self::ZeroForce if below > 1e-10 => {
                let turn = below.sqrt();
                (2.0 * zeta * turn).atan2(2.0 * zeta * zeta - 1.0) / turn
            }
            Self::ZeroForce if below < -1e-10 => {
                let s = (-below).sqrt();
                // zeta - s loses all digits far beyond critical damping; (zeta + s)(zeta - s) = 1.
                2.0 * (zeta + s).ln() / s
            }
            Self::ZeroForce => 2.0 / zeta,
        }
    }
}
