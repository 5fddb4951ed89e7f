//! Resistance to rolling and twisting.
//!
//! ```text
//! t <- t + (swing x t) dt + R* (w_a - w_b) dt            turning of a against b, times R*; it goes along with the normal
//! t_n = (t.n) n,  t_r = t - t_n                          twisting and rolling (Luding 2008)
//! M_a = -R* [ (k_r t_r + eta_r dt_r/dt) + (k_r t_n + eta_r dt_n/dt) ] = -M_b,    each bracket at most mu_r N
//! ```
//!
//! Spring, dashpot and slider (Ai et al. 2011, model C): what rests stays at rest on a slope up to tan = mu_r R* / r, and the
//! moment neither drives nor hums where rolling ends. t_r x n is the stretch of a rolling spring that others write.
//!
//! Twisting has the same spring: with a dashpot alone, a grain that leans on a wall and on another would roll down that wall for
//! ever, turning about the wall's normal at the speed at which the dashpot bears its weight.

use shapes::frame::{Vector, along, cross, difference, dot, length, scaled};

use crate::meeting::Meeting;
use crate::slider::{left, let_through};

/// Rolling resistance of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rolling {
    /// Coefficient mu_r, zero or more: the moment is at most mu_r R* N.
    pub coefficient: f64,
    /// Stiffness of the rolling spring over that of the tangential one.
    pub stiffness_ratio: f64,
}

impl Rolling {
    /// Moment on a \[N m\] (on b the opposite) under the push `push` \[N\] after a step of `step` \[s\]; the turning t \[m\] moves on.
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
        let n = meeting.normal;
        let velocity = scaled(meeting.radius, meeting.turn);
        let kept = along(*rolled, step, cross(meeting.swing, *rolled));
        let whole = along(kept, step, velocity);
        let most = self.coefficient * push.max(0.0);
        let mut moment = [0.0; 3];
        let mut turning = [0.0; 3];
        let [twisting, twists] = [whole, velocity].map(|t| scaled(dot(t, n), n));
        let rolling = (difference(whole, twisting), difference(velocity, twists));
        for (whole, velocity) in [(twisting, twists), rolling] {
            let pull = along(scaled(stiffness, whole), damping, velocity);
            let part = let_through(length(pull), most);
            let force = scaled(-part, pull);
            let stays = left(whole, part, force, stiffness, scaled(damping, velocity));
            turning = along(turning, 1.0, stays);
            moment = along(moment, meeting.radius, force);
        }
        *rolled = turning;
        moment
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(coefficient: f64) -> Rolling {
        Rolling {
            coefficient,
            stiffness_ratio: 1.0,
        }
    }

    /// A grain of a millimetre that rests on a floor.
    fn touching() -> Meeting {
        Meeting {
            normal: [0.0, 0.0, 1.0],
            overlap: 1e-6,
            arms: [1e-3, 0.0],
            approach: 0.0,
            slide: [0.0; 3],
            turn: [0.0; 3],
            swing: [0.0; 3],
            mass: 1e-6,
            radius: 1e-3,
        }
    }

    #[test]
    fn twisting_stops_as_its_dashpot_and_slider_say() {
        let rolling = of(0.1);
        let mut meeting = Meeting {
            turn: [0.0, 0.0, 20.0],
            ..touching()
        };
        let moment = |meeting: &Meeting| {
            let mut rolled = [0.0; 3];
            rolling.moment(meeting, 1e-3, [100.0, 1e-2], &mut rolled, 0.0)
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

    #[test]
    fn a_twist_that_has_stopped_is_held_by_its_spring() {
        let rolling = of(0.1);
        let mut meeting = Meeting {
            turn: [0.0, 0.0, 0.5],
            ..touching()
        };
        let mut rolled = [0.0; 3];
        let mut moment = |meeting: &Meeting, push: f64| {
            rolling.moment(meeting, push, [100.0, 1e-2], &mut rolled, 1e-3)
        };
        let _ = moment(&meeting, 1.0);
        meeting.turn = [0.0; 3];
        // k R* (R* w dt)
        assert!((moment(&meeting, 1.0)[2] + 100.0 * 1e-6 * 0.5e-3).abs() < 1e-18);
        // A lesser push lets the spring slip, and it stays where it slipped to.
        let _ = moment(&meeting, 0.1 * 0.5e-4 / 0.1);
        assert!((moment(&meeting, 1.0)[2] + 0.1 * 0.5e-4 * 1e-3).abs() < 1e-18);
    }

    #[test]
    fn turning_goes_along_with_a_pair_that_turns_as_a_whole() {
        let rolling = of(10.0);
        let steps = 20_000;
        let step = 0.5 * std::f64::consts::PI / f64::from(steps);
        let mut rolled = [1e-6, 2e-6, 3e-6];
        let mut moment = [0.0; 3];
        for k in 1..=steps {
            let angle = step * f64::from(k);
            let meeting = Meeting {
                normal: [angle.cos(), angle.sin(), 0.0],
                swing: [0.0, 0.0, 1.0],
                radius: 0.5e-3,
                arms: [1e-3; 2],
                ..touching()
            };
            moment = rolling.moment(&meeting, 1.0, [100.0, 1e-2], &mut rolled, step);
        }
        let turned = [-2e-6, 1e-6, 3e-6];
        for k in 0..3 {
            assert!((rolled[k] - turned[k]).abs() < 1e-4 * 3e-6, "{rolled:?}");
            assert!((moment[k] + 0.5e-3 * 100.0 * rolled[k]).abs() < 1e-15);
        }
    }
}
