//! What a solid body is made of, and what holds and loads it.

use super::bound::{Anchor, Load};
use super::cell::Cell;

/// A solid body and what holds and loads it.
#[derive(Debug, Clone)]
pub struct Body {
    /// Number of its set.
    pub set: usize,
    /// Its cells.
    pub cell: Cell,
    /// Size of a cell \[m\].
    pub size: [f64; 3],
    /// Places of the anchors at rest, along the axes of the lattice \[m\].
    pub anchor_rest: Vec<[f64; 3]>,
    /// Anchors.
    pub anchors: Vec<Anchor>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Rate at which velocities die away \[1/s\]; 0 where nothing damps them.
    pub damping: f64,
}
