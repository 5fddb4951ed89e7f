//! Patches of surface in the shade of their own body.
//!
//! From the middle of a patch that faces the light a ray goes against it. Its steps are signed distances, within which there is no
//! surface, until it has left the body for good or is in it again.

use rayon::prelude::*;

use crate::cloud::{Cloud, Patch};
use shapes::Body;
use shapes::frame::{Vector, along, difference, dot, length};

/// Height above its patch at which a ray begins, its shortest step, and the depth in metal that ends it, over the patch's edge.
const ABOVE: f64 = 0.5;
const STEP: f64 = 0.25;
const DEEP: f64 = 0.01;
/// Patches that one task follows.
const ROWS: usize = 64;

/// Whether each patch lies in the shade of light that goes `into` the body; one that faces away counts as lit.
pub(crate) fn shaded(body: &Body, cloud: &Cloud, into: Vector) -> Vec<bool> {
    let [low, high] = body.bounds();
    let reach = length(difference(high, low));
    let behind = |patch: &Patch| {
        if dot(patch.normal, into) >= 0.0 {
            return false;
        }
        let edge = patch.area.powf(1.0 / (cloud.dimensions - 1) as f64);
        let from = along(patch.place, ABOVE * edge, patch.normal);
        let mut way = 0.0;
        while way <= reach {
            let away = body.distance(along(from, -way, into));
            if away < -DEEP * edge {
                return true;
            }
            way += away.max(STEP * edge);
        }
        false
    };
    let patches = cloud.patches.par_iter().with_min_len(ROWS);
    patches.map(behind).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOWN: Vector = [0.0, 0.0, -1.0];

    fn body(text: &str) -> (Body, Cloud) {
        let body = Body::new(&serde_json::from_str(text).unwrap(), 3);
        let points = r#"{"spacing_m": 0.1, "arrangement": "cut"}"#;
        let cloud = Cloud::fill(&body, &serde_json::from_str(points).unwrap(), 3).unwrap();
        (body, cloud)
    }

    /// Area across the light that is lit, and whether a place is.
    fn lit(body: &Body, cloud: &Cloud, into: Vector) -> f64 {
        let shade = shaded(body, cloud, into);
        let each = cloud.patches.iter().zip(shade);
        let faced = each.filter(|(patch, hidden)| !hidden && dot(patch.normal, into) < 0.0);
        faced
            .map(|(patch, _)| -patch.area * dot(patch.normal, into))
            .sum()
    }

    #[test]
    fn of_two_plates_the_upper_alone_is_lit_and_the_lower_beside_it() {
        let (body, cloud) = body(
            r#"{"union": [{"box": {"min_m": [0, 0, 0], "max_m": [2, 1, 0.4]}},
                {"box": {"min_m": [0, 0, 0.8], "max_m": [1, 1, 1.2]}}]}"#,
        );
        // From above the body has its outline, 2 by 1; from the side two edges of 0.4.
        let found = lit(&body, &cloud, DOWN);
        assert!((found - 2.0).abs() < 0.02, "{found}");
        let found = lit(&body, &cloud, [1.0, 0.0, 0.0]);
        assert!((found - 0.8).abs() < 0.01, "{found}");
    }

    #[test]
    fn nothing_of_a_convex_body_or_of_a_groove_that_is_seen_lies_in_the_shade() {
        let (ball, cloud) = body(r#"{"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}}"#);
        for into in [DOWN, [0.6, 0.0, 0.8]] {
            assert!(!shaded(&ball, &cloud, into).contains(&true));
        }
        let (groove, cloud) = body(
            r#"{"difference": [{"box": {"min_m": [0, 0, 0], "max_m": [2, 1, 1]}},
                {"intersection": [{"half_space": {"point_m": [1, 0, 0.5], "normal": [-1, 0, -1]}},
                    {"half_space": {"point_m": [1, 0, 0.5], "normal": [1, 0, -1]}}]}]}"#,
        );
        assert!(!shaded(&groove, &cloud, DOWN).contains(&true));
    }
}
