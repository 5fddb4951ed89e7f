//! The surface over the distance from the axis, as an axisymmetric arc should see it.
//!
//! In rings as wide as the grid spacing, about the source or, at rest, about x = y = 0, the height of
//! the surface ([`surface`]) is averaged over the angle and over all frames:
//!
//! ```text
//! h(ring) = 1/N sum_t 1/n sum_k z(r, theta_k, t),    r^2 = (r_in^2 + r_out^2) / 2
//! ```
//!
//! Seen along the radius, r halves the area of its ring, which is the midpoint rule in r^2: the mean
//! over the area, and so the volume below the surface, is exact where the height goes with r^2, and
//! errs by the fourth power of the spacing else. The mean over the angle keeps the volume for
//! whatever shape. What is in flight is surface as well unless the scene says `landed`.

use rayon::prelude::*;

use artefact::Table;

use crate::cloud::Cloud;
use crate::ensemble::Moments;
use crate::mean::{Cells, Smoothing};
use crate::surface;

/// Name of the channel of the surface over the distance from the axis.
pub const PROFILE: &str = "profile";

/// Fewest places of a ring.
const PLACES_LEAST: f64 = 8.0;
/// Places on the way of one spacing along a ring.
const PLACES: f64 = 2.0;

/// Least part of the places and frames of a ring that have metal.
const COVERED: f64 = 0.95;

/// Rings about the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Rings {
    /// Radius that halves the area of each ring \[m\], `[nr]`.
    pub radius: Vec<f64>,
    /// Outer radius of each ring \[m\], `[nr]`.
    pub outer: Vec<f64>,
    /// Where the height is looked up \[m\]: x and y of each place, ring by ring.
    pub places: Vec<[f64; 2]>,
    /// One past the last place of each ring, `[nr]`.
    pub ends: Vec<usize>,
}

/// How many places rings of `spacing` \[m\] within `radius` \[m\] have, about, before any is made.
#[must_use]
pub fn wanted(radius: f64, spacing: f64) -> f64 {
    let rings = radius / spacing;
    rings * (PLACES_LEAST + std::f64::consts::PI * PLACES * rings)
}

impl Rings {
    /// The whole rings of width `spacing` \[m\] within `radius` \[m\].
    #[must_use]
    pub fn new(radius: f64, spacing: f64) -> Self {
        // A millionth of a spacing keeps a radius that is meant to be on the edge of a ring.
        let count = (radius / spacing + 1e-6).floor() as usize;
        let mut rings = Self {
            radius: Vec::with_capacity(count),
            outer: Vec::with_capacity(count),
            places: Vec::new(),
            ends: Vec::with_capacity(count),
        };
        for i in 0..count {
            let (inner, outer) = (i as f64 * spacing, (i + 1) as f64 * spacing);
            let r = (0.5 * (inner * inner + outer * outer)).sqrt();
            let around = std::f64::consts::TAU * r * PLACES / spacing;
            let number = around.ceil().max(PLACES_LEAST) as usize;
            let place = |k: usize| {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / number as f64).sin_cos();
                [r * cos, r * sin]
            };
            rings.places.extend((0..number).map(place));
            rings.radius.push(r);
            rings.outer.push(outer);
            rings.ends.push(rings.places.len());
        }
        rings
    }

    /// Number of rings.
    #[must_use]
    pub fn len(&self) -> usize {
        self.radius.len()
    }

    /// True without rings.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.radius.is_empty()
    }

    /// The places of ring `i`.
    fn of(&self, i: usize) -> std::ops::Range<usize> {
        let from = i.checked_sub(1).map_or(0, |before| self.ends[before]);
        from..self.ends[i]
    }

    /// Area of ring `i` \[m2\].
    fn area(&self, i: usize) -> f64 {
        let inner = i.checked_sub(1).map_or(0.0, |before| self.outer[before]);
        std::f64::consts::PI * (self.outer[i].powi(2) - inner.powi(2))
    }
}

/// The heights of all frames so far.
#[derive(Debug, Clone)]
pub struct Profile {
    /// Height at each place over the frames with metal there, `[places]`.
    pub(crate) places: Vec<Moments>,
    /// Mean height of each ring over the frames with metal in it, `[nr]`.
    pub(crate) rings: Vec<Moments>,
    /// Frames.
    pub(crate) frames: u32,
}

impl Profile {
    /// Nothing seen yet.
    #[must_use]
    pub fn new(rings: &Rings) -> Self {
        Self {
            places: vec![Moments::default(); rings.places.len()],
            rings: vec![Moments::default(); rings.len()],
            frames: 0,
        }
    }

    /// Whether no frame had metal in any ring.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rings.iter().all(|ring| ring.count == 0)
    }

    /// Takes in a frame. Frames come in the order of time, and each place gathers in the order of
    /// the cells, so that the result does not depend on the number of threads.
    pub fn add(&mut self, rings: &Rings, cloud: &Cloud, cells: &Cells, smoothing: &Smoothing) {
        let heights: Vec<Option<f64>> = rings
            .places
            .par_iter()
            .with_min_len(16)
            .map(|place| surface::height(cloud, cells.flat(), *place, smoothing))
            .collect();
        self.frames += 1;
        for (moments, height) in self.places.iter_mut().zip(&heights) {
            if let Some(height) = height {
                moments.add(*height);
            }
        }
        for i in 0..rings.len() {
            let found = || heights[rings.of(i)].iter().flatten();
            if found().next().is_some() {
                let mean = found().sum::<f64>() / found().count() as f64;
                self.rings[i].add(mean);
            }
        }
    }

    /// Standard deviation, over the places of ring `i`, of their means over time \[m\].
    fn spread_angle(&self, rings: &Rings, i: usize) -> f64 {
        let means = || {
            let places = self.places[rings.of(i)].iter();
            places.filter(|m| m.count > 0).map(|m| m.mean)
        };
        let n = means().count().max(1) as f64;
        let mean = means().sum::<f64>() / n;
        (means().map(|m| (m - mean).powi(2)).sum::<f64>() / n).sqrt()
    }

    /// Part of the places and frames of ring `i` with metal.
    fn metal_share(&self, rings: &Rings, i: usize) -> f64 {
        let places = &self.places[rings.of(i)];
        let found: f64 = places.iter().map(|m| f64::from(m.count)).sum();
        found / (places.len() as f64 * f64::from(self.frames.max(1)))
    }

    /// What to tell of rings that metal does not cover: their heights are those of the metal that there is, or 0.
    #[must_use]
    pub fn uncovered(&self, rings: &Rings) -> Option<String> {
        let short = |i: &usize| self.metal_share(rings, *i) < COVERED;
        let count = (0..rings.len()).filter(short).count();
        let first = (0..rings.len()).find(short)?;
        Some(format!(
            "profile: {count} of {} rings, first that up to r = {:.3} mm, have metal at less than {:.0} % of their places and \
             times: their heights are of that alone, or 0, and so are the volumes; take a smaller 'radius_m'",
            rings.len(),
            1e3 * rings.outer[first],
            100.0 * COVERED
        ))
    }

    /// Volume between the surface and z = 0 \[m3\]: above less below, and below alone.
    #[must_use]
    pub fn volumes(&self, rings: &Rings) -> [f64; 2] {
        let volume = |part: &dyn Fn(f64) -> f64| -> f64 {
            let of = |i: usize| part(self.rings[i].mean) * rings.area(i);
            (0..rings.len()).map(of).sum()
        };
        [volume(&|h| h), volume(&|h| (-h).max(0.0))]
    }

    /// The table of the profile. A ring without metal has the height 0 and the share 0.
    #[must_use]
    pub fn table(&self, rings: &Rings, smoothing: &Smoothing) -> Table {
        let each =
            |value: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..rings.len()).map(value).collect() };
        let [net, below] = self.volumes(rings);
        Table::new(rings.len())
            .column("radius_m", "m", rings.radius.iter().copied())
            .column("outer_radius_m", "m", rings.outer.iter().copied())
            .column("height_m", "m", each(&|i| self.rings[i].mean))
            .column(
                "height_spread_angle_m",
                "m",
                each(&|i| self.spread_angle(rings, i)),
            )
            .column(
                "height_spread_time_m",
                "m",
                each(&|i| self.rings[i].deviation()),
            )
            .column("metal_share", "1", each(&|i| self.metal_share(rings, i)))
            .attribute("frames", "1", f64::from(self.frames))
            .attribute("smoothing_length_m", "m", smoothing.length)
            .attribute("net_volume_m3", "m3", net)
            .attribute("depression_m3", "m3", below)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns of particles `d` apart in a disc of 6 mm, from `surface` 4 mm down.
    fn metal(d: f64, surface: impl Fn(f64, f64) -> f64) -> (Cloud, Smoothing) {
        let mut cloud = Cloud::default();
        let reach = 6e-3;
        let n = (reach / d) as i64 + 1;
        // Off the axis: no place is better than another.
        let at = |i: i64, off: f64| (i as f64 + off) * d;
        for i in -n..n {
            for j in -n..n {
                let (x, y) = (at(i, 0.31), at(j, 0.77));
                if x * x + y * y < reach * reach {
                    let column = 0..(4e-3 / d) as i64;
                    let place = |k: i64| [x, y, surface(x, y) - at(k, 0.5)];
                    cloud.position.extend(column.map(place));
                }
            }
        }
        cloud.velocity = vec![[0.0; 3]; cloud.len()];
        cloud.liquid = vec![true; cloud.len()];
        let smoothing = Smoothing {
            length: d,
            spacing: d,
            volume: d * d * d,
        };
        (cloud, smoothing)
    }

    /// The table of the surface in `clouds`, a frame each, within 4 mm.
    fn seen(clouds: &[Cloud], smoothing: &Smoothing) -> Table {
        let rings = Rings::new(4e-3, smoothing.spacing);
        let mut profile = Profile::new(&rings);
        for cloud in clouds {
            let cells = Cells::new(cloud, 2.0 * smoothing.length);
            profile.add(&rings, cloud, &cells, smoothing);
        }
        profile.table(&rings, smoothing)
    }

    #[test]
    fn rings_that_reach_beyond_the_metal_are_told() {
        let (cloud, smoothing) = metal(0.5e-3, |_, _| 0.0);
        let uncovered = |radius: f64| {
            let rings = Rings::new(radius, smoothing.spacing);
            let mut profile = Profile::new(&rings);
            let cells = Cells::new(&cloud, 2.0 * smoothing.length);
            profile.add(&rings, &cloud, &cells, &smoothing);
            profile.uncovered(&rings)
        };
        assert_eq!(uncovered(4e-3), None);
        let told = uncovered(9e-3).unwrap();
        assert!(told.contains("of 18 rings"), "{told}");
    }

    fn worst(table: &Table, name: &str, exact: impl Fn(f64) -> f64) -> f64 {
        let rows = table.values("radius_m").unwrap().iter();
        rows.zip(table.values(name).unwrap())
            .map(|(r, v)| (v - exact(*r)).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_plane_is_level_to_a_thousandth_of_a_spacing() {
        let d = 5e-4;
        let (cloud, smoothing) = metal(d, |_, _| 0.3 * d);
        let table = seen(&[cloud], &smoothing);
        assert_eq!(table.len(), 8);
        assert!(worst(&table, "height_m", |_| 0.3 * d) < 1e-3 * d);
        assert!(worst(&table, "height_spread_angle_m", |_| 0.0) < 1e-3 * d);
        assert!(worst(&table, "height_spread_time_m", |_| 0.0) < 1e-12 * d);
        assert!(worst(&table, "metal_share", |_| 1.0) < 1e-12);
    }

    #[test]
    fn a_paraboloid_comes_back_with_its_volume_at_three_resolutions() {
        let (depth, bend) = (1.5e-3, 120.0);
        let bowl = |r2: f64| -depth + bend * r2;
        let volume = 0.5 * std::f64::consts::PI * depth * depth / bend;
        for (d, part) in [(5e-4, 0.025), (2.5e-4, 7e-3), (1.25e-4, 2e-3)] {
            let (cloud, smoothing) = metal(d, |x, y| bowl(x * x + y * y));
            let table = seen(&[cloud], &smoothing);
            // The mean of the kernel errs by 0.15 d^2 times the curvature, 480 / m.
            let off = worst(&table, "height_m", |r| bowl(r * r));
            assert!(off < 0.04 * d * (d / 5e-4), "{} of {d} m", off / d);
            let found = table.scalar("depression_m3").unwrap() / volume - 1.0;
            assert!(found.abs() < part, "{found} at {d} m");
            // All of it: what is above the surface takes part too.
            let net = std::f64::consts::PI * 16e-6 * (-depth + 0.5 * bend * 16e-6);
            let found = table.scalar("net_volume_m3").unwrap() / net - 1.0;
            assert!(found.abs() < 0.1 * (d / 5e-4).powi(2), "{found} at {d} m");
        }
    }

    #[test]
    fn a_slope_has_no_mean_and_its_spread_and_a_wave_is_seen_in_time() {
        let d = 2.5e-4;
        let (slope, wave) = (0.25, 2e-4);
        let at = |phase: f64| metal(d, |x, _| slope * x + wave * phase);
        let (clouds, smoothing) = ([at(1.0).0, at(-1.0).0], at(0.0).1);
        let table = seen(&clouds, &smoothing);
        let (angle, time) = (slope / 2.0_f64.sqrt(), wave * 2.0_f64.sqrt());
        assert!(worst(&table, "height_m", |_| 0.0) < 1e-3 * d);
        assert!(worst(&table, "height_spread_angle_m", |r| angle * r) < 1e-3 * d);
        assert!(worst(&table, "height_spread_time_m", |_| time) < 1e-3 * d);
        assert!((table.scalar("frames").unwrap() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn where_no_metal_is_the_share_tells() {
        let d = 2.5e-4;
        let (mut cloud, smoothing) = metal(d, |_, _| 0.0);
        let keep: Vec<bool> = cloud.position.iter().map(|p| p[0] > 0.0).collect();
        cloud.retain(&keep);
        let table = seen(&[cloud], &smoothing);
        let share = table.values("metal_share").unwrap();
        assert!(share.iter().all(|s| (s - 0.5).abs() < 0.06), "{share:?}");
        let table = seen(&[], &smoothing);
        assert!(worst(&table, "metal_share", |_| 0.0) < 1e-12);
        assert!(worst(&table, "height_m", |_| 0.0) < 1e-12);
    }
}
