//! Points of a drop in the open merge where they crowd, and come where they are thin (2.2.6, Matsuzawa 2017).
//!
//! Two points of the surface nearer than `MERGED` spacings become one in their middle, and so do two inside. One inside that is
//! nearer than `SUNK` to the surface leaves. No other point of the surface leaves. Points come to the middles of holes.
//! A new point of the surface stands on the fit of the old ones; what it carries is the value of a fit over them. What comes inside
//! carries the values of fits over all old points. So neither depends on the order in which points are looked at.
//!
//! Differences from (2.56) to (2.59): a pair is not told by its distance alone, which any even lattice has at its diagonals, but by the
//! room about its middle; and one of two is not removed, but both are replaced.

pub(super) mod holes;

#[cfg(test)]
mod tests;

use std::iter::empty;

use run::Failure;
use wls::{Cloud, Everything, Metric, Plan, Search, Stencils, Wants};

use self::holes::Holes;
use super::effort::failed;
use super::fill::Crowd;
use super::matter::Way;
use super::points::Liquid;
use super::surface::{Patch, SIDE, Seat, Sheet, between};
use super::vector::{along, difference, direction, dot, length};

/// Spacings below which two points merge. Those of an even drop stand at 0.83 and more. Where a surface is drawn together in one
/// direction, no push can help, since pushes from both sides are alike: some must go before they stand too close. With 0.5 a drop let
/// go at 2.5:1 (Oh 0.02, 5 spacings a radius) broke after 0.6 periods.
const MERGED: f64 = 0.75;
/// Spacings from the surface below which a point inside leaves.
const SUNK: f64 = 0.55;

/// How many points came and merged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Renewed {
    /// Points that came where there was room.
    pub added: u64,
    /// Points that merged with another or left for the surface.
    pub merged: u64,
}

impl Renewed {
    /// Whether anything changed.
    #[must_use]
    pub fn any(&self) -> bool {
        *self != Self::default()
    }

    /// Both counts together.
    pub fn add(&mut self, more: Self) {
        self.added += more.added;
        self.merged += more.merged;
    }
}

/// Two points that are close.
struct Pair {
    far: f64,
    both: [usize; 2],
}

/// Which points leave, and what comes.
struct Change<const D: usize> {
    leaves: Vec<bool>,
    /// On the surface, about.
    skin: Vec<Seat<D>>,
    /// Inside.
    inner: Vec<[f64; D]>,
    count: Renewed,
}

/// What new points carry: weights over old ones.
struct Fresh<const D: usize> {
    patches: Vec<Patch<D>>,
    rows: Stencils<D>,
    inner: usize,
}

impl<const D: usize> Fresh<D> {
    /// Values of a field on the surface at new points there.
    fn skin<const C: usize>(&self, field: &[[f64; C]]) -> impl Iterator<Item = [f64; C]> {
        self.patches.iter().map(|patch| {
            let near = patch.neighbours.iter().zip(&patch.value);
            let add = |sum, (j, w): (&u32, &f64)| along(&sum, *w, &field[*j as usize]);
            near.fold([0.0; C], add)
        })
    }

    /// Values of a field at new points inside.
    fn inner<const C: usize>(&self, field: &[[f64; C]]) -> impl Iterator<Item = [f64; C]> {
        (0..self.inner).map(|k| {
            let row = self.rows.value(k);
            row.iter()
                .fold([0.0; C], |sum, (j, w)| along(&sum, w, &field[j]))
        })
    }
}

impl<const D: usize> Liquid<D> {
    /// Lets points merge and come.
    ///
    /// # Errors
    /// Where the values of new points have no fit.
    pub fn renew(&mut self, way: &Way) -> Result<Renewed, Failure> {
        self.renew_with(way, &mut Vec::new())
    }

    /// Lets points merge and come, with something that they carry beside, by point.
    ///
    /// # Errors
    /// Where the values of new points have no fit.
    pub fn renew_with(&mut self, way: &Way, borne: &mut Vec<f64>) -> Result<Renewed, Failure> {
        let change = self.change(way.spacing);
        let count = change.count;
        if count.any() {
            self.take(change, way, borne)?;
        }
        Ok(count)
    }

    /// What is to change.
    fn change(&self, spacing: f64) -> Change<D> {
        let mut change = self.merging(spacing);
        let surface = self.surface();
        let stay = |i: &usize| !change.leaves[*i];
        let mut skin: Vec<Seat<D>> = (0..surface).filter(stay).map(|i| self.seat(i)).collect();
        skin.extend(&change.skin);
        let inside = (surface..self.position.len()).filter(stay);
        let mut inner: Vec<[f64; D]> = inside.map(|i| self.position[i]).collect();
        inner.extend(&change.inner);
        let holes = Holes { spacing };
        let seats = holes.on_surface(&skin);
        skin.extend(&seats);
        let places = holes.inside(&skin, &inner);
        change.count.added = (seats.len() + places.len()) as u64;
        change.skin.extend(seats);
        change.inner.extend(places);
        change
    }

    pub(super) fn seat(&self, i: usize) -> Seat<D> {
        Seat {
            place: self.position[i],
            normal: self.normal[i],
        }
    }

    /// What merges and leaves.
    fn merging(&self, spacing: f64) -> Change<D> {
        let mut change = Change {
            leaves: vec![false; self.position.len()],
            skin: Vec::new(),
            inner: Vec::new(),
            count: Renewed::default(),
        };
        let surface = self.surface();
        for Pair { both: [i, j], .. } in self.close(spacing) {
            if change.leaves[i] || change.leaves[j] {
                continue;
            }
            change.leaves[j] = true;
            change.count.merged += 1;
            let middle = self.position[i].map(|c| 0.5 * c);
            let middle = along(&middle, 0.5, &self.position[j]);
            if j < surface {
                change.leaves[i] = true;
                let normal = direction(&along(&self.normal[i], 1.0, &self.normal[j]));
                let place = middle;
                change.skin.push(Seat { place, normal });
            } else if i >= surface {
                change.leaves[i] = true;
                change.inner.push(middle);
            }
        }
        change
    }

    /// Pairs that are too close, the closest first.
    fn close(&self, spacing: f64) -> Vec<Pair> {
        let surface = self.surface();
        let crowd = Crowd::new(&self.position, spacing);
        let mut pairs = Vec::new();
        for (i, x) in self.position.iter().enumerate() {
            crowd.near(x, MERGED, |j| {
                if j <= i {
                    return;
                }
                let far = length(&difference(x, &self.position[j])) / spacing;
                let apart = if i < surface && j >= surface {
                    far > SUNK
                } else {
                    j < surface && dot(&self.normal[i], &self.normal[j]) <= SIDE
                };
                if !apart {
                    pairs.push(Pair { far, both: [i, j] });
                }
            });
        }
        let order = |a: &Pair, b: &Pair| a.far.total_cmp(&b.far).then(a.both.cmp(&b.both));
        pairs.sort_by(order);
        pairs
    }

    /// Makes the change.
    fn take(
        &mut self,
        mut change: Change<D>,
        way: &Way,
        borne: &mut Vec<f64>,
    ) -> Result<(), Failure> {
        let surface = self.surface();
        let sheet = Sheet {
            points: &self.position[..surface],
            normals: &self.normal,
        };
        let patches = between(sheet, &mut change.skin, way.spacing).map_err(|e| failed(&e))?;
        let fresh = Fresh {
            patches,
            rows: valued(&self.position, &change.inner, way).map_err(|e| failed(&e))?,
            inner: change.inner.len(),
        };
        let leaves = &change.leaves;
        let places = change.skin.iter().map(|s| s.place);
        let inner = change.inner.iter().copied();
        let position = rebuilt(&self.position, leaves, surface, places, inner);
        self.velocity = self.carried(&self.velocity, leaves, &fresh);
        self.rate = self.carried(&self.rate, leaves, &fresh);
        let pressure = self.pressure.as_chunks::<1>().0;
        self.pressure = self.carried(pressure, leaves, &fresh).into_flattened();
        if !borne.is_empty() {
            let old = borne.as_chunks::<1>().0;
            *borne = self.carried(old, leaves, &fresh).into_flattened();
        }
        let skin = &leaves[..surface];
        let [now, rate] = &mut self.pull;
        for field in [&mut self.stress, &mut self.charge, now, rate] {
            if !field.is_empty() {
                let old = field.as_chunks::<1>().0;
                *field = rebuilt(old, skin, surface, fresh.skin(old), empty()).into_flattened();
            }
        }
        if !self.drag.is_empty() {
            let old = &self.drag;
            self.drag = rebuilt(old, skin, surface, fresh.skin(old), empty());
        }
        let normals = change.skin.iter().map(|s| s.normal);
        self.normal = rebuilt(&self.normal, skin, surface, normals, empty());
        self.position = position;
        if let Some(borne) = &mut self.borne {
            borne.clear();
        }
        Ok(())
    }

    /// A field after the change.
    fn carried<const C: usize>(
        &self,
        field: &[[f64; C]],
        leaves: &[bool],
        fresh: &Fresh<D>,
    ) -> Vec<[f64; C]> {
        let (skin, inner) = (fresh.skin(field), fresh.inner(field));
        rebuilt(field, leaves, self.surface(), skin, inner)
    }
}

/// What stays of `old` with the new behind it, first of the surface (`skin`), then inside.
fn rebuilt<T: Copy>(
    old: &[T],
    leaves: &[bool],
    surface: usize,
    skin: impl Iterator<Item = T>,
    inner: impl Iterator<Item = T>,
) -> Vec<T> {
    let kept = |from: usize, to: usize| {
        let both = old[from..to].iter().zip(&leaves[from..to]);
        both.filter(|(_, leaves)| !**leaves)
            .map(|(value, _)| *value)
    };
    let skin = kept(0, surface).chain(skin);
    skin.chain(kept(surface, old.len())).chain(inner).collect()
}

/// Values of fits at places among points.
pub(super) fn valued<const D: usize>(
    points: &[[f64; D]],
    places: &[[f64; D]],
    way: &Way,
) -> Result<Stencils<D>, wls::Error> {
    let metrics = vec![Metric::round(way.spacing); points.len()];
    let search = Search::new(Cloud {
        points,
        metrics: &metrics,
    })?;
    let wants = Wants {
        value: true,
        ..Wants::default()
    };
    Stencils::at(
        &search,
        &Plan::new::<D>(way.order, wants),
        places,
        &Everything,
    )
}
