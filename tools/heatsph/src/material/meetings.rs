//! Which materials points and links meet, and which of them touch.

use rayon::prelude::*;

use super::Materials;
use crate::cloud::Cloud;
use crate::operator::Links;

/// Points that one task looks at.
const ROWS: usize = 256;

/// Materials that were met.
#[derive(Debug, Clone, PartialEq)]
pub struct Meetings {
    /// Whether each was.
    pub materials: Vec<bool>,
    /// Whether i and j follow one another on a link, at `i * kinds + j` with i below j.
    pairs: Vec<bool>,
}

impl Meetings {
    fn none(kinds: usize) -> Self {
        Self {
            materials: vec![false; kinds],
            pairs: vec![false; kinds * kinds],
        }
    }

    /// Those at points.
    #[must_use]
    pub fn of_points(materials: &Materials, cloud: &Cloud) -> Self {
        let mut met = Self::none(materials.len());
        for x in &cloud.position {
            met.materials[materials.at(*x)] = true;
        }
        met
    }

    /// Those along links.
    #[must_use]
    pub fn of_links(materials: &Materials, cloud: &Cloud, links: &Links) -> Self {
        let kinds = materials.len();
        let rows = (0..cloud.position.len()).into_par_iter().with_min_len(ROWS);
        let of = |mut met: Self, i: usize| {
            for link in links.pattern.row(i) {
                let j = links.pattern.columns()[link] as usize;
                if j > i {
                    met.follow(materials, [cloud.position[i], cloud.position[j]]);
                }
            }
            met
        };
        let join = |mut a: Self, b: Self| {
            let (materials, pairs) = (a.materials.iter_mut(), a.pairs.iter_mut());
            materials.zip(&b.materials).for_each(|(a, b)| *a |= b);
            pairs.zip(&b.pairs).for_each(|(a, b)| *a |= b);
            a
        };
        rows.fold(|| Self::none(kinds), of)
            .reduce(|| Self::none(kinds), join)
    }

    fn follow(&mut self, materials: &Materials, ends: [[f64; 3]; 2]) {
        let kinds = self.materials.len();
        let stretches = materials.stretches(ends[0], ends[1]).0;
        for stretch in &stretches {
            self.materials[stretch.material] = true;
        }
        for pair in stretches.windows(2) {
            let (a, b) = (pair[0].material, pair[1].material);
            self.pairs[a.min(b) * kinds + a.max(b)] = true;
        }
    }

    /// Whether two materials touch.
    #[must_use]
    pub fn touch(&self, a: usize, b: usize) -> bool {
        self.pairs[a.min(b) * self.materials.len() + a.max(b)]
    }
}
