//! Measures of the bead, by geometry alone.

pub(crate) mod bead;
pub(crate) mod heat_affected;
pub(crate) mod section;
pub(crate) mod slag;
pub(crate) mod spatter;
