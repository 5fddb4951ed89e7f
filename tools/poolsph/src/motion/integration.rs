//! A step of the motion (Komen 2019, fig. 3.16): prediction by inertia, viscosity and forces,
//! correction by the pressure, new positions.

use particles::{Column, Matter, POSITION};
use rayon::prelude::*;
use shapes::frame::{along, squared};
use steps::{Figure, Limit};

use super::around::Around;
use super::divergence_free::{Closing, DivergenceFree};
use super::homogenising::Homogenising;
use super::law::Law;
use super::noise::Noise;
use super::parameters::{Method, Parameters};
use super::projection::Projection;
use super::settled::Settled;
use super::step::{Solved, Step, Tolerance};
use super::viscosity::Viscosity;
use crate::forces::capillary;
use crate::near::{Near, Role};
use crate::stage::{Stage, StageError};
use crate::state::slag::Slag;
use crate::state::{PHASE, State, TEMPERATURE, VELOCITY, phase};
use crate::sweep::GRAIN;

/// A particle may cross this part of its diameter in one substep.
const COURANT: f64 = 0.4;
/// Pressure is the mean over about this time \[s\], but for [`Method::DivergenceFree`]: single steps push unevenly, as the
/// density is kept only to a tolerance, and it is their mean that balances the forces.
const PRESSURE_TIME: f64 = 5e-3;
/// More substeps than this are no longer a flow.
const SUBSTEPS_MAX: u32 = 32;
/// Part of what is left of a step that rounding may take.
const ROUNDED: f64 = 1e-9;

/// p \[Pa\] as frames show it.
pub(crate) const PRESSURE: Column<f64> = Column::new("pressure", "Pa", 0.0).shown();
/// p \[Pa\] that the metal carries, from all pair forces, as the mean over some milliseconds. Single particles differ like
/// the contacts of grains, so that frames show [`Near::liquid_mean`]. That of the last step is even where the flow is
/// without divergence, and shown as it is.
pub(crate) const CARRIED: Column<f64> = Column::new("pressure_carried", "Pa", 0.0).saved();

/// The stage that moves the liquid.
pub struct Motion {
    parameters: Parameters,
    viscosity: Viscosity,
    noise: Noise,
    around: Around,
    projection: Projection,
    homogenising: Homogenising,
    divergence_free: DivergenceFree,
    closing: Closing,
    predicted: Vec<[f64; 3]>,
    /// Pressure that keeps the density, by index in [`State`]: where the next solution starts.
    multiplier: Vec<f64>,
    solved: Solved,
    settled: Settled,
    /// Step in which a particle at rest falls by COURANT d \[s\].
    fall: f64,
    substeps: u32,
    speed: f64,
}

impl Motion {
    /// The motion of `metal` with a viscosity by `law`, that of the parameters.
    #[must_use]
    pub fn new(parameters: Parameters, law: Law, metal: Matter) -> Self {
        let gravity = parameters.gravity_m_s2.unwrap_or_default();
        Self {
            viscosity: Viscosity::new(law, metal),
            noise: Noise::new(squared(gravity).sqrt(), metal),
            parameters,
            around: Around::default(),
            projection: Projection::new(metal),
            homogenising: Homogenising::new(metal),
            divergence_free: DivergenceFree::new(metal),
            closing: Closing::default(),
            predicted: Vec::new(),
            multiplier: Vec::new(),
            solved: Solved::default(),
            settled: Settled::default(),
            fall: (COURANT * metal.spacing / squared(gravity).sqrt()).sqrt(),
            substeps: 0,
            speed: 0.0,
        }
    }

    /// The same with slag of a viscosity by `law` beside the metal.
    #[must_use]
    pub fn beside(mut self, slag: Slag, law: Law) -> Self {
        self.viscosity = self.viscosity.beside(slag, law);
        self
    }

    /// u* = u + dt (g + f/rho + viscous acceleration); solid particles rest.
    fn predict(&mut self, near: &Near, dt: f64) {
        let gravity = self.parameters.gravity_m_s2.unwrap_or_default();
        let points = near.role.par_iter().zip(&near.velocity).zip(&near.force);
        points
            .enumerate()
            .with_min_len(GRAIN)
            .map(|(a, ((role, u), force))| match role {
                Role::Liquid => along(along(*u, dt, gravity), dt / near.density(a), *force),
                _ => [0.0; 3],
            })
            .collect_into_vec(&mut self.predicted);
        let (around, predicted) = (&mut self.around, &mut self.predicted);
        if self.parameters.method == Method::DivergenceFree {
            (self.viscosity).apply_between_faces(near, dt, predicted);
            let viscosity = &self.viscosity;
            self.divergence_free.begin(near, viscosity);
            (self.divergence_free).slacken(near, viscosity, dt, predicted);
        } else if self.viscosity.acts() || self.noise.acts() {
            around.sum(near, &near.velocity);
            self.viscosity.apply(near, around, dt, predicted);
            self.noise
                .damp(near, around, &self.viscosity, dt, predicted);
        }
    }

    fn substep(&mut self, near: &mut Near, step: Step, borne: [f64; 3]) {
        let dt = step.dt;
        self.predict(near, dt);
        let tolerance = Tolerance {
            density: self.parameters.density_tolerance,
            sweeps_min: self.parameters.sweeps_min,
            sweeps_max: self.parameters.sweeps_max,
        };
        let predicted = &mut self.predicted;
        let solved = match self.parameters.method {
            Method::Projection => self.projection.solve(near, predicted, step, tolerance),
            Method::Homogenising => self.homogenising.solve(near, predicted, step, tolerance),
            Method::DivergenceFree => self
                .divergence_free
                .solve(near, predicted, borne, step, tolerance),
        };
        (self.settled).note(solved.density_error, self.parameters.density_tolerance);
        self.solved.sweeps += solved.sweeps;
        self.solved.density_error = self.solved.density_error.max(solved.density_error);
        std::mem::swap(&mut near.velocity, &mut self.predicted);
        let points = near.position.par_iter_mut().zip(&near.velocity);
        points
            .with_min_len(GRAIN)
            .for_each(|(x, u)| *x = along(*x, dt, *u));
        if self.parameters.method == Method::DivergenceFree {
            self.divergence_free.even(near, dt);
        }
    }

    /// An error if the fastest particle is no longer part of a flow in a step of `dt` \[s\]; its speed \[m/s\].
    fn fastest(&self, state: &State, dt: f64) -> Result<f64, StageError> {
        let near = &state.near;
        let fastest = near.fastest_squared();
        let speed = fastest.sqrt();
        let limit = f64::from(SUBSTEPS_MAX) * COURANT * state.metal.matter.spacing / dt;
        if speed.is_nan() || speed > limit {
            let is_it =
                |u: &[f64; 3]| squared(*u).total_cmp(&fastest).is_eq() || squared(*u).is_nan();
            let member = near.velocity.iter().position(is_it).unwrap_or(0);
            let particle = near.id[member] as usize;
            return Err(StageError::Diverged {
                step: state.step,
                particle,
                place: state.metal.column(&POSITION)[particle],
                quantity: "speed",
                value: speed,
                limit,
                unit: "m/s",
            });
        }
        Ok(speed)
    }

    /// Number of substeps of `dt` \[s\] for a greatest `speed` \[m/s\].
    fn divide(&mut self, near: &Near, metal: Matter, speed: f64, dt: f64) -> u32 {
        let courant = (speed * dt / (COURANT * metal.spacing)).ceil().max(1.0);
        let viscous = (dt / self.viscosity.limit()).ceil().max(1.0);
        let falling = (dt / self.fall).ceil();
        let capillary = (dt / capillary::limit(near, metal)).ceil();
        let mut substeps = courant.max(viscous).max(falling).max(capillary);
        if self.parameters.method == Method::DivergenceFree {
            let closing = dt / self.closing.limit(near, metal.spacing);
            substeps = substeps.max(closing.ceil());
        }
        substeps as u32
    }

    /// Takes a step of `dt` \[s\] in as many parts as the flow needs at its beginning; where it is without divergence, what is left
    /// is divided anew after each of them.
    fn march(&mut self, state: &mut State, dt: f64, borne: [f64; 3]) -> Result<(), StageError> {
        let metal = state.metal.matter;
        let speed = self.fastest(state, dt)?;
        let mut left = self.divide(&state.near, metal, speed, dt);
        let mut share = 1.0 / f64::from(left);
        let mut step = Step {
            metal,
            dt: dt / f64::from(left),
            share,
        };
        let mut rest = 1.0;
        self.substeps = 0;
        loop {
            self.substep(&mut state.near, step, borne);
            self.substeps += 1;
            (left, rest) = (left - 1, rest - share);
            if left == 0 {
                return Ok(());
            }
            state.near.refresh(&state.faces);
            if self.parameters.method == Method::DivergenceFree {
                let speed = self.fastest(state, dt)?;
                let needed = self.divide(&state.near, metal, speed, rest * dt * (1.0 - ROUNDED));
                if needed != left {
                    (left, share) = (needed, rest / f64::from(needed));
                    (step.dt, step.share) = (share * dt, share);
                }
            }
        }
    }

    /// The pressure that particles carry.
    fn carried(&self) -> Column<f64> {
        match self.parameters.method {
            Method::DivergenceFree => PRESSURE.saved(),
            Method::Projection | Method::Homogenising => CARRIED,
        }
    }

    /// Takes the results of the copy back to the particles.
    fn scatter(&mut self, state: &mut State, dt: f64) {
        let free = self.parameters.method == Method::DivergenceFree;
        let weight = if free {
            1.0
        } else {
            (dt / PRESSURE_TIME).min(1.0)
        };
        self.multiplier.resize(state.len(), 0.0);
        let found = if free {
            &self.divergence_free.pressure
        } else {
            &self.projection.pressure
        };
        let near = &state.near;
        let columns = (&POSITION, &VELOCITY, &self.carried(), &PHASE);
        let (places, velocities, pressures, phases) = state.metal.columns_mut(columns);
        let places = places.par_iter_mut().zip(velocities);
        let pressures = pressures.par_iter_mut().zip(&mut self.multiplier);
        let members = phases.par_iter().zip(near.members());
        let particles = places.zip(pressures).zip(members);
        particles.with_min_len(GRAIN).for_each(
            |(((x, u), (pressure, multiplier)), (phase, member))| {
                let Some(a) = member else {
                    (*pressure, *multiplier) = (0.0, 0.0);
                    return;
                };
                *pressure += weight * (near.virial[a] - *pressure);
                *multiplier = f64::from(found[a]);
                if near.role[a] == Role::Liquid && *phase == phase::LIQUID {
                    (*x, *u) = (near.position[a], near.velocity[a]);
                }
            },
        );
    }
}

impl Stage for Motion {
    fn name(&self) -> &'static str {
        "motion"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&self.carried());
        state.metal.declare(&PRESSURE);
    }

    fn show(&self, state: &mut State) {
        if self.parameters.method != Method::DivergenceFree {
            let carried = state.metal.column(&CARRIED);
            let mean = state.near.liquid_mean(carried);
            state.metal.put(&PRESSURE, mean);
        }
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let courant = COURANT * state.metal.matter.spacing / self.speed;
        let viscous = self.viscosity.limit();
        Some(if self.fall < courant.min(viscous) {
            Limit::dividing("fall", self.fall)
        } else if courant < viscous {
            Limit::dividing("courant", courant)
        } else {
            Limit::dividing("viscosity", viscous)
        })
    }

    fn parts(&self) -> u64 {
        u64::from(self.substeps)
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.solved = Solved::default();
        if state.near.is_empty() {
            return Ok(());
        }
        self.viscosity
            .take(&state.near, state.metal.column(&TEMPERATURE))?;
        self.projection.pressure.clear();
        let start = |&id: &u32| self.multiplier.get(id as usize).copied().unwrap_or(0.0) as f32;
        self.projection
            .pressure
            .extend(state.near.id.iter().map(start));
        self.divergence_free
            .pressure
            .clone_from(&self.projection.pressure);
        let gravity = self.parameters.gravity_m_s2.unwrap_or_default();
        let borne = [0, 1, 2].map(|axis| {
            if state.faces.is_periodic(axis) {
                0.0
            } else {
                gravity[axis]
            }
        });
        self.march(state, dt, borne)?;
        state.near.fold(&state.faces);
        self.speed = state.near.fastest_squared().sqrt();
        self.scatter(state, dt);
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        vec![
            Figure {
                name: "sweeps",
                unit: "1",
                value: f64::from(self.solved.sweeps),
            },
            Figure {
                name: "density_error",
                unit: "1",
                value: self.solved.density_error,
            },
            Figure {
                name: "substeps",
                unit: "1",
                value: f64::from(self.substeps),
            },
            Figure {
                name: "speed_max",
                unit: "m/s",
                value: self.speed,
            },
        ]
    }

    fn bytes(&self) -> usize {
        self.projection.bytes()
            + self.homogenising.bytes()
            + self.closing.bytes()
            + self.divergence_free.bytes()
            + self.noise.bytes()
            + self.viscosity.bytes()
            + self.around.bytes()
            + 24 * self.predicted.capacity()
            + 8 * self.multiplier.capacity()
    }

    fn warnings(&self) -> Vec<String> {
        let told = self.settled.warning(self.parameters.sweeps_max);
        told.into_iter().collect()
    }

    fn save(&self) -> Vec<f64> {
        let multiplier = self.multiplier.iter().copied();
        self.settled.save().into_iter().chain(multiplier).collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        let (settled, multiplier) = Settled::restored(saved);
        (self.settled, self.multiplier) = (settled, multiplier.to_vec());
    }
}
