//! The near ones among candidates: one test per candidate, and what is near put side by side.

use std::array::from_fn;

/// Candidates that are tested at once.
pub(crate) const LANES: usize = 8;

/// Places of candidates, each axis a column.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lanes<'a> {
    pub(crate) x: &'a [f64; LANES],
    pub(crate) y: &'a [f64; LANES],
    pub(crate) z: &'a [f64; LANES],
}

/// Candidates side by side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Candidates<'a> {
    pub(crate) lanes: Lanes<'a>,
    /// Their indices.
    pub(crate) index: &'a [u32; LANES],
}

/// Farther than any point.
pub(crate) const AWAY: f64 = f64::INFINITY;

/// Whose neighbours are looked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Centre {
    pub(crate) point: [f64; 3],
    pub(crate) radius: f64,
    /// Index of the point itself, which is no neighbour.
    pub(crate) own: u32,
}

/// How a machine finds the near ones; all ways give the same numbers in the same order.
pub(crate) trait Sieve: Copy {
    /// Writes index and squared distance of each candidate closer than the radius, other than the
    /// centre itself, to the beginning of `slots` and `squares`; returns their number. What lies
    /// beyond it is left undefined.
    fn sift(
        self,
        centre: Centre,
        candidates: Candidates<'_>,
        slots: &mut [u32; LANES],
        squares: &mut [f64; LANES],
    ) -> usize;
}

/// For any machine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OneByOne;

impl Sieve for OneByOne {
    #[inline(always)]
    fn sift(
        self,
        Centre { point, radius, own }: Centre,
        Candidates { lanes, index }: Candidates<'_>,
        slots: &mut [u32; LANES],
        squares: &mut [f64; LANES],
    ) -> usize {
        let all: [f64; LANES] = from_fn(|k| {
            let dx = [
                point[0] - lanes.x[k],
                point[1] - lanes.y[k],
                point[2] - lanes.z[k],
            ];
            dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]
        });
        let mut hits = 0;
        // Written without a branch: every index is stored and the end moves on only for a near one.
        for k in 0..LANES {
            (slots[hits % LANES], squares[hits % LANES]) = (index[k], all[k]);
            hits += usize::from((all[k] < radius * radius) & (index[k] != own));
        }
        hits
    }
}

/// For machines that can put the chosen lanes of a vector side by side at once.
#[cfg(target_arch = "x86_64")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Packed(pub(crate) pulp::x86::V4);

#[cfg(target_arch = "x86_64")]
impl Sieve for Packed {
    #[inline(always)]
    fn sift(
        self,
        Centre { point, radius, own }: Centre,
        Candidates { lanes, index }: Candidates<'_>,
        slots: &mut [u32; LANES],
        squares: &mut [f64; LANES],
    ) -> usize {
        let simd = self.0;
        let away = |x: f64, from: &[f64; LANES]| -> pulp::f64x8 {
            simd.sub_f64x8(simd.splat_f64x8(x), pulp::cast(*from))
        };
        let [dx, dy, dz] = [
            away(point[0], lanes.x),
            away(point[1], lanes.y),
            away(point[2], lanes.z),
        ];
        // Products and sums rounded one by one, as elsewhere.
        let plane = simd.add_f64x8(simd.mul_f64x8(dx, dx), simd.mul_f64x8(dy, dy));
        let square = simd.add_f64x8(plane, simd.mul_f64x8(dz, dz));
        let index: pulp::u32x8 = pulp::cast(*index);
        let near = simd
            .cmp_lt_f64x8(square, simd.splat_f64x8(radius * radius))
            .0;
        let other = !simd.cmp_eq_u32x8(index, simd.splat_u32x8(own)).0;
        let chosen = near & other;
        *squares = pulp::cast(
            simd.avx512f
                ._mm512_maskz_compress_pd(chosen, pulp::cast(square)),
        );
        *slots = pulp::cast(
            simd.avx512f
                ._mm256_maskz_compress_epi32(chosen, pulp::cast(index)),
        );
        chosen.count_ones() as usize
    }
}

/// For machines that can put the numbers of a vector in any order: four candidates at once.
#[cfg(target_arch = "x86_64")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ordered(pub(crate) pulp::x86::V3);

/// Candidates that [`Ordered`] puts in order at once.
#[cfg(target_arch = "x86_64")]
const HALF: usize = LANES / 2;

/// For each choice among [`HALF`] numbers, as bits, the parts of a vector in which the chosen ones come first; a number
/// has `parts` of them.
#[cfg(target_arch = "x86_64")]
const fn chosen_first<const N: usize>(parts: usize) -> [[u8; N]; 1 << HALF] {
    let mut table = [[0; N]; 1 << HALF];
    let mut choice = 0;
    while choice < table.len() {
        let (mut k, mut used) = (0, 0);
        while k < HALF {
            let mut part = 0;
            while part < parts && choice >> k & 1 == 1 {
                table[choice][used] = (parts * k + part) as u8;
                (part, used) = (part + 1, used + 1);
            }
            k += 1;
        }
        choice += 1;
    }
    table
}

/// Bytes of indices.
#[cfg(target_arch = "x86_64")]
const INDICES: [[u8; 16]; 1 << HALF] = chosen_first(size_of::<u32>());

/// Halves of squares.
#[cfg(target_arch = "x86_64")]
const SQUARES: [[u32; 8]; 1 << HALF] = {
    let (narrow, mut wide) = (chosen_first::<8>(2), [[0; 8]; 1 << HALF]);
    let mut at = 0;
    while at < 8 << HALF {
        wide[at / 8][at % 8] = narrow[at / 8][at % 8] as u32;
        at += 1;
    }
    wide
};

#[cfg(target_arch = "x86_64")]
impl Ordered {
    /// Squared distances of a half of the candidates from the `point`, and which are closer than the radius, as bits.
    #[inline(always)]
    fn near(self, at: &Centre, lanes: [&[f64; HALF]; 3]) -> (pulp::f64x4, usize) {
        let simd = self.0;
        let away = |axis: usize| -> pulp::f64x4 {
            simd.sub_f64x4(simd.splat_f64x4(at.point[axis]), pulp::cast(*lanes[axis]))
        };
        let [dx, dy, dz] = [away(0), away(1), away(2)];
        // Products and sums rounded one by one, as elsewhere.
        let plane = simd.add_f64x4(simd.mul_f64x4(dx, dx), simd.mul_f64x4(dy, dy));
        let square = simd.add_f64x4(plane, simd.mul_f64x4(dz, dz));
        let near = simd.cmp_lt_f64x4(square, simd.splat_f64x4(at.radius * at.radius));
        let bits = simd.avx._mm256_movemask_pd(pulp::cast(near));
        (square, bits as usize)
    }
}

#[cfg(target_arch = "x86_64")]
impl Sieve for Ordered {
    #[inline(always)]
    fn sift(
        self,
        centre: Centre,
        Candidates { lanes, index }: Candidates<'_>,
        slots: &mut [u32; LANES],
        squares: &mut [f64; LANES],
    ) -> usize {
        let simd = self.0;
        let halves = |column: &'_ [f64; LANES]| -> [[f64; HALF]; 2] { pulp::cast(*column) };
        let [x, y, z] = [halves(lanes.x), halves(lanes.y), halves(lanes.z)];
        let index: [pulp::u32x4; 2] = pulp::cast(*index);
        let mut hits = 0;
        for half in 0..2 {
            let (square, near) = self.near(&centre, [&x[half], &y[half], &z[half]]);
            let own = simd.cmp_eq_u32x4(index[half], simd.splat_u32x4(centre.own));
            let own = simd.sse._mm_movemask_ps(pulp::cast(own)) as usize;
            let chosen = near & !own;
            let slots: &mut [u32] = &mut slots[hits..hits + HALF];
            slots.copy_from_slice(&pulp::cast::<_, [u32; HALF]>(
                simd.ssse3
                    ._mm_shuffle_epi8(pulp::cast(index[half]), pulp::cast(INDICES[chosen])),
            ));
            let squares: &mut [f64] = &mut squares[hits..hits + HALF];
            squares.copy_from_slice(&pulp::cast::<_, [f64; HALF]>(
                simd.avx2
                    ._mm256_permutevar8x32_epi32(pulp::cast(square), pulp::cast(SQUARES[chosen])),
            ));
            hits += chosen.count_ones() as usize;
        }
        hits
    }
}

/// Work in which a machine sifts.
pub(crate) trait Sifting {
    /// Does it by `sieve`.
    fn run(self, sieve: impl Sieve);
}

/// Does the work in the widest vectors that this machine has.
pub(crate) fn on_this_machine(work: impl Sifting) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V4::try_new() {
        let sieve = Packed(simd);
        return simd.vectorize(With { work, sieve });
    }
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        let sieve = Ordered(simd);
        return simd.vectorize(With { work, sieve });
    }
    let sieve = OneByOne;
    pulp::Arch::new().dispatch(With { work, sieve });
}

/// Work with the sieve chosen for it.
struct With<W, S> {
    work: W,
    sieve: S,
}

impl<W: Sifting, S: Sieve> pulp::NullaryFnOnce for With<W, S> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.work.run(self.sieve);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Neighbours of the third of some points, of which `count` are candidates.
    fn sift(sieve: impl Sieve, radius: f64, count: usize) -> Vec<(u32, f64)> {
        let wave = |step: f64| from_fn(|k| (step * (k + 1) as f64).sin());
        let [mut x, y, z]: [[f64; LANES]; 3] = [0.9, 1.7, 2.3].map(wave);
        let index: [u32; LANES] = from_fn(|k| 100 - 3 * k as u32);
        let (point, own) = ([x[2], y[2], z[2]], index[2]);
        x[count..].fill(AWAY);
        let (mut slots, mut squares) = ([0; LANES], [0.0; LANES]);
        let candidates = Candidates {
            lanes: Lanes {
                x: &x,
                y: &y,
                z: &z,
            },
            index: &index,
        };
        let centre = Centre { point, radius, own };
        let hits = sieve.sift(centre, candidates, &mut slots, &mut squares);
        slots.into_iter().zip(squares).take(hits).collect()
    }

    #[test]
    fn neither_what_is_far_nor_the_centre_is_kept() {
        assert_eq!(sift(OneByOne, 1e-9, LANES), []);
        assert_eq!(sift(OneByOne, 10.0, LANES).len(), LANES - 1);
        assert_eq!(sift(OneByOne, 10.0, 5).len(), 4);
        assert_eq!(
            sift(OneByOne, 10.0, 1).len(),
            1,
            "the centre is none of them"
        );
        let found = sift(OneByOne, 1.5, LANES);
        assert!((2..LANES - 1).contains(&found.len()), "{}", found.len());
        assert!(
            found
                .iter()
                .all(|(b, square)| *b != 94 && *square < 1.5 * 1.5)
        );
        assert!(
            found.is_sorted_by(|(a, _), (b, _)| a > b),
            "the order of the candidates"
        );
    }

    /// Both find the same, in the same order.
    #[cfg(target_arch = "x86_64")]
    fn alike(sieve: impl Sieve) {
        for radius in [1e-9, 0.3, 0.7, 1.0, 1.5, 10.0] {
            for count in 0..=LANES {
                let found = sift(sieve, radius, count);
                assert_eq!(found, sift(OneByOne, radius, count), "{radius}, {count}");
            }
        }
    }

    // Machines without the vectors have nothing to compare.
    #[cfg(target_arch = "x86_64")]
    #[test]
    fn vectors_give_the_same_bits() {
        if let Some(simd) = pulp::x86::V4::try_new() {
            alike(Packed(simd));
        }
        if let Some(simd) = pulp::x86::V3::try_new() {
            alike(Ordered(simd));
        }
    }
}
