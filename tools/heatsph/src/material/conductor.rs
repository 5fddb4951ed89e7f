//! Conductivity as a function of temperature, and its integral.
//!
//! Between two points of temperature T1 and T2 in one material the steady flux is `(theta(T2) - theta(T1)) / r`
//! with Kirchhoff's transform, `theta(T)`, the integral of k. With the mean `(theta2 - theta1)/(T2 - T1)` on every
//! link, one-dimensional steady states are exact at the points, however steep k(T) is.

use quadrature::THREE;
use run::property::{Arguments, Curve, OutOfRange};

/// Intervals of the table over the range of temperature at the start.
const INTERVALS: f64 = 2048.0;
/// Most doublings of the interval on one side.
const DOUBLINGS: f64 = 50.0;
/// Part of an interval within which conductivity is that of the middle.
const BLUR: f64 = 1e-6;

/// k(T) and its integral, tabulated. Nodes stand at whole multiples of the interval from the first temperature, in the
/// first range and as far again on both sides. Beyond that intervals double each time the way from the first range has
/// doubled: a body that starts at one temperature may end anywhere. Places of nodes depend on the first range alone, so
/// that a wider table holds the same numbers.
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
        let (from, to) = (self.node(low).floor(), self.node(high).ceil());
        let most = INTERVALS * DOUBLINGS;
        if !(from > -most && to < most) {
            return Err(OutOfRange::Formula {
                value: f64::NAN,
                at: Arguments::at_temperature(if to < most { low } else { high }),
            });
        }
        // The ends lie within an interval of the wanted temperatures; the curve may end at these.
        let (from, to) = (from as i64, to as i64);
        while self.first + self.value.len() as i64 - 1 < to {
            let last = self.first + self.value.len() as i64 - 1;
            let step = self.integrate(last)?;
            self.value.push(self.at(last + 1)?);
            self.integral
                .push(self.integral[self.integral.len() - 1] + step);
        }
        if self.first > from {
            let (mut value, mut integral) = (Vec::new(), Vec::new());
            let mut sum = self.integral[0];
            while self.first > from {
                sum -= self.integrate(self.first - 1)?;
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

    /// The node at a temperature: a whole number and a part of the interval that follows it.
    #[inline]
    fn node(&self, temperature: f64) -> f64 {
        let even = (temperature - self.origin) / self.interval;
        // Counted from the nearer end of the first range.
        let beyond = if even > 0.0 { even - INTERVALS } else { -even };
        if beyond <= INTERVALS || !beyond.is_finite() {
            return even;
        }
        let (far, scale) = doubled(1.0 + beyond / INTERVALS);
        let nodes = INTERVALS * (far + scale - 1.0);
        if even > 0.0 {
            INTERVALS + nodes
        } else {
            -nodes
        }
    }

    /// The temperature at a node \[K\].
    fn place(&self, node: f64) -> f64 {
        let beyond = if node > 0.0 { node - INTERVALS } else { -node };
        if beyond <= INTERVALS {
            return self.origin + self.interval * node;
        }
        let far = (beyond / INTERVALS).floor();
        let way = INTERVALS * (far.exp2() * (1.0 + beyond / INTERVALS - far) - 1.0);
        let even = if node > 0.0 { INTERVALS + way } else { -way };
        self.origin + self.interval * even
    }

    /// Length of the interval that follows a node \[K\].
    #[inline]
    fn length(&self, node: i64) -> f64 {
        let own = INTERVALS as i64;
        let beyond = if node >= 0 { node - own } else { -node - 1 };
        let far = beyond.max(0) / own;
        self.interval * (1_u64 << far.min(63)) as f64
    }

    fn temperature(&self, node: f64) -> f64 {
        let t = self.place(node);
        match self.curve.range_k() {
            // A node beyond the end of a table stands at its end: at most one interval away.
            Some((low, high)) => {
                let near = self
                    .length(node.floor() as i64)
                    .max(self.length(node.ceil() as i64 - 1));
                if t < low && t > low - near {
                    low
                } else if t > high && t < high + near {
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

    /// The integral over the interval that follows a node.
    fn integrate(&self, node: i64) -> Result<f64, OutOfRange> {
        let mut sum = 0.0;
        for (at, weight) in THREE {
            let t = self.temperature(node as f64 + at);
            sum += weight * self.curve.at_temperature(t)?;
        }
        Ok(sum * self.length(node))
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
        let node = self.node(temperature);
        let x = node - self.first as f64;
        if !(x > 0.0 && x < n as f64) {
            let end = if x > 0.0 { n } else { 0 };
            let beyond = temperature - self.place((self.first + end as i64) as f64);
            return (
                self.value[end],
                self.integral[end] + self.value[end] * beyond,
            );
        }
        let i = ((node.floor() as i64 - self.first) as usize).min(n - 1);
        let number = self.first + i as i64;
        let s = node - number as f64;
        let length = self.length(number);
        // Hermite's cubic through the integral with the slopes k.
        let (k0, k1) = (length * self.value[i], length * self.value[i + 1]);
        let rise = self.integral[i + 1] - self.integral[i];
        let (b, c) = (3.0 * rise - 2.0 * k0 - k1, k0 + k1 - 2.0 * rise);
        let integral = self.integral[i] + s * (k0 + s * (b + s * c));
        let value = (k0 + s * (2.0 * b + s * 3.0 * c)) / length;
        (value, integral)
    }

    /// The temperatures that the table spans \[K\]; everything for a constant.
    #[must_use]
    pub fn span(&self) -> (f64, f64) {
        if self.constant().is_some() {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let at = |node: i64| self.place(node as f64);
        (at(self.first), at(self.first + self.value.len() as i64 - 1))
    }
}

/// The power of two below a number that is 1 or more, as exponent and as what is left, from 1 to 2.
#[inline]
fn doubled(value: f64) -> (f64, f64) {
    let bits = value.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i64 - 1023;
    let rest = f64::from_bits((bits & !(0x7ff << 52)) | (1023 << 52));
    (exponent as f64, rest)
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
    fn a_table_reaches_far_from_where_it_starts() {
        for a in [0.0, 300.0] {
            let mut k = Conductor::new(curve("1/(500 + T)"), a, a + 1e-3).unwrap();
            k.widen(0.0, 5000.0).unwrap();
            assert!(k.value.len() < 120_000, "{}", k.value.len());
            assert!(k.span().0 <= 0.0 && k.span().1 >= 5000.0);
            for i in 0..=500 {
                let t = 10.0 * f64::from(i);
                let (value, integral) = k.value_and_integral(t);
                let whole = ((500.0 + t) / (500.0 + a)).ln();
                assert!((value * (500.0 + t) - 1.0).abs() < 1e-9, "{a} {t}: {value}");
                assert!(
                    (integral - whole).abs() < 1e-9,
                    "{a} {t}: {integral} {whole}"
                );
            }
            for node in [
                -9000, -4097, -4096, -2048, -1, 0, 2047, 2048, 4095, 4096, 8191, 8192, 20_000,
            ] {
                let at = k.place(f64::from(node));
                assert!((k.node(at) - f64::from(node)).abs() < 1e-5, "{node}");
                let next = k.place(f64::from(node + 1)) - at;
                assert!(
                    (next / k.length(i64::from(node)) - 1.0).abs() < 1e-5,
                    "{node}: {next}"
                );
            }
        }
    }

    #[test]
    fn a_constant_costs_no_table() {
        let k = Conductor::new(Curve::Constant(40.0), 0.0, 1000.0).unwrap();
        assert_eq!(k.value.len(), 1);
        let ((k0, a), (_, b)) = (k.value_and_integral(100.0), k.value_and_integral(350.0));
        assert!((k0 - 40.0).abs() < 1e-15 && (b - a - 10_000.0).abs() < 1e-9);
    }
}
