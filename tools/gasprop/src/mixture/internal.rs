//! What a particle holds inside.

/// What the inside of a particle (electrons, vibration, rotation; not its flight) holds at a temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Internal {
    /// ln Q of the partition function Q(T) = sum of g exp(-E/kT), E above the ground state.
    pub ln_partition: f64,
    /// Mean energy above the ground state, kT d ln Q / d ln T, J.
    pub energy: f64,
    /// Heat capacity of the internal modes at constant volume, J/K.
    pub heat_capacity: f64,
}
