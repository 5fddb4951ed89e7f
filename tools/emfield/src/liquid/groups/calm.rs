//! Flow that slows where the sum of the energies would rise: friction can only lessen it, but new points and fits may raise it.
//!
//! In each drop the velocity about that of its centre becomes a part of itself, the same in all drops. So momentum and volumes are
//! kept, and a flow without sources stays one.

use super::{Groups, Seen};
use crate::liquid::vector::{along, difference, dot};

impl Groups {
    /// Energy of the flow about the centres of drops \[J\].
    #[must_use]
    pub fn stirred(&self, seen: &[Seen], density: f64) -> f64 {
        let each = self.drops.iter().zip(seen).map(|(group, seen)| {
            let all = seen.volumes.iter().zip(&group.liquid.velocity);
            all.map(|(v, u)| {
                let about = difference(u, &group.drift);
                v * dot(&about, &about)
            })
            .sum::<f64>()
        });
        0.5 * density * each.sum::<f64>()
    }

    /// Takes energy from the flow, at most all that there is; how much \[J\].
    pub fn calm(&mut self, seen: &[Seen], density: f64, excess: f64) -> f64 {
        let stirred = self.stirred(seen, density);
        let taken = excess.min(stirred);
        if taken <= 0.0 {
            return 0.0;
        }
        let left = (1.0 - taken / stirred).max(0.0).sqrt();
        for group in &mut self.drops {
            for u in &mut group.liquid.velocity {
                *u = along(&group.drift, left, &difference(u, &group.drift));
            }
        }
        taken
    }
}
