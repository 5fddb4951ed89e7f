//! Clouds made by hand, and the equations on them.

mod quadrature;

use crate::stencils::quadrature::Moments;
use crate::stencils::region::{Face, Kind, Region};
use wls::Metric;

/// A disc of radius 1 (medium 1) in a disc of radius 3 (medium 0), points in rings.
pub(crate) fn rings(spacing: f64) -> Region<2> {
    let mut region = Region::default();
    let inside = (1.0 / spacing).round() as i32;
    for k in 0..=3 * inside {
        let r = f64::from(k) / f64::from(inside);
        let count = ((std::f64::consts::TAU * r / spacing).round() as i32).max(1);
        for m in 0..count {
            let angle =
                std::f64::consts::TAU * (f64::from(m) + 0.5 * f64::from(k % 2)) / f64::from(count);
            let n = [angle.cos(), angle.sin()];
            let point = region.places.len() as u32;
            region.places.push([r * n[0], r * n[1]]);
            region.metrics.push(Metric::round(spacing));
            region.wall_normals.push(n);
            region.kinds.push(if k == inside {
                region.faces.push(Face {
                    point,
                    inner: 1,
                    outer: 0,
                    normal: n,
                    area: std::f64::consts::TAU / f64::from(count),
                });
                Kind::Interface(region.faces.len() as u32 - 1)
            } else if k == 3 * inside {
                Kind::Wall { medium: 0, wall: 6 }
            } else {
                Kind::Inside(u16::from(k < inside))
            });
        }
    }
    region
}

/// Radii of shells and their distances: `across` apart beside the radius 1, growing, up to 4.
fn radii(across: f64, along: f64) -> Vec<(f64, f64)> {
    let growth: f64 = 1.2;
    let mut radii = vec![(1.0, across)];
    let (mut r, mut step) = (1.0, across);
    while r > 0.6 * along {
        r -= step;
        radii.push((r.max(0.0), step));
        step = (step * growth).min(along).min(r.max(0.01));
        if r <= 0.6 * along {
            break;
        }
    }
    radii.reverse();
    let (mut r, mut step) = (1.0, across);
    let mut last = false;
    while !last {
        r += step;
        last = r + 0.7 * step > 4.0;
        r = if last { 4.0 } else { r };
        radii.push((r, step));
        step = (step * growth).min(along * r);
    }
    radii
}

/// A round patch of a shell, about a point at the distance `r` along `n`.
fn patch(r: f64, n: [f64; 3], [low, high]: [f64; 2], volume: f64) -> Moments<3> {
    let (middle, thick) = (0.5 * (low + high), high - low);
    let square = volume / (thick * 4.0 * std::f64::consts::PI);
    // Curved patches lie below their points; a shell holds more outside than inside.
    let way = middle - square / middle + thick * thick / (6.0 * middle) - r;
    let second = |a: usize, b: usize| {
        let along = n[a] * n[b];
        let across = f64::from(u8::from(a == b)) - along;
        volume * ((way * way + thick * thick / 12.0) * along + square * across)
    };
    Moments {
        volume,
        first: n.map(|x| volume * way * x),
        second: std::array::from_fn(|a| std::array::from_fn(|b| second(a, b))),
    }
}

/// A ball of radius 1 (medium 1) in a ball of radius 4 (medium 0): points on shells, `along` apart at
/// the surface, and `across` apart beside it, growing.
pub(crate) fn shells(across: f64, along: f64) -> (Region<3>, Vec<Moments<3>>) {
    let radii = radii(across, along);
    let mut region = Region::default();
    let mut cells = Vec::new();
    for (k, &(r, step)) in radii.iter().enumerate() {
        let spacing = along * r.max(0.5);
        let count = ((4.0 * std::f64::consts::PI * (r / spacing).powi(2)) as usize).max(1);
        let edge = |a: f64, b: f64| 0.5 * (a + b);
        let low = if k == 0 { 0.0 } else { edge(radii[k - 1].0, r) };
        let high = radii.get(k + 1).map_or(r, |n| edge(r, n.0));
        let high = if (r - 1.0).abs() < 1e-12 { r } else { high };
        let shell = 4.0 / 3.0 * std::f64::consts::PI * (high.powi(3) - low.powi(3));
        for m in 0..count {
            let z = 1.0 - (2.0 * m as f64 + 1.0) / count as f64;
            let angle = 2.399_963_229_728_653 * m as f64 + 0.7 * k as f64;
            let s = (1.0 - z * z).sqrt();
            let n = [s * angle.cos(), s * angle.sin(), z];
            let point = region.places.len() as u32;
            region.places.push(n.map(|x| x * r));
            region.metrics.push(if step < 0.9 * spacing {
                Metric::layered(n, step, spacing)
            } else {
                Metric::round(spacing)
            });
            region.wall_normals.push(n);
            let volume = if r < 1.0 + 1e-12 {
                shell / count as f64
            } else {
                0.0
            };
            cells.push(patch(r, n, [low, high], volume));
            region.kinds.push(if (r - 1.0).abs() < 1e-12 {
                region.faces.push(Face {
                    point,
                    inner: 1,
                    outer: 0,
                    normal: n,
                    area: 4.0 * std::f64::consts::PI / count as f64,
                });
                Kind::Interface(region.faces.len() as u32 - 1)
            } else if (r - 4.0).abs() < 1e-12 {
                Kind::Wall { medium: 0, wall: 6 }
            } else {
                Kind::Inside(u16::from(r < 1.0))
            });
        }
    }
    (region, cells)
}
