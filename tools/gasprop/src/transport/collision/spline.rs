//! Cubic splines in one variable, continued by straight lines beyond their ends.

/// Cubic spline through given points; twice continuously differentiable inside.
///
/// An end without a given slope is natural (no curvature), so that the straight line beyond it joins with a
/// continuous second derivative: in logarithms of both axes, a power law.
#[derive(Debug, Clone)]
pub(super) struct Spline {
    x: Vec<f64>,
    y: Vec<f64>,
    curvature: Vec<f64>,
}

/// Value and derivatives of a spline at one place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local {
    pub(super) value: f64,
    pub(super) slope: f64,
    pub(super) curvature: f64,
}

impl Spline {
    /// Spline through `x` (strictly rising, at least two) and `y`, with given slopes at the first and last point where
    /// there are any. None where the points do not allow one.
    pub(super) fn new(x: Vec<f64>, y: Vec<f64>, ends: [Option<f64>; 2]) -> Option<Self> {
        let rising = x.windows(2).all(|w| w[1] > w[0]);
        let finite = x.iter().chain(&y).all(|v| v.is_finite());
        if x.len() < 2 || x.len() != y.len() || !rising || !finite {
            return None;
        }
        let curvature = curvatures(&x, &y, ends);
        Some(Self { x, y, curvature })
    }

    /// First abscissa.
    pub(super) fn first(&self) -> f64 {
        self.x[0]
    }

    /// Value, first and second derivative at `x`.
    pub(super) fn at(&self, x: f64) -> Local {
        let last = self.x.len() - 1;
        if x < self.x[0] {
            return self.beyond(0, self.at(self.x[0]).slope, x);
        }
        if x > self.x[last] {
            return self.beyond(last, self.at(self.x[last]).slope, x);
        }
        let i = self.x.partition_point(|&node| node <= x).clamp(1, last) - 1;
        let h = self.x[i + 1] - self.x[i];
        let (b, a) = ((x - self.x[i]) / h, (self.x[i + 1] - x) / h);
        let (ca, cb) = (self.curvature[i], self.curvature[i + 1]);
        Local {
            value: a * self.y[i]
                + b * self.y[i + 1]
                + ((a.powi(3) - a) * ca + (b.powi(3) - b) * cb) * h * h / 6.0,
            slope: (self.y[i + 1] - self.y[i]) / h
                + ((3.0 * b * b - 1.0) * cb - (3.0 * a * a - 1.0) * ca) * h / 6.0,
            curvature: a * ca + b * cb,
        }
    }

    /// Value at `x`, held at the end values beyond the ends.
    pub(super) fn held(&self, x: f64) -> Local {
        let last = self.x.len() - 1;
        let inside = x.clamp(self.x[0], self.x[last]);
        let local = self.at(inside);
        if (self.x[0]..=self.x[last]).contains(&x) {
            local
        } else {
            Local {
                slope: 0.0,
                curvature: 0.0,
                ..local
            }
        }
    }

    fn beyond(&self, end: usize, slope: f64, x: f64) -> Local {
        Local {
            value: self.y[end] + slope * (x - self.x[end]),
            slope,
            curvature: 0.0,
        }
    }
}

/// Second derivatives at the points: the tridiagonal system of continuous slopes, by elimination.
fn curvatures(x: &[f64], y: &[f64], ends: [Option<f64>; 2]) -> Vec<f64> {
    let n = x.len();
    let gradient = |i: usize| (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
    if let Some(slope) = ends[0] {
        upper[0] = 0.5;
        right[0] = 3.0 / (x[1] - x[0]) * (gradient(0) - slope);
    }
    for i in 1..n - 1 {
        let share = (x[i] - x[i - 1]) / (x[i + 1] - x[i - 1]);
        let pivot = share * upper[i - 1] + 2.0;
        let jump = (gradient(i) - gradient(i - 1)) * 6.0 / (x[i + 1] - x[i - 1]);
        // Rows: share c[i-1] + 2 c[i] + (1 - share) c[i+1] = jump, with c[i-1] = right - upper c[i] put in.
        let pivot = 4.0 - pivot;
        upper[i] = (1.0 - share) / pivot;
        right[i] = (jump - share * right[i - 1]) / pivot;
    }
    let mut curvature = vec![0.0; n];
    if let Some(slope) = ends[1] {
        let h = x[n - 1] - x[n - 2];
        let jump = 3.0 / h * (slope - gradient(n - 2));
        curvature[n - 1] = (jump - 0.5 * right[n - 2]) / (1.0 - 0.5 * upper[n - 2]);
    }
    for i in (0..n - 1).rev() {
        curvature[i] = right[i] - upper[i] * curvature[i + 1];
    }
    curvature
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubic(x: f64) -> f64 {
        1.0 - 2.0 * x + 0.5 * x * x + 0.25 * x.powi(3)
    }

    #[test]
    fn a_cubic_with_its_end_slopes_is_reproduced() {
        let slope = |x: f64| -2.0 + x + 0.75 * x * x;
        let x = vec![-1.0, 0.0, 0.7, 2.0, 2.5];
        let y = x.iter().map(|&x| cubic(x)).collect();
        let spline = Spline::new(x, y, [Some(slope(-1.0)), Some(slope(2.5))]).unwrap();
        for x in [-1.0, -0.3, 0.2, 0.7, 1.9, 2.5] {
            let local = spline.at(x);
            assert!((local.value - cubic(x)).abs() < 1e-13);
            assert!((local.slope - slope(x)).abs() < 1e-12);
            assert!((local.curvature - (1.0 + 1.5 * x)).abs() < 1e-11);
        }
    }

    #[test]
    fn lines_go_on_as_lines() {
        let spline = Spline::new(vec![0.0, 1.0, 3.0], vec![1.0, 3.0, 7.0], [None, None]).unwrap();
        for x in [-5.0, 0.5, 2.0, 10.0] {
            assert!((spline.at(x).value - (1.0 + 2.0 * x)).abs() < 1e-12);
        }
        assert!((spline.held(9.0).value - 7.0).abs() < 1e-12);
        assert!(spline.held(9.0).slope.abs() < 1e-12);
        assert!(Spline::new(vec![0.0, 0.0], vec![1.0, 2.0], [None, None]).is_none());
    }
}
