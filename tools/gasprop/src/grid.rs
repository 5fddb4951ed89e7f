//! Where a table has its temperatures, and what linear interpolation between them costs.
//!
//! The error of an interval is measured, not estimated: the gas is evaluated at its middle as well, and compared with
//! the mean of both ends, column by column, relative to the value or, where that is small, to [`SMALL`] of the column's
//! greatest value. Halving the worst intervals until there are enough temperatures spreads the error evenly (the
//! equidistribution of de Boor 1973); a middle that was evaluated for its error becomes a temperature then, so that a
//! chosen table costs no more than an even one.

/// Part of a column's greatest value below which errors count relative to this part.
pub const SMALL: f64 = 1e-3;
/// Part of the intervals that is halved at once.
const AT_ONCE: usize = 6;
/// Part of the temperatures that a chosen table begins with, at equal ratios.
const BEGINNING: usize = 4;

/// One column at each iron fraction: `values[fraction][column]`.
pub type Rows = Vec<Vec<f64>>;

/// Rows at rising temperatures.
#[derive(Debug, Clone, Default)]
pub struct Sheet {
    /// Temperatures, K.
    pub temperatures: Vec<f64>,
    /// Rows at each.
    pub rows: Vec<Rows>,
    /// Rows in the middle of each interval.
    pub middles: Vec<Rows>,
}

/// Where an error is greatest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Worst {
    /// The relative error.
    pub error: f64,
    /// Temperature, K.
    pub temperature: f64,
    /// Place of the iron fraction (along temperature) or of the interval (along iron).
    pub fraction: usize,
}

impl Worst {
    fn take(&mut self, error: f64, temperature: f64, fraction: usize) {
        if error > self.error {
            *self = Self {
                error,
                temperature,
                fraction,
            };
        }
    }
}

/// The temperatures that a chosen table begins with.
#[must_use]
pub fn beginning(from: f64, to: f64, count: usize) -> Vec<f64> {
    let begin = (count / BEGINNING).clamp(2, count);
    let step = (to / from).ln() / (begin - 1) as f64;
    spaced(begin, |k| from * (step * k).exp(), to)
}

/// `count` temperatures at equal distances.
#[must_use]
pub fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    let step = (to - from) / (count - 1) as f64;
    spaced(count, |k| from + step * k, to)
}

/// Values at 0, 1, ... rounded to a thousandth, the last exactly `to`.
fn spaced(count: usize, at: impl Fn(f64) -> f64, to: f64) -> Vec<f64> {
    let mut all: Vec<f64> = (0..count)
        .map(|k| (at(k as f64) * 1e3).round() / 1e3)
        .collect();
    all[count - 1] = to;
    all
}

/// The middles of all intervals.
#[must_use]
pub fn middles(nodes: &[f64]) -> Vec<f64> {
    nodes
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .collect()
}

impl Sheet {
    /// Greatest size of each column.
    #[must_use]
    pub fn greatest(&self) -> Vec<f64> {
        let columns = self
            .rows
            .first()
            .and_then(|rows| rows.first())
            .map_or(0, Vec::len);
        let mut greatest = vec![0.0_f64; columns];
        for row in self.rows.iter().flatten() {
            for (most, value) in greatest.iter_mut().zip(row) {
                *most = most.max(value.abs());
            }
        }
        greatest
    }

    /// Greatest error of each interval over columns and fractions.
    fn errors(&self) -> Vec<f64> {
        let greatest = self.greatest();
        let one = |k: usize| {
            let mut worst = 0.0_f64;
            for (fraction, middle) in self.middles[k].iter().enumerate() {
                let (before, after) = (&self.rows[k][fraction], &self.rows[k + 1][fraction]);
                for (c, most) in greatest.iter().enumerate() {
                    worst = worst.max(relative(middle[c], before[c], after[c], *most));
                }
            }
            worst
        };
        (0..self.middles.len()).map(one).collect()
    }

    /// Which intervals to halve next, rising, if there shall be `count` temperatures in the end.
    #[must_use]
    pub fn to_halve(&self, count: usize) -> Vec<usize> {
        let errors = self.errors();
        let wanted = count.saturating_sub(self.temperatures.len());
        let at_once = wanted.min(errors.len().div_ceil(AT_ONCE));
        let mut order: Vec<usize> = (0..errors.len()).collect();
        order.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]).then(a.cmp(b)));
        order.truncate(at_once);
        order.sort_unstable();
        order
    }

    /// Makes the middles of `intervals` (rising) temperatures; says where the new middles are, which must be put in
    /// with [`Sheet::fill`] before the sheet is used again.
    pub fn halve(&mut self, intervals: &[usize]) -> Vec<f64> {
        let mut fresh = Vec::with_capacity(2 * intervals.len());
        for k in intervals.iter().rev() {
            let rows = std::mem::take(&mut self.middles[*k]);
            let (from, to) = (self.temperatures[*k], self.temperatures[k + 1]);
            let middle = 0.5 * (from + to);
            self.temperatures.insert(k + 1, middle);
            self.rows.insert(k + 1, rows);
            self.middles.insert(k + 1, Rows::new());
            fresh.extend([0.5 * (middle + to), 0.5 * (from + middle)]);
        }
        fresh.reverse();
        fresh
    }

    /// Puts rows in where middles are missing, in rising order.
    pub fn fill(&mut self, rows: Vec<Rows>) {
        let empty = self.middles.iter_mut().filter(|middle| middle.is_empty());
        empty.zip(rows).for_each(|(middle, rows)| *middle = rows);
    }

    /// Greatest error of each column along the temperatures.
    #[must_use]
    pub fn worst(&self) -> Vec<Worst> {
        let greatest = self.greatest();
        let mut worst = vec![Worst::default(); greatest.len()];
        for (k, middle) in self.middles.iter().enumerate() {
            let temperature = 0.5 * (self.temperatures[k] + self.temperatures[k + 1]);
            for (fraction, row) in middle.iter().enumerate() {
                let (before, after) = (&self.rows[k][fraction], &self.rows[k + 1][fraction]);
                for (c, most) in greatest.iter().enumerate() {
                    let error = relative(row[c], before[c], after[c], *most);
                    worst[c].take(error, temperature, fraction);
                }
            }
        }
        worst
    }

    /// Greatest error of each column along the iron fractions; `between[temperature][interval]` are rows in the middle
    /// of each interval of iron.
    #[must_use]
    pub fn worst_of_iron(&self, between: &[Rows]) -> Vec<Worst> {
        let greatest = self.greatest();
        let mut worst = vec![Worst::default(); greatest.len()];
        for (k, row) in between.iter().enumerate() {
            for (interval, middle) in row.iter().enumerate() {
                let (before, after) = (&self.rows[k][interval], &self.rows[k][interval + 1]);
                for (c, most) in greatest.iter().enumerate() {
                    let error = relative(middle[c], before[c], after[c], *most);
                    worst[c].take(error, self.temperatures[k], interval);
                }
            }
        }
        worst
    }
}

/// Error of the mean of both ends.
fn relative(middle: f64, before: f64, after: f64, greatest: f64) -> f64 {
    let scale = middle.abs().max(SMALL * greatest);
    if scale > 0.0 {
        (middle - 0.5 * (before + after)).abs() / scale
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of one fraction over `f`, with so many temperatures.
    fn sheet(count: usize, f: impl Fn(f64) -> f64) -> Sheet {
        let rows = |at: &[f64]| at.iter().map(|t| vec![vec![f(*t)]]).collect::<Vec<_>>();
        let temperatures = beginning(300.0, 30_000.0, count);
        let mut sheet = Sheet {
            rows: rows(&temperatures),
            middles: rows(&middles(&temperatures)),
            temperatures,
        };
        while sheet.temperatures.len() < count {
            let intervals = sheet.to_halve(count);
            let fresh = sheet.halve(&intervals);
            sheet.fill(rows(&fresh));
        }
        sheet
    }

    #[test]
    fn middles_stay_in_the_middle() {
        let line = sheet(57, |t| 3.0 + 2.0 * t);
        assert_eq!(line.temperatures.len(), 57);
        assert!(line.temperatures.windows(2).all(|pair| pair[0] < pair[1]));
        for (k, middle) in line.middles.iter().enumerate() {
            let at = 0.5 * (line.temperatures[k] + line.temperatures[k + 1]);
            assert!((middle[0][0] - 3.0 - 2.0 * at).abs() < 1e-9);
        }
        assert!(line.worst()[0].error < 1e-12);
    }

    #[test]
    fn temperatures_gather_where_the_curve_bends() {
        let step = |t: f64| 1.0 + ((t - 9000.0) / 500.0).tanh();
        let chosen = sheet(100, step);
        let near = chosen
            .temperatures
            .iter()
            .filter(|t| (7500.0..10_500.0).contains(*t));
        assert!(near.count() > 30);
        let even_nodes = even(300.0, 30_000.0, 100);
        let mut worst_of_even = 0.0_f64;
        for pair in even_nodes.windows(2) {
            let middle = step(0.5 * (pair[0] + pair[1]));
            worst_of_even = worst_of_even.max(relative(middle, step(pair[0]), step(pair[1]), 2.0));
        }
        assert!(chosen.worst()[0].error < 0.2 * worst_of_even);
    }

    /// The error of an interval of width w falls as w^2 f''/8.
    #[test]
    fn the_error_is_that_of_linear_interpolation() {
        let square = |t: f64| t * t;
        let nodes = [1000.0, 1100.0];
        let one = Sheet {
            temperatures: nodes.to_vec(),
            rows: nodes.iter().map(|t| vec![vec![square(*t)]]).collect(),
            middles: vec![vec![vec![square(1050.0)]]],
        };
        let exact = 100.0 * 100.0 / 4.0 / square(1050.0);
        assert!((one.worst()[0].error - exact).abs() < 1e-12);
    }
}
