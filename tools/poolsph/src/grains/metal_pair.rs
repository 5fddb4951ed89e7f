//! A grain and a particle of metal that may touch.

use contact::{Grain, Meeting};
use shapes::frame::Vector;

use super::near::Near;
#[cfg(doc)]
use crate::state::State;

/// A particle of metal that grains may touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Body {
    /// Its index in [`State`].
    pub(super) id: u32,
    /// Its place in the copy of the flow, if it moves.
    pub(super) member: Option<u32>,
    pub(super) grain: Grain,
    /// Force of all grains \[N\], and that of the step before.
    pub(super) force: Vector,
    pub(super) before: Vector,
    /// Integral of the force over the step of the metal \[N s\].
    pub(super) impulse: Vector,
}

/// A grain and a particle of metal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) near: Near,
    /// Place among the bodies.
    pub(super) body: u32,
}

impl Body {
    /// How a grain meets it; the overlap is below zero where they are apart.
    pub(super) fn meeting(&self, grain: &Grain) -> Option<Meeting> {
        let meeting = Meeting::parted(grain, &self.grain)?;
        Some(match self.member {
            Some(_) => meeting,
            // What rests gives way to nothing.
            None => Meeting {
                mass: grain.mass,
                ..meeting
            },
        })
    }
}
