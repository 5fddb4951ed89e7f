//! Water without sound: a pressure that leaves its velocity without divergence, on particles that are kept even.
//!
//! At the places of a step's end, with the accelerations f of all other stages, the pressure solves
//!
//! ```text
//! div (dt/rho grad p) = div u* - e/dt,   u* = u + dt f,   u -= dt/rho grad p      (Chorin 1968; Cummins and Rudman 1999)
//! p = 0 at the free surface,   dp/dn = rho f.n at plain walls,   and u.n as told where a nozzle leads
//! ```
//!
//! Forces and pressure give their impulse at once, so that the velocity with which particles drift in the next step has no
//! divergence, whatever the length of that step. (Half of the impulse before and half after, as the march does it, left some
//! where steps changed, and the pressure swung by a half.) e is a small part of the
//! excess of density (Pozorski and Wawrenczuk 2002). The surface is where a particle lacks neighbours
//! (`operators`); it needs no threshold on the density and nothing there is stiff.
//!
//! The gradient is that of differences, exact where p is linear (`operators`; Bonet and Lok 1999); what it lacks in
//! action and reaction is put right in `bodies`. The equation is the compact one of Brookshaw (1985) with the diagonal as
//! preconditioner (`poisson`), which begins from the last pressure. Particles come to lie in rows along streamlines and
//! are shifted back (`shift`). Solids beside the water yield within the equation of the pressure (`beside`). A jet without an obstacle has p = 0 to the last bit, and keeps its speed.
//!
//! The step is bounded by how far neighbours go against one another and how far anything goes at all (it must see a wall
//! before it is behind it), by no speed of sound.

mod beside;
mod bodies;
mod equations;
mod filled;
mod operators;
mod poisson;
mod shift;
mod shore;
mod slopes;
mod yielding;

use kernels::Kernel;
use particles::{Column, POSITION, sweep};
use shapes::Body;
use steps::Limit;

use self::beside::Beside;
use self::bodies::Bodies;
use self::filled::Filled;
use self::operators::{Sums, is_led};
use self::poisson::Poisson;
pub use self::shore::Shore;
use super::around::Around;
use super::near::LISTED;
use super::nozzle::LED;
use super::walls::Walls;
use crate::stage::{Course, Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// p \[Pa\]: the next solution begins with it.
const PRESSURE: Column<f64> = Column::new("pressure", "Pa", 0.0).saved().shown();

/// Way of neighbours against one another in a step, in spacings.
const LONGEST: f64 = 0.2;
/// Way of a particle in a step, in spacings.
const FARTHEST: f64 = 0.5;
/// Part of the time in which what pushes moves water by a spacing that a step may take.
const PUSH: f64 = 0.25;

/// What a scene says of its water.
#[derive(Debug, Clone)]
pub struct Liquid {
    /// Number of the set.
    pub set: usize,
    /// rho \[kg/m3\].
    pub density: f64,
    /// d \[m\].
    pub spacing: f64,
    /// h \[m\].
    pub smoothing_length: f64,
    /// Plain walls with their names.
    pub walls: Vec<(String, Body)>,
    /// Whether it pulls where it cannot part from a solid.
    pub pulls: bool,
}

/// The stage.
pub struct DivergenceFree<const D: usize, K> {
    liquid: Liquid,
    around: Around<K>,
    filled: Filled,
    rows: Vec<Sums>,
    /// Whether a particle is near a wall.
    is_beside: Vec<bool>,
    /// f \[m/s2\].
    pushed: Vec<[f64; 3]>,
    poisson: Poisson,
    bodies: Bodies,
    walls: Walls,
    beside: Beside<K>,
    /// Speed of neighbours against one another \[m/s\].
    closing: f64,
    /// Greatest f \[m/s2\].
    push: f64,
    /// What others count: the sums of m f \[N\] and of m f.u \[W\].
    others: Course<4>,
    entry: Entry,
    sweeps: u64,
}

impl<const D: usize, K: Kernel> DivergenceFree<D, K> {
    /// The stage of a scene's water beside solids.
    #[must_use]
    pub fn new(liquid: Liquid, kernel: K, shores: Vec<Shore<K>>) -> Self {
        let filled = Filled::of(&kernel, liquid.spacing, D);
        let bodies = liquid.walls.iter().map(|(_, body)| body.clone()).collect();
        Self {
            around: Around::new(kernel, liquid.smoothing_length, bodies),
            filled,
            rows: Vec::new(),
            is_beside: Vec::new(),
            pushed: Vec::new(),
            poisson: Poisson::default(),
            bodies: Bodies::beside(shores.len()),
            beside: Beside::new(shores),
            walls: Walls::new(liquid.walls.iter().map(|(name, _)| name.clone()).collect()),
            closing: 0.0,
            push: 0.0,
            others: Course::default(),
            entry: Entry::default(),
            sweeps: 0,
            liquid,
        }
    }

    /// Looks at all particles, and brings back what stands behind a wall: only those before it see each other's images
    /// alike.
    fn see(&mut self, state: &mut State, dt: f64) {
        let exchanges = state.exchanges;
        let set = &mut state.sets[self.liquid.set];
        let (mass, density) = (set.take(&MASS), self.liquid.density);
        let led = set.has(&LED).then(|| set.take(&LED));
        let leads = |a: usize| led.as_ref().is_some_and(|led| led[a] > 0);
        self.around.look(set, exchanges, |a| {
            (mass[a] / density, f64::from(u8::from(leads(a))))
        });
        set.put(&MASS, mass);
        if let Some(led) = led {
            set.put(&LED, led);
        }
        self.is_beside.clear();
        self.is_beside.resize(set.len(), false);
        for a in &self.around.beside {
            self.is_beside[*a as usize] = true;
        }
        if dt > 0.0 && !self.around.beside.is_empty() {
            self.walls.land(set, &self.around, dt, &mut self.entry);
            let (position, velocity) = (set.column(&POSITION), set.column(&VELOCITY));
            for a in self.around.beside.iter().map(|a| *a as usize) {
                let seen = &mut self.around.seen[a];
                (seen.x, seen.u) = (position[a], velocity[a]);
            }
        }
    }

    /// u* = u + dt f.
    fn predict(&mut self, state: &State, dt: f64) {
        let acceleration = state.sets[self.liquid.set].column(&ACCELERATION);
        let seen = &self.around.seen;
        self.pushed.resize(seen.len(), [0.0; 3]);
        sweep::fill(&mut self.pushed, |a| {
            if is_led(&seen[a]) {
                [0.0; 3]
            } else {
                acceleration[a]
            }
        });
        let pushed = &self.pushed;
        sweep::change(&mut self.around.seen, |a, seen| {
            (0..3).for_each(|k| seen.u[k] += dt * pushed[a][k]);
        });
        let most = sweep::greatest(pushed.len(), |a| pushed[a].iter().map(|x| x * x).sum());
        self.push = most.map_or(0.0, |(_, most)| most.sqrt());
    }

    /// How fast neighbours go against one another with the velocities that are seen \[m/s\].
    fn closing(&self) -> f64 {
        let around = &self.around;
        let most = sweep::greatest(around.seen.len(), |a| {
            let (own, mut most) = (&around.seen[a], 0.0_f64);
            let mut look = |u: [f64; 3]| {
                most = most.max((0..3).map(|k| (u[k] - own.u[k]).powi(2)).sum());
            };
            around.each(a, |_, other, _, _, _| look(other.u));
            if self.is_beside[a] {
                around.mirrored(a, |_, other, _, _, _| look(other.u));
            }
            for partner in self.beside.of(a) {
                let led = partner.led(own.u);
                look([0, 1, 2].map(|k| 2.0 * led.u[k] - own.u[k]));
            }
            most
        });
        most.map_or(0.0, |(_, most)| most.sqrt())
    }

    /// u += dt (f - grad p/rho), once for the whole step: what others push is taken out of the march, which gives it in halves. Their
    /// books count halves too; what was given is put in their place.
    fn strike(&mut self, state: &mut State, accelerations: &[[f64; 3]], dt: f64) {
        let set = &mut state.sets[self.liquid.set];
        let (mut velocity, mut pushes) = (set.take(&VELOCITY), set.take(&ACCELERATION));
        let mass = set.column(&MASS);
        let [x, y, z, work, gained] = sweep::sum(mass.len(), |a| {
            let (f, own) = (self.pushed[a], accelerations[a]);
            let middle = [0, 1, 2].map(|k| velocity[a][k] + 0.5 * dt * (f[k] + own[k]));
            let [x, y, z] = f.map(|f| mass[a] * f);
            [
                x,
                y,
                z,
                mass[a] * dot(f, middle),
                mass[a] * dot(own, middle),
            ]
        });
        let counted = sweep::sum(mass.len(), |a| {
            let [x, y, z] = pushes[a].map(|f| mass[a] * f);
            [x, y, z, mass[a] * dot(pushes[a], velocity[a])]
        });
        let counted = self.others.over(dt, counted);
        for (k, force) in [x, y, z].into_iter().enumerate() {
            self.entry.impulse[k] += dt * force - counted[k];
        }
        self.entry.work += dt * work - counted[3];
        self.entry.spent -= dt * gained;
        let pushed = &self.pushed;
        sweep::change(&mut velocity, |a, u| {
            (0..3).for_each(|k| u[k] += dt * (pushed[a][k] + accelerations[a][k]));
        });
        pushes.fill([0.0; 3]);
        set.put(&VELOCITY, velocity);
        set.put(&ACCELERATION, pushes);
        sweep::change(&mut self.around.seen, |a, seen| {
            (0..3).for_each(|k| seen.u[k] += dt * accelerations[a][k]);
        });
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

impl<const D: usize, K: Kernel> Stage for DivergenceFree<D, K> {
    fn name(&self) -> &'static str {
        "water"
    }

    fn declare(&self, state: &mut State) {
        let set = &mut state.sets[self.liquid.set];
        set.declare(&LISTED);
        set.declare(&PRESSURE);
        self.beside.declare(state);
    }

    fn look(&mut self, state: &mut State, _: f64) {
        self.beside.show(state);
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let (d, mut closing) = (self.liquid.spacing, self.closing);
        let u = state.sets[self.liquid.set].column(&VELOCITY);
        let most = sweep::greatest(u.len(), |a| u[a].iter().map(|u| u * u).sum());
        let fastest = most.map_or(0.0, |(_, most)| most.sqrt());
        if state.step == 0 && self.closing <= 0.0 {
            // Before the first step nobody has looked: at most all go against one another.
            closing = fastest;
        }
        let limits = [
            ("courant", FARTHEST * d / fastest),
            ("closing", LONGEST * d / closing),
            ("acceleration", PUSH * (d / self.push).sqrt()),
        ];
        let all = limits
            .into_iter()
            .map(|(name, seconds)| Limit::dividing(name, seconds));
        let least = all.min_by(|a, b| a.seconds.total_cmp(&b.seconds));
        least.filter(|limit| limit.seconds.is_finite())
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        self.see(state, dt);
        self.predict(state, dt);
        if self.beside.len() > 0 {
            let seen = &self.around.seen;
            self.beside.look(state, seen, dt, is_led);
        }
        self.sum();
        let mut p = state.sets[self.liquid.set].take(&PRESSURE);
        for (p, seen) in p.iter_mut().zip(&self.around.seen) {
            if is_led(seen) {
                *p = 0.0;
            }
        }
        if dt > 0.0 {
            self.solve(&mut p, state, dt)?;
        }
        self.reach_led(&mut p);
        let (density, seen) = (self.liquid.density, &self.around.seen);
        self.beside.reach(&p, seen, density, &self.pushed);
        let mut accelerations = self.accelerations(&p);
        let across = self.across(&p);
        let bodies = &mut self.bodies;
        let mut forces = bodies.balance(&self.around, density, &mut accelerations, &across);
        self.strike(state, &accelerations, dt);
        let nozzles = forces.pop().unwrap_or_default();
        if self.beside.len() > 0 && dt > 0.0 {
            let on_solids = forces.split_off(self.around.bodies.len());
            for force in &on_solids {
                (0..3).for_each(|k| self.entry.impulse[k] -= dt * force[k]);
            }
            self.beside.press(state, &p, on_solids);
        }
        state.sets[self.liquid.set].put(&PRESSURE, p);
        forces.truncate(self.around.bodies.len());
        self.walls.forces = forces;
        let by_walls = self.walls.strike(dt);
        (0..3).for_each(|k| self.entry.impulse[k] += by_walls[k] - dt * nozzles[k]);
        self.closing = self.closing();
        Ok(())
    }

    fn exchange(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let set = &mut state.sets[self.liquid.set];
        let d = self.liquid.spacing;
        let shifts = shift::shifts(&self.around, &self.rows, self.closing * dt / d, d);
        let (mut position, mut velocity) = (set.take(&POSITION), set.take(&VELOCITY));
        let mass = set.column(&MASS);
        let [gained] = sweep::sum(mass.len(), |a| {
            let (u, change) = (velocity[a], shifts[a].1);
            let along: f64 = (0..3).map(|k| change[k] * (u[k] + 0.5 * change[k])).sum();
            [mass[a] * along]
        });
        self.entry.spent -= gained;
        sweep::change(&mut position, |a, x| {
            (0..3).for_each(|k| x[k] += shifts[a].0[k])
        });
        sweep::change(&mut velocity, |a, u| {
            (0..3).for_each(|k| u[k] += shifts[a].1[k])
        });
        set.put(&POSITION, position);
        set.put(&VELOCITY, velocity);
        Ok(())
    }

    fn entry(&self, _: &State) -> Entry {
        self.entry
    }

    fn figures(&self, state: &State) -> Vec<Figure> {
        let mut figures = self.walls.figures(D);
        figures.extend(self.beside.figures(state));
        figures.push(Figure {
            name: "water_sweeps".to_owned(),
            unit: "1",
            value: self.sweeps as f64 / state.step.max(1) as f64,
        });
        figures
    }

    fn bytes(&self) -> usize {
        self.around.bytes()
            + self.poisson.bytes()
            + self.bodies.bytes()
            + self.beside.bytes()
            + (size_of::<Sums>() + 24 + 1) * self.rows.len()
    }

    fn save(&self) -> Vec<f64> {
        let mut saved = [
            &self.entry.save()[..],
            &self.others.last(),
            &[self.closing, self.push, self.sweeps as f64],
            &[self.around.near.save()],
        ]
        .concat();
        saved.extend(self.beside.save());
        saved.extend(self.walls.save());
        saved
    }

    fn restore(&mut self, state: &State, saved: &[f64]) {
        let listed = state.sets[self.liquid.set].column(&LISTED);
        let rest = self.others.restore(self.entry.restore(saved));
        if let [closing, push, sweeps, seen, walls @ ..] = rest {
            (self.closing, self.push, self.sweeps) = (*closing, *push, *sweeps as u64);
            self.around.near.restore(listed, *seen);
            self.walls.restore(self.beside.restore(walls));
        }
        self.around.stand_beside(listed);
    }
}

#[cfg(test)]
mod tests;
