//! Grains on their way: what a step of velocity Verlet does to them.

use contact::Grain;
use particles::{POSITION, Set, sweep};
use rayon::prelude::*;
use run::property::{Curve, OutOfRange};
use shapes::frame::{Vector, difference, dot};

use super::depth::{CELL, asleep};
use super::glued::{Glued, Grains};
use super::gone::Gone;
use super::greater::greater;
use super::lists::{AT_ONCE, ROWS};
use super::verlet::{Lead, Verlet};
use super::walls::velocity;
use super::{DRIVEN, FORCE, LISTED, MASS, MOMENT, RADIUS, SPIN, TURNED, VELOCITY, WATCHED};

/// Rows, within a chunk of so many, of each of its cells that is awake by `depth`.
#[inline(always)]
fn awake(depth: &[u8], chunk: usize, rows: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    let cells = (0..rows).step_by(CELL);
    let cells = cells.filter(move |row| !asleep(depth, chunk * ROWS + row));
    cells.map(move |row| row..rows.min(row + CELL))
}

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
    /// Where they were when sleep was last asked for \[m\], and their turning since \[rad\]; empty where none sleeps.
    pub(super) watched: [Vec<Vector>; 2],
    /// Forces and moments of the step before.
    before: [Vec<Vector>; 2],
    /// How much of the step velocities have been led on, by rows.
    leads: Vec<f64>,
    driven: Vec<Driven>,
    pub(super) glued: Glued,
    drives: Vec<Option<[Curve; 3]>>,
    pub(super) gravity: Vector,
    /// I / (m r^2).
    pub(super) inertia_factor: f64,
    /// Depth of sleep by cells when the columns were last put back; none where they are to be taken anew.
    slept: Option<Vec<u8>>,
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

    /// Takes the columns that move; those that have been put back only have not changed since.
    pub fn take(&mut self, set: &mut Set) {
        if self.slept.is_none() {
            self.copy(set);
        }
        if set.has(&WATCHED) {
            self.watched = [set.take(&WATCHED), set.take(&TURNED)];
        }
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
        self.glued.take(set, &self.grains, self.inertia_factor);
        self.force = set.take(&FORCE);
        self.moment = set.take(&MOMENT);
        self.listed = set.take(&LISTED);
    }

    /// Grains as the columns have them.
    fn copy(&mut self, set: &Set) {
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
    }

    /// Whether no grain is free.
    #[must_use]
    pub fn all_driven(&self) -> bool {
        !self.grains.is_empty() && self.driven.len() == self.grains.len()
    }

    /// Puts the columns back, where cells sleep by `depth`: what has slept since they were last put back stays.
    pub fn put(&mut self, set: &mut Set, depth: &[u8]) {
        let mut slept = self.slept.take().unwrap_or_default();
        for cell in 0..self.grains.len().div_ceil(CELL) {
            let row = cell * CELL;
            if !(asleep(&slept, row) && asleep(depth, row)) {
                self.write(set, self.cell(cell));
            }
        }
        self.put_forces(set);
        slept.clear();
        slept.extend_from_slice(depth);
        self.slept = Some(slept);
    }

    /// Puts all columns back, for rows that are to be put in order or to leave.
    pub fn put_all(&mut self, set: &mut Set) {
        self.write(set, 0..self.grains.len());
        self.put_forces(set);
        self.slept = None;
    }

    fn write(&self, set: &mut Set, rows: std::ops::Range<usize>) {
        let (grains, from) = (&self.grains[rows.clone()], rows);
        let value = |of: fn(&Grain) -> Vector| move |a: usize| of(&grains[a]);
        sweep::fill(
            &mut set.column_mut(&POSITION)[from.clone()],
            value(|g| g.position),
        );
        sweep::fill(
            &mut set.column_mut(&VELOCITY)[from.clone()],
            value(|g| g.velocity),
        );
        sweep::fill(&mut set.column_mut(&SPIN)[from], value(|g| g.spin));
    }

    fn put_forces(&mut self, set: &mut Set) {
        set.put(&FORCE, std::mem::take(&mut self.force));
        set.put(&MOMENT, std::mem::take(&mut self.moment));
        set.put(&LISTED, std::mem::take(&mut self.listed));
        if set.has(&WATCHED) {
            let [watched, turned] = std::mem::take(&mut self.watched);
            set.put(&WATCHED, watched);
            set.put(&TURNED, turned);
        }
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

    /// x += dt u + dt^2/2 a, u += dt a, or as much of that as `lead` says for the rows from a first one on. Gives how far grains
    /// have gone.
    ///
    /// What sleeps by `depth` stands still.
    pub fn predict(&mut self, step: f64, depth: &[u8], lead: impl Lead) -> Gone {
        let verlet = self.verlet(step);
        self.leads.resize(self.grains.len(), 1.0);
        for driven in &mut self.driven {
            driven.from = self.grains[driven.row].position;
        }
        let forces = self
            .force
            .par_chunks(ROWS)
            .zip(self.moment.par_chunks(ROWS));
        let places = (self.leads.par_chunks_mut(ROWS)).zip(self.listed.par_chunks(ROWS));
        let far = self.grains.par_chunks_mut(ROWS).zip(forces).zip(places);
        let far = far.enumerate().with_max_len(AT_ONCE);
        let far = far.map(|(chunk, ((grains, (force, moment)), (leads, listed)))| {
            let mut gone = Gone::default();
            for cell in awake(depth, chunk, grains.len()) {
                lead(chunk * ROWS + cell.start, &mut leads[cell.clone()]);
                let forces = force[cell.clone()].iter().zip(&moment[cell.clone()]);
                let each = grains[cell.clone()].iter_mut().zip(&leads[cell.clone()]);
                for (((grain, lead), (force, moment)), listed) in
                    each.zip(forces).zip(&listed[cell])
                {
                    let square = verlet.predict(grain, [force, moment], *lead);
                    gone.note(grain, listed, square);
                }
            }
            gone
        });
        far.reduce(Gone::default, Gone::farther).rooted()
    }

    /// Keeps the forces of the step before; new ones take their place.
    pub fn turn(&mut self) {
        let [force, moment] = &mut self.before;
        std::mem::swap(force, &mut self.force);
        std::mem::swap(moment, &mut self.moment);
    }

    /// u += dt/2 (a' - a), or dt/2 a', but for what sleeps by `depth`. Where a step of `next` \[s\] follows, its prediction is made at once, for
    /// grains are then in fast memory. Gives the greatest speed \[m/s\], no number where one is none, and how far grains have gone
    /// where the next step was predicted.
    pub fn correct(
        &mut self,
        step: f64,
        next: Option<f64>,
        depth: &[u8],
        lead: impl Lead,
    ) -> (f64, Gone) {
        let verlet = self.verlet(step);
        let following = next.map(|next| self.verlet(next));
        let forces = self
            .force
            .par_chunks(ROWS)
            .zip(self.moment.par_chunks(ROWS));
        let [before, turned] = &self.before;
        let old = before.par_chunks(ROWS).zip(turned.par_chunks(ROWS));
        let places = (self.leads.par_chunks_mut(ROWS)).zip(self.listed.par_chunks(ROWS));
        let rest = forces.zip(old).zip(places);
        let most = self.grains.par_chunks_mut(ROWS).zip(rest).enumerate();
        let most = most.with_max_len(AT_ONCE);
        let most = most.map(|(chunk, (grains, ((forces, old), (leads, listed))))| {
            let (mut fastest, mut gone) = (0.0, Gone::default());
            for cell in awake(depth, chunk, grains.len()) {
                let grains = &mut grains[cell.clone()];
                let (leads, listed) = (&mut leads[cell.clone()], &listed[cell.clone()]);
                let now = [&forces.0[cell.clone()], &forces.1[cell.clone()]];
                let before = [&old.0[cell.clone()], &old.1[cell.clone()]];
                for (k, (grain, lead)) in grains.iter_mut().zip(&*leads).enumerate() {
                    let forces = [now, before].map(|[force, moment]| [&force[k], &moment[k]]);
                    verlet.correct(grain, forces[0], forces[1], *lead);
                    fastest = greater(fastest, dot(grain.velocity, grain.velocity));
                }
                if let Some(following) = &following {
                    lead(chunk * ROWS + cell.start, leads);
                    for (k, (grain, lead)) in grains.iter_mut().zip(&*leads).enumerate() {
                        let square = following.predict(grain, now.map(|forces| &forces[k]), *lead);
                        gone.note(grain, &listed[k], square);
                    }
                }
            }
            (fastest, gone)
        });
        let greatest = |a: (f64, Gone), b: (f64, Gone)| (greater(a.0, b.0), a.1.farther(b.1));
        let (fastest, gone) = most.reduce(Default::default, greatest);
        for driven in &self.driven {
            let grain = &mut self.grains[driven.row];
            (grain.velocity, grain.spin) = (driven.velocity[1], [0.0; 3]);
        }
        let (glued, mut all) = self.glued();
        glued.correct(&mut all, step);
        let fastest = if self.drives() {
            self.fastest()
        } else {
            fastest.sqrt()
        };
        (fastest, gone.rooted())
    }

    /// Whether grains are driven or glued.
    #[must_use]
    pub fn drives(&self) -> bool {
        !(self.driven.is_empty() && self.glued.is_empty())
    }

    /// Bodies of glued grains, and what they move.
    fn glued(&mut self) -> (&mut Glued, Grains<'_>) {
        let all = Grains {
            grains: &mut self.grains,
            force: &self.force,
            moment: &self.moment,
            listed: &self.listed,
        };
        (&mut self.glued, all)
    }

    fn verlet(&self, step: f64) -> Verlet {
        Verlet {
            step,
            gravity: self.gravity,
            inertia_factor: self.inertia_factor,
        }
    }

    /// Moves the grains that are held to a velocity or glued. Gives the farthest way of these since neighbours were listed \[m\].
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
        let gravity = self.gravity;
        let (glued, mut all) = self.glued();
        Ok(greater(far.sqrt(), glued.predict(&mut all, step, gravity)))
    }

    /// Rows of a cell.
    #[must_use]
    pub fn cell(&self, cell: usize) -> std::ops::Range<usize> {
        cell * CELL..(cell * CELL + CELL).min(self.grains.len())
    }

    /// Keeps the forces of a cell as they are for as long as nobody reckons them.
    pub fn hold(&mut self, cell: usize) {
        let rows = self.cell(cell);
        for (old, now) in self.before.iter_mut().zip([&self.force, &self.moment]) {
            old.resize(now.len(), [0.0; 3]);
            old[rows.clone()].copy_from_slice(&now[rows.clone()]);
        }
    }

    /// Rows that are held to a velocity that is not zero, and those that are glued.
    pub fn stirred(&self, rows: &mut Vec<u32>) {
        let moves = |driven: &&Driven| driven.velocity[1].iter().any(|u| u.abs() > 0.0);
        let driven = self.driven.iter().filter(moves);
        rows.extend(driven.map(|driven| driven.row as u32));
        rows.extend(self.glued.rows().map(|row| row as u32));
    }

    /// The greatest speed \[m/s\]; no number where one is none.
    fn fastest(&self) -> f64 {
        let squares = self.grains.iter().map(|g| dot(g.velocity, g.velocity));
        squares.fold(0.0, greater).sqrt()
    }
}
