//! Odd functions that rise, smooth between their nodes.

use crate::Error;
use crate::table::Table;

/// An odd rising function by cubics of Hermite's form: its first derivative is continuous, and it rises wherever its nodes
/// do.
///
/// Slopes at inner nodes are weighted harmonic means of those of the intervals (Fritsch and Butland 1984, SIAM J. Sci.
/// Stat. Comput. 5, 300, eq. 5), so that no interval overshoots. At zero the slope is that of an odd cubic, without a
/// quadratic term: `y(x) / x` is smooth there.
#[derive(Debug, Clone, PartialEq)]
pub struct Odd {
    x: Vec<f64>,
    y: Vec<f64>,
    slope: Vec<f64>,
    /// Integral from zero to each node.
    area: Vec<f64>,
}

/// A function at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Local {
    /// Its value.
    pub value: f64,
    /// Its slope.
    pub slope: f64,
    /// Its integral from zero.
    pub area: f64,
}

impl Odd {
    /// Through nodes that rise from (0, 0); it ends with a slope of at most `most`, where the last nodes do.
    ///
    /// # Errors
    /// When columns differ in length, have fewer than two rows, are not finite, do not begin at zero or do not rise.
    pub fn new(x: Vec<f64>, y: Vec<f64>, most: f64) -> Result<Self, Error> {
        Table::new(x.clone(), y.clone())?;
        Table::new(y.clone(), x.clone())?;
        for begin in [x[0], y[0]] {
            if begin != 0.0 {
                return Err(Error::NotIncreasing {
                    row: 0,
                    value: begin,
                    before: 0.0,
                });
            }
        }
        let slope = slopes(&x, &y, most);
        let mut area = vec![0.0; x.len()];
        for k in 1..x.len() {
            let h = x[k] - x[k - 1];
            let ends = 0.5 * (y[k - 1] + y[k]) + h / 12.0 * (slope[k - 1] - slope[k]);
            area[k] = area[k - 1] + h * ends;
        }
        Ok(Self { x, y, slope, area })
    }

    /// The last node.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.x[self.x.len() - 1]
    }

    /// Where the first interval ends.
    #[must_use]
    pub fn first(&self) -> f64 {
        self.x[1]
    }

    /// The function at `x` from zero to the last node; beyond it the last cubic goes on.
    #[must_use]
    pub fn at(&self, x: f64) -> Local {
        let k = self.x.partition_point(|node| *node <= x);
        let k = k.clamp(1, self.x.len() - 1);
        let h = self.x[k] - self.x[k - 1];
        let t = (x - self.x[k - 1]) / h;
        let (a, d) = (self.y[k - 1], h * self.slope[k - 1]);
        let rise = self.y[k] - a;
        let end = h * self.slope[k];
        // a + d t + p t^2 + q t^3.
        let (p, q) = (3.0 * rise - 2.0 * d - end, d + end - 2.0 * rise);
        Local {
            value: a + t * (d + t * (p + t * q)),
            slope: (d + t * (2.0 * p + t * 3.0 * q)) / h,
            area: self.area[k - 1] + h * t * (a + t * (d / 2.0 + t * (p / 3.0 + t * q / 4.0))),
        }
    }
}

/// The slopes at the nodes.
fn slopes(x: &[f64], y: &[f64], most: f64) -> Vec<f64> {
    let n = x.len();
    let width = |k: usize| x[k + 1] - x[k];
    let secant = |k: usize| (y[k + 1] - y[k]) / width(k);
    let mut slope = vec![0.0; n];
    for (k, own) in slope.iter_mut().enumerate().take(n - 1).skip(1) {
        let (before, after) = (width(k - 1), width(k));
        let share = (before + 2.0 * after) / (3.0 * (before + after));
        let (a, b) = (secant(k - 1), secant(k));
        *own = a * b / (share * b + (1.0 - share) * a);
    }
    slope[n - 1] = secant(n - 2);
    if n > 2 {
        // Of the parabola through the last three nodes. Beyond three times the secant a cubic does not rise all the way
        // (Fritsch and Carlson 1980).
        let (before, after) = (width(n - 3), width(n - 2));
        let lean = after / (before + after) * (secant(n - 2) - secant(n - 3));
        slope[n - 1] = (secant(n - 2) + lean).clamp(0.0, 3.0 * secant(n - 2));
    }
    slope[n - 1] = slope[n - 1].min(most.max(secant(n - 2)));
    slope[0] = 0.5 * (3.0 * secant(0) - slope[1]);
    slope
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steel() -> Odd {
        let b = vec![0.0, 0.2, 0.6, 1.0, 1.3, 1.5, 1.7, 2.0];
        let h = vec![0.0, 60.0, 110.0, 190.0, 420.0, 1600.0, 8000.0, 90_000.0];
        Odd::new(b, h, 795_775.0).unwrap()
    }

    #[test]
    fn it_passes_its_nodes_and_rises_between_them() {
        let odd = steel();
        assert!((odd.at(1.3).value - 420.0).abs() < 1e-9);
        assert!((odd.at(2.0).value - 90_000.0).abs() < 1e-6);
        let mut before = -1.0;
        for k in 0..=2000 {
            let local = odd.at(0.001 * f64::from(k));
            assert!(local.value > before && local.slope > 0.0, "{k}: {local:?}");
            before = local.value;
        }
    }

    /// The slope is that of the value and the value that of the integral, across nodes too.
    #[test]
    fn slope_and_integral_belong_to_the_value() {
        let odd = steel();
        let step = 1e-5;
        for k in 1..199 {
            let x = 0.01 * f64::from(k);
            let [a, b] = [odd.at(x - step), odd.at(x + step)];
            let here = odd.at(x);
            let slope = (b.value - a.value) / (2.0 * step);
            assert!((slope / here.slope - 1.0).abs() < 1e-2, "{x}");
            let value = (b.area - a.area) / (2.0 * step);
            assert!((value / here.value - 1.0).abs() < 1e-3, "{x}");
        }
    }

    #[test]
    fn at_zero_it_is_an_odd_cubic() {
        let odd = steel();
        // y / x has no term of the first order in x.
        let over = |x: f64| odd.at(x).value / x;
        let (a, b, c) = (over(0.001), over(0.01), over(0.1));
        let curve = (c - a) / (0.01 - 1e-6);
        assert!((b - a - curve * (1e-4 - 1e-6)).abs() < 1e-9 * a);
    }

    #[test]
    fn straight_lines_stay_straight_and_what_does_not_rise_is_refused() {
        let line = Odd::new(vec![0.0, 1.0, 3.0], vec![0.0, 2.0, 6.0], 2.0).unwrap();
        for x in [0.0, 0.5, 1.0, 2.5, 3.0] {
            let local = line.at(x);
            assert!((local.value - 2.0 * x).abs() < 1e-14 && (local.slope - 2.0).abs() < 1e-14);
            assert!((local.area - x * x).abs() < 1e-13);
        }
        assert!(Odd::new(vec![0.0, 1.0, 2.0], vec![0.0, 2.0, 2.0], 1.0).is_err());
        assert!(Odd::new(vec![0.1, 1.0, 2.0], vec![0.0, 2.0, 3.0], 1.0).is_err());
        let short = Odd::new(vec![0.0, 1.0], vec![0.0, 1.0], 9.0).unwrap();
        assert!((short.at(0.5).slope - 1.0).abs() < 1e-15);
    }
}
