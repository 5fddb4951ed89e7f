//! Lattices of round bodies, whose particles hold the volume of the body.
//!
//! How many lattice points a round body holds changes with where it lies upon its lattice. The lattice from the corner of the box
//! around it is taken where its particles hold the volume to half a percent. Otherwise it is the one, of those that the centre
//! halves, that holds it best, and what is still missing is made up by a stretch. Beside other bodies, whose lattices it continues, the
//! lattice stays as it is.

use super::shape::Shape;

/// Part of its volume by which the particles of a round body may miss it.
pub const MISSED: f64 = 5e-3;
/// Most by which places are stretched.
const STRETCH: f64 = 0.05;

/// How the lattice of a round body lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Round {
    /// Where it begins \[m\]; none where that is the corner of the box around the body.
    pub anchor: Option<[f64; 3]>,
    /// Places are so many times as far from the centre, along each axis.
    pub stretch: [f64; 3],
}

/// No stretch.
const NONE: [f64; 3] = [1.0; 3];

impl Default for Round {
    /// From the corner, as it is.
    fn default() -> Self {
        Self {
            anchor: None,
            stretch: NONE,
        }
    }
}

impl Round {
    /// How a lattice of the spacings `pitch` \[m\] lies in a shape that has no other beside it.
    #[must_use]
    pub fn of(shape: &Shape, pitch: [f64; 3]) -> Self {
        let anchor = anchor(shape, pitch);
        Self {
            anchor,
            stretch: stretch(shape, pitch, anchor),
        }
    }

    /// Places of the particles of a shape, on a lattice from `anchor` where that is given \[m\].
    #[must_use]
    pub fn points(
        &self,
        shape: &Shape,
        pitch: [f64; 3],
        anchor: Option<[f64; 3]>,
    ) -> Vec<[f64; 3]> {
        let mut points = shape.points(pitch, anchor.or(self.anchor));
        if let Some((centre, _)) = shape.round().filter(|_| self.stretch != NONE) {
            for point in &mut points {
                *point = [0, 1, 2].map(|k| centre[k] + self.stretch[k] * (point[k] - centre[k]));
            }
        }
        points
    }
}

/// Lattice points from which on a body misses less than [`MISSED`] of its volume wherever it lies: they are not counted.
const MANY: f64 = 1e6;

/// Part by which the particles of a lattice hold more than the volume.
fn missed(shape: &Shape, pitch: [f64; 3], anchor: Option<[f64; 3]>, volume: f64) -> f64 {
    if shape.sites(pitch).iter().product::<f64>() > MANY {
        return 0.0;
    }
    let cell: f64 = pitch.iter().product();
    shape.points(pitch, anchor).len() as f64 * cell / volume - 1.0
}

/// Where the lattice of a round body begins \[m\]; none where it begins at the corner of its box.
fn anchor(shape: &Shape, pitch: [f64; 3]) -> Option<[f64; 3]> {
    let (centre, volume) = shape.round()?;
    let own = missed(shape, pitch, None, volume);
    if own.abs() <= MISSED {
        return None;
    }
    let along = shape.sides();
    let (corner, _) = shape.bounds();
    // The centre is the middle of a cell or its edge, along each axis that is not filled from end to end.
    let places = (0..8).map(|n| {
        [0, 1, 2].map(|k| match along[k] {
            Some(_) => corner[k],
            None => centre[k] - 0.5 * f64::from(n >> k & 1) * pitch[k],
        })
    });
    let tried = places.map(|place| (place, missed(shape, pitch, Some(place), volume).abs()));
    let best = tried.min_by(|a, b| a.1.total_cmp(&b.1))?;
    (best.1 < own.abs()).then_some(best.0)
}

/// The stretch along each axis with which the particles of a round body hold its volume; 1 where they do within half a percent,
/// or miss too much. A bar keeps its length.
fn stretch(shape: &Shape, pitch: [f64; 3], anchor: Option<[f64; 3]>) -> [f64; 3] {
    let Some((_, volume)) = shape.round() else {
        return NONE;
    };
    let off = missed(shape, pitch, anchor, volume);
    let along = shape.sides();
    let free = along.iter().filter(|side| side.is_none()).count();
    let stretch = (1.0 + off).powf(-1.0 / free as f64);
    if off.abs() <= MISSED || (stretch - 1.0).abs() > STRETCH {
        return NONE;
    }
    along.map(|side| if side.is_none() { stretch } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::shape::edge;
    use shapes::Axis;
    use shapes::shape::{Cylinder, EllipsoidShape, Sphere};

    const D: f64 = 5e-4;

    fn shapes(radius: f64) -> [Shape; 3] {
        let centre_m = vec![1e-3, 2e-3, 3.3e-3];
        [
            Shape::Sphere(Sphere {
                name: None,
                centre_m: centre_m.clone(),
                radius_m: radius,
            }),
            Shape::Ellipsoid(EllipsoidShape {
                name: None,
                centre_m: centre_m.clone(),
                semi_axes_m: vec![0.8 * radius, 1.2 * radius, radius],
            }),
            Shape::Cylinder(Cylinder {
                name: None,
                centre_m,
                axis: Axis::Y,
                radius_m: radius,
                length_m: 20.0 * D,
            }),
        ]
    }

    #[test]
    fn a_lone_round_body_holds_its_volume() {
        for radius in (0..60).map(|n| (3.0 + 0.11 * f64::from(n)) * D) {
            for shape in shapes(radius) {
                let pitch = [D, 1.01 * D, 0.98 * D].map(|d| if radius > 6.0 * D { D } else { d });
                let round = Round::of(&shape, pitch);
                let (centre, volume) = shape.round().unwrap();
                let points = round.points(&shape, pitch, None);
                let held = points.len() as f64
                    * edge([0, 1, 2].map(|k| pitch[k] * round.stretch[k])).powi(3);
                assert!((held / volume - 1.0).abs() <= MISSED, "{shape:?}");
                // The body stays where it is, but for the corner's lattice.
                let middle: [f64; 3] = std::array::from_fn(|k| {
                    points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64
                });
                let off = (0..3).map(|k| (middle[k] - centre[k]).abs());
                assert!(off.fold(0.0, f64::max) < 0.25 * D, "{middle:?}");
            }
        }
    }

    #[test]
    fn what_holds_its_volume_keeps_the_lattice_of_its_corner() {
        let mut kept = 0;
        for radius in (0..60).map(|n| (3.0 + 0.11 * f64::from(n)) * D) {
            for shape in shapes(radius) {
                let own = missed(&shape, [D; 3], None, shape.round().unwrap().1);
                let round = Round::of(&shape, [D; 3]);
                assert_eq!(round == Round::default(), own.abs() <= MISSED);
                kept += u32::from(round == Round::default());
            }
        }
        assert!((1..180).contains(&kept), "{kept}");
    }
}
