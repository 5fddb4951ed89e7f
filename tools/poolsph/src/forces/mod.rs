//! Forces on the liquid, one file each (Komen 2019, eq. 4.1).

pub mod tension;
