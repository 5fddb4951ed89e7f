//! Matrices of conduction on clouds of points.

use krylov::{Pattern, Sparse};
use nalgebra::DMatrix;
use std::sync::Arc;

/// Numbers in [0, 1) that are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn matrix(rows: Vec<(f64, Vec<(u32, f64)>)>) -> Sparse {
    let (mut offsets, mut columns) = (vec![0], Vec::new());
    for (_, row) in &rows {
        columns.extend(row.iter().map(|(j, _)| *j));
        offsets.push(columns.len());
    }
    let mut a = Sparse::zeros(Arc::new(Pattern::new(offsets, columns)));
    a.fill(|i, _, values| {
        for (v, (_, g)) in values.iter_mut().zip(&rows[i].1) {
            *v = -g;
        }
        rows[i].0
    });
    a
}

/// A random M-matrix: each row has about twelve couplings that spread over the factor `spread`.
#[allow(clippy::type_complexity, reason = "rows of columns and couplings")]
pub(crate) fn random(n: usize, seed: u64, spread: f64, symmetric: bool) -> (Sparse, Vec<f64>) {
    let mut numbers = Numbers(seed);
    let mut rows: Vec<(f64, Vec<(u32, f64)>)> = vec![(0.0, Vec::new()); n];
    for i in 0..n {
        for _ in 0..6 {
            let j = (numbers.next() * n as f64) as usize;
            if j == i || rows[i].1.iter().any(|(c, _)| *c as usize == j) {
                continue;
            }
            let there = spread.powf(numbers.next());
            let back = if symmetric {
                there
            } else {
                there * numbers.next()
            };
            rows[i].1.push((j as u32, there));
            rows[j].1.push((i as u32, back));
        }
    }
    let rhs = (0..n).map(|_| numbers.next() - 0.5).collect();
    for (i, (diagonal, row)) in rows.iter_mut().enumerate() {
        let fixed = if i % 10 == 0 { numbers.next() } else { 0.0 };
        *diagonal = fixed + row.iter().map(|(_, g)| g).sum::<f64>();
    }
    (matrix(rows), rhs)
}

/// The same equations in random order.
pub(crate) fn shuffled(a: &Sparse, rhs: &[f64]) -> (Sparse, Vec<f64>) {
    let (n, mut numbers) = (rhs.len(), Numbers(5));
    let mut from: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        from.swap(i, (numbers.next() * (i + 1) as f64) as usize);
    }
    let mut to = vec![0; n];
    for (new, old) in from.iter().enumerate() {
        to[*old] = new as u32;
    }
    let row = |old: &usize| {
        let entries = a.pattern().row(*old);
        let entries = entries.map(|k| (to[a.pattern().columns()[k] as usize], -a.values()[k]));
        (a.diagonal()[*old], entries.collect())
    };
    let mixed = from.iter().map(|old| rhs[*old]).collect();
    (matrix(from.iter().map(row).collect()), mixed)
}

/// The same matrix with all its zeros.
pub(crate) fn dense(a: &Sparse) -> DMatrix<f64> {
    let mut full = DMatrix::zeros(a.diagonal().len(), a.diagonal().len());
    for (i, d) in a.diagonal().iter().enumerate() {
        full[(i, i)] = *d;
        for k in a.pattern().row(i) {
            full[(i, a.pattern().columns()[k] as usize)] += a.values()[k];
        }
    }
    full
}

/// Points on a lattice with neighbours within a reach.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cloud {
    /// Points along each direction.
    pub(crate) size: [usize; 3],
    /// Reach of neighbours in spacings.
    pub(crate) reach: i32,
    /// Conductivity of a disc (or ball) in the middle; 1 outside.
    pub(crate) jump: f64,
    /// One fixed value in a corner instead of fixed left and right sides.
    pub(crate) one: bool,
    /// Coupling across relative to that along.
    pub(crate) squeeze: f64,
    /// Coupling between some pairs of neighbours.
    pub(crate) close: f64,
    /// What each row stores.
    pub(crate) stored: f64,
    /// Flow to the right and around (upwind), relative to conduction.
    pub(crate) flow: f64,
}

impl Cloud {
    pub(crate) fn square(n: usize) -> Self {
        Self {
            size: [n, n, 1],
            reach: 1,
            jump: 1.0,
            one: false,
            squeeze: 1.0,
            close: 1.0,
            stored: 0.0,
            flow: 0.0,
        }
    }

    pub(crate) fn cube(n: usize) -> Self {
        Self {
            size: [n, n, n],
            ..Self::square(n)
        }
    }

    fn conductivity(&self, at: [i32; 3]) -> f64 {
        let off: f64 = (0..3)
            .map(|c| {
                let n = self.size[c] as f64;
                if n > 1.0 {
                    ((f64::from(at[c]) + 0.5) / n - 0.5).powi(2)
                } else {
                    0.0
                }
            })
            .sum();
        if off < 0.09 { self.jump } else { 1.0 }
    }

    /// Coupling of neighbours apart by `d`.
    fn weight(&self, d: [i32; 3]) -> f64 {
        let r = f64::from(d.iter().map(|d| d * d).sum::<i32>()).sqrt();
        let wide = (1.0 - r / (f64::from(self.reach) + 0.9)).max(0.0).powi(2);
        if d[0] == 0 {
            wide * self.squeeze
        } else if d[1] == 0 {
            wide
        } else {
            wide * self.squeeze
        }
    }

    pub(crate) fn build(&self) -> (Sparse, Vec<f64>) {
        let n = self.size.map(|n| n as i32);
        let index = |p: [i32; 3]| p[0] + n[0] * (p[1] + n[1] * p[2]);
        let count = n.iter().product::<i32>() as usize;
        let reach = n.map(|n| if n > 1 { self.reach } else { 0 });
        let (mut rows, mut rhs) = (Vec::with_capacity(count), vec![0.0; count]);
        for i in 0..count as i32 {
            let p = [i % n[0], i / n[0] % n[1], i / n[0] / n[1]];
            let k = self.conductivity(p);
            let (mut diagonal, mut row) = (self.stored * k, Vec::new());
            for (dz, dy) in
                (-reach[2]..=reach[2]).flat_map(|z| (-reach[1]..=reach[1]).map(move |y| (z, y)))
            {
                for dx in -reach[0]..=reach[0] {
                    let (d, q) = ([dx, dy, dz], [p[0] + dx, p[1] + dy, p[2] + dz]);
                    let mut g = self.weight(d);
                    if g == 0.0 || d == [0; 3] || (1..3).any(|c| q[c] < 0 || q[c] >= n[c]) {
                        continue;
                    }
                    if q[0] < 0 || q[0] >= n[0] {
                        let fixed = if self.one { 0.0 } else { g * k };
                        diagonal += fixed;
                        rhs[i as usize] += if q[0] < 0 { fixed } else { 0.0 };
                        continue;
                    }
                    let other = self.conductivity(q);
                    g *= 2.0 * k * other / (k + other);
                    if [dy, dz] == [0, 0]
                        && (p[0] + q[0]) % 4 == 1
                        && (p[0] - q[0]).abs() == 1
                        && p[1] % 3 == 0
                    {
                        g *= self.close;
                    }
                    // Upwind: what comes from the left and, in the lower half, from above.
                    if dx == -1 && dy == 0 {
                        g += self.flow;
                    }
                    diagonal += g;
                    row.push((index(q) as u32, g));
                }
            }
            rows.push((diagonal, row));
        }
        if self.one {
            rows[0].0 += 1.0;
            rhs[count - 1] = 1.0;
        }
        (matrix(rows), rhs)
    }
}
