//! What water without sound owes to a solid.
//!
//! Water takes the impulse J of its pressure at once; the solid gets it by a force F in the next step. What it got by the trapezoids of the march and what it will still get by the force that acts now
//! is kept account of, cell by cell,
//!
//! ```text
//! owed -= dt/2 (F_before + F_now)                  each step of the march
//! F     = J/dt + owed/dt - F_now/2                 at each pressure;   owed += J
//! ```
//!
//! so that steps of any length give the solid what the water has lost. With F go its moments, as
//! [`crate::matter::meeting::faces`] has them.

use particles::Set;

use crate::matter::meeting::faces::{
    BEND, BEND_RATE, DEFORMATION_RATE, PULL, TWIST, Taken, WARP, WARP_RATE,
};
use crate::state::VELOCITY;

/// Force on a cell \[N\] and its moments, by rows of first, second and mixed derivatives.
type Charge = [[f64; 3]; 10];

const NONE: Charge = [[0.0; 3]; 10];

/// What a solid is owed.
#[derive(Debug, Clone, Default)]
pub(super) struct Ledger {
    /// Cells that ever were.
    cells: Vec<u32>,
    /// Of each of these: what it is owed \[N s\], and the force before and now \[N\].
    accounts: Vec<[Charge; 3]>,
    /// Whether the columns of the solid lack the forces, after a checkpoint was taken up.
    is_new: bool,
}

/// What a solid has got in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Got {
    /// \[N s\].
    pub(super) impulse: [f64; 3],
    /// \[J\].
    pub(super) work: f64,
}

fn add(charge: &mut Charge, scale: f64, other: &Charge) {
    for (sum, part) in charge.iter_mut().zip(other) {
        (0..3).for_each(|k| sum[k] += scale * part[k]);
    }
}

/// The forces in the columns of a solid.
fn read(set: &Set, cell: usize) -> Charge {
    let mut charge = NONE;
    charge[0] = set.column(&PULL)[cell];
    for (k, column) in [&TWIST, &BEND, &WARP].into_iter().enumerate() {
        charge[3 * k + 1..3 * k + 4].copy_from_slice(&set.column(column)[cell]);
    }
    charge
}

fn write(set: &mut Set, cell: usize, charge: &Charge) {
    set.column_mut(&PULL)[cell] = charge[0];
    for (k, column) in [&TWIST, &BEND, &WARP].into_iter().enumerate() {
        set.column_mut(column)[cell].copy_from_slice(&charge[3 * k + 1..3 * k + 4]);
    }
}

/// How a cell moves, by what its forces are multiplied by.
fn motion(set: &Set, cell: usize) -> Charge {
    let mut motion = NONE;
    motion[0] = set.column(&VELOCITY)[cell];
    for (k, column) in [&DEFORMATION_RATE, &BEND_RATE, &WARP_RATE]
        .into_iter()
        .enumerate()
    {
        motion[3 * k + 1..3 * k + 4].copy_from_slice(&set.column(column)[cell]);
    }
    motion
}

impl Ledger {
    /// Puts the forces into the columns where a checkpoint was taken up.
    pub(super) fn look(&mut self, set: &mut Set) {
        if std::mem::take(&mut self.is_new) {
            for (cell, [_, _, now]) in self.cells.iter().zip(&self.accounts) {
                write(set, *cell as usize, now);
            }
        }
    }

    /// Counts a step of `dt` \[s\] of the march.
    pub(super) fn march(&mut self, set: &Set, dt: f64) -> Got {
        let mut got = Got::default();
        for (cell, [owed, before, now]) in self.cells.iter().zip(&mut self.accounts) {
            let mut both = *before;
            add(&mut both, 1.0, now);
            add(owed, -0.5 * dt, &both);
            *before = *now;
            let motion = motion(set, *cell as usize);
            let products = both.as_flattened().iter().zip(motion.as_flattened());
            got.work += 0.5 * dt * products.map(|(f, u)| f * u).sum::<f64>();
            (0..3).for_each(|k| got.impulse[k] += 0.5 * dt * both[0][k]);
        }
        got
    }

    /// Takes new forces \[N\] up, which have given their impulse to the water over a step of `dt` \[s\], and adds what is owed beyond
    /// what the present ones will still give.
    pub(super) fn renew(&mut self, set: &mut Set, taken: Taken, dt: f64) {
        taken.end(set);
        let pressed = set.column(&PULL).iter().enumerate();
        let pressed = pressed.filter(|(_, pull)| pull.iter().any(|f| f.abs() > 0.0));
        let found: Vec<u32> = pressed.map(|(cell, _)| cell as u32).collect();
        for cell in found {
            if let Err(place) = self.cells.binary_search(&cell) {
                self.cells.insert(place, cell);
                self.accounts.insert(place, [NONE; 3]);
            }
        }
        for (cell, [owed, _, now]) in self.cells.iter().zip(&mut self.accounts) {
            let pressed = read(set, *cell as usize);
            let mut force = pressed;
            add(&mut force, 1.0 / dt, owed);
            add(&mut force, -0.5, now);
            add(owed, dt, &pressed);
            *now = force;
            write(set, *cell as usize, now);
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        (4 + size_of::<[Charge; 3]>()) * self.cells.capacity()
    }

    /// What a checkpoint keeps.
    pub(super) fn save(&self, saved: &mut Vec<f64>) {
        saved.push(self.cells.len() as f64);
        for (cell, account) in self.cells.iter().zip(&self.accounts) {
            saved.push(f64::from(*cell));
            saved.extend(account.as_flattened().as_flattened());
        }
    }

    /// Takes it back; gives the rest.
    pub(super) fn restore<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        let Some((count, mut rest)) = saved.split_first() else {
            return saved;
        };
        (self.cells, self.accounts) = Default::default();
        for _ in 0..*count as usize {
            let Some(([cell, numbers @ ..], left)) = rest.split_first_chunk::<91>() else {
                return rest;
            };
            let mut account = [NONE; 3];
            account
                .as_flattened_mut()
                .as_flattened_mut()
                .copy_from_slice(numbers);
            self.cells.push(*cell as u32);
            self.accounts.push(account);
            rest = left;
        }
        self.is_new = true;
        rest
    }
}
