//! From a cloud to its weights: supports, equal ones together, one solution for each.

use rayon::prelude::*;

use crate::bench::{Bench, Work};
use crate::error::Error;
use crate::functional::Condition;
use crate::ladder::Made;
use crate::memo::{self, Group};
use crate::plan::{Plan, Rules};
use crate::report::Report;
use crate::search::{Aim, Search, Target};
use crate::stencils::{Spot, Stencils};
use crate::supports::{Found, Supports};

/// Leaves of the tree that make a parcel of parallel work.
const LEAVES: usize = 16;
/// Solutions that make one.
const SOLUTIONS: usize = 64;

/// Rows close to each other, and how often their supports are enlarged.
struct Batch {
    rows: Vec<u32>,
    times: u32,
}

/// Rows whose group's first had to take another support.
#[derive(Default)]
struct Strays {
    /// They may still be alike in a larger support: number of the row, and how large.
    alike: Vec<(u32, u32)>,
    /// Their numbers among the supports.
    alone: Vec<usize>,
}

/// The weights of one group, and the support where it is another one than was found.
struct Solution {
    made: Made,
    weights: usize,
    shares: u32,
    changed: Option<Vec<u32>>,
    /// Its weights stand among the extra ones of its parcel.
    extra: bool,
}

impl<const D: usize> Stencils<D> {
    /// Makes the rows of all points of the cloud that the `rules` want.
    ///
    /// # Errors
    /// Where points coincide, where a point is alone, or where its neighbours lie so that no order
    /// serves; and where the plan is none.
    pub fn build(
        search: &Search<'_, D>,
        plan: &Plan,
        rules: &impl Rules<D>,
    ) -> Result<Self, Error> {
        let target = |row: usize| straightened(search.target(row), rules);
        let leaves = search.tree().leaves();
        let batches = leaves
            .iter()
            .map(|leaf| {
                let rows = search.tree().order()[leaf.clone()].iter().copied();
                Batch {
                    rows: rows.filter(|&row| rules.wanted(row as usize)).collect(),
                    times: 0,
                }
            })
            .collect::<Vec<_>>();
        let bench = Bench::new(search, plan, rules)?;
        bench.sweep(batches, search.cloud().points.len(), &target)
    }

    /// Makes a row at each of the `places` \[m\], with the spacing of the nearest point. In the
    /// `rules`, a row is a place.
    ///
    /// # Errors
    /// As [`Stencils::build`].
    pub fn at(
        search: &Search<'_, D>,
        plan: &Plan,
        places: &[[f64; D]],
        rules: &impl Rules<D>,
    ) -> Result<Self, Error> {
        if let Some(point) = places.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            return Err(Error::NotFinite {
                point,
                place: places[point].to_vec(),
            });
        }
        let target = |row: usize| {
            let nearest = search.nearest(places[row]);
            let target = Target {
                row,
                place: places[row],
                metric: search.cloud().metrics[nearest],
                own: false,
            };
            straightened(target, rules)
        };
        let batches = (0..places.len() as u32)
            .filter(|&row| rules.wanted(row as usize))
            .map(|row| Batch {
                rows: vec![row],
                times: 0,
            })
            .collect::<Vec<_>>();
        let bench = Bench::new(search, plan, rules)?;
        bench.sweep(batches, places.len(), &target)
    }
}

/// A row, its coordinates straight where its polynomial must be harmonic.
fn straightened<const D: usize>(target: Target<D>, rules: &dyn Rules<D>) -> Target<D> {
    if !target.metric.follows() {
        return target;
    }
    let mut conditions = Vec::new();
    rules.conditions(target.row, &mut conditions);
    let metric = if conditions.contains(&Condition::Harmonic) {
        target.metric.straight()
    } else {
        target.metric
    };
    Target { metric, ..target }
}

impl Strays {
    fn take(&mut self, supports: &Supports, group: &Group, made: &Made, order: u8) {
        let larger = made.times > supports.found[group.first].times && made.order == order;
        for &k in &group.others {
            if larger {
                self.alike.push((supports.found[k].row, made.times));
            } else {
                self.alone.push(k);
            }
        }
    }
}

/// Where the weights of some groups go: the number of the first, and their room.
struct Room<'a> {
    start: usize,
    weights: &'a mut [f64],
}

/// What one parcel of solutions has found out.
#[derive(Default)]
struct Parcel {
    solutions: Vec<Solution>,
    /// Weights of rows that do not fit where they were expected.
    extra: Vec<f64>,
}

impl<const D: usize> Bench<'_, D> {
    fn sweep(
        &self,
        mut batches: Vec<Batch>,
        rows: usize,
        target: &Aim<'_, D>,
    ) -> Result<Stencils<D>, Error> {
        let mut stencils = Stencils {
            spots: vec![Spot::default(); rows],
            neighbours: Vec::new(),
            weights: Vec::new(),
            columns: self.columns,
            report: Report::default(),
        };
        let mut changed = Vec::new();
        while !batches.is_empty() {
            let mut supports = self.supports(&batches, target)?;
            let groups = memo::groups(&supports, target, self.search.cloud().points);
            let strays = self.place(&supports, &groups, target, &mut stencils, &mut changed)?;
            let alone = strays.alone.into_iter().map(Group::alone);
            let alone = alone.collect::<Vec<_>>();
            self.place(&supports, &alone, target, &mut stencils, &mut changed)?;
            stencils.neighbours.append(&mut supports.neighbours);
            let again = strays.alike.into_iter().map(|(row, times)| Batch {
                rows: vec![row],
                times,
            });
            batches = again.collect();
        }
        for (row, neighbours) in changed {
            stencils.spots[row].start = stencils.neighbours.len();
            stencils.neighbours.extend_from_slice(&neighbours);
        }
        stencils.report.rows = stencils.spots.iter().filter(|s| s.count > 0).count();
        stencils.report.neighbours = stencils.spots.iter().map(|s| s.count as usize).sum();
        Ok(stencils)
    }

    /// Supports of all rows, parcel after parcel.
    fn supports(&self, batches: &[Batch], target: &Aim<'_, D>) -> Result<Supports, Error> {
        let parcels = batches
            .par_chunks(LEAVES)
            .map_init(Work::<D>::new, |work, batches| {
                let mut supports = Supports::default();
                for batch in batches {
                    self.batch(batch, target, work, &mut supports)?;
                }
                Ok(supports)
            })
            .collect::<Vec<Result<Supports, Error>>>();
        let mut all = Supports::default();
        let sizes = parcels.iter().flatten().map(|p| p.neighbours.len());
        all.neighbours.reserve_exact(sizes.sum());
        for parcel in parcels {
            let mut parcel = parcel?;
            for found in &mut parcel.found {
                found.start += all.neighbours.len();
            }
            all.found.append(&mut parcel.found);
            all.neighbours.append(&mut parcel.neighbours);
        }
        Ok(all)
    }

    fn batch(
        &self,
        batch: &Batch,
        target: &Aim<'_, D>,
        work: &mut Work<D>,
        supports: &mut Supports,
    ) -> Result<(), Error> {
        let rows = batch.rows.iter();
        let targets = rows.map(|&row| target(row as usize)).collect::<Vec<_>>();
        let reach = self.plan.reach.enlarged(batch.times);
        let (mut candidates, mut conditions) = (Vec::new(), Vec::<Condition<D>>::new());
        self.search.candidates(&targets, reach, &mut candidates);
        for target in &targets {
            let allowed = |j| self.rules.allowed(target.row, j);
            let support = &mut work.support;
            self.search
                .support(target, reach, &candidates, allowed, support)?;
            conditions.clear();
            self.rules.conditions(target.row, &mut conditions);
            supports.found.push(Found {
                row: target.row as u32,
                count: support.neighbours.len() as u32,
                start: supports.neighbours.len(),
                radius: support.radius,
                hash: support.hash,
                free: conditions.iter().all(|c| *c == Condition::Harmonic),
                harmonic: conditions.contains(&Condition::Harmonic),
                times: batch.times,
            });
            supports.neighbours.extend_from_slice(&support.neighbours);
        }
        Ok(())
    }

    /// Solves for the `groups` and gives their rows their weights; returns the members of groups
    /// whose first had to change its support.
    fn place(
        &self,
        supports: &Supports,
        groups: &[Group],
        target: &Aim<'_, D>,
        stencils: &mut Stencils<D>,
        changed: &mut Vec<(usize, Vec<u32>)>,
    ) -> Result<Strays, Error> {
        let solutions = self.solutions(supports, groups, target, &mut stencils.weights)?;
        let base = stencils.neighbours.len();
        let mut strays = Strays::default();
        for (group, solution) in groups.iter().zip(solutions) {
            stencils.report.count(&solution.made, self.plan.order);
            let mut put = |k: usize, count: usize| {
                let found = &supports.found[k];
                let row = found.row as usize;
                stencils.spots[row] = Spot {
                    start: base + found.start,
                    count: count as u32,
                    shares: solution.shares,
                    weights: solution.weights,
                    inverse_spacing: target(row).metric.spacing().recip(),
                    order: solution.made.order,
                };
                found
            };
            if let Some(other) = solution.changed {
                let first = put(group.first, other.len());
                changed.push((first.row as usize, other));
                strays.take(supports, group, &solution.made, self.plan.order);
                continue;
            }
            for &k in std::iter::once(&group.first).chain(&group.others) {
                put(k, supports.found[k].count as usize);
            }
            stencils.report.shared += group.others.len();
        }
        Ok(strays)
    }

    /// One solution per group; appends the weights to `weights`.
    fn solutions(
        &self,
        supports: &Supports,
        groups: &[Group],
        target: &Aim<'_, D>,
        weights: &mut Vec<f64>,
    ) -> Result<Vec<Solution>, Error> {
        let first = weights.len();
        let size = |group: &Group| supports.found[group.first].count as usize * self.columns.count;
        let sizes = groups
            .chunks(SOLUTIONS)
            .map(|chunk| chunk.iter().map(size).sum::<usize>())
            .collect::<Vec<_>>();
        // A fresh vector is zero without being touched: its pages come to the workers' hands.
        let mut fresh = vec![0.0; sizes.iter().sum()];
        let mut rest = fresh.as_mut_slice();
        let mut start = first;
        let mut parcels = Vec::with_capacity(sizes.len());
        for (chunk, size) in groups.chunks(SOLUTIONS).zip(sizes) {
            let (own, others) = std::mem::take(&mut rest).split_at_mut(size);
            parcels.push((
                chunk,
                Room {
                    start,
                    weights: own,
                },
            ));
            (rest, start) = (others, start + size);
        }
        let done = parcels
            .into_par_iter()
            .map_init(Work::<D>::new, |work, (chunk, room)| {
                self.parcel(supports, chunk, target, room, work)
            })
            .collect::<Vec<Result<Parcel, Error>>>();
        if first == 0 {
            *weights = fresh;
        } else {
            weights.append(&mut fresh);
        }
        let mut solutions = Vec::with_capacity(groups.len());
        for parcel in done {
            let parcel = parcel?;
            for mut solution in parcel.solutions {
                if solution.extra {
                    solution.weights += weights.len();
                }
                solutions.push(solution);
            }
            weights.extend_from_slice(&parcel.extra);
        }
        Ok(solutions)
    }

    fn parcel(
        &self,
        supports: &Supports,
        groups: &[Group],
        target: &Aim<'_, D>,
        room: Room<'_>,
        work: &mut Work<D>,
    ) -> Result<Parcel, Error> {
        let Room {
            mut start,
            weights: mut room,
        } = room;
        let mut parcel = Parcel::default();
        for group in groups {
            let found = &supports.found[group.first];
            let neighbours = &supports.neighbours[found.start..][..found.count as usize];
            let target = target(found.row as usize);
            self.search
                .recall(&target, neighbours, found.radius, &mut work.support);
            let made = self.solve(&target, found.times, work)?;
            let size = neighbours.len() * self.columns.count;
            let (own, others) = std::mem::take(&mut room).split_at_mut(size);
            let changed = work.support.neighbours != neighbours;
            let extra = changed || !work.shares.is_empty();
            let mut solution = Solution {
                made,
                weights: start,
                shares: (work.shares.len() / self.columns.count) as u32,
                changed: changed.then(|| work.support.neighbours.clone()),
                extra,
            };
            if extra {
                solution.weights = parcel.extra.len();
                parcel.extra.extend_from_slice(&work.fit.weights);
                parcel.extra.extend_from_slice(&work.shares);
            } else {
                own.copy_from_slice(&work.fit.weights);
            }
            parcel.solutions.push(solution);
            (room, start) = (others, start + size);
        }
        Ok(parcel)
    }
}
