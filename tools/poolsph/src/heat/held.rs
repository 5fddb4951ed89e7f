//! Particles whose temperature is prescribed: boundary values on a body of the scene.

use std::ops::Range;

use particles::POSITION;
use run::property::{Arguments, Curve};

use super::bounds::outside;
use super::ledger::Sum;
use super::substances::Substances;
use crate::stage::StageError;
use crate::state::{ENTHALPY, State, TEMPERATURE};

/// Consecutive particles with a prescribed temperature.
#[derive(Debug, Clone)]
pub(crate) struct Held {
    /// Their indices.
    pub(crate) particles: Range<usize>,
    /// T(x, y, z, t) \[K\].
    pub(crate) temperature: Curve,
}

impl Held {
    /// Sets the temperatures of the moment; the heat that this takes away is added to `out`.
    pub(crate) fn prescribe(
        &self,
        state: &mut State,
        made: &Substances,
        out: &mut Sum,
    ) -> Result<(), StageError> {
        let step = state.step;
        let marks = Substances::marks(&state.metal).get(self.particles.clone());
        // The particles of a body are all of one substance.
        let own = made.at(marks.unwrap_or_default(), 0);
        let (mass, caloric) = (own.mass, own.caloric.as_ref());
        let columns = (&POSITION, &ENTHALPY, &TEMPERATURE);
        let (places, enthalpies, temperatures) = state.metal.columns_mut(columns);
        for a in self.particles.clone() {
            let at = Arguments::at(places[a], state.time);
            let temperature = (self.temperature.kelvin(&at))
                .map_err(|fault| StageError::Data(format!("held temperature: {fault}")))?;
            if !caloric.covers(temperature) {
                return Err(outside(step, a, places[a], temperature, caloric));
            }
            let enthalpy = caloric.enthalpy(temperature);
            out.add(mass * (enthalpies[a] - enthalpy));
            (enthalpies[a], temperatures[a]) = (enthalpy, temperature);
        }
        Ok(())
    }
}
