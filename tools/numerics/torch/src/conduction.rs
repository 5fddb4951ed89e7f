//! What a torch warms where heat is only conducted: exact in a plate of constant properties.
//!
//! A distribution q that has spread for the time s is q as the mean over a cloud of the variance 2 alpha s, so that a torch which goes
//! straight ahead from x_0 at the speed v has warmed the metal after the time t by
//!
//! ```text
//! T - T_0 = P/(rho c) int_0^t sum_i q(x_i - x_0 - v (t - s) e; 2 alpha s) ds
//! ```
//!
//! with the images x_i of the place in the faces of the plate. It is Eagar and Tsai (1983) for a Gaussian on the surface, and for a double
//! ellipsoid the solution of Fachinotti, Anca and Cardona (2011), with halves that end at the torch.

use crate::shape::Shape;

/// Beyond so many standard deviations nothing is left: exp(-reach^2/2) is 3e-14.
const REACH: f64 = 7.9;
/// Points of each piece of the integral.
const POINTS: usize = 8;
/// Greatest growth of s within a piece.
const GROWTH: f64 = 0.5;

/// A plate of constant properties, with the surface that the torch points at. Places are ahead of the start of the torch, across its path,
/// and below the surface \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// lambda \[W/(m K)\].
    pub conductivity_w_m_k: f64,
    /// rho c \[J/(m3 K)\].
    pub capacity_j_m3_k: f64,
    /// Where the plate ends behind and ahead of the start, and at both sides of the path; none where it goes on. No heat leaves by its ends.
    pub ends_m: [[Option<f64>; 2]; 2],
    /// How thick it is; none where it goes down for ever.
    pub thickness_m: Option<f64>,
}

impl Plate {
    /// Rise of temperature per watt \[K/W\] at a place, after the time `seconds` of a torch of this shape that moves at `speed`.
    #[must_use]
    pub fn rise_per_watt(&self, shape: &Shape, speed: f64, place: [f64; 3], seconds: f64) -> f64 {
        let alpha = self.conductivity_w_m_k / self.capacity_j_m3_k;
        let rule = quadrature::gauss(POINTS);
        // Heat of its own width has spread by as much again after this time.
        let own = shape.least() * shape.least() / (12.0 * alpha);
        let (mut from, mut sum) = (0.0_f64, 0.0);
        while from < seconds {
            // No piece is longer than the torch takes to pass what its heat has spread to.
            let passes = (2.0 * alpha * (from + own)).sqrt() / speed;
            let to = seconds.min(from + (GROWTH * (from + own)).min(passes));
            // The root of s makes heat of a surface smooth at 0: ds = 2 w dw.
            let (low, high) = (from.sqrt(), to.sqrt());
            for (x, weight) in &rule {
                let w = 0.5 * (low + high + x * (high - low));
                let s = w * w;
                let gone = speed * (seconds - s);
                sum += weight * w * (high - low) * self.spread(shape, gone, place, 2.0 * alpha * s);
            }
            from = to;
        }
        sum / self.capacity_j_m3_k
    }

    /// Sum of q over all images of a place, when the torch is `gone` metres ahead of its start \[1/m3\].
    fn spread(&self, shape: &Shape, gone: f64, place: [f64; 3], variance: f64) -> f64 {
        let wide = shape.greatest();
        let reach = REACH * (wide * wide / 6.0 + variance).sqrt();
        let ahead = images(self.ends_m[0], place[0], gone, reach);
        let across = images(self.ends_m[1], place[1], 0.0, reach);
        // q is that of a half space: the surface has been mirrored at.
        let deep = match self.thickness_m {
            Some(thick) => images([Some(-thick), Some(thick)], place[2], 0.0, reach),
            None => vec![place[2]],
        };
        let mut sum = 0.0;
        for xi in &ahead {
            for eta in &across {
                let line = deep
                    .iter()
                    .map(|zeta| shape.spread([*xi, *eta, *zeta], variance));
                sum += line.sum::<f64>();
            }
        }
        sum
    }
}

/// Distances of the images of `x` in two faces from a source, as far as they are within reach.
fn images(faces: [Option<f64>; 2], x: f64, source: f64, reach: f64) -> Vec<f64> {
    let within = |image: f64| Some(image - source).filter(|away| away.abs() < reach);
    let [low, high] = match faces {
        [Some(low), Some(high)] => [low, high],
        [Some(face), None] | [None, Some(face)] => {
            return [x, 2.0 * face - x].into_iter().filter_map(within).collect();
        }
        [None, None] => return within(x).into_iter().collect(),
    };
    let period = 2.0 * (high - low);
    let count = (reach / period).ceil() + 1.0;
    (-count as i64..=count as i64)
        .flat_map(|n| [x, 2.0 * low - x].map(|image| image + n as f64 * period))
        .filter_map(within)
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::shape::{DoubleEllipsoid, Gaussian};

    const STEEL: Plate = Plate {
        conductivity_w_m_k: 40.0,
        capacity_j_m3_k: 4e6,
        ends_m: [[None; 2]; 2],
        thickness_m: None,
    };

    fn goldak(scale: f64) -> Shape {
        Shape::DoubleEllipsoid(DoubleEllipsoid {
            half_width_m: 3e-3 * scale,
            depth_m: 2e-3 * scale,
            front_m: 2e-3 * scale,
            rear_m: 5e-3 * scale,
            front_fraction: None,
        })
    }

    #[test]
    fn far_from_a_torch_is_what_rosenthal_says() {
        // P/(2 pi lambda R) exp(-v (xi + R)/(2 alpha)) in a half space, with xi ahead (Rosenthal 1941).
        let (speed, seconds) = (0.01, 60.0);
        for at in [[-4e-3, 3e-3, 2e-3], [2e-3, 0.0, 3e-3], [-20e-3, 0.0, 0.0]] {
            let [xi, eta, zeta]: [f64; 3] = at;
            let distance = (xi * xi + eta * eta + zeta * zeta).sqrt();
            let exact = (-speed * (xi + distance) / 2e-5).exp() / (2.0 * PI * 40.0 * distance);
            let place = [xi + speed * seconds, eta, zeta];
            // Without a middle of its own behind the torch, as unequal halves have.
            let even = Shape::DoubleEllipsoid(DoubleEllipsoid {
                half_width_m: 6e-5,
                depth_m: 4e-5,
                front_m: 5e-5,
                rear_m: 5e-5,
                front_fraction: None,
            });
            for shape in [even, Shape::Gaussian(Gaussian { radius_m: 5e-5 })] {
                let found = STEEL.rise_per_watt(&shape, speed, place, seconds);
                assert!((found / exact - 1.0).abs() < 2e-3, "{at:?} {found} {exact}");
            }
        }
    }

    #[test]
    fn a_closed_plate_holds_all_heat() {
        let plate = Plate {
            ends_m: [[Some(-6e-3), Some(18e-3)], [Some(-5e-3), Some(7e-3)]],
            thickness_m: Some(4e-3),
            ..STEEL
        };
        // Sums over a lattice of 1 mm: exact but for harmonics, 2 exp(-2 pi^2 A/d^2) with the least variance A.
        let (size, cells) = (1e-3, [24, 12, 4]);
        for seconds in [0.3, 1.5] {
            let mut sum = 0.0;
            for i in 0..cells[0] {
                for j in 0..cells[1] {
                    for k in 0..cells[2] {
                        let [x, y, z] = [i, j, k].map(|n| (f64::from(n) + 0.5) * size);
                        let at = [x - 6e-3, y - 5e-3, z];
                        sum += plate.rise_per_watt(&goldak(1.0), 0.008, at, seconds);
                    }
                }
            }
            let held = sum * size.powi(3) * plate.capacity_j_m3_k;
            assert!((held / seconds - 1.0).abs() < 1e-4, "{held} {seconds}");
        }
    }

    #[test]
    fn equal_halves_are_three_bells() {
        let half = [4e-3_f64, 3e-3, 2.5e-3];
        let shape = Shape::DoubleEllipsoid(DoubleEllipsoid {
            half_width_m: half[1],
            depth_m: half[2],
            front_m: half[0],
            rear_m: half[0],
            front_fraction: None,
        });
        let (speed, seconds, place) = (0.01, 1.0, [7e-3, 2e-3, 1e-3]);
        let pieces = 20_000;
        let step = seconds / f64::from(pieces);
        let sum: f64 = (0..pieces)
            .map(|k| {
                let s = (f64::from(k) + 0.5) * step;
                let own = [place[0] - speed * (seconds - s), place[1], place[2]];
                let bell = |k: usize| {
                    let spread = half[k] * half[k] / 6.0 + 2e-5 * s;
                    (-own[k] * own[k] / (2.0 * spread)).exp() / (2.0 * PI * spread).sqrt()
                };
                2.0 * bell(0) * bell(1) * bell(2) * step / 4e6
            })
            .sum();
        let found = STEEL.rise_per_watt(&shape, speed, place, seconds);
        assert!((found / sum - 1.0).abs() < 1e-6, "{found} {sum}");
    }

    #[test]
    fn unequal_halves_are_a_sum_over_the_places_of_their_heat() {
        let Shape::DoubleEllipsoid(halves) = goldak(1.0) else {
            return;
        };
        let (speed, seconds, alpha) = (0.01, 0.8, 1e-5);
        for place in [[9e-3, 1e-3, 1e-3], [8e-3, 0.0, 0.0], [2e-3, 2e-3, 0.5e-3]] {
            // Bells of a source that has no length along its path, at every place u of it.
            let (pieces, step) = (600, seconds / 600.0);
            let mut sum = 0.0;
            for k in 0..pieces {
                let s = (f64::from(k) + 0.5) * step;
                let bell = |x: f64, spread: f64| {
                    (-x * x / (2.0 * spread)).exp() / (2.0 * PI * spread).sqrt()
                };
                let section =
                    2.0 * bell(
                        place[1],
                        halves.half_width_m.powi(2) / 6.0 + 2.0 * alpha * s,
                    ) * bell(place[2], halves.depth_m.powi(2) / 6.0 + 2.0 * alpha * s);
                let part = 2e-5;
                for j in -800..800 {
                    let u = (f64::from(j) + 0.5) * part;
                    let half = if u > 0.0 {
                        halves.front_m
                    } else {
                        halves.rear_m
                    };
                    let share = 2.0 * half / (halves.front_m + halves.rear_m);
                    let here = share * bell(u, half * half / 6.0) * part;
                    let away = place[0] - speed * (seconds - s) - u;
                    sum += here * section * bell(away, 2.0 * alpha * s) * step / 4e6;
                }
            }
            let found = STEEL.rise_per_watt(&goldak(1.0), speed, place, seconds);
            assert!((found / sum - 1.0).abs() < 2e-4, "{found} {sum}");
        }
    }

    #[test]
    fn all_lengths_twice_and_times_four_times_give_half_the_rise() {
        let place = [4e-3, 1e-3, 1e-3];
        let one = STEEL.rise_per_watt(&goldak(1.0), 0.01, place, 0.5);
        let two = STEEL.rise_per_watt(&goldak(2.0), 0.005, place.map(|x| 2.0 * x), 2.0);
        assert!((2.0 * two / one - 1.0).abs() < 1e-12, "{one} {two}");
        assert_eq!(
            STEEL.rise_per_watt(&goldak(1.0), 0.0, place, 0.0).to_bits(),
            0
        );
    }
}
