//! Points already placed, found by place while more are added.

use shapes::frame::{Vector, difference, dot};

/// A growing set of points in cells of one size, hashed.
#[derive(Debug, Clone)]
pub(crate) struct Occupied {
    edge: f64,
    heads: Vec<u32>,
    next: Vec<u32>,
    place: Vec<Vector>,
}

const NONE: u32 = u32::MAX;

impl Occupied {
    /// An empty set whose searches have about the radius `edge` \[m\].
    pub(crate) fn new(edge: f64) -> Self {
        Self {
            edge,
            heads: vec![NONE; 1 << 10],
            next: Vec::new(),
            place: Vec::new(),
        }
    }

    fn cell(&self, x: Vector) -> [i64; 3] {
        x.map(|c| (c / self.edge).floor() as i64)
    }

    fn slot(&self, cell: [i64; 3]) -> usize {
        const PRIMES: [u64; 3] = [
            0x9E37_79B9_7F4A_7C15,
            0xC2B2_AE3D_27D4_EB4F,
            0x1656_67B1_9E37_79F9,
        ];
        let mixed = (0..3).fold(0_u64, |h, k| {
            (h ^ (cell[k] as u64).wrapping_mul(PRIMES[k])).rotate_left(23)
        });
        (mixed.wrapping_mul(PRIMES[0]) >> 32) as usize & (self.heads.len() - 1)
    }

    /// Adds a point; points are numbered as they come.
    pub(crate) fn push(&mut self, x: Vector) {
        if self.place.len() >= self.heads.len() {
            self.heads = vec![NONE; 4 * self.heads.len()];
            for k in 0..self.place.len() {
                self.link(k);
            }
        }
        self.place.push(x);
        self.next.push(NONE);
        self.link(self.place.len() - 1);
    }

    fn link(&mut self, k: usize) {
        let slot = self.slot(self.cell(self.place[k]));
        self.next[k] = self.heads[slot];
        self.heads[slot] = k as u32;
    }

    /// Calls `stop` with number, offset from `x` and squared distance of each point within `radius`, until it says
    /// true; tells whether it did.
    pub(crate) fn any(
        &self,
        x: Vector,
        radius: f64,
        mut stop: impl FnMut(u32, Vector, f64) -> bool,
    ) -> bool {
        let (low, high) = (x.map(|c| c - radius), x.map(|c| c + radius));
        let (low, high) = (self.cell(low), self.cell(high));
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                for k in low[2]..=high[2] {
                    let mut at = self.heads[self.slot([i, j, k])];
                    while at != NONE {
                        let place = self.place[at as usize];
                        let away = difference(place, x);
                        let square = dot(away, away);
                        if square <= radius * radius
                            && self.cell(place) == [i, j, k]
                            && stop(at, away, square)
                        {
                            return true;
                        }
                        at = self.next[at as usize];
                    }
                }
            }
        }
        false
    }

    /// The nearest point within `radius`; of two at the same distance the one that came first.
    pub(crate) fn nearest(&self, x: Vector, radius: f64) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        self.any(x, radius, |k, _, square| {
            if best.is_none_or(|b| (square, k) < b) {
                best = Some((square, k));
            }
            false
        });
        best.map(|b| b.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_a_naive_search_finds() {
        let mut set = Occupied::new(0.3);
        let mut state = 1_u64;
        let mut draw = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as f64 / f64::from(1_u32 << 31) * 4.0 - 2.0
        };
        let points: Vec<Vector> = (0..3000).map(|_| [draw(), draw(), draw()]).collect();
        for x in &points {
            set.push(*x);
        }
        for _ in 0..200 {
            let x = [draw(), draw(), draw()];
            let mut found = Vec::new();
            set.any(x, 0.37, |k, _, _| {
                found.push(k);
                false
            });
            found.sort_unstable();
            let naive: Vec<u32> = (0..3000_u32)
                .filter(|k| {
                    let d = difference(points[*k as usize], x);
                    dot(d, d) <= 0.37 * 0.37
                })
                .collect();
            assert_eq!(found, naive);
        }
    }
}
