//! Nested lattices: a cubic one, every second point of it (face-centred; a chessboard in two dimensions), the cubic
//! one of twice the spacing, and so on outward. Each is part of the one before it, so that points of different
//! lattices never come near each other.

use rayon::prelude::*;
use shapes::frame::{Vector, difference, length};

use super::layout::{Layout, Wall};

/// A node of a lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Node {
    pub(crate) place: Vector,
    /// Spacing of the lattice there \[m\]: that of as many points on a cubic one.
    pub(crate) spacing: f64,
    /// Number of the wall on which it lies.
    pub(crate) face: Option<u8>,
}

/// Places of the finest lattice, by number along each axis.
#[derive(Debug, Clone, Copy)]
struct Frame {
    origin: Vector,
    step: Vector,
    /// Last number along each axis.
    last: [i64; 3],
    /// Doublings from the finest to the coarsest lattice.
    doublings: u32,
}

impl Frame {
    fn new(layout: &Layout) -> Self {
        let h = layout.spacing;
        let doublings = (layout.largest / h).log2().max(0.0).floor() as u32;
        let block = (1_i64 << doublings) as f64;
        let mut frame = Self {
            origin: [0.0; 3],
            step: [h; 3],
            last: [0; 3],
            doublings,
        };
        for k in 0..layout.dimensions {
            match &layout.wall {
                Wall::Box { low, high, .. } => {
                    let size = high[k] - low[k];
                    let blocks = (size / (h * block)).round().max(1.0);
                    frame.last[k] = (blocks * block) as i64;
                    frame.step[k] = size / (blocks * block);
                    frame.origin[k] = low[k];
                }
                Wall::Ball { centre, radius } => {
                    let blocks = (radius / (h * block)).ceil();
                    let half = if layout.axisymmetric() && k == 0 {
                        0.0
                    } else {
                        blocks
                    };
                    frame.last[k] = ((blocks + half) * block) as i64;
                    frame.origin[k] = centre[k] - half * block * h;
                }
            }
        }
        frame
    }

    fn place(&self, n: [i64; 3], layout: &Layout) -> Vector {
        let mut x: Vector = std::array::from_fn(|k| self.origin[k] + n[k] as f64 * self.step[k]);
        // Walls exactly where the scene has them.
        if let Wall::Box { high, .. } = &layout.wall {
            for k in 0..layout.dimensions {
                if n[k] == self.last[k] {
                    x[k] = high[k];
                }
            }
        }
        x
    }
}

/// How often the spacing has grown by the square root of 2 up to the coarsest lattice of which a node is part.
fn rank(n: [i64; 3]) -> u32 {
    let all = n[0] | n[1] | n[2];
    if all == 0 {
        return u32::MAX;
    }
    let zeros = all.trailing_zeros();
    let odd = n.iter().map(|i| i >> zeros & 1).sum::<i64>();
    2 * zeros + u32::from(odd == 2)
}

/// The spacing that is wanted nearest to a place within a reach of it \[m\].
pub(crate) type Wanted<'a> = &'a (dyn Fn(Vector, f64) -> f64 + Sync);

struct Descent<'a> {
    layout: &'a Layout,
    wanted: Wanted<'a>,
    frame: Frame,
}

impl Descent<'_> {
    /// Rank of the lattice of a wanted spacing.
    fn rank_of(&self, spacing: f64) -> u32 {
        let least = (0..self.layout.dimensions).map(|k| self.frame.step[k]);
        let h = least.fold(f64::INFINITY, f64::min);
        let steps = (2.0 * (spacing / h).log2() + 0.02).floor().max(0.0) as u32;
        let steps = if self.layout.smooth {
            steps
        } else {
            steps & !1
        };
        steps.min(2 * self.frame.doublings)
    }

    /// Nodes of the cell of `2^level` steps that begins at `n`.
    fn cell(&self, n: [i64; 3], level: u32, found: &mut Vec<Node>) {
        let edge = 1_i64 << level;
        let mut half = [0.0; 3];
        for (half, step) in half
            .iter_mut()
            .zip(self.frame.step)
            .take(self.layout.dimensions)
        {
            *half = 0.5 * edge as f64 * step;
        }
        let corner = self.frame.place(n, self.layout);
        let middle = std::array::from_fn(|k| corner[k] + half[k]);
        let reach = length(half);
        if self.layout.depth(middle) < -reach * 1.001 {
            return;
        }
        if level == 0 || self.rank_of((self.wanted)(middle, reach)) >= 2 * level {
            found.extend(self.node(n));
            return;
        }
        let children = 1 << self.layout.dimensions;
        for child in 0..children {
            let part = std::array::from_fn(|k| n[k] + (child >> k & 1) * (edge / 2));
            if (0..3).all(|k| part[k] <= self.frame.last[k]) {
                self.cell(part, level - 1, found);
            }
        }
    }

    fn node(&self, n: [i64; 3]) -> Option<Node> {
        let place = self.frame.place(n, self.layout);
        let wanted = self.rank_of((self.wanted)(place, 0.0));
        if rank(n) < wanted {
            return None;
        }
        let spacing = self.spacing(wanted);
        let face = match &self.layout.wall {
            Wall::Box { axis, .. } => (0..2 * self.layout.dimensions)
                .find(|f| {
                    let end = if f % 2 == 0 {
                        0
                    } else {
                        self.frame.last[f / 2]
                    };
                    n[f / 2] == end && !(*f == 0 && *axis)
                })
                .map(|f| f as u8),
            Wall::Ball { centre, radius } => {
                let room = radius - length(difference(place, *centre));
                if room < 0.6 * spacing {
                    return None;
                }
                None
            }
        };
        Some(Node {
            place,
            spacing,
            face,
        })
    }

    fn spacing(&self, rank: u32) -> f64 {
        let d = self.layout.dimensions;
        let volume: f64 = self.frame.step[..d].iter().product();
        let whole = f64::from(rank / 2) + f64::from(rank % 2) / d as f64;
        volume.powf(1.0 / d as f64) * whole.exp2()
    }
}

/// All nodes, from the coarse cells in order.
pub(crate) fn nodes(layout: &Layout) -> Vec<Node> {
    graded(layout, &|x, nearer| layout.wanted(x, nearer))
}

/// The same where the spacing is another one than bodies want.
pub(crate) fn graded(layout: &Layout, wanted: Wanted<'_>) -> Vec<Node> {
    let frame = Frame::new(layout);
    let descent = Descent {
        layout,
        wanted,
        frame,
    };
    let edge = 1_i64 << frame.doublings;
    let counts = frame.last.map(|n| n / edge + 1);
    let cells: i64 = counts.iter().product();
    let parts: Vec<Vec<Node>> = (0..cells)
        .into_par_iter()
        .map(|c| {
            let mut found = Vec::new();
            let n = [
                c % counts[0] * edge,
                c / counts[0] % counts[1] * edge,
                c / counts[0] / counts[1] * edge,
            ];
            descent.cell(n, frame.doublings, &mut found);
            found
        })
        .collect();
    parts.into_iter().flatten().collect()
}

/// Closest packing within a box, of points as dense as a cubic lattice of the given spacing: triangles in two
/// dimensions, face-centred cubes in space.
pub(crate) fn packed([low, high]: [Vector; 2], dimensions: usize, spacing: f64) -> Vec<Node> {
    let (d, cell) = if dimensions == 3 {
        // Cubes with 4 points each.
        let edge = spacing * 4.0_f64.cbrt();
        (3, [edge; 3])
    } else {
        // Rectangles with 2 points each.
        let side = spacing * (2.0 / 3.0_f64.sqrt()).sqrt();
        (2, [side, 3.0_f64.sqrt() * side, 1.0])
    };
    let offsets: &[[f64; 3]] = if d == 3 {
        &[[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]]
    } else {
        &[[0.0; 3], [0.5, 0.5, 0.0]]
    };
    let middle: Vector = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
    let half: [i64; 3] = std::array::from_fn(|k| {
        if k < d {
            ((high[k] - low[k]) / (2.0 * cell[k])).ceil() as i64
        } else {
            0
        }
    });
    let mut nodes = Vec::new();
    for k in -half[2]..=half[2] {
        for j in -half[1]..=half[1] {
            for i in -half[0]..=half[0] {
                nodes.extend(offsets.iter().map(|o| {
                    let n = [i as f64 + o[0], j as f64 + o[1], k as f64 + o[2]];
                    let place = std::array::from_fn(|a| {
                        if a < d {
                            middle[a] + n[a] * cell[a]
                        } else {
                            0.0
                        }
                    });
                    Node {
                        place,
                        spacing,
                        face: None,
                    }
                }));
            }
        }
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattices_are_nested() {
        assert_eq!(rank([1, 0, 0]), 0);
        assert_eq!(rank([1, 1, 0]), 1);
        assert_eq!(rank([1, 1, 1]), 0);
        assert_eq!(rank([2, 0, 4]), 2);
        assert_eq!(rank([2, 2, 4]), 3);
        assert_eq!(rank([-4, 4, 0]), 5);
    }
}
