//! Which rows are joined to one row of the next coarser matrix.
//!
//! Pairs of pairs are formed greedily, the best partner first, and kept only if their quality
//! bounds what smoothing leaves to the coarse matrix (Napov and Notay 2012, SIAM J. Sci. Comput.
//! 34, A1079, algorithms 4.2 and 4.3; Notay 2012, the same, A2288 for unsymmetric matrices, where
//! the symmetric part is looked at).

use super::quality::Candidate;
use super::view::View;
use crate::grouping::NONE;

/// Worst quality of a group in a narrow stencil.
const QUALITY: f64 = 8.0;
/// Worst quality of a group per effective neighbour: the bound leaves out the couplings to rows
/// outside a group, which matter the more the more neighbours a row has.
const QUALITY_PER_NEIGHBOUR: f64 = 2.0;
/// Partners whose quality is tried.
const TRIES: usize = 3;
/// Passes: groups of at most 2^PASSES rows.
const PASSES: usize = 3;
/// A share of groups per row above which groups are joined whatever their quality.
const STALLED: f64 = 0.75;

/// The group of each row, [`NONE`] for rows that smoothing alone solves, and the number of groups.
pub(crate) fn form(view: View<'_>) -> (Vec<u32>, usize) {
    let mut joining = Joining::new(view);
    joining.join();
    (joining.of, joining.count)
}

/// Groups while they grow.
struct Joining<'a> {
    view: View<'a>,
    /// Effective neighbours of each row.
    wide: Vec<f32>,
    /// Group of each row.
    of: Vec<u32>,
    count: usize,
    /// Members of group `g`: `members[g * stride..]`, filled up with [`NONE`].
    members: Vec<u32>,
    stride: usize,
    /// Diagonal and excess of each group as one row.
    sums: Vec<[f64; 2]>,
    /// Join whatever is coupled.
    any: bool,
}

/// A possible partner: its group and the coupling.
type Partner = (u32, f64);

impl<'a> Joining<'a> {
    fn new(view: View<'a>) -> Self {
        let n = view.len();
        let mut new = Self {
            view,
            wide: Vec::with_capacity(n),
            of: vec![NONE; n],
            count: 0,
            members: Vec::with_capacity(n),
            stride: 1,
            sums: Vec::with_capacity(n),
            any: false,
        };
        for i in 0..n {
            let (mut sum, mut squares) = (0.0, 0.0);
            for (_, w) in view.row(i) {
                let w = w.max(0.0);
                sum += w;
                squares += w * w;
            }
            let wide = sum * sum / f64::max(squares, f64::MIN_POSITIVE);
            new.wide.push(wide as f32);
            // Smoothing alone solves a row of strong diagonal.
            if view.diagonal(i) < QUALITY / (QUALITY - 2.0) * sum {
                new.add(i);
            }
        }
        new
    }

    /// A group of one row.
    fn add(&mut self, i: usize) {
        self.of[i] = self.count as u32;
        self.count += 1;
        self.members.push(i as u32);
        let sums = [self.view.diagonal(i), self.view.excess(i)];
        self.sums.push(sums);
    }

    fn join(&mut self) {
        let active = self.count;
        for pass in 0..PASSES {
            self.pass(pass == 0);
        }
        if self.count as f64 <= STALLED * active as f64 {
            return;
        }
        // Once more, whatever the quality.
        (self.count, self.stride, self.any) = (0, 1, true);
        self.members.clear();
        self.sums.clear();
        for i in 0..self.of.len() {
            if self.of[i] != NONE {
                self.add(i);
            }
        }
        self.pass(true);
        self.adopt();
    }

    fn group(&self, g: usize) -> impl Iterator<Item = u32> {
        let members = &self.members[g * self.stride..(g + 1) * self.stride];
        members.iter().copied().take_while(|m| *m != NONE)
    }

    /// Joins groups in pairs.
    fn pass(&mut self, rows: bool) {
        let mut joined = vec![NONE; self.count];
        let mut slot = vec![NONE; if rows { 0 } else { self.count }];
        let (mut members, mut sums) = (Vec::with_capacity(self.members.len()), Vec::new());
        let mut partners: Vec<Partner> = Vec::new();
        for g in 0..self.count {
            if joined[g] != NONE {
                continue;
            }
            partners.clear();
            if rows {
                self.near_row(g, &joined, &mut partners);
            } else {
                self.near_group(g, &joined, &mut slot, &mut partners);
            }
            let found = self.best(g, &mut partners);
            joined[g] = sums.len() as u32;
            let end = members.len() + 2 * self.stride;
            members.extend(self.group(g));
            let mut sum = self.sums[g];
            if let Some((other, w)) = found {
                joined[other as usize] = joined[g];
                members.extend(self.group(other as usize));
                let [diagonal, excess] = self.sums[other as usize];
                sum = [sum[0] + diagonal - 2.0 * w, sum[1] + excess];
            }
            members.resize(end, NONE);
            sums.push(sum);
        }
        for of in &mut self.of {
            if *of != NONE {
                *of = joined[*of as usize];
            }
        }
        self.stride *= 2;
        self.count = sums.len();
        (self.members, self.sums) = (members, sums);
    }

    /// Partners of a group of one row.
    fn near_row(&self, g: usize, joined: &[u32], partners: &mut Vec<Partner>) {
        for (j, w) in self.view.row(self.members[g] as usize) {
            let other = self.of[j as usize];
            if other != NONE && joined[other as usize] == NONE && w > 0.0 {
                partners.push((other, w));
            }
        }
    }

    /// Partners of a group of rows, and the sums of couplings.
    fn near_group(&self, g: usize, joined: &[u32], slot: &mut [u32], partners: &mut Vec<Partner>) {
        for i in self.group(g) {
            for (j, w) in self.view.row(i as usize) {
                let other = self.of[j as usize];
                if other == NONE || other as usize == g || joined[other as usize] != NONE {
                    continue;
                }
                let at = &mut slot[other as usize];
                if *at == NONE {
                    *at = partners.len() as u32;
                    partners.push((other, w));
                } else {
                    partners[*at as usize].1 += w;
                }
            }
        }
        for (other, _) in partners.iter() {
            slot[*other as usize] = NONE;
        }
    }

    /// The best partner of good quality.
    fn best(&self, g: usize, partners: &mut Vec<Partner>) -> Option<Partner> {
        for _ in 0..TRIES {
            let (mut best, mut place) = (0.0, None);
            for (k, &(other, w)) in partners.iter().enumerate() {
                let value = self.value(g, other as usize, w);
                if value > best {
                    (best, place) = (value, Some(k));
                }
            }
            let partner = partners.swap_remove(place?);
            if self.any || self.good(g, partner.0, best) {
                return Some(partner);
            }
            if self.stride == 1 {
                return None;
            }
        }
        None
    }

    /// Twice the inverse of the quality of a pair of rows.
    fn value(&self, g: usize, other: usize, w: f64) -> f64 {
        let ([d0, e0], [d1, e1]) = (self.sums[g], self.sums[other]);
        let tie = if e0 > 0.0 && e1 > 0.0 {
            e0 * e1 / (e0 + e1)
        } else {
            0.0
        };
        (w + tie) * (d0 + d1) / (d0 * d1).max(f64::MIN_POSITIVE)
    }

    /// Is the quality of two groups as one good enough?
    fn good(&self, g: usize, other: u32, value: f64) -> bool {
        let nodes = || self.group(g).chain(self.group(other as usize));
        let wide = nodes()
            .map(|i| f64::from(self.wide[i as usize]))
            .fold(f64::INFINITY, f64::min);
        let limit = QUALITY.max(QUALITY_PER_NEIGHBOUR * wide);
        if self.stride == 1 {
            return 2.0 <= limit * value;
        }
        let inside = |j: u32| {
            let of = self.of[j as usize];
            of == g as u32 || of == other
        };
        Candidate::new(nodes()).within(self.view, inside, limit)
    }

    /// Rows that are alone join the group of their strongest neighbour.
    fn adopt(&mut self) {
        let mut size = vec![0_u32; self.count];
        for &of in self.of.iter().filter(|of| **of != NONE) {
            size[of as usize] += 1;
        }
        for i in 0..self.of.len() {
            let own = self.of[i];
            if own == NONE || size[own as usize] != 1 {
                continue;
            }
            let (mut most, mut to) = (0.0, NONE);
            for (j, w) in self.view.row(i) {
                if w > most && self.of[j as usize] != NONE {
                    (most, to) = (w, self.of[j as usize]);
                }
            }
            if to != NONE {
                self.of[i] = to;
                size[own as usize] = 0;
                size[to as usize] += 1;
            }
        }
        let mut number = vec![NONE; self.count];
        self.count = 0;
        for of in self.of.iter_mut().filter(|of| **of != NONE) {
            let new = &mut number[*of as usize];
            if *new == NONE {
                *new = self.count as u32;
                self.count += 1;
            }
            *of = *new;
        }
    }
}
