//! What a checkpoint keeps of drops that meet and part.

use artefact::Checkpoint;
use run::Failure;

use super::groups::March;
use super::ledger::{Counts, Ledger};
use crate::liquid::groups::{Group, Groups, Parcel, chosen};

impl March {
    pub(super) fn save(&self, checkpoint: &mut Checkpoint) {
        let Groups { drops, parcels } = &self.groups;
        let all = self.groups.together();
        self.course.save(&all.liquid, checkpoint);
        self.acting
            .save(&all.liquid, &self.course.effort, checkpoint);
        let sizes = drops.iter().map(|g| &g.liquid);
        let sizes = sizes.flat_map(|l| [l.surface() as u64, l.position.len() as u64]);
        checkpoint.put_u64("sizes", &sizes.collect::<Vec<_>>());
        let Counts {
            joined,
            closed,
            parted,
            taken,
        } = self.counts;
        checkpoint.put_u64("groups", &[joined, closed, parted, taken]);
        let Ledger {
            first,
            least,
            rise,
            strewn,
            work,
            power,
            calmed,
        } = self.ledger;
        let ledger = [first, least, rise, strewn, work, power, calmed];
        checkpoint.put_f64("ledger", &ledger);
        let kept = drops.iter().map(Group::parcel);
        let numbers = kept.chain(parcels.iter().copied()).flat_map(|p| {
            let ([x, y, z], [a, b, c]) = (p.centre, p.drift);
            [p.volume, x, y, z, a, b, c, p.charge]
        });
        checkpoint.put_f64("kept", &numbers.collect::<Vec<_>>());
    }

    pub(super) fn restore(&mut self, checkpoint: &mut Checkpoint) -> Result<(), Failure> {
        let Some(first) = self.groups.drops.first() else {
            return Ok(());
        };
        let mut all = first.liquid.clone();
        self.course.restore(&mut all, checkpoint)?;
        let (spacing, effort) = (self.way.spacing, &mut self.course.effort);
        self.acting.restore(&mut all, effort, spacing, checkpoint)?;
        if let [joined, closed, parted, taken] = checkpoint.u64("groups")?[..] {
            self.counts = Counts {
                joined,
                closed,
                parted,
                taken,
            };
        }
        if let [first, least, rise, strewn, work, power, calmed] = checkpoint.f64("ledger")?[..] {
            self.ledger = Ledger {
                first,
                least,
                rise,
                strewn,
                work,
                power,
                calmed,
            };
        }
        let sizes = checkpoint.u64("sizes")?;
        let kept = checkpoint.f64("kept")?;
        self.groups = Groups::default();
        let parcels = kept.as_chunks::<8>().0.iter();
        let parcels = parcels.map(|&[volume, x, y, z, a, b, c, charge]| Parcel {
            volume,
            centre: [x, y, z],
            drift: [a, b, c],
            charge,
        });
        let (mut on, mut inside) = (0, all.surface());
        let sizes = sizes.as_chunks::<2>().0;
        for (k, parcel) in parcels.enumerate() {
            let Some(&[surface, count]) = sizes.get(k) else {
                self.groups.parcels.push(parcel);
                continue;
            };
            let (surface, inner) = (surface as usize, (count - surface) as usize);
            let liquid = chosen(
                &all,
                (on..on + surface).collect(),
                (inside..inside + inner).collect(),
            );
            (on, inside) = (on + surface, inside + inner);
            self.groups.drops.push(Group {
                liquid,
                volume: parcel.volume,
                centre: parcel.centre,
                drift: parcel.drift,
                charge: parcel.charge,
                met: false,
            });
        }
        Ok(())
    }
}
