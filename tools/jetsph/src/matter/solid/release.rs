//! Energy that goes with a particle when it breaks, told before it does.
//!
//! ```text
//! G_a = (E(whole) - E(without a)) psi+/psi / A,      A = d in the plane, d^2 in space
//! ```
//!
//! the release of Griffith (1921) with the smallest step of a crack that the lattice knows: a's own cell goes, the fits of
//! its neighbours are made anew from what is left to them, and those around come to rest (`relief`). At the tip of
//! a crack the links give a fifth of it, their neighbourhood the rest, on any spacing alike. psi+ is the part of what is
//! stretched: compression opens nothing.

use rayon::prelude::*;

use super::breaking::Breaking;
use super::cell::{Derivatives, gradient};
use super::cracks::AROUND;
use super::elastic::Elastic;
use super::fracture::{stretched, stretched_most};
use super::trial::{Left, Trial};

/// Cells whose own energy is less than this part of that of a crack are not tried: at the tip of a crack it is a fifth.
const TRIED: f64 = 0.08;
/// Those around that come to rest give this part of what the whole body would: that of a long crack in a strip of 30 rows,
/// solved for on the same lattice (plane strain, nu 0.3).
const WITHIN: f64 = 0.83;
/// A cell that bears so many times more is asked again.
const GROWN: f64 = 1.03;
/// Of two releases that differ by less than this part the first particle breaks.
const EQUAL: f64 = 1e-9;

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Derivatives of the deformation of a particle by other links than its own.
    fn derivatives_by(&self, left: &Left<T>) -> Derivatives<L, T> {
        let own = self.places[left.particle];
        let mut sum = [[0.0; L]; T];
        for (b, weight) in left.other.iter().zip(&left.weight) {
            let other = self.places[*b as usize];
            for (column, w) in sum.iter_mut().zip(weight) {
                (0..L).for_each(|k| column[k] += w * (other[k] - own[k]));
            }
        }
        sum
    }

    /// Energy of what is stretched in a cell \[J\], and its part of all.
    fn own(&self, a: usize) -> (f64, f64) {
        let cell = &self.body.cell;
        let deformation = cell.law.completed(gradient(&self.derivatives(a)));
        let pulled = stretched(&cell.law, &deformation);
        let whole = cell.law.energy(&deformation).max(f64::MIN_POSITIVE);
        (
            self.body.share(a) * cell.volume * pulled,
            (pulled / whole).min(1.0),
        )
    }

    /// Energy that would go with the links \[J\].
    fn links_alone(&self, trial: &Trial<T>) -> f64 {
        let cell = &self.body.cell;
        let part = |left: &Left<T>| {
            let before = cell.energy(&self.derivatives(left.particle));
            let after = if left.other.is_empty() {
                0.0
            } else {
                cell.energy(&self.derivatives_by(left))
            };
            self.body.share(left.particle) * (before - after)
        };
        trial.left.iter().map(part).sum()
    }

    /// Those that break because a crack of an energy \[J/m2\] would be paid: of neighbours the one that gives most.
    pub(super) fn released(
        &self,
        breaking: &mut Breaking<T>,
        limit: f64,
        pushed: impl Fn(usize) -> [f64; 3] + Sync,
    ) -> Vec<usize> {
        let cell = &self.body.cell;
        let area = cell.volume / breaking.size;
        let is_near = |a: &usize| {
            let deformation = cell.law.completed(gradient(&self.derivatives(*a)));
            let is_enough = |energy: f64| energy * breaking.size >= TRIED * limit;
            !breaking.broken[*a]
                && is_enough(stretched_most(&cell.law, &deformation))
                && is_enough(stretched(&cell.law, &deformation))
        };
        let all = (0..breaking.broken.len()).into_par_iter().with_min_len(32);
        let near: Vec<usize> = all.filter(is_near).collect();
        let of = |a: &usize| {
            let (cracks, broken) = (&breaking.cracks, &breaking.broken);
            let trial = Trial::new(cracks, *a, broken, self.body.size);
            (*a, trial)
        };
        let is_new = |a: &&usize| !breaking.trials.contains_key(a);
        let fresh: Vec<_> = near.par_iter().filter(is_new).map(of).collect();
        breaking.trials.extend(fresh);
        // The neighbourhood is asked where the ratio that it had would do, and again where the cell bears more: under a load
        // that grows the ratio hardly changes.
        let paid = |a: &usize| {
            let trial = breaking.trials.get(a)?;
            let (own, part) = self.own(*a);
            let wanted = own * trial.ratio >= limit * area || own >= GROWN * trial.asked;
            let gone = wanted.then(|| {
                let all = self.links_alone(trial) + self.relief(breaking, trial, &pushed);
                part * all / WITHIN
            });
            Some((*a, own, gone))
        };
        let asked: Vec<(usize, f64, Option<f64>)> = near.par_iter().filter_map(paid).collect();
        let mut due = Vec::new();
        for (a, own, gone) in asked {
            let Some(trial) = breaking.trials.get_mut(&a) else {
                continue;
            };
            trial.asked = trial.asked.min(own);
            if let Some(gone) = gone {
                (trial.ratio, trial.asked) = (gone / own.max(f64::MIN_POSITIVE), own);
                if gone >= limit * area {
                    due.push((a, gone));
                }
            }
        }
        let leads = |(a, gone): &&(usize, f64)| {
            due.iter().all(|(b, other)| {
                let apart = a == b || breaking.cracks.distance(*a, *b) >= AROUND;
                let first =
                    *gone > other * (1.0 + EQUAL) || (*gone >= other * (1.0 - EQUAL) && a < b);
                apart || first
            })
        };
        let found: Vec<(usize, f64)> = due.iter().filter(leads).copied().collect();
        breaking.released += found.iter().map(|(_, gone)| gone).sum::<f64>();
        found.into_iter().map(|(a, _)| a).collect()
    }
}

#[cfg(test)]
mod tests {
    use particles::{Ids, Matter, Set};

    use super::super::body::Body;
    use super::super::cell::Cell;
    use super::super::elastic::REST;
    use super::super::fracture::{BROKEN, Criterion};
    use super::super::law::{Elastic as Constants, Law, Young};
    use super::super::tensor::UNIT;
    use super::*;
    use crate::matter::shares::Shares;
    use crate::state::MASS;

    /// A sheet of 9 by 9 cells of 1 mm under a uniform pull in y, with those that are broken in it.
    fn sheet(pull: f64) -> (Elastic<2, 5>, Set) {
        let young = Young {
            youngs_modulus_pa: 1e5,
            poisson_ratio: 0.0,
        };
        let size = [1e-3, 1e-3, 1.0];
        let body = Body {
            set: 0,
            cell: Cell::new(Law::new(&Constants::Young(young), None), size, 2),
            size,
            shares: Shares::default(),
            anchor_rest: Vec::new(),
            anchors: Vec::new(),
            loads: Vec::new(),
            damping: 0.0,
        };
        let matter = Matter {
            density: 1e3,
            spacing: 1e-3,
            smoothing_length: 1.5e-3,
        };
        let (mut set, mut ids) = (Set::new("sheet", matter), Ids::default());
        set.declare(&REST);
        set.declare(&MASS);
        for i in 0..81 {
            let row = set.push(&mut ids);
            set.column_mut(&REST)[row] = [1e-3 * f64::from(i % 9), 1e-3 * f64::from(i / 9), 0.0];
            set.column_mut(&MASS)[row] = 1e-3;
        }
        let (stage, _) = Elastic::<2, 5>::new(body, &set);
        let mut stage = stage.breaking(Criterion::Energy(1.0), &set, set.column(&REST), UNIT);
        for (place, rest) in stage.places.iter_mut().zip(set.column(&REST)) {
            *place = [rest[0], (1.0 + pull) * rest[1]];
        }
        (stage, set)
    }

    #[test]
    fn alone_a_cell_gives_its_own_energy_and_beside_a_crack_more() {
        let pull = 1e-3;
        let (stage, _) = sheet(pull);
        let own = 0.5 * 1e5 * pull * pull * 1e-6;
        let breaking = stage.breaking.as_ref().unwrap();
        let broken = vec![false; 81];
        let trial = |stage: &Elastic<2, 5>, broken: &[bool]| {
            let trial = Trial::new(&breaking.cracks, 40, broken, stage.body.size);
            stage.own(40).1 * stage.links_alone(&trial)
        };
        let alone = trial(&stage, &broken);
        assert!((alone / own - 1.0).abs() < 0.01, "{alone} {own}");
        // Pressed together it gives nothing.
        assert!(trial(&sheet(-pull).0, &broken).abs() < 1e-3 * own);
    }

    #[test]
    fn what_is_told_to_go_goes() {
        let (mut stage, mut set) = sheet(1e-3);
        set.declare(&BROKEN);
        let loose = stage.break_up(&[36, 37, 38, 39], &mut set);
        assert!(loose.is_empty());
        // The crack opens: what is above it moves up.
        for (i, place) in stage.places.iter_mut().enumerate() {
            place[1] += if i % 9 < 5 && i >= 45 { 1e-6 } else { 0.0 };
        }
        let mut breaking = stage.breaking.take().unwrap();
        let told = stage.released(&mut breaking, 0.0, |_| [0.0; 3]);
        let (cracks, broken) = (&breaking.cracks, &breaking.broken);
        let trial = Trial::new(cracks, 40, broken, stage.body.size);
        stage.breaking = Some(breaking);
        assert!(!told.is_empty());
        let (release, before) = (stage.links_alone(&trial), stage.stored());
        assert!(stage.break_up(&[40], &mut set).is_empty());
        let gone = before - stage.stored();
        assert!((release / gone - 1.0).abs() < 1e-9, "{release} {gone}");
    }

    #[test]
    fn what_swings_gives_no_more_than_what_rests() {
        let (mut stage, mut set) = sheet(1e-3);
        set.declare(&BROKEN);
        let loose = stage.break_up(&[36, 37, 38, 39], &mut set);
        assert!(loose.is_empty());
        let breaking = stage.breaking.take().unwrap();
        let mass = set.column(&MASS);
        let mut gone = || {
            stage.answer(0.0);
            let mut pushed = vec![[0.0; 3]; mass.len()];
            stage.accelerate(&mut pushed, mass);
            let pushed = |a: usize| pushed[a].map(|x| mass[a] * x);
            let (cracks, broken) = (&breaking.cracks, &breaking.broken);
            let trial = Trial::new(cracks, 40, broken, stage.body.size);
            let gone = stage.links_alone(&trial) + stage.relief(&breaking, &trial, pushed);
            // Those around the break swing.
            for a in [31, 32, 41, 50] {
                stage.places[a][1] += 2e-7 * (a as f64).sin();
            }
            gone
        };
        let (rests, swings) = (gone(), gone());
        assert!(
            rests > 0.0 && (swings / rests - 1.0).abs() < 0.03,
            "{swings} {rests}"
        );
    }
}
