//! What has to be listed again: only chunks near grains that have moved.
//!
//! The pairs of a chunk are those of the places that its grains were listed at. Where neither a grain of its own nor any within reach, at the
//! place where it was listed or at the one where it is, has moved since, a new list would be the old one. So what sleeps is
//! not listed again, and the lists are the same as if it were.

use contact::Grain;
use neighbours::Halo;
use rayon::prelude::*;
use shapes::frame::Vector;

/// Finds who has moved.
#[derive(Debug, Clone, Default)]
pub struct Again {
    halo: Option<Halo>,
    places: Vec<Vector>,
    /// By chunks: whether no grain of its own has moved.
    pub still: Vec<bool>,
    /// By chunks: whether its pairs stay.
    pub stay: Vec<bool>,
}

impl Again {
    /// Everything is listed again.
    pub fn all(&mut self) {
        self.still.clear();
        self.stay.clear();
    }

    /// Finds the chunks of `rows` whose pairs stay, of `grains` that were `listed` \[m\]; `reach` is that of a pair \[m\].
    pub fn find(&mut self, grains: &[Grain], listed: &[Vector], rows: usize, reach: f64) {
        self.places.clear();
        self.still.clear();
        for (grains, listed) in grains.chunks(rows).zip(listed.chunks(rows)) {
            let before = self.places.len();
            let both = grains.iter().map(|g| g.position).zip(listed);
            let moved =
                |now: &Vector, then: &Vector| now.map(f64::to_bits) != then.map(f64::to_bits);
            for (now, then) in both.filter(|(now, then)| moved(now, then)) {
                self.places.extend([now, *then]);
            }
            self.still.push(self.places.len() == before);
        }
        let halo = self.halo.get_or_insert_with(|| Halo::new(reach));
        halo.mark(&self.places);
        let (halo, still) = (&*halo, &self.still);
        let each = still.par_iter().zip(grains.par_chunks(rows));
        each.map(|(still, grains)| *still && !grains.iter().any(|g| halo.may_touch(g.position)))
            .collect_into_vec(&mut self.stay);
    }

    /// Whether the pairs of a chunk stay.
    #[must_use]
    pub fn stays(&self, chunk: usize) -> bool {
        self.stay.get(chunk).copied().unwrap_or(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grains::lists::Lists;

    const RADII: [f64; 2] = [0.5, 0.6];

    /// A block of 4,096 grains, no two of which lie alike.
    fn block() -> Vec<Grain> {
        let at = |k: usize| {
            let cell = [k % 16, k / 16 % 16, k / 256].map(|i| 1.02 * i as f64);
            std::array::from_fn(|i| cell[i] + 0.1 * ((7 * k + 3 * i) as f64).sin())
        };
        let grain = |k: usize| Grain {
            position: at(k),
            velocity: [0.0; 3],
            spin: [0.0; 3],
            radius: RADII[k % 2],
            mass: 1.0,
        };
        (0..4096).map(grain).collect()
    }

    #[test]
    fn what_is_listed_again_is_as_if_all_were() {
        let mut grains = block();
        let mut lists = Lists::new(false);
        lists.list(&grains, RADII, &[]);
        let mut kept = 0;
        for turn in 0..3 {
            let listed: Vec<Vector> = grains.iter().map(|g| g.position).collect();
            // A few grains of the corner go about, and one flies across the block from turn to turn.
            for (k, grain) in grains.iter_mut().enumerate().take(20) {
                grain.position[2] += 0.3 * ((k + turn) as f64).cos();
            }
            grains[3000].position = [2.0 + 3.0 * turn as f64, 9.0, 3.0];
            lists.mark_again(&grains, &listed, RADII);
            kept += lists.again.stay.iter().filter(|stays| **stays).count();
            lists.list(&grains, RADII, &[]);
            let mut fresh = Lists::new(false);
            fresh.list(&grains, RADII, &[]);
            for (own, other) in lists.chunks.iter().zip(&fresh.chunks) {
                assert_eq!((&own.pairs, own.inner), (&other.pairs, other.inner));
                assert_eq!(own.incoming, other.incoming);
            }
        }
        assert!(kept > 3, "only {kept} of 24 chunks kept their pairs");
    }
}
