//! Points of any grading in a tree of boxes.

use std::ops::Range;

use crate::grid::{distance_squared, number};

/// Points of a leaf at most.
const LEAF: usize = 16;
/// Subtrees of more points than this are built at the same time.
const PARALLEL: usize = 8192;

/// A balanced tree of boxes around halves of the cloud.
///
/// A [`crate::Grid`] has cells of one size; where the spacing of a cloud varies, a tree finds the
/// points within any radius at a cost in proportion to their number. Sorting ties by index makes it
/// depend on the points alone.
///
/// ```
/// use neighbours::Tree;
/// let tree = Tree::new(&[[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [100.0, 0.0, 0.0]]);
/// let mut found = Vec::new();
/// tree.within([0.0; 3], 0.01, |a, square| found.push((a, square)));
/// assert_eq!(found, [(0, 0.0), (1, 1e-6)]);
/// assert_eq!(tree.nearest([60.0, 0.0, 0.0]), Some(2));
/// ```
#[derive(Debug, Clone)]
pub struct Tree {
    depth: u32,
    /// Box of each node, heap order: children of `k` are `2 k + 1` and `2 k + 2`.
    boxes: Vec<[[f64; 3]; 2]>,
    order: Vec<u32>,
    sorted: Vec<[f64; 3]>,
}

/// A node under way: its number in the heap and its points.
#[derive(Clone, Copy)]
struct Node {
    number: usize,
    start: usize,
    end: usize,
}

impl Node {
    fn halves(self) -> [Self; 2] {
        let middle = usize::midpoint(self.start, self.end);
        [
            Self {
                number: 2 * self.number + 1,
                end: middle,
                ..self
            },
            Self {
                number: 2 * self.number + 2,
                start: middle,
                ..self
            },
        ]
    }
}

impl Tree {
    /// Sorts `points`, which must be finite.
    #[must_use]
    pub fn new(points: &[[f64; 3]]) -> Self {
        let leaves = points.len().div_ceil(LEAF).max(1).next_power_of_two();
        let mut order = (0..number(points.len())).collect::<Vec<u32>>();
        split(points, &mut order, leaves.trailing_zeros());
        let sorted = order
            .iter()
            .map(|&a| points[a as usize])
            .collect::<Vec<_>>();
        let mut tree = Self {
            depth: leaves.trailing_zeros(),
            boxes: vec![[[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]; 2 * leaves - 1],
            order,
            sorted,
        };
        tree.enclose();
        tree
    }

    /// Point indices in the order of the tree: near each other in space and in memory.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Positions in the order of [`Tree::order`].
    #[must_use]
    pub fn sorted(&self) -> &[[f64; 3]] {
        &self.sorted
    }

    /// Runs of [`Tree::order`] that share a leaf, in order: at most 16 points close to each other.
    #[must_use]
    pub fn leaves(&self) -> Vec<Range<usize>> {
        let first = (1_usize << self.depth) - 1;
        let mut nodes = vec![self.root()];
        let mut leaves = Vec::with_capacity(first + 1);
        while let Some(node) = nodes.pop() {
            if node.number >= first {
                leaves.push(node.start..node.end);
            } else {
                let [left, right] = node.halves();
                nodes.push(right);
                nodes.push(left);
            }
        }
        leaves
    }

    /// Calls `visit` with each run of sorted points that may lie in the box from `low` to `high`.
    pub fn runs(&self, low: [f64; 3], high: [f64; 3], mut visit: impl FnMut(Range<usize>)) {
        let mut pending = 0..0;
        self.descend(self.root(), low, high, &mut |run| {
            if run.start == pending.end {
                pending.end = run.end;
            } else {
                let whole = std::mem::replace(&mut pending, run);
                if !whole.is_empty() {
                    visit(whole);
                }
            }
        });
        if !pending.is_empty() {
            visit(pending);
        }
    }

    /// Calls `visit` with each point closer than `radius` to `place` and its squared distance.
    pub fn within(&self, place: [f64; 3], radius: f64, mut visit: impl FnMut(usize, f64)) {
        let limit = radius * radius;
        self.runs(
            place.map(|x| x - radius),
            place.map(|x| x + radius),
            |run| {
                for k in run {
                    let square = distance_squared(place, self.sorted[k]);
                    if square < limit {
                        visit(self.order[k] as usize, square);
                    }
                }
            },
        );
    }

    /// The point nearest to `place`, the lowest of equals; none in an empty tree.
    #[must_use]
    pub fn nearest(&self, place: [f64; 3]) -> Option<usize> {
        let first = (1_usize << self.depth) - 1;
        let mut best = (f64::INFINITY, u32::MAX);
        let mut nodes = vec![(0.0, self.root())];
        while let Some((square, node)) = nodes.pop() {
            if square > best.0 {
                continue;
            }
            if node.number >= first {
                for k in node.start..node.end {
                    let here = (distance_squared(place, self.sorted[k]), self.order[k]);
                    if here < best {
                        best = here;
                    }
                }
                continue;
            }
            let [left, right] = node
                .halves()
                .map(|n| (square_to(place, &self.boxes[n.number]), n));
            // The nearer half is taken from the stack first.
            let (far, near) = if left.0 <= right.0 {
                (right, left)
            } else {
                (left, right)
            };
            nodes.push(far);
            nodes.push(near);
        }
        (best.1 != u32::MAX).then_some(best.1 as usize)
    }

    fn root(&self) -> Node {
        Node {
            number: 0,
            start: 0,
            end: self.order.len(),
        }
    }

    fn descend(
        &self,
        node: Node,
        low: [f64; 3],
        high: [f64; 3],
        visit: &mut impl FnMut(Range<usize>),
    ) {
        let [start, end] = self.boxes[node.number];
        if (0..3).any(|k| start[k] > high[k] || end[k] < low[k]) {
            return;
        }
        let inside = (0..3).all(|k| start[k] >= low[k] && end[k] <= high[k]);
        if inside || node.number + 1 >= 1 << self.depth {
            visit(node.start..node.end);
            return;
        }
        for half in node.halves() {
            self.descend(half, low, high, visit);
        }
    }

    /// Boxes of the leaves from their points, of the others from their halves.
    fn enclose(&mut self) {
        let first = (1_usize << self.depth) - 1;
        for (k, run) in self.leaves().into_iter().enumerate() {
            let around = &mut self.boxes[first + k];
            for point in &self.sorted[run] {
                for (axis, &x) in point.iter().enumerate() {
                    around[0][axis] = around[0][axis].min(x);
                    around[1][axis] = around[1][axis].max(x);
                }
            }
        }
        for k in (0..first).rev() {
            let (left, right) = (self.boxes[2 * k + 1], self.boxes[2 * k + 2]);
            for axis in 0..3 {
                self.boxes[k][0][axis] = left[0][axis].min(right[0][axis]);
                self.boxes[k][1][axis] = left[1][axis].max(right[1][axis]);
            }
        }
    }
}

/// Halves `order` again and again across the longest side of its box.
fn split(points: &[[f64; 3]], order: &mut [u32], depth: u32) {
    if depth == 0 || order.len() < 2 {
        return;
    }
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for &a in order.iter() {
        for (k, &x) in points[a as usize].iter().enumerate() {
            low[k] = low[k].min(x);
            high[k] = high[k].max(x);
        }
    }
    let side = |k: usize| high[k] - low[k];
    let mut axis = 0;
    for k in 1..3 {
        if side(k) > side(axis) {
            axis = k;
        }
    }
    let middle = order.len() / 2;
    if middle < order.len() {
        order.select_nth_unstable_by(middle, |&a, &b| {
            let (x, y) = (points[a as usize][axis], points[b as usize][axis]);
            x.total_cmp(&y).then(a.cmp(&b))
        });
    }
    let (left, right) = order.split_at_mut(middle);
    if left.len() > PARALLEL {
        rayon::join(
            || split(points, left, depth - 1),
            || split(points, right, depth - 1),
        );
    } else {
        split(points, left, depth - 1);
        split(points, right, depth - 1);
    }
    if depth == 1 {
        left.sort_unstable();
        right.sort_unstable();
    }
}

/// Squared distance from a place to a box.
fn square_to(place: [f64; 3], [low, high]: &[[f64; 3]; 2]) -> f64 {
    let mut square = 0.0;
    for k in 0..3 {
        let gap = (low[k] - place[k]).max(place[k] - high[k]).max(0.0);
        square += gap * gap;
    }
    square
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cloud whose spacing grows a hundredfold with the distance from the origin.
    fn graded(count: usize) -> Vec<[f64; 3]> {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        (0..count)
            .map(|_| {
                let direction = [random(), random(), random()];
                let size = 10.0_f64.powf(4.0 * random());
                direction.map(|x| x * size)
            })
            .collect()
    }

    fn naive(points: &[[f64; 3]], place: [f64; 3], radius: f64) -> Vec<usize> {
        (0..points.len())
            .filter(|&a| distance_squared(place, points[a]) < radius * radius)
            .collect()
    }

    #[test]
    fn finds_what_a_plain_search_finds() {
        for count in [0, 1, 2, 17, 1000, 20_000] {
            let points = graded(count);
            let tree = Tree::new(&points);
            for (k, &place) in points.iter().enumerate().step_by(1 + count / 50) {
                let radius = 0.3 * distance_squared(place, [0.0; 3]).sqrt() + 1e-3;
                let mut found = Vec::new();
                tree.within(place, radius, |a, _| found.push(a));
                found.sort_unstable();
                assert_eq!(found, naive(&points, place, radius), "point {k} of {count}");
                let beside = place.map(|x| x * 1.01);
                let nearest = (0..count)
                    .min_by(|&a, &b| {
                        distance_squared(beside, points[a])
                            .total_cmp(&distance_squared(beside, points[b]))
                    })
                    .unwrap();
                assert_eq!(tree.nearest(beside), Some(nearest));
            }
        }
    }

    #[test]
    fn leaves_cover_the_cloud_once_and_are_small() {
        let points = graded(5000);
        let tree = Tree::new(&points);
        let mut next = 0;
        for leaf in tree.leaves() {
            assert_eq!(leaf.start, next);
            assert!(leaf.len() <= LEAF);
            next = leaf.end;
        }
        assert_eq!(next, points.len());
        let mut seen = tree.order().to_vec();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(k, &a)| k == a as usize));
    }

    #[test]
    fn coincident_points_are_all_found() {
        let points = vec![[1.0, 2.0, 3.0]; 100];
        let mut found = 0;
        Tree::new(&points).within([1.0, 2.0, 3.0], 1e-9, |_, _| found += 1);
        assert_eq!(found, 100);
    }
}
