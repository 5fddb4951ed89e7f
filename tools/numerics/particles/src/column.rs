//! What a stage declares of a particle.

use crate::store::Value;

/// A declared column with values of type `T`: a number, a vector, a matrix, a flag or a number of identity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column<T> {
    /// Name in frames, checkpoints and plans.
    pub name: &'static str,
    /// SI unit, `1` for none.
    pub unit: &'static str,
    /// Value of a new particle.
    pub default: T,
    /// A checkpoint keeps it: it does not follow from other columns.
    pub saved: bool,
    /// Frames show it.
    pub shown: bool,
}

impl<T: Value> Column<T> {
    /// A column that is neither saved nor shown.
    #[must_use]
    pub const fn new(name: &'static str, unit: &'static str, default: T) -> Self {
        Self {
            name,
            unit,
            default,
            saved: false,
            shown: false,
        }
    }

    /// Kept by checkpoints.
    #[must_use]
    pub const fn saved(mut self) -> Self {
        self.saved = true;
        self
    }

    /// Shown in frames.
    #[must_use]
    pub const fn shown(mut self) -> Self {
        self.shown = true;
        self
    }
}
