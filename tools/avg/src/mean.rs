//! The kernel mean of one frame at the points of a section (Komen 2019, eq. 4.8):
//!
//! ```text
//! chi_i = sum_b chi_b W_ib / sum_b W_ib
//! ```
//!
//! Velocities are averaged over liquid particles, temperatures over all. A mean extends as far as
//! the kernel does; that metal is only where metal is, and flow only where liquid is, is asked
//! with shares: the share of metal at a point, `V sum_b W_ib` over the same sum in a filled
//! neighbourhood, and the share of liquid in it must both be at least one half, which is what
//! they are on a plane surface and on a plane front.

use kernels::CubicSpline;
use neighbours::Grid;
use rayon::prelude::*;

use crate::cloud::{Cloud, distance};
use crate::grid::{Cut, Section};

/// Least share of metal and of liquid.
const LEAST_SHARE: f64 = 0.5;

/// What one frame shows at one grid point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// Metal is here: temperature and height hold.
    pub metal: bool,
    /// Liquid is here: the velocity holds.
    pub liquid: bool,
    /// Velocity relative to the source \[m/s\].
    pub velocity: [f64; 3],
    /// Temperature \[K\]; 0 when the frames carry none.
    pub temperature: f64,
    /// Height of the averaged particles \[m\].
    pub height: f64,
    /// Share of liquid in the metal, 0..1.
    pub share: f64,
}

/// How the means are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothing {
    /// Smoothing length h \[m\]; the support is 2h.
    pub length: f64,
    /// Grid spacing \[m\].
    pub spacing: f64,
    /// Volume of a particle \[m3\].
    pub volume: f64,
}

/// Sums of a kernel mean.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    all: f64,
    liquid: f64,
    velocity: [f64; 3],
    temperature: f64,
    height: f64,
}

impl Sums {
    fn add(&mut self, w: f64, cloud: &Cloud, b: usize) {
        self.all += w;
        if let Some(temperature) = &cloud.temperature {
            self.temperature += w * temperature[b];
        }
        self.height += w * cloud.position[b][2];
        if cloud.liquid[b] {
            self.liquid += w;
            for k in 0..3 {
                self.velocity[k] += w * cloud.velocity[b][k];
            }
        }
    }

    fn sample(&self, metal: bool) -> Sample {
        if !metal || self.all <= 0.0 {
            return Sample::default();
        }
        let share = self.liquid / self.all;
        let liquid = share >= LEAST_SHARE;
        Sample {
            metal,
            liquid,
            velocity: if liquid {
                self.velocity.map(|u| u / self.liquid)
            } else {
                [0.0; 3]
            },
            temperature: self.temperature / self.all,
            height: self.height / self.all,
            share,
        }
    }
}

/// The particles of a frame sorted into cells: in space, and as seen from above.
#[derive(Debug, Clone)]
pub struct Cells {
    space: Grid,
    flat: Grid,
}

impl Cells {
    /// Sorts `cloud` for searches within `support` \[m\].
    #[must_use]
    pub fn new(cloud: &Cloud, support: f64) -> Self {
        let (mut space, mut flat) = (Grid::new(support), Grid::new(support));
        space.bin(&cloud.position);
        let shadow: Vec<[f64; 3]> = cloud.position.iter().map(|x| [x[0], x[1], 0.0]).collect();
        flat.bin(&shadow);
        Self { space, flat }
    }

    /// The shadows on the plan, at height 0.
    pub(crate) fn flat(&self) -> &Grid {
        &self.flat
    }
}

/// Kernel means of `cloud` at every point of `section`. Each point gathers in the order of the
/// cells, so that the result does not depend on the number of threads.
#[must_use]
pub fn section(
    cloud: &Cloud,
    cells: &Cells,
    section: &Section,
    smoothing: &Smoothing,
) -> Vec<Sample> {
    let points = (0..section.len()).into_par_iter().with_min_len(64);
    match section.cut {
        Cut::Plane {
            axis,
            at,
            half_thickness,
        } => {
            let full = inside_slab(smoothing.length, half_thickness) / smoothing.volume;
            let slab = |x: [f64; 3]| (x[axis] - at).abs() <= half_thickness;
            points
                .map(|i| {
                    in_plane(
                        cloud,
                        &cells.space,
                        section.point(i),
                        smoothing.length,
                        &slab,
                    )
                })
                .map(|sums| sums.sample(sums.all >= LEAST_SHARE * full))
                .collect()
        }
        Cut::Surface { layer } => points
            .map(|i| on_top(cloud, &cells.flat, section.point(i), smoothing, layer))
            .map(|sums| sums.sample(sums.all > 0.0))
            .collect(),
    }
}

fn in_plane(
    cloud: &Cloud,
    cells: &Grid,
    point: [f64; 3],
    length: f64,
    slab: &impl Fn([f64; 3]) -> bool,
) -> Sums {
    let kernel = CubicSpline::<3>::new(length);
    let mut sums = Sums::default();
    cells.runs(point, kernel.support(), |run| {
        for k in run {
            let x = cells.sorted()[k];
            if slab(x) {
                let w = kernel.value(distance(point, x));
                if w > 0.0 {
                    sums.add(w, cloud, cells.order()[k] as usize);
                }
            }
        }
    });
    sums
}

/// The topmost metal of the column at `point`: particles at most `layer` lower than the highest one
/// within one grid spacing, weighted by the two-dimensional kernel of the horizontal distance.
/// Nothing where no particle is within one grid spacing.
fn on_top(cloud: &Cloud, flat: &Grid, point: [f64; 3], smoothing: &Smoothing, layer: f64) -> Sums {
    let kernel = CubicSpline::<2>::new(smoothing.length);
    let reach = kernel.support().max(smoothing.spacing);
    let mut top = f64::NEG_INFINITY;
    let mut near = Vec::new();
    flat.runs(point, reach, |run| {
        for k in run {
            let r = distance(point, flat.sorted()[k]);
            let b = flat.order()[k] as usize;
            if r < smoothing.spacing {
                top = top.max(cloud.position[b][2]);
            }
            if r < kernel.support() {
                near.push((b, kernel.value(r)));
            }
        }
    });
    let mut sums = Sums::default();
    for (b, w) in near {
        if w > 0.0 && cloud.position[b][2] >= top - layer && top.is_finite() {
            sums.add(w, cloud, b);
        }
    }
    sums
}

/// The part of the kernel's integral within `half_thickness` of a plane through its centre, by
/// Simpson's rule over the plane integrals `m(x) = 2 pi int_x^2h W(r) r dr`.
fn inside_slab(length: f64, half_thickness: f64) -> f64 {
    let kernel = CubicSpline::<3>::new(length);
    let end = kernel.support();
    let reach = half_thickness.min(end);
    let ring = |r: f64| 2.0 * std::f64::consts::PI * r * kernel.value(r);
    2.0 * simpson(0.0, reach, |x| simpson(x, end, ring))
}

fn simpson(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let n = 64;
    let step = (to - from) / f64::from(n);
    let sum: f64 = (0..=n)
        .map(|i| {
            let weight = if i == 0 || i == n {
                1.0
            } else {
                2.0 + 2.0 * f64::from(i % 2)
            };
            weight * f(from + f64::from(i) * step)
        })
        .sum();
    sum * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMOOTHING: Smoothing = Smoothing {
        length: 1.0,
        spacing: 1.0,
        volume: 1.0,
    };

    /// A block of liquid on the lattice of half-integers, z below 0, with the given fields.
    fn block(
        velocity: impl Fn([f64; 3]) -> [f64; 3],
        temperature: impl Fn([f64; 3]) -> f64,
    ) -> Cloud {
        let mut cloud = Cloud::default();
        for i in -6..6 {
            for j in -6..6 {
                for k in -6..0 {
                    let x = [f64::from(i) + 0.5, f64::from(j) + 0.5, f64::from(k) + 0.5];
                    cloud.position.push(x);
                    cloud.velocity.push(velocity(x));
                    cloud
                        .temperature
                        .get_or_insert_default()
                        .push(temperature(x));
                    cloud.liquid.push(true);
                }
            }
        }
        cloud
    }

    fn cut() -> Section {
        let plane = Cut::Plane {
            axis: 0,
            at: 0.0,
            half_thickness: 1.0,
        };
        Section::new("section_x0", plane, [[-3.0, 3.0], [-3.0, 2.0]], 1.0)
    }

    fn means(cloud: &Cloud, at: &Section) -> Vec<Sample> {
        section(cloud, &Cells::new(cloud, 2.0), at, &SMOOTHING)
    }

    #[test]
    fn a_uniform_field_is_exact_wherever_there_is_metal() {
        let cloud = block(|_| [0.5, -0.25, 2.0], |_| 2000.0);
        let section = cut();
        for (i, sample) in means(&cloud, &section).iter().enumerate() {
            let z = section.point(i)[2];
            assert_eq!(sample.liquid, z <= 0.0, "at height {z}");
            if sample.liquid {
                assert!((sample.velocity[2] - 2.0).abs() < 1e-14);
                assert!((sample.temperature - 2000.0).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn a_linear_field_is_exact_at_symmetric_interior_points() {
        let u = |x: [f64; 3]| [x[1] - x[2], 2.0 * x[1] + 0.5 * x[2], 3.0 - x[0] + x[1]];
        let cloud = block(u, |x| 2000.0 + 10.0 * x[1] - 4.0 * x[2]);
        let section = cut();
        let found = means(&cloud, &section);
        for (i, sample) in found.iter().enumerate() {
            let x = section.point(i);
            if x[2] <= -2.0 && x[2] >= -4.0 {
                let exact = u(x);
                for (mean, exact) in sample.velocity.iter().zip(exact) {
                    assert!((mean - exact).abs() < 1e-13, "{x:?}");
                }
                let t = 2000.0 + 10.0 * x[1] - 4.0 * x[2];
                assert!((sample.temperature - t).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_share_of_metal_is_one_half_on_the_surface() {
        let cloud = block(|_| [0.0; 3], |_| 2000.0);
        let point = [0.0, 0.0, 0.0];
        let cells = Cells::new(&cloud, 2.0);
        let sums = in_plane(&cloud, &cells.space, point, 1.0, &|x| x[0].abs() <= 1.0);
        let share = sums.all / inside_slab(1.0, 1.0);
        assert!((share - 0.5).abs() < 0.05, "{share}");
        assert!((inside_slab(1.0, 5.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_surface_takes_the_top_layer_only() {
        let cloud = block(|x| [x[2], 0.0, 0.0], |x| 1000.0 - 100.0 * x[2]);
        let section = Section::new(
            "surface",
            Cut::Surface { layer: 0.6 },
            [[-2.0, 2.0], [-9.0, 2.0]],
            1.0,
        );
        for (i, sample) in means(&cloud, &section).iter().enumerate() {
            let y = section.point(i)[1];
            assert_eq!(sample.metal, y > -6.5, "at {y}");
            if sample.metal {
                assert!((sample.velocity[0] + 0.5).abs() < 1e-14);
                assert!((sample.temperature - 1050.0).abs() < 1e-9);
                assert!((sample.height + 0.5).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn solid_metal_has_a_temperature_and_no_velocity() {
        let mut cloud = block(|_| [1.0; 3], |_| 900.0);
        cloud.liquid.fill(false);
        let section = cut();
        let found = means(&cloud, &section);
        assert!(found.iter().any(|s| s.metal));
        assert!(
            found
                .iter()
                .all(|s| !s.liquid && s.velocity.iter().all(|u| u.abs() < f64::MIN_POSITIVE))
        );
    }

    #[test]
    fn threads_change_no_bit() {
        let cloud = block(|x| [x[0].sin(), x[1].cos(), x[2]], |x| x[0].exp());
        let with = |n: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(n)
                .build()
                .unwrap();
            pool.install(|| means(&cloud, &cut()))
        };
        let bits = |samples: Vec<Sample>| -> Vec<u64> {
            samples
                .iter()
                .map(|s| s.velocity[0].to_bits() ^ s.temperature.to_bits())
                .collect()
        };
        assert_eq!(bits(with(1)), bits(with(2)));
    }
}
