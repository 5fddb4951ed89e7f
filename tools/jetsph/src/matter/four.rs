//! Four numbers side by side, as the machine holds them.
//!
//! All machines give the same bits: each of the four is computed as it would be alone, and sums run in the order of the
//! pairs, or each of the four in its own and all four in their order.

use std::ops::{Add, Div, Mul, Sub};

use kernels::Number;

/// How a machine holds four numbers.
pub(super) trait Lanes: Copy {
    /// Four numbers.
    type Four: Number;
    /// Takes them up.
    fn take(self, numbers: [f64; 4]) -> Self::Four;
    /// Gives them back.
    fn give(self, four: Self::Four) -> [f64; 4];
    /// Rows for columns.
    fn turn(self, rows: [Self::Four; 4]) -> [Self::Four; 4];
}

/// For any machine.
#[derive(Debug, Clone, Copy)]
pub(super) struct OneByOne;

/// Four numbers of any machine.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plain([f64; 4]);

impl Plain {
    #[inline(always)]
    fn with(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        Self([0, 1, 2, 3].map(|k| operation(self.0[k], other.0[k])))
    }
}

impl Lanes for OneByOne {
    type Four = Plain;

    #[inline(always)]
    fn take(self, numbers: [f64; 4]) -> Plain {
        Plain(numbers)
    }

    #[inline(always)]
    fn give(self, four: Plain) -> [f64; 4] {
        four.0
    }

    #[inline(always)]
    fn turn(self, rows: [Plain; 4]) -> [Plain; 4] {
        [0, 1, 2, 3].map(|k| Plain(rows.map(|row| row.0[k])))
    }
}

impl Add for Plain {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl Sub for Plain {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl Mul for Plain {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

impl Div for Plain {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.with(other, |a, b| a / b)
    }
}

impl Number for Plain {
    #[inline(always)]
    fn of(self, value: f64) -> Self {
        Self([value; 4])
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn greatest(self, other: Self) -> Self {
        self.with(other, Number::greatest)
    }

    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.with(other, Number::least)
    }

    #[inline(always)]
    fn below(self, bound: Self, then: Self, otherwise: Self) -> Self {
        let one = |k: usize| self.0[k].below(bound.0[k], then.0[k], otherwise.0[k]);
        Self([0, 1, 2, 3].map(one))
    }
}

/// Four numbers in one vector.
#[cfg(target_arch = "x86_64")]
pub(super) mod vector {
    use std::ops::{Add, Div, Mul, Sub};

    use kernels::Number;
    use pulp::{cast, f64x4, x86::V3};

    use super::Lanes;

    /// Four numbers and the leave to compute with them.
    #[derive(Debug, Clone, Copy)]
    pub(in super::super) struct Vector(V3, f64x4);

    impl Lanes for V3 {
        type Four = Vector;

        #[inline(always)]
        fn take(self, numbers: [f64; 4]) -> Vector {
            Vector(self, cast(numbers))
        }

        #[inline(always)]
        fn give(self, four: Vector) -> [f64; 4] {
            cast(four.1)
        }

        #[inline(always)]
        fn turn(self, rows: [Vector; 4]) -> [Vector; 4] {
            // One by one: what is given to a function of arrays would not be compiled for the vectors.
            let (avx, [a, b, c, d]) = (self.avx, rows);
            let (a, b, c, d) = (cast(a.1), cast(b.1), cast(c.1), cast(d.1));
            let low = [avx._mm256_unpacklo_pd(a, b), avx._mm256_unpacklo_pd(c, d)];
            let high = [avx._mm256_unpackhi_pd(a, b), avx._mm256_unpackhi_pd(c, d)];
            [
                Vector(
                    self,
                    cast(avx._mm256_permute2f128_pd::<0x20>(low[0], low[1])),
                ),
                Vector(
                    self,
                    cast(avx._mm256_permute2f128_pd::<0x20>(high[0], high[1])),
                ),
                Vector(
                    self,
                    cast(avx._mm256_permute2f128_pd::<0x31>(low[0], low[1])),
                ),
                Vector(
                    self,
                    cast(avx._mm256_permute2f128_pd::<0x31>(high[0], high[1])),
                ),
            ]
        }
    }

    impl Add for Vector {
        type Output = Self;

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(self.0, self.0.add_f64x4(self.1, other.1))
        }
    }

    impl Sub for Vector {
        type Output = Self;

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(self.0, self.0.sub_f64x4(self.1, other.1))
        }
    }

    impl Mul for Vector {
        type Output = Self;

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(self.0, self.0.mul_f64x4(self.1, other.1))
        }
    }

    impl Div for Vector {
        type Output = Self;

        #[inline(always)]
        fn div(self, other: Self) -> Self {
            Self(self.0, self.0.div_f64x4(self.1, other.1))
        }
    }

    impl Number for Vector {
        #[inline(always)]
        fn of(self, value: f64) -> Self {
            Self(self.0, self.0.splat_f64x4(value))
        }

        #[inline(always)]
        fn root(self) -> Self {
            Self(self.0, self.0.sqrt_f64x4(self.1))
        }

        #[inline(always)]
        fn greatest(self, other: Self) -> Self {
            Self(self.0, self.0.max_f64x4(self.1, other.1))
        }

        #[inline(always)]
        fn least(self, other: Self) -> Self {
            Self(self.0, self.0.min_f64x4(self.1, other.1))
        }

        #[inline(always)]
        fn below(self, bound: Self, then: Self, otherwise: Self) -> Self {
            let below = self.0.cmp_lt_f64x4(self.1, bound.1);
            Self(self.0, self.0.select_f64x4(below, then.1, otherwise.1))
        }
    }
}

/// Work by fours.
pub(super) trait Work {
    /// Does it.
    fn run(self, lanes: impl Lanes);
}

/// Does the work as this machine can.
pub(super) fn on_this_machine(work: impl Work) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return pulp::Simd::vectorize(simd, With { work, lanes: simd });
    }
    let lanes = OneByOne;
    pulp::Arch::new().dispatch(With { work, lanes });
}

/// Work with the lanes chosen for it.
struct With<W, L> {
    work: W,
    lanes: L,
}

impl<W: Work, L: Lanes> pulp::NullaryFnOnce for With<W, L> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.work.run(self.lanes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All that four numbers can do, with some.
    fn all(lanes: impl Lanes, a: [f64; 4], b: [f64; 4]) -> Vec<[u64; 4]> {
        let (x, y) = (lanes.take(a), lanes.take(b));
        let turned = lanes.turn([x, y, x * y, x.of(3.0)]);
        let simple = [
            x + y,
            x - y,
            x * y,
            x / y,
            x.greatest(y),
            x.least(y),
            y.root(),
            x.below(y, x * x, y * y),
        ];
        let every = simple.into_iter().chain(turned);
        every
            .map(|four| lanes.give(four).map(f64::to_bits))
            .collect()
    }

    #[test]
    fn four_are_computed_as_each_would_be_alone() {
        let (a, b) = ([1.5, -2.0, 0.3, f64::NAN], [0.7, 3.0, 0.3, 2.0]);
        let found = all(OneByOne, a, b);
        for k in 0..4 {
            let alone = [a[k] + b[k], a[k] - b[k], a[k] * b[k], a[k] / b[k]];
            for (four, alone) in found.iter().zip(alone) {
                assert!(f64::from_bits(four[k]).total_cmp(&alone).is_eq() || alone.is_nan());
            }
            assert_eq!(f64::from_bits(found[8 + k][0]).to_bits(), a[k].to_bits());
            assert_eq!(found[8 + k][1], b[k].to_bits());
        }
        assert_eq!(
            found[4][3],
            2.0_f64.to_bits(),
            "what is no number gives way"
        );
        assert_eq!(found[7][2], (b[2] * b[2]).to_bits(), "equal is not below");
    }

    // Machines without the vectors have nothing to compare.
    #[cfg(target_arch = "x86_64")]
    #[test]
    fn vectors_give_the_same_bits() {
        if let Some(simd) = pulp::x86::V3::try_new() {
            let (a, b) = ([1.5, -2.0, 0.3, 7.1], [0.7, 3.0, 0.3, 2.0]);
            assert_eq!(all(simd, a, b), all(OneByOne, a, b));
        }
    }
}
