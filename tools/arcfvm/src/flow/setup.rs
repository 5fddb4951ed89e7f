//! What is set up of the flow.

use crate::edges::Edges;

/// What the flow meets at an edge face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlowEdge {
    /// Fixed velocity, radial and axial \[m/s\]: a wall (zero) or an inlet.
    Velocity([f64; 2]),
    /// Fixed pressure \[Pa\]; gas drawn in comes from rest.
    Open(f64),
    /// No flow through, no stress along: the axis or a plane of symmetry.
    Slip,
}

/// Gravity acting on the excess of density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// Downward acceleration \[m/s2\].
    pub acceleration: f64,
    /// Density of the gas at rest around \[kg/m3\], whose weight the pressure leaves out.
    pub reference_density: f64,
}

/// The flow, where it is solved.
#[derive(Debug, Clone)]
pub struct FlowCase {
    /// Edges.
    pub edges: Edges<FlowEdge>,
    /// Gravity.
    pub gravity: Option<Gravity>,
    /// Given forces on radial and axial faces \[N/m3\]; manufactured solutions only.
    pub force: Option<[Vec<f64>; 2]>,
    /// Whether no edge fixes the pressure, so that it is known up to a constant.
    pub closed: bool,
}
