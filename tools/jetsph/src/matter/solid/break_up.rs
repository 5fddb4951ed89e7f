//! An elastic solid that breaks: the part of its stage that only fracture needs.

use particles::{POSITION, Set, sweep};
use rayon::prelude::*;

use super::breaking::Breaking;
use super::cell::gradient;
use super::elastic::Elastic;
use super::fracture::{BROKEN, Criterion};
use super::nonlocal::Boxes;
use super::stiffness::stiffness;
use super::tensor::{UNIT, determinant, transposed_times};
use super::trial::Trial;
use crate::matter::meeting::faces::PRESSED;
use crate::matter::meeting::skin::DEFORMATION;
use crate::stage::Figure;
use crate::state::{ACCELERATION, MASS, State};

/// Part of the energy that sums may gain by rounding.
const ROUNDING: f64 = 1e-12;
/// A broken cell keeps its shape for the water, if it has at least this part of its volume and at most its inverse.
const SHAPE: f64 = 0.5;

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Nothing holds what is broken.
    pub(super) fn let_go(&mut self) {
        if let Some(breaking) = &self.breaking {
            for a in &breaking.list {
                self.answers[*a] = [[0.0; L]; T];
                self.stiffer[*a] = 1.0;
            }
        }
    }

    /// Energy of the cells that are whole \[J\].
    pub(super) fn stored(&self) -> f64 {
        sweep::sum(self.answers.len(), |a| [self.stored_in(a)])[0]
    }

    /// Energy of a cell if it is whole \[J\]; one that is turned inside out has none that can be told.
    fn stored_in(&self, a: usize) -> f64 {
        if !self.is_whole(a) {
            return 0.0;
        }
        let energy = self.cell_energy(a);
        if energy.is_finite() || self.breaking.is_none() {
            energy
        } else {
            0.0
        }
    }

    /// Cells that a step turned inside out: nothing can be reckoned with them.
    fn inside_out(&self) -> Vec<usize> {
        let Some(breaking) = &self.breaking else {
            return Vec::new();
        };
        let all = (0..breaking.broken.len()).into_par_iter().with_min_len(32);
        let is_one = |a: &usize| {
            let volume = determinant(&gradient(&self.derivatives(*a)));
            !breaking.broken[*a] && (volume.is_nan() || volume <= 0.0)
        };
        all.filter(is_one).collect()
    }

    /// Those that the criterion breaks.
    fn due(&mut self, set: &Set) -> Vec<usize> {
        let Some(mut breaking) = self.breaking.take() else {
            return Vec::new();
        };
        let mut due = match &breaking.boxes {
            Some(boxes) => self.due_over(&breaking, boxes),
            None => self.due_alone(&breaking),
        };
        if let Criterion::Energy(limit) = breaking.criterion {
            let (acceleration, mass) = (set.column(&ACCELERATION), set.column(&MASS));
            let pushed = |a: usize| acceleration[a].map(|x| mass[a] * x);
            due.extend(self.released(&mut breaking, limit, pushed));
            due.sort_unstable();
            due.dedup();
        }
        self.breaking = Some(breaking);
        due
    }

    /// Those that break by what their own cell bears.
    fn due_alone(&self, breaking: &Breaking<T>) -> Vec<usize> {
        let law = self.body.cell.law;
        let is_due = |a: &usize| {
            let deformation = law.completed(gradient(&self.derivatives(*a)));
            !breaking.broken[*a] && breaking.criterion.breaks(&law, &deformation)
        };
        let all = (0..breaking.broken.len()).into_par_iter().with_min_len(32);
        all.filter(is_due).collect()
    }

    /// Those that break by what the boxes around them bear.
    fn due_over(&self, breaking: &Breaking<T>, boxes: &Boxes) -> Vec<usize> {
        let law = self.body.cell.law;
        let mut squares = vec![UNIT; breaking.broken.len()];
        sweep::fill(&mut squares, |a| {
            if breaking.broken[a] {
                return UNIT;
            }
            let deformation = law.completed(gradient(&self.derivatives(a)));
            transposed_times(&deformation, &deformation)
        });
        let share = |a: usize| self.body.share(a);
        boxes.due(&breaking.criterion, &law, &breaking.broken, &squares, share)
    }

    /// Breaks some particles and what they held, and books the energy that goes with their links.
    fn break_all(&mut self, mut fresh: Vec<usize>, set: &mut Set, time: f64) {
        if let Some(breaking) = self.breaking.as_mut().filter(|b| b.first[0].is_nan()) {
            let place = set.column(&POSITION);
            let mean =
                |k: usize| fresh.iter().map(|a| place[*a][k]).sum::<f64>() / fresh.len() as f64;
            breaking.first = [time, mean(0), mean(1), mean(2)];
        }
        let mut before = vec![0.0; self.answers.len()];
        sweep::fill(&mut before, |a| self.stored_in(a));
        let loads = self.load_potential(set.column(&POSITION), time);
        // What is left of a fit, from one side, can be turned inside out where the whole was not, or store more than all did.
        while !fresh.is_empty() {
            fresh = self.break_up(&fresh, set);
            if fresh.is_empty() {
                fresh = self.inside_out();
            }
            if fresh.is_empty() {
                fresh = self.torn(&before);
            }
        }
        let [freed] = sweep::sum(before.len(), |a| [before[a] - self.stored_in(a)]);
        let spent = freed + self.load_potential(set.column(&POSITION), time) - loads;
        self.entry.spent += spent;
        if let Some(breaking) = &mut self.breaking {
            breaking.energy += spent;
        }
    }

    /// Where a break would give energy, the cell that gains most: what is left around it tells nothing of its strain.
    fn torn(&self, before: &[f64]) -> Vec<usize> {
        let gain = |a: usize| self.stored_in(a) - before[a];
        let [gained, all] = sweep::sum(before.len(), |a| [gain(a), before[a]]);
        if gained <= ROUNDING * all {
            return Vec::new();
        }
        let of_whole = |a: usize| if self.is_whole(a) { gain(a) } else { 0.0 };
        let most = sweep::greatest(before.len(), of_whole).filter(|(_, gain)| *gain > 0.0);
        most.map(|(a, _)| a).into_iter().collect()
    }

    /// Breaks what a step has turned inside out, before its forces; tells whether anything broke.
    pub(super) fn breaks(&mut self, set: &mut Set, time: f64) -> bool {
        let fresh = self.inside_out();
        let any = !fresh.is_empty();
        if any {
            self.break_all(fresh, set, time);
        }
        any
    }

    /// Breaks what is due between two steps: the last one ends with the forces of the whole solid, the next begins with
    /// those of what is left, so that each step has one energy.
    pub(super) fn break_between(&mut self, state: &mut State, dt: f64) {
        let fresh = self.due(&state.sets[self.body.set]);
        if fresh.is_empty() {
            return;
        }
        // The time of the state is that of the begin of the step.
        let time = state.time + dt;
        let set = &mut state.sets[self.body.set];
        let mut acceleration = set.take(&ACCELERATION);
        let before = self.own_accelerations(set, time);
        self.break_all(fresh, set, time);
        self.answer(time);
        if !set.has(&PRESSED) {
            self.twisted(set);
        }
        let after = self.own_accelerations(set, time);
        sweep::change(&mut acceleration, |a, own| {
            (0..3).for_each(|k| own[k] += after[a][k] - before[a][k]);
        });
        set.put(&ACCELERATION, acceleration);
        self.hold_anew();
    }

    /// Accelerations by the cells and by the loads.
    fn own_accelerations(&self, set: &Set, time: f64) -> Vec<[f64; 3]> {
        let mass = set.column(&MASS);
        let mut all = vec![[0.0; 3]; mass.len()];
        self.accelerate(&mut all, mass);
        for load in &self.body.loads {
            let (a, force) = (load.particle, load.at(time));
            (0..3).for_each(|k| all[a][k] += force[k] / mass[a]);
        }
        all
    }

    /// Breaks particles and gives those that nothing holds any more.
    pub(super) fn break_up(&mut self, fresh: &[usize], set: &mut Set) -> Vec<usize> {
        let Some(mut breaking) = self.breaking.take() else {
            return Vec::new();
        };
        for a in fresh {
            breaking.broken[*a] = true;
            set.column_mut(&BROKEN)[*a] = 1;
            if let Some(shape) = set.column_mut(&DEFORMATION).get_mut(*a) {
                let volume = determinant(shape).abs();
                if !(SHAPE..=1.0 / SHAPE).contains(&volume) {
                    *shape = breaking.axes;
                }
            }
        }
        let loose = self.cut(&mut breaking, fresh);
        self.breaking = Some(breaking);
        loose
    }

    fn cut(&mut self, breaking: &mut Breaking<T>, fresh: &[usize]) -> Vec<usize> {
        breaking.forget(fresh);
        let broken = &breaking.broken;
        breaking.list = (0..broken.len()).filter(|a| broken[*a]).collect();
        let touched = breaking.cracks.touched(fresh, broken);
        let (cracks, size) = (&breaking.cracks, self.body.size);
        let loose = self.links.cut(cracks, size, broken, fresh, &touched);
        self.body.loads.retain(|load| !broken[load.particle]);
        let moment = self.body.cell.moment;
        for a in fresh.iter().chain(&touched) {
            breaking.stiffness.0[*a] = stiffness(self.links.row(*a).weight, moment);
        }
        let (now, rest) = &breaking.stiffness;
        let most = now.iter().fold(0.0, |most: f64, x| most.max(*x));
        self.raised = (most / rest).max(1.0);
        loose
    }

    /// What a checkpoint keeps of trials: their number, and of each the particle and what was reckoned.
    pub(super) fn saved_trials(&self) -> Vec<f64> {
        let trials = self.breaking.iter().flat_map(|breaking| &breaking.trials);
        let all: Vec<f64> = trials
            .flat_map(|(a, trial)| [*a as f64, trial.ratio, trial.asked])
            .collect();
        [&[(all.len() / 3) as f64], &all[..]].concat()
    }

    /// Takes trials up; gives the rest.
    pub(super) fn take_trials<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        let [count, rest @ ..] = saved else {
            return saved;
        };
        let (trials, rest) = rest.split_at(3 * *count as usize);
        if let Some(mut breaking) = self.breaking.take() {
            for of in trials.as_chunks::<3>().0 {
                let (a, size) = (of[0] as usize, self.body.size);
                let (cracks, broken) = (&breaking.cracks, &breaking.broken);
                let mut trial = Trial::new(cracks, a, broken, size);
                (trial.ratio, trial.asked) = (of[1], of[2]);
                breaking.trials.insert(a, trial);
            }
            self.breaking = Some(breaking);
        }
        rest
    }

    /// What a checkpoint keeps of cracks.
    pub(super) fn saved_cracks(&self) -> [f64; 6] {
        let Some(breaking) = &self.breaking else {
            return [0.0; 6];
        };
        let [time, x, y, z] = breaking.first;
        [breaking.energy, breaking.released, time, x, y, z]
    }

    /// Takes up what was broken when a checkpoint was written; gives the rest.
    pub(super) fn take_up<'a>(&mut self, flags: &[u8], saved: &'a [f64]) -> &'a [f64] {
        let [energy, released, time, x, y, z, rest @ ..] = saved else {
            return saved;
        };
        if let Some(mut breaking) = self.breaking.take() {
            (breaking.energy, breaking.released) = (*energy, *released);
            breaking.first = [*time, *x, *y, *z];
            breaking.broken = flags.iter().map(|flag| *flag > 0).collect();
            let fresh: Vec<usize> = (0..flags.len()).filter(|a| flags[*a] > 0).collect();
            let _ = self.cut(&mut breaking, &fresh);
            self.breaking = Some(breaking);
        }
        rest
    }

    /// When and where the solid first broke.
    pub(super) fn first_break(&self, state: &State) -> Vec<Figure> {
        let Some(first) = self.breaking.as_ref().map(|breaking| breaking.first) else {
            return Vec::new();
        };
        let name = state.sets[self.body.set].name();
        let each = [("s", "s"), ("x_m", "m"), ("y_m", "m"), ("z_m", "m")];
        let told = first
            .into_iter()
            .zip(each)
            .filter(|(value, _)| value.is_finite());
        told.map(|(value, (what, unit))| Figure {
            name: format!("{name}_first_break_{what}"),
            unit,
            value,
        })
        .collect()
    }

    /// Numbers of the cracks.
    pub(super) fn cracks(&self, state: &State) -> Vec<Figure> {
        let Some(breaking) = &self.breaking else {
            return Vec::new();
        };
        let set = &state.sets[self.body.set];
        let (name, mass) = (set.name(), set.column(&MASS));
        let debris: f64 = breaking.list.iter().map(|a| mass[*a]).sum();
        let figure = |what: &str, unit, value| Figure {
            name: format!("{name}_{what}"),
            unit,
            value,
        };
        vec![
            figure("fracture_energy", "J", breaking.energy),
            figure("released_energy", "J", breaking.released),
            figure("debris", "kg", debris),
            figure("largest_piece", "1", self.largest_piece(&breaking.broken)),
        ]
    }

    /// Part of the particles that belongs to the largest piece that holds together.
    fn largest_piece(&self, broken: &[bool]) -> f64 {
        let mut seen = broken.to_vec();
        let mut largest = 0;
        for start in 0..seen.len() {
            let (mut open, mut size) = (vec![start], 0);
            while let Some(a) = open.pop() {
                if std::mem::replace(&mut seen[a], true) {
                    continue;
                }
                size += 1;
                let row = self.links.row(a).other.iter().map(|b| *b as usize);
                open.extend(row.filter(|b| seen.get(*b) == Some(&false)));
            }
            largest = largest.max(size);
        }
        largest as f64 / broken.len().max(1) as f64
    }
}
