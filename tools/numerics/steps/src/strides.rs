//! Steps that hold 1, 2, 4, 8 ... steps of one length, so that all that is due at multiples of that keeps its time, and
//! times are no sums.

/// How many steps of one length a step holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strides {
    /// That length \[s\].
    base: f64,
    /// Most of them that one step holds, a power of two.
    pub greatest: u64,
    /// Number of them that the present step holds.
    pub stride: u64,
    /// Steps taken.
    pub taken: u64,
}

impl Strides {
    /// Steps of one length \[s\].
    #[must_use]
    pub fn even(base: f64) -> Self {
        Self {
            base,
            greatest: 1,
            stride: 1,
            taken: 0,
        }
    }

    /// Whether steps differ.
    #[must_use]
    pub fn grows(&self) -> bool {
        self.greatest > 1
    }

    /// Length of the present step \[s\].
    #[must_use]
    pub fn step(&self) -> f64 {
        self.stride as f64 * self.base
    }

    /// Chooses the step from number `step` on: not beyond number `until` nor, by more than one of that length, the instant `mark` \[s\],
    /// no longer than `longest` \[s\], and at most twice the last one.
    pub fn choose(&mut self, step: u64, until: u64, mark: f64, longest: f64) {
        // The end of the first step that does not lie before the mark.
        let marked = (mark / self.base * (1.0 - 1e-12)).ceil();
        let marked = if marked.is_finite() {
            marked as u64
        } else {
            u64::MAX
        };
        let left = until.min(marked.max(step + 1)) - step;
        let allowed = (longest / self.base) as u64;
        let most = self.greatest.min(2 * self.stride).min(left).min(allowed);
        self.stride = 1 << most.max(1).ilog2();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_grow_and_meet_their_marks() {
        let mut strides = Strides {
            greatest: 8,
            ..Strides::even(1e-4)
        };
        let (mut step, mut taken) = (0, Vec::new());
        while step < 60 {
            let mark = if step < 21 { 2.05e-3 } else { f64::INFINITY };
            let longest = if step < 40 { 1.0 } else { 3.9e-4 };
            strides.choose(step, 60, mark, longest);
            step += strides.stride;
            taken.push(strides.stride);
        }
        assert_eq!(
            taken,
            [2, 4, 8, 4, 2, 1, 2, 4, 8, 8, 2, 2, 2, 2, 2, 2, 2, 2, 1]
        );
        assert_eq!(step, 60);
    }

    #[test]
    fn steps_that_are_all_alike_stay_so() {
        let mut strides = Strides::even(1e-4);
        strides.choose(3, 100, f64::INFINITY, 1.0);
        assert_eq!((strides.stride, strides.grows()), (1, false));
    }
}
