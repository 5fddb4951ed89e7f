//! Walls around a hollow.
//!
//! Between two walls the places along the hollow are spread evenly, up to 5 % closer or farther than the spacing, so that the
//! walls join the floor without a seam. A hollow that this does not fit is refused.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shapes::Face;

use super::row::{lattice, product};

/// Walls outside of an inner box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Container {
    /// Lower corner of the hollow \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub min_m: [f64; 3],
    /// Upper corner of the hollow \[m\].
    #[schemars(extend("x-unit" = "m"))]
    pub max_m: [f64; 3],
    /// Thickness of the walls \[m\]; never fewer than two layers, as thinner walls leak.
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub thickness_m: f64,
    /// Sides without a wall.
    #[serde(default)]
    pub open: Vec<Face>,
}

/// Whether the lower and the upper side of an axis have a wall.
pub(super) fn walls(c: &Container, axis: usize) -> [bool; 2] {
    [false, true].map(|upper| !c.open.iter().any(|face| face.side() == (axis, upper)))
}

/// Fewest layers of a wall that carry what lies on it: the kernel reaches over two spacings.
const TIGHT: usize = 2;

/// Particles along a hollow may stand this part closer or farther than the spacing.
const STRETCH: f64 = 0.05;

/// Length of a hollow in spacings between two walls, of which the lower end is where its lattice starts.
fn length(c: &Container, axis: usize, d: f64) -> f64 {
    (c.max_m[axis] - c.min_m[axis]) / d
}

/// Places along the hollow. Below an upper wall they are spread evenly, so that it joins the floor without a seam.
fn along(c: &Container, axis: usize, d: f64) -> Vec<f64> {
    let (low, high, length) = (c.min_m[axis], c.max_m[axis], length(c, axis, d));
    let count = length.round().max(1.0);
    if !walls(c, axis)[1] || (length - count).abs() <= 1e-9 * count {
        return lattice(low, low, high, d);
    }
    let spread = (high - low) / count;
    (0..count as usize)
        .map(|i| low + (i as f64 + 0.5) * spread)
        .collect()
}

impl Container {
    /// The axis along which no layers of about the spacing `d` \[m\] fill the hollow, and the sizes next to that asked for which
    /// some do \[m\].
    #[must_use]
    pub fn misfit(&self, d: f64) -> Option<(usize, [f64; 2])> {
        let fits = |length: f64| {
            let count = length.round().max(1.0);
            (length / count - 1.0).abs() <= STRETCH + 1e-9
        };
        let walled = (0..3).filter(|axis| walls(self, *axis)[1]);
        let odd = walled.map(|axis| (axis, length(self, axis, d)));
        let (axis, length) = odd.into_iter().find(|(_, length)| !fits(*length))?;
        Some((axis, [length.floor().max(1.0) * d, length.ceil() * d]))
    }
}

/// Layers of the walls stand from the faces of the hollow outwards, so that the hollow has the size
/// asked for even where that is no multiple of d.
pub(super) fn container_points(c: &Container, d: f64) -> Vec<[f64; 3]> {
    let layers = ((c.thickness_m / d - 1e-9).ceil() as usize).max(TIGHT);
    let inner = [0, 1, 2].map(|k| along(c, k, d));
    let outer = [0, 1, 2].map(|k| {
        let [lower, upper] = walls(c, k).map(|wall| if wall { layers } else { 0 });
        let below = (0..lower).rev().map(|i| c.min_m[k] - (i as f64 + 0.5) * d);
        let above = (0..upper).map(|i| c.max_m[k] + (i as f64 + 0.5) * d);
        below.chain(inner[k].iter().copied()).chain(above).collect()
    });
    let mut points = product(&outer);
    points.retain(|p| (0..3).any(|k| p[k] < c.min_m[k] || p[k] > c.max_m[k]));
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::shape::Shape;

    const D: f64 = 0.5e-3;

    #[test]
    fn walls_join_the_floor_whatever_the_size() {
        for axis in 0..2 {
            for size in [16.4, 16.5, 10.7, 9.6, 20.0 + 1.0 / 3.0] {
                let mut max_m = [8.0 * D, 8.0 * D, 6.0 * D];
                max_m[axis] = size * D;
                let tank = Container {
                    min_m: [0.0; 3],
                    max_m,
                    thickness_m: 2.0 * D,
                    open: vec![Face::ZHigh],
                };
                assert_eq!(tank.misfit(D), None);
                // Along the axis, the first layer of the floor has no gap.
                let points = Shape::Container(tank).points([D; 3], None);
                let floor = |p: &&[f64; 3]| {
                    (p[2] + 0.5 * D).abs() < 1e-12 && (p[1 - axis] - 0.5 * D).abs() < 1e-12
                };
                let mut line: Vec<f64> = points.iter().filter(floor).map(|p| p[axis]).collect();
                line.sort_by(f64::total_cmp);
                let gap = line.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
                assert!(gap <= 1.05 * D, "{size}: {}", gap / D);
            }
        }
    }

    #[test]
    fn a_hollow_that_no_layers_fill_is_told_with_sizes_that_fit() {
        let mut tank = Container {
            min_m: [0.0; 3],
            max_m: [8.0 * D, 2.5 * D, 6.3 * D],
            thickness_m: 2.0 * D,
            open: vec![Face::ZHigh],
        };
        let (axis, [less, more]) = tank.misfit(D).unwrap();
        assert_eq!(axis, 1);
        for size in [less, more] {
            tank.max_m[1] = size;
            assert_eq!(tank.misfit(D), None);
        }
        // Beside an open side there is no seam.
        tank.max_m[1] = 2.5 * D;
        tank.open.push(Face::YHigh);
        assert_eq!(tank.misfit(D), None);
    }

    #[test]
    fn walls_stand_outside_of_the_hollow() {
        let container = |open| {
            Shape::Container(Container {
                min_m: [0.0; 3],
                max_m: [4.0 * D, 5.0 * D, 6.3 * D],
                thickness_m: 2.0 * D,
                open,
            })
        };
        let closed = container(vec![]).points([D; 3], None);
        assert_eq!(closed.len(), 8 * 9 * 10 - 4 * 5 * 6);
        let open = container(vec![Face::ZHigh]).points([D; 3], None);
        assert_eq!(open.len(), 8 * 9 * 8 - 4 * 5 * 6);
        for p in &closed {
            assert!((0..3).any(|k| {
                let high = [4.0 * D, 5.0 * D, 6.3 * D][k];
                p[k] < -0.49 * D || p[k] > high + 0.49 * D
            }));
        }
    }
}
