//! Period and decay of a swing, by its zeros and by a fit.

use std::f64::consts::PI;

use super::Series;

/// Rounds of Gauss and Newton's method.
const ROUNDS: usize = 60;

/// Times at which a series changes its sign, through cubics of the four values about each.
#[must_use]
pub fn zeros(series: &Series) -> Vec<f64> {
    let (t, y) = (&series.time, &series.value);
    let mut found = Vec::new();
    for k in 1..t.len().saturating_sub(2) {
        if (y[k] > 0.0) == (y[k + 1] > 0.0) {
            continue;
        }
        let (mut low, mut high) = (t[k], t[k + 1]);
        let four = [k - 1, k, k + 1, k + 2];
        let cubic = |x: f64| -> f64 {
            four.iter()
                .map(|&a| {
                    let others = four.iter().filter(|b| **b != a);
                    y[a] * others.map(|&b| (x - t[b]) / (t[a] - t[b])).product::<f64>()
                })
                .sum()
        };
        let rises = y[k + 1] > y[k];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (cubic(middle) > 0.0) == rises {
                high = middle;
            } else {
                low = middle;
            }
        }
        found.push(0.5 * (low + high));
    }
    found
}

/// `y = c + exp(-d t) (a cos w t + b sin w t)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// w \[1/s\].
    pub frequency: f64,
    /// d \[1/s\].
    pub decay: f64,
}

impl Fit {
    /// Period \[s\].
    #[must_use]
    pub fn period(&self) -> f64 {
        2.0 * PI / self.frequency
    }
}

/// The fit of least squares, from about known frequency and decay: those two by Gauss and Newton's method, the others, in which
/// y is linear, exactly in each round.
#[must_use]
pub fn fit(series: &Series, guess: Fit) -> Fit {
    found(series, guess, Tones::One)
}

/// The same of `y = c + exp(-d t) (a cos w t + b sin w t) + exp(-2 d t) (e cos 2 w t + f sin 2 w t)`.
///
/// The last part is that of a swing that is not small. At Oh 2e-5 one of mode 2 with an amplitude A = 0.01 R had 0.34 A^2 of it and a
/// mean of 0.39 A^2, and so at 0.001 R. Over one period a fit without it takes it for a decay of -0.0056 sqrt(gamma/(rho R^3)),
/// 57 times that of Lamb, and in proportion to A.
#[must_use]
pub fn fit_with_double(series: &Series, guess: Fit) -> Fit {
    found(series, guess, Tones::Two)
}

/// Whether a swing has a part at twice its frequency.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Tones {
    One,
    Two,
}

fn found(series: &Series, guess: Fit, tones: Tones) -> Fit {
    let mut now = guess;
    for _ in 0..ROUNDS {
        let scale = now.frequency;
        let left = residual(series, now, tones);
        let step = 1e-5 * scale;
        let turned = |frequency: f64, decay: f64| {
            let moved = residual(series, Fit { frequency, decay }, tones);
            let pairs = moved.iter().zip(&left);
            pairs.map(|(a, b)| (a - b) / step).collect::<Vec<f64>>()
        };
        let a = turned(now.frequency + step, now.decay);
        let b = turned(now.frequency, now.decay + step);
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let (aa, ab, bb) = (dot(&a, &a), dot(&a, &b), dot(&b, &b));
        let (ra, rb) = (dot(&a, &left), dot(&b, &left));
        let whole = aa * bb - ab * ab;
        let (da, db) = ((bb * ra - ab * rb) / whole, (aa * rb - ab * ra) / whole);
        now.frequency -= da;
        now.decay -= db;
        if da.hypot(db) < 1e-12 * scale {
            break;
        }
    }
    now
}

/// c, the value that a series swings about, of the best a, b, c.
#[must_use]
pub fn rest(series: &Series, fit: Fit) -> f64 {
    best(series, fit, Tones::One).1
}

/// What the best a, b, c leave.
fn residual(series: &Series, fit: Fit, tones: Tones) -> Vec<f64> {
    best(series, fit, tones).0
}

/// What the best a, b, c leave, and c.
fn best(series: &Series, fit: Fit, tones: Tones) -> (Vec<f64>, f64) {
    let rows: Vec<[f64; 5]> = series
        .time
        .iter()
        .map(|t| {
            let damped = (-fit.decay * t).exp();
            let (sine, cosine) = (fit.frequency * t).sin_cos();
            let (double, square) = ((2.0 * fit.frequency * t).sin_cos(), damped * damped);
            [
                damped * cosine,
                damped * sine,
                square * double.1,
                square * double.0,
                1.0,
            ]
        })
        .collect();
    let mut bases: Vec<Vec<f64>> = Vec::new();
    let (mut left, mut rest) = (series.value.clone(), 0.0);
    let columns: &[usize] = match tones {
        Tones::One => &[0, 1, 4],
        Tones::Two => &[0, 1, 2, 3, 4],
    };
    for &k in columns {
        let mut column: Vec<f64> = rows.iter().map(|r| r[k]).collect();
        for _ in 0..2 {
            for basis in &bases {
                let along: f64 = basis.iter().zip(&column).map(|(a, b)| a * b).sum();
                column
                    .iter_mut()
                    .zip(basis)
                    .for_each(|(c, b)| *c -= along * b);
            }
        }
        let size = column.iter().map(|c| c * c).sum::<f64>().sqrt();
        column.iter_mut().for_each(|c| *c /= size);
        let along: f64 = column.iter().zip(&left).map(|(a, b)| a * b).sum();
        left.iter_mut()
            .zip(&column)
            .for_each(|(l, c)| *l -= along * c);
        // The last column has only what the others lack: its factor is that of the constant.
        rest = along / size;
        bases.push(column);
    }
    (left, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damped_swing_tells_its_period_and_decay() {
        let time: Vec<f64> = (0..90).map(|k| 0.03 * f64::from(k)).collect();
        let value = time
            .iter()
            .map(|t| 0.1 + (-0.3 * t).exp() * (5.0 * t + 0.4).sin())
            .collect();
        let series = Series { time, value };
        let guess = Fit {
            frequency: 4.8,
            decay: 0.0,
        };
        let found = fit(&series, guess);
        assert!((found.frequency - 5.0).abs() < 1e-9 && (found.decay - 0.3).abs() < 1e-9);
        assert!((rest(&series, found) - 0.1).abs() < 1e-9);
        let even = Series {
            value: series.time.iter().map(|t| (5.0 * t).sin()).collect(),
            ..series
        };
        let zeros = zeros(&even);
        assert!((zeros[1] - zeros[0] - PI / 5.0).abs() < 1e-5, "{zeros:?}");
    }

    #[test]
    fn what_swings_twice_as_fast_is_no_decay() {
        let time: Vec<f64> = (0..50).map(|k| 0.05 * f64::from(k)).collect();
        let value = time
            .iter()
            .map(|t| {
                let phase = 8.0_f64.sqrt() * t;
                phase.sin() + 0.0039 + 0.0034 * (2.0 * phase).cos()
            })
            .collect();
        let guess = Fit {
            frequency: 2.8,
            decay: 0.0,
        };
        let series = Series { time, value };
        let found = fit_with_double(&series, guess);
        assert!(found.decay.abs() < 1e-9 && (found.frequency - 8.0_f64.sqrt()).abs() < 1e-9);
        let without = fit(&series, guess).decay;
        assert!((without + 0.0056).abs() < 3e-4, "{without}");
    }
}
