//! Resistance to rolling.
//!
//! ```text
//! v_r = R* (w_a - w_b) x n            velocity of rolling (Luding 2008)
//! Q   = -k_r r - eta_r v_r,  |Q| <= mu_r N        r: stretch of the rolling spring
//! w_n = (w_a - w_b) . n               twisting
//! M_a = R* n x Q - R* sign(w_n) min(eta_r R* |w_n|, mu_r N) n = -M_b
//! ```
//!
//! The stretch is the same seen from a and from b; n, and with it the moment, changes sign.
//!
//! Spring, dashpot and slider (Ai et al. 2011, model C): what rests stays at rest on a slope up to tan = mu_r R* / r, and the
//! moment neither drives nor hums where rolling ends.
//!
//! Twisting has a dashpot and the same slider (Luding 2008, torsion, without its spring): a grain that nothing but a floor touches
//! would spin about the normal for ever.

use shapes::frame::{Vector, along, cross, dot, length, scaled};

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
        let twist = meeting.radius * dot(meeting.turn, meeting.normal);
        let drag = (damping * twist).min(most).max(-most);
        let bend = scaled(meeting.radius, cross(meeting.normal, force));
        along(bend, -meeting.radius * drag, meeting.normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twisting_stops_as_its_dashpot_and_slider_say() {
        let rolling = Rolling {
            coefficient: 0.1,
            stiffness_ratio: 1.0,
        };
        let mut meeting = Meeting {
            normal: [0.0, 0.0, 1.0],
            overlap: 1e-6,
            arms: [1e-3, 0.0],
            approach: 0.0,
            slide: [0.0; 3],
            turn: [0.0, 0.0, 20.0],
            mass: 1e-6,
            radius: 1e-3,
        };
        let moment = |meeting: &Meeting| {
            let mut rolled = [0.0; 3];
            rolling.moment(meeting, 1e-3, [100.0, 1e-2], &mut rolled, 1e-6)
        };
        // The slider: mu_r R* N.
        assert!((moment(&meeting)[2] + 0.1 * 1e-3 * 1e-3).abs() < 1e-20);
        // The dashpot: eta R*^2 w.
        meeting.turn = [0.0, 0.0, -2.0];
        assert!((moment(&meeting)[2] - 1e-2 * 1e-6 * 2.0).abs() < 1e-20);
        // Seen from the other grain: the opposite.
        meeting.turn = [0.3, 0.1, 2.0];
        let own = moment(&meeting);
        (meeting.turn, meeting.normal) = ([-0.3, -0.1, -2.0], [0.0, 0.0, -1.0]);
        let other = moment(&meeting);
        assert!((0..3).all(|k| (own[k] + other[k]).abs() < 1e-22));
    }
}
