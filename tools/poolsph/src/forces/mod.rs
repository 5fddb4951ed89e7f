//! Forces on the liquid, one file each (Komen 2019, eq. 4.1).

pub mod arc_pressure;
pub mod buoyancy;
pub mod capillary;
pub mod gas_shear;
pub mod lorentz;
pub mod marangoni;
pub mod solute;
pub mod surface_stress;
pub mod tension;

#[cfg(test)]
mod arc_tests;
#[cfg(test)]
mod tests;
