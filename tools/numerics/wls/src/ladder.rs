//! One row, whatever its support is like: enlarge it, take it by singular values, lower the order.

use crate::basis::{Basis, terms};
use crate::bench::{Bench, Work};
use crate::error::Error;
use crate::fit::Way;
use crate::functional::Condition;
use crate::judge::{LEANS, tame};
use crate::positive;
use crate::search::{Support, Target};

/// Condition number up to which a support is good, by order from 1, in two and three dimensions:
/// about twice that of a corner of a lattice.
const GOOD: [[f64; 4]; 2] = [[20.0, 40.0, 100.0, 400.0], [20.0, 60.0, 150.0, 400.0]];
/// Condition number up to which a support will do, where none is good.
const FAIR: f64 = 1e5;
/// A support is enlarged so many times.
const ENLARGEMENTS: u32 = 5;
/// And so many times for an even Laplacian.
const SEARCHES: u32 = 3;
/// Weights of a Laplacian of the sign of the own one add up to this part of it at most; lattices have none for quadratics
/// and a tenth for quartics, points all on one side several times as many.
const EVEN: f64 = 1.0;
/// How a row came about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Made {
    pub(crate) order: u8,
    pub(crate) way: Way,
    /// How often the support was enlarged.
    pub(crate) times: u32,
    pub(crate) condition: f64,
    pub(crate) positive: Option<bool>,
    /// Points weigh by the room that each has.
    pub(crate) by_room: bool,
}

/// A support that was tried.
#[derive(Debug, Clone, Copy)]
struct Trial {
    order: u8,
    times: u32,
    /// Condition number at most.
    limit: f64,
    /// Points weigh by the room that each has.
    by_room: bool,
}

/// Where a climb begins: the order, how often the support is enlarged, and whether it stands already.
#[derive(Debug, Clone, Copy)]
struct First {
    order: u8,
    times: u32,
    ready: bool,
}

/// What an order has come to where no support serves.
struct Tried {
    /// Least condition number, and how often that support was enlarged.
    best: (f64, u32),
    /// Least unevenness of a Laplacian.
    evenest: Option<(f64, Trial)>,
    /// Least leaning of a one-sided derivative.
    leanest: Option<(f64, Trial)>,
    /// Least loudness above 1 of a plain fit.
    quietest: Option<(f64, Trial)>,
}

impl Tried {
    fn new(from: u32) -> Self {
        Self {
            best: (f64::INFINITY, from),
            evenest: None,
            leanest: None,
            quietest: None,
        }
    }
}

impl<const D: usize> Bench<'_, D> {
    /// Weights of `target`, whose support stands in `work`, enlarged `from` times, into `work.fit`
    /// and `work.shares`.
    pub(crate) fn solve(
        &self,
        target: &Target<D>,
        from: u32,
        work: &mut Work<D>,
    ) -> Result<Made, Error> {
        work.conditions.clear();
        if self.plan.interpolating && target.own {
            work.conditions.push(Condition::Value { at: target.place });
        }
        self.rules.conditions(target.row, &mut work.conditions);
        let (mut ready, mut worst) = (true, f64::INFINITY);
        for order in (self.plan.lowest()..=self.plan.order).rev() {
            let mut tried = Tried::new(from);
            let first = First {
                order,
                times: from,
                ready: std::mem::take(&mut ready),
            };
            if let Some(made) = self.climb(target, first, &mut tried, work)? {
                return Ok(made);
            }
            if let Some((lean, trial)) = tried.leanest {
                if let Some(made) = self.leaning_least(target, lean, trial, work)? {
                    return Ok(made);
                }
                continue;
            }
            let fair = Trial {
                order,
                times: tried.best.1,
                limit: FAIR,
                by_room: false,
            };
            let rest = (tried.best.0 <= FAIR).then_some(fair);
            let trial = tried.evenest.map(|e| e.1).or(rest);
            worst = tried.best.0;
            if let Some(made) = self.last(target, order, from, trial, work)? {
                return Ok(made);
            }
        }
        Err(self.refusal(target, work, worst))
    }

    /// A row of an order from the smallest support that is good, even and does not lean; else what was tried is kept.
    fn climb(
        &self,
        target: &Target<D>,
        first: First,
        tried: &mut Tried,
        work: &mut Work<D>,
    ) -> Result<Option<Made>, Error> {
        let First {
            order,
            times: from,
            mut ready,
        } = first;
        let mut size = 0;
        for times in from..=ENLARGEMENTS {
            if !std::mem::take(&mut ready) {
                self.enlarge(target, times, &mut work.support)?;
            }
            let before = std::mem::replace(&mut size, work.support.neighbours.len());
            if size == before {
                continue;
            }
            let trial = Trial {
                order,
                times,
                limit: GOOD[D - 2][usize::from(order) - 1],
                by_room: false,
            };
            if let Some(made) = self.even(target, trial, work, &mut tried.evenest) {
                let loud = self.loud(order, work);
                if loud > 1.0 && times < from + SEARCHES {
                    if tried.quietest.is_none_or(|(least, _)| loud < least) {
                        tried.quietest = Some((loud, trial));
                    }
                    continue;
                }
                if let Some((_, trial)) = tried.quietest.filter(|(least, _)| *least < loud) {
                    self.enlarge(target, trial.times, &mut work.support)?;
                    return Ok(self.attempt(target, trial, work).map(|(made, _)| made));
                }
                let lean = self.leaning(target, order, work);
                if lean <= LEANS {
                    return Ok(Some(made));
                }
                if tried.leanest.is_none_or(|(least, _)| lean < least) {
                    tried.leanest = Some((lean, trial));
                }
                if order == 2 || times >= from + SEARCHES {
                    break;
                }
                continue;
            }
            if tried.evenest.is_some() && times >= from + SEARCHES {
                break;
            }
            if work.fit.condition < tried.best.0 {
                tried.best = (work.fit.condition, times);
            }
        }
        Ok(None)
    }

    /// The row of the support that leans least; none of quadratics, nor one whose own weight has the sign of the others.
    fn leaning_least(
        &self,
        target: &Target<D>,
        lean: f64,
        trial: Trial,
        work: &mut Work<D>,
    ) -> Result<Option<Made>, Error> {
        if trial.order == 2 || lean.is_infinite() {
            return Ok(None);
        }
        self.enlarge(target, trial.times, &mut work.support)?;
        Ok(self.attempt(target, trial, work).map(|(made, _)| made))
    }

    /// A row of an order by what is left to try: the best support found, then singular values of the first.
    fn last(
        &self,
        target: &Target<D>,
        order: u8,
        from: u32,
        trial: Option<Trial>,
        work: &mut Work<D>,
    ) -> Result<Option<Made>, Error> {
        if let Some(trial) = trial {
            self.enlarge(target, trial.times, &mut work.support)?;
            if let Some((made, _)) = self.attempt(target, trial, work)
                && !self.leans(target, order, work)
            {
                return Ok(Some(made));
            }
        }
        self.enlarge(target, from, &mut work.support)?;
        let made = self.by_spectrum(target, order, from, work);
        Ok(made.filter(|_| !self.leans(target, order, work)))
    }

    fn enlarge(
        &self,
        target: &Target<D>,
        times: u32,
        support: &mut Support<D>,
    ) -> Result<(), Error> {
        let reach = self.plan.reach.enlarged(times);
        let allowed = |j| self.rules.allowed(target.row, j);
        self.search.lone_support(target, reach, allowed, support)
    }

    /// A row whose Laplacian is even, points weighing alike or by their room; else the evenest trial is kept.
    fn even(
        &self,
        target: &Target<D>,
        trial: Trial,
        work: &mut Work<D>,
        evenest: &mut Option<(f64, Trial)>,
    ) -> Option<Made> {
        for by_room in [false, true] {
            let trial = Trial { by_room, ..trial };
            let (made, uneven) = self.attempt(target, trial, work)?;
            if uneven <= EVEN {
                return Some(made);
            }
            if evenest.is_none_or(|(least, _)| uneven < least) {
                *evenest = Some((uneven, trial));
            }
        }
        None
    }

    /// A row from one support, and the weights of its Laplacian that have the sign of the own one over that.
    fn attempt(&self, target: &Target<D>, trial: Trial, work: &mut Work<D>) -> Option<(Made, f64)> {
        let Trial {
            order,
            times,
            limit,
            by_room,
        } = trial;
        let basis = self.basis(order, work);
        self.prepare(target, by_room, order, work);
        let known = work.support.offsets.len() + work.condition_rows.len();
        if known < work.fit.many(basis) {
            work.fit.condition = f64::INFINITY;
            return None;
        }
        if !work.fit.factor(basis, limit) {
            return None;
        }
        if !work.fit.solve(basis, &work.functionals) || !tame(target, work) {
            work.fit.condition = f64::INFINITY;
            return None;
        }
        let positive = self.make_positive(target, basis, work);
        let made = Made {
            by_room,
            ..self.made(target, order, times, positive, work)
        };
        Some((made, self.uneven(work)))
    }

    fn by_spectrum(
        &self,
        target: &Target<D>,
        order: u8,
        times: u32,
        work: &mut Work<D>,
    ) -> Option<Made> {
        let basis = self.basis(order, work);
        if work.support.offsets.len() <= D {
            return None;
        }
        self.prepare(target, false, order, work);
        if !work.fit.factor_spectrum(basis) || !work.fit.solve(basis, &work.functionals) {
            return None;
        }
        tame(target, work).then(|| self.made(target, order, times, None, work))
    }

    fn make_positive(
        &self,
        target: &Target<D>,
        basis: &Basis<D>,
        work: &mut Work<D>,
    ) -> Option<bool> {
        let row = self.columns.laplacian.filter(|_| self.plan.positive)?;
        if !self.rules.surrounded(target.row) {
            return None;
        }
        let own = work.support.own?;
        if work.conditions.len() > usize::from(self.plan.interpolating && target.own) {
            return None;
        }
        positive::improve(&mut work.fit, basis, &work.functionals[row], row, own)
    }

    /// Gives the own point what an interpolating fit takes from its condition, and the data of the
    /// others their weights in units of 1 / L per derivative.
    fn made(
        &self,
        target: &Target<D>,
        order: u8,
        times: u32,
        positive: Option<bool>,
        work: &mut Work<D>,
    ) -> Made {
        let (points, count) = (work.support.offsets.len(), work.powers.len());
        let skip = usize::from(self.plan.interpolating && target.own);
        work.shares.clear();
        for f in 0..self.columns.count * usize::from(count > 0) {
            let own = &work.fit.shares[f * count..(f + 1) * count];
            if let (1, Some(place)) = (skip, work.support.own) {
                work.fit.weights[f * points + place] += own[0];
            }
            for (share, power) in own.iter().zip(&work.powers).skip(skip) {
                if let Some(power) = power {
                    work.shares
                        .push(share * target.metric.spacing().powi(*power));
                }
            }
        }
        Made {
            order,
            way: work.fit.way,
            times,
            condition: work.fit.condition,
            positive,
            by_room: false,
        }
    }

    fn refusal(&self, target: &Target<D>, work: &Work<D>, condition: f64) -> Error {
        let found = work.support.neighbours.len();
        let lowest = self.plan.lowest();
        let needed = terms::<D>(lowest).saturating_sub(work.condition_rows.len());
        if found < needed.max(D + 1) {
            return Error::Lone {
                point: target.row,
                place: target.place.to_vec(),
                found,
                needed,
                radius: target.metric.reach(work.support.radius),
            };
        }
        Error::Flat {
            point: target.row,
            place: target.place.to_vec(),
            found,
            order: lowest,
            condition,
        }
    }
}
