//! What tells whether grains rest: how far they go.

use shapes::frame::{along, difference, dot};

use super::greater::greater;
use super::moving::Moving;

/// How far the grains of a cell have gone, or their surfaces by their turning \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way {
    /// In the mean.
    pub mean: f64,
    /// The farthest; no number where one is none.
    pub greatest: f64,
}

impl Moving {
    /// How far the grains of a cell have gone since it was looked at; `dt` \[s\] have gone by since the last question.
    pub fn way(&mut self, cell: usize, dt: f64) -> Way {
        let rows = self.cell(cell);
        let number = rows.len().max(1) as f64;
        let [watched, turned] = &mut self.watched;
        let (then, turned) = (&watched[rows.clone()], &mut turned[rows.clone()]);
        let (mut sum, mut greatest) = (0.0, 0.0);
        for ((grain, then), turned) in self.grains[rows].iter().zip(then).zip(turned) {
            *turned = along(*turned, dt, grain.spin);
            let way = difference(grain.position, *then);
            let rolled = grain.radius * grain.radius * dot(*turned, *turned);
            let far = greater(dot(way, way), rolled).sqrt();
            sum += far;
            greatest = greater(greatest, far);
        }
        Way {
            mean: sum / number,
            greatest,
        }
    }

    /// Looks at a cell from now on.
    pub fn look_again(&mut self, cell: usize) {
        let rows = self.cell(cell);
        let grains = &self.grains[rows.clone()];
        let [watched, turned] = &mut self.watched;
        for (then, grain) in watched[rows.clone()].iter_mut().zip(grains) {
            *then = grain.position;
        }
        turned[rows].fill([0.0; 3]);
    }

    /// Stops the grains of a cell; gives the kinetic energy that they had \[J\].
    pub fn stop(&mut self, cell: usize) -> f64 {
        let rows = self.cell(cell);
        let c = self.inertia_factor;
        let mut taken = 0.0;
        for grain in &mut self.grains[rows] {
            let turning = c * grain.radius * grain.radius * dot(grain.spin, grain.spin);
            taken += 0.5 * grain.mass * (dot(grain.velocity, grain.velocity) + turning);
            (grain.velocity, grain.spin) = ([0.0; 3], [0.0; 3]);
        }
        taken
    }
}
