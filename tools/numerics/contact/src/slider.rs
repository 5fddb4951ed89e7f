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

use shapes::frame::{Vector, along, dot, length, scaled};

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
///
/// What is chosen is chosen between numbers, here and in the forces below: several contacts are then reckoned at once.
#[inline(always)]
pub(crate) fn turned(stretch: Vector, normal: Vector) -> Vector {
    let across = dot(stretch, normal);
    let flat = along(stretch, -across, normal);
    let (old, new) = (dot(stretch, stretch), dot(flat, flat));
    let keep = if new > 0.0 { (old / new).sqrt() } else { 0.0 };
    scaled(keep, flat)
}

/// The part of a force of `size` \[N\] that a slider of at most `most` \[N\] lets through.
#[inline(always)]
pub(crate) fn let_through(size: f64, most: f64) -> f64 {
    if size > most { most / size } else { 1.0 }
}

/// The stretch of the spring beside a dashpot that pulls with `damped` \[N\], where the slider lets `part` of their force through,
/// `force` \[N\]; `whole` is the stretch before it slides.
#[inline(always)]
pub(crate) fn left(
    whole: Vector,
    part: f64,
    force: Vector,
    stiffness: f64,
    damped: Vector,
) -> Vector {
    let slides = part < 1.0 && stiffness > 0.0;
    let sprung = scaled(-1.0 / stiffness, along(force, 1.0, damped));
    let choose = |k: usize| if slides { sprung[k] } else { whole[k] };
    [choose(0), choose(1), choose(2)]
}

impl Friction {
    /// Force on a in the plane of contact \[N\] under the push `push` \[N\] after a step of `step` \[s\]; the history moves on.
    ///
    /// `stiffness` and `damping` are those of the tangential spring and dashpot \[N/m, N s/m\].
    #[inline(always)]
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
        let kept = scaled(grown, turned(history.stretch, meeting.normal));
        let whole = along(kept, step, meeting.slide);
        let pull = along(scaled(stiffness, whole), damping, meeting.slide);
        let most = self.coefficient * push.max(0.0);
        let part = let_through(length(pull), most);
        let force = scaled(-part, pull);
        let stretch = left(
            whole,
            part,
            force,
            stiffness,
            scaled(damping, meeting.slide),
        );
        *history = History { stretch, stiffness };
        force
    }
}
