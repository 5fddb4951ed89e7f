//! Patches as flat pieces over which a property has a mean.

use crate::cloud::Patch;
use crate::source::cubature::Piece;
use shapes::frame::Frame;

/// A patch as a line or a square that touches the surface.
pub(super) fn tangent(patch: &Patch, dimensions: usize) -> Piece {
    let [first, second, _] = Frame::facing(patch.place, patch.normal).axes;
    let size = 0.5 * patch.area.powf(1.0 / (dimensions - 1) as f64);
    let [x, y, _] = patch.normal;
    let half = if dimensions == 2 {
        [[-y, x, 0.0], [0.0; 3], [0.0; 3]]
    } else {
        [first, second, [0.0; 3]]
    };
    Piece {
        centre: patch.place,
        half: half.map(|axis| axis.map(|c| size * c)),
        rank: dimensions - 1,
    }
}
