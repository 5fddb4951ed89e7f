//! Points on surfaces, about evenly, with normal, area and curvature.

use std::f64::consts::PI;

use shapes::frame::{Vector, along, cross, difference, direction, dot, length};
use shapes::jitter;
use shapes::surface::{Piece, pieces};
use shapes::{Body, Kind};

use super::areas;
pub use super::seed::Curvature;
pub(crate) use super::seed::Seed;
use super::seed::aside;
use crate::cloud::Cell;
use crate::cloud::occupied::Occupied;

/// Pieces per spacing from which points are chosen, over those that shapes make by themselves.
const FINER: f64 = 2.0;
/// Pieces per spacing along a curve: points stand as evenly as these are fine.
const CURVES: f64 = 64.0;
/// Distance over spacing at which points chosen at random stand as close as an even arrangement.
const PACKING: f64 = 0.8;
/// The same for points of two faces that meet at an edge.
const EDGES: f64 = 0.65;
/// Pieces among which a point is chosen, over those that the finest spacing has.
const CHOICE: f64 = 2.0;

/// Points on the surface of a body; `local` is the wanted distance of points at a place, at most `spacing` and at
/// least `least` \[m\].
pub(crate) fn seeds(
    body: &Body,
    dimensions: usize,
    spacing: f64,
    least: f64,
    local: &dyn Fn(Vector) -> f64,
) -> Vec<Seed> {
    let even = least >= spacing;
    let ball = body.single().and_then(|p| match p.kind {
        Kind::Ball(radius) => Some((p.frame.origin, radius)),
        _ => None,
    });
    let mut found = match ball {
        Some((centre, radius)) if even && dimensions == 3 => {
            return spiral(centre, radius, spacing);
        }
        _ if dimensions == 2 => along_curves(&pieces(body, 2, least / CURVES), local),
        _ => {
            let finer = if even { FINER } else { 1.0 };
            spread(&pieces(body, 3, least / finer), spacing, least, local)
        }
    };
    for seed in &mut found {
        seed.curvature = curvature(body, seed, dimensions);
    }
    found
}

/// A spiral of golden angles: equal areas, nearly even (Gonzalez 2010).
fn spiral(centre: Vector, radius: f64, spacing: f64) -> Vec<Seed> {
    let area = 4.0 * PI * radius * radius;
    let number = (area / (spacing * spacing)).round().max(12.0);
    let turn = PI * (3.0 - 5.0_f64.sqrt());
    (0..number as usize)
        .map(|k| {
            let z = 1.0 - (2.0 * k as f64 + 1.0) / number;
            let ring = (1.0 - z * z).sqrt();
            let (sine, cosine) = (turn * k as f64).sin_cos();
            let normal = direction([ring * cosine, ring * sine, z]);
            Seed {
                place: along(centre, radius, normal),
                normal,
                area: area / number,
                spacing: (area / number).sqrt(),
                curvature: Curvature {
                    along: aside(normal),
                    principal: [1.0 / radius; 2],
                },
            }
        })
        .collect()
}

/// Even steps along the curves that pieces form.
fn along_curves(pieces: &[Piece], local: &dyn Fn(Vector) -> f64) -> Vec<Seed> {
    let joined = |a: &Piece, b: &Piece| {
        let gap = length(difference(a.place, b.place));
        a.face == b.face && gap < 0.75 * (a.area + b.area)
    };
    let mut seeds = Vec::new();
    for curve in pieces.chunk_by(joined) {
        let steps: Vec<f64> = curve.iter().map(|p| p.area / local(p.place)).collect();
        let whole: f64 = steps.iter().sum();
        // Points of a curve that closes stand between its quarters: off the axes of a full circle.
        let closed = curve.len() > 2 && joined(&curve[curve.len() - 1], &curve[0]);
        let parts = if closed { 4.0 } else { 2.0 };
        let least = if whole < 1.0 { 1.0 } else { parts };
        let number = (parts * (whole / parts).round()).max(least);
        let (mut passed, mut area, mut next) = (0.0, 0.0, 0.5);
        let mut middle: Option<Piece> = None;
        for (piece, step) in curve.iter().zip(&steps) {
            passed += step * number / whole;
            area += piece.area;
            if passed >= next && middle.is_none() {
                middle = Some(*piece);
            }
            if passed >= next + 0.5 - 1e-9 {
                if let Some(p) = middle.take() {
                    seeds.push(seed(&p, area, area));
                }
                area = 0.0;
                next += 1.0;
            }
        }
    }
    seeds
}

fn seed(piece: &Piece, area: f64, spacing: f64) -> Seed {
    Seed {
        place: piece.place,
        normal: direction(piece.normal),
        area,
        spacing,
        curvature: Curvature::default(),
    }
}

/// Points chosen among pieces in a scattered order, none nearer to another than the packing allows; each takes the
/// area of the pieces nearest to it; where points stand closer here than there, its weight in sums.
fn spread(pieces: &[Piece], spacing: f64, least: f64, local: &dyn Fn(Vector) -> f64) -> Vec<Seed> {
    let wanted: Vec<f64> = pieces.iter().map(|p| local(p.place)).collect();
    // Where points stand far apart, a few of the pieces are choice enough.
    let enough = |k: usize| {
        let part = CHOICE * (least / wanted[k]).powi(2);
        (jitter::bits(!(k as u64), 0) >> 11) as f64 <= part * (1_u64 << 53) as f64
    };
    let mut order: Vec<(u64, usize)> = (0..pieces.len())
        .filter(|k| enough(*k))
        .map(|k| (jitter::bits(k as u64, 0), k))
        .collect();
    order.sort_unstable();
    let mut set = Occupied::new(spacing);
    let mut seeds: Vec<Seed> = Vec::new();
    for (_, k) in order {
        let (piece, own) = (&pieces[k], wanted[k]);
        let taken = set.any(piece.place, PACKING * own, |other, _, square| {
            // Faces that meet at an edge do not keep each other as far from it as points of one face are apart.
            let same = dot(seeds[other as usize].normal, piece.normal) > 0.5;
            same || square < (EDGES * own).powi(2)
        });
        if !taken {
            set.push(piece.place);
            seeds.push(seed(piece, 0.0, own));
        }
    }
    let mut parts = vec![Cell::default(); if least < spacing { seeds.len() } else { 0 }];
    for (piece, own) in pieces.iter().zip(&wanted) {
        let mut radius = PACKING * own;
        while radius < 4.0 * spacing {
            let mut best: Option<(f64, u32)> = None;
            set.any(piece.place, radius, |k, _, square| {
                let same = dot(seeds[k as usize].normal, piece.normal) > 0.5;
                if same && best.is_none_or(|b| (square, k) < b) {
                    best = Some((square, k));
                }
                false
            });
            if let Some((_, k)) = best {
                let seed = &mut seeds[k as usize];
                seed.area += piece.area;
                if let Some(part) = parts.get_mut(k as usize) {
                    let way = difference(piece.place, seed.place);
                    part.add(piece.area, way, [[0.0; 3]; 3]);
                }
                break;
            }
            radius *= 1.5;
        }
    }
    areas::weigh(&mut seeds, &parts, &set, spacing);
    seeds.retain(|s| s.area > 0.0);
    seeds
}

/// Principal curvatures: from the turning of the normal.
fn curvature(body: &Body, seed: &Seed, dimensions: usize) -> Curvature {
    let plane = [0.0, 0.0, 1.0];
    if let Some(primitive) = body.single()
        && let Kind::Cylinder { radius, half } = primitive.kind
        && half.is_infinite()
    {
        let sign = if primitive.cut { -1.0 } else { 1.0 };
        return Curvature {
            along: direction(cross(primitive.frame.axes[2], seed.normal)),
            principal: [sign / radius, 0.0],
        };
    }
    let step = 0.02 * seed.spacing;
    let u = if dimensions == 2 {
        direction(cross(plane, seed.normal))
    } else {
        aside(seed.normal)
    };
    let v = cross(seed.normal, u);
    let slope = |d: Vector| {
        let normal = |s: f64| body.normal(along(seed.place, s, d), 0.1 * step);
        let change = difference(normal(step), normal(-step));
        [dot(change, u), dot(change, v)].map(|c| c / (2.0 * step))
    };
    let (a, b) = (slope(u), if dimensions == 2 { [0.0; 2] } else { slope(v) });
    let found = if dimensions == 2 {
        Curvature {
            along: u,
            principal: [a[0], 0.0],
        }
    } else {
        principal([u, v], [a[0], 0.5 * (a[1] + b[0]), b[1]])
    };
    // Where a sharp edge is within reach there is no curvature to speak of.
    let limit = 1.0 / seed.spacing;
    let sharp = found.principal.iter().any(|k| k.abs() > limit);
    if sharp || found.sum().abs() > limit {
        return Curvature::default();
    }
    found
}

/// Principal curvatures of the form `a x^2 + 2 b x y + c y^2` along two axes.
fn principal([u, v]: [Vector; 2], [a, b, c]: [f64; 3]) -> Curvature {
    let (sine, cosine) = (0.5 * (2.0 * b).atan2(a - c)).sin_cos();
    let [mean, apart] = [0.5 * (a + c), (0.5 * (a - c)).hypot(b)];
    Curvature {
        along: std::array::from_fn(|k| cosine * u[k] + sine * v[k]),
        principal: [mean + apart, mean - apart],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_curvatures_turn_with_their_axes() {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let (sine, cosine) = 0.4_f64.sin_cos();
        let [first, second] = [3.0, -1.0];
        let form = [
            first * cosine * cosine + second * sine * sine,
            (first - second) * sine * cosine,
            first * sine * sine + second * cosine * cosine,
        ];
        let found = principal(axes, form);
        assert!((found.principal[0] - first).abs() < 1e-12);
        assert!((found.principal[1] - second).abs() < 1e-12);
        assert!((found.along[0] - cosine).abs() < 1e-12 && (found.along[1] - sine).abs() < 1e-12);
        assert!((found.widening(0.1) - 1.3 * 0.9).abs() < 1e-12);
        assert!((found.beside(0.1).principal[0] - 3.0 / 1.3).abs() < 1e-12);
    }
}
