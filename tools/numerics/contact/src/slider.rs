//! Friction with history.
//!
//! ```text
//! s <- (s - (s.n) n) |s| / |s - (s.n) n| + u_t dt         the stretch, turned into the plane, its length kept
//! F_t = -k_t s - eta_t u_t                                where |F_t| <= mu N
//! F_t <- mu N F_t / |F_t|,   s <- -(F_t + eta_t u_t)/k_t  where the contact slides
//! ```
//!
//! Komen (2019), eqs 3.109 to 3.114, whose print points the stretch along the present velocity and so flips it when the motion
//! reverses. Where the tangential spring stiffens with the overlap (Mindlin), new area of contact carries no load: the stretch
//! shrinks so that the force stays (Thornton, Cummins and Cleary 2013), and unloading never makes energy.

use shapes::frame::{Vector, along, dot, length};

use crate::meeting::Meeting;

/// Coulomb friction of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient mu, zero or more.
    pub coefficient: f64,
}

/// What a contact remembers from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct History {
    /// Stretch s of the tangential spring \[m\], seen from a; from b it is the opposite.
    pub stretch: Vector,
    /// Stiffness of the tangential spring at the last step \[N/m\]; zero in a new contact.
    pub stiffness: f64,
}

/// A stretch turned into the plane of `normal`, its length kept.
#[inline]
pub(crate) fn turned(stretch: Vector, normal: Vector) -> Vector {
    let across = dot(stretch, normal);
    let flat = along(stretch, -across, normal);
    let (old, new) = (dot(stretch, stretch), dot(flat, flat));
    if new > 0.0 {
        let keep = (old / new).sqrt();
        flat.map(|x| keep * x)
    } else {
        [0.0; 3]
    }
}

impl Friction {
    /// Force on a in the plane of contact \[N\] under the push `push` \[N\] after a step of `step` \[s\]; the history moves on.
    ///
    /// `stiffness` and `damping` are those of the tangential spring and dashpot \[N/m, N s/m\].
    #[inline]
    pub fn force(
        self,
        meeting: &Meeting,
        push: f64,
        [stiffness, damping]: [f64; 2],
        history: &mut History,
        step: f64,
    ) -> Vector {
        let grown = if history.stiffness > 0.0 && stiffness > history.stiffness {
            history.stiffness / stiffness
        } else {
            1.0
        };
        let kept = turned(history.stretch, meeting.normal).map(|x| grown * x);
        let mut stretch = along(kept, step, meeting.slide);
        let mut force = [0, 1, 2].map(|i| -stiffness * stretch[i] - damping * meeting.slide[i]);
        let (most, size) = (self.coefficient * push.max(0.0), length(force));
        if size > most {
            force = force.map(|f| f * (most / size));
            if stiffness > 0.0 {
                stretch = [0, 1, 2].map(|i| -(force[i] + damping * meeting.slide[i]) / stiffness);
            }
        }
        *history = History { stretch, stiffness };
        force
    }
}
