//! What an exchange of heat makes of a particle.

/// What a particle is after an exchange.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exchanged {
    pub(super) a: u32,
    pub(super) enthalpy: f64,
    pub(super) temperature: f64,
    /// Heat that left through an open face, or into a wall in the plane of one \[J\].
    pub(super) out: f64,
    /// Has a pair that exchanges heat.
    pub(super) busy: bool,
    /// Has such a pair with a particle that is passed over.
    pub(super) wakes: bool,
}

impl Exchanged {
    /// A particle of an enthalpy \[J/kg\] and temperature \[K\] as it is.
    pub(super) fn unchanged(a: u32, enthalpy: f64, temperature: f64) -> Self {
        Self {
            a,
            enthalpy,
            temperature,
            out: 0.0,
            busy: false,
            wakes: false,
        }
    }
}
