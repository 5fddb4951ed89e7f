//! Fields between the points: at probes and along lines.

use run::{Failure, Fault};
use shapes::frame::Vector;
use wls::{Condition, Plan, Reach, Rules, Search, Stencils, Wants};

use super::Column;
use crate::cloud::layout::vector;
use crate::cloud::{self, Class, Cloud};
use crate::geometry::Geometry;
use crate::scene::{Interfaces, Scene};
use crate::solve::setup::numerics;
use crate::stencils::region::Region;
use crate::stencils::setup::region;
use crate::stencils::sides::Form;

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
    /// For any quantity; none where all are harmonic.
    any: Vec<Vec<Share>>,
    /// For quantities that have no Laplacian in a medium; none where no quantity is known to have none.
    harmonic: Vec<Vec<Share>>,
}

/// Points of the medium in which a place lies.
struct Within<'a, const D: usize> {
    region: &'a Region<D>,
    media: &'a [u16],
    harmonic: bool,
}

impl<const D: usize> Rules<D> for Within<'_, D> {
    fn allowed(&self, i: usize, j: usize) -> bool {
        self.region.touches(j, self.media[i])
    }

    fn conditions(&self, _: usize, conditions: &mut Vec<Condition<D>>) {
        if self.harmonic {
            conditions.push(Condition::Harmonic);
        }
    }
}

/// The polynomials of a potential between the points where they are harmonic at the points too.
fn harmonic_form<const D: usize>(scene: &Scene) -> Option<Form> {
    let one_sided = matches!(scene.method.interfaces, Interfaces::OneSided(_));
    let straight = scene.geometry != Geometry::Axisymmetric;
    let form = numerics(scene).form.for_harmonics(D);
    (scene.electrostatics.is_some() && one_sided && straight && form.compares()).then_some(form)
}

/// Points for each coefficient of a harmonic polynomial between the points: fewer than equations take, since nothing
/// has to be stable and an error grows with the order of the distance.
const POINTS: f64 = 4.0 / 3.0;

/// The support of a harmonic polynomial.
fn nearest<const D: usize>(order: u8) -> Reach {
    let order = usize::from(order);
    let coefficients = if D == 2 {
        2 * order + 1
    } else {
        (order + 1) * (order + 1)
    };
    Reach::Nearest((POINTS * coefficients as f64).ceil() as usize)
}

impl Samples {
    /// The probes and lines of a scene.
    ///
    /// # Errors
    /// Where one lies outside the domain, or too few points lie about it.
    pub fn new<const D: usize>(scene: &Scene, cloud: &Cloud) -> Result<Self, Failure> {
        let layout = cloud::setup::layout(scene);
        let (own, paths) = places(scene);
        if own.is_empty() {
            return Ok(Self::default());
        }
        let mut faults: Vec<Fault> = Vec::new();
        for (x, path) in own.iter().zip(&paths) {
            if layout.depth(*x) < -1e-9 * layout.spacing {
                let what = format!("({}, {}, {}) m lies outside the domain", x[0], x[1], x[2]);
                faults.push(Fault::at(path, what));
            }
        }
        if !faults.is_empty() {
            faults.dedup_by(|a, b| a.path() == b.path());
            return Err(faults.into());
        }
        let region = region::<D>(scene, cloud, &|_| false);
        let media: Vec<u16> = own.iter().map(|x| layout.medium(*x)).collect();
        let flat: Vec<[f64; D]> = own.iter().map(|x| std::array::from_fn(|k| x[k])).collect();
        let about = wls::Cloud {
            points: &region.places,
            metrics: &region.metrics,
        };
        let failed = |error: wls::Error| Failure::Other(format!("probes and lines: {error}"));
        let search = Search::new(about).map_err(failed)?;
        let wants = Wants {
            value: true,
            ..Wants::default()
        };
        let make = |plan: Plan, harmonic: bool| {
            let rules = Within {
                region: &region,
                media: &media,
                harmonic,
            };
            let stencils = Stencils::at(&search, &plan, &flat, &rules).map_err(failed)?;
            Ok::<_, Failure>(shares(cloud, &media, &stencils))
        };
        let harmonic = harmonic_form::<D>(scene).map(|form| {
            let reach = nearest::<D>(form.order);
            let plan = form.between::<D>(wants);
            make(Plan { reach, ..plan }, true)
        });
        let harmonic = harmonic.transpose()?.unwrap_or_default();
        let any = if harmonic.is_empty() || scene.eddy_currents.is_some() {
            let order = (scene.method.order as u8).max(2);
            make(Plan::new::<D>(order, wants), false)?
        } else {
            Vec::new()
        };
        let places = own.iter().map(|x| scene.geometry.place(*x)).collect();
        Ok(Self {
            places,
            any,
            harmonic,
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
        let shares = if column.harmonic && !self.harmonic.is_empty() {
            &self.harmonic
        } else {
            &self.any
        };
        shares[place].iter().map(part).sum()
    }
}

/// Points and weights of places in `media`.
fn shares<const D: usize>(cloud: &Cloud, media: &[u16], stencils: &Stencils<D>) -> Vec<Vec<Share>> {
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
    (0..media.len()).map(share).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    const SPHERE: &str = r#"{"geometry": "space", "domain": {"box": {"min_m": [-6, -6, -6], "max_m": [6, 6, 6]}},
        "bodies": [{"name": "sphere", "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}},
        "relative_permittivity": 80}], "electrostatics": {"outer": [{"potential_v": 0}]},
        "points": {"spacing_m": 0.125}, "method": {"order": 4},
        "output": {"lines": [{"name": "z", "from_m": [0, 0, 0], "to_m": [0, 0, 3], "points": 100}]}}"#;

    /// Potential of a dielectric sphere in a field of 1.
    fn potential(x: Vector) -> f64 {
        let r = shapes::frame::length(x);
        if r < 1.0 {
            3.0 / 82.0 * x[2]
        } else {
            x[2] * (1.0 - 79.0 / 82.0 / r.powi(3))
        }
    }

    /// Greatest error along the line, of a column that knows exact values at the points.
    fn worst(samples: &Samples, column: &Column) -> f64 {
        let far = |(n, x): (usize, &Vector)| (samples.value(n, column) - potential(*x)).abs();
        let places = samples.places.iter().enumerate();
        places.map(far).fold(0.0, f64::max)
    }

    #[test]
    fn harmonic_polynomials_follow_a_potential_between_the_points() {
        let scene: Scene = serde_json::from_str(SPHERE).unwrap();
        let cloud = cloud::setup::cloud(&scene).unwrap();
        let values: Vec<f64> = cloud.position.iter().map(|x| potential(*x)).collect();
        let column = Column::new("potential", "V", values);
        let samples = Samples::new::<3>(&scene, &cloud).unwrap();
        assert!(
            samples.any.is_empty(),
            "nothing asks for another polynomial"
        );
        let harmonic = worst(&samples, &column.clone().without_laplacian());
        let smeared = r#"{"smeared": {}}"#;
        let mut other = scene.clone();
        other.method.interfaces = serde_json::from_str(smeared).unwrap();
        let samples = Samples::new::<3>(&other, &cloud).unwrap();
        let any = worst(&samples, &column.without_laplacian());
        assert!(
            harmonic < 4e-4 && harmonic < 0.4 * any,
            "{harmonic:.1e} {any:.1e}"
        );
    }
}
