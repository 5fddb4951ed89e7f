//! What water gives to plain walls: by its pressure and friction, and by what lands on them.

use kernels::Kernel;
use particles::{POSITION, Set};

use super::around::Around;
use super::near::Lists;
use crate::stage::{Course, Entry, Figure};
use crate::state::{MASS, VELOCITY};

/// Forces on plain walls and what they have given.
#[derive(Debug, Clone)]
pub(super) struct Walls {
    names: Vec<String>,
    /// Force of the water on each wall \[N\].
    pub(super) forces: Vec<[f64; 3]>,
    /// Those forces over time.
    pushes: Vec<Course<3>>,
    /// What landed on each wall in the last step, over that \[N\].
    landed: Vec<[f64; 3]>,
    /// What they have given to each wall, and what landed on it \[N s\].
    impulses: Vec<[f64; 3]>,
}

impl Walls {
    /// Walls on which nothing has pressed.
    pub(super) fn new(names: Vec<String>) -> Self {
        let none = vec![[0.0; 3]; names.len()];
        Self {
            pushes: vec![Course::default(); names.len()],
            names,
            forces: none.clone(),
            landed: none.clone(),
            impulses: none,
        }
    }

    /// Takes over what others found that walls bear \[N\].
    pub(super) fn bear(&mut self, found: &mut [[f64; 3]]) {
        for (force, found) in self.forces.iter_mut().zip(found) {
            let more = std::mem::take(found);
            (0..3).for_each(|k| force[k] += more[k]);
        }
    }

    /// Counts the present forces over a step of `dt` \[s\]; gives what all walls exert on the water \[N\].
    pub(super) fn press(&mut self, dt: f64) -> [f64; 3] {
        let pushes = self.pushes.iter_mut().zip(&self.forces);
        for (impulse, (push, force)) in self.impulses.iter_mut().zip(pushes) {
            let given = push.over(dt, *force);
            (0..3).for_each(|k| impulse[k] += given[k]);
        }
        self.forces.iter().fold([0.0; 3], |sum, wall| {
            [0, 1, 2].map(|k: usize| sum[k] - wall[k])
        })
    }

    /// Counts the present forces as what a step of `dt` \[s\] has given at once; gives what all walls gave the water \[N s\].
    pub(super) fn strike(&mut self, dt: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (impulse, force) in self.impulses.iter_mut().zip(&self.forces) {
            for k in 0..3 {
                impulse[k] += dt * force[k];
                sum[k] -= dt * force[k];
            }
        }
        sum
    }

    /// Brings back what came behind a wall, and takes its speed into the wall: thin or parted water has no pressure that
    /// could stop it, and clings there instead of leaping off. What it gives to the wall is counted.
    pub(super) fn land<K: Kernel, L: Lists>(
        &mut self,
        set: &mut Set,
        around: &Around<K, L>,
        dt: f64,
        entry: &mut Entry,
    ) {
        self.landed.fill([0.0; 3]);
        let h = 0.5 * around.kernel.support();
        let (mut position, mut velocity) = (set.take(&POSITION), set.take(&VELOCITY));
        let mass = set.column(&MASS);
        for a in around.beside.iter().map(|a| *a as usize) {
            for (wall, body) in around.bodies.iter().enumerate() {
                let distance = body.distance(position[a]);
                if distance < 0.0 {
                    let normal = body.normal(position[a], 1e-3 * h);
                    (0..3).for_each(|k| position[a][k] -= 2.0 * distance * normal[k]);
                    let inward: f64 = (0..3).map(|k| velocity[a][k] * normal[k]).sum();
                    if inward < 0.0 {
                        entry.spent += 0.5 * mass[a] * inward * inward;
                        for k in 0..3 {
                            let given = -mass[a] * inward * normal[k];
                            entry.impulse[k] += given;
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

    /// Force and impulse on each wall along each of `axes`.
    pub(super) fn figures(&self, axes: usize) -> Vec<Figure> {
        let of = |what: &'static str, unit, values: &[[f64; 3]]| {
            let walls = self.names.iter().zip(values);
            let each = walls.flat_map(|(name, value)| {
                let axes = ["x", "y", "z"].iter().zip(*value).take(axes);
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

    /// What a checkpoint keeps.
    pub(super) fn save(&self) -> Vec<f64> {
        [&self.forces[..], &self.impulses].concat().concat()
    }

    /// Takes it back.
    pub(super) fn restore(&mut self, saved: &[f64]) {
        let (forces, impulses) = saved.split_at(3 * self.forces.len());
        self.forces.as_flattened_mut().copy_from_slice(forces);
        self.impulses.as_flattened_mut().copy_from_slice(impulses);
        for (push, force) in self.pushes.iter_mut().zip(&self.forces) {
            // What it has given until now is counted.
            let _ = push.over(0.0, *force);
        }
    }
}
