//! Points that fill a room: on the free face, on walls, inside.

use super::{Room, Side};
use crate::cloud::jitter::signed;
use crate::liquid::fill::Filled;

impl<const D: usize> Room<D> {
    /// Even coordinates along an axis: a spacing from faces with points, half of one from the others.
    fn nodes(&self, axis: usize, spacing: f64) -> Vec<f64> {
        let off = self.sides[axis].map(|s| if s.bears() { 1.0 } else { 0.5 });
        let length = self.length(axis);
        let count = (length / spacing + 1.0 - off[0] - off[1]).round().max(1.0);
        let apart = length / (count - 1.0 + off[0] + off[1]);
        (0..count as usize)
            .map(|k| self.min[axis] + apart * (k as f64 + off[0]))
            .collect()
    }

    /// Half a spacing from the edges of a face.
    fn across(&self, axis: usize, spacing: f64) -> Vec<f64> {
        let count = (self.length(axis) / spacing).round().max(1.0);
        let apart = self.length(axis) / count;
        (0..count as usize)
            .map(|k| self.min[axis] + apart * (k as f64 + 0.5))
            .collect()
    }
}

/// Fills a room with points at about `spacing` \[m\], each shifted by at most the part `jitter` of it along each axis, or along the
/// face on which it lies; those on the free face come first, then those on walls.
#[must_use]
pub fn furnish<const D: usize>(
    room: &mut Room<D>,
    spacing: f64,
    jitter: f64,
    seed: u64,
) -> Filled<D> {
    let mut position = Vec::new();
    let mut shifted = |mut x: [f64; D], fixed: Option<usize>| {
        let number = position.len() as u64;
        for (k, c) in x.iter_mut().enumerate() {
            if fixed != Some(k) {
                *c += jitter * spacing * signed(seed, number, k as u64);
            }
        }
        position.push(x);
    };
    let (mut normal, mut held) = (Vec::new(), Vec::new());
    for walls in [false, true] {
        for (axis, sides) in room.sides.iter().enumerate() {
            for (side, what) in sides.iter().enumerate() {
                if !what.bears() || walls != matches!(what, Side::Wall(_)) {
                    continue;
                }
                let at = [room.min, room.max][side][axis];
                let lines: [Vec<f64>; D] = std::array::from_fn(|k| match k == axis {
                    true => vec![at],
                    false => room.across(k, spacing),
                });
                let mut out = [0.0; D];
                out[axis] = [-1.0, 1.0][side];
                for x in product(&lines) {
                    shifted(x, Some(axis));
                    (if walls { &mut held } else { &mut normal }).push(out);
                }
            }
        }
    }
    let lines: [Vec<f64>; D] = std::array::from_fn(|k| room.nodes(k, spacing));
    for x in product(&lines) {
        shifted(x, None);
    }
    room.held = held;
    Filled { position, normal }
}

/// All places with one coordinate of each line.
fn product<const D: usize>(lines: &[Vec<f64>; D]) -> Vec<[f64; D]> {
    let mut places = vec![[0.0; D]];
    for (k, line) in lines.iter().enumerate() {
        let longer = places.iter().flat_map(|x| {
            line.iter().map(move |c| {
                let mut x = *x;
                x[k] = *c;
                x
            })
        });
        places = longer.collect();
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stand_a_spacing_from_walls_and_half_of_one_from_mirrors() {
        let mut room = Room::<2> {
            min: [0.0, 0.0],
            max: [1.0, 0.5],
            sides: [[Side::Mirror; 2], [Side::Wall([0.0, 0.0]), Side::Open]],
            ..Room::default()
        };
        let filled = furnish(&mut room, 0.1, 0.0, 0);
        assert_eq!((filled.normal.len(), room.held.len()), (10, 10));
        assert_eq!(filled.position.len(), 20 + 10 * 4);
        assert!(
            (filled.position[0][1] - 0.5).abs() < 1e-12 && filled.position[10][1].abs() < 1e-12
        );
        assert!((filled.position[20][0] - 0.05).abs() < 1e-12);
        assert!((filled.position[20][1] - 0.1).abs() < 1e-12);
        assert!(room.held[0][1] < 0.0 && filled.normal[0][1] > 0.0);
    }
}
