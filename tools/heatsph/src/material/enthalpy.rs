//! Heat of the unit volume as a function of temperature: the integral of rho c.
//!
//! A cell has a fixed volume, so what it stores is `integral of rho(T) c(T) dT`: the product of density and specific
//! heat is what counts, and a density that falls with temperature is that of the cell, not metal that leaves it.
//!
//! The integral is tabulated between knots that stand as close as it needs: rows of tables are knots, intervals are
//! halved until two rules agree, and bounds of the formula over whole intervals (Moore 1966) leave no peak between
//! samples. Cells of the table stand at places that depend on the first range of temperature alone, so that a table that
//! was widened in many steps holds the same numbers as one that was widened in one.

use quadrature::THREE;
use run::property::{Arguments, OutOfRange};

use super::volumetric::Volumetric;

/// Cells over the first range, and growth of those beyond it from one to the next.
const CELLS: i64 = 16;
const GROWTH: f64 = 1.0 / 16.0;
/// Most cells on one side: they reach 1e9 times the first range.
const SIDE: i64 = 400;
/// Error of the integral within an interval, over the heat of its cell.
const TOLERANCE: f64 = 1e-12;
/// Part by which the slope of the integral may differ from rho c.
const SLOPE: f64 = 1e-4;
/// Shortest interval over the temperatures at its ends: a jump.
const JUMP: f64 = 1e-14;
/// Bounds wider than this many times what samples span are not trusted, unless they shrink with the interval.
const TRUST: f64 = 3.0;
const SHRINKS: f64 = 0.75;
/// Part of a value that is no peak.
const NOTHING: f64 = 1e-3;
/// Most knots of a cell.
const MOST: usize = 50_000;
/// Iterations within an interval.
const ITERATIONS: usize = 80;

/// A knot of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Knot {
    temperature: f64,
    /// rho c \[J/(m3 K)\].
    slope: f64,
    /// Heat above the first temperature \[J/m3\].
    heat: f64,
}

/// rho c and its integral.
#[derive(Debug, Clone, PartialEq)]
pub struct Enthalpy {
    law: Volumetric,
    /// First range of temperature \[K\].
    range: (f64, f64),
    /// Number of the first cell and of that after the last.
    cells: (i64, i64),
    knots: Vec<Knot>,
    resolved: bool,
}

impl Enthalpy {
    /// The table of a law over a range \[K\].
    ///
    /// # Errors
    /// Where the law has no value, or one that is not positive.
    pub fn new(law: Volumetric, range: (f64, f64)) -> Result<Self, OutOfRange> {
        let (low, high) = range;
        let width = (high - low).max(1e-9 * (low.abs() + high.abs()).max(1e-6));
        let first = Knot {
            temperature: low,
            slope: law.value(low)?,
            heat: 0.0,
        };
        let mut table = Self {
            range: (low, low + width),
            cells: (0, 0),
            knots: vec![first],
            resolved: true,
            law,
        };
        table.widen(low, high)?;
        Ok(table)
    }

    /// The function that is the temperature itself: of what stores the same at all temperatures.
    #[must_use]
    pub fn even(origin: f64) -> Self {
        let first = Knot {
            temperature: origin,
            slope: 1.0,
            heat: 0.0,
        };
        Self {
            law: Volumetric {
                factors: Vec::new(),
                place: [0.0; 3],
            },
            range: (origin, origin),
            cells: (0, 0),
            knots: vec![first],
            resolved: true,
        }
    }

    /// Whether all peaks were found.
    #[must_use]
    pub fn is_resolved(&self) -> bool {
        self.resolved
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (size_of::<Self>() + size_of::<Knot>() * self.knots.len()) as u64
    }

    /// The temperatures that the table spans \[K\]; everything for a constant.
    #[must_use]
    pub fn span(&self) -> (f64, f64) {
        if self.law.constant().is_some() {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let ends = [0, self.knots.len() - 1].map(|k| self.knots[k].temperature);
        (ends[0], ends[1])
    }

    /// Begin of a cell of the table: equal ones over the first range, growing ones beyond, none below 0 K.
    fn begin(&self, cell: i64) -> f64 {
        let (low, high) = self.range;
        let width = (high - low) / CELLS as f64;
        let beyond = |n: i64| width * ((1.0 + GROWTH).powi(n as i32) - 1.0) / GROWTH;
        let plain = if cell < 0 {
            low - beyond(-cell)
        } else if cell > CELLS {
            high + beyond(cell - CELLS)
        } else if cell == CELLS {
            high
        } else {
            low + width * cell as f64
        };
        let (from, to) = self.law.range();
        let least = if low >= 0.0 { from.max(0.0) } else { from };
        plain.max(least).min(to)
    }

    /// Makes the table span from `low` to `high` \[K\], as far as there are such temperatures; whether it has grown.
    ///
    /// # Errors
    /// Where the law has no value, or the range is beyond all measure.
    pub fn widen(&mut self, low: f64, high: f64) -> Result<bool, OutOfRange> {
        if self.law.constant().is_some() {
            return Ok(false);
        }
        let (from, to) = self.span();
        if low < from && low >= 0.0 {
            self.law.value(low)?;
        }
        if high > to {
            self.law.value(high)?;
        }
        let before = self.cells;
        while high > self.span().1 && self.cells.1 < CELLS + SIDE {
            let cell = self.cells.1;
            let mut last = self.knots[self.knots.len() - 1];
            for knot in self.cell(cell)? {
                last = Knot {
                    heat: last.heat + knot.heat,
                    ..knot
                };
                self.knots.push(last);
            }
            self.cells.1 += 1;
        }
        let mut under = Vec::new();
        let mut first = self.knots[0];
        while low < first.temperature && self.cells.0 > -SIDE {
            // Pieces lead from the lower knot to the upper one, and are gone over from above.
            let begin = self.begin(self.cells.0 - 1);
            if begin >= first.temperature {
                break;
            }
            let pieces = self.cell(self.cells.0 - 1)?;
            self.cells.0 -= 1;
            for k in (0..pieces.len()).rev() {
                let below = if k == 0 {
                    begin
                } else {
                    pieces[k - 1].temperature
                };
                first = Knot {
                    temperature: below,
                    slope: self.law.value(below)?,
                    heat: first.heat - pieces[k].heat,
                };
                under.push(first);
            }
        }
        under.reverse();
        under.append(&mut self.knots);
        self.knots = under;
        if !(high <= self.span().1 || high > self.law.range().1) {
            return Err(OutOfRange::Formula {
                value: f64::NAN,
                at: Arguments::at_temperature(high),
            });
        }
        Ok(self.cells != before)
    }

    /// The pieces of a cell: their upper knots, each with the heat of the piece.
    fn cell(&mut self, cell: i64) -> Result<Vec<Knot>, OutOfRange> {
        let (begin, end) = (self.begin(cell), self.begin(cell + 1));
        let mut ends: Vec<f64> = self.law.rows().collect();
        ends.retain(|t| *t > begin && *t < end);
        ends.push(end);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let (mut found, mut from) = (Vec::new(), begin);
        if begin >= end {
            return Ok(found);
        }
        let mut least = self.law.value(begin)?.min(self.law.value(end)?);
        for (s, _) in THREE {
            least = least.min(self.law.value(begin + s * (end - begin))?);
        }
        // No peak that a sample happens to meet may loosen what is tolerated.
        let heat = least * (end - begin);
        for to in ends {
            let mut left = vec![[from, to]];
            while let Some([a, b]) = left.pop() {
                let middle = 0.5 * (a + b);
                let jump = b - a <= JUMP * (a.abs() + b.abs()) || middle <= a || middle >= b;
                let (piece, good) = self.piece([a, b], heat)?;
                if good {
                    found.push(piece);
                } else if jump || found.len() > MOST {
                    // The slopes of both sides, and what lies between.
                    self.resolved &= jump;
                    let slopes = self.law.value(a)? + self.law.value(b)?;
                    found.push(Knot {
                        heat: 0.5 * slopes * (b - a),
                        ..piece
                    });
                } else {
                    left.push([middle, b]);
                    left.push([a, middle]);
                }
            }
            from = to;
        }
        Ok(found)
    }

    fn gauss(&self, a: f64, b: f64) -> Result<f64, OutOfRange> {
        let mut sum = 0.0;
        for (s, weight) in THREE {
            sum += weight * self.law.value(a + s * (b - a))?;
        }
        Ok(sum * (b - a))
    }

    /// The piece between two temperatures, and whether it is good enough within a cell of this heat.
    fn piece(&self, [a, b]: [f64; 2], cell: f64) -> Result<(Knot, bool), OutOfRange> {
        let (length, middle) = (b - a, 0.5 * (a + b));
        let whole = self.gauss(a, b)?;
        let heat = self.gauss(a, middle)? + self.gauss(middle, b)?;
        let (first, last) = (self.law.value(a)?, self.law.value(b)?);
        let knot = |temperature, slope, heat| Knot {
            temperature,
            slope,
            heat,
        };
        let piece = knot(b, last, heat);
        let between = Between::new(knot(a, first, 0.0), piece);
        let (mut low, mut high) = (first.min(last), first.max(last));
        let (mut error, mut part) = ((whole - heat).abs(), 0.0_f64);
        for s in [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875] {
            let value = self.law.value(a + s * length)?;
            (low, high) = (low.min(value), high.max(value));
            let miss = (between.slope(s) - value).abs();
            error = error.max(0.25 * length * miss);
            part = part.max(miss / value);
        }
        let good = error <= TOLERANCE * cell && part <= SLOPE;
        Ok((piece, good && self.trusted([a, b], low, high)))
    }

    /// Whether nothing hides between samples that span from `low` to `high`.
    fn trusted(&self, [a, b]: [f64; 2], low: f64, high: f64) -> bool {
        let whole = self.law.bounds([a, b]).width();
        if whole <= TRUST * (high - low) + NOTHING * high {
            return true;
        }
        if !whole.is_finite() {
            return false;
        }
        // Bounds that are wide because a variable occurs twice shrink with the interval; those of a peak do not.
        let parts = |count: u32| {
            let at = |k: u32| a + (b - a) * f64::from(k) / f64::from(count);
            let each = (0..count).map(|k| self.law.bounds([at(k), at(k + 1)]).width());
            each.fold(0.0, f64::max)
        };
        parts(2) <= SHRINKS * whole && parts(4) <= SHRINKS * SHRINKS * whole
    }

    /// rho c \[J/(m3 K)\] and heat \[J/m3\] at a temperature; beyond the table rho c is that of its end.
    #[inline]
    #[must_use]
    pub fn at(&self, temperature: f64) -> (f64, f64) {
        let next = self.knots.partition_point(|k| k.temperature <= temperature);
        if let (true, Some(above)) = (next > 0, self.knots.get(next)) {
            let between = Between::new(self.knots[next - 1], *above);
            let s = (temperature - between.begin) / between.length;
            return (between.slope(s), between.heat(s));
        }
        let end = self.knots[next.saturating_sub(1)];
        (
            end.slope,
            end.heat + end.slope * (temperature - end.temperature),
        )
    }

    /// The temperature at which a heat is stored \[K\].
    #[must_use]
    pub fn temperature(&self, heat: f64) -> f64 {
        let next = self.knots.partition_point(|k| k.heat <= heat);
        if let (true, Some(above)) = (next > 0, self.knots.get(next)) {
            return Between::new(self.knots[next - 1], *above).temperature(heat);
        }
        let end = self.knots[next.saturating_sub(1)];
        end.temperature + (heat - end.heat) / end.slope
    }
}

/// Hermite's cubic through the heats of two knots, with their slopes.
#[derive(Debug, Clone, Copy)]
struct Between {
    begin: f64,
    length: f64,
    first: f64,
    coefficients: [f64; 3],
}

impl Between {
    #[inline]
    fn new(from: Knot, to: Knot) -> Self {
        let length = to.temperature - from.temperature;
        let (a, b) = (from.slope * length, to.slope * length);
        let rise = to.heat - from.heat;
        Self {
            begin: from.temperature,
            length,
            first: from.heat,
            coefficients: [a, 3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise],
        }
    }

    #[inline]
    fn heat(&self, s: f64) -> f64 {
        let [a, b, c] = self.coefficients;
        self.first + s * (a + s * (b + s * c))
    }

    #[inline]
    fn slope(&self, s: f64) -> f64 {
        let [a, b, c] = self.coefficients;
        (a + s * (2.0 * b + s * 3.0 * c)) / self.length
    }

    /// Newton's method between bounds: the cubic rises.
    fn temperature(&self, heat: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        let mut s = ((heat - self.first) / (self.heat(1.0) - self.first)).clamp(0.0, 1.0);
        for _ in 0..ITERATIONS {
            let miss = self.heat(s) - heat;
            if miss > 0.0 {
                high = s;
            } else {
                low = s;
            }
            let newton = s - miss / (self.slope(s) * self.length);
            if (newton - s).abs() <= f64::EPSILON * s {
                break;
            }
            s = if newton >= low && newton <= high {
                newton
            } else {
                0.5 * (low + high)
            };
        }
        self.begin + s * self.length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use run::property::Property;

    fn table(text: &str, range: (f64, f64)) -> Enthalpy {
        let property: Property = serde_json::from_str(text).unwrap();
        let law = Volumetric {
            factors: vec![property.compile("/c", &["T"]).unwrap()],
            place: [0.0; 3],
        };
        Enthalpy::new(law, range).unwrap()
    }

    #[test]
    fn the_integral_is_exact_and_turns_back() {
        for a in [8.0_f64, -3.0, 1.0] {
            let e = table(&format!(r#"{{"expr": "exp({a}*T)"}}"#), (0.0, 1.0));
            for i in 0..=1000 {
                let t = 0.001 * f64::from(i);
                let (slope, heat) = e.at(t);
                let whole = (a * t).exp_m1() / a;
                assert!((slope / (a * t).exp() - 1.0).abs() < 1e-4, "{a} {t}");
                let all = (a.exp_m1() / a).abs();
                assert!(
                    (heat - whole).abs() < 1e-11 * all,
                    "{a} {t}: {heat} {whole}"
                );
                assert!((e.temperature(heat) - t).abs() < 1e-12, "{a} {t}");
            }
        }
    }

    #[test]
    fn no_peak_is_too_narrow_to_be_found() {
        // Latent heat of 2.5e5 within some thousandths of a kelvin, between no two samples of a coarse table.
        for width in [1.0, 1e-3, 1e-6] {
            let peak = format!("500 + 2.5e5/{width}/sqrt(pi)*exp(-((T - 1637.123456)/{width})^2)");
            let e = table(&format!(r#"{{"expr": "{peak}"}}"#), (300.0, 2300.0));
            let all = e.at(2300.0).1;
            let wanted = 500.0 * 2000.0 + 2.5e5;
            assert!((all / wanted - 1.0).abs() < 1e-10, "{width}: {all}");
            assert!(e.is_resolved());
            let half = e.at(1637.123456).1;
            assert!((half - 500.0 * 1337.123456 - 1.25e5).abs() < 1e-4 * 2.5e5);
            let t = e.temperature(half);
            assert!((t - 1637.123456).abs() < 1e-3 * width + 1e-10, "{t}");
        }
    }

    #[test]
    fn rows_and_jumps_are_knots() {
        let e = table(
            r#"{"t_k": [300, 1000, 1000.01, 2000], "value": [500, 700, 70000, 700]}"#,
            (300.0, 2000.0),
        );
        let exact = 600.0 * 700.0 + 0.5 * 70700.0 * 0.01 + 0.5 * 70700.0 * 999.99;
        assert!((e.at(2000.0).1 / exact - 1.0).abs() < 1e-12);
        let e = table(r#"{"expr": "if(T - 400.7, 900, 450)"}"#, (300.0, 500.0));
        let exact = 450.0 * 100.7 + 900.0 * 99.3;
        assert!((e.at(500.0).1 / exact - 1.0).abs() < 1e-12);
        assert!(e.is_resolved());
    }

    #[test]
    fn a_wider_table_holds_the_same_numbers() {
        let text = r#"{"expr": "400 + 0.3*T + 1e5/(1 + T)^2"}"#;
        let (mut once, mut often) = (table(text, (300.0, 400.0)), table(text, (300.0, 400.0)));
        once.widen(100.0, 900.0).unwrap();
        for step in 1..=10 {
            let s = f64::from(step);
            often.widen(300.0 - 20.0 * s, 400.0 + 50.0 * s).unwrap();
        }
        for t in [101.0, 250.0, 333.3, 399.0, 555.5, 900.0] {
            assert_eq!(once.at(t), often.at(t));
        }
        // Nothing is below 0 K, and no table is asked beyond its rows.
        assert!(once.widen(-1.0, 900.0).is_ok() && once.span().0 <= 0.0);
        assert!(!once.widen(-1.0, 900.0).unwrap());
        let mut rows = table(r#"{"t_k": [300, 500], "value": [1, 2]}"#, (310.0, 320.0));
        assert!(rows.widen(300.0, 500.0).is_ok());
        assert!(rows.widen(300.0, 501.0).is_err() && rows.widen(299.0, 500.0).is_err());
    }

    #[test]
    fn what_is_not_positive_is_no_heat_capacity() {
        let law = |text: &str| Volumetric {
            factors: vec![
                serde_json::from_str::<Property>(text)
                    .unwrap()
                    .compile("/c", &["T"])
                    .unwrap(),
            ],
            place: [0.0; 3],
        };
        let falling = law(r#"{"expr": "1000 - T"}"#);
        assert!(Enthalpy::new(falling.clone(), (300.0, 900.0)).is_ok());
        assert!(Enthalpy::new(falling, (300.0, 1100.0)).is_err());
    }
}
