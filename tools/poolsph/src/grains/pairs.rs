//! Contacts of grains: each reckoned once, then gathered by every grain.

use contact::{Contact, Grain, History, Meeting, Normal, Reply, Rolling};
use rayon::prelude::*;
use shapes::frame::Vector;

use super::lists::{Action, Chunk, Lists, Pair, ROWS, Touch};

/// Reckons all contacts after a step of `step` \[s\].
pub fn act<N: Normal + Copy + Sync>(
    lists: &mut Lists,
    grains: &[Grain],
    (contact, rolling): (&Contact<N>, Option<Rolling>),
    step: f64,
) {
    let chunks = lists.chunks.par_iter_mut().enumerate();
    chunks.for_each(|(c, chunk)| {
        let work = Work {
            grains,
            contact,
            first: c * ROWS,
            step,
        };
        match rolling {
            None => work.each(chunk, |meeting, pair, _, step| {
                contact.act(meeting, &mut pair.history, step)
            }),
            Some(rolling) => work.each(chunk, |meeting, pair, rolled, step| {
                contact.act_rolling(meeting, rolling, (&mut pair.history, rolled), step)
            }),
        }
    });
}

/// What the contacts of a chunk are reckoned from.
struct Work<'a, N> {
    grains: &'a [Grain],
    contact: &'a Contact<N>,
    first: usize,
    step: f64,
}

impl<N: Normal> Work<'_, N> {
    #[inline(always)]
    fn each(
        &self,
        chunk: &mut Chunk,
        reply: impl Fn(&Meeting, &mut Pair, &mut Vector, f64) -> Reply,
    ) {
        let mut deepest = 0.0_f64;
        let mut still = [0.0; 3];
        for k in 0..chunk.rows() {
            let a = &self.grains[self.first + k];
            for place in chunk.row(k) {
                let pair = &mut chunk.pairs[place];
                let b = &self.grains[pair.other as usize];
                let Some(meeting) = Meeting::of(a, b) else {
                    if pair.state != Touch::Apart {
                        let rolled = chunk.rolled.get_mut(place);
                        chunk.actions[place] = self.part((a, b), pair, rolled);
                    }
                    continue;
                };
                deepest = deepest.max(meeting.overlap);
                let (meeting, step) = if pair.state == Touch::Touching {
                    (meeting, self.step)
                } else {
                    meeting.begun(self.step)
                };
                pair.state = Touch::Touching;
                let rolled = chunk.rolled.get_mut(place).unwrap_or(&mut still);
                let reply = reply(&meeting, pair, rolled, step);
                chunk.actions[place] = Action {
                    force: reply.force,
                    moment: reply.moment,
                    moment_on_other: reply.moment_on_b,
                };
            }
        }
        chunk.deepest = deepest;
    }

    /// The last that a contact does.
    #[cold]
    fn part(
        &self,
        (a, b): (&Grain, &Grain),
        pair: &mut Pair,
        rolled: Option<&mut Vector>,
    ) -> Action {
        let pulls = pair.state == Touch::Touching && self.contact.normal.pulls_at_the_end();
        pair.history = History::default();
        if let Some(rolled) = rolled {
            *rolled = [0.0; 3];
        }
        let parted = if pulls { Meeting::parted(a, b) } else { None };
        let Some(meeting) = parted else {
            pair.state = Touch::Apart;
            return Action::default();
        };
        let meeting = meeting.ended(self.step);
        pair.state = Touch::Parting;
        let push = self.contact.normal.push(&meeting);
        Action {
            force: meeting.normal.map(|n| push * n),
            ..Action::default()
        }
    }
}

/// Gives every grain the force \[N\] and the moment \[N m\] of its contacts with other grains.
pub fn gather(lists: &Lists, force: &mut [Vector], moment: &mut [Vector]) {
    let forces = force.par_chunks_mut(ROWS).zip(moment.par_chunks_mut(ROWS));
    let chunks = lists.chunks.par_iter().zip(forces);
    chunks.for_each(|(chunk, (forces, moments))| {
        for (k, (force, moment)) in forces.iter_mut().zip(moments).enumerate() {
            let (mut f, mut m) = ([0.0; 3], [0.0; 3]);
            for &[from, place] in chunk.incoming(k) {
                let from = &lists.chunks[from as usize];
                if from.pairs[place as usize].state != Touch::Apart {
                    let action = &from.actions[place as usize];
                    for i in 0..3 {
                        f[i] -= action.force[i];
                        m[i] += action.moment_on_other[i];
                    }
                }
            }
            for place in chunk.row(k) {
                if chunk.pairs[place].state != Touch::Apart {
                    let action = &chunk.actions[place];
                    for i in 0..3 {
                        f[i] += action.force[i];
                        m[i] += action.moment[i];
                    }
                }
            }
            (*force, *moment) = (f, m);
        }
    });
}
