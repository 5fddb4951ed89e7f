//! Where arcs stand in a step, and how strongly they burn there.
//!
//! An arc that goes farther than a part of a spacing within a step burns at several places of its way in turn, each for the same
//! time: else a fast one would leave spots.

use super::Burner;
use crate::source::Place;

/// Way between two places, in spacings.
const APART: f64 = 0.5;
/// Most places.
const MOST: f64 = 1000.0;

/// An arc at a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stand {
    /// Number of the arc.
    pub(super) arc: usize,
    pub(super) axis: [f64; 3],
    /// Its level, over the number of places.
    pub(super) level: f64,
}

impl Stand {
    /// Square of the distance of a place from the axis \[m2\].
    pub(super) fn square(&self, [x, y]: [f64; 2]) -> f64 {
        let (dx, dy) = (x - self.axis[0], y - self.axis[1]);
        dx * dx + dy * dy
    }
}

/// Where all arcs stand from `time` on over `dt` \[s\], arc by arc; those that rest for it, or hardly move, stand where they are
/// at its end. False where they go too far to be followed.
pub(super) fn stands(
    arcs: &[Burner],
    source: Option<Place>,
    [time, dt]: [f64; 2],
    spacing: f64,
    stands: &mut Vec<Stand>,
) -> bool {
    let [position, way] = source.map_or([[0.0; 3]; 2], |source| [source.position, source.way]);
    let wanted = (way[0].hypot(way[1]) / (APART * spacing)).ceil().max(1.0);
    let places = wanted.min(MOST);
    stands.clear();
    for (arc, burner) in arcs.iter().enumerate() {
        let end = burner.burning.axis(position);
        let level = burner.burning.level(time, dt) / places;
        if places <= 1.0 {
            stands.push(Stand {
                arc,
                axis: end,
                level,
            });
            continue;
        }
        stands.extend((0..places as u32).map(|k| {
            let left = 1.0 - (f64::from(k) + 0.5) / places;
            let axis = std::array::from_fn(|i| end[i] - left * way[i]);
            Stand { arc, axis, level }
        }));
    }
    wanted <= MOST
}
