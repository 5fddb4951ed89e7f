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

use shapes::frame::{Vector, along, cross, length};

use crate::meeting::Meeting;
use crate::slider::turned;

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
    #[inline]
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
        let velocity = cross(meeting.turn, meeting.normal).map(|v| meeting.radius * v);
        *rolled = along(turned(*rolled, meeting.normal), step, velocity);
        let mut force = [0, 1, 2].map(|i| -stiffness * rolled[i] - damping * velocity[i]);
        let (most, size) = (self.coefficient * push.max(0.0), length(force));
        if size > most {
            force = force.map(|f| f * (most / size));
            if stiffness > 0.0 {
                *rolled = [0, 1, 2].map(|i| -(force[i] + damping * velocity[i]) / stiffness);
            }
        }
        cross(meeting.normal, force).map(|m| meeting.radius * m)
    }
}
