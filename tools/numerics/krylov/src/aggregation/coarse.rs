//! From a matrix to the next coarser one: each group of rows becomes one row, the sum of theirs.

use super::rows::{Balance, Rows, blocks};
use crate::Error;
use crate::grouping::{Grouping, NONE};

/// Groups that one task restricts.
const GROUPS: usize = 4096;

/// Part of the diagonal that the excess of a row in no group must keep: a little less than what
/// keeps a row out of all groups.
const STRONG: f64 = 0.2;
/// One in so many rows of weak diagonal and no group is too many.
const FEW: usize = 100;

/// Which rows form which group, and memory for [`Self::sum`].
#[derive(Debug, Clone, Default)]
pub(crate) struct Groups {
    rows: Grouping,
    /// Where the entry of each group stands, and the entries of a row.
    slot: Vec<u32>,
    entries: Vec<(u32, f64)>,
}

impl Groups {
    pub(crate) fn new(of: Vec<u32>, count: usize) -> Self {
        Self {
            rows: Grouping::new(of, count),
            slot: vec![NONE; count],
            entries: Vec::new(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn bytes(&self) -> usize {
        self.rows.bytes() + 4 * self.slot.capacity()
    }

    /// Are there many rows in no group whose diagonal is no longer strong?
    pub(crate) fn outgrown(&self, balance: &Balance) -> bool {
        let rows = self
            .rows
            .of
            .iter()
            .zip(&balance.excess)
            .zip(&balance.diagonal);
        let weak = rows.filter(|((g, e), d)| **g == NONE && **e < STRONG * **d);
        weak.count() > self.rows.of.len() / FEW
    }

    /// Sums over groups.
    pub(crate) fn restrict(&self, x: &[f64], out: &mut [f64]) {
        blocks(out, GROUPS, |first, out| {
            for (k, out) in out.iter_mut().enumerate() {
                let members = self.rows.members(first + k);
                *out = members.iter().map(|i| x[*i as usize]).sum();
            }
        });
    }

    /// Adds the correction of each group to its rows.
    pub(crate) fn prolong(&self, correction: &[f64], x: &mut [f64]) {
        blocks(x, 4 * GROUPS, |first, x| {
            for (x, &g) in x.iter_mut().zip(&self.rows.of[first..]) {
                if g != NONE {
                    *x += correction[g as usize];
                }
            }
        });
    }

    /// Sums the rows of each group into `coarse`. Couplings to rows in no group stay in the
    /// diagonal, as those to fixed values do.
    pub(crate) fn sum(
        &mut self,
        rows: &Rows,
        balance: &Balance,
        coarse: &mut Rows,
        sums: &mut Balance,
    ) -> Result<(), Error> {
        coarse.clear();
        sums.clear();
        let mut slot = std::mem::take(&mut self.slot);
        let mut entries = std::mem::take(&mut self.entries);
        for g in 0..self.len() {
            entries.clear();
            let mut excess = 0.0;
            for &i in self.rows.members(g) {
                excess += balance.excess[i as usize];
                for &(j, w) in rows.row(i as usize) {
                    let (other, w) = (self.rows.of[j as usize], f64::from(w));
                    if other == NONE {
                        excess += w;
                    } else if other as usize != g {
                        let at = &mut slot[other as usize];
                        if *at == NONE {
                            *at = entries.len() as u32;
                            entries.push((other, w));
                        } else {
                            entries[*at as usize].1 += w;
                        }
                    }
                }
            }
            for (other, _) in &entries {
                slot[*other as usize] = NONE;
            }
            let leader = balance.leader[self.rows.members(g)[0] as usize];
            let diagonal = excess + coarse.push(entries.iter().copied());
            if diagonal.is_nan() || diagonal <= 0.0 {
                let index = leader as usize;
                (self.slot, self.entries) = (slot, entries);
                return Err(Error::Singular { index });
            }
            coarse.close(diagonal);
            sums.push(diagonal, excess, leader);
        }
        (self.slot, self.entries) = (slot, entries);
        Ok(())
    }
}
