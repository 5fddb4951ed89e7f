//! Granular flux around the arc: its slag, and the cavity that boils into it (Komen 2019, section 5.2.3).

pub(crate) mod clear;
pub mod figures;
pub mod granular;
pub mod lit_wall;
mod step;
