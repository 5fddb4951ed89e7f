//! Grains on their way: what a step of velocity Verlet does to them.

use contact::Grain;
use particles::{POSITION, Set, sweep};
use rayon::prelude::*;
use run::property::{Curve, OutOfRange};
use shapes::frame::{Vector, difference, dot};

use super::lists::ROWS;
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

    /// Whether no grain is free.
    #[must_use]
    pub fn all_driven(&self) -> bool {
        !self.grains.is_empty() && self.driven.len() == self.grains.len()
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

    /// x += dt u + dt^2/2 a, u += dt a. Gives the farthest way since neighbours were listed \[m\]; no number where one is none.
    pub fn predict(&mut self, step: f64) -> f64 {
        let (gravity, c) = (self.gravity, self.inertia_factor);
        for driven in &mut self.driven {
            driven.from = self.grains[driven.row].position;
        }
        let forces = self
            .force
            .par_chunks(ROWS)
            .zip(self.moment.par_chunks(ROWS));
        let places = self.listed.par_chunks(ROWS);
        let grains = self.grains.par_chunks_mut(ROWS);
        let far = grains.zip(forces).zip(places);
        let far = far.map(|((grains, (force, moment)), listed)| {
            let mut far = 0.0;
            let each = grains.iter_mut().zip(force).zip(moment).zip(listed);
            for (((grain, force), moment), listed) in each {
                let inverse = 1.0 / grain.mass;
                let turns = step * inverse / (c * grain.radius * grain.radius);
                for k in 0..3 {
                    let gained = step * (force[k] * inverse + gravity[k]);
                    grain.position[k] += step * (grain.velocity[k] + 0.5 * gained);
                    grain.velocity[k] += gained;
                    grain.spin[k] += turns * moment[k];
                }
                let way = difference(grain.position, *listed);
                far = greater(far, dot(way, way));
            }
            far
        });
        far.reduce(|| 0.0, greater).sqrt()
    }

    /// Keeps the forces of the step before; new ones take their place.
    pub fn turn(&mut self) {
        let [force, moment] = &mut self.before;
        std::mem::swap(force, &mut self.force);
        std::mem::swap(moment, &mut self.moment);
    }

    /// u += dt/2 (a' - a). Gives the greatest speed \[m/s\]; no number where one is none.
    pub fn correct(&mut self, step: f64) -> f64 {
        let c = self.inertia_factor;
        let forces = self
            .force
            .par_chunks(ROWS)
            .zip(self.moment.par_chunks(ROWS));
        let [before, turned] = &self.before;
        let old = before.par_chunks(ROWS).zip(turned.par_chunks(ROWS));
        let grains = self.grains.par_chunks_mut(ROWS);
        let fastest = grains.zip(forces).zip(old);
        let fastest = fastest.map(|((grains, (force, moment)), (before, turned))| {
            let mut fastest = 0.0;
            let forces = force.iter().zip(before).zip(moment.iter().zip(turned));
            for (grain, ((force, before), (moment, turned))) in grains.iter_mut().zip(forces) {
                let half = 0.5 * step / grain.mass;
                let turns = half / (c * grain.radius * grain.radius);
                for k in 0..3 {
                    grain.velocity[k] += half * (force[k] - before[k]);
                    grain.spin[k] += turns * (moment[k] - turned[k]);
                }
                fastest = greater(fastest, dot(grain.velocity, grain.velocity));
            }
            fastest
        });
        let fastest = fastest.reduce(|| 0.0, greater).sqrt();
        for driven in &self.driven {
            let grain = &mut self.grains[driven.row];
            (grain.velocity, grain.spin) = (driven.velocity[1], [0.0; 3]);
        }
        if self.driven.is_empty() {
            fastest
        } else {
            self.fastest()
        }
    }

    /// Moves the grains that are held to a velocity. Gives the farthest way of these since neighbours were listed \[m\].
    ///
    /// # Errors
    /// Where a formula has no value.
    pub fn drive(&mut self, time: f64, step: f64) -> Result<f64, OutOfRange> {
        let mut far = 0.0;
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
            let way = difference(grain.position, self.listed[driven.row]);
            far = greater(far, dot(way, way));
        }
        Ok(far.sqrt())
    }

    /// The greatest speed \[m/s\]; no number where one is none.
    fn fastest(&self) -> f64 {
        let squares = self.grains.iter().map(|g| dot(g.velocity, g.velocity));
        squares.fold(0.0, greater).sqrt()
    }
}

/// The greater of two; what is no number is greater.
#[inline]
fn greater(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
