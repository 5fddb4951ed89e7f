//! What an electric field does to drops as a whole.
//!
//! Force and power are sums over surface points. The forces that drops exert on each other are equal and opposite, so that all
//! forces together are those of the applied field on the charges. What the sums miss of that is shared by volume. Parcels
//! feel the applied field alone, and none feels them.

use super::{Group, Groups, Parcel, Seen};
use crate::liquid::electric::Drops;
use crate::liquid::points::Liquid;
use crate::liquid::vector::{along, difference, dot};

impl Groups {
    /// Points by drop, which are those of `of`, with the areas of the surface, and the charges.
    #[must_use]
    pub fn surfaces(&self, of: Vec<u32>, seen: &[Seen]) -> Drops {
        let areas = seen.iter().flat_map(|s| &s.patches).map(|p| p.area);
        Drops {
            of,
            area: areas.collect(),
            charge: self.drops.iter().map(|g| g.charge).collect(),
        }
    }

    /// Shares a charge among the drops by volume.
    pub fn charge(&mut self, charge: f64) {
        let volume: f64 = self.drops.iter().map(|g| g.volume).sum();
        for group in &mut self.drops {
            group.charge = charge * group.volume / volume;
        }
    }

    /// Gives each drop what the field does on its part of the surface of `all`. Where the surface has been made anew, how fast it
    /// changes is not known.
    pub fn feel(&mut self, all: &Liquid<3>) {
        let mut from = 0;
        for group in &mut self.drops {
            let liquid = &mut group.liquid;
            let own = from..from + liquid.surface();
            let [now, rate] = all.pull.each_ref().map(|field| field[own.clone()].to_vec());
            let anew = liquid.pull[1].is_empty();
            let rate = if anew { vec![0.0; now.len()] } else { rate };
            liquid.pull = [now, rate];
            liquid.drag = all.drag.get(own.clone()).unwrap_or_default().to_vec();
            liquid.charge = all.charge.get(own.clone()).unwrap_or_default().to_vec();
            from = own.end;
        }
    }

    /// Gives drops the momentum that a field brings in `dt` \[s\], of whose forces the applied field \[V/m\] has the sum; the
    /// power of all \[W\].
    pub fn drive(&mut self, seen: &[Seen], field: &[f64; 3], density: f64, dt: f64) -> f64 {
        let each = self.drops.iter().zip(seen);
        let forces: Vec<[f64; 3]> = each.map(|(group, seen)| group.force(seen)).collect();
        let found = forces.iter();
        let found = found.fold([0.0; 3], |sum, force| along(&sum, 1.0, force));
        let charge: f64 = self.drops.iter().map(|g| g.charge).sum();
        let lack = difference(&field.map(|e| charge * e), &found);
        let volume: f64 = self.drops.iter().map(|g| g.volume).sum();
        for (group, force) in self.drops.iter_mut().zip(&forces) {
            let force = along(force, group.volume / volume, &lack);
            let gained = force.map(|f| f * dt / (density * group.volume));
            group.drift = along(&group.drift, 1.0, &gained);
            for u in &mut group.liquid.velocity {
                *u = along(u, 1.0, &gained);
            }
        }
        let drops = self.drops.iter().zip(seen);
        let drops: f64 = drops.map(|(group, seen)| group.power(seen)).sum();
        let flying = |p: &Parcel| p.charge * dot(field, &p.drift);
        drops + self.parcels.iter().map(flying).sum::<f64>()
    }
}

impl Group {
    /// Traction of a field at each point of the surface, times its area \[N\].
    fn pulls(&self, seen: &Seen) -> impl Iterator<Item = [f64; 3]> {
        let liquid = &self.liquid;
        seen.patches.iter().enumerate().map(|(i, patch)| {
            let drag = liquid.drag.get(i).copied().unwrap_or([0.0; 3]);
            let traction = along(&drag, liquid.pull[0][i], &patch.normal);
            traction.map(|t| t * patch.area)
        })
    }

    /// \[N\].
    fn force(&self, seen: &Seen) -> [f64; 3] {
        let pulls = self.pulls(seen);
        pulls.fold([0.0; 3], |sum, pull| along(&sum, 1.0, &pull))
    }

    /// \[W\].
    fn power(&self, seen: &Seen) -> f64 {
        let each = self.pulls(seen).zip(&self.liquid.velocity);
        each.map(|(pull, u)| dot(&pull, u)).sum()
    }
}
