//! Plain walls: water meets its mirror image.
//!
//! A particle near a wall sees its neighbours and itself mirrored in the plane that touches the wall next to it, with the
//! velocity mirrored too. At a flat wall water and image are one symmetric flow: nothing passes, nothing rubs, linear
//! fields stay exact, and the energy is that of half of it. Where walls meet at a right angle, images are mirrored again.

use shapes::Body;

/// Two walls with a smaller cosine between them have a common image.
const UPRIGHT: f64 = 0.05;
/// Most walls that a particle sees.
pub const WALLS: usize = 3;

/// A plane wall as a particle sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Number of the wall.
    pub wall: usize,
    /// Away from it.
    pub normal: [f64; 3],
    /// Distance \[m\].
    pub distance: f64,
}

impl Plane {
    /// Height of a place above the plane, given the particle's own place \[m\].
    #[inline(always)]
    #[must_use]
    pub fn height(&self, own: [f64; 3], place: [f64; 3]) -> f64 {
        let n = self.normal;
        self.distance + (0..3).map(|k| (place[k] - own[k]) * n[k]).sum::<f64>()
    }

    /// A vector mirrored.
    #[inline(always)]
    #[must_use]
    pub fn mirrored(&self, u: [f64; 3]) -> [f64; 3] {
        let n = self.normal;
        let across = 2.0 * (u[0] * n[0] + u[1] * n[1] + u[2] * n[2]);
        [0, 1, 2].map(|k| u[k] - across * n[k])
    }
}

/// Planes in which a particle is mirrored, one after the other.
pub type Mirror = Vec<Plane>;

/// All mirrors of a place within `reach` \[m\] of walls.
#[must_use]
pub fn mirrors(walls: &[Body], place: [f64; 3], reach: f64) -> Vec<Mirror> {
    let mut planes = Vec::new();
    for (wall, body) in walls.iter().enumerate() {
        let distance = body.distance(place);
        if distance < reach && planes.len() < WALLS {
            let normal = body.normal(place, 1e-3 * reach);
            planes.push(Plane {
                wall,
                normal,
                distance,
            });
        }
    }
    let upright = |a: &Plane, b: &Plane| {
        let cosine: f64 = (0..3).map(|k| a.normal[k] * b.normal[k]).sum();
        cosine.abs() < UPRIGHT
    };
    let mut mirrors: Vec<Mirror> = Vec::new();
    for plane in planes {
        let again: Vec<Mirror> = mirrors
            .iter()
            .filter(|mirror| mirror.iter().all(|other| upright(other, &plane)))
            .map(|mirror| mirror.iter().copied().chain([plane]).collect())
            .collect();
        mirrors.push(vec![plane]);
        mirrors.extend(again);
    }
    mirrors
}

/// The image of a place and a velocity; none of what is behind a wall already.
#[inline]
#[must_use]
pub fn image(
    mirror: &[Plane],
    own: [f64; 3],
    place: [f64; 3],
    velocity: [f64; 3],
) -> Option<([f64; 3], [f64; 3])> {
    let (mut x, mut u) = (place, velocity);
    for plane in mirror {
        let height = plane.height(own, x);
        if height < 0.0 && plane.distance > 0.0 {
            return None;
        }
        (0..3).for_each(|k| x[k] -= 2.0 * height * plane.normal[k]);
        u = plane.mirrored(u);
    }
    Some((x, u))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_space(point: [f64; 2], normal: [f64; 2]) -> Body {
        let shape = serde_json::json!({"half_space": {"point_m": point, "normal": normal}});
        Body::new(&serde_json::from_value(shape).unwrap(), 2)
    }

    #[test]
    fn a_corner_has_three_images() {
        let walls = [
            half_space([0.0, 0.0], [0.0, 1.0]),
            half_space([0.0, 0.0], [1.0, 0.0]),
        ];
        let own = [0.1, 0.2, 0.0];
        let found = mirrors(&walls, own, 0.5);
        let places: Vec<[f64; 3]> = found
            .iter()
            .filter_map(|m| image(m, own, own, [1.0, 2.0, 0.0]))
            .map(|(x, _)| x)
            .collect();
        for (found, exact) in places.iter().zip([[0.1, -0.2], [-0.1, 0.2], [-0.1, -0.2]]) {
            assert!((found[0] - exact[0]).abs() + (found[1] - exact[1]).abs() < 1e-12);
        }
        assert_eq!(places.len(), 3);
    }
}
