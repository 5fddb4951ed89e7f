//! The exact integral of a positive piecewise linear table, and its inverse.

use crate::{Error, Table};

/// `F(x)`, the integral of `y` from the first node to `x`; beyond the ends `y` keeps its end value.
#[derive(Debug, Clone, PartialEq)]
pub struct Integral {
    density: Table,
    /// Nodes of x against F, for the look-up of the inverse.
    inverse: Table,
}

impl Integral {
    /// Integrates `density`.
    ///
    /// # Errors
    /// When a value is not positive: the integral could not be inverted.
    pub fn new(density: &Table) -> Result<Self, Error> {
        if let Some((row, value)) = density
            .values()
            .iter()
            .enumerate()
            .find(|(_, v)| **v <= 0.0)
        {
            return Err(Error::NotPositive { row, value: *value });
        }
        let mut total = vec![0.0];
        for (x, y) in density.nodes().windows(2).zip(density.values().windows(2)) {
            let step = 0.5 * (x[1] - x[0]) * (y[0] + y[1]);
            total.push(total[total.len() - 1] + step);
        }
        let inverse = Table::new(total, density.nodes().to_vec())?;
        Ok(Self {
            density: density.clone(),
            inverse,
        })
    }

    /// `F(x)`.
    #[must_use]
    #[inline]
    pub fn value(&self, x: f64) -> f64 {
        let (nodes, y, sums) = (
            self.density.nodes(),
            self.density.values(),
            self.inverse.nodes(),
        );
        let last = nodes.len() - 1;
        if x <= nodes[0] {
            return (x - nodes[0]) * y[0];
        }
        if x >= nodes[last] {
            return sums[last] + (x - nodes[last]) * y[last];
        }
        let k = self.density.interval(x);
        let d = x - nodes[k];
        let slope = (y[k + 1] - y[k]) / (nodes[k + 1] - nodes[k]);
        sums[k] + d * (y[k] + 0.5 * slope * d)
    }

    /// `dF/dx`, the table itself, held beyond its ends.
    #[must_use]
    #[inline]
    pub fn slope(&self, x: f64) -> f64 {
        self.density.held(x)
    }

    /// The `x` at which `F(x) = f`.
    #[must_use]
    #[inline]
    pub fn inverse(&self, f: f64) -> f64 {
        let (nodes, y, sums) = (
            self.density.nodes(),
            self.density.values(),
            self.inverse.nodes(),
        );
        let last = nodes.len() - 1;
        if f <= 0.0 {
            return nodes[0] + f / y[0];
        }
        if f >= sums[last] {
            return nodes[last] + (f - sums[last]) / y[last];
        }
        let k = self.inverse.interval(f);
        let slope = (y[k + 1] - y[k]) / (nodes[k + 1] - nodes[k]);
        let rest = f - sums[k];
        // The root of y d + slope d^2 / 2 = rest that is free of cancellation.
        nodes[k] + 2.0 * rest / (y[k] + (y[k] * y[k] + 2.0 * slope * rest).max(0.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_integral_of_a_line_is_its_parabola() {
        let t = Table::new(vec![0.0, 2.0, 3.0], vec![1.0, 5.0, 7.0]).unwrap();
        let f = Integral::new(&t).unwrap();
        for x in [0.0, 0.5, 2.0, 2.9, 3.0] {
            assert!((f.value(x) - (x + x * x)).abs() < 1e-13);
        }
        assert!((f.value(4.0) - (12.0 + 7.0)).abs() < 1e-13);
        assert!((f.value(-1.0) + 1.0).abs() < 1e-13);
    }

    #[test]
    fn a_zero_value_is_refused() {
        let t = Table::new(vec![0.0, 1.0], vec![1.0, 0.0]).unwrap();
        assert_eq!(
            Integral::new(&t),
            Err(Error::NotPositive { row: 1, value: 0.0 })
        );
    }

    proptest! {
        #[test]
        fn the_inverse_undoes_the_integral(
            rows in prop::collection::vec((1.0..500.0_f64, 0.1..1e4_f64), 2..40),
            part in -0.2..1.2_f64,
        ) {
            let mut x = Vec::new();
            let mut at = 300.0;
            for (step, _) in &rows {
                x.push(at);
                at += step;
            }
            let t = Table::new(x.clone(), rows.iter().map(|r| r.1).collect()).unwrap();
            let f = Integral::new(&t).unwrap();
            let want = x[0] + part * (x[x.len() - 1] - x[0]);
            let found = f.inverse(f.value(want));
            prop_assert!((found - want).abs() < 1e-6 * (1.0 + want.abs()), "{found} {want}");
        }
    }
}
