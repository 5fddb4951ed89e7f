//! What the ways to keep the density share: the step that is asked for, and how its solution ended.

use particles::Matter;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Mean over the liquid of the excess of C + dt J u, and of its lack where p > 0.
    pub density: f64,
    /// Fewest sweeps.
    pub sweeps_min: u32,
    /// Most sweeps.
    pub sweeps_max: u32,
}

/// The step to take.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// The metal.
    pub metal: Matter,
    /// \[s\].
    pub dt: f64,
    /// Part of the whole step that this one is: weight of its pressure in the virial.
    pub share: f64,
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, Default)]
pub struct Solved {
    /// Sweeps made.
    pub sweeps: u32,
    /// What [`Tolerance::density`] bounds, predicted for the end of the step.
    pub density_error: f64,
}
