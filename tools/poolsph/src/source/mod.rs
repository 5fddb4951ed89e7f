//! What a run begins with and goes by: the moving arc, where it stands and where in the droplet's period it is; files of other runs.

pub mod arc;
pub mod arcs;
pub mod bed;
mod path;
pub mod start;

pub use path::{Parameters, Path};

/// Where the arc stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Axis of the arc on the plate's original surface \[m\].
    pub position: [f64; 3],
    /// The way that it goes in the step \[m\].
    pub way: [f64; 3],
    /// Part of the droplet's period that has passed, 0 to 1; 0 when a droplet is born.
    pub phase: f64,
    /// Droplets born so far.
    pub droplets: u64,
}

impl Place {
    /// Distance of `x` from the axis \[m\] and the unit vector outwards; no direction on the axis.
    #[must_use]
    #[inline]
    pub fn around(&self, x: [f64; 3]) -> (f64, [f64; 2]) {
        let (dx, dy) = (x[0] - self.position[0], x[1] - self.position[1]);
        let r = (dx * dx + dy * dy).sqrt();
        if r > 0.0 {
            (r, [dx / r, dy / r])
        } else {
            (0.0, [0.0; 2])
        }
    }
}
