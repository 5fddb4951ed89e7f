//! Sums over the rows of neighbours, four numbers at once.
//!
//! A sum of differences is taken apart: with the sums D of the weights times a field, the sum of
//! `w_ab (y_a + y_b) (x_a - x_b)` is `y_a` times that of `w_ab (x_a - x_b)`, plus `D(y) x_a - D(y x)`.

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

/// As [`summed`], in double precision; the weights may come in single.
#[inline]
pub(crate) fn summed_double<W: Copy + Into<f64>>(
    row: &[u32],
    weight: &[W],
    field: &[[f64; 4]],
) -> [f64; 4] {
    let (mut even, mut odd) = ([0.0; 4], [0.0; 4]);
    let ((twos, one), (weights, last)) = (row.as_chunks::<2>(), weight.as_chunks::<2>());
    for ([b, c], [v, w]) in twos.iter().zip(weights) {
        let (x, y) = (field[*b as usize], field[*c as usize]);
        let (v, w): (f64, f64) = ((*v).into(), (*w).into());
        for i in 0..4 {
            even[i] += v * x[i];
            odd[i] += w * y[i];
        }
    }
    for (b, w) in one.iter().zip(last) {
        let (x, w): (_, f64) = (field[*b as usize], (*w).into());
        for i in 0..4 {
            even[i] += w * x[i];
        }
    }
    std::array::from_fn(|i| even[i] + odd[i])
}

/// Sum of `weight` times `field` over the neighbours of a `row`, of every other one on its own, so
/// that additions need not wait for each other.
#[inline]
pub(crate) fn summed(row: &[u32], weight: &[f32], field: &[[f32; 4]]) -> [f32; 4] {
    let (mut even, mut odd) = ([0.0_f32; 4], [0.0_f32; 4]);
    let ((twos, one), (weights, last)) = (row.as_chunks::<2>(), weight.as_chunks::<2>());
    for ([b, c], [v, w]) in twos.iter().zip(weights) {
        let (x, y) = (field[*b as usize], field[*c as usize]);
        for i in 0..4 {
            even[i] += v * x[i];
            odd[i] += w * y[i];
        }
    }
    for (b, w) in one.iter().zip(last) {
        let x = field[*b as usize];
        for i in 0..4 {
            even[i] += w * x[i];
        }
    }
    std::array::from_fn(|i| even[i] + odd[i])
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
