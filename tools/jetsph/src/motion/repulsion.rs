//! Walls that push away what comes near.
//!
//! ```text
//! f(s) = D [ (d0/s)^n1 - (d0/s)^n2 ] / s     for s < d0, force per mass along the normal          (43)
//! ```
//!
//! In print the brackets do not match, and the force is that of wall particles at a spacing of d0, whose sum waves along
//! the wall. Here s is the distance from the surface of the wall, so that a flat wall is flat; D is of the order of the
//! square of the speed.

use particles::{POSITION, sweep};
use shapes::Body;
use steps::Limit;

use crate::stage::{Course, Entry, Figure, Stage, StageError};
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// Nothing comes nearer than this part of d0: the force grows without end there.
const NEAREST: f64 = 0.05;
/// Part of the time of a swing in the wall's field that a step may take.
const PART: f64 = 0.1;

/// The law (43).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repulsion {
    /// D \[m2/s2\].
    pub strength: f64,
    /// d0 \[m\], for each set.
    pub range: f64,
    /// n1 and n2.
    pub exponents: [f64; 2],
}

impl Repulsion {
    /// Acceleration away from the wall at a distance \[m/s2\].
    #[must_use]
    pub fn push(&self, distance: f64) -> f64 {
        if distance >= self.range {
            return 0.0;
        }
        let s = distance.max(NEAREST * self.range);
        let [near, far] = self.exponents.map(|n| (self.range / s).powf(n));
        self.strength * (near - far) / s
    }

    /// Energy that a kilogram stores there \[J/kg\]: the work of the push from d0.
    #[must_use]
    pub fn energy(&self, distance: f64) -> f64 {
        if distance >= self.range {
            return 0.0;
        }
        let s = distance.max(NEAREST * self.range);
        let [near, far] = self.exponents.map(|n| ((self.range / s).powf(n) - 1.0) / n);
        self.strength * (near - far) + self.push(s) * (s - distance)
    }
}

/// The stage of one wall.
pub struct Wall {
    name: String,
    body: Body,
    /// The law for each set.
    laws: Vec<Repulsion>,
    force: [f64; 3],
    /// Greatest push of the present state \[m/s2\].
    greatest: f64,
    course: Course<3>,
    entry: Entry,
}

impl Wall {
    /// The stage of a wall with the law for each set.
    #[must_use]
    pub fn new(name: String, body: Body, laws: Vec<Repulsion>) -> Self {
        Self {
            name,
            body,
            laws,
            force: [0.0; 3],
            greatest: 0.0,
            course: Course::default(),
            entry: Entry::default(),
        }
    }
}

impl Stage for Wall {
    fn name(&self) -> &'static str {
        "repulsion"
    }

    fn limit(&self, state: &State) -> Option<Limit> {
        let sets = state.sets.iter().zip(&self.laws);
        let seconds = sets.map(|(set, law)| {
            let speed = sweep::greatest(set.len(), |a| {
                let u = set.column(&VELOCITY)[a];
                u[0].hypot(u[1]).hypot(u[2])
            });
            let swing = PART * law.range / law.strength.sqrt();
            let pushed = PART * (law.range / self.greatest).sqrt();
            swing
                .min(pushed)
                .min(PART * law.range / speed.map_or(0.0, |(_, most)| most))
        });
        let seconds = seconds.fold(f64::INFINITY, f64::min);
        Some(Limit::dividing("repulsion", seconds))
    }

    fn act(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let mut total = [0.0; 3];
        self.greatest = 0.0;
        for (set, law) in state.sets.iter_mut().zip(&self.laws) {
            let mut acceleration = set.take(&ACCELERATION);
            let (position, mass) = (set.column(&POSITION), set.column(&MASS));
            let mut pushes = vec![[0.0; 3]; position.len()];
            sweep::fill(&mut pushes, |a| {
                let distance = self.body.distance(position[a]);
                if distance >= law.range {
                    return [0.0; 3];
                }
                let normal = self.body.normal(position[a], 1e-3 * law.range);
                normal.map(|n| law.push(distance) * n)
            });
            sweep::change(&mut acceleration, |a, own| {
                (0..3).for_each(|k| own[k] += pushes[a][k]);
            });
            let part = sweep::sum(pushes.len(), |a| pushes[a].map(|f| mass[a] * f));
            (0..3).for_each(|k| total[k] += part[k]);
            let length = |a: usize| pushes[a][0].hypot(pushes[a][1]).hypot(pushes[a][2]);
            let most = sweep::greatest(pushes.len(), length).map_or(0.0, |(_, most)| most);
            self.greatest = self.greatest.max(most);
            set.put(&ACCELERATION, acceleration);
        }
        self.force = total.map(|f| -f);
        let given = self.course.over(dt, total);
        (0..3).for_each(|k| self.entry.impulse[k] += given[k]);
        Ok(())
    }

    fn entry(&self, state: &State) -> Entry {
        let sets = state.sets.iter().zip(&self.laws);
        let stored = sets.map(|(set, law)| {
            let (position, mass) = (set.column(&POSITION), set.column(&MASS));
            sweep::sum(set.len(), |a| {
                [mass[a] * law.energy(self.body.distance(position[a]))]
            })[0]
        });
        Entry {
            stored: stored.sum(),
            ..self.entry
        }
    }

    fn figures(&self, state: &State) -> Vec<Figure> {
        let axes = ["x", "y", "z"]
            .iter()
            .zip(self.force)
            .take(state.dimensions);
        axes.map(|(axis, value)| Figure {
            name: format!("force_on_{}_{axis}", self.name),
            unit: "N",
            value,
        })
        .collect()
    }

    fn save(&self) -> Vec<f64> {
        let own = [self.greatest];
        [
            &self.entry.save()[..],
            &self.course.last(),
            &self.force,
            &own,
        ]
        .concat()
    }

    fn restore(&mut self, _: &State, saved: &[f64]) {
        let rest = self.entry.restore(saved);
        if let [x, y, z, greatest] = *self.course.restore(rest) {
            (self.force, self.greatest) = ([x, y, z], greatest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_push_is_the_slope_of_what_it_stores() {
        let law = Repulsion {
            strength: 25.0,
            range: 1e-3,
            exponents: [4.0, 2.0],
        };
        for s in [2e-5, 3e-4, 7e-4, 9.9e-4] {
            let slope = (law.energy(s - 1e-9) - law.energy(s + 1e-9)) / 2e-9;
            assert!((slope / law.push(s) - 1.0).abs() < 1e-4, "{s}: {slope}");
        }
        assert!(law.push(1e-3).abs() + law.energy(1.1e-3).abs() <= 0.0);
    }
}
