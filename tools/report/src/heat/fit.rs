//! A field between scattered points by moving least squares with a linear basis (Lancaster and
//! Salkauskas 1981): exact for linear fields, also at the edge and a little beyond it.

/// Neighbours of a fit at first.
const FEW: usize = 8;
/// Most neighbours of a fit.
const MANY: usize = 128;
/// Least roundness of a neighbourhood: 1 where it is as wide as it is high, 0 on a line.
const ROUND: f64 = 0.02;
/// Weight against slopes that no neighbour tells of.
const RIDGE: f64 = 1e-10;
/// Most that the sizes of shares may sum up to: one where none is negative.
const STEADY: f64 = 2.0;
/// Points in a bin, about.
const FILL: f64 = 3.0;

/// A value at a place: right, up, and off the plane of the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    pub(crate) at: [f64; 3],
    pub(crate) value: f64,
}

/// Samples sorted into bins of the plane.
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    samples: Vec<Sample>,
    low: [f64; 2],
    cell: f64,
    count: [usize; 2],
    bins: Vec<Vec<u32>>,
}

impl Fit {
    /// A fit through samples; `None` without any.
    pub(crate) fn new(samples: Vec<Sample>) -> Option<Self> {
        let first = samples.first()?.at;
        let (mut low, mut high) = ([first[0], first[1]], [first[0], first[1]]);
        for sample in &samples {
            for k in 0..2 {
                low[k] = low[k].min(sample.at[k]);
                high[k] = high[k].max(sample.at[k]);
            }
        }
        let size = [0, 1].map(|k| high[k] - low[k]);
        let longest = size[0].max(size[1]).max(f64::MIN_POSITIVE);
        let n = samples.len() as f64;
        let cell = (size[0] * size[1] * FILL / n)
            .sqrt()
            .max(longest * FILL / n);
        let count = size.map(|s| (s / cell) as usize + 1);
        let mut fit = Self {
            bins: vec![Vec::new(); count[0] * count[1]],
            samples,
            low,
            cell,
            count,
        };
        for n in 0..fit.samples.len() {
            let [i, k] = fit.bin([fit.samples[n].at[0], fit.samples[n].at[1]]);
            fit.bins[i * count[1] + k].push(n as u32);
        }
        Some(fit)
    }

    fn bin(&self, p: [f64; 2]) -> [usize; 2] {
        [0, 1]
            .map(|k| (((p[k] - self.low[k]) / self.cell).max(0.0) as usize).min(self.count[k] - 1))
    }

    /// The nearest samples, at most `wanted`, with their squared distances, the nearest first.
    fn nearest(&self, p: [f64; 2], wanted: usize) -> Vec<(f64, u32)> {
        let wanted = wanted.min(self.samples.len());
        let [i, k] = self.bin(p);
        let mut found: Vec<(f64, u32)> = Vec::new();
        let most = self.count[0].max(self.count[1]);
        let mut last = most;
        for ring in 0..=most {
            if ring > last {
                break;
            }
            self.ring([i, k], ring, |n| {
                let at = self.samples[n as usize].at;
                let d = [at[0] - p[0], at[1] - p[1], at[2]];
                found.push((d[0] * d[0] + d[1] * d[1] + d[2] * d[2], n));
            });
            // What lies in a corner of this ring may be farther than what the next rings hold.
            if found.len() >= wanted && last == most {
                last = (1.5 * (ring + 1) as f64).ceil() as usize;
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.truncate(wanted);
        found
    }

    fn ring(&self, [i, k]: [usize; 2], ring: usize, mut visit: impl FnMut(u32)) {
        let rows = i.saturating_sub(ring)..=(i + ring).min(self.count[0] - 1);
        for a in rows {
            let edge = a.abs_diff(i) == ring;
            let columns = k.saturating_sub(ring)..=(k + ring).min(self.count[1] - 1);
            for b in columns.filter(|b| edge || b.abs_diff(k) == ring) {
                for n in &self.bins[a * self.count[1] + b] {
                    visit(*n);
                }
            }
        }
    }

    /// Distance to the nearest sample.
    pub(crate) fn distance(&self, p: [f64; 2]) -> f64 {
        self.nearest(p, 1)
            .first()
            .map_or(f64::INFINITY, |n| n.0.sqrt())
    }

    /// The value at a place of the plane.
    pub(crate) fn at(&self, p: [f64; 2]) -> f64 {
        let mut wanted = FEW;
        loop {
            let near = self.nearest(p, wanted);
            let reach = near.last().map_or(0.0, |n| 1.1 * n.0.sqrt());
            if reach <= 0.0 {
                return self.samples[near[0].1 as usize].value;
            }
            let rows: Vec<([f64; 4], f64, f64)> =
                near.iter().map(|near| self.row(p, reach, *near)).collect();
            let done = wanted >= MANY || near.len() < wanted;
            if done || roundness(&rows) > ROUND {
                return solve(&rows);
            }
            wanted *= 2;
        }
    }

    /// Weights of samples in the value at a place of the plane, for values that are not known yet: neighbours
    /// whose places tell little of a slope across the plane are joined by further ones.
    pub(crate) fn shares(&self, p: [f64; 2]) -> Vec<(u32, f64)> {
        let mut wanted = FEW;
        loop {
            let near = self.nearest(p, wanted);
            let reach = near.last().map_or(0.0, |n| 1.1 * n.0.sqrt());
            if reach <= 0.0 {
                return near.first().map_or_else(Vec::new, |n| vec![(n.1, 1.0)]);
            }
            let rows: Vec<([f64; 4], f64, f64)> =
                near.iter().map(|near| self.row(p, reach, *near)).collect();
            let done = wanted >= MANY || near.len() < wanted;
            if done || roundness(&rows) > ROUND {
                let factors = factors(&rows);
                let share = |((_, n), (basis, _, weight)): (&(f64, u32), &([f64; 4], f64, f64))| {
                    let along: f64 = basis.iter().zip(&factors).map(|(b, y)| b * y).sum();
                    (*n, weight * along)
                };
                let shares: Vec<(u32, f64)> = near.iter().zip(&rows).map(share).collect();
                if done || shares.iter().map(|s| s.1.abs()).sum::<f64>() < STEADY {
                    return shares;
                }
            }
            wanted *= 2;
        }
    }

    /// Basis, value and weight of a neighbour.
    fn row(&self, p: [f64; 2], reach: f64, near: (f64, u32)) -> ([f64; 4], f64, f64) {
        let (square, n) = near;
        let sample = &self.samples[n as usize];
        let q = square / (reach * reach);
        let weight = (1.0 - q).powi(2) / (q + 0.02);
        let at = [
            (sample.at[0] - p[0]) / reach,
            (sample.at[1] - p[1]) / reach,
            sample.at[2] / reach,
        ];
        ([1.0, at[0], at[1], at[2]], sample.value, weight)
    }
}

/// Least over greatest spread of a neighbourhood, squared, nearly.
fn roundness(rows: &[([f64; 4], f64, f64)]) -> f64 {
    let sum = |f: fn(&[f64; 4]) -> f64| rows.iter().map(|(b, _, w)| w * f(b)).sum::<f64>();
    let whole = sum(|_| 1.0);
    let mean = [sum(|b| b[1]) / whole, sum(|b| b[2]) / whole];
    let xx = sum(|b| b[1] * b[1]) / whole - mean[0] * mean[0];
    let yy = sum(|b| b[2] * b[2]) / whole - mean[1] * mean[1];
    let xy = sum(|b| b[1] * b[2]) / whole - mean[0] * mean[1];
    let half = 0.5 * (xx + yy);
    if half > 0.0 {
        (xx * yy - xy * xy) / (half * half)
    } else {
        0.0
    }
}

/// The value at the origin of the weighted linear fit.
fn solve(rows: &[([f64; 4], f64, f64)]) -> f64 {
    let whole: f64 = rows.iter().map(|r| r.2).sum();
    let mean: f64 = rows.iter().map(|r| r.2 * r.1).sum::<f64>() / whole;
    let mut right = [0.0; 4];
    for (basis, value, weight) in rows {
        for (right, part) in right.iter_mut().zip(basis) {
            *right += weight * part * (value - mean);
        }
    }
    mean + normal(rows, right)[0]
}

/// What the bases of neighbours times their weights are multiplied by for the value at the origin.
fn factors(rows: &[([f64; 4], f64, f64)]) -> [f64; 4] {
    normal(rows, [1.0, 0.0, 0.0, 0.0])
}

/// Solves the normal equations of the weighted linear fit, by Cholesky's method.
fn normal(rows: &[([f64; 4], f64, f64)], right: [f64; 4]) -> [f64; 4] {
    let whole: f64 = rows.iter().map(|r| r.2).sum();
    let mut a = [[0.0; 4]; 4];
    let mut x = right;
    for (basis, _, weight) in rows {
        for i in 0..4 {
            for k in 0..=i {
                a[i][k] += weight * basis[i] * basis[k];
            }
        }
    }
    for (i, row) in a.iter_mut().enumerate().skip(1) {
        row[i] += RIDGE * whole;
    }
    for i in 0..4 {
        for k in 0..=i {
            let rest = a[i][k] - (0..k).map(|m| a[i][m] * a[k][m]).sum::<f64>();
            a[i][k] = if i == k {
                rest.max(f64::MIN_POSITIVE).sqrt()
            } else {
                rest / a[k][k]
            };
        }
        x[i] = (x[i] - (0..i).map(|m| a[i][m] * x[m]).sum::<f64>()) / a[i][i];
    }
    for i in (0..4).rev() {
        x[i] = (x[i] - (i + 1..4).map(|m| a[m][i] * x[m]).sum::<f64>()) / a[i][i];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(stretch: f64, f: impl Fn([f64; 3]) -> f64) -> Vec<Sample> {
        let shake = |n: u32| f64::from((n * 7919) % 101) / 101.0 - 0.5;
        let place = |n: u32| {
            let (i, k) = (n / 12, n % 12);
            let at = [
                f64::from(i) + 0.4 * shake(n),
                f64::from(k) + 0.4 * shake(n + 50),
            ];
            [at[0] * stretch, at[1], 0.3 * shake(n + 90)]
        };
        let sample = |n| Sample {
            at: place(n),
            value: f(place(n)),
        };
        (0..144).map(sample).collect()
    }

    #[test]
    fn a_linear_field_comes_back_inside_at_the_edge_and_where_points_lie_far_apart() {
        for stretch in [1.0, 8.0] {
            let f = |p: [f64; 3]| 900.0 + 3.0 * p[0] - 2.0 * p[1] + 5.0 * p[2];
            let fit = Fit::new(samples(stretch, f)).unwrap();
            for p in [[5.3, 6.1], [0.0, 0.0], [11.2, 11.2], [2.2, -0.3]] {
                let p = [p[0] * stretch, p[1]];
                let off = fit.at(p) - f([p[0], p[1], 0.0]);
                assert!(off.abs() < 2e-3 * stretch, "{stretch} {p:?}: {off}");
            }
        }
    }

    #[test]
    fn shares_make_up_the_value_and_are_one_together() {
        let all = samples(3.0, |p| (0.3 * p[0]).sin() + p[1] * p[1]);
        let fit = Fit::new(all.clone()).unwrap();
        for p in [[5.3, 6.1], [0.0, 0.0], [33.0, 11.2]] {
            let shares = fit.shares(p);
            let sum: f64 = shares.iter().map(|s| s.1).sum();
            let value: f64 = shares.iter().map(|(n, w)| w * all[*n as usize].value).sum();
            assert!((sum - 1.0).abs() < 1e-6, "{sum}");
            assert!((value - fit.at(p)).abs() < 0.05, "{value} {}", fit.at(p));
        }
    }

    #[test]
    fn the_nearest_are_those_that_a_search_of_all_finds() {
        let fit = Fit::new(samples(3.0, |p| p[0])).unwrap();
        for p in [[0.1, 0.2], [17.0, 5.5], [40.0, 20.0], [-9.0, 3.0]] {
            let mut all: Vec<f64> = fit
                .samples
                .iter()
                .map(|s| (s.at[0] - p[0]).powi(2) + (s.at[1] - p[1]).powi(2) + s.at[2].powi(2))
                .collect();
            all.sort_by(f64::total_cmp);
            let found: Vec<f64> = fit.nearest(p, 8).iter().map(|n| n.0).collect();
            assert_eq!(found, all[..8]);
        }
    }

    #[test]
    fn one_sample_is_a_constant_and_none_is_no_fit() {
        let one = Sample {
            at: [1.0, 2.0, 0.0],
            value: 7.0,
        };
        let fit = Fit::new(vec![one]).unwrap();
        assert!((fit.at([3.0, 4.0]) - 7.0).abs() < 1e-12);
        assert!(Fit::new(Vec::new()).is_none());
    }
}
