//! Times the weights of gradient and Laplacian on large clouds: `cargo run --release --example speed`.

#![allow(clippy::print_stdout, reason = "a program that prints times")]

use std::time::Instant;

use wls::{Cloud, Everything, Metric, Plan, Search, Stencils, Wants};

/// A cube of `n` cells per side, jittered by `jitter` of the spacing.
fn cube(n: usize, jitter: f64) -> Vec<[f64; 3]> {
    let mut seed = 7_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    };
    (0..n * n * n)
        .map(|k| [k % n, k / n % n, k / n / n].map(|c| c as f64 + jitter * random()))
        .collect()
}

/// Processor time of all threads so far \[s\]; 0 where the system does not tell.
fn processor() -> f64 {
    let line = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = line.split_whitespace().skip(13).take(2);
    ticks.filter_map(|t| t.parse::<f64>().ok()).sum::<f64>() / 100.0
}

fn main() -> Result<(), wls::Error> {
    for (n, order, jitter) in [
        (57, 2, 0.3),
        (57, 2, 0.0),
        (39, 3, 0.3),
        (39, 4, 0.3),
        (39, 4, 0.0),
        (100, 2, 0.0),
    ] {
        let points = cube(n, jitter);
        let metrics = vec![Metric::round(1.0); points.len()];
        let wants = Wants {
            gradient: true,
            laplacian: true,
            ..Wants::default()
        };
        let (start, before) = (Instant::now(), processor());
        let search = Search::new(Cloud {
            points: &points,
            metrics: &metrics,
        })?;
        let sorted = start.elapsed().as_secs_f64();
        let stencils = Stencils::build(&search, &Plan::new::<3>(order, wants), &Everything)?;
        println!(
            "{} points, order {order}, jitter {jitter}: tree {sorted:.3} s, all {:.3} s, processor {:.2} s; {:?}",
            points.len(),
            start.elapsed().as_secs_f64(),
            processor() - before,
            stencils.report()
        );
    }
    Ok(())
}
