//! Spacings of the lattice along the axes with which particles fill boxes as they are.
//!
//! A side of length L holds n layers, L/n apart. The spacings of the axes differ from one another by at most a twentieth, so
//! that sums over the cubic lattice hold on this one too: of one stretched by so much they differ by up to 1 % (conduction, put right
//! where metal rests: `rest/stretched`) and 1e-4 (density). A particle holds the volume of a cell, and d is the edge of the cube of that volume.

/// Most by which the spacings of two axes differ.
const APART: f64 = 0.05;
/// Most by which a spacing differs from the one asked for.
const OFF: f64 = 0.1;
/// A spacing that fits but for this part is the one asked for: places in decimals are rounded.
const SAME: f64 = 1e-12;
/// A side is a whole number of layers but for this part.
const WHOLE: f64 = 1e-9;
/// Most numbers of layers that are looked at along a side, above and below the nearest one.
const MOST: f64 = 2000.0;
/// Layers of a side that no run holds: what is longer is refused elsewhere.
const ENDLESS: f64 = 1e7;

/// The spacings \[m\] nearest to `d` with which whole numbers of layers fill all `sides` \[m\] along each axis; none where no
/// spacings do.
#[must_use]
pub fn pitch(sides: &[Vec<f64>; 3], d: f64) -> Option<[f64; 3]> {
    let fit = [0, 1, 2].map(|axis| candidates(&sides[axis], d));
    if fit.iter().any(Vec::is_empty) {
        return None;
    }
    let targets = fit.iter().flatten().copied();
    let near = targets.map(|target| {
        let chosen = [0, 1, 2].map(|axis| nearest(&fit[axis], target));
        let [least, most] = ends(&chosen);
        (chosen, most / least - 1.0, (most / d).max(d / least))
    });
    let even = near.filter(|(_, apart, _)| *apart <= APART);
    even.min_by(|a, b| a.2.total_cmp(&b.2))
        .map(|(chosen, ..)| chosen)
}

fn ends(values: &[f64]) -> [f64; 2] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [least, most]
}

/// Spacings about `d` with which whole numbers of layers fill all sides, each a little closer than the one before; any where
/// there is no side.
fn candidates(sides: &[f64], d: f64) -> Vec<f64> {
    let Some(shortest) = sides.iter().copied().min_by(f64::total_cmp) else {
        return vec![d];
    };
    let layers = shortest / d;
    if layers > ENDLESS {
        return vec![d];
    }
    let first = (layers / (1.0 + OFF)).max(layers.round() - MOST).ceil();
    let last = (layers / (1.0 - OFF)).min(layers.round() + MOST).floor();
    let mut fit = Vec::new();
    let mut count = first.max(1.0);
    while count <= last {
        let spacing = shortest / count;
        let spacing = if (spacing / d - 1.0).abs() <= SAME {
            d
        } else {
            spacing
        };
        if sides.iter().all(|side| whole(side / spacing)) {
            fit.push(spacing);
        }
        count += 1.0;
    }
    fit
}

fn whole(layers: f64) -> bool {
    (layers / layers.round() - 1.0).abs() <= WHOLE
}

fn nearest(fit: &[f64], target: f64) -> f64 {
    // The farther ones come first.
    let closer = fit.partition_point(|spacing| *spacing > target);
    let beside = [closer.saturating_sub(1), closer.min(fit.len() - 1)].map(|i| fit[i]);
    let [a, b] = beside.map(|spacing| (spacing / target).ln().abs());
    if a < b { beside[0] } else { beside[1] }
}

#[cfg(test)]
mod tests {
    use super::*;

    const D: f64 = 8e-4;

    fn of(sides: [&[f64]; 3]) -> Option<[f64; 3]> {
        pitch(&sides.map(<[f64]>::to_vec), D)
    }

    #[test]
    fn what_fits_the_spacing_keeps_it() {
        assert_eq!(of([&[10.0 * D, 16.0 * D], &[D], &[]]), Some([D; 3]));
    }

    #[test]
    fn each_side_is_a_whole_number_of_layers() {
        let mut random = 0.37;
        for _ in 0..500 {
            random = (random * 997.0_f64 + 0.1).fract();
            let sides = [11.6e-3, (10.0 + 20.0 * random) * D, 8e-3];
            let found = of([&[sides[0]], &[sides[1]], &[sides[2]]]).unwrap();
            for (side, spacing) in sides.into_iter().zip(found) {
                let layers = side / spacing;
                assert!((layers / layers.round() - 1.0).abs() < 1e-12);
                assert!((spacing / D - 1.0).abs() < OFF);
            }
            let [least, most] = ends(&found);
            assert!(most / least - 1.0 <= APART);
        }
    }

    #[test]
    fn sides_along_one_axis_share_their_spacing() {
        let found = of([&[11.6e-3, 5.8e-3], &[8e-3], &[8e-3]]).unwrap();
        for side in [11.6e-3, 5.8e-3] {
            assert!(whole(side / found[0]), "{found:?}");
        }
        assert_eq!(of([&[2.4 * D, 3.0 * D], &[], &[]]), None);
    }

    #[test]
    fn a_thin_plate_is_filled_where_the_other_axes_can_follow() {
        // Two layers 1.06 times as far apart; the long sides follow.
        let found = of([&[100.3 * D], &[77.7 * D], &[2.12 * D]]).unwrap();
        assert!((found[2] / D - 1.06).abs() < 1e-12, "{found:?}");
        assert!((found[0] / D - 1.06).abs() < 0.02, "{found:?}");
        // A side of 10 layers that cannot.
        assert_eq!(of([&[100.3 * D], &[77.7 * D], &[2.4 * D]]), None);
    }

    #[test]
    fn any_numbers_come_to_an_end() {
        for side in [1e300, 1e-300, 1e9, 0.0, f64::MIN_POSITIVE] {
            let _ = of([&[side], &[1e-3], &[]]);
        }
    }
}
