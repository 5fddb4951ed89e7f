//! Harmonics in prolate spheroidal coordinates.

use nalgebra::{DMatrix, DVector};

use super::outline::gauss;

/// Gauss's nodes over both halves, for so many harmonics.
pub(super) fn nodes(harmonics: usize) -> Vec<(f64, f64)> {
    gauss(4 * harmonics + 8)
}

/// Even harmonics through places (eta, xi) along the curve, by least squares.
pub(super) fn fitted(harmonics: usize, place: &dyn Fn(f64) -> [f64; 2]) -> Vec<f64> {
    let places: Vec<[f64; 2]> = nodes(harmonics).iter().map(|n| place(n.0)).collect();
    let matrix = DMatrix::from_fn(places.len(), harmonics + 1, |i, k| {
        legendre(2 * k, places[i][0])[0]
    });
    let right = DVector::from_iterator(places.len(), places.iter().map(|p| p[1]));
    let found = matrix.svd(true, true).solve(&right, 1e-14);
    found.map_or_else(|_| Vec::new(), |f| f.as_slice().to_vec())
}

/// P_l and its first two derivatives, at any argument but 1 and -1 for the second.
pub(super) fn legendre(l: usize, x: f64) -> [f64; 3] {
    let (mut before, mut now) = ([0.0; 3], [1.0, 0.0, 0.0]);
    for n in 1..=l {
        let m = n as f64;
        let (a, b) = ((2.0 * m - 1.0) / m, (m - 1.0) / m);
        let next = [
            a * x * now[0] - b * before[0],
            a * (now[0] + x * now[1]) - b * before[1],
            a * (2.0 * now[1] + x * now[2]) - b * before[2],
        ];
        (before, now) = (now, next);
    }
    now
}

/// Q_l and its derivative for l up to `most`, at x > 1, by the recurrence from far above.
fn second_kind(most: usize, x: f64) -> Vec<[f64; 2]> {
    let zero = 0.5 * ((x + 1.0) / (x - 1.0)).ln();
    let far = most + 400;
    // Q_(l+1)/Q_l.
    let mut ratios = vec![0.0; far + 1];
    for l in (0..far).rev() {
        let l1 = (l + 1) as f64;
        ratios[l] = l1 / ((2.0 * l1 + 1.0) * x - (l1 + 1.0) * ratios[l + 1]);
    }
    let mut values = vec![zero];
    for l in 0..=most {
        values.push(values[l] * ratios[l]);
    }
    let slope = |l: usize| (l as f64 + 1.0) * (values[l + 1] - x * values[l]) / (x * x - 1.0);
    (0..=most).map(|l| [values[l], slope(l)]).collect()
}

/// Of each odd harmonic, inside and outside: value, derivatives over xi and eta; 1 at the waist and the pole.
pub(super) fn terms_at(terms: usize, xi: f64, waist: f64, eta: f64) -> Vec<[[f64; 3]; 2]> {
    let (here, there) = (second_kind(2 * terms, xi), second_kind(2 * terms, waist));
    let each = (0..terms).map(|k| {
        let l = 2 * k + 1;
        let [p, along, _] = legendre(l, eta);
        let [inner, inner_slope, _] = legendre(l, xi);
        let inner_unit = legendre(l, waist)[0];
        let [outer, outer_slope] = here[l].map(|q| q / there[l][0]);
        [
            [inner, inner_slope, inner].map(|v| v / inner_unit),
            [outer, outer_slope, outer],
        ]
        .map(|[value, slope, same]| [value * p, slope * p, same * along])
    });
    each.collect()
}
