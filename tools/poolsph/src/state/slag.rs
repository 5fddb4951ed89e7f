//! A second liquid beside the metal that does not mix with it, such as slag upon a pool.
//!
//! Its particles stand among those of the metal and have their volume; a column marks them, which metal alone does not hold.

use particles::{Column, Matter};

/// Is slag.
pub const SLAG: Column<bool> = Column::new("slag", "1", false).saved().shown();

/// What slag has of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slag {
    /// rho \[kg/m3\].
    pub density: f64,
    /// mu \[Pa s\].
    pub viscosity: f64,
    /// Tension of the interface between both liquids \[N/m\].
    pub interface_tension: f64,
    /// Tension of its free surface \[N/m\]; none where that of the metal holds.
    pub surface_tension: Option<f64>,
}

impl Slag {
    /// The greatest mu/rho \[m2/s\] by which the momentum of a particle spreads, in `metal` of a viscosity `mu` \[Pa s\], in
    /// slag, or between both.
    #[must_use]
    pub fn spreading(self, mu: f64, metal: Matter) -> f64 {
        let both = mu + self.viscosity;
        let between = if both > 0.0 {
            2.0 * mu * self.viscosity / both
        } else {
            0.0
        };
        let own = (mu.max(between) / metal.density).max(self.viscosity.max(between) / self.density);
        own.max(f64::MIN_POSITIVE)
    }
}
