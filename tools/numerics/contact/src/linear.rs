//! Spring and dashpot.
//!
//! ```text
//! N = k d + eta d',     eta = 2 zeta sqrt(m k)
//! ```
//!
//! with the effective mass m of the pair (Cundall and Strack 1979; Komen 2019, eqs 3.104 and 3.108, printed with the mass of one
//! grain, which makes a restitution of 0.75 into 0.66).

use crate::meeting::Meeting;
use crate::normal::Normal;
use crate::restitution::Ending;

/// A linear spring beside a dashpot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linear {
    stiffness: f64,
    tangential: f64,
    damping_ratio: f64,
    ending: Ending,
}

impl Linear {
    /// The contact of a spring of `stiffness` \[N/m\] along the normal and of `tangential` \[N/m\] across, whose `restitution` is
    /// above 0 and at most 1.
    #[must_use]
    pub fn new(stiffness: f64, tangential: f64, restitution: f64, ending: Ending) -> Self {
        Self {
            stiffness,
            tangential,
            damping_ratio: ending.damping_ratio(restitution),
            ending,
        }
    }

    /// Duration of a contact of effective mass m \[s\].
    #[must_use]
    pub fn duration(&self, mass: f64) -> f64 {
        self.ending.duration(self.damping_ratio) * (mass / self.stiffness).sqrt()
    }
}

impl Normal for Linear {
    const STIFFENS: bool = false;

    #[inline(always)]
    fn push(&self, meeting: &Meeting) -> f64 {
        let damping = 2.0 * self.damping_ratio * (meeting.mass * self.stiffness).sqrt();
        let push = self.stiffness * meeting.overlap + damping * meeting.approach;
        match self.ending {
            Ending::ZeroForce => push.max(0.0),
            Ending::ZeroOverlap => push,
        }
    }

    #[inline(always)]
    fn stiffness(&self, _: &Meeting) -> f64 {
        self.stiffness
    }

    #[inline(always)]
    fn tangential(&self, _: &Meeting) -> f64 {
        self.tangential
    }

    #[inline(always)]
    fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    fn pulls_at_the_end(&self) -> bool {
        self.ending == Ending::ZeroOverlap
    }
}
