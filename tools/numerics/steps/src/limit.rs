//! Bounds on a step, and what becomes of a step beyond them.

/// A bound on the step and who sets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// Largest stable step \[s\].
    pub seconds: f64,
    /// For example `viscosity`, `courant`, `acoustic`.
    pub name: &'static str,
    /// What becomes of a step beyond it.
    pub beyond: Beyond,
}

/// What becomes of a step beyond a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// It is divided.
    Divides,
    /// Nothing divides it: the scene is refused.
    Refuses,
}

impl Limit {
    /// A limit beyond which the step is divided.
    #[must_use]
    pub fn dividing(name: &'static str, seconds: f64) -> Self {
        Self {
            seconds,
            name,
            beyond: Beyond::Divides,
        }
    }

    /// A limit beyond which nothing divides the step.
    #[must_use]
    pub fn refusing(name: &'static str, seconds: f64) -> Self {
        Self {
            seconds,
            name,
            beyond: Beyond::Refuses,
        }
    }

    /// The smallest of them, if there is any; the first of those that are equal.
    #[must_use]
    pub fn least(limits: impl IntoIterator<Item = Self>) -> Option<Self> {
        let limits = limits.into_iter();
        limits.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }

    /// Whether a step of `dt` \[s\] is beyond it. A step at the very limit is within it, whatever its last bit.
    #[must_use]
    pub fn is_passed(&self, dt: f64) -> bool {
        dt > self.seconds * (1.0 + 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_limit_is_the_first_of_the_smallest() {
        let limits = [
            Limit::dividing("a", 2.0),
            Limit::refusing("b", 1.0),
            Limit::dividing("c", 1.0),
        ];
        let least = Limit::least(limits);
        assert_eq!(least, Some(limits[1]));
        assert_eq!(Limit::least([]), None);
    }

    #[test]
    fn a_step_at_the_limit_is_within_it() {
        let limit = Limit::refusing("capillary", 0.3);
        assert!(!limit.is_passed(0.1 + 0.2) && limit.is_passed(0.301));
    }
}
