//! The law by which two grains push each other.

use contact::{Contact, Hertz, Linear, Normal, Rolling};

/// The push of two grains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Spring and dashpot.
    Linear(Linear),
    /// Elastic spheres.
    Hertz(Hertz),
}

/// What acts at a contact: its push and friction, and what resists rolling.
#[derive(Debug, Clone, Copy)]
pub struct Laws<'a, N> {
    /// Along and across the contact.
    pub contact: &'a Contact<N>,
    /// Absent: grains roll freely.
    pub rolling: Option<Rolling>,
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
