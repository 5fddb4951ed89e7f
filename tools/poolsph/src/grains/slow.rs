//! Heat of what sleeps goes in longer steps.
//!
//! Grains that sleep deep lie far from what is hot: heat between two of them, and from metal into one of them, goes once
//! in a number of steps, over the time of all of these. Who takes part in it is settled for all of this time, so that each
//! contact conducts over all of it, whoever wakes or falls asleep meanwhile. What one grain gets the other gives, either way.

use particles::Column;

use super::lists::{Lists, ROWS};

/// 1 where a grain takes part in the long steps.
pub const SLOW: Column<u8> = Column::new("slow", "1", 0).saved();

/// Which contacts conduct in a pass over them.
#[derive(Debug, Clone, Copy)]
pub(super) enum Pass<'a> {
    /// All.
    Every,
    /// Those of which one grain at least is not slow.
    Quick(&'a [u8]),
    /// The others.
    Slow(&'a [u8]),
}

impl Pass<'_> {
    /// Whether a contact of the grains a and b conducts now.
    #[inline]
    pub(super) fn takes(self, a: usize, b: usize) -> bool {
        match self {
            Self::Every => true,
            Self::Quick(slow) => slow[a] & slow[b] == 0,
            Self::Slow(slow) => slow[a] & slow[b] == 1,
        }
    }

    /// Whether light falls in it.
    pub(super) fn shines(self) -> bool {
        !matches!(self, Self::Slow(_))
    }

    /// Whether a contact of the grain a with metal does.
    #[inline]
    pub(super) fn takes_alone(self, a: usize) -> bool {
        self.takes(a, a)
    }
}

/// Chunks of rows with contacts that conduct, and those whose grains get heat.
#[derive(Debug, Clone, Default)]
pub(super) struct Busy {
    /// By chunks of the lower row.
    pub(super) conduct: Vec<bool>,
    /// By chunks of either.
    pub(super) get: Vec<bool>,
}

impl Busy {
    /// Those of a pass, and those of `rows` that get heat elsewhere.
    pub(super) fn find(&mut self, lists: &Lists, pass: Pass<'_>, rows: impl Iterator<Item = u32>) {
        let all = matches!(pass, Pass::Every);
        self.conduct.clear();
        self.get.clear();
        self.get.resize(lists.chunks.len(), all);
        for (c, chunk) in lists.chunks.iter().enumerate() {
            let pairs = chunk.pairs.iter();
            let takes = |(a, b): (usize, usize)| pass.takes(c * ROWS + a, b);
            let busy = all
                || pairs
                    .clone()
                    .any(|pair| takes((pair.own as usize, pair.other as usize)));
            self.conduct.push(busy);
            if busy && !all {
                self.get[c] = true;
                for pair in &chunk.pairs[chunk.inner..] {
                    self.get[pair.other as usize / ROWS] = true;
                }
            }
        }
        rows.for_each(|row| self.get[row as usize / ROWS] = true);
    }
}

/// Long steps of heat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Long {
    /// Steps of the scene's length in one.
    pub(super) interval: u64,
    /// Time since the last \[s\].
    pub(super) waited: f64,
}

impl Long {
    /// Whether one ends with the step that follows `step` others and holds `stride` of them.
    pub(super) fn due(self, step: u64, stride: u64) -> bool {
        (step + stride) / self.interval > step / self.interval
    }
}
