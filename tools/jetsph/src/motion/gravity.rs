//! Weight.

use particles::sweep;

use crate::stage::{Course, Entry, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// The stage: g on every particle.
pub struct Gravity {
    /// g \[m/s2\].
    pub acceleration: [f64; 3],
    course: Course<4>,
    entry: Entry,
}

impl Gravity {
    /// The stage of an acceleration \[m/s2\].
    #[must_use]
    pub fn new(acceleration: [f64; 3]) -> Self {
        Self {
            acceleration,
            course: Course::default(),
            entry: Entry::default(),
        }
    }
}

impl Stage for Gravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let g = self.acceleration;
        let mut now = [0.0; 4];
        for set in &mut state.sets {
            let own = set.column_mut(&ACCELERATION);
            sweep::change(own, |_, a| (0..3).for_each(|k| a[k] += g[k]));
            // Work as it is done: what comes in and leaves needs no height then.
            let (mass, velocity) = (set.column(&MASS), set.column(&VELOCITY));
            let [total, power] = sweep::sum(set.len(), |a| {
                let u = velocity[a];
                [mass[a], mass[a] * (u[0] * g[0] + u[1] * g[1] + u[2] * g[2])]
            });
            (0..3).for_each(|k| now[k] += total * g[k]);
            now[3] += power;
        }
        let [x, y, z, work] = self.course.over(dt, now);
        let given = self.entry.impulse.iter_mut().zip([x, y, z]);
        given.for_each(|(sum, part)| *sum += part);
        self.entry.work += work;
        Ok(())
    }

    fn entry(&self, _: &State) -> Entry {
        self.entry
    }

    fn save(&self) -> Vec<f64> {
        [&self.entry.save()[..], &self.course.last()].concat()
    }

    fn restore(&mut self, _: &State, saved: &[f64]) {
        let rest = self.entry.restore(saved);
        self.course.restore(rest);
    }
}
