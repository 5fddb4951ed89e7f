//! Push, friction and rolling of one contact put together.

use shapes::frame::{Vector, along, cross, scaled};

use crate::meeting::Meeting;
use crate::normal::Normal;
use crate::rolling::Rolling;
use crate::slider::{Friction, History};

/// What a contact does to grain a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reply {
    /// Force on a \[N\]; on b the opposite.
    pub force: Vector,
    /// Part of the force in the plane of contact \[N\].
    pub friction: Vector,
    /// Moment on a about its centre \[N m\].
    pub moment: Vector,
    /// Moment on b about its centre \[N m\].
    pub moment_on_b: Vector,
    /// Push along the normal \[N\].
    pub push: f64,
}

/// A contact of one normal law, with or without friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact<N> {
    /// Law of the push.
    pub normal: N,
    /// Friction in the plane of contact; grains that only push have none.
    pub friction: Option<Friction>,
}

impl<N: Normal> Contact<N> {
    /// Force and moments of a contact after a step of `step` \[s\].
    ///
    /// The tangential dashpot has the share of critical damping of the normal one, on its own spring.
    #[inline(always)]
    pub fn act(&self, meeting: &Meeting, history: &mut History, step: f64) -> Reply {
        let push = self.normal.push(meeting);
        let friction = match self.friction {
            Some(friction) => friction.force(meeting, push, self.across(meeting), history, step),
            None => [0.0; 3],
        };
        let moment = cross(meeting.normal, friction);
        Reply {
            force: along(friction, push, meeting.normal),
            friction,
            moment: scaled(-meeting.arms[0], moment),
            moment_on_b: scaled(-meeting.arms[1], moment),
            push,
        }
    }

    /// The same with resistance to rolling, whose stretch is `rolled` \[m\].
    #[inline(always)]
    pub fn act_rolling(
        &self,
        meeting: &Meeting,
        rolling: Rolling,
        history: &mut History,
        rolled: &mut Vector,
        step: f64,
    ) -> Reply {
        let reply = self.act(meeting, history, step);
        let moment = rolling.moment(meeting, reply.push, self.across(meeting), rolled, step);
        Reply {
            moment: along(reply.moment, 1.0, moment),
            moment_on_b: along(reply.moment_on_b, -1.0, moment),
            ..reply
        }
    }

    /// Stiffness \[N/m\] and damping \[N s/m\] across the normal.
    #[inline(always)]
    fn across(&self, meeting: &Meeting) -> [f64; 2] {
        let stiffness = self.normal.tangential(meeting);
        let damping = 2.0 * self.normal.damping_ratio() * (meeting.mass * stiffness).sqrt();
        [stiffness, damping]
    }
}
