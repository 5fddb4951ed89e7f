//! Mass, momentum and energy of all particles, and whether they close.

use artefact::Record;
use particles::sweep;

use crate::march::March;
use crate::stage::Entry;
use crate::state::{MASS, State, VELOCITY};

/// An energy balance that closes to this part is good.
const CLOSES: f64 = 0.02;

/// Conserved totals at one time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// Mass \[kg\].
    pub mass: f64,
    /// Momentum \[N s\].
    pub momentum: [f64; 3],
    /// Kinetic energy \[J\].
    pub kinetic: f64,
    /// What the stages store, have put in and have spent.
    pub entry: Entry,
}

impl Balance {
    /// The totals of a state.
    #[must_use]
    pub fn of(state: &State, march: &March) -> Self {
        let mut balance = Self::default();
        for set in &state.sets {
            let (mass, velocity) = (set.column(&MASS), set.column(&VELOCITY));
            let [m, x, y, z, kinetic] = sweep::sum(set.len(), |a| {
                let (m, [x, y, z]) = (mass[a], velocity[a]);
                [m, m * x, m * y, m * z, 0.5 * m * (x * x + y * y + z * z)]
            });
            balance.mass += m;
            balance.kinetic += kinetic;
            for (sum, part) in balance.momentum.iter_mut().zip([x, y, z]) {
                *sum += part;
            }
        }
        for stage in &march.stages {
            let entry = stage.entry(state);
            balance.entry.add(&entry);
        }
        balance
    }

    /// Energy that neither the start nor work from outside explains, over the greatest kinetic energy or the like \[1\].
    #[must_use]
    pub fn energy_error(&self, start: &Self) -> f64 {
        let there = self.kinetic + self.entry.stored + self.entry.spent;
        let given = start.kinetic + start.entry.stored + self.entry.work;
        let stored = (self.entry.stored - start.entry.stored).abs();
        let scale = start
            .kinetic
            .max(self.kinetic)
            .max(stored)
            .max(self.entry.work.abs());
        if scale > 0.0 {
            (there - given) / scale
        } else {
            0.0
        }
    }

    /// Mass that neither the start nor what came in and left explains, over all of it \[1\].
    #[must_use]
    pub fn mass_error(&self, start: &Self) -> f64 {
        let there = self.mass.max(start.mass).max(f64::MIN_POSITIVE);
        (self.mass - start.mass - self.entry.mass) / there
    }

    /// Momentum that neither the start nor an impulse from outside explains, over the greatest momentum that the
    /// kinetic energy can stand for \[1\].
    #[must_use]
    pub fn momentum_error(&self, start: &Self) -> f64 {
        let missing = (0..3).map(|k| self.momentum[k] - start.momentum[k] - self.entry.impulse[k]);
        let missing = missing.map(|m| m * m).sum::<f64>().sqrt();
        let scale = (2.0 * self.mass * self.kinetic.max(start.kinetic)).sqrt();
        if scale > 0.0 { missing / scale } else { 0.0 }
    }

    /// The totals as written to `/balance`.
    #[must_use]
    pub fn record(&self, time: f64, start: &Self) -> Record {
        let [x, y, z] = self.momentum;
        Record::new()
            .with("time_s", "s", time)
            .with("mass_kg", "kg", self.mass)
            .with("momentum_x", "kg m/s", x)
            .with("momentum_y", "kg m/s", y)
            .with("momentum_z", "kg m/s", z)
            .with("kinetic_energy_j", "J", self.kinetic)
            .with(
                "stored_energy_j",
                "J",
                self.entry.stored - start.entry.stored,
            )
            .with("work_j", "J", self.entry.work)
            .with("spent_energy_j", "J", self.entry.spent)
            .with("energy_error", "1", self.energy_error(start))
            .with("momentum_error", "1", self.momentum_error(start))
    }

    /// Name, unit, value of the closing block.
    #[must_use]
    pub fn closing(&self, start: &Self) -> [(&'static str, &'static str, f64); 8] {
        [
            ("mass_kg", "kg", self.mass),
            ("mass_error", "1", self.mass_error(start)),
            ("momentum_error", "1", self.momentum_error(start)),
            ("kinetic_energy_j", "J", self.kinetic),
            (
                "stored_energy_j",
                "J",
                self.entry.stored - start.entry.stored,
            ),
            ("work_j", "J", self.entry.work),
            ("spent_energy_j", "J", self.entry.spent),
            ("energy_error", "1", self.energy_error(start)),
        ]
    }

    /// What to warn of where energy does not close.
    #[must_use]
    pub fn unclosed(&self, start: &Self) -> Option<String> {
        let error = self.energy_error(start);
        // An error that is no number closes nothing.
        let closes = error.abs() <= CLOSES;
        (!closes).then(|| {
            format!(
                "energy is off by {error:.1e} of what moves or is stored; at most {CLOSES} is good"
            )
        })
    }

    /// Numbers that a checkpoint keeps.
    #[must_use]
    pub fn save(&self) -> Vec<f64> {
        let Entry {
            stored,
            work,
            spent,
            impulse,
            mass: brought,
        } = self.entry;
        let mut saved = vec![self.mass, self.kinetic, stored, work, spent, brought];
        saved.extend(self.momentum);
        saved.extend(impulse);
        saved
    }

    /// Takes back what [`Balance::save`] gave.
    #[must_use]
    pub fn restored(saved: &[f64]) -> Self {
        match *saved {
            [
                mass,
                kinetic,
                stored,
                work,
                spent,
                brought,
                mx,
                my,
                mz,
                ix,
                iy,
                iz,
            ] => Self {
                mass,
                kinetic,
                momentum: [mx, my, mz],
                entry: Entry {
                    stored,
                    work,
                    spent,
                    impulse: [ix, iy, iz],
                    mass: brought,
                },
            },
            _ => Self::default(),
        }
    }
}
