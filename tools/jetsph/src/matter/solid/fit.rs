//! The fit of a quadratic to the neighbours of a particle, in cells of the lattice.
//!
//! Weighted least squares: the weights w_j of the neighbours in a derivative are those that keep
//!
//! ```text
//! sum_j w_j^2 / share(r_j)      smallest,      of all that give quadratics exactly
//! ```
//!
//! The nearest do where they can: inside a lattice those that share an edge, at its faces two rows, which halves the work
//! of a step. Among them the nearest lead by far, so that a held face, half a cell from the first row, is met the better.
//! Where places are disturbed, from one side above all, such shares find the curvature in what the nearest differ by, and
//! not in the rows behind them: a cell is then many times as stiff as any of the lattice. So shares fall as steeply as the
//! places allow. Where none is as soft, the softest is taken if it has all terms and bounded weights; if there is none,
//! curvatures are left out.

use nalgebra::DMatrix;

use super::quadratic::{second, terms};
use super::stiffness::stiffness;

/// Support of a link in cells of the lattice.
pub(super) const SUPPORT: f64 = 2.3;
/// How far neighbours count \[cells\]: inside a lattice, at its faces, and where it is disturbed most.
const NEAR: [f64; 3] = [1.6, 2.1, SUPPORT];
/// How steeply shares fall: powers of the distance, the first ones that the places allow.
const STEEP: [i32; 5] = [8, 6, 4, 2, 0];
/// Shares of all, where nothing else is found.
const FAR: Shares = Shares {
    near: SUPPORT,
    power: STEEP[0],
};
/// Stiffness of a cell in cells that a fit may have. The corner of a straight lattice has 9.76 in the plane and 12.39 in space.
const SOFT: f64 = 12.5;
/// The same where all terms are found so alone: a corner that is much disturbed.
const STIFFEST: f64 = 50.0;
/// Slopes that the fit gives of linear fields are exact to this.
const EXACT: f64 = 1e-6;
/// Offsets are rounded to this part of a cell.
const EVEN: f64 = (1_u64 << 40) as f64;
/// An anchor that is nearer stands on a face of the particle's own cell \[cells\].
const OWN: f64 = 0.75;

/// Neighbours and their weights in cells.
pub(super) type Fitted<const T: usize> = (Vec<u32>, Vec<[f64; T]>);

/// Weights of the neighbours, in cells, and what they are worth.
pub(super) struct Fit<const T: usize> {
    pub(super) weights: Vec<[f64; T]>,
    /// Linear fields are exact.
    pub(super) held: bool,
    /// Its slopes, before the balance at a held face, are not too stiff for its neighbours.
    pub(super) soft: bool,
}

/// Weights of the neighbours `row` of place `a`; places behind the `particles` are anchors.
pub(super) fn fit<const T: usize>(
    places: &[[f64; 3]],
    particles: usize,
    a: usize,
    row: &[u32],
) -> Fit<T> {
    let (dimensions, x) = (if T == 5 { 2 } else { 3 }, places[a]);
    // Those that stand alike in a lattice get the same bits.
    let even = |x: f64| (x * EVEN).round() / EVEN;
    let offset =
        |b: &u32| -> [f64; 3] { std::array::from_fn(|k| even(places[*b as usize][k] - x[k])) };
    let offsets: Vec<[f64; 3]> = row.iter().map(offset).collect();
    let (mut weights, soft) = chosen(&offsets, dimensions);
    for (_, anchor) in row
        .iter()
        .zip(&offsets)
        .filter(|(b, _)| **b as usize >= particles)
    {
        balance(&mut weights, *anchor, dimensions);
    }
    let error = |k: usize, l: usize| {
        let moment: f64 = offsets.iter().zip(&weights).map(|(r, w)| r[k] * w[l]).sum();
        (moment - f64::from(u8::from(k == l))).abs()
    };
    let axes = || (0..dimensions).flat_map(|k| (0..dimensions).map(move |l| (k, l)));
    let held = row.len() >= dimensions && axes().all(|(k, l)| error(k, l) < EXACT);
    Fit {
        weights,
        held,
        soft,
    }
}

/// Weights by the steepest shares that give all terms, or else as many as they give, and whether they are soft enough.
fn chosen<const T: usize>(offsets: &[[f64; 3]], dimensions: usize) -> (Vec<[f64; T]>, bool) {
    let all: Vec<usize> = (0..T).collect();
    if let Some(weights) = steepest(offsets, &all, STIFFEST) {
        return (weights, true);
    }
    let mut kept: Vec<usize> = (0..dimensions).collect();
    let Some(mut weights) = steepest(offsets, &kept, SOFT) else {
        // Too few, or all on one side of a corner: slopes are exact where they can be.
        let linear = solved(offsets, &kept, FAR);
        return (
            linear.unwrap_or_else(|| vec![[0.0; T]; offsets.len()]),
            false,
        );
    };
    for term in dimensions..T {
        kept.push(term);
        match steepest(offsets, &kept, SOFT) {
            Some(more) => weights = more,
            None => _ = kept.pop(),
        }
    }
    (weights, true)
}

/// Weights of some terms by the steepest shares with which the cell is as soft as those of a lattice, or else by those with
/// which it is softest, if it is no stiffer than `stiffest`.
fn steepest<const T: usize>(
    offsets: &[[f64; 3]],
    kept: &[usize],
    stiffest: f64,
) -> Option<Vec<[f64; T]>> {
    let mut softest: Option<(f64, Vec<[f64; T]>)> = None;
    let tried = NEAR
        .into_iter()
        .flat_map(|near| STEEP.map(|power| Shares { near, power }));
    for weights in tried.filter_map(|shares| solved(offsets, kept, shares)) {
        let stiff = stiffness(&weights, [1.0 / 12.0; 3]);
        let is_soft = stiff <= SOFT;
        if softest.as_ref().is_none_or(|(least, _)| stiff < *least) {
            softest = Some((stiff, weights));
        }
        if is_soft {
            break;
        }
    }
    let found = softest.filter(|(least, _)| *least <= stiffest);
    found.map(|(_, weights)| weights)
}

/// Shares of the neighbours in a fit: the weights of their errors squared.
#[derive(Clone, Copy)]
struct Shares {
    /// Beyond, neighbours have none \[cells\].
    near: f64,
    /// They fall with this power of the distance.
    power: i32,
}

impl Shares {
    /// Share at an offset \[cells\].
    fn of(self, offset: &[f64; 3]) -> f64 {
        let square: f64 = offset.iter().map(|x| x * x).sum();
        let distance = square.sqrt() / SUPPORT;
        let rest = 1.0 - distance * distance;
        rest * rest / distance.powi(self.power)
    }

    fn counts(self, offset: &[f64; 3]) -> bool {
        offset.iter().map(|x| x * x).sum::<f64>() < self.near * self.near
    }
}

/// Weights of some terms with given shares; none where the neighbours do not span them.
fn solved<const T: usize>(
    offsets: &[[f64; 3]],
    kept: &[usize],
    shares: Shares,
) -> Option<Vec<[f64; T]>> {
    let near: Vec<usize> = (0..offsets.len())
        .filter(|k| shares.counts(&offsets[*k]))
        .collect();
    if near.len() < kept.len() {
        return None;
    }
    let roots: Vec<f64> = near
        .iter()
        .map(|k| shares.of(&offsets[*k]).sqrt())
        .collect();
    let design = DMatrix::from_fn(near.len(), kept.len(), |k, m| {
        let p: [f64; T] = terms(offsets[near[k]]);
        roots[k] * p[kept[m]]
    });
    let (q, r) = design.qr().unpack();
    let inverse = r.solve_upper_triangular(&q.transpose())?;
    let mut weights = vec![[0.0; T]; offsets.len()];
    for (row, m) in inverse.row_iter().zip(kept) {
        for (k, of) in near.iter().enumerate() {
            weights[*of][*m] = roots[k] * row[k];
        }
    }
    Some(weights)
}

/// Takes the slopes of the cell at a held face where they are in balance with those of the others. Summed over the cells, slopes must be
/// the difference between the faces (the integration constraint, Chen et al. 2001), or an even stress bends the first rows:
///
/// ```text
/// F_1 + F_2 + ... = sum (x_b - x_a)/d    needs   F_1 = ((x_1 + x_2)/2 - x_face)/d = F(quadratic) + d/8 dF/dX
/// ```
///
/// which is an eighth of a cell inwards of its middle.
fn balance<const T: usize>(weights: &mut [[f64; T]], anchor: [f64; 3], dimensions: usize) {
    let square: f64 = anchor.iter().map(|x| x * x).sum();
    // Those of the cell's own face are half a cell away.
    if square > OWN * OWN {
        return;
    }
    for weight in weights {
        for k in 0..dimensions {
            let inwards: f64 = (0..dimensions)
                .map(|l| -0.25 * anchor[l] * weight[second(dimensions, k, l)])
                .sum();
            weight[k] += inwards;
        }
    }
}

/// Takes the slopes of a cell in the middle of what it has of the body, `to` from the particle \[cells\]: F + c . dF/dX.
pub(super) fn moved<const T: usize>(weights: &mut [[f64; T]], to: [f64; 3]) {
    let dimensions = if T == 5 { 2 } else { 3 };
    for weight in weights {
        for k in 0..dimensions {
            let along = (0..dimensions).map(|l| to[l] * weight[second(dimensions, k, l)]);
            weight[k] += along.sum::<f64>();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::links::Links;
    use super::*;
    use shapes::jitter::signed;

    fn shaken(jitter: f64, sides: [usize; 3]) -> Vec<[f64; 3]> {
        let place = |i: usize| {
            let at = [
                i % sides[0],
                (i / sides[0]) % sides[1],
                i / (sides[0] * sides[1]),
            ];
            let shake = |k: usize| {
                if sides[k] > 1 {
                    jitter * signed(0, (3 * i + k) as u64)
                } else {
                    0.0
                }
            };
            [0, 1, 2].map(|k| at[k] as f64 + shake(k))
        };
        (0..sides.iter().product()).map(place).collect()
    }

    fn stiffest<const T: usize>(jitter: f64, sides: [usize; 3]) -> f64 {
        let places = shaken(jitter, sides);
        let (links, loose) = Links::<T>::new(&places, places.len(), [1.0; 3], &[]);
        assert!(loose.is_empty());
        let each = (0..places.len()).map(|a| stiffness(links.row(a).weight, [1.0 / 12.0; 3]));
        each.fold(0.0, f64::max)
    }

    #[test]
    fn shaken_faces_and_corners_are_as_soft_as_straight_ones() {
        assert!((stiffest::<5>(0.0, [6, 6, 1]) - 9.76).abs() < 0.01);
        assert!((stiffest::<9>(0.0, [5, 5, 5]) - 12.39).abs() < 0.01);
        for (jitter, limit) in [(0.02, SOFT), (0.05, SOFT), (0.1, SOFT), (0.2, STIFFEST)] {
            let most = stiffest::<5>(jitter, [20, 20, 1]).max(stiffest::<9>(jitter, [6, 6, 6]));
            assert!(most <= limit, "{jitter}: {most}");
        }
    }
}
