//! Resistance to rolling.
//!
//! ```text
//! v_r = R* (w_a - w_b) x n            velocity of rolling (Luding 2008)
//! Q   = -k_r r - eta_r v_r,  |Q| <= mu_r N        r: stretch of the rolling spring
//! M_a = R* n x Q = -M_b
//! ```
//!
//! The stretch is the same seen from a and from b; n, and with it the moment, changes sign.
//!
//! Spring, dashpot and slider (Ai et al. 2011, model C): what rests stays at rest on a slope up to tan = mu_r R* / r, and the
//! moment neither drives nor hums where rolling ends.

use shapes::frame::{Vector, along, cross, length, scaled};

use crate::meeting::Meeting;
use crate::slider::{left, let_through, turned};

/// Rolling resistance of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rolling {
    /// Coefficient mu_r, zero or more: the moment is at most mu_r R* N.
    pub coefficient: f64,
    /// Stiffness of the rolling spring over that of the tangential one.
    pub stiffness_ratio: f64,
}

impl Rolling {
    /// Moment on a \[N m\] (on b the opposite) under the push `push` \[N\] after a step of `step` \[s\]; the stretch r \[m\] moves on.
    ///
    /// `stiffness` and `damping` are those of the tangential spring and dashpot \[N/m, N s/m\].
    #[inline(always)]
    pub fn moment(
        self,
        meeting: &Meeting,
        push: f64,
        [stiffness, damping]: [f64; 2],
        rolled: &mut Vector,
        step: f64,
    ) -> Vector {
        let [stiffness, damping] = [
            self.stiffness_ratio * stiffness,
            self.stiffness_ratio.sqrt() * damping,
        ];
        let velocity = scaled(meeting.radius, cross(meeting.turn, meeting.normal));
        let whole = along(turned(*rolled, meeting.normal), step, velocity);
        let pull = along(scaled(stiffness, whole), damping, velocity);
        let most = self.coefficient * push.max(0.0);
        let part = let_through(length(pull), most);
        let force = scaled(-part, pull);
        *rolled = left(whole, part, force, (stiffness, scaled(damping, velocity)));
        scaled(meeting.radius, cross(meeting.normal, force))
    }
}
