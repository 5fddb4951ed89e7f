//! Sleep: what rests is not moved, and deep within it nothing is reckoned.
//!
//! [`CELL`] rows make a cell, some two grains along each side; cells are neighbours where they share a pair. A cell is quiet
//! where its grains, or their surfaces by their turning, have gone no farther within the time T than at the speed v, in the mean, and
//! none of them b times as far:
//!
//! ```text
//! d_a = max(|x(t) - x(t - T)|, r |integral of w dt|)         sum d_a < N v T,   d_a < b v T
//! ```
//!
//! So grains that tremble where they lie are quiet: sound of what moves goes through all of a bed, and shakes grains by less than a
//! thousandth of their diameter. With b above 1 so are the few that rattle in a cage of others, which bear nothing; what hits a
//! sleeping bed then wakes it a little later.
//!
//! A quiet cell whose neighbours are quiet falls asleep: a ring of quiet cells stays awake around what moves. Its grains stand still,
//! and the energy that they had is told. Cells that sleep beside others that are awake still feel them, and are put to the test: each
//! wakes after ten T for as long as it takes to see whether it goes on sleeping. What has grown around it by then pushes it as
//! if it had never slept, for the springs across its contacts are kept. Cells wake at once beside what moves, where a grain
//! melts or sets, and beside a wall that moves, is fed or presses. A bed that was handed on at rest sleeps from the start.

use particles::Set;

use super::Motion;
use super::columns::STATE;
use super::depth::{AWAKE, BORDER, CELL, DEEP, EDGE};
use super::lists::Lists;
use super::moving::Moving;
use super::parameters::SleepScene;

/// What sleeps beside others that are awake is put to the test after so many times T.
const LONG: f64 = 10.0;

/// Which cells sleep, and how deeply.
#[derive(Debug, Clone)]
pub struct Sleep {
    scene: SleepScene,
    depth: Vec<u8>,
    /// How long each cell has been quiet, and been looked at \[s\].
    quiet: Vec<f64>,
    age: Vec<f64>,
    /// Cells that share a pair.
    neighbours: Vec<[u32; 2]>,
    /// Kinetic energy that was taken from grains that fell asleep \[J\].
    pub taken: f64,
    /// Grains times steps, and those of them that were moved.
    pub shares: [f64; 2],
}

impl Sleep {
    /// All awake.
    #[must_use]
    pub fn new(scene: SleepScene) -> Self {
        Self {
            scene,
            depth: Vec::new(),
            quiet: Vec::new(),
            age: Vec::new(),
            neighbours: Vec::new(),
            taken: 0.0,
            shares: [0.0; 2],
        }
    }

    /// Depth of sleep by cells; empty where all are awake.
    #[must_use]
    pub fn depth(&self) -> &[u8] {
        &self.depth
    }

    /// Finds which cells share a pair.
    pub fn list(&mut self, lists: &Lists, rows: usize) {
        self.neighbours.clear();
        for chunk in &lists.chunks {
            self.neighbours.extend_from_slice(&chunk.cells);
        }
        self.neighbours.dedup();
        self.quiet.resize(rows.div_ceil(CELL), 0.0);
        self.age.resize(rows.div_ceil(CELL), 0.0);
    }

    /// Takes all cells for quiet, as they were when they were handed on, and watches them from where they are.
    pub fn lie(&mut self, moving: &mut Moving) {
        let cells = moving.grains.len().div_ceil(CELL);
        self.quiet = vec![self.scene.held_s; cells];
        (0..cells).for_each(|cell| moving.look_again(cell));
    }

    /// Follows rows to their new places: `rows` has that of each old row, none where a grain leaves.
    pub fn renumber(&mut self, rows: &[Option<u32>]) {
        let left = rows.iter().flatten().count();
        let mut quiet = vec![f64::INFINITY; left.div_ceil(CELL)];
        let mut depth = vec![BORDER; quiet.len()];
        let mut age = vec![0.0_f64; quiet.len()];
        for (old, new) in rows.iter().enumerate() {
            let Some(new) = new else { continue };
            let cell = *new as usize / CELL;
            age[cell] = age[cell].max(self.age.get(old / CELL).copied().unwrap_or(0.0));
            quiet[cell] = quiet[cell].min(self.quiet.get(old / CELL).copied().unwrap_or(0.0));
            depth[cell] = depth[cell].min(self.depth.get(old / CELL).copied().unwrap_or(AWAKE));
        }
        // How deeply they sleep is found anew; until then all that sleep feel the others.
        (self.quiet, self.depth, self.age) = (quiet, depth, age);
        self.simplify();
    }

    /// An empty list where all are awake.
    fn simplify(&mut self) {
        if self.depth.iter().all(|depth| *depth == AWAKE) {
            self.depth.clear();
        }
    }

    /// Tells how long a cell has been quiet after `dt` \[s\]; who has slept long beside others that are awake is put to the test.
    fn look(&mut self, cell: usize, moving: &mut Moving, dt: f64) {
        let (v, held) = (self.scene.speed_m_s, self.scene.held_s);
        let age = self.age[cell] + dt;
        let (still, done) = match self.depth[cell] {
            AWAKE => {
                let (way, most) = (moving.way(cell, dt), v * held);
                // What is no number is not still.
                let still = way.mean < most && way.greatest < self.scene.rattle * most;
                (still, age >= held)
            }
            BORDER => (true, age >= LONG * held),
            _ => (true, false),
        };
        self.quiet[cell] = match (still, done && self.depth[cell] == BORDER) {
            (false, _) => 0.0,
            // Quiet but for a while: those beside it sleep on.
            (true, true) => dt.min(0.5 * held),
            (true, false) => self.quiet[cell] + dt,
        };
        self.age[cell] = age;
        if done || !still {
            self.age[cell] = 0.0;
            moving.look_again(cell);
        }
    }

    /// Puts cells to sleep and wakes them after `dt` \[s\]; `stirred` are rows that may not sleep.
    pub fn turn(&mut self, moving: &mut Moving, stirred: &[u32], dt: f64) {
        let cells = moving.grains.len().div_ceil(CELL);
        self.depth.resize(cells, AWAKE);
        self.quiet.resize(cells, 0.0);
        self.age.resize(cells, 0.0);
        for cell in 0..cells {
            self.look(cell, moving, dt);
        }
        stirred.iter().for_each(|row| self.stir(*row as usize));
        // One pass each, so that nothing hangs on the order of cells.
        let rests: Vec<bool> = self.quiet.iter().map(|q| *q >= self.scene.held_s).collect();
        let mut asleep = rests.clone();
        self.meet(|cell, other| {
            // What has slept goes on sleeping beside what is quiet but for a while.
            let calm = rests[other] || (self.depth[cell] > AWAKE && self.quiet[other] > 0.0);
            asleep[cell] &= calm;
        });
        let mut depth: Vec<u8> = asleep
            .iter()
            .map(|asleep| if *asleep { DEEP } else { AWAKE })
            .collect();
        for (nearer, own) in [(AWAKE, BORDER), (BORDER, EDGE)] {
            let before = depth.clone();
            self.meet(|cell, other| {
                if before[cell] == DEEP && before[other] == nearer {
                    depth[cell] = own;
                }
            });
        }
        for (cell, (new, old)) in depth.iter().zip(&self.depth).enumerate() {
            if *new > AWAKE && *old == AWAKE {
                self.taken += moving.stop(cell);
            }
            if (*new == BORDER) != (*old == BORDER) || (*new == AWAKE) != (*old == AWAKE) {
                self.age[cell] = 0.0;
                moving.look_again(cell);
            }
            if *new >= EDGE && *old < EDGE {
                moving.hold(cell);
            }
        }
        self.depth = depth;
        self.simplify();
    }

    /// Calls `meet` with each cell and each of its neighbours.
    fn meet(&self, mut meet: impl FnMut(usize, usize)) {
        for [a, b] in &self.neighbours {
            let (a, b) = (*a as usize, *b as usize);
            meet(a, b);
            meet(b, a);
        }
    }

    /// Grains that sleep among `rows`.
    #[must_use]
    pub fn sleeping(&self, rows: usize) -> usize {
        let cells = self.depth.iter().enumerate();
        let asleep = cells.filter(|(_, depth)| **depth > AWAKE);
        asleep.map(|(cell, _)| CELL.min(rows - cell * CELL)).sum()
    }

    /// Counts a step of `rows` grains.
    pub fn count(&mut self, rows: usize) {
        self.shares[0] += rows as f64;
        self.shares[1] += (rows - self.sleeping(rows)) as f64;
    }

    /// Wakes the cell of a row.
    pub fn stir(&mut self, row: usize) {
        if let Some(quiet) = self.quiet.get_mut(row / CELL) {
            *quiet = 0.0;
        }
    }

    /// Numbers of a checkpoint with so many rows.
    #[must_use]
    pub fn numbers(rows: usize) -> usize {
        3 + 3 * rows.div_ceil(CELL)
    }

    /// As numbers for a checkpoint.
    #[must_use]
    pub fn save(&self, rows: usize) -> Vec<f64> {
        let mut saved = vec![self.taken, self.shares[0], self.shares[1]];
        let cells = rows.div_ceil(CELL);
        for times in [&self.quiet, &self.age] {
            saved.extend((0..cells).map(|cell| times.get(cell).copied().unwrap_or(0.0)));
        }
        saved.extend((0..cells).map(|cell| self.depth.get(cell).copied().map_or(0.0, f64::from)));
        saved
    }

    /// Takes back what [`Sleep::save`] gave.
    pub fn restore(&mut self, saved: &[f64], moving: &mut Moving) {
        let Some(([taken, all, moved], rest)) = saved.split_first_chunk::<3>() else {
            return;
        };
        (self.taken, self.shares) = (*taken, [*all, *moved]);
        let (quiet, rest) = rest.split_at(rest.len() / 3);
        let (age, depth) = rest.split_at(rest.len() / 2);
        (self.quiet, self.age) = (quiet.to_vec(), age.to_vec());
        self.depth = depth.iter().map(|depth| *depth as u8).collect();
        let kept = (0..self.depth.len()).filter(|cell| self.depth[*cell] >= EDGE);
        kept.for_each(|cell| moving.hold(cell));
        self.simplify();
    }
}

/// Depth of sleep by cells.
pub(super) fn depth(sleep: &Option<Sleep>) -> &[u8] {
    sleep.as_ref().map_or(&[], Sleep::depth)
}

impl Motion {
    /// Puts to sleep what rests and wakes what is stirred, after `dt` \[s\].
    pub(super) fn turn_in(&mut self, dt: f64) {
        if let Some(sleep) = &mut self.sleep {
            self.walls.stirred(&mut self.stirred);
            self.moving.stirred(&mut self.stirred);
            if let Some(metal) = &self.metal {
                metal.stirred(&mut self.stirred);
            }
            sleep.turn(&mut self.moving, &self.stirred, dt);
            self.lists.rest(sleep.depth());
            self.walls.rest(sleep.depth());
            self.stirred.clear();
        }
    }

    /// Lets a bed that was handed on with all of its contacts go on sleeping, but where it is stirred.
    pub(super) fn lie(&mut self) {
        let whole = self.laid.as_ref().is_some_and(|laid| laid.whole);
        if let Some(sleep) = self.sleep.as_mut().filter(|_| whole) {
            sleep.lie(&mut self.moving);
        }
    }

    /// Wakes grains that have melted or set.
    pub(super) fn stir_changed(&mut self, set: &Set) {
        if let Some(sleep) = &mut self.sleep {
            let states = set.column(&STATE);
            for (row, (now, before)) in states.iter().zip(&self.states).enumerate() {
                if now != before {
                    sleep.stir(row);
                }
            }
        }
    }
}
