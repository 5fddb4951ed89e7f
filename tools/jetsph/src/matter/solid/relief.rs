//! What the neighbourhood of a break gives when it comes to rest.
//!
//! ```text
//! f = m a + f(without a) - f(whole),      K u = f,      energy = f.u/2 - that of m a in the whole neighbourhood
//! ```
//!
//! u moves those around the break, all beyond stand still, and K is the stiffness of what is left where it is now. What is
//! pushed from outside is pushed on; what waves already would come to rest without the break, too, and counts for
//! nothing. By conjugate gradients, whose energy grows with each
//! iteration towards that of rest (Hestenes and Stiefel 1952).

use std::collections::{BTreeMap, BTreeSet};

use super::breaking::Breaking;
use super::cell::Derivatives;
use super::elastic::Elastic;
use super::forces::add;
use super::trial::{Left, Trial};

/// Those that move are nearer than so many cells: beyond, a crack is felt as one of any other lattice.
const AROUND: f64 = 4.0;
/// Iterations, and the part of the forces that may be left.
const ITERATIONS: usize = 20;
const REST: f64 = 1e-2;
/// What is so many times softer than the stiffest motion is loose.
const LOOSE: f64 = 1e-7;
/// A small motion, in cells.
const SMALL: f64 = 1e-5;

/// Those that move, and the cells that feel it.
struct Region<'a, const T: usize> {
    /// Numbers of those that move.
    moving: BTreeMap<u32, usize>,
    cells: Vec<usize>,
    /// What is left of those whose fit changes.
    left: BTreeMap<usize, &'a Left<T>>,
}

impl<const L: usize, const T: usize> Elastic<L, T> {
    /// Energy that the neighbourhood of a break gives beside that of the links \[J\]; `pushed` are the forces on all
    /// particles that nothing balances now \[N\].
    pub(super) fn relief(
        &self,
        breaking: &Breaking<T>,
        trial: &Trial<T>,
        pushed: impl Fn(usize) -> [f64; 3],
    ) -> f64 {
        let Some(own) = trial.left.first().map(|left| left.particle) else {
            return 0.0;
        };
        let region = self.region(breaking, trial, own);
        let still = vec![[0.0; L]; region.moving.len()];
        let whole = self.slopes(&region, &still, false);
        let without = self.slopes(&region, &still, true);
        let mut moving = vec![[0.0; L]; region.moving.len()];
        for (a, k) in &region.moving {
            let force = pushed(*a as usize);
            (0..L.min(3)).for_each(|i| moving[*k][i] = force[i]);
        }
        // Forces are slopes of the energy, downwards.
        let change = whole.iter().zip(&without).map(|(a, b)| minus(a, b));
        let mut all = moving.clone();
        for (force, change) in all.iter_mut().zip(change) {
            (0..L).for_each(|i| force[i] += change[i]);
        }
        self.given(&region, &all, &without, true) - self.given(&region, &moving, &whole, false)
    }

    /// Energy that a neighbourhood gives when it comes to rest under forces that nothing balances \[J\]; `slopes` are those of
    /// its energy where it is.
    fn given(
        &self,
        region: &Region<'_, T>,
        force: &[[f64; L]],
        slopes: &[[f64; L]],
        without: bool,
    ) -> f64 {
        let mut motion = vec![[0.0; L]; force.len()];
        let mut rest = force.to_vec();
        let mut way = rest.clone();
        let begun = dot(&rest, &rest);
        let mut square = begun;
        let mut stiffest = 0.0_f64;
        for _ in 0..ITERATIONS {
            let most = way.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
            if most <= 0.0 || square <= REST * REST * begun {
                break;
            }
            let small = SMALL * self.body.size[0] / most;
            let tried: Vec<[f64; L]> = way.iter().map(|p| p.map(|x| small * x)).collect();
            let there = self.slopes(region, &tried, without);
            let stiff: Vec<[f64; L]> = there
                .iter()
                .zip(slopes)
                .map(|(a, b)| minus(a, b).map(|x| x / small))
                .collect();
            let along = dot(&way, &stiff);
            // What is left may be loose, and then gives no more: what rounding leaves of its stiffness is none.
            let stiffness = along / dot(&way, &way);
            stiffest = stiffest.max(stiffness);
            if along.is_nan() || along <= 0.0 || stiffness <= LOOSE * stiffest {
                break;
            }
            let step = square / along;
            advance(&mut motion, step, &way);
            advance(&mut rest, -step, &stiff);
            let next = dot(&rest, &rest);
            way.iter_mut().zip(&rest).for_each(|(p, r)| {
                (0..L).for_each(|k| p[k] = r[k] + next / square * p[k]);
            });
            square = next;
        }
        0.5 * dot(force, &motion)
    }

    fn region<'a>(&self, breaking: &Breaking<T>, trial: &'a Trial<T>, own: usize) -> Region<'a, T> {
        let near = breaking.cracks.near(own, AROUND).into_iter();
        let is_left = |a: &u32| !breaking.broken[*a as usize] && *a as usize != own;
        let moving: BTreeMap<u32, usize> = near
            .filter(is_left)
            .enumerate()
            .map(|(k, a)| (a, k))
            .collect();
        let mut cells: BTreeSet<usize> = BTreeSet::from([own]);
        for a in moving.keys().map(|a| *a as usize) {
            cells.insert(a);
            // A link that one way alone holds is one of the other's row at rest.
            let rows = breaking.cracks.row(a).iter().map(|b| *b as usize);
            cells.extend(rows.filter(|b| breaking.broken.get(*b) == Some(&false)));
        }
        Region {
            moving,
            cells: cells.into_iter().collect(),
            left: trial
                .left
                .iter()
                .map(|left| (left.particle, left))
                .collect(),
        }
    }

    /// Slopes of the energy with the places of those that move, moved by `motion` \[N\].
    fn slopes(&self, region: &Region<'_, T>, motion: &[[f64; L]], without: bool) -> Vec<[f64; L]> {
        let place = |b: u32| {
            let x = self.places[b as usize];
            match region.moving.get(&b) {
                Some(k) => std::array::from_fn(|i| x[i] + motion[*k][i]),
                None => x,
            }
        };
        let mut slopes = vec![[0.0; L]; region.moving.len()];
        for cell in &region.cells {
            let left = region.left.get(cell).filter(|_| without);
            let row = self.links.row(*cell);
            let (other, weight) = match left {
                Some(left) => (left.other.as_slice(), left.weight.as_slice()),
                None => (row.other, row.weight),
            };
            if other.is_empty() {
                continue;
            }
            let own: [f64; L] = place(*cell as u32);
            let mut derivatives: Derivatives<L, T> = [[0.0; L]; T];
            for (b, weight) in other.iter().zip(weight) {
                let dx = minus(&place(*b), &own);
                for (column, w) in derivatives.iter_mut().zip(weight) {
                    (0..L).for_each(|k| column[k] += w * dx[k]);
                }
            }
            let (answer, _) = self.body.cell.answer(&derivatives);
            let share = self.body.share(*cell);
            let mut all = [0.0; L];
            for (b, weight) in other.iter().zip(weight) {
                let mut part = [0.0; L];
                add(&mut part, &answer, &weight.map(|w| share * w));
                if let Some(k) = region.moving.get(b) {
                    (0..L).for_each(|i| slopes[*k][i] += part[i]);
                }
                (0..L).for_each(|i| all[i] += part[i]);
            }
            if let Some(k) = region.moving.get(&(*cell as u32)) {
                (0..L).for_each(|i| slopes[*k][i] -= all[i]);
            }
        }
        slopes
    }
}

fn minus<const L: usize>(a: &[f64; L], b: &[f64; L]) -> [f64; L] {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot<const L: usize>(a: &[[f64; L]], b: &[[f64; L]]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(x, y)| x * y).sum()
}

/// x += step p.
fn advance<const L: usize>(x: &mut [[f64; L]], step: f64, p: &[[f64; L]]) {
    for (x, p) in x.iter_mut().zip(p) {
        (0..L).for_each(|k| x[k] += step * p[k]);
    }
}
