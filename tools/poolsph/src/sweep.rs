//! Sums over the rows of neighbours, four numbers at once.
//!
//! A sum of differences is taken apart: with the sums D of the weights times a field, the sum of
//! `w_ab (y_a + y_b) (x_a - x_b)` is `y_a` times that of `w_ab (x_a - x_b)`, plus `D(y) x_a - D(y x)`.

use std::ops::Add;

/// Particles per unit of parallel work, where each takes little.
pub(crate) const GRAIN: usize = 2048;

/// y x and y.
#[inline]
pub(crate) fn carried(x: [f32; 3], y: f32) -> [f32; 4] {
    [y * x[0], y * x[1], y * x[2], y]
}

/// Middle of the box around `places`: numbers counted from there lose least by rounding.
pub(crate) fn middle(places: &[[f64; 3]]) -> [f64; 3] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for place in places {
        for k in 0..3 {
            low[k] = low[k].min(place[k]);
            high[k] = high[k].max(place[k]);
        }
    }
    std::array::from_fn(|k| 0.5 * (low[k] + high[k]))
}

/// Sum of `weight` times `field` over the neighbours of a `row`, of every fourth one on its own, so
/// that additions need not wait for each other.
#[inline(always)]
pub(crate) fn summed(row: &[u32], weight: &[f32], field: &[[f32; 4]]) -> [f32; 4] {
    #[cfg(target_arch = "x86_64")]
    if let Some(sse) = pulp::core_arch::x86::Sse::try_new() {
        // Told to, the compiler keeps the four numbers in one vector; left to itself it takes halves.
        let mut parts = [sse._mm_setzero_ps(); 4];
        each_part(row, weight, field, |part, w, x| {
            let more = sse._mm_mul_ps(sse._mm_set1_ps(w), pulp::cast(x));
            parts[part] = sse._mm_add_ps(parts[part], more);
        });
        return added(parts.map(pulp::cast));
    }
    let mut parts = [[0.0_f32; 4]; 4];
    each_part(row, weight, field, |part, w, x| {
        for i in 0..4 {
            parts[part][i] += w * x[i];
        }
    });
    added(parts)
}

/// Sum of four parts.
#[inline(always)]
fn added<T: Copy + Add<Output = T>, const N: usize>([p, q, r, s]: [[T; N]; 4]) -> [T; N] {
    std::array::from_fn(|i| (p[i] + q[i]) + (r[i] + s[i]))
}

/// As [`summed`], in double precision; the weights may come in single.
#[inline(always)]
pub(crate) fn summed_double<W: Copy + Into<f64>, const N: usize>(
    row: &[u32],
    weight: &[W],
    field: &[[f64; N]],
) -> [f64; N] {
    let mut parts = [[0.0; N]; 4];
    each_part(row, weight, field, |part, w, x| {
        for i in 0..N {
            parts[part][i] += w.into() * x[i];
        }
    });
    added(parts)
}

/// Calls `add` with the part to which each neighbour of a `row` belongs, its weight and its field.
#[inline(always)]
fn each_part<W: Copy, F: Copy>(
    row: &[u32],
    weight: &[W],
    field: &[F],
    mut add: impl FnMut(usize, W, F),
) {
    let ((fours, rest), (weights, last)) = (row.as_chunks::<4>(), weight.as_chunks::<4>());
    for (b, w) in fours.iter().zip(weights) {
        add(0, w[0], field[b[0] as usize]);
        add(1, w[1], field[b[1] as usize]);
        add(2, w[2], field[b[2] as usize]);
        add(3, w[3], field[b[3] as usize]);
    }
    for (b, w) in rest.iter().zip(last) {
        add(0, *w, field[*b as usize]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_taken_apart_are_those_of_the_differences() {
        let at = |k: usize| [0.3 * k as f32, 1.0 - 0.2 * k as f32, 0.1 * (k * k) as f32];
        let pressure = |k: usize| 2.0 + 0.5 * k as f32;
        let field: Vec<_> = (0..6).map(|k| carried(at(k), pressure(k))).collect();
        for row in [&[1, 2, 3, 4, 5][..], &[4, 2], &[3], &[]] {
            let weight: Vec<f32> = row.iter().map(|b| -1.0 - 0.3 * *b as f32).collect();
            let sum = summed(row, &weight, &field);
            for i in 0..3 {
                let (mut direct, mut gradient) = (0.0, 0.0);
                for (b, w) in row.iter().zip(&weight) {
                    let dx = at(0)[i] - at(*b as usize)[i];
                    direct += w * (pressure(0) + pressure(*b as usize)) * dx;
                    gradient += w * dx;
                }
                let apart = pressure(0) * gradient + sum[3] * at(0)[i] - sum[i];
                assert!((apart - direct).abs() < 1e-5, "{apart} {direct}");
            }
        }
    }

    #[test]
    fn both_precisions_sum_alike() {
        let field: Vec<[f32; 4]> = (0..7)
            .map(|k| [k, k * k, 3 - k, 1].map(|x| x as f32))
            .collect();
        let double: Vec<_> = field.iter().map(|x| x.map(f64::from)).collect();
        for row in [&[1, 2, 3, 4, 5][..], &[6, 2], &[3], &[]] {
            let weight: Vec<f32> = row.iter().map(|b| 0.5 * *b as f32 - 1.0).collect();
            let sum = summed(row, &weight, &field).map(f64::from);
            let other = summed_double(row, &weight, &double);
            for (sum, other) in sum.iter().zip(other) {
                assert!((sum - other).abs() < 1e-5, "{sum} {other}");
            }
        }
    }

    #[test]
    fn the_middle_is_that_of_the_box() {
        let found = middle(&[[0.0, 5.0, -1.0], [1.0, 3.0, 1.0], [0.9, 4.5, 2.0]]);
        for (found, expected) in found.iter().zip([0.5, 4.0, 0.5]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}
