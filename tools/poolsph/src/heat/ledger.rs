//! Sums of energy over a whole run.

/// A sum that loses no digits to its length (Neumaier 1974).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sum {
    total: f64,
    lost: f64,
}

impl Sum {
    /// Adds `x`.
    #[inline]
    pub fn add(&mut self, x: f64) {
        let sum = self.total + x;
        self.lost += if self.total.abs() >= x.abs() {
            (self.total - sum) + x
        } else {
            (x - sum) + self.total
        };
        self.total = sum;
    }

    /// The sum.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.total + self.lost
    }

    /// Both parts, for a checkpoint.
    #[must_use]
    pub fn save(&self) -> [f64; 2] {
        [self.total, self.lost]
    }

    /// The sum of which `saved` are the parts.
    #[must_use]
    pub fn restored(saved: &[f64]) -> Self {
        Self {
            total: saved.first().copied().unwrap_or(0.0),
            lost: saved.get(1).copied().unwrap_or(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_terms_survive_large_ones() {
        let mut sum = Sum::default();
        for x in [1e16, 1.0, 1.0, -1e16] {
            sum.add(x);
        }
        assert!((sum.value() - 2.0).abs() < 1e-12);
        assert_eq!(Sum::restored(&sum.save()), sum);
    }
}
