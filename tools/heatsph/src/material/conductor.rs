//! Conductivity as a function of temperature, and its integral.
//!
//! Between two points of temperature T1 and T2 in one material the steady flux is `(theta(T2) - theta(T1)) / r`
//! with Kirchhoff's transform, `theta(T)`, the integral of k. With the mean `(theta2 - theta1)/(T2 - T1)` on every
//! link, one-dimensional steady states are exact at the points, however steep k(T) is.

use run::property::{Arguments, Curve, OutOfRange};

/// Intervals of the table over the range of temperature at the start.
const INTERVALS: f64 = 2048.0;
/// Most intervals after widening.
const MOST: usize = 4_000_000;
/// Part of an interval within which conductivity is that of the middle.
const BLUR: f64 = 1e-6;
/// Nodes and weights of Gauss' rule on [0, 1], three points.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// k(T) and its integral, tabulated with equal intervals. Nodes stand at whole multiples of the interval from
/// the first temperature, so that a wider table holds the same numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Conductor {
    curve: Curve,
    origin: f64,
    interval: f64,
    /// Number of the first node.
    first: i64,
    value: Vec<f64>,
    integral: Vec<f64>,
}

impl Conductor {
    /// A table from `low` to `high` \[K\].
    ///
    /// # Errors
    /// Where the curve has no value, or one that is not positive.
    pub fn new(curve: Curve, low: f64, high: f64) -> Result<Self, OutOfRange> {
        let mut conductor = Self {
            origin: low,
            interval: ((high - low) / INTERVALS).max(1e-9 * (low.abs() + high.abs()).max(1e-6)),
            first: 0,
            value: Vec::new(),
            integral: Vec::new(),
            curve,
        };
        let constant = conductor.curve.constant();
        if let Some(value) = constant {
            conductor.value = vec![value];
            conductor.integral = vec![0.0];
            return Ok(conductor);
        }
        let first = conductor.at(0)?;
        conductor.value.push(first);
        conductor.integral.push(0.0);
        conductor.widen(low, high)?;
        Ok(conductor)
    }

    /// The difference of temperature below which the difference of two integrals is rounding \[K\].
    #[must_use]
    pub fn blur(&self) -> f64 {
        BLUR * self.interval
    }

    /// Whether it is the same at all temperatures.
    #[must_use]
    pub fn constant(&self) -> Option<f64> {
        self.curve.constant()
    }

    /// Makes sure that the table spans from `low` to `high` \[K\].
    ///
    /// # Errors
    /// Where the curve has no value, or the range is beyond all measure.
    pub fn widen(&mut self, low: f64, high: f64) -> Result<(), OutOfRange> {
        if self.constant().is_some() {
            return Ok(());
        }
        let node = |t: f64| (t - self.origin) / self.interval;
        let (from, to) = (node(low).floor(), node(high).ceil());
        if !(from > -(MOST as f64) && to < MOST as f64) {
            return Err(OutOfRange::Formula {
                value: f64::NAN,
                at: Arguments::at_temperature(if to < MOST as f64 { low } else { high }),
            });
        }
        // The ends lie within an interval of the wanted temperatures; the curve may end at these.
        let (from, to) = (from as i64, to as i64);
        while self.first + self.value.len() as i64 - 1 < to {
            let last = self.first + self.value.len() as i64 - 1;
            let step = self.integrate(last, 1)?;
            self.value.push(self.at(last + 1)?);
            self.integral
                .push(self.integral[self.integral.len() - 1] + step);
        }
        if self.first > from {
            let (mut value, mut integral) = (Vec::new(), Vec::new());
            let mut sum = self.integral[0];
            while self.first > from {
                sum -= self.integrate(self.first - 1, 1)?;
                self.first -= 1;
                value.push(self.at(self.first)?);
                integral.push(sum);
            }
            value.reverse();
            integral.reverse();
            value.append(&mut self.value);
            integral.append(&mut self.integral);
            (self.value, self.integral) = (value, integral);
        }
        Ok(())
    }

    fn temperature(&self, node: f64) -> f64 {
        let t = self.origin + self.interval * node;
        match self.curve.range_k() {
            // A node beyond the end of a table stands at its end: at most one interval away.
            Some((low, high)) => {
                if t < low && t > low - self.interval {
                    low
                } else if t > high && t < high + self.interval {
                    high
                } else {
                    t
                }
            }
            None => t,
        }
    }

    /// k at a node, which must be above zero.
    fn at(&self, node: i64) -> Result<f64, OutOfRange> {
        let t = self.temperature(node as f64);
        let value = self.curve.at_temperature(t)?;
        if value > 0.0 {
            Ok(value)
        } else {
            Err(OutOfRange::Formula {
                value,
                at: Arguments::at_temperature(t),
            })
        }
    }

    fn integrate(&self, node: i64, intervals: i64) -> Result<f64, OutOfRange> {
        let mut sum = 0.0;
        for (at, weight) in GAUSS {
            let t = self.temperature(node as f64 + at * intervals as f64);
            sum += weight * self.curve.at_temperature(t)?;
        }
        Ok(sum * self.interval * intervals as f64)
    }

    /// k at `temperature` \[W/(m K)\]; beyond the table that of its end.
    #[inline]
    #[must_use]
    pub fn value(&self, temperature: f64) -> f64 {
        self.value_and_integral(temperature).0
    }

    /// k \[W/(m K)\] and its integral \[W/m\] at `temperature`; beyond the table k is that of its end.
    #[inline]
    #[must_use]
    pub fn value_and_integral(&self, temperature: f64) -> (f64, f64) {
        let n = self.value.len() - 1;
        if n == 0 {
            return (self.value[0], self.value[0] * (temperature - self.origin));
        }
        // Counted from the origin, so that a wider table gives the same bits.
        let node = (temperature - self.origin) / self.interval;
        let x = node - self.first as f64;
        if !(x > 0.0 && x < n as f64) {
            let end = if x > 0.0 { n } else { 0 };
            let beyond = self.interval * (x - end as f64);
            return (
                self.value[end],
                self.integral[end] + self.value[end] * beyond,
            );
        }
        let i = ((node.floor() as i64 - self.first) as usize).min(n - 1);
        let s = node - (self.first + i as i64) as f64;
        // Hermite's cubic through the integral with the slopes k.
        let (k0, k1) = (
            self.interval * self.value[i],
            self.interval * self.value[i + 1],
        );
        let rise = self.integral[i + 1] - self.integral[i];
        let (b, c) = (3.0 * rise - 2.0 * k0 - k1, k0 + k1 - 2.0 * rise);
        let integral = self.integral[i] + s * (k0 + s * (b + s * c));
        let value = (k0 + s * (2.0 * b + s * 3.0 * c)) / self.interval;
        (value, integral)
    }

    /// The temperatures that the table spans \[K\]; everything for a constant.
    #[must_use]
    pub fn span(&self) -> (f64, f64) {
        if self.constant().is_some() {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let at = |node: i64| self.origin + self.interval * node as f64;
        (at(self.first), at(self.first + self.value.len() as i64 - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use run::property::{Formula, Property};

    fn curve(text: &str) -> Curve {
        let formula = Property::Formula(Formula {
            expr: text.to_owned(),
        });
        formula.compile("/k", &["T"]).unwrap()
    }

    #[test]
    fn the_integral_of_a_steep_law_is_exact() {
        for a in [8.0, -3.0, 1.0] {
            let k = Conductor::new(curve(&format!("exp({a}*T)")), 0.0, 1.0).unwrap();
            for i in 0..=100 {
                let t = 0.01 * f64::from(i);
                let (value, integral) = k.value_and_integral(t);
                let exact = (a * t).exp();
                assert!((value - exact).abs() < 1e-8 * exact, "{a} {t}: {value}");
                let whole = ((a * t).exp() - 1.0) / a;
                assert!(
                    (integral - whole).abs() < 1e-11 * exact,
                    "{a} {t}: {integral} {whole}"
                );
            }
        }
    }

    #[test]
    fn a_wider_table_holds_the_same_numbers() {
        let mut k = Conductor::new(curve("1/(1 + T)"), 300.0, 400.0).unwrap();
        let before: Vec<_> = [301.0, 333.3, 399.0]
            .map(|t| k.value_and_integral(t))
            .into();
        k.widen(250.0, 900.0).unwrap();
        let after: Vec<_> = [301.0, 333.3, 399.0]
            .map(|t| k.value_and_integral(t))
            .into();
        assert_eq!(before, after);
        assert!(k.span().0 <= 250.0 && k.span().1 >= 900.0);
    }

    #[test]
    fn a_constant_costs_no_table() {
        let k = Conductor::new(Curve::Constant(40.0), 0.0, 1000.0).unwrap();
        assert_eq!(k.value.len(), 1);
        let ((k0, a), (_, b)) = (k.value_and_integral(100.0), k.value_and_integral(350.0));
        assert!((k0 - 40.0).abs() < 1e-15 && (b - a - 10_000.0).abs() < 1e-9);
    }
}
