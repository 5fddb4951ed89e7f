//! Drops that meet become one, sheets of one that meet close, and parcels are taken up.

use run::Failure;

use super::level::{Level, Rim, either};
use super::reshape::reshaped;
use super::{Group, Groups, Parcel, Rule, beside};
use crate::liquid::effort::failed;
use crate::liquid::matter::Way;
use crate::liquid::points::Liquid;
use crate::liquid::vector::{along, difference, dot};

/// Width over which the surfaces of two drops that meet are rounded off into each other, in spacings.
const FILLET: f64 = 2.0;
/// The same where sheets of one drop have met.
const CREASE: f64 = 1.2;
/// Spacings within which points of sheets that meet stand.
const BESIDE: f64 = 1.0;
/// What closes changes its volume by less than this part.
const LIKE: f64 = 0.1;

impl Groups {
    /// Lets drops that meet become one; how often.
    ///
    /// # Errors
    /// Where surfaces or what new points carry cannot be fitted.
    pub fn join(&mut self, rule: &Rule, way: &Way) -> Result<u64, Failure> {
        let mut joined = 0;
        while let Some([a, b]) = self.meeting(rule, way)? {
            self.drops[a] = self.drops[a].with(&self.drops[b], way)?;
            self.drops.remove(b);
            joined += 1;
        }
        Ok(joined)
    }

    /// Closes the gas between sheets of one drop that meet; how many drops did.
    ///
    /// # Errors
    /// Where surfaces or what new points carry cannot be fitted.
    pub fn close(&mut self, rule: &Rule, way: &Way) -> Result<u64, Failure> {
        let mut closed = 0;
        for group in &mut self.drops {
            if let Some(liquid) = group.closed(rule, way)? {
                group.liquid = liquid;
                closed += 1;
            }
        }
        Ok(closed)
    }

    /// The first two drops that meet.
    fn meeting(&self, rule: &Rule, way: &Way) -> Result<Option<[usize; 2]>, Failure> {
        let reach = rule.join * way.spacing;
        for (b, second) in self.drops.iter().enumerate() {
            for (a, first) in self.drops[..b].iter().enumerate() {
                if near(&first.liquid, &second.liquid, reach)
                    && first.meets(second, reach, way.spacing)?
                {
                    return Ok(Some([a, b]));
                }
            }
        }
        Ok(None)
    }

    /// Lets drops take up parcels that run into them; how often.
    ///
    /// # Errors
    /// Where surfaces cannot be fitted.
    pub fn take_up(&mut self, way: &Way) -> Result<u64, Failure> {
        let before = self.parcels.len();
        let mut drops = self.drops.iter_mut();
        while !self.parcels.is_empty()
            && let Some(drop) = drops.next()
        {
            let patches = drop.liquid.skin(way.spacing).map_err(|e| failed(&e))?;
            let skin = drop.liquid.position[..patches.len()].to_vec();
            let velocity = drop.liquid.velocity[..skin.len()].to_vec();
            let level = Level::new(&skin, &patches, way.spacing);
            self.parcels.retain(|parcel| {
                let within = level.nearest(&parcel.centre).is_some_and(|j| {
                    let against = difference(&parcel.drift, &velocity[j]);
                    level.height(&parcel.centre) < 0.0 && dot(&against, &patches[j].normal) < 0.0
                });
                if within {
                    drop.take(parcel);
                }
                !within
            });
        }
        Ok((before - self.parcels.len()) as u64)
    }
}

/// Whether the boxes about two liquids are nearer than `reach`.
fn near(a: &Liquid<3>, b: &Liquid<3>, reach: f64) -> bool {
    let ends = |liquid: &Liquid<3>, k: usize| {
        let along = liquid.position.iter().map(|x| x[k]);
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], c| {
            [l.min(c), h.max(c)]
        })
    };
    (0..3).all(|k| {
        let ([a_low, a_high], [b_low, b_high]) = (ends(a, k), ends(b, k));
        a_low < b_high + reach && b_low < a_high + reach
    })
}

impl Group {
    /// Whether its surface is nearer to that of another than `reach` \[m\] somewhere, and approaches it there.
    fn meets(&self, other: &Self, reach: f64, spacing: f64) -> Result<bool, Failure> {
        let patches = other.liquid.skin(spacing).map_err(|e| failed(&e))?;
        let theirs = &other.liquid.position[..patches.len()];
        let level = Level::new(theirs, &patches, spacing);
        let mut own = 0..self.liquid.surface();
        Ok(own.any(|i| {
            let place = &self.liquid.position[i];
            let Some(j) = level.nearest(place) else {
                return false;
            };
            let against = difference(&self.liquid.velocity[i], &other.liquid.velocity[j]);
            level.height(place) < reach && dot(&against, &patches[j].normal) < 0.0
        }))
    }

    /// Its points once sheets that meet have closed; none where none do.
    fn closed(&self, rule: &Rule, way: &Way) -> Result<Option<Liquid<3>>, Failure> {
        let (spacing, velocity) = (way.spacing, &self.liquid.velocity);
        let patches = self.liquid.skin(spacing).map_err(|e| failed(&e))?;
        let skin = &self.liquid.position[..patches.len()];
        let level = Level::new(skin, &patches, spacing);
        let meets = (0..skin.len()).any(|i| {
            level
                .facing(&skin[i], i, BESIDE * spacing)
                .is_some_and(|j| {
                    let against = difference(&velocity[i], &velocity[j]);
                    level.height_by(&skin[i], j) < rule.join * spacing
                        && dot(&against, &patches[j].normal) < 0.0
                })
        });
        if !meets {
            return Ok(None);
        }
        let rim = Rim {
            height: |x: &[f64; 3]| level.closed(x, CREASE * spacing),
            spacing,
        };
        let closed = reshaped(&self.liquid, &rim)?;
        let closed = closed.and_then(|l| Group::new(l, spacing));
        let near = |group: &Group| (group.volume - self.volume).abs() < LIKE * self.volume;
        Ok(closed.filter(near).map(|group| group.liquid))
    }

    /// Both as one.
    fn with(&self, other: &Self, way: &Way) -> Result<Self, Failure> {
        let spacing = way.spacing;
        let [own, theirs] = [self, other].map(|g| g.liquid.skin(spacing).map_err(|e| failed(&e)));
        let (own, theirs) = (own?, theirs?);
        let levels = [
            Level::new(&self.liquid.position[..own.len()], &own, spacing),
            Level::new(&other.liquid.position[..theirs.len()], &theirs, spacing),
        ];
        let rim = Rim {
            height: |x: &[f64; 3]| {
                let [a, b] = levels.each_ref().map(|l| l.height(x));
                either(a, b, FILLET * spacing)
            },
            spacing,
        };
        let lost = || failed(&"two drops that meet leave no points");
        let liquid = reshaped(&beside(&self.liquid, &other.liquid), &rim)?.ok_or_else(lost)?;
        let volume = self.volume + other.volume;
        let share = other.volume / volume;
        let mean = |a: &[f64; 3], b: &[f64; 3]| along(a, share, &difference(b, a));
        Ok(Self {
            liquid,
            volume,
            centre: mean(&self.centre, &other.centre),
            drift: mean(&self.drift, &other.drift),
            charge: self.charge + other.charge,
            met: true,
        })
    }

    /// Takes up a parcel: volume, centre, momentum and charge.
    fn take(&mut self, parcel: &Parcel) {
        self.volume += parcel.volume;
        self.charge += parcel.charge;
        let share = parcel.volume / self.volume;
        let toward = |a: &[f64; 3], b: &[f64; 3]| along(a, share, &difference(b, a));
        self.centre = toward(&self.centre, &parcel.centre);
        self.drift = toward(&self.drift, &parcel.drift);
    }
}
