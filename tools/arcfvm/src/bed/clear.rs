//! How the heat in and around a bed of clear slag answers to temperatures.
//!
//! Slag that is clear conducts some forty times as well as the flux that it melts from. In and around such a bed the equation of
//! the energy takes the change of the heat along (Newton),
//!
//! ```text
//! q = G (T_P - T_E) + dq/dT_P dT_P + dq/dT_E dT_E,   dq/dT_P = k(T_P)/d between cells of the bed
//! ```
//!
//! and a cell that would pass an end of its melting range stops there for an iteration, where the slopes are others. With the mean G
//! in place of both slopes a cell that has just melted answers as many times too far as its slag conducts better than the mean.

use crate::case::Case;
use crate::equation::faces::FaceOf;
use crate::grid::{FaceIndex, Grid};

/// How far past an end of its melting range a cell goes at once, as part of half of the range.
const PAST: f64 = 0.1;

/// How the heat through faces in and around a clear bed changes with the temperatures of the two cells, that at the smaller radius
/// or height first \[W/K\]; none elsewhere, and where metal moves.
#[derive(Debug, Clone)]
pub(crate) struct Slopes {
    pub(crate) radial: Vec<Option<[f64; 2]>>,
    pub(crate) axial: Vec<Option<[f64; 2]>>,
}

impl Slopes {
    /// Of a grid, none known.
    pub(crate) fn new(grid: &Grid) -> Self {
        Self {
            radial: vec![None; grid.radial_faces()],
            axial: vec![None; grid.axial_faces()],
        }
    }

    /// Of a face as its cell sees it: with its own temperature, and with that beyond.
    pub(crate) fn seen(&self, face: &FaceOf) -> Option<[f64; 2]> {
        let [first, second] = match face.at {
            FaceIndex::Radial(at) => self.radial[at],
            FaceIndex::Axial(at) => self.axial[at],
        }?;
        Some(if face.before {
            [second, first]
        } else {
            [first, second]
        })
    }
}

/// Change of the temperature of cell `k` from `old` \[K\]: as `wanted`, but in a clear bed no farther than just past an end of the
/// melting range.
pub(crate) fn to_the_bend(case: &Case, k: usize, old: f64, wanted: f64) -> f64 {
    let bed = case.clear_bed();
    let bed = bed.filter(|bed| bed.material == case.material[k]);
    let Some((melting, half)) = bed.and_then(|bed| Some((bed.melting, bed.melts_within?))) else {
        return wanted;
    };
    let past = PAST * half;
    [melting - half, melting + half]
        .into_iter()
        .filter(|end| (old - end).abs() > past && (old - end) * (old + wanted - end) < 0.0)
        .map(|end| end - old + past.copysign(wanted))
        .fold(
            wanted,
            |least, way| if way.abs() < least.abs() { way } else { least },
        )
}
