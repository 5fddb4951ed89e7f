//! The stage of water: densities at the middle of a step, forces at its end.

use kernels::Kernel;
use particles::{Column, POSITION, Set, sweep};
use rayon::prelude::*;
use shapes::Body;

use super::diffusion::DensityDiffusion;
use super::friction::Artificial;
use super::near::{LISTED, Near};
use super::seen::Seen;
use super::tait::Tait;
use crate::stage::{Course, Entry, Figure, Limit, Stage, StageError};
use crate::state::{ACCELERATION, DENSITY, DENSITY_RATE, MASS, State, VELOCITY};

/// p \[Pa\].
pub const PRESSURE: Column<f64> = Column::new("pressure", "Pa", 0.0).shown();

/// Part of h that sound may go in a step.
const COURANT: f64 = 0.4;
/// Part of the time in which friction evens out a kernel that a step may take.
const FRICTION: f64 = 0.2;
/// Part of the time in which an acceleration moves by h that a step may take.
const PUSH: f64 = 0.25;
/// Particles per unit of parallel work.
pub(super) const GRAIN: usize = 64;

/// What a scene says of its water.
#[derive(Debug, Clone)]
pub struct Water {
    /// Number of the set.
    pub set: usize,
    /// Equation of state.
    pub law: Tait,
    /// h \[m\].
    pub smoothing_length: f64,
    /// Artificial viscosity, if any.
    pub artificial: Option<Artificial>,
    /// True viscosity \[Pa s\], if any.
    pub viscosity: Option<f64>,
    /// Diffusion of density, if any.
    pub diffusion: Option<DensityDiffusion>,
    /// Plain walls with their names.
    pub walls: Vec<(String, Body)>,
}

/// The stage.
pub struct Flow<const D: usize, K> {
    pub(super) water: Water,
    pub(super) kernel: K,
    pub(super) near: Near,
    pub(super) seen: Vec<Seen>,
    /// Corrected slopes of density.
    pub(super) slopes: Vec<[f64; 3]>,
    /// Particles near walls, since neighbours were found.
    pub(super) beside: Vec<u32>,
    pub(super) bodies: Vec<Body>,
    /// Force of the water on each wall \[N\].
    pub(super) forces: Vec<[f64; 3]>,
    /// Those forces over time.
    pushes: Vec<Course<3>>,
    /// What landed on each wall in the last step, over that \[N\].
    landed: Vec<[f64; 3]>,
    /// What they have given to each wall, and what landed on it \[N s\].
    impulses: Vec<[f64; 3]>,
    /// The force of all walls on the water and what friction takes.
    course: Course<4>,
    entry: Entry,
}

impl<const D: usize, K: Kernel> Flow<D, K> {
    /// The stage of a scene's water.
    #[must_use]
    pub fn new(water: Water, kernel: K) -> Self {
        let h = water.smoothing_length;
        Self {
            kernel,
            near: Near::new(h),
            seen: Vec::new(),
            slopes: Vec::new(),
            beside: Vec::new(),
            bodies: water.walls.iter().map(|(_, body)| body.clone()).collect(),
            forces: vec![[0.0; 3]; water.walls.len()],
            pushes: vec![Course::default(); water.walls.len()],
            landed: vec![[0.0; 3]; water.walls.len()],
            impulses: vec![[0.0; 3]; water.walls.len()],
            course: Course::default(),
            entry: Entry::default(),
            water,
        }
    }

    /// Looks at all particles; `value` gives what they show beside their volume.
    fn look(&mut self, set: &mut Set, exchanges: u64, value: impl Fn(f64) -> f64 + Sync) {
        let mut listed = set.take(&LISTED);
        let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
        let (mass, density) = (set.column(&MASS), set.column(&DENSITY));
        if self.near.refresh(position, &mut listed, exchanges) {
            self.stand_beside(&listed);
        }
        let law = self.water.law;
        self.seen.resize(position.len(), Seen::default());
        sweep::fill(&mut self.seen, |a| Seen {
            x: position[a],
            u: velocity[a],
            volume: mass[a] / law.filling(density[a]),
            value: value(density[a]),
        });
        set.put(&LISTED, listed);
    }

    /// Notes who stands beside a wall.
    fn stand_beside(&mut self, listed: &[[f64; 3]]) {
        let (bodies, reach) = (&self.bodies, self.near.radius());
        let near = |a: &u32| {
            bodies
                .iter()
                .any(|b| b.distance(listed[*a as usize]) < reach)
        };
        self.beside.clear();
        if !bodies.is_empty() {
            let all = (0..listed.len() as u32).into_par_iter().with_min_len(GRAIN);
            self.beside = all.filter(near).collect();
        }
    }

    /// Brings back what came behind a wall, and takes its speed into the wall: thin or parted water has no pressure that
    /// could stop it, and clings there instead of leaping off. What it gives to the wall is counted.
    fn land(&mut self, state: &mut State, dt: f64) {
        self.landed.fill([0.0; 3]);
        let set = &mut state.sets[self.water.set];
        let (mut position, mut velocity) = (set.take(&POSITION), set.take(&VELOCITY));
        let mass = set.column(&MASS);
        for a in self.beside.iter().map(|a| *a as usize) {
            for (wall, body) in self.bodies.iter().enumerate() {
                let distance = body.distance(position[a]);
                if distance < 0.0 {
                    let normal = body.normal(position[a], 1e-3 * self.water.smoothing_length);
                    (0..3).for_each(|k| position[a][k] -= 2.0 * distance * normal[k]);
                    let inward: f64 = (0..3).map(|k| velocity[a][k] * normal[k]).sum();
                    if inward < 0.0 {
                        self.entry.spent += 0.5 * mass[a] * inward * inward;
                        for k in 0..3 {
                            let given = -mass[a] * inward * normal[k];
                            self.entry.impulse[k] += given;
                            self.impulses[wall][k] -= given;
                            self.landed[wall][k] -= given / dt;
                            velocity[a][k] -= inward * normal[k];
                        }
                    }
                }
            }
        }
        set.put(&POSITION, position);
        set.put(&VELOCITY, velocity);
    }
}

impl<const D: usize, K: Kernel> Stage for Flow<D, K> {
    fn name(&self) -> &'static str {
        "water"
    }

    fn declare(&self, state: &mut State) {
        let set = &mut state.sets[self.water.set];
        set.declare(&LISTED);
        set.declare(&DENSITY_RATE);
        set.declare(&PRESSURE);
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let set = &state.sets[self.water.set];
        let (h, c) = (self.water.smoothing_length, self.water.law.sound_speed);
        let length = |x: [f64; 3]| x[0].hypot(x[1]).hypot(x[2]);
        let fastest = |column: &[[f64; 3]]| {
            sweep::greatest(column.len(), |a| length(column[a])).map_or(0.0, |(_, most)| most)
        };
        // Of speeds only how they differ counts; the whole is at most that.
        let speed = fastest(set.column(&VELOCITY));
        let push = fastest(set.column(&ACCELERATION));
        let density = self.water.law.density;
        let kinematic = self.water.viscosity.map_or(0.0, |mu| mu / density)
            + self.water.artificial.map_or(0.0, |a| {
                (a.linear + 2.0 * a.quadratic * speed / h) / density / (2.0 * (D as f64 + 2.0))
            });
        let limits = [
            ("acoustic", COURANT * h / (c + speed)),
            ("viscous", FRICTION * h * h / kinematic),
            ("acceleration", PUSH * (h / push).sqrt()),
        ];
        let all = limits
            .into_iter()
            .map(|(name, seconds)| Limit { seconds, name });
        all.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }

    fn flows(&self) -> bool {
        true
    }

    fn flow(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let exchanges = state.exchanges;
        let set = &mut state.sets[self.water.set];
        self.look(set, exchanges, |density| density);
        let rates = self.rates();
        let law = self.water.law;
        let mut total = set.take(&DENSITY_RATE);
        sweep::change(&mut total, |a, rate| *rate += rates[a][0] + rates[a][1]);
        set.put(&DENSITY_RATE, total);
        let mass = set.column(&MASS);
        let gained = |a: usize| {
            let density = self.seen[a].value;
            [mass[a] * law.pressure(density) / (density * density) * rates[a][1]]
        };
        if self.water.diffusion.is_some() {
            self.entry.spent -= dt * sweep::sum(rates.len(), gained)[0];
        }
        Ok(())
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let exchanges = state.exchanges;
        let law = self.water.law;
        let set = &mut state.sets[self.water.set];
        self.look(set, exchanges, |density| law.pressure(density));
        let forces = self.all_forces();
        let mut acceleration = set.take(&ACCELERATION);
        let mass = set.column(&MASS);
        sweep::change(&mut acceleration, |a, own| {
            (0..3).for_each(|k| own[k] += forces[a][k] / mass[a]);
        });
        set.put(&ACCELERATION, acceleration);
        let [lost] = sweep::sum(forces.len(), |a| [forces[a][3]]);
        let [x, y, z] = self.forces.iter().fold([0.0; 3], |sum, wall| {
            [0, 1, 2].map(|k: usize| sum[k] - wall[k])
        });
        let pushes = self.pushes.iter_mut().zip(&self.forces);
        for (impulse, (push, force)) in self.impulses.iter_mut().zip(pushes) {
            let given = push.over(dt, *force);
            (0..3).for_each(|k| impulse[k] += given[k]);
        }
        let [x, y, z, lost] = self.course.over(dt, [x, y, z, lost]);
        let given = self.entry.impulse.iter_mut().zip([x, y, z]);
        given.for_each(|(sum, part)| *sum += part);
        self.entry.spent += lost;
        Ok(())
    }

    fn exchange(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        if !self.beside.is_empty() {
            self.land(state, dt);
        }
        Ok(())
    }

    fn show(&self, state: &mut State) {
        let law = self.water.law;
        let set = &mut state.sets[self.water.set];
        let density = set.column(&DENSITY).to_vec();
        sweep::fill(set.column_mut(&PRESSURE), |a| law.pressure(density[a]));
    }

    fn entry(&self, state: &State) -> Entry {
        let set = &state.sets[self.water.set];
        let (mass, density) = (set.column(&MASS), set.column(&DENSITY));
        let law = self.water.law;
        let stored = sweep::sum(set.len(), |a| [mass[a] * law.energy(density[a])])[0];
        Entry {
            stored,
            ..self.entry
        }
    }

    fn figures(&self, _: &State) -> Vec<Figure> {
        let of = |what: &'static str, unit, values: &[[f64; 3]]| {
            let walls = self.water.walls.iter().zip(values);
            let each = walls.flat_map(|((name, _), value)| {
                let axes = ["x", "y", "z"].iter().zip(*value).take(D);
                axes.map(move |(axis, value)| Figure {
                    name: format!("water_{what}_on_{name}_{axis}"),
                    unit,
                    value,
                })
            });
            each.collect::<Vec<_>>()
        };
        let both = self.forces.iter().zip(&self.landed);
        let forces: Vec<[f64; 3]> = both
            .map(|(force, landed)| [0, 1, 2].map(|k: usize| force[k] + landed[k]))
            .collect();
        let mut figures = of("force", "N", &forces);
        figures.extend(of("impulse", "N s", &self.impulses));
        figures
    }

    fn bytes(&self) -> usize {
        self.near.bytes() + 64 * self.seen.len()
    }

    fn save(&self) -> Vec<f64> {
        let mut saved = [
            &self.entry.save()[..],
            &self.course.last(),
            &[self.near.save()],
        ]
        .concat();
        saved.extend(self.forces.as_flattened());
        saved.extend(self.impulses.as_flattened());
        saved
    }

    fn restore(&mut self, state: &State, saved: &[f64]) {
        let listed = state.sets[self.water.set].column(&LISTED);
        let rest = self.entry.restore(saved);
        if let [seen, walls @ ..] = self.course.restore(rest) {
            self.near.restore(listed, *seen);
            let (forces, impulses) = walls.split_at(3 * self.forces.len());
            self.forces.as_flattened_mut().copy_from_slice(forces);
            self.impulses.as_flattened_mut().copy_from_slice(impulses);
            for (push, force) in self.pushes.iter_mut().zip(&self.forces) {
                // What it has given until now is counted.
                let _ = push.over(0.0, *force);
            }
        }
        self.stand_beside(listed);
    }
}
