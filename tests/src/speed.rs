//! Times of the numerical cores, measured in this process.
//!
//! Thread numbers take turns within every repeat, so that a machine which slows down slows all of
//! them; the median over the repeats is the figure, the least tells how far it is from quiet.

use std::hint::black_box;
use std::time::Instant;

use kernels::CubicSpline;
use neighbours::{Grid, Lists};
use rayon::ThreadPoolBuilder;
use relax::{Coefficients, FivePoint, Sor};
use serde::Serialize;

/// One figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// What was timed.
    pub name: String,
    /// Median of the repeats.
    pub value: f64,
    /// Least of the repeats.
    pub least: f64,
    /// Unit of both.
    pub unit: String,
    /// Times measured.
    pub repeats: usize,
    /// Threads used.
    pub threads: usize,
}

impl Row {
    /// Median and least of `times`, which must not be empty.
    #[must_use]
    pub fn of(name: &str, unit: &str, threads: usize, mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        let middle = times.len() / 2;
        let median = if times.len() % 2 == 1 {
            times[middle]
        } else {
            0.5 * (times[middle - 1] + times[middle])
        };
        Self {
            name: name.to_owned(),
            value: median,
            least: times[0],
            unit: unit.to_owned(),
            repeats: times.len(),
            threads,
        }
    }
}

/// Work that can be timed, and into how many parts its time is divided.
struct Work {
    name: &'static str,
    unit: &'static str,
    parts: f64,
    run: Box<dyn FnMut() + Send>,
}

/// Times neighbour search, pair sweep and SOR on each number of threads, `repeats` times in turn.
///
/// # Errors
/// When threads cannot be started.
pub fn cores(threads: &[usize], repeats: usize) -> Result<Vec<Row>, rayon::ThreadPoolBuildError> {
    let mut pools = Vec::new();
    for &count in threads {
        pools.push(ThreadPoolBuilder::new().num_threads(count).build()?);
    }
    let mut rows = Vec::new();
    for mut work in [search(40), pair_sweep(40), over_relaxation(512)] {
        let mut times = vec![Vec::new(); pools.len()];
        pools.iter().for_each(|pool| pool.install(&mut work.run));
        for _ in 0..repeats {
            for (pool, times) in pools.iter().zip(&mut times) {
                let start = Instant::now();
                pool.install(&mut work.run);
                times.push(start.elapsed().as_secs_f64() * 1e9 / work.parts);
            }
        }
        for (&count, times) in threads.iter().zip(times) {
            rows.push(Row::of(work.name, work.unit, count, times));
        }
    }
    Ok(rows)
}

/// A cube of `side`^3 points at unit distance, each moved by up to 0.15 per axis.
fn cloud(side: usize) -> Vec<[f64; 3]> {
    let mut seed = 1_u64;
    let mut shake = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        0.3 * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
    };
    (0..side * side * side)
        .map(|k| [k % side, k / side % side, k / side / side].map(|i| i as f64 + shake()))
        .collect()
}

fn search(side: usize) -> Work {
    let points = cloud(side);
    let (mut grid, mut lists) = (Grid::new(1.0), Lists::new());
    Work {
        name: "neighbour search",
        unit: "ns/particle",
        parts: points.len() as f64,
        run: Box::new(move || {
            grid.bin(&points);
            lists.build(grid.search(&points, 2.0), |_| true, |_, _| true);
            black_box(lists.len());
        }),
    }
}

fn pair_sweep(side: usize) -> Work {
    use rayon::prelude::*;
    let points = cloud(side);
    let (mut grid, mut lists) = (Grid::new(1.0), Lists::new());
    grid.bin(&points);
    lists.build(grid.search(&points, 2.0), |_| true, |_, _| true);
    let kernel = CubicSpline::<3>::new(1.0);
    let mut density = vec![0.0; points.len()];
    Work {
        name: "pair sweep (density)",
        unit: "ns/pair",
        parts: lists.pairs() as f64,
        run: Box::new(move || {
            density
                .par_chunks_mut(neighbours::ROWS)
                .zip(lists.chunks())
                .for_each(|(density, chunk)| {
                    for (k, density) in density.iter_mut().enumerate() {
                        let at = points[chunk.first() + k];
                        *density = chunk.row(k).iter().fold(0.0, |sum, &b| {
                            let to = points[b as usize];
                            let [x, y, z] = [at[0] - to[0], at[1] - to[1], at[2] - to[2]];
                            sum + kernel.value((x * x + y * y + z * z).sqrt())
                        });
                    }
                });
            black_box(density[0]);
        }),
    }
}

/// Sweeps of SOR per timing, the residual taken every fourth.
const SWEEPS: usize = 20;

fn over_relaxation(side: usize) -> Work {
    let mut equation = FivePoint::new(side, side);
    let beside = |inside: bool| if inside { 1.0 } else { 0.0 };
    equation.fill(|i, j| Coefficients {
        centre: 4.0,
        east: beside(i + 1 < side),
        west: beside(i > 0),
        north: beside(j + 1 < side),
        south: beside(j > 0),
        source: 1.0,
    });
    let mut x = vec![0.0; side * side];
    let solver = Sor::new(1.9, SWEEPS, 0.0);
    let mut scratch = Vec::new();
    Work {
        name: "red-black SOR sweep",
        unit: "ns/cell",
        parts: (SWEEPS * side * side) as f64,
        run: Box::new(move || {
            x.fill(0.0);
            black_box(solver.solve(&equation, &mut x, &mut scratch).last);
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_figure_is_the_median() {
        let row = Row::of("a", "ns", 1, vec![4.0, 1.0, 9.0]);
        assert!((row.value - 4.0).abs() < 1e-12 && (row.least - 1.0).abs() < 1e-12);
        let row = Row::of("a", "ns", 1, vec![4.0, 1.0]);
        assert!((row.value - 2.5).abs() < 1e-12);
    }

    #[test]
    fn every_core_is_timed_on_every_number_of_threads() {
        let rows = cores(&[1, 2], 1).unwrap();
        assert_eq!(rows.len(), 6);
        assert!(
            rows.iter()
                .all(|row| row.value > 0.0 && row.value.is_finite())
        );
    }
}
