//! A look before a run: the bodies, points and conditions that would be there, and the ways of what moves.
//!
//! `TOOL check SCENE.json --points FILE.mcap` writes them as an artefact of kind `preview`: the frame `/points` with the place,
//! size, material and condition of each point, and `/look` with the names of materials and conditions and the marks (axis of
//! the arc, path of the weld, way of the droplets, faces, coils, walls). `report preview` draws them.

use artefact::{Frame, Precision, Version};
use serde::{Deserialize, Serialize};

/// Kind of the artefact.
pub const KIND: &str = "preview";
/// Version of the kind.
pub const VERSION: Version = Version::new(1, 0);
/// Channel of the points.
pub const POINTS: &str = "/points";
/// Channel of names and marks.
pub const LOOK: &str = "/look";
/// JSON Schema of `/look`.
pub(crate) const SCHEMA: (&str, &str) = (
    "fusionline.look.v1",
    include_str!("../../../../schemas/look.v1.json"),
);

/// Most places that are looked at for the layer of a wall.
const SITES: f64 = 1e6;
/// Thickness of the layer of a wall that is shown, in spacings.
const LAYER: f64 = 2.0;

/// What the three coordinates of places mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Coordinates {
    /// x, y and z.
    #[default]
    Space,
    /// x and y of a plane scene; z is 0.
    Plane,
    /// x is the radius and z the height about an axis; y is 0.
    Axisymmetric,
}

/// What a mark shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Marked {
    /// The axis of the arc, or of a nozzle.
    Axis,
    /// Where the source goes.
    Path,
    /// The way of droplets, or of a jet.
    Droplets,
    /// A condition on a face.
    Condition,
    /// An edge of a wall, or of a box in which something is followed.
    Wall,
    /// A conductor with a given current.
    Coil,
    /// A place whose values are written.
    Probe,
}

/// Lines with a name. A line of one point is a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// What it is called in the legend.
    pub name: String,
    /// What it shows.
    pub kind: Marked,
    /// Corners of each line \[m\].
    pub lines_m: Vec<Vec<[f64; 3]>>,
}

/// Names and marks, as `/look` tells them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Look {
    /// What coordinates mean.
    pub coordinates: Coordinates,
    /// Names of materials: a point of material `k` has the name `materials[k]`.
    pub materials: Vec<String>,
    /// Names of conditions: a point of condition `k` above 0 has the name `conditions[k - 1]`, one of 0 has none.
    pub conditions: Vec<String>,
    /// Marks.
    pub marks: Vec<Mark>,
}

/// A point, particle or cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Place of its middle \[m\].
    pub place: [f64; 3],
    /// Its extent along x, y, z \[m\].
    pub size: [f64; 3],
    /// Number of its material, as [`Preview::material`] gave it.
    pub material: u32,
    /// Number of its condition, as [`Preview::condition`] gave it; 0 without one.
    pub condition: u32,
}

/// What would be there when a run begins.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Preview {
    /// Names and marks.
    pub look: Look,
    spots: Vec<Spot>,
}

impl Preview {
    /// Nothing yet.
    #[must_use]
    pub fn new(coordinates: Coordinates) -> Self {
        let look = Look {
            coordinates,
            ..Look::default()
        };
        Self {
            look,
            spots: Vec::new(),
        }
    }

    /// The number of a material.
    pub fn material(&mut self, name: &str) -> u32 {
        numbered(&mut self.look.materials, name)
    }

    /// The number of a condition; above 0.
    pub fn condition(&mut self, name: &str) -> u32 {
        1 + numbered(&mut self.look.conditions, name)
    }

    /// Adds a point.
    pub fn spot(&mut self, spot: Spot) {
        self.spots.push(spot);
    }

    /// All points.
    #[must_use]
    pub fn spots(&self) -> &[Spot] {
        &self.spots
    }

    /// Adds a mark.
    pub fn mark(&mut self, kind: Marked, name: &str, lines_m: Vec<Vec<[f64; 3]>>) {
        self.look.marks.push(Mark {
            name: name.to_owned(),
            kind,
            lines_m,
        });
    }

    /// Adds the layer of a wall that faces a box, two spacings thick: places of a lattice in the box that lie in the wall, by the
    /// distance from its surface, negative inside. Where the box is large the lattice is wider than the spacing \[m\].
    pub fn wall(
        &mut self,
        name: &str,
        within: [[f64; 3]; 2],
        spacing: f64,
        distance: impl Fn([f64; 3]) -> f64,
    ) {
        let [low, high] = within;
        let flat = |k: usize| high[k] <= low[k];
        let rank = (0..3).filter(|k| !flat(*k)).count().max(1);
        let extent = |k: usize| if flat(k) { 1.0 } else { high[k] - low[k] };
        let room = extent(0) * extent(1) * extent(2);
        let wide = (room / SITES).powf(1.0 / rank as f64).max(spacing);
        let counts: [usize; 3] = std::array::from_fn(|k| match flat(k) {
            true => 1,
            false => (extent(k) / wide).ceil() as usize,
        });
        let material = self.material(name);
        for site in 0..counts.iter().product() {
            let at = [
                site % counts[0],
                site / counts[0] % counts[1],
                site / (counts[0] * counts[1]),
            ];
            let place = std::array::from_fn(|k| match flat(k) {
                true => low[k],
                false => low[k] + (at[k] as f64 + 0.5) * wide,
            });
            if (-LAYER * wide..0.0).contains(&distance(place)) {
                self.spot(Spot {
                    place,
                    size: std::array::from_fn(|k| if flat(k) { 0.0 } else { wide }),
                    material,
                    condition: 0,
                });
            }
        }
    }

    /// Lower and upper corner of the box around all points \[m\]; none without points.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let around = |spot: &Spot| {
            let half = |k: usize, side: f64| spot.place[k] + 0.5 * side * spot.size[k];
            [-1.0, 1.0].map(|side| std::array::from_fn(|k| half(k, side)))
        };
        let wider = |[low, high]: [[f64; 3]; 2], [from, to]: [[f64; 3]; 2]| {
            [
                std::array::from_fn(|k| low[k].min(from[k])),
                std::array::from_fn(|k| high[k].max(to[k])),
            ]
        };
        self.spots.iter().map(around).reduce(wider)
    }

    pub(crate) fn frame(&self) -> Frame {
        let spots = || self.spots.iter();
        Frame::new(Precision::F32)
            .positions(spots().map(|spot| spot.place))
            .vector("size", "m", spots().map(|spot| spot.size))
            .id("material", spots().map(|spot| spot.material))
            .id("condition", spots().map(|spot| spot.condition))
    }
}

/// The outline of an upright box: all of its edges.
#[must_use]
pub fn edges([low, high]: [[f64; 3]; 2]) -> Vec<Vec<[f64; 3]>> {
    let ring = |z: f64| {
        let corners = [
            [low[0], low[1]],
            [high[0], low[1]],
            [high[0], high[1]],
            [low[0], high[1]],
            [low[0], low[1]],
        ];
        corners.map(|[x, y]| [x, y, z]).to_vec()
    };
    if high[2] <= low[2] {
        return vec![ring(low[2])];
    }
    let posts = ring(low[2])
        .into_iter()
        .take(4)
        .map(|[x, y, z]| vec![[x, y, z], [x, y, high[2]]]);
    [ring(low[2]), ring(high[2])]
        .into_iter()
        .chain(posts)
        .collect()
}

/// The outline of a face of an upright box: across an axis, the upper one or the lower.
#[must_use]
pub fn face([low, high]: [[f64; 3]; 2], axis: usize, upper: bool) -> Vec<Vec<[f64; 3]>> {
    let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
    let corner = |first: f64, second: f64| {
        let mut place = low;
        place[axis] = if upper { high[axis] } else { low[axis] };
        place[a] = first;
        place[b] = second;
        place
    };
    vec![vec![
        corner(low[a], low[b]),
        corner(high[a], low[b]),
        corner(high[a], high[b]),
        corner(low[a], high[b]),
        corner(low[a], low[b]),
    ]]
}

fn numbered(names: &mut Vec<String>, name: &str) -> u32 {
    let found = names.iter().position(|known| known == name);
    let number = found.unwrap_or_else(|| {
        names.push(name.to_owned());
        names.len() - 1
    });
    u32::try_from(number).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_numbered_once_and_places_bounded() {
        let mut preview = Preview::new(Coordinates::Space);
        assert_eq!(preview.bounds(), None);
        let [a, b, again] = ["a", "b", "a"].map(|name| preview.material(name));
        assert_eq!([a, b, again], [0, 1, 0]);
        assert_eq!(preview.condition("held"), 1);
        for x in [0.0, 4.0] {
            preview.spot(Spot {
                place: [x, 1.0, 0.0],
                size: [2.0, 2.0, 0.0],
                material: a,
                condition: 0,
            });
        }
        let around = [[-1.0, 0.0, 0.0], [5.0, 2.0, 0.0]];
        assert_eq!(preview.bounds(), Some(around));
    }

    #[test]
    fn a_wall_shows_the_layer_that_faces_the_box() {
        let mut preview = Preview::new(Coordinates::Plane);
        let within = [[0.0; 3], [1.0, 1.0, 0.0]];
        preview.wall("floor", within, 0.1, |place| place[1] - 0.25);
        let heights: Vec<f64> = preview.spots().iter().map(|spot| spot.place[1]).collect();
        assert_eq!(heights.len(), 20);
        assert!(heights.iter().all(|y| (0.05..0.25).contains(y)));
    }

    #[test]
    fn outlines_lie_on_their_box() {
        let around = [[0.0; 3], [1.0, 2.0, 3.0]];
        assert_eq!(edges(around).len(), 6);
        assert_eq!(edges([[0.0; 3], [1.0, 2.0, 0.0]]).len(), 1);
        for axis in 0..3 {
            for upper in [false, true] {
                let lines = face(around, axis, upper);
                let at = if upper { around[1][axis] } else { 0.0 };
                let off = lines[0].iter().map(|place| (place[axis] - at).abs());
                assert!(off.fold(0.0, f64::max) < 1e-15);
                assert_eq!(lines[0].first(), lines[0].last());
            }
        }
    }
}
