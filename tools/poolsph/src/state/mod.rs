//! Columns of the particles and the metal they are made of.
//!
//! A column that no stage needs stays empty: [`State::new`] is told the union
//! of what the stages declare. Particles keep their index for life; new ones are appended.

pub mod near;

use particles::Set;

use crate::faces::Faces;
use crate::patch::Patch;
use crate::source::Place;
use near::Near;

/// The one metal and the lattice that its particles start on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metal {
    /// rho \[kg/m3\].
    pub density: f64,
    /// Particle diameter d = lattice spacing \[m\]; a particle fills the volume d^3.
    pub spacing: f64,
    /// h \[m\]; the kernel's support is 2h. Komen (2019) takes h = d.
    pub smoothing_length: f64,
}

impl Metal {
    /// Volume of a particle, d^3 \[m3\] (the plate's box divided by its particles).
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.spacing * self.spacing * self.spacing
    }

    /// Mass of a particle \[kg\].
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.density * self.volume()
    }

    /// Radius of the kernel's support, 2h \[m\].
    #[must_use]
    pub fn support(&self) -> f64 {
        2.0 * self.smoothing_length
    }
}

/// What a particle does in the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Phase {
    /// Rests; neighbour of the liquid, carries pressure and heat.
    Solid = 0,
    /// Moves by the equations of motion.
    Liquid = 1,
    /// Part of a droplet on its prescribed way down; meets nobody.
    Flying = 2,
}

/// Columns that exist only if a stage needs them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Column {
    /// [`State::temperature`].
    Temperature,
    /// [`State::enthalpy`].
    Enthalpy,
    /// [`State::pressure`].
    Pressure,
    /// [`State::surface`].
    Surface,
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
    /// The metal.
    pub metal: Metal,
    /// x \[m\], `[n][3]`; z upwards, z = 0 on the plate, y along the weld.
    pub position: Vec<[f64; 3]>,
    /// u \[m/s\], `[n][3]`.
    pub velocity: Vec<[f64; 3]>,
    /// `[n]`.
    pub phase: Vec<Phase>,
    /// Greatest part of its latent heat that it has ever held, `[n]`: 1 from the start on for what
    /// enters liquid.
    pub fused: Vec<f64>,
    /// Came from the wire, `[n]`.
    pub droplet: Vec<bool>,
    /// Belongs to the container and never melts, `[n]`.
    pub wall: Vec<bool>,
    /// T \[K\], `[n]` or empty.
    pub temperature: Vec<f64>,
    /// Specific enthalpy \[J/kg\], `[n]` or empty.
    pub enthalpy: Vec<f64>,
    /// p \[Pa\], `[n]` or empty: the pressure that the metal carries, from all pair forces, as the mean over some
    /// milliseconds (that of the last step where the flow is without divergence).
    /// Single particles differ like the contacts of grains; frames show [`Near::liquid_mean`].
    pub pressure: Vec<f64>,
    /// What the surface is at each particle, `[n]` or empty.
    pub surface: Vec<Patch>,
    /// Particles with an area, ascending; follows from [`State::surface`].
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
    columns: Vec<Column>,
}

/// One particle to be appended.
#[derive(Debug, Clone, Copy)]
pub struct Particle {
    /// x \[m\].
    pub position: [f64; 3],
    /// u \[m/s\].
    pub velocity: [f64; 3],
    /// Its part in the motion.
    pub phase: Phase,
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

    /// No particles, and of the optional columns those that `columns` names.
    #[must_use]
    pub fn new(metal: Metal, mut columns: Vec<Column>) -> Self {
        columns.sort_unstable();
        columns.dedup();
        Self {
            time: 0.0,
            step: 0,
            stride: 1,
            metal,
            position: Vec::new(),
            velocity: Vec::new(),
            phase: Vec::new(),
            fused: Vec::new(),
            droplet: Vec::new(),
            wall: Vec::new(),
            temperature: Vec::new(),
            enthalpy: Vec::new(),
            pressure: Vec::new(),
            surface: Vec::new(),
            exposed: Vec::new(),
            source: None,
            flowing: false,
            faces: Faces::default(),
            near: Near::new(metal),
            grains: None,
            columns,
        }
    }

    /// True if the optional column is held.
    #[must_use]
    pub fn has(&self, column: Column) -> bool {
        self.columns.contains(&column)
    }

    /// The optional columns held.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// True without particles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Number of liquid particles.
    #[must_use]
    pub fn liquid(&self) -> usize {
        self.phase
            .iter()
            .filter(|phase| **phase == Phase::Liquid)
            .count()
    }

    /// True if particle `a` has ever been liquid.
    #[must_use]
    pub fn was_liquid(&self, a: usize) -> bool {
        self.fused[a] >= LIQUID
    }

    /// Appends a particle.
    pub fn push(&mut self, particle: Particle) {
        self.position.push(particle.position);
        self.velocity.push(particle.velocity);
        self.phase.push(particle.phase);
        self.fused
            .push(f64::from(u8::from(particle.phase != Phase::Solid)));
        self.droplet.push(particle.droplet);
        self.wall.push(particle.wall);
        for column in &self.columns {
            match column {
                Column::Temperature => self.temperature.push(particle.temperature),
                Column::Enthalpy => self.enthalpy.push(particle.enthalpy),
                Column::Pressure => self.pressure.push(0.0),
                Column::Surface => self.surface.push(Patch::default()),
            }
        }
    }

    /// Gathers the moving particles and all that they touch into [`State::near`].
    pub fn gather(&mut self) {
        let mut near = std::mem::replace(&mut self.near, Near::new(self.metal));
        if self.faces.any() {
            self.fold();
        }
        near.gather(self);
        self.near = near;
    }

    /// Brings liquid that has gone through a face back.
    fn fold(&mut self) {
        let places = self.position.iter_mut().zip(&mut self.velocity);
        for ((x, u), phase) in places.zip(&self.phase) {
            if *phase == Phase::Liquid {
                self.faces.fold(x, u);
            }
        }
    }

    /// Name and bytes of each column, for the record.
    #[must_use]
    pub fn memory(&self) -> Vec<(&'static str, usize)> {
        let n = self.len();
        let mut bytes = vec![
            ("position", 24 * n),
            ("velocity", 24 * n),
            ("flags", 4 * n),
            ("temperature", 8 * self.temperature.len()),
            ("enthalpy", 8 * self.enthalpy.len()),
            ("pressure", 8 * self.pressure.len()),
            ("surface", size_of::<Patch>() * self.surface.len()),
            ("near", self.near.bytes()),
            ("grains", self.grains.as_ref().map_or(0, Set::bytes)),
        ];
        bytes.retain(|(_, held)| *held > 0);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const METAL: Metal = Metal {
        density: 7850.0,
        spacing: 0.5e-3,
        smoothing_length: 0.5e-3,
    };

    #[test]
    fn a_column_nobody_needs_is_not_held() {
        let mut state = State::new(METAL, vec![Column::Pressure, Column::Pressure]);
        state.push(Particle {
            position: [0.0; 3],
            velocity: [0.0; 3],
            phase: Phase::Liquid,
            droplet: false,
            wall: false,
            temperature: 300.0,
            enthalpy: 0.0,
        });
        assert_eq!(state.columns(), [Column::Pressure]);
        assert!(state.temperature.is_empty() && state.enthalpy.is_empty());
        assert_eq!(state.pressure.len(), 1);
        assert!(
            state
                .memory()
                .iter()
                .all(|(name, _)| *name != "temperature")
        );
    }
}
