//! Areas of points on a surface whose points stand closer here than there, as weights of a sum.
//!
//! The part of a surface nearest to a point reaches farther where points are sparser, so that the sum of area times value
//! errs to first order: by a hundredth for the force on two electrodes a hundredth of a radius apart, at any spacing. On
//! its part a value is its polynomial fit to the points around, `f = f_i + d . g + d . H . d / 2`, so that
//! `int f dA = sum_i (A_i f_i + M_i . g_i + M2_i : H_i / 2) = sum_j W_j f_j`
//! with the moments M of the parts, as for volumes. What a part takes from or gives to a point is limited, so that no
//! weight leaves its area far.

use nalgebra::{SMatrix, SVector};
use shapes::frame::{Vector, cross, difference, dot};

use super::seed::{Seed, aside};
use crate::cloud::Cell;
use crate::cloud::occupied::Occupied;

/// Points of a fit, and how few will do.
const POINTS: usize = 14;
const FEWEST: usize = 8;
/// Greatest part of its area that a point takes or gives for one part of the surface.
const PART: f64 = 0.3;
/// Coefficients: slopes and curvatures along the surface.
const TERMS: usize = 5;
/// Least pivot of the factors of a fit over the largest one.
const PIVOT: f64 = 1e-5;

type Terms = SVector<f64, TERMS>;
type Square = SMatrix<f64, TERMS, TERMS>;

/// Weights instead of areas, from the parts of the surface that are nearest to each point, about it.
pub(crate) fn weigh(seeds: &mut [Seed], parts: &[Cell], set: &Occupied, spacing: f64) {
    let mut weights: Vec<f64> = seeds.iter().map(|s| s.area).collect();
    for (i, part) in parts.iter().enumerate().filter(|(_, p)| p.volume > 0.0) {
        let around = around(seeds, i, set, spacing);
        let Some(shares) = shares(seeds, i, part, &around) else {
            continue;
        };
        let whole: f64 = shares.iter().sum();
        let limit = |j: usize, share: f64| PART * seeds[j].area / share.abs();
        let each = around.iter().zip(&shares).map(|(j, s)| limit(*j, *s));
        let factor = each.fold(limit(i, whole).min(1.0), f64::min);
        for (j, share) in around.iter().zip(&shares) {
            weights[*j] += factor * share;
        }
        weights[i] -= factor * whole;
    }
    for (seed, weight) in seeds.iter_mut().zip(weights) {
        seed.area = weight;
    }
}

/// The nearest points of the same face.
fn around(seeds: &[Seed], i: usize, set: &Occupied, spacing: f64) -> Vec<usize> {
    let own = &seeds[i];
    let mut radius = 2.0 * own.spacing;
    loop {
        let mut found: Vec<(f64, usize)> = Vec::new();
        set.any(own.place, radius, |j, _, square| {
            let j = j as usize;
            if j != i && seeds[j].area > 0.0 && dot(seeds[j].normal, own.normal) > 0.5 {
                found.push((square, j));
            }
            false
        });
        if found.len() >= POINTS || radius > 4.0 * spacing {
            found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            found.truncate(POINTS);
            return found.into_iter().map(|(_, j)| j).collect();
        }
        radius *= 1.4;
    }
}

/// What the moments of a part weigh the difference of each point from its own by; nothing where they do not tell.
fn shares(seeds: &[Seed], i: usize, part: &Cell, around: &[usize]) -> Option<Vec<f64>> {
    if around.len() < FEWEST {
        return None;
    }
    let own = &seeds[i];
    let first = aside(own.normal);
    let axes = [first, cross(own.normal, first)];
    let ways = around
        .iter()
        .map(|j| difference(seeds[*j].place, own.place));
    let ways: Vec<[f64; 2]> = ways.map(|way| axes.map(|axis| dot(way, axis))).collect();
    let squares = ways.iter().map(|[u, v]| u * u + v * v);
    let reach = squares.fold(0.0_f64, f64::max).sqrt();
    let rows: Vec<Terms> = ways
        .iter()
        .map(|way| terms(way.map(|c| c / reach)))
        .collect();
    let weights = rows.iter().map(|row| (-2.0 * (row[2] + row[4])).exp());
    let weights: Vec<f64> = weights.collect();
    let weighed = rows.iter().zip(&weights);
    let normal: Square = weighed.map(|(row, w)| *w * row * row.transpose()).sum();
    let flat =
        |a: &Vector, b: &Vector| -> f64 { (0..3).map(|k| dot(part.second[k], *b) * a[k]).sum() };
    let [u, v] = axes;
    let moments = Terms::from([
        dot(part.first, u) / reach,
        dot(part.first, v) / reach,
        flat(&u, &u) / (reach * reach),
        flat(&u, &v) / (reach * reach),
        flat(&v, &v) / (reach * reach),
    ]);
    let known = solved(normal, &moments)?;
    let share = |(row, weight): (&Terms, &f64)| weight * row.dot(&known);
    Some(rows.iter().zip(&weights).map(share).collect())
}

fn terms([u, v]: [f64; 2]) -> Terms {
    Terms::from([u, v, u * u, u * v, v * v])
}

/// Solves a symmetric positive system; nothing where it is singular.
fn solved(a: Square, b: &Terms) -> Option<Terms> {
    let factor = a.cholesky()?;
    let pivots = factor.l_dirty().diagonal();
    let sound = pivots.min() > PIVOT * pivots.max();
    sound.then(|| factor.solve(b))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use crate::cloud::setup;
    use crate::scene::Scene;

    /// `int dA / (a + c)^2` over a ball of radius 1 with `c = 1 - cos` of the angle from the pole that faces another ball.
    #[test]
    fn sums_over_graded_points_follow_what_is_steep() {
        let scene = r#"{"geometry": "space", "domain": {"sphere": {"centre_m": [0, 0, 0], "radius_m": 6}},
            "bodies": [
              {"name": "a", "potential_v": 0, "shape": {"sphere": {"centre_m": [0, 0, -1.005], "radius_m": 1}}},
              {"name": "b", "potential_v": 1, "shape": {"sphere": {"centre_m": [0, 0, 1.005], "radius_m": 1}}}],
            "electrostatics": {"outer": [{"potential_v": 0}]}, "points": {"spacing_m": 0.2}}"#;
        let scene: Scene = serde_json::from_str(scene).unwrap();
        let cloud = setup::cloud(&scene).unwrap();
        let (a, mut sum, mut area) = (0.005, 0.0, 0.0);
        for s in cloud.surface.iter().filter(|s| s.inner == 1) {
            sum += s.area / (a + 1.0 - s.normal[2]).powi(2);
            area += s.area;
            assert!(s.area > 0.0);
        }
        assert!((area / (4.0 * PI) - 1.0).abs() < 1e-12);
        let exact = 2.0 * PI * (1.0 / a - 1.0 / (a + 2.0));
        assert!((sum / exact - 1.0).abs() < 2e-3, "{}", sum / exact);
    }
}
