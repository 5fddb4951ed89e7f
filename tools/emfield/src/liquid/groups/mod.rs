//! Groups of points: drops that meet become one, and one whose neck is thin parts (2.2.5, Matsuzawa 2017).
//!
//! Each group is a liquid of its own with its own surface, volume and momentum. At every step ([`Groups::join`], [`Groups::part`]):
//!
//! - Two whose surfaces come nearer than a part of a spacing, and still approach, become one. Its surface is that of both, with a fillet
//!   where they meet. Gas between them is not known, so that nothing delays it.
//! - Sheets of one that meet close likewise ([`Groups::close`]), and so does the crease where drops run into each other.
//! - One parts where it has become too thin: its points that lie deep beneath the surface no longer hang together. What is left
//!   between the parts, thin edges, and parts too small for fits fly on as parcels without a shape, until a drop takes them up
//!   ([`Groups::take_up`]).
//!
//! Volume, momentum and charge of all are kept: what comes of a change shares what there was before.

mod calm;
mod drawn;
pub mod hull;
mod join;
mod level;
mod necks;
mod part;
mod reshape;
pub mod told;

#[cfg(test)]
mod tests;

use neighbours::Tree;
use run::Failure;

use self::hull::Hull;
use self::necks::{LINK, clusters};
use super::effort::failed;
use super::points::Liquid;
use super::surface::Patch;
use super::vector::{along, difference, length};

/// Moves that give a liquid its volume.
const SWELLS: usize = 2;
/// Part of its volume below which they leave it to a change of its size.
const EVEN: f64 = 1e-6;
/// Such changes at most: each leaves up to a third of what is lacking where parts end at a given length; and what of its size counts as
/// rounding.
const SCALES: usize = 40;
const ROUNDING: f64 = 1e-13;
/// Part of its volume beyond which it is lost.
const LOST: f64 = 0.02;

/// Part of all below which a drop is little.
const LITTLE: f64 = 0.1;

/// When groups meet and part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Distance of two surfaces at which they become one, in spacings.
    pub join: f64,
    /// Depth beneath the surface at which points hold a liquid together, in spacings.
    pub part: f64,
}

/// A drop.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Its points.
    pub liquid: Liquid<3>,
    /// Volume \[m3\].
    pub volume: f64,
    /// Centre \[m\].
    pub centre: [f64; 3],
    /// Its velocity: momentum over mass \[m/s\].
    pub drift: [f64; 3],
    /// Charge of a conductor \[C\].
    pub charge: f64,
    /// It has become one of two, and its flow is not yet free of divergence.
    pub met: bool,
}

/// Liquid that is too small to have a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parcel {
    /// Volume \[m3\].
    pub volume: f64,
    /// Centre \[m\].
    pub centre: [f64; 3],
    /// Its velocity \[m/s\].
    pub drift: [f64; 3],
    /// Charge of a conductor \[C\].
    pub charge: f64,
}

/// The points of all drops as those of one liquid.
#[derive(Debug, Clone, PartialEq)]
pub struct Together {
    /// Those of all surfaces first.
    pub liquid: Liquid<3>,
    /// Number of the drop of each.
    pub group: Vec<u32>,
}

/// All drops and parcels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Groups {
    /// Drops with their points.
    pub drops: Vec<Group>,
    /// Liquid without a shape.
    pub parcels: Vec<Parcel>,
}

/// The surface of a group and what it encloses.
#[derive(Debug, Clone)]
pub struct Seen {
    /// The surface at its points.
    pub patches: Vec<Patch<3>>,
    /// What it encloses.
    pub hull: Hull,
    /// What points stand for \[m3\].
    pub volumes: Vec<f64>,
    /// Velocity that all points were given, so that the momentum is kept \[m/s\].
    pub pushed: [f64; 3],
}

impl Group {
    /// A liquid with its own volume, centre and momentum; none where it has too few points for them.
    #[must_use]
    pub fn new(liquid: Liquid<3>, spacing: f64) -> Option<Self> {
        let mut group = Self {
            liquid,
            volume: 0.0,
            centre: [0.0; 3],
            drift: [0.0; 3],
            charge: 0.0,
            met: false,
        };
        let seen = group.seen(spacing).ok()?;
        group.starts(&seen);
        Some(group)
    }

    /// Takes what it has now for what it is to keep.
    pub fn starts(&mut self, seen: &Seen) {
        self.volume = seen.hull.volume;
        self.centre = seen.hull.centre;
        self.drift = self.moves(seen);
    }

    /// Its surface as it is.
    ///
    /// # Errors
    /// Where it has too few points.
    pub fn seen(&self, spacing: f64) -> Result<Seen, Failure> {
        let patches = self.liquid.skin(spacing).map_err(|e| failed(&e))?;
        let surface = self.liquid.surface();
        let skin = &self.liquid.position[..surface];
        let hull = Hull::new(skin, &patches, spacing)
            .ok_or_else(|| failed(&"a surface encloses nothing"))?;
        let volumes = hull.volumes(&self.liquid.position, surface);
        Ok(Seen {
            volumes: volumes.ok_or_else(|| failed(&"points lie in a plane"))?,
            patches,
            hull,
            pushed: [0.0; 3],
        })
    }

    /// The velocity of its centre, as its points move \[m/s\].
    fn moves(&self, seen: &Seen) -> [f64; 3] {
        let all = seen.volumes.iter().zip(&self.liquid.velocity);
        let sum = all.fold([0.0; 3], |sum, (v, u)| along(&sum, *v, u));
        sum.map(|c| c / seen.hull.volume)
    }

    /// Gives it what is left of its volume by a change of its size alone, which no fit bends.
    fn scale(&mut self, seen: &mut Seen, spacing: f64) -> Result<(), Failure> {
        for _ in 0..SCALES {
            let larger = (self.volume / seen.hull.volume).cbrt();
            if (larger - 1.0).abs() < ROUNDING {
                break;
            }
            let centre = seen.hull.centre;
            for x in &mut self.liquid.position {
                *x = along(&centre, larger, &difference(x, &centre));
            }
            *seen = self.seen(spacing)?;
        }
        let enclosed = seen.hull.volume / self.volume;
        if (enclosed - 1.0).abs() > LOST {
            let (count, [x, y, z]) = (self.liquid.surface(), self.centre);
            return Err(failed(&format!(
                "{count} points about [{x:.6e}, {y:.6e}, {z:.6e}] m enclose {enclosed:.4} of what is theirs; take a smaller spacing"
            )));
        }
        Ok(())
    }

    /// Gives its points its volume, its centre and its momentum; its surface then, and the velocity that all were given.
    ///
    /// # Errors
    /// Where it has too few points.
    pub fn keep(&mut self, spacing: f64) -> Result<Seen, Failure> {
        let mut seen = self.seen(spacing)?;
        for _ in 0..SWELLS {
            let lack = self.volume - seen.hull.volume;
            if lack.abs() < EVEN * self.volume {
                break;
            }
            self.liquid.swell(lack / seen.hull.area);
            seen = self.seen(spacing)?;
        }
        self.scale(&mut seen, spacing)?;
        let aside = difference(&self.centre, &seen.hull.centre);
        for x in &mut self.liquid.position {
            *x = along(x, 1.0, &aside);
        }
        seen.hull.centre = self.centre;
        seen.pushed = difference(&self.drift, &self.moves(&seen));
        for u in &mut self.liquid.velocity {
            *u = along(u, 1.0, &seen.pushed);
        }
        Ok(seen)
    }
}

impl Groups {
    /// The drops of a liquid: points inside hang together where `within` says that there is liquid between them. None where one
    /// has too few points.
    #[must_use]
    pub fn new(
        liquid: &Liquid<3>,
        spacing: f64,
        within: impl Fn(&[f64; 3]) -> bool,
    ) -> Option<Self> {
        let surface = liquid.surface();
        let inner = &liquid.position[surface..];
        let linked = |a: &[f64; 3], b: &[f64; 3]| within(&along(&a.map(|c| 0.5 * c), 0.5, b));
        let clusters = clusters(inner, LINK * spacing, linked);
        let mut of = vec![0; inner.len()];
        for (k, cluster) in clusters.iter().enumerate() {
            cluster.iter().for_each(|&i| of[i] = k);
        }
        let tree = Tree::new(inner);
        let skin = liquid.position[..surface].iter();
        let skin = skin.map(|x| {
            let near = tree.nearest(*x)?;
            let far = length(&difference(x, &inner[near]));
            (far < LINK * spacing).then(|| of[near])
        });
        let skin: Vec<usize> = skin.collect::<Option<_>>()?;
        let drops = (0..clusters.len()).map(|k| {
            let on = (0..surface).filter(|&i| skin[i] == k);
            let inside = clusters[k].iter().map(|i| surface + i);
            Group::new(chosen(liquid, on.collect(), inside.collect()), spacing)
        });
        Some(Self {
            drops: drops.collect::<Option<_>>()?,
            parcels: Vec::new(),
        })
    }

    /// All points.
    #[must_use]
    pub fn together(&self) -> Together {
        let each = |k: usize, count: usize| std::iter::repeat_n(k as u32, count);
        let numbered = self.drops.iter().zip(0..);
        let on = numbered
            .clone()
            .flat_map(|(g, k)| each(k, g.liquid.surface()));
        let inside =
            numbered.flat_map(|(g, k)| each(k, g.liquid.position.len() - g.liquid.surface()));
        let liquids = self.drops.iter().map(|g| &g.liquid);
        Together {
            liquid: liquids.fold(Liquid::default(), |all, liquid| beside(&all, liquid)),
            group: on.chain(inside).collect(),
        }
    }

    /// Does something with each drop. A little one that its points no longer hold becomes a parcel.
    ///
    /// # Errors
    /// Those of what is done, where the drop is not little.
    pub fn each(
        &mut self,
        mut act: impl FnMut(&mut Group) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let little = LITTLE * self.volume();
        let mut k = 0;
        while let Some(group) = self.drops.get_mut(k) {
            match act(group) {
                Ok(()) => k += 1,
                Err(Failure::Other(_)) if group.volume < little => {
                    self.parcels.push(self.drops.remove(k).parcel());
                }
                Err(why) => return Err(why),
            }
        }
        Ok(())
    }

    /// Volume of all \[m3\].
    #[must_use]
    pub fn volume(&self) -> f64 {
        let drops = self.drops.iter().map(|g| g.volume);
        drops.chain(self.parcels.iter().map(|p| p.volume)).sum()
    }

    /// Moves parcels for `dt` \[s\] at the acceleration that each has \[m/s2\].
    pub fn fly(&mut self, pulled: impl Fn(&Parcel) -> [f64; 3], dt: f64) {
        for parcel in &mut self.parcels {
            let rate = pulled(parcel);
            let mean = along(&parcel.drift, 0.5 * dt, &rate);
            parcel.centre = along(&parcel.centre, dt, &mean);
            parcel.drift = along(&parcel.drift, dt, &rate);
        }
    }
}

/// The points of two liquids as one, those of the surfaces first.
fn beside(a: &Liquid<3>, b: &Liquid<3>) -> Liquid<3> {
    let (m, n) = (a.surface(), b.surface());
    let vectors = |a: &[[f64; 3]], b: &[[f64; 3]]| [&a[..m], &b[..n], &a[m..], &b[n..]].concat();
    Liquid {
        position: vectors(&a.position, &b.position),
        velocity: vectors(&a.velocity, &b.velocity),
        rate: vectors(&a.rate, &b.rate),
        pressure: [
            &a.pressure[..m],
            &b.pressure[..n],
            &a.pressure[m..],
            &b.pressure[n..],
        ]
        .concat(),
        normal: [a.normal.as_slice(), &b.normal].concat(),
        stress: [a.stress.as_slice(), &b.stress].concat(),
        pull: std::array::from_fn(|k| [a.pull[k].as_slice(), &b.pull[k]].concat()),
        drag: [a.drag.as_slice(), &b.drag].concat(),
        charge: [a.charge.as_slice(), &b.charge].concat(),
        borne: None,
        ..a.clone()
    }
}

/// Some points of a liquid, by their numbers: of the surface, and inside.
#[must_use]
pub fn chosen(liquid: &Liquid<3>, on: Vec<usize>, inside: Vec<usize>) -> Liquid<3> {
    let surface = on.len();
    let all = [on, inside].concat();
    let vectors = |field: &[[f64; 3]]| all.iter().map(|&i| field[i]).collect();
    let numbers = |field: &[f64], count: usize| all[..count].iter().map(|&i| field[i]).collect();
    // What fields do, where there are any.
    let told = |field: &[f64]| {
        let each = all[..surface].iter();
        each.filter_map(|&i| field.get(i).copied()).collect()
    };
    Liquid {
        position: vectors(&liquid.position),
        velocity: vectors(&liquid.velocity),
        rate: vectors(&liquid.rate),
        pressure: numbers(&liquid.pressure, all.len()),
        normal: all[..surface].iter().map(|&i| liquid.normal[i]).collect(),
        stress: numbers(&liquid.stress, surface),
        pull: liquid.pull.each_ref().map(|field| told(field)),
        drag: all[..surface]
            .iter()
            .filter_map(|&i| liquid.drag.get(i).copied())
            .collect(),
        charge: told(&liquid.charge),
        borne: None,
        ..liquid.clone()
    }
}
