//! The moving arc: where it stands and where in the droplet's period it is.

/// Where the arc stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Axis of the arc on the plate's original surface \[m\].
    pub position: [f64; 3],
    /// Part of the droplet's period that has passed, 0 to 1; 0 when a droplet is born.
    pub phase: f64,
    /// Droplets born so far.
    pub droplets: u64,
}
