//! Shells of a sphere: on each, points on a spiral of equal turns (Fibonacci's lattice), about one spacing apart.

use std::f64::consts::PI;

use super::points::Points;
use super::{Cloud, Patch};

/// Fills a ball about the origin.
pub(super) fn fill(radius: f64, points: &Points) -> Cloud {
    let steps = ((radius / points.spacing_m).round() as usize).max(1);
    let gap = radius / steps as f64;
    let mut cloud = Cloud {
        dimensions: 3,
        ..Cloud::default()
    };
    cloud.push([0.0; 3], gap, 4.0 / 3.0 * PI * (0.5 * gap).powi(3));
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    for m in 1..=steps {
        let r = gap * m as f64;
        let number = (4.0 * PI * (m * m) as f64).round() as usize;
        let (low, high) = (r - 0.5 * gap, if m == steps { r } else { r + 0.5 * gap });
        let share = 4.0 / 3.0 * PI * (high.powi(3) - low.powi(3)) / number as f64;
        for k in 0..number {
            let height = 1.0 - (2.0 * k as f64 + 1.0) / number as f64;
            let across = (1.0 - height * height).sqrt();
            let (sine, cosine) = (golden * k as f64 + m as f64).sin_cos();
            let normal = [across * cosine, across * sine, height];
            let point = cloud.push(normal.map(|n| r * n), gap, share);
            if m == steps {
                cloud.patches.push(Patch {
                    point,
                    face: 0,
                    area: 4.0 * PI * r * r / number as f64,
                    normal,
                    place: normal.map(|n| r * n),
                });
            }
        }
    }
    cloud
}
