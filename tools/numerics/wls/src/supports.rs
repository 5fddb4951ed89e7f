//! The neighbours of every row.

/// The support of one row, among those of a parcel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    pub(crate) row: u32,
    pub(crate) count: u32,
    /// First neighbour in the array of all.
    pub(crate) start: usize,
    pub(crate) radius: f64,
    pub(crate) hash: u64,
    /// It may share weights: no conditions of its own, unless its polynomial is harmonic.
    pub(crate) free: bool,
    /// Its polynomial is harmonic.
    pub(crate) harmonic: bool,
    /// How often the support was enlarged.
    pub(crate) times: u32,
}

/// Supports of a cloud, in the order of the tree.
#[derive(Debug, Default)]
pub(crate) struct Supports {
    pub(crate) found: Vec<Found>,
    pub(crate) neighbours: Vec<u32>,
}
