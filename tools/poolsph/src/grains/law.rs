//! The law by which two grains push each other.

use contact::{Hertz, Linear, Normal};

/// The push of two grains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Spring and dashpot.
    Linear(Linear),
    /// Elastic spheres.
    Hertz(Hertz),
}

impl Law {
    /// Share of critical damping.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        match self {
            Self::Linear(law) => law.damping_ratio(),
            Self::Hertz(law) => law.damping_ratio(),
        }
    }
}
