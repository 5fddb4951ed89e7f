//! The metal, and what a step knows beside it.
//!
//! The metal is a set of particles: a column exists where a stage declares it ([`crate::stage::Stage::declare`]), as a
//! constant in the file of the physics that it belongs to; those that all share stand here. Particles keep their row for
//! life; new ones are appended, so that row and number are one.

pub mod near;
pub mod slag;

use particles::{Column, Ids, Matter, POSITION, Set};

use crate::faces::Faces;
use crate::source::Place;
use near::Near;
use slag::Slag;

/// u \[m/s\]; zero for solid ones.
pub const VELOCITY: Column<[f64; 3]> = Column::new("velocity", "m/s", [0.0; 3]).saved().shown();
/// Part in the motion: one of [`phase`].
pub const PHASE: Column<u8> = Column::new("phase", "1", phase::SOLID).saved();
/// Moves or flies; frames show it.
const MOLTEN: Column<bool> = Column::new("molten", "1", false).shown();
/// Greatest part of its latent heat that a particle has ever held, where metal melts: 1 from the start on for what enters
/// liquid.
pub const FUSED: Column<f64> = Column::new("fused", "1", 0.0).saved().shown();
/// Came from the wire.
pub const DROPLET: Column<bool> = Column::new("droplet", "1", false).saved().shown();
/// Belongs to the container and never melts.
pub const WALL: Column<bool> = Column::new("wall", "1", false).saved().shown();
/// T \[K\].
pub const TEMPERATURE: Column<f64> = Column::new("temperature", "K", 0.0).saved().shown();
/// Specific enthalpy \[J/kg\].
pub const ENTHALPY: Column<f64> = Column::new("enthalpy", "J/kg", 0.0).saved();

/// What a particle does in the motion.
pub mod phase {
    /// Rests; neighbour of the liquid, carries pressure and heat.
    pub const SOLID: u8 = 0;
    /// Moves by the equations of motion.
    pub const LIQUID: u8 = 1;
    /// Part of a droplet on its prescribed way down; meets nobody.
    pub const FLYING: u8 = 2;
    /// Molten, and frozen to colder metal that it touches: rests.
    pub const HELD: u8 = 3;
}

/// A particle is liquid from this part of its latent heat on (Komen 2019, section 4.2.2).
pub const LIQUID: f64 = 0.5;

/// All particles at one time. Index = identity.
#[derive(Debug, Clone)]
pub struct State {
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps of the scene's length that have passed.
    pub step: u64,
    /// Steps of the scene's length that the present one holds.
    pub stride: u64,
    /// The metal; z upwards, z = 0 on the plate, y along the weld.
    pub metal: Set,
    /// Particles with an area, ascending; follows from [`crate::patch::AREA`].
    pub exposed: Vec<u32>,
    /// Where the arc stands, if there is one.
    pub source: Option<Place>,
    /// Liquid particles move. False until enough of them are there (Komen 2019, section 4.3).
    pub flowing: bool,
    /// Faces beside which the flow goes on.
    pub faces: Faces,
    /// The moving particles and all that they touch, gathered afresh each step.
    pub near: Near,
    /// Grains beside the metal, if there are any.
    pub grains: Option<Set>,
    /// What the slag has of its own, if there is any.
    pub slag: Option<Slag>,
}

/// One particle to be appended.
#[derive(Debug, Clone, Copy)]
pub struct Particle {
    /// x \[m\].
    pub position: [f64; 3],
    /// u \[m/s\].
    pub velocity: [f64; 3],
    /// Its part in the motion: one of [`phase`].
    pub phase: u8,
    /// From the wire.
    pub droplet: bool,
    /// Of the container.
    pub wall: bool,
    /// T \[K\]; dropped where the column is absent.
    pub temperature: f64,
    /// Specific enthalpy \[J/kg\]; dropped where the column is absent.
    pub enthalpy: f64,
}

impl State {
    /// The time at the end of the present step, of `dt` \[s\].
    #[must_use]
    pub fn end(&self, dt: f64) -> f64 {
        // Times are multiples of the scene's step, not sums, so that no error grows with their number.
        (self.step + self.stride) as f64 * (dt / self.stride as f64)
    }

    /// No particles, and of the columns those that all metal has.
    #[must_use]
    pub fn new(matter: Matter) -> Self {
        let mut metal = Set::new("metal", matter);
        metal.declare(&VELOCITY);
        metal.declare(&PHASE);
        metal.declare(&MOLTEN);
        Self {
            time: 0.0,
            step: 0,
            stride: 1,
            metal,
            exposed: Vec::new(),
            source: None,
            flowing: false,
            faces: Faces::default(),
            near: Near::new(matter),
            grains: None,
            slag: None,
        }
    }

    /// Mass of a particle \[kg\].
    #[must_use]
    pub fn mass(&self, a: usize) -> f64 {
        let matter = self.metal.matter;
        match self.slag {
            Some(slag) if marked(self.metal.column(&slag::SLAG), a) => {
                slag.density * matter.volume()
            }
            _ => matter.mass(),
        }
    }

    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.metal.len()
    }

    /// True without particles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.metal.is_empty()
    }

    /// Number of liquid particles.
    #[must_use]
    pub fn liquid(&self) -> usize {
        let phases = self.metal.column(&PHASE).iter();
        phases.filter(|phase| **phase == phase::LIQUID).count()
    }

    /// Appends a particle.
    pub fn push(&mut self, particle: Particle) {
        if particle.wall {
            self.metal.declare(&WALL);
        }
        let metal = &mut self.metal;
        // Row and number are one.
        let next = metal.len() as u32;
        let row = metal.push(&mut Ids { next });
        let entered = f64::from(u8::from(particle.phase != phase::SOLID));
        metal.set(&POSITION, row, particle.position);
        metal.set(&VELOCITY, row, particle.velocity);
        metal.set(&PHASE, row, particle.phase);
        metal.set(&FUSED, row, entered);
        metal.set(&DROPLET, row, particle.droplet);
        metal.set(&WALL, row, particle.wall);
        metal.set(&TEMPERATURE, row, particle.temperature);
        metal.set(&ENTHALPY, row, particle.enthalpy);
    }

    /// Fills what only frames show.
    pub fn show(&mut self) {
        let (molten, phases) = self.metal.columns_mut((&MOLTEN, &PHASE));
        for (molten, phase) in molten.iter_mut().zip(phases) {
            *molten = *phase != phase::SOLID;
        }
    }

    /// Gathers the moving particles and all that they touch into [`State::near`].
    pub fn gather(&mut self) {
        let mut near = std::mem::replace(&mut self.near, Near::new(self.metal.matter));
        if self.faces.any() {
            self.fold();
        }
        near.gather(self);
        self.near = near;
    }

    /// Brings liquid that has gone through a face back.
    fn fold(&mut self) {
        let (places, velocities, phases) = (self.metal).columns_mut((&POSITION, &VELOCITY, &PHASE));
        for ((x, u), phase) in places.iter_mut().zip(velocities).zip(phases) {
            if *phase == phase::LIQUID {
                self.faces.fold(x, u);
            }
        }
    }

    /// Name and bytes of each column, for the record.
    #[must_use]
    pub fn memory(&self) -> Vec<(&'static str, usize)> {
        let columns = self.metal.declared();
        let mut bytes: Vec<_> = columns.map(|held| (held.name, held.bytes())).collect();
        bytes.push(("near", self.near.bytes()));
        bytes.push(("grains", self.grains.as_ref().map_or(0, Set::bytes)));
        bytes.retain(|(_, held)| *held > 0);
        bytes
    }
}

/// Whether the mark of a particle stands in a column, which may be absent.
#[must_use]
#[inline]
pub fn marked(column: &[bool], a: usize) -> bool {
    column.get(a).is_some_and(|mark| *mark)
}

#[cfg(test)]
mod tests {
    use super::*;

    const METAL: Matter = Matter {
        density: 7850.0,
        spacing: 0.5e-3,
        smoothing_length: 0.5e-3,
    };

    #[test]
    fn a_column_nobody_needs_is_not_held() {
        let mut state = State::new(METAL);
        state.metal.declare(&ENTHALPY);
        state.push(Particle {
            position: [0.0; 3],
            velocity: [0.0; 3],
            phase: phase::LIQUID,
            droplet: false,
            wall: false,
            temperature: 300.0,
            enthalpy: 5.0,
        });
        assert!(!state.metal.has(&TEMPERATURE) && !state.metal.has(&WALL));
        assert_eq!(state.metal.column(&ENTHALPY).len(), 1);
        let told = |wanted| state.memory().iter().any(|(name, _)| *name == wanted);
        assert!(told("enthalpy") && !told("temperature"));
    }
}
