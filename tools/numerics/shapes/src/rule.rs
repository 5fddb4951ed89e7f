//! Places and weights of integrals over closed surfaces.
//!
//! On a box, a finite bar, a ball or an ellipsoid in space: per face the rule of Gauss and Legendre along each parameter, equal steps
//! along angles, where these are as exact. What is smooth on each face is integrated to a power of the spacing that grows
//! with the number of places. Other surfaces are summed over the middles of their pieces, to second order.

use quadrature::gauss;

use crate::body::{Body, Kind, Primitive};
use crate::face::faces;
use crate::surface::{Piece, pieces};

/// Least number of places along a parameter.
const LEAST: usize = 6;

/// Places with normals and weights \[m2; m in a plane\] for integrals over the surface of a body, about one per spacing
/// \[m\].
#[must_use]
pub fn rule(body: &Body, dimensions: usize, spacing: f64) -> Vec<Piece> {
    match body.single() {
        Some(primitive) if dimensions == 3 && ends(primitive) => smooth(primitive, spacing),
        _ => pieces(body, dimensions, spacing),
    }
}

fn ends(primitive: &Primitive) -> bool {
    match &primitive.kind {
        Kind::Box(half) => half.iter().all(|h| h.is_finite()),
        Kind::Cylinder { half, .. } => half.is_finite(),
        Kind::Ball(_) | Kind::Ellipsoid(_) => true,
        Kind::HalfSpace | Kind::Mesh(_) => false,
    }
}

/// The rule of a primitive in space.
fn smooth(primitive: &Primitive, spacing: f64) -> Vec<Piece> {
    let mut found = Vec::new();
    let Primitive { kind, frame, .. } = primitive;
    for (number, face) in faces(primitive, 3, f64::INFINITY).iter().enumerate() {
        let [u, v] = [0, 1].map(|k| {
            let count = ((face.lengths[k] / spacing).ceil() as usize).max(LEAST);
            let unit = if face.closed(k) {
                even(count)
            } else {
                gauss(count)
            };
            let [a, b] = face.range[k];
            let half = 0.5 * (b - a);
            let place = |(x, w): (f64, f64)| (a + half * (1.0 + x), half * w);
            unit.into_iter().map(place).collect::<Vec<_>>()
        });
        for (x, along) in &u {
            for (y, across) in &v {
                let (place, normal, density) = face.at(kind, frame, [*x, *y], 3);
                found.push(Piece {
                    face: number,
                    place,
                    normal,
                    area: density * along * across,
                });
            }
        }
    }
    found
}

/// Middles of equal parts of -1 to 1, with their lengths.
fn even(count: usize) -> Vec<(f64, f64)> {
    let part = 2.0 / count as f64;
    (0..count)
        .map(|k| (part * (k as f64 + 0.5) - 1.0, part))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::frame::dot;
    use crate::surface::{closure, enclosed};

    fn surface(text: &str, spacing: f64) -> Vec<Piece> {
        rule(
            &Body::new(&serde_json::from_str(text).unwrap(), 3),
            3,
            spacing,
        )
    }

    #[test]
    fn areas_and_volumes_are_exact() {
        let ball = r#"{"sphere": {"centre_m": [1, 0, 2], "radius_m": 0.5}}"#;
        let block = r#"{"turned": {"axis": "x", "angle_deg": 30,
            "shape": {"box": {"min_m": [1, 2, 0], "max_m": [2, 4, 3]}}}}"#;
        let bar =
            r#"{"cylinder": {"centre_m": [1, 0, 2], "axis": "y", "radius_m": 1, "length_m": 2}}"#;
        for (text, area, volume) in [
            (ball, PI, PI / 6.0),
            (block, 22.0, 6.0),
            (bar, 6.0 * PI, 2.0 * PI),
        ] {
            let found = surface(text, 0.4);
            let total: f64 = found.iter().map(|p| p.area).sum();
            assert!((total / area - 1.0).abs() < 1e-13, "{total} of {area}");
            assert!((enclosed(&found, 3) / volume - 1.0).abs() < 1e-13);
            assert!(closure(&found).iter().all(|c| c.abs() < 1e-12));
        }
    }

    /// Also of one that is moved outward: `V + A d + M d^2 + 4/3 pi d^3`, `M` the integral of the mean curvature, that of a
    /// spheroid `2 pi (c + a^2/f ln((c + f)/a))`, `f^2 = c^2 - a^2`.
    #[test]
    fn ellipsoids_are_measured_to_many_digits() {
        let text = r#"{"ellipsoid": {"centre_m": [1, 0, 2], "semi_axes_m": [1, 1, 2]}}"#;
        let body = Body::new(&serde_json::from_str(text).unwrap(), 3);
        let f = 3.0_f64.sqrt();
        let (volume, area) = (
            8.0 / 3.0 * PI,
            2.0 * PI * (1.0 + 4.0 / f * (f / 2.0).asin()),
        );
        let mean = 2.0 * PI * (2.0 + (2.0 + f).ln() / f);
        for d in [0.0, 0.25, -0.25] {
            let found = rule(&body.grown(d).unwrap(), 3, 0.1);
            let total: f64 = found.iter().map(|p| p.area).sum();
            let wanted = area + 2.0 * mean * d + 4.0 * PI * d * d;
            assert!((total / wanted - 1.0).abs() < 1e-9, "{d}: {total} {wanted}");
            let wanted = volume + area * d + mean * d * d + 4.0 / 3.0 * PI * d.powi(3);
            assert!((enclosed(&found, 3) / wanted - 1.0).abs() < 1e-9, "{d}");
        }
    }

    /// The flux of a charge through a surface about it is the same wherever it is.
    #[test]
    fn the_flux_of_a_charge_is_found_to_many_digits() {
        let charge = [1.1, 0.2, 1.9];
        let flux = |text: &str, spacing: f64| -> f64 {
            let found = surface(text, spacing);
            let part = |p: &Piece| {
                let d = [0, 1, 2].map(|k| p.place[k] - charge[k]);
                p.area * dot(p.normal, d) / dot(d, d).powf(1.5)
            };
            found.iter().map(part).sum::<f64>() / (4.0 * PI) - 1.0
        };
        let ball = r#"{"sphere": {"centre_m": [1, 0, 2], "radius_m": 1}}"#;
        let bar =
            r#"{"cylinder": {"centre_m": [1, 0, 2], "axis": "y", "radius_m": 1, "length_m": 2}}"#;
        for shape in [ball, bar] {
            let errors = [0.2, 0.1].map(|h| flux(shape, h).abs());
            assert!(errors[0] < 1e-4 && errors[1] < 1e-7, "{errors:?}");
        }
        // Composed: by pieces, to second order.
        let lens = r#"{"intersection": [{"sphere": {"centre_m": [1, 0, 2], "radius_m": 1}},
            {"half_space": {"point_m": [1, 0, 2.3], "normal": [0, 0, 1]}}]}"#;
        assert!(flux(lens, 0.1).abs() < 2e-3);
    }
}
