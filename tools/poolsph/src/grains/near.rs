//! A contact of a grain with a wall or with a particle of metal.

use contact::{Contact, History, Meeting, Normal, Reply, Rolling};
use shapes::frame::Vector;

use super::memory::Memory;

/// Contacts that a thread takes at least: to share fewer costs more than it saves.
pub(super) const AT_LEAST: usize = 512;

/// A grain near a face, or near a particle of metal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near {
    pub(super) row: u32,
    pub(super) touching: bool,
    pub(super) history: History,
    pub(super) rolled: Vector,
    pub(super) reply: Option<Reply>,
    pub(super) overlap: f64,
}

impl Near {
    /// A grain that touches nothing yet.
    pub(super) fn new(row: u32) -> Self {
        Self {
            row,
            touching: false,
            history: History::default(),
            rolled: [0.0; 3],
            reply: None,
            overlap: 0.0,
        }
    }

    /// Goes on with a contact of an earlier list.
    pub(super) fn remember(&mut self, memory: &Memory) {
        (self.touching, self.history) = (true, memory.history);
        self.rolled = memory.rolled;
    }

    /// The contact as a memory, if it touches; `other` is who it touches.
    pub(super) fn memory(&self, other: u32) -> Option<Memory> {
        self.touching.then_some(Memory {
            row: self.row,
            other,
            history: self.history,
            rolled: self.rolled,
        })
    }

    pub(super) fn meet<N: Normal>(
        &mut self,
        meeting: Meeting,
        contact: &Contact<N>,
        rolling: Option<Rolling>,
        step: f64,
    ) {
        self.overlap = meeting.overlap;
        if meeting.overlap <= 0.0 {
            self.part(meeting, contact, step);
            return;
        }
        let (meeting, step) = if self.touching {
            (meeting, step)
        } else {
            meeting.begun(step)
        };
        self.touching = true;
        let history = &mut self.history;
        self.reply = Some(match rolling {
            None => contact.act(&meeting, history, step),
            Some(rolling) => {
                contact.act_rolling(&meeting, rolling, history, &mut self.rolled, step)
            }
        });
    }

    fn part<N: Normal>(&mut self, meeting: Meeting, contact: &Contact<N>, step: f64) {
        if !self.touching && self.reply.is_none() {
            return;
        }
        let pulls = self.touching && contact.normal.pulls_at_the_end();
        self.reply = pulls.then(|| {
            let push = contact.normal.push(&meeting.ended(step));
            Reply {
                force: meeting.normal.map(|n| push * n),
                friction: [0.0; 3],
                moment: [0.0; 3],
                moment_on_b: [0.0; 3],
                push,
            }
        });
        self.touching = false;
        self.history = History::default();
        self.rolled = [0.0; 3];
    }
}
