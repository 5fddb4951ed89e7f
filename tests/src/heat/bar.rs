//! Transient conduction along x with `k = A exp(B x + a T)` and both ends held.
//!
//! Finite volumes about nodes on a grid that is finer toward both ends; the flux between nodes is
//! exact for a steady profile: `(exp(a T2) - exp(a T1)) / a` over the integral of `1 / (A exp(B x))`
//! (Kirchhoff and harmonic). Time by [`super::sdirk`] with Newton's method. Two grids, one of half
//! the spacing, give a value without the error of second order (Richardson).

use super::plate::Plate;
use super::sdirk::{March, Stiff, march};

/// Nodes are this much denser at the ends than evenly spread ones (0 even, below 1).
const DENSITY: f64 = 0.8;

/// The problem.
#[derive(Debug, Clone, Copy)]
pub struct Bar {
    /// Conductivity, ends and what they are held at.
    pub plate: Plate,
    /// Density times specific heat \[J/(m3 K)\].
    pub capacity: f64,
    /// Temperature at the start \[K\].
    pub start: f64,
}

/// Temperatures along the bar at some times.
#[derive(Debug, Clone)]
pub struct Profiles {
    /// Nodes \[m\].
    pub x: Vec<f64>,
    /// Temperatures by time and node \[K\].
    pub temperature: Vec<Vec<f64>>,
    /// Largest difference between the extrapolated and the finer grid's values \[K\].
    pub correction: f64,
}

impl Profiles {
    /// The temperature at `x` at the time of index `time`, by a cubic through four nodes.
    #[must_use]
    pub fn value(&self, time: usize, x: f64) -> f64 {
        let n = self.x.len();
        let first = self.x.partition_point(|node| *node < x);
        let first = first.saturating_sub(2).min(n - 4);
        let (nodes, values) = (&self.x[first..first + 4], &self.temperature[time][first..]);
        let mut sum = 0.0;
        for i in 0..4 {
            let mut weight = 1.0;
            for j in (0..4).filter(|j| *j != i) {
                weight *= (x - nodes[j]) / (nodes[i] - nodes[j]);
            }
            sum += weight * values[i];
        }
        sum
    }
}

/// Profiles at the times `at` \[s\] from grids of `intervals` and `2 intervals`; `None` when the
/// march fails.
#[must_use]
pub fn profiles(bar: &Bar, at: &[f64], intervals: usize, tolerance: f64) -> Option<Profiles> {
    let (x, coarse) = solve(bar, at, intervals, tolerance)?;
    let (_, fine) = solve(bar, at, 2 * intervals, tolerance)?;
    let mut correction = 0.0_f64;
    let mut temperature = Vec::new();
    for (coarse, fine) in coarse.iter().zip(&fine) {
        let better = coarse.iter().enumerate().map(|(i, c)| {
            let change = (fine[2 * i] - c) / 3.0;
            correction = correction.max(change.abs());
            fine[2 * i] + change
        });
        temperature.push(better.collect());
    }
    Some(Profiles {
        x,
        temperature,
        correction,
    })
}

type Solved = (Vec<f64>, Vec<Vec<f64>>);

fn solve(bar: &Bar, at: &[f64], intervals: usize, tolerance: f64) -> Option<Solved> {
    let grid = Grid::new(bar, intervals);
    let mut start = vec![bar.start; intervals + 1];
    start[0] = bar.plate.held[0];
    start[intervals] = bar.plate.held[1];
    let range = grid.range;
    let how = March {
        tolerance: tolerance * (range[1] - range[0]).max(f64::MIN_POSITIVE),
        first_s: 1e-6 * at.first()?,
    };
    let found = march(&grid, &start, at, how)?;
    Some((grid.x, found))
}

struct Grid {
    x: Vec<f64>,
    /// Exponent with temperature \[1/K\].
    a: f64,
    /// Conductance of each interval at T = 0 \[W/(m2 K)\].
    conductance: Vec<f64>,
    /// Heat capacity of each node \[J/(m2 K)\].
    capacity: Vec<f64>,
    /// Lowest and highest temperature that may occur \[K\].
    range: [f64; 2],
}

impl Grid {
    fn new(bar: &Bar, intervals: usize) -> Self {
        use std::f64::consts::TAU;
        let [from, to] = bar.plate.faces;
        let place = |i: usize| {
            let s = i as f64 / intervals as f64;
            from + (to - from) * (s - DENSITY * (TAU * s).sin() / TAU)
        };
        let x: Vec<f64> = (0..=intervals).map(place).collect();
        let k = bar.plate.conductivity;
        let conductance = x.windows(2).map(|w| {
            let b = k.along_x;
            let length = if (b * (w[1] - w[0])).abs() < 1e-12 {
                w[1] - w[0]
            } else {
                -(-b * (w[1] - w[0])).exp_m1() / b
            };
            k.value(w[0], 0.0) / length
        });
        let width = |i: usize| 0.5 * (x[(i + 1).min(intervals)] - x[i.saturating_sub(1)]);
        let ends = [bar.plate.held[0], bar.plate.held[1], bar.start];
        Self {
            a: k.with_temperature,
            conductance: conductance.collect(),
            capacity: (0..=intervals).map(|i| bar.capacity * width(i)).collect(),
            range: [
                ends.iter().copied().fold(f64::INFINITY, f64::min),
                ends.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ],
            x,
        }
    }

    /// `(exp(a T2) - exp(a T1)) / a`.
    fn kirchhoff(&self, from: f64, to: f64) -> f64 {
        if (self.a * (to - from)).abs() < 1e-12 {
            return (self.a * from).exp() * (to - from);
        }
        (self.a * from).exp() * (self.a * (to - from)).exp_m1() / self.a
    }
}

impl Stiff for Grid {
    fn implicit(&self, base: &[f64], dt: f64, t: &mut Vec<f64>) -> bool {
        let n = t.len();
        let scale = (self.range[1] - self.range[0]).max(f64::MIN_POSITIVE);
        for _ in 0..30 {
            // Residual and the three diagonals at the inner nodes.
            let slope: Vec<f64> = t.iter().map(|t| (self.a * t).exp()).collect();
            let mut upper = vec![0.0; n];
            let mut change = vec![0.0; n];
            for i in 1..n - 1 {
                let (west, east) = (self.conductance[i - 1], self.conductance[i]);
                let inflow =
                    east * self.kirchhoff(t[i], t[i + 1]) - west * self.kirchhoff(t[i - 1], t[i]);
                let store = self.capacity[i] / dt;
                let residual = store * (base[i] - t[i]) + inflow;
                let lower = -west * slope[i - 1];
                let pivot = store + (west + east) * slope[i] - lower * upper[i - 1];
                upper[i] = -east * slope[i + 1] / pivot;
                change[i] = (residual - lower * change[i - 1]) / pivot;
            }
            let mut worst = 0.0_f64;
            for i in (1..n - 1).rev() {
                change[i] -= upper[i] * change[i + 1];
                worst = worst.max(change[i].abs());
                // Far outside the data the exponential would run away.
                let [low, high] = self.range;
                t[i] = (t[i] + change[i]).clamp(low - 0.5 * scale, high + 0.5 * scale);
            }
            if !worst.is_finite() {
                return false;
            }
            // The error after this change is of the order of its square.
            if worst < 1e-9 * scale {
                return true;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat::property::Exponential;
    use crate::special::erf;

    fn bar(along_x: f64, with_temperature: f64) -> Bar {
        Bar {
            plate: Plate {
                conductivity: Exponential {
                    scale: 1.0,
                    along_x,
                    with_temperature,
                },
                faces: [0.0, 1.0],
                held: [0.0, 1.0],
            },
            capacity: 1.0,
            start: 0.0,
        }
    }

    #[test]
    fn a_constant_conductivity_gives_the_error_function() {
        let found = profiles(&bar(0.0, 0.0), &[0.005, 0.01], 200, 1e-6).unwrap();
        for (i, t) in [0.005_f64, 0.01].iter().enumerate() {
            for x in [0.5, 0.73, 0.8, 0.91, 0.987] {
                let wanted = 1.0 - erf((1.0 - x) / (2.0 * t.sqrt()));
                let miss = (found.value(i, x) - wanted).abs();
                assert!(miss < 2e-6, "{t} {x}: {miss:e}");
            }
        }
    }

    #[test]
    fn it_ends_at_the_steady_profile() {
        for (b, a) in [(0.5, 0.0), (0.0, 4.0), (0.0, -3.0), (0.3, 1.0)] {
            let bar = bar(b, a);
            let found = profiles(&bar, &[40.0], 60, 1e-5).unwrap();
            for (i, x) in found.x.iter().enumerate() {
                let miss = (found.temperature[0][i] - bar.plate.temperature(*x)).abs();
                assert!(miss < 1e-6, "{b} {a} {x}: {miss:e}");
            }
        }
    }

    #[test]
    fn a_finer_grid_changes_nothing_that_matters() {
        // Targets 5e-4 (k of x) and 5e-3 (k of T): at least 20 times below.
        for (b, a, at, most) in [(0.5, 0.0, 0.05, 2.5e-6), (0.0, 4.0, 0.01, 2.5e-5)] {
            let bar = bar(b, a);
            let one = profiles(&bar, &[at], 200, 1e-5).unwrap();
            let two = profiles(&bar, &[at], 400, 1e-6).unwrap();
            let worst = (0..=200)
                .map(|i| (one.temperature[0][i] - two.temperature[0][2 * i]).abs())
                .fold(0.0, f64::max);
            assert!(worst < most, "{b} {a}: {worst:e}");
        }
    }
}
