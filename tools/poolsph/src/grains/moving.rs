//! Grains on their way: what a step of velocity Verlet does to them.

use contact::Grain;
use particles::{POSITION, Set, sweep};
use run::property::{Curve, OutOfRange};
use shapes::frame::{Vector, difference, dot};

use super::walls::velocity;
use super::{DRIVEN, FORCE, LISTED, MASS, MOMENT, RADIUS, SPIN, VELOCITY};

/// A grain that is held to a velocity.
#[derive(Debug, Clone, Copy)]
struct Driven {
    row: usize,
    /// Number of its body.
    body: usize,
    /// Where the step began \[m\], and its velocity there and at the end \[m/s\].
    from: Vector,
    velocity: [Vector; 2],
}

/// Grains with their forces, taken out of their columns for the steps within a step.
#[derive(Debug, Clone, Default)]
pub struct Moving {
    /// The grains.
    pub grains: Vec<Grain>,
    /// Force of all contacts \[N\].
    pub force: Vec<Vector>,
    /// Moment of all contacts \[N m\].
    pub moment: Vec<Vector>,
    /// Where they were when neighbours were listed \[m\].
    pub listed: Vec<Vector>,
    /// Forces and moments of the step before.
    before: [Vec<Vector>; 2],
    driven: Vec<Driven>,
    drives: Vec<Option<[Curve; 3]>>,
    gravity: Vector,
    /// I / (m r^2).
    inertia_factor: f64,
}

impl Moving {
    /// No grains yet; `drives` are the velocities that bodies are held to.
    #[must_use]
    pub fn new(gravity: Vector, inertia_factor: f64, drives: Vec<Option<[Curve; 3]>>) -> Self {
        Self {
            gravity,
            inertia_factor,
            drives,
            ..Self::default()
        }
    }

    /// Takes the columns that move.
    pub fn take(&mut self, set: &mut Set) {
        let columns = (
            set.column(&POSITION),
            set.column(&VELOCITY),
            set.column(&SPIN),
        );
        let (radius, mass) = (set.column(&RADIUS), set.column(&MASS));
        self.grains.clear();
        self.grains.extend((0..set.len()).map(|a| Grain {
            position: columns.0[a],
            velocity: columns.1[a],
            spin: columns.2[a],
            radius: radius[a],
            mass: mass[a],
        }));
        self.driven.clear();
        let driven = set.column(&DRIVEN).iter().enumerate();
        self.driven.extend(
            driven
                .filter(|(_, body)| **body > 0)
                .map(|(row, body)| Driven {
                    row,
                    body: *body as usize - 1,
                    from: [0.0; 3],
                    velocity: [self.grains[row].velocity; 2],
                }),
        );
        self.force = set.take(&FORCE);
        self.moment = set.take(&MOMENT);
        self.listed = set.take(&LISTED);
    }

    /// Puts the columns back.
    pub fn put(&mut self, set: &mut Set) {
        let grains = &self.grains;
        sweep::fill(set.column_mut(&POSITION), |a| grains[a].position);
        sweep::fill(set.column_mut(&VELOCITY), |a| grains[a].velocity);
        sweep::fill(set.column_mut(&SPIN), |a| grains[a].spin);
        set.put(&FORCE, std::mem::take(&mut self.force));
        set.put(&MOMENT, std::mem::take(&mut self.moment));
        set.put(&LISTED, std::mem::take(&mut self.listed));
    }

    /// Gives driven grains their velocity at the start.
    ///
    /// # Errors
    /// Where a formula has no value.
    pub fn begin(&mut self, time: f64) -> Result<(), OutOfRange> {
        for driven in &mut self.driven {
            if let Some(curves) = &self.drives[driven.body] {
                let now = velocity(curves, time)?;
                driven.velocity = [now; 2];
                self.grains[driven.row].velocity = now;
            }
        }
        Ok(())
    }

    /// x += dt u + dt^2/2 a, u += dt a.
    pub fn predict(&mut self, step: f64) {
        let (force, moment) = (&self.force, &self.moment);
        let (gravity, c) = (self.gravity, self.inertia_factor);
        for driven in &mut self.driven {
            driven.from = self.grains[driven.row].position;
        }
        sweep::change(&mut self.grains, |row, grain| {
            let inverse = 1.0 / grain.mass;
            let turns = step * inverse / (c * grain.radius * grain.radius);
            for k in 0..3 {
                let gained = step * (force[row][k] * inverse + gravity[k]);
                grain.position[k] += step * (grain.velocity[k] + 0.5 * gained);
                grain.velocity[k] += gained;
                grain.spin[k] += turns * moment[row][k];
            }
        });
    }

    /// Keeps the forces of the step before; new ones take their place.
    pub fn turn(&mut self) {
        let [force, moment] = &mut self.before;
        std::mem::swap(force, &mut self.force);
        std::mem::swap(moment, &mut self.moment);
    }

    /// u += dt/2 (a' - a).
    pub fn correct(&mut self, step: f64) {
        let (force, moment, [before, turned]) = (&self.force, &self.moment, &self.before);
        let c = self.inertia_factor;
        sweep::change(&mut self.grains, |row, grain| {
            let half = 0.5 * step / grain.mass;
            let turns = half / (c * grain.radius * grain.radius);
            for k in 0..3 {
                grain.velocity[k] += half * (force[row][k] - before[row][k]);
                grain.spin[k] += turns * (moment[row][k] - turned[row][k]);
            }
        });
        for driven in &self.driven {
            let grain = &mut self.grains[driven.row];
            (grain.velocity, grain.spin) = (driven.velocity[1], [0.0; 3]);
        }
    }

    /// Moves the grains that are held to a velocity.
    ///
    /// # Errors
    /// Where a formula has no value.
    pub fn drive(&mut self, time: f64, step: f64) -> Result<(), OutOfRange> {
        for driven in &mut self.driven {
            let Some(curves) = &self.drives[driven.body] else {
                continue;
            };
            let now = velocity(curves, time)?;
            let before = driven.velocity[1];
            driven.velocity = [before, now];
            let grain = &mut self.grains[driven.row];
            for k in 0..3 {
                grain.position[k] = driven.from[k] + 0.5 * step * (before[k] + now[k]);
            }
            (grain.velocity, grain.spin) = (now, [0.0; 3]);
        }
        Ok(())
    }

    /// The greatest speed \[m/s\]; none where one is no number.
    #[must_use]
    pub fn fastest(&self) -> f64 {
        let grains = &self.grains;
        let speed = sweep::greatest(grains.len(), |a| {
            dot(grains[a].velocity, grains[a].velocity)
        });
        speed.map_or(0.0, |(_, squared)| squared.sqrt())
    }

    /// The farthest way since neighbours were listed \[m\].
    #[must_use]
    pub fn strayed(&self) -> f64 {
        let (grains, listed) = (&self.grains, &self.listed);
        let far = sweep::greatest(grains.len(), |a| {
            let way = difference(grains[a].position, listed[a]);
            dot(way, way)
        });
        far.map_or(0.0, |(_, squared)| squared.sqrt())
    }
}
