//! A number, or several side by side.
//!
//! A formula that is written for any [`Number`] is computed for one pair of particles or for several at once, and each has
//! the same bits: operations are neither fused nor reordered.

use std::ops::{Add, Div, Mul, Sub};

/// A number, or several side by side.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// `value` in each place.
    #[must_use]
    fn of(self, value: f64) -> Self;
    /// The square root.
    #[must_use]
    fn root(self) -> Self;
    /// The greater one; `other` where one of both is no number.
    #[must_use]
    fn greatest(self, other: Self) -> Self;
    /// The smaller one; `other` where one of both is no number.
    #[must_use]
    fn least(self, other: Self) -> Self;
    /// `then` where it is below `bound`, else `otherwise`.
    #[must_use]
    fn below(self, bound: Self, then: Self, otherwise: Self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn of(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn greatest(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn least(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn below(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self < bound { then } else { otherwise }
    }
}
