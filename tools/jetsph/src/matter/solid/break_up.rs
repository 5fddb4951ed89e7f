//! An elastic solid that breaks: the part of its stage that only fracture needs.

use particles::{POSITION, Set, sweep};
use rayon::prelude::*;

use super::breaking::Breaking;
use super::cell::gradient;
use super::elastic::Elastic;
use super::fracture::BROKEN;
use super::tensor::determinant;
use crate::matter::meeting::skin::{DEFORMATION, DEFORMATION_RATE};
use crate::stage::Figure;
use crate::state::{MASS, State};

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

    /// Energy of the cells that are whole \[J\]; one that is turned inside out has none that can be told.
    pub(super) fn stored(&self) -> f64 {
        let whole = |a: usize| self.breaking.as_ref().is_none_or(|b| !b.broken[a]);
        sweep::sum(self.answers.len(), |a| {
            let energy = if whole(a) {
                self.body.cell.energy(&self.derivatives(a))
            } else {
                0.0
            };
            [if energy.is_finite() || self.breaking.is_none() {
                energy
            } else {
                0.0
            }]
        })[0]
    }

    /// Breaks what is due; tells whether anything broke.
    pub(super) fn breaks(&mut self, set: &mut Set) -> bool {
        let Some(breaking) = self.breaking.take() else {
            return false;
        };
        let law = self.body.cell.law;
        let is_due = |a: &usize| {
            let deformation = law.completed(gradient(&self.derivatives(*a)));
            !breaking.broken[*a] && breaking.criterion.breaks(&law, &deformation, breaking.size)
        };
        let all = (0..breaking.broken.len()).into_par_iter().with_min_len(32);
        let mut fresh: Vec<usize> = all.filter(is_due).collect();
        if fresh.is_empty() {
            self.breaking = Some(breaking);
            return false;
        }
        self.breaking = Some(breaking);
        let before = self.stored() - self.load_potential(set.column(&POSITION));
        while !fresh.is_empty() {
            fresh = self.break_up(&fresh, set);
        }
        let after = self.stored() - self.load_potential(set.column(&POSITION));
        self.entry.spent += before - after;
        if let Some(breaking) = &mut self.breaking {
            breaking.energy += before - after;
        }
        true
    }

    /// Breaks particles and gives those that nothing holds any more.
    fn break_up(&mut self, fresh: &[usize], set: &mut Set) -> Vec<usize> {
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

    fn cut(&mut self, breaking: &mut Breaking, fresh: &[usize]) -> Vec<usize> {
        let broken = &breaking.broken;
        breaking.list = (0..broken.len()).filter(|a| broken[*a]).collect();
        let touched = breaking.cracks.touched(fresh, broken);
        let (cracks, size) = (&breaking.cracks, self.body.size);
        let loose = self.links.cut(cracks, size, broken, (fresh, &touched));
        self.body.loads.retain(|load| !broken[load.particle]);
        loose
    }

    /// Takes up what was broken when a checkpoint was written.
    pub(super) fn take_up(&mut self, flags: &[u8], energy: f64) {
        let Some(mut breaking) = self.breaking.take() else {
            return;
        };
        breaking.energy = energy;
        breaking.broken = flags.iter().map(|flag| *flag > 0).collect();
        let fresh: Vec<usize> = (0..flags.len()).filter(|a| flags[*a] > 0).collect();
        let _ = self.cut(&mut breaking, &fresh);
        self.breaking = Some(breaking);
    }

    /// Shows the water how the cells are deformed; broken ones keep their shape.
    pub(super) fn show_shape(&mut self, set: &mut Set, time: f64) {
        let since = time - std::mem::replace(&mut self.looked, time);
        let whole = |a: usize| self.breaking.as_ref().is_none_or(|b| !b.broken[a]);
        let mut rate = set.take(&DEFORMATION_RATE);
        let before = set.column(&DEFORMATION);
        sweep::fill(&mut rate, |a| {
            if !whole(a) || since <= 0.0 {
                return [[0.0; 3]; 3];
            }
            let now = gradient(&self.derivatives(a));
            [0, 1, 2].map(|i| [0, 1, 2].map(|j: usize| (now[i][j] - before[a][i][j]) / since))
        });
        set.put(&DEFORMATION_RATE, rate);
        sweep::change(set.column_mut(&DEFORMATION), |a, shape| {
            if whole(a) {
                *shape = gradient(&self.derivatives(a));
            }
        });
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
