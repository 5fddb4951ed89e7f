//! A solve whose sizes are known allocates nothing but the history that it returns.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use krylov::{Aggregation, Pattern, Rule, Scratch, Sparse, conjugate_gradient, gmres};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use std::sync::Arc;

#[global_allocator]
static GLOBAL: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// A square of `n` by `n` points with four neighbours, fixed at its edges.
fn square(n: usize) -> Sparse {
    let (mut offsets, mut columns) = (vec![0], Vec::new());
    for k in 0..n * n {
        let (i, j) = (k % n, k / n);
        columns.extend((j > 0).then(|| (k - n) as u32));
        columns.extend((i > 0).then(|| k as u32 - 1));
        columns.extend((i + 1 < n).then(|| k as u32 + 1));
        columns.extend((j + 1 < n).then(|| (k + n) as u32));
        offsets.push(columns.len());
    }
    let mut a = Sparse::zeros(Arc::new(Pattern::new(offsets, columns)));
    a.fill(|_, _, values| {
        values.fill(-1.0);
        4.0
    });
    a
}

#[test]
fn a_solve_allocates_its_history_alone() {
    let rule = Rule::to(1e-8, 55);
    // One thread: to hand a task to another allocates now and then, in the pool itself.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        for n in [40, 150] {
            let a = square(n);
            let (rhs, mut x) = (vec![1.0; n * n], vec![0.0; n * n]);
            let mut grid = Aggregation::new(&a, true).unwrap();
            let mut any = Aggregation::new(&a, false).unwrap();
            let mut work = Scratch::default();
            let mut solve = || {
                x.fill(0.0);
                conjugate_gradient(&a, &rhs, &mut x, &mut grid, rule, &mut work);
                x.fill(0.0);
                gmres(&a, &rhs, &mut x, &mut any, rule.restarted(10), &mut work);
            };
            solve();
            let region = Region::new(GLOBAL);
            solve();
            let change = region.change();
            assert_eq!(change.allocations, 2, "{n}");
            assert!(
                change.reallocations <= 8 && change.bytes_reallocated < 1024,
                "{n}"
            );
        }
    });
}
