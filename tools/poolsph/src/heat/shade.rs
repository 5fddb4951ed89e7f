//! What of the surface a torch sees that does not shine straight down, and what lies in the shade.
//!
//! A particle b stands before a, as the torch sees them, where it is no farther aside than 0.75 d and lies in front of a: nearer
//! to the torch by t along its way, and by as much above the plane of the surface at a. What is in front by a layer
//! is the same surface; from 1.75 d on it hides what is behind. From above, the columns of the surface do the same.

use std::collections::HashMap;

use shapes::frame::{difference, dot, squared};
use torch::Stand;

/// No farther aside than this stands what is before a particle, in spacings.
const ASIDE: f64 = 0.75;
/// In front by this much, in spacings, a particle begins to hide another, and does so wholly.
const HIDES: [f64; 2] = [1.0, 1.75];

/// The surface as a torch sees it.
pub(super) struct Shade {
    into: [f64; 3],
    axes: [[f64; 3]; 2],
    d: f64,
    /// Places in cells of the edge d across the way of the torch.
    cells: HashMap<[i64; 2], Vec<[f64; 3]>>,
}

impl Shade {
    /// Of a surface at the places `surface`, of particles `d` \[m\] apart.
    pub(super) fn of(surface: impl Iterator<Item = [f64; 3]>, stand: &Stand, d: f64) -> Self {
        let [ahead, across, into] = stand.axes;
        let mut shade = Self {
            into,
            axes: [ahead, across],
            d,
            cells: HashMap::new(),
        };
        for x in surface {
            shade.cells.entry(shade.cell(x)).or_default().push(x);
        }
        shade
    }

    /// Part of the surface at `x` with the outward normal `normal` that the torch sees, 0 to 1.
    pub(super) fn seen(&self, x: [f64; 3], normal: [f64; 3]) -> f64 {
        let [i, j] = self.cell(x);
        let around = (-1..=1).flat_map(|p| (-1..=1).map(move |q| [i + p, j + q]));
        let others = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        let front = others.fold(0.0_f64, |most, other| {
            let way = difference(*other, x);
            let nearer = -dot(way, self.into);
            let aside = squared(way) - nearer * nearer;
            if aside > (ASIDE * self.d).powi(2) {
                return most;
            }
            most.max(nearer.min(dot(way, normal)))
        });
        let [from, to] = HIDES;
        ((to - front / self.d) / (to - from)).clamp(0.0, 1.0)
    }

    fn cell(&self, x: [f64; 3]) -> [i64; 2] {
        self.axes.map(|axis| (dot(x, axis) / self.d).floor() as i64)
    }
}
