//! What tells whether grains rest: how far they go, and what pulls on those that sleep.

use shapes::frame::{along, difference, dot};

use super::depth::BORDER;
use super::moving::{Moving, greater};

impl Moving {
    /// Whether a grain of an awake cell, or its surface by its turning, has gone farther than `most` \[m\] since it was looked at; `dt` \[s\]
    /// have gone by since the last question.
    pub fn gone(&mut self, cell: usize, dt: f64, most: f64) -> bool {
        let rows = self.cell(cell);
        let [watched, turned, _] = &mut self.watched;
        let (then, turned) = (&watched[rows.clone()], &mut turned[rows.clone()]);
        let mut gone = false;
        for ((grain, then), turned) in self.grains[rows].iter().zip(then).zip(turned) {
            *turned = along(*turned, dt, grain.spin);
            let way = difference(grain.position, *then);
            let rolled = grain.radius * grain.radius * dot(*turned, *turned);
            // What is no number has gone.
            let near = dot(way, way) < most * most && rolled < most * most;
            gone |= !near;
        }
        gone
    }

    /// Adds the pull of a step of `step` \[s\] on the cells that sleep beside others that are awake.
    pub fn feel(&mut self, step: f64, depth: &[u8]) {
        for cell in (0..depth.len()).filter(|cell| depth[*cell] == BORDER) {
            for row in self.cell(cell) {
                let pull = along(self.gravity, 1.0 / self.grains[row].mass, self.force[row]);
                self.watched[2][row] = along(self.watched[2][row], step, pull);
            }
        }
    }

    /// The greatest pull on a grain of a cell since it was looked at \[m/s\].
    #[must_use]
    pub fn pulled(&self, cell: usize) -> f64 {
        let pulls = self.watched[2][self.cell(cell)].iter();
        pulls
            .map(|pull| dot(*pull, *pull))
            .fold(0.0, greater)
            .sqrt()
    }

    /// Looks at a cell from now on.
    pub fn look_again(&mut self, cell: usize) {
        let rows = self.cell(cell);
        let grains = &self.grains[rows.clone()];
        let [watched, turned, pull] = &mut self.watched;
        for (then, grain) in watched[rows.clone()].iter_mut().zip(grains) {
            *then = grain.position;
        }
        turned[rows.clone()].fill([0.0; 3]);
        pull[rows].fill([0.0; 3]);
    }
}
