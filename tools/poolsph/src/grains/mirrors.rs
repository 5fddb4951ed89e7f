//! Planes of symmetry: what lies beyond is the image of what lies before.
//!
//! A grain touches its own image (`contact::Meeting::with_image`). No grain beyond is nearer to a place before the plane
//! than its original is, so that the nearest grain needs no images; sums over grains do.

use shapes::frame::{Vector, along, difference, dot};

use super::faces::Face;
use super::wall_parameters::WallScene;

/// The mirrors among walls.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mirrors {
    /// A place of each, and its normal.
    planes: Vec<(Vector, Vector)>,
}

impl Mirrors {
    /// Those of a scene.
    #[must_use]
    pub fn of(walls: &[WallScene]) -> Self {
        let mirrors = walls.iter().filter(|wall| wall.mirror);
        let faces = mirrors.flat_map(|wall| Face::outside(&wall.shape));
        let planes = faces.filter_map(|face| match face {
            Face::Plane(point, normal) => Some((point, normal)),
            _ => None,
        });
        Self {
            planes: planes.collect(),
        }
    }

    /// Whether one is the plane through `point` of the unit `normal`, to a part of `small` \[m\].
    #[must_use]
    pub fn have(&self, point: Vector, normal: Vector, small: f64) -> bool {
        let same = |(own, way): &(Vector, Vector)| {
            dot(*way, normal) > 1.0 - 1e-9 && dot(difference(*own, point), normal).abs() < small
        };
        self.planes.iter().any(same)
    }

    /// Whether a place lies beyond one.
    #[must_use]
    pub fn hide(&self, place: Vector) -> bool {
        let away = |(point, normal): &(Vector, Vector)| dot(difference(place, *point), *normal);
        self.planes.iter().any(|plane| away(plane) < 0.0)
    }

    /// Adds the images of balls that are within `reach` \[m\] of a mirror, those of images included.
    pub fn complete(&self, places: &mut Vec<Vector>, radii: &mut Vec<f64>, reach: f64) {
        for (point, normal) in &self.planes {
            for k in 0..places.len() {
                let away = dot(difference(places[k], *point), *normal);
                if away.abs() < reach {
                    places.push(along(places[k], -2.0 * away, *normal));
                    radii.push(radii[k]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_of_two_mirrors_shows_a_ball_three_times() {
        let mirrors = Mirrors {
            planes: vec![
                ([0.0; 3], [1.0, 0.0, 0.0]),
                ([0.0, 2.0, 0.0], [0.0, -1.0, 0.0]),
            ],
        };
        let (mut places, mut radii) = (vec![[0.25, 1.5, 7.0], [3.0, 1.5, 0.0]], vec![0.1, 0.2]);
        mirrors.complete(&mut places, &mut radii, 1.0);
        let images = [
            [-0.25, 1.5, 7.0],
            [0.25, 2.5, 7.0],
            [3.0, 2.5, 0.0],
            [-0.25, 2.5, 7.0],
        ];
        assert_eq!(places[2..], images);
        assert_eq!(radii[2..], [0.1, 0.1, 0.2, 0.1]);
        assert!(mirrors.hide(images[0]) && mirrors.hide(images[1]) && !mirrors.hide(places[0]));
    }
}
