//! What has to be listed again: only chunks near grains that have moved.
//!
//! The pairs of a chunk are those of the places that its grains were listed at. A grain that has since gone no farther than a part of
//! the skin keeps that place: what is left of its skin lasts on. Where neither a grain of its own nor any within reach has got
//! another place, a new list would be the old one. So what sleeps or creeps is not listed again each time that a few are fast, and the lists
//! are the same as if it were.

use contact::Grain;
use neighbours::Halo;
use rayon::prelude::*;
use shapes::frame::{Vector, difference, squared};

/// Finds who has moved.
#[derive(Debug, Clone, Default)]
pub struct Again {
    halo: Option<Halo>,
    places: Vec<Vector>,
    /// By chunks: whether no grain of its own has got another place.
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

    /// Whether everything is.
    #[must_use]
    pub fn is_all(&self) -> bool {
        self.stay.is_empty()
    }

    /// Brings the places at which `grains` are `listed` \[m\] to where those are that have gone farther than `least` \[m\], and finds the
    /// chunks of `rows` whose pairs stay; `reach` is that of a pair \[m\].
    pub fn find(
        &mut self,
        grains: &[Grain],
        listed: &mut [Vector],
        rows: usize,
        [least, reach]: [f64; 2],
    ) {
        let chunks = grains.par_chunks(rows).zip(listed.par_chunks_mut(rows));
        let moved: Vec<Vec<Vector>> = chunks
            .map(|(grains, listed)| {
                let mut moved = Vec::new();
                for (grain, listed) in grains.iter().zip(listed) {
                    let near = squared(difference(grain.position, *listed)) <= least * least;
                    // What is no number has moved.
                    if !near {
                        moved.extend([*listed, grain.position]);
                        *listed = grain.position;
                    }
                }
                moved
            })
            .collect();
        self.still.clear();
        self.still.extend(moved.iter().map(Vec::is_empty));
        self.places.clear();
        self.places.extend(moved.into_iter().flatten());
        let halo = self.halo.get_or_insert_with(|| Halo::new(reach));
        halo.mark(&self.places);
        let (halo, still) = (&*halo, &self.still);
        let each = still.par_iter().zip(listed.par_chunks(rows));
        each.map(|(still, listed)| *still && !listed.iter().any(|place| halo.may_touch(*place)))
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
    fn what_is_listed_again_is_as_if_all_were_and_holds_all_that_touch() {
        let mut grains = block();
        let mut listed: Vec<Vector> = grains.iter().map(|g| g.position).collect();
        let mut lists = Lists::new(false);
        lists.list(&grains, &listed, RADII, &[]);
        let (mut kept, mut near) = (0, 0);
        for turn in 0..4 {
            // A few grains of the corner go about, one flies across the block from turn to turn, and all the others creep.
            for (k, grain) in grains.iter_mut().enumerate() {
                let far = if k < 20 { 0.3 } else { 0.01 };
                grain.position[2] += far * ((k + turn) as f64).cos();
            }
            grains[3000].position = [2.0 + 3.0 * turn as f64, 9.0, 3.0];
            lists.mark_again(&grains, &mut listed, RADII);
            kept += lists.again.stay.iter().filter(|stays| **stays).count();
            lists.list(&grains, &listed, RADII, &[]);
            let mut fresh = Lists::new(false);
            fresh.list(&grains, &listed, RADII, &[]);
            for (own, other) in lists.chunks.iter().zip(&fresh.chunks) {
                assert_eq!((&own.pairs, own.inner), (&other.pairs, other.inner));
                assert_eq!(own.incoming, other.incoming);
            }
            let moved = grains.iter().zip(&listed);
            near += moved
                .filter(|(g, at)| g.position[2].to_bits() != at[2].to_bits())
                .count();
            assert!(holds_all_that_touch(&lists, &grains));
        }
        assert!(kept > 3, "only {kept} of 32 chunks kept their pairs");
        assert!(near > 9000, "only {near} grains kept their places");
    }

    /// Whether all pairs that touch are listed, by looking at each.
    fn holds_all_that_touch(lists: &Lists, grains: &[Grain]) -> bool {
        let touches = |a: &Grain, b: &Grain| {
            squared(difference(a.position, b.position)) < (a.radius + b.radius).powi(2)
        };
        grains.iter().enumerate().all(|(a, grain)| {
            let chunk = &lists.chunks[a / crate::grains::lists::ROWS];
            let own = chunk.pairs.iter();
            let own = own.filter(|p| p.own as usize == a % crate::grains::lists::ROWS);
            let listed: Vec<usize> = own.map(|pair| pair.other as usize).collect();
            let mut later = (a + 1..grains.len()).filter(|b| touches(grain, &grains[*b]));
            later.all(|b| listed.contains(&b))
        })
    }
}
