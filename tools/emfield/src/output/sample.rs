//! Fields between the points: at probes and along lines.

use run::{Failure, Fault};
use shapes::frame::Vector;
use wls::{Plan, Rules, Search, Stencils, Wants};

use super::Column;
use crate::cloud::region::{Region as Ground, vector};
use crate::cloud::{Class, Cloud};
use crate::scene::Scene;
use crate::solve::region::Region;

/// A point and its weight; a point of an interface counts with its outer side where it is marked.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Share {
    point: u32,
    beyond: Option<u32>,
    weight: f64,
}

/// Places between points, with the weights of the points about them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Samples {
    /// Places in space: probes, then those of each line \[m\].
    pub places: Vec<Vector>,
    shares: Vec<Vec<Share>>,
}

/// Points of the medium in which a place lies.
struct Within<'a, const D: usize> {
    region: &'a Region<D>,
    media: &'a [u8],
}

impl<const D: usize> Rules<D> for Within<'_, D> {
    fn allowed(&self, i: usize, j: usize) -> bool {
        self.region.touches(j, self.media[i])
    }
}

impl Samples {
    /// The probes and lines of a scene.
    ///
    /// # Errors
    /// Where one lies outside the domain, or too few points lie about it.
    pub fn new<const D: usize>(scene: &Scene, cloud: &Cloud) -> Result<Self, Failure> {
        let ground = Ground::new(scene);
        let (own, paths) = places(scene);
        if own.is_empty() {
            return Ok(Self::default());
        }
        let mut faults: Vec<Fault> = Vec::new();
        for (x, path) in own.iter().zip(&paths) {
            if ground.depth(*x) < -1e-9 * ground.spacing {
                let what = format!("({}, {}, {}) m lies outside the domain", x[0], x[1], x[2]);
                faults.push(Fault::at(path, what));
            }
        }
        if !faults.is_empty() {
            faults.dedup_by(|a, b| a.path() == b.path());
            return Err(faults.into());
        }
        let region = crate::assemble::region::<D>(scene, cloud, &|_| false);
        let media: Vec<u8> = own.iter().map(|x| ground.medium(*x)).collect();
        let flat: Vec<[f64; D]> = own.iter().map(|x| std::array::from_fn(|k| x[k])).collect();
        let wants = Wants {
            value: true,
            ..Wants::default()
        };
        let plan = Plan::new::<D>((scene.method.order as u8).max(2), wants);
        let about = wls::Cloud {
            points: &region.places,
            metrics: &region.metrics,
        };
        let failed = |error: wls::Error| Failure::Other(format!("probes and lines: {error}"));
        let search = Search::new(about).map_err(failed)?;
        let rules = Within {
            region: &region,
            media: &media,
        };
        let stencils = Stencils::at(&search, &plan, &flat, &rules).map_err(failed)?;
        let mut on_surface = vec![None; cloud.len()];
        for (k, s) in cloud.surface.iter().enumerate() {
            on_surface[s.point as usize] = Some(k as u32);
        }
        let share = |n: usize| {
            let shares = stencils.value(n).iter().map(|(j, weight)| {
                let outer =
                    matches!(cloud.class[j], Class::Interface { inner, .. } if inner != media[n]);
                Share {
                    point: j as u32,
                    beyond: if outer { on_surface[j] } else { None },
                    weight,
                }
            });
            shares.collect::<Vec<Share>>()
        };
        Ok(Self {
            places: own.iter().map(|x| scene.geometry.place(*x)).collect(),
            shares: (0..own.len()).map(share).collect(),
        })
    }

    /// Value of a quantity at a place.
    #[must_use]
    pub fn value(&self, place: usize, column: &Column) -> f64 {
        let part = |s: &Share| {
            let value = match s.beyond {
                Some(k) if !column.beyond.is_empty() => column.beyond[k as usize],
                _ => column.values[s.point as usize],
            };
            s.weight * value
        };
        self.shares[place].iter().map(part).sum()
    }
}

/// Places of probes and lines in coordinates of the scene, and where the scene has them.
fn places(scene: &Scene) -> (Vec<Vector>, Vec<String>) {
    let (mut places, mut paths) = (Vec::new(), Vec::new());
    for (k, probe) in scene.output.probes.iter().enumerate() {
        places.push(vector(&probe.place_m));
        paths.push(format!("/output/probes/{k}/place_m"));
    }
    for (k, line) in scene.output.lines.iter().enumerate() {
        let (from, to) = (vector(&line.from_m), vector(&line.to_m));
        for n in 0..line.points {
            let t = n as f64 / (line.points - 1) as f64;
            places.push(std::array::from_fn(|a| from[a] + t * (to[a] - from[a])));
            paths.push(format!("/output/lines/{k}"));
        }
    }
    (places, paths)
}
