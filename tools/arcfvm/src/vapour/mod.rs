//! Iron vapour (Komen 2019, eqs 5.23 to 5.25).

pub mod balance;
pub mod evaporation;
pub mod field;
pub(crate) mod figures;
pub(crate) mod mixing;
pub mod setup;
mod step;
