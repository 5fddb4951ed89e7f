//! The order of unknowns: reverse Cuthill-McKee, cut into slabs that do not touch.

use crate::Rows;
use rayon::prelude::*;
use std::ops::Range;

/// Fewest rows of a slab.
const LEAST: usize = 4096;
/// Most slabs.
const MOST: usize = 16;

/// A permutation of unknowns, and the slabs it makes.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Order {
    old: Vec<u32>,
    new: Vec<u32>,
    slabs: Slabs,
}

/// Ranges of rows. No slab touches another; no wall touches another. Slabs come first, walls last.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Slabs {
    pub(crate) slabs: Vec<Range<usize>>,
    pub(crate) walls: Vec<Range<usize>>,
}

impl Order {
    /// New place `k` is taken by the unknown `old[k]`; one slab.
    ///
    /// # Panics
    /// When `old` is no permutation.
    #[must_use]
    pub fn from_old(old: Vec<u32>) -> Self {
        let mut new = vec![u32::MAX; old.len()];
        for (k, &i) in old.iter().enumerate() {
            assert!(
                new.get(i as usize) == Some(&u32::MAX),
                "unknown {i} twice or beyond {}",
                old.len()
            );
            new[i as usize] = k as u32;
        }
        let slabs = Slabs {
            slabs: std::iter::once(0..old.len()).collect(),
            walls: Vec::new(),
        };
        Self { old, new, slabs }
    }

    /// The order as it is.
    #[must_use]
    pub fn natural(n: usize) -> Self {
        Self::from_old((0..n as u32).collect())
    }

    /// Reverse Cuthill-McKee of the pattern of `a` and its transpose (Cuthill and McKee 1969;
    /// George 1971), the start being a point farthest from another. Whole levels of the search that
    /// are far from each other become walls: what lies between them does not touch, so that slabs
    /// can be eliminated side by side. The number of slabs depends on the matrix alone.
    #[must_use]
    pub fn cuthill_mckee<T: Copy + Sync>(a: &Rows<T>) -> Self {
        let graph = Graph::of(a);
        let mut search = Search::new(&graph);
        search.run();
        let levels = &search.levels;
        let n = a.len();
        let wanted = (n / LEAST).clamp(1, MOST);
        let mut walls = Vec::new();
        let mut next = n / wanted;
        for pair in levels.windows(2).skip(1) {
            let (begin, end) = (pair[0], pair[1]);
            let last = walls.last().map_or(0, |w: &Range<usize>| w.end);
            // A wall wider than its slab, or next to another wall, is worth nothing.
            if end >= next && begin > last && end < n && 2 * (end - begin) < begin - last {
                walls.push(begin..end);
                next = end + n / wanted;
            }
        }
        search.arranged(&walls)
    }

    /// Unknown at the new place `k`.
    #[must_use]
    pub fn old_of(&self, k: usize) -> usize {
        self.old[k] as usize
    }

    /// New place of the unknown `i`.
    #[must_use]
    pub fn new_of(&self, i: usize) -> usize {
        self.new[i] as usize
    }

    /// Number of unknowns.
    #[must_use]
    pub fn len(&self) -> usize {
        self.old.len()
    }

    /// No unknowns.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.old.is_empty()
    }

    pub(crate) fn slabs(&self) -> &Slabs {
        &self.slabs
    }

    /// From the old order to the new.
    pub fn forth<X: Copy + Send + Sync>(&self, old: &[X], new: &mut [X]) {
        new.par_iter_mut()
            .with_min_len(8192)
            .zip(&self.old)
            .for_each(|(new, i)| *new = old[*i as usize]);
    }

    /// From the new order to the old.
    pub fn back<X: Copy + Send + Sync>(&self, new: &[X], old: &mut [X]) {
        old.par_iter_mut()
            .with_min_len(8192)
            .zip(&self.new)
            .for_each(|(old, k)| *old = new[*k as usize]);
    }
}

/// Neighbours of each unknown in the pattern of `A + A^T`, without itself.
struct Graph {
    starts: Vec<usize>,
    ends: Vec<u32>,
}

impl Graph {
    fn of<T: Copy + Sync>(a: &Rows<T>) -> Self {
        let n = a.len();
        let lacking = |i: usize, j: u32| a.columns(j as usize).binary_search(&(i as u32)).is_err();
        let mut starts = vec![0; n + 1];
        let mut missing: Vec<(u32, u32)> = (0..n)
            .into_par_iter()
            .with_min_len(4096)
            .flat_map_iter(|i| {
                let columns = a.columns(i).iter();
                columns
                    .filter(move |j| lacking(i, **j))
                    .map(move |j| (*j, i as u32))
            })
            .collect();
        missing.par_sort_unstable();
        let mut rest = missing.as_slice();
        let mut ends = Vec::with_capacity(a.entries() + missing.len());
        for i in 0..n {
            ends.extend(a.columns(i).iter().filter(|j| **j as usize != i));
            let here = rest.iter().take_while(|m| m.0 as usize == i).count();
            ends.extend(rest[..here].iter().map(|m| m.1));
            rest = &rest[here..];
            starts[i + 1] = ends.len();
        }
        Self { starts, ends }
    }

    fn of_point(&self, i: u32) -> &[u32] {
        &self.ends[self.starts[i as usize]..self.starts[i as usize + 1]]
    }
}

/// Breadth-first search, part by part.
struct Search<'a> {
    graph: &'a Graph,
    seen: Vec<bool>,
    /// Unknowns in the order found.
    found: Vec<u32>,
    /// Begin of each level in `found`, and the end of the last.
    levels: Vec<usize>,
}

impl<'a> Search<'a> {
    fn new(graph: &'a Graph) -> Self {
        let n = graph.starts.len() - 1;
        Self {
            graph,
            seen: vec![false; n],
            found: Vec::with_capacity(n),
            levels: vec![0],
        }
    }

    fn run(&mut self) {
        for i in 0..self.seen.len() {
            if !self.seen[i] {
                let start = self.far(i as u32);
                self.part(start);
            }
        }
    }

    /// Searches from `start`, level by level, points of few neighbours first.
    fn part(&mut self, start: u32) {
        self.seen[start as usize] = true;
        self.found.push(start);
        let mut begin = self.found.len() - 1;
        while begin < self.found.len() {
            let end = self.found.len();
            if end > self.levels[self.levels.len() - 1] {
                self.levels.push(end);
            }
            for k in begin..end {
                let from = self.found.len();
                for &j in self.graph.of_point(self.found[k]) {
                    if !self.seen[j as usize] {
                        self.seen[j as usize] = true;
                        self.found.push(j);
                    }
                }
                let graph = self.graph;
                self.found[from..].sort_by_key(|j| graph.of_point(*j).len());
            }
            begin = end;
        }
    }

    /// A point far from others in the part of `i`: the last that a search finds, twice.
    fn far(&mut self, i: u32) -> u32 {
        let (found, levels) = (self.found.len(), self.levels.len());
        let mut start = i;
        for _ in 0..2 {
            self.part(start);
            start = self.found[self.found.len() - 1];
            for j in self.found.drain(found..) {
                self.seen[j as usize] = false;
            }
            self.levels.truncate(levels);
        }
        start
    }

    /// Slabs in reverse, then the walls in reverse.
    fn arranged(&self, walls: &[Range<usize>]) -> Order {
        let n = self.found.len();
        let mut slabs = Vec::new();
        let mut begin = 0;
        for wall in walls {
            slabs.push(begin..wall.start);
            begin = wall.end;
        }
        slabs.push(begin..n);
        let mut old = Vec::with_capacity(n);
        let mut place = |ranges: &[Range<usize>]| -> Vec<Range<usize>> {
            let mut placed = Vec::new();
            for range in ranges {
                let from = old.len();
                old.extend(self.found[range.clone()].iter().rev());
                placed.push(from..old.len());
            }
            placed
        };
        let slabs = Slabs {
            slabs: place(&slabs),
            walls: place(walls),
        };
        Order {
            slabs,
            ..Order::from_old(old)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(n: usize) -> Rows<f64> {
        Rows::gathered(n * n * n, 1.0, |i, row| {
            let at = [i % n, i / n % n, i / n / n];
            for (d, step) in [1, n, n * n].into_iter().enumerate() {
                if at[d] > 0 {
                    row.push(((i - step) as u32, -1.0));
                }
                // One way only, at times: the order looks at the transpose too.
                if at[d] + 1 < n && i % 7 != 0 {
                    row.push(((i + step) as u32, -1.0));
                }
            }
        })
    }

    #[test]
    fn slabs_and_walls_do_not_touch() {
        let a = lattice(32);
        let order = Order::cuthill_mckee(&a);
        let b = a.permuted(&order);
        let slabs = order.slabs();
        assert!(slabs.slabs.len() > 4 && slabs.walls.len() == slabs.slabs.len() - 1);
        let mut zone = vec![usize::MAX; b.len()];
        for (k, range) in slabs.slabs.iter().chain(&slabs.walls).enumerate() {
            zone[range.clone()].fill(k);
        }
        let count = slabs.slabs.len();
        for i in 0..b.len() {
            for (j, _) in b.pairs(i) {
                let (p, q) = (zone[i], zone[j]);
                assert!(p == q || (p < count) != (q < count), "{p} touches {q}");
            }
        }
    }

    #[test]
    fn parts_that_do_not_hang_together_are_all_found() {
        let a = Rows::gathered(10, 1.0, |i, row| row.push(((i ^ 1) as u32, 1.0)));
        let order = Order::cuthill_mckee(&a);
        let mut old: Vec<usize> = (0..10).map(|k| order.old_of(k)).collect();
        old.sort_unstable();
        assert_eq!(old, (0..10).collect::<Vec<_>>());
    }
}
