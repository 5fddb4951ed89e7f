//! What is set up of the current.

use crate::current::sheath::Sheath;
use crate::edges::Edges;

/// What the potential meets at an edge face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PotentialEdge {
    /// No current crosses.
    Insulated,
    /// Fixed potential \[V\].
    Voltage(f64),
    /// Current into the domain \[A\].
    Current(f64),
    /// The one potential at which all such faces together let in the driven current.
    Driven,
}

/// The potential, where it is solved.
#[derive(Debug, Clone)]
pub struct PotentialCase {
    /// Edges.
    pub edges: Edges<PotentialEdge>,
    /// Current into the domain through all driven faces \[A\].
    pub driven: Option<f64>,
    /// Current source of each cell \[A\], `[nr nz]`; manufactured solutions only.
    pub source: Option<Vec<f64>>,
    /// Gas close to electrodes that conducts as the gas beyond.
    pub sheath: Option<Sheath>,
}
