//! Melting and solidification (Komen 2019, fig. 4.7): a particle is liquid from half of the
//! latent heat on, and the flow starts with enough liquid particles (section 4.3).
//!
//! Where the scene says so, liquid that freezes on contact with colder metal is held there (`contact`).
//!
//! What a particle has held of its latent heat at most is kept, liquid or not: it tells how far into
//! the particle the front of melting has come, and so the fusion line to a part of a particle.

use std::sync::Arc;

use particles::POSITION;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use steps::Figure;

use super::caloric::Caloric;
use super::contact::Contact;
use crate::stage::{Stage, StageError};
use crate::state::slag::SLAG;
use crate::state::{
    DROPLET, ENTHALPY, FUSED, LIQUID, PHASE, State, TEMPERATURE, VELOCITY, WALL, marked, phase,
};

/// When the flow starts (key `flow_start`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowStart {
    /// The flow starts when this number of particles is liquid; 120 in Komen (2019), section 4.3.
    #[schemars(range(min = 1))]
    pub liquid_particles: usize,
}

/// The change of phase as a stage.
pub struct Phase {
    caloric: Arc<Caloric>,
    start: Option<usize>,
    /// What freezes on contact; none where liquid slides on cold metal.
    contact: Option<Contact>,
    liquid: usize,
    held: usize,
    /// Height of the underside of the base metal \[m\].
    underside: Option<f64>,
    /// When and where the base metal was first molten down to it \[s, m\].
    through: Option<[f64; 4]>,
}

impl Phase {
    /// Phases of the metal; with `start`, sets [`State::flowing`] once enough of it is liquid.
    #[must_use]
    pub fn new(caloric: Arc<Caloric>, start: Option<FlowStart>) -> Self {
        Self {
            caloric,
            start: start.map(|s| s.liquid_particles),
            contact: None,
            liquid: 0,
            held: 0,
            underside: None,
            through: None,
        }
    }

    /// Holds liquid that freezes where it touches colder metal.
    #[must_use]
    pub fn sticking(mut self) -> Self {
        self.contact = Some(Contact::default());
        self
    }

    /// Looks out for base metal that melts down to its underside at this height \[m\].
    #[must_use]
    pub fn above(self, underside: Option<f64>) -> Self {
        Self { underside, ..self }
    }

    /// Keeps when and where particle `a` of the lowest layer melted, if it is the first of all.
    fn melts(&mut self, state: &State, a: usize) {
        let [x, y, z] = state.metal.column(&POSITION)[a];
        let lowest = |underside: f64| z < underside + state.metal.matter.spacing;
        let base = !marked(state.metal.column(&DROPLET), a);
        if self.through.is_none() && base && self.underside.is_some_and(lowest) {
            self.through = Some([state.time, x, y, z]);
        }
    }
}

impl Stage for Phase {
    fn name(&self) -> &'static str {
        "phase"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&TEMPERATURE);
        state.metal.declare(&ENTHALPY);
        state.metal.declare(&FUSED);
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        (self.liquid, self.held) = (0, 0);
        if let Some(contact) = &mut self.contact {
            contact.look(&mut state.near, &state.metal, &self.caloric);
        }
        let (mut phases, mut fused) = (state.metal.take(&PHASE), state.metal.take(&FUSED));
        let mut velocities = state.metal.take(&VELOCITY);
        let (enthalpies, wall) = (state.metal.column(&ENTHALPY), state.metal.column(&WALL));
        let slag = state.metal.column(&SLAG);
        for (a, phase) in phases.iter_mut().enumerate() {
            // Slag is liquid, and stiff where it is cold.
            if marked(wall, a) || marked(slag, a) || *phase == phase::FLYING {
                continue;
            }
            let molten = self.caloric.molten(enthalpies[a]);
            fused[a] = fused[a].max(molten);
            let liquid = molten >= LIQUID;
            self.liquid += usize::from(liquid);
            let contact = self.contact.as_ref().filter(|_| liquid);
            let now = match (liquid, contact.is_some_and(|c| c.holds(&state.near, a))) {
                (false, _) => phase::SOLID,
                (true, true) => phase::HELD,
                (true, false) => phase::LIQUID,
            };
            self.held += usize::from(now == phase::HELD);
            let before = std::mem::replace(phase, now);
            if before == phase::SOLID && liquid {
                self.melts(state, a);
            }
            if before == phase::LIQUID && now != before {
                velocities[a] = [0.0; 3];
            }
        }
        state.metal.put(&PHASE, phases);
        state.metal.put(&FUSED, fused);
        state.metal.put(&VELOCITY, velocities);
        if self.start.is_some_and(|start| self.liquid >= start) {
            state.flowing = true;
        }
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        let figure = |name, count: usize| Figure {
            name,
            unit: "1",
            value: count as f64,
        };
        let held = self
            .contact
            .iter()
            .map(|_| figure("held_particles", self.held));
        std::iter::once(figure("liquid_particles", self.liquid))
            .chain(held)
            .collect()
    }

    fn bytes(&self) -> usize {
        self.contact.as_ref().map_or(0, Contact::bytes)
    }

    fn warnings(&self) -> Vec<String> {
        let told = |[time, x, y, z]: [f64; 4]| {
            format!(
                "burn-through: the base metal is molten down to its underside from {time:.4} s on, at ({x:.4e}, {y:.4e}, {z:.4e}) m"
            )
        };
        self.through.map(told).into_iter().collect()
    }

    fn save(&self) -> Vec<f64> {
        self.through.map_or(Vec::new(), Vec::from)
    }

    fn restore(&mut self, saved: &[f64]) {
        self.through = saved.first_chunk().copied();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::caloric::tests::steel;
    use crate::state::Particle;
    use particles::Matter;

    #[test]
    fn the_first_melt_at_the_underside_is_told_and_kept() {
        let metal = Matter {
            density: 7850.0,
            spacing: 1e-3,
            smoothing_length: 1e-3,
        };
        let caloric = Arc::new(steel());
        let mut state = State::new(metal);
        state.metal.declare(&TEMPERATURE);
        state.metal.declare(&ENTHALPY);
        state.metal.declare(&FUSED);
        for z in [-0.5e-3, -1.5e-3, -2.5e-3] {
            state.push(Particle {
                position: [2e-3, 0.0, z],
                velocity: [0.0; 3],
                phase: phase::SOLID,
                droplet: false,
                wall: false,
                temperature: 1500.0,
                enthalpy: caloric.enthalpy(1500.0),
            });
        }
        let mut phase = Phase::new(caloric.clone(), None).above(Some(-3e-3));
        let mut warned = |state: &mut State, molten: usize, time: f64| {
            state.time = time;
            state.metal.column_mut(&ENTHALPY)[molten] = caloric.enthalpy(2500.0);
            phase.advance(state, 1e-3).unwrap();
            (phase.warnings(), phase.save())
        };
        assert_eq!(warned(&mut state, 0, 0.1).0, [""; 0]);
        let (told, saved) = warned(&mut state, 2, 0.25);
        assert!(
            told[0].contains("0.2500 s") && told[0].contains("-2.5000e-3"),
            "{told:?}"
        );
        let mut other = Phase::new(caloric.clone(), None);
        other.restore(&saved);
        assert_eq!(other.warnings(), told);
    }
}
