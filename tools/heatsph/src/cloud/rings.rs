//! Rings of a disc or cylinder (Rong and Kisu 2010, fig. 11): six points more on each ring than on the one
//! within it.

use std::f64::consts::{PI, TAU};

use super::points::Points;
use super::{Cloud, Patch, gaps, graded, widths};
use shapes::frame::Vector;

/// One ring and what its points stand for.
struct Ring {
    radius: f64,
    /// Distance to the nearer of its neighbours.
    gap: f64,
    points: usize,
    /// Radii between which it lies.
    edges: [f64; 2],
    /// Whether it is the rim.
    outer: bool,
}

/// One layer of a cylinder.
struct Layer {
    height: f64,
    width: f64,
    gap: f64,
    /// Heights between which it lies.
    edges: [f64; 2],
    /// -1 at the bottom, 1 at the top.
    end: f64,
}

/// Fills a disc or cylinder about the origin, its axis along z.
pub(super) fn fill(radius: f64, half: f64, points: &Points, dimensions: usize) -> Cloud {
    let steps = ((radius / points.spacing_m).round() as usize).max(1);
    let radii: Vec<f64> = graded(steps, points.grading.r)
        .iter()
        .map(|t| radius * t)
        .collect();
    let gap = gaps(&radii);
    let layers = layers(half, points, dimensions);
    let faces = if dimensions == 3 { [0, 1, 2] } else { [0; 3] };
    let mut cloud = Cloud {
        dimensions,
        ..Cloud::default()
    };
    for layer in &layers {
        for (m, &r) in radii.iter().enumerate() {
            let ring = Ring {
                radius: r,
                gap: gap[m],
                points: if m == 0 {
                    1
                } else {
                    around(r, gap[m], m, points.grading.r.is_some())
                },
                edges: [
                    if m == 0 {
                        0.0
                    } else {
                        0.5 * (radii[m - 1] + r)
                    },
                    if m == steps {
                        r
                    } else {
                        0.5 * (radii[m + 1] + r)
                    },
                ],
                outer: m == steps,
            };
            for k in 0..ring.points {
                point(&mut cloud, &ring, layer, k, faces);
            }
        }
    }
    cloud
}

/// Points of ring `m`.
fn around(radius: f64, gap: f64, m: usize, graded: bool) -> usize {
    if graded {
        ((TAU * radius / gap).round() as usize).max(6)
    } else {
        6 * m
    }
}

fn layers(half: f64, points: &Points, dimensions: usize) -> Vec<Layer> {
    if dimensions == 2 {
        return vec![Layer {
            height: 0.0,
            width: 1.0,
            gap: 0.0,
            edges: [0.0; 2],
            end: 0.0,
        }];
    }
    let steps = ((2.0 * half / points.spacing_m).round() as usize).max(1);
    let offsets = graded(steps, points.grading.z);
    let heights: Vec<f64> = offsets.iter().map(|t| half * (2.0 * t - 1.0)).collect();
    let (width, gap) = (widths(&heights), gaps(&heights));
    (0..=steps)
        .map(|i| Layer {
            height: heights[i],
            width: width[i],
            gap: gap[i],
            edges: [
                0.5 * (heights[i.saturating_sub(1)] + heights[i]),
                0.5 * (heights[(i + 1).min(steps)] + heights[i]),
            ],
            end: if i == 0 {
                -1.0
            } else if i == steps {
                1.0
            } else {
                0.0
            },
        })
        .collect()
}

/// Adds point `k` of a ring with what it owns of the rim and the ends.
fn point(cloud: &mut Cloud, ring: &Ring, layer: &Layer, k: usize, faces: [u32; 3]) {
    let part = TAU / ring.points as f64;
    let angle = part * k as f64;
    let at = |radius: f64, angle: f64, z: f64| -> Vector {
        let (sine, cosine) = angle.sin_cos();
        [radius * cosine, radius * sine, z]
    };
    let [inner, outside] = ring.edges;
    let sector = (outside * outside - inner * inner) * PI / ring.points as f64;
    let point = cloud.push(
        at(ring.radius, angle, layer.height),
        ring.gap.max(layer.gap),
        sector * layer.width,
    );
    let mut own = |face: u32, area: f64, normal: Vector, place: Vector| {
        cloud.patches.push(Patch {
            point,
            face,
            area,
            normal,
            place,
        });
    };
    if ring.outer {
        let area = ring.radius * part * layer.width;
        let height = 0.5 * (layer.edges[0] + layer.edges[1]);
        own(
            faces[0],
            area,
            at(1.0, angle, 0.0),
            at(ring.radius, angle, height),
        );
    }
    if layer.end.abs() > 0.5 {
        let face = faces[if layer.end < 0.0 { 1 } else { 2 }];
        // Radius of the middle of the sector; that of the innermost is on the axis.
        let middle = if ring.points == 1 {
            0.0
        } else {
            let half = 0.5 * part;
            let cubes = outside.powi(3) - inner.powi(3);
            2.0 / 3.0 * cubes / (outside * outside - inner * inner) * half.sin() / half
        };
        own(
            face,
            sector,
            [0.0, 0.0, layer.end],
            at(middle, angle, layer.height),
        );
    }
}
