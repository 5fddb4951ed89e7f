//! One frame of particles, seen from the source.

use neighbours::Grid;

/// Particles of one frame in the frame of reference that moves with the source: x and y count from
/// the source, z from the original surface of the plate, velocities are relative to the source.
#[derive(Debug, Clone, Default)]
pub struct Cloud {
    /// Position \[m\], `[n][3]`.
    pub position: Vec<[f64; 3]>,
    /// Velocity relative to the source \[m/s\], `[n][3]`.
    pub velocity: Vec<[f64; 3]>,
    /// Temperature \[K\], `[n]`; `None` when the frames carry none.
    pub temperature: Option<Vec<f64>>,
    /// Liquid now, `[n]`.
    pub liquid: Vec<bool>,
}

impl Cloud {
    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// True without particles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Moves the cloud into the frame of a source at `place` \[m\] (its x and y) with `velocity`
    /// \[m/s\].
    pub fn follow(&mut self, place: [f64; 2], velocity: [f64; 3]) {
        for x in &mut self.position {
            x[0] -= place[0];
            x[1] -= place[1];
        }
        for u in &mut self.velocity {
            for k in 0..3 {
                u[k] -= velocity[k];
            }
        }
    }

    /// Adds the image of half a weld beyond the plane at `x` \[m\].
    pub fn complete(&mut self, x: f64) {
        let images: Vec<_> = self
            .position
            .iter()
            .map(|p| [2.0 * x - p[0], p[1], p[2]])
            .collect();
        self.position.extend(images);
        let turned: Vec<_> = self.velocity.iter().map(|u| [-u[0], u[1], u[2]]).collect();
        self.velocity.extend(turned);
        self.liquid.extend_from_within(..);
        self.temperature
            .iter_mut()
            .for_each(|t| t.extend_from_within(..));
    }

    /// Removes what is in flight: liquid that no chain of particles, each closer than `link` \[m\]
    /// to the next, joins to solid metal. Without solid metal nothing is removed.
    pub fn land(&mut self, link: f64) {
        if self.liquid.iter().all(|liquid| *liquid) {
            return;
        }
        let joined = self.joined(link);
        self.retain(&joined);
    }

    /// Keeps the particles whose flag is set.
    pub fn retain(&mut self, flags: &[bool]) {
        keep(&mut self.position, flags);
        keep(&mut self.velocity, flags);
        keep(&mut self.liquid, flags);
        if let Some(temperature) = &mut self.temperature {
            keep(temperature, flags);
        }
    }

    fn joined(&self, link: f64) -> Vec<bool> {
        let mut grid = Grid::new(link);
        grid.bin(&self.position);
        let mut joined: Vec<bool> = self.liquid.iter().map(|liquid| !liquid).collect();
        let mut open: Vec<usize> = (0..self.len()).filter(|a| joined[*a]).collect();
        while let Some(a) = open.pop() {
            let at = self.position[a];
            grid.runs(at, link, |run| {
                for k in run {
                    let b = grid.order()[k] as usize;
                    if !joined[b] && distance(at, grid.sorted()[k]) < link {
                        joined[b] = true;
                        open.push(b);
                    }
                }
            });
        }
        joined
    }
}

/// Keeps the entries whose flag is set.
fn keep<T>(values: &mut Vec<T>, flags: &[bool]) {
    let mut flags = flags.iter();
    values.retain(|_| flags.next().is_some_and(|flag| *flag));
}

/// Distance of two points \[m\].
pub(crate) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dx = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    (dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(points: &[([f64; 3], bool)]) -> Cloud {
        Cloud {
            position: points.iter().map(|p| p.0).collect(),
            velocity: vec![[1.0, 2.0, 3.0]; points.len()],
            temperature: Some(vec![300.0; points.len()]),
            liquid: points.iter().map(|p| p.1).collect(),
        }
    }

    #[test]
    fn a_drop_in_flight_is_left_out_and_the_pool_stays() {
        let mut c = cloud(&[
            ([0.0, 0.0, 0.0], false),
            ([0.0, 0.0, 1.0], true),
            ([0.0, 0.0, 2.0], true),
            ([0.0, 0.0, 5.0], true),
            ([0.0, 0.0, 6.0], true),
        ]);
        c.land(1.5);
        assert_eq!(c.len(), 3);
        assert_eq!((c.velocity.len(), c.liquid.len()), (3, 3));
        assert_eq!(c.temperature.as_ref().unwrap().len(), 3);
        assert!(c.position.iter().all(|x| x[2] < 3.0));
    }

    #[test]
    fn the_image_of_a_half_moves_the_other_way() {
        let mut c = cloud(&[([3.0, 7.0, 1.0], true)]);
        c.complete(1.0);
        assert_eq!(c.position, vec![[3.0, 7.0, 1.0], [-1.0, 7.0, 1.0]]);
        assert_eq!(c.velocity, vec![[1.0, 2.0, 3.0], [-1.0, 2.0, 3.0]]);
        assert_eq!((c.liquid.len(), c.temperature.unwrap().len()), (2, 2));
    }

    #[test]
    fn the_moving_frame_removes_the_translation() {
        let mut c = cloud(&[([3.0, 7.0, 1.0], true)]);
        c.follow([3.0, 5.0], [1.0, 2.0, 0.0]);
        assert_eq!(c.position, vec![[0.0, 2.0, 1.0]]);
        assert_eq!(c.velocity, vec![[0.0, 0.0, 3.0]]);
    }
}
