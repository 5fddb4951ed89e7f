//! Drops that have become too thin part.

use run::Failure;

use super::hull::HALF;
use super::level::{Level, Rim, both};
use super::necks::{Pieces, pieces};
use super::reshape::reshaped;
use super::{Group, Groups, Parcel, Rule};
use crate::liquid::effort::failed;
use crate::liquid::matter::Way;
use crate::liquid::points::Liquid;
use crate::liquid::surface::Patch;
use crate::liquid::vector::{along, difference};

/// Width over which the cap of a part goes over into its old surface, in spacings.
const EDGE: f64 = 0.4;
/// Spacings that caps reach beyond the deep points of their part, and that the caps of two parts keep from each other.
const CAP: f64 = 1.6;
const GAP: f64 = 1.0;

/// Cubes of a spacing below which a drop has too few points for the fits of its surface: those of a sphere of two spacings.
const SMALL: f64 = 34.0;

impl Groups {
    /// Lets drops part; how many parts and parcels came of them.
    ///
    /// # Errors
    /// Where surfaces or what new points carry cannot be fitted.
    pub fn part(&mut self, rule: &Rule, way: &Way) -> Result<u64, Failure> {
        let mut all = Groups::default();
        let mut parted = 0;
        for group in &self.drops {
            if group.volume < SMALL * way.spacing.powi(3) {
                all.parcels.push(group.parcel());
                parted += 1;
                continue;
            }
            match group.parts(rule, way)? {
                None => all.drops.push(group.clone()),
                Some(parts) => {
                    parted += (parts.drops.len() + parts.parcels.len()) as u64;
                    all.drops.extend(parts.drops);
                    all.parcels.extend(parts.parcels);
                }
            }
        }
        self.drops = all.drops;
        self.parcels.extend(all.parcels);
        Ok(parted)
    }
}

impl Group {
    /// All of it, without its shape.
    #[must_use]
    pub fn parcel(&self) -> Parcel {
        Parcel {
            volume: self.volume,
            centre: self.centre,
            drift: self.drift,
            charge: self.charge,
        }
    }

    /// What it parts into; none where it holds together.
    fn parts(&self, rule: &Rule, way: &Way) -> Result<Option<Groups>, Failure> {
        let spacing = way.spacing;
        let patches = self.liquid.skin(spacing).map_err(|e| failed(&e))?;
        let level = Level::new(&self.liquid.position[..patches.len()], &patches, spacing);
        let Some(pieces) = pieces(&self.liquid, &level, rule.part, spacing) else {
            return Ok(None);
        };
        let mut parts = Groups::default();
        let mut loose = pieces.between.clone();
        let borne = |points: &[usize]| self.borne(points, &patches);
        for piece in 0..pieces.cores.len() {
            let rim = Rim {
                height: |x: &[f64; 3]| {
                    let cap = cap(&pieces, piece, x, spacing);
                    both(level.height(x), cap, EDGE * spacing)
                },
                spacing,
            };
            let liquid = reshaped(&self.liquid, &rim)?;
            let small = |group: &Group| group.volume < SMALL * spacing.powi(3);
            let about = pieces.about(piece, &self.liquid);
            let Some(mut group) = liquid.and_then(|l| Group::new(l, spacing)) else {
                loose.push(about);
                continue;
            };
            group.charge = borne(&about);
            if small(&group) {
                parts.parcels.push(group.parcel());
            } else {
                parts.drops.push(group);
            }
        }
        let strewn = loose.iter();
        parts.parcels.extend(strewn.map(|points| Parcel {
            charge: borne(points),
            ..Parcel::of(&self.liquid, points, spacing)
        }));
        self.share(&mut parts);
        Ok(Some(parts))
    }

    /// Charge that the surface has at some points \[C\].
    fn borne(&self, points: &[usize], patches: &[Patch<3>]) -> f64 {
        let charge = &self.liquid.charge;
        let each = points
            .iter()
            .filter_map(|&i| Some((charge.get(i)?, patches.get(i)?)));
        each.map(|(charge, patch)| charge * patch.area).sum()
    }

    /// Gives parts the volume, the centre, the momentum and the charge that there were.
    fn share(&self, parts: &mut Groups) {
        let strewn: f64 = parts.parcels.iter().map(|p| p.volume).sum();
        let rest: f64 = parts.drops.iter().map(|g| g.volume).sum();
        let larger = self.volume / (strewn + rest);
        parts.drops.iter_mut().for_each(|g| g.volume *= larger);
        parts.parcels.iter_mut().for_each(|p| p.volume *= larger);
        let all = parts.drops.iter().map(Group::parcel);
        let all: Vec<Parcel> = all.chain(parts.parcels.iter().copied()).collect();
        let volume: f64 = all.iter().map(|p| p.volume).sum();
        let mean = |of: fn(&Parcel) -> &[f64; 3]| {
            let each = all.iter();
            each.fold([0.0; 3], |sum, p| along(&sum, p.volume / volume, of(p)))
        };
        let aside = difference(&self.centre, &mean(|p| &p.centre));
        let lack = difference(&self.drift, &mean(|p| &p.drift));
        // What integrals over the surface leave of the charge.
        let left = self.charge - all.iter().map(|p| p.charge).sum::<f64>();
        for group in &mut parts.drops {
            group.charge += left * group.volume / volume;
            group.centre = along(&group.centre, 1.0, &aside);
            group.drift = along(&group.drift, 1.0, &lack);
        }
        for parcel in &mut parts.parcels {
            parcel.charge += left * parcel.volume / volume;
            parcel.centre = along(&parcel.centre, 1.0, &aside);
            parcel.drift = along(&parcel.drift, 1.0, &lack);
        }
    }
}

/// How far a place lies beyond the cap of a piece \[m\]: from its deep points, and from the middle between it and the others.
fn cap(pieces: &Pieces, piece: usize, x: &[f64; 3], spacing: f64) -> f64 {
    let [own, others] = pieces.far(piece, x);
    let reach = own - CAP * spacing;
    reach.max(0.5 * (own - others + GAP * spacing))
}

impl Parcel {
    /// What some points of a liquid stand for.
    fn of(liquid: &Liquid<3>, points: &[usize], spacing: f64) -> Self {
        let surface = liquid.surface();
        let share = |i: usize| if i < surface { HALF } else { 1.0 };
        let whole: f64 = points.iter().map(|&i| share(i)).sum();
        let mean = |field: &[[f64; 3]]| {
            let each = points.iter();
            each.fold([0.0; 3], |sum, &i| along(&sum, share(i) / whole, &field[i]))
        };
        Self {
            volume: whole * spacing.powi(3),
            centre: mean(&liquid.position),
            drift: mean(&liquid.velocity),
            charge: 0.0,
        }
    }
}
