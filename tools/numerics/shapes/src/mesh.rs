//! Closed surfaces of triangles: how far a place is from one, and on which side.
//!
//! The nearest place of the surface is sought through a tree of boxes. Which side a place is on tells the normal there: that
//! of the triangle, the sum of both triangles' at an edge, and at a corner the sum over all of them weighted with their
//! angles, which has the right sign everywhere (Baerentzen and Aanaes 2005).

use std::collections::BTreeMap;

use crate::frame::{Vector, along, cross, difference, dot, length};

/// Triangles of a leaf of the tree.
const LEAF: usize = 4;

/// A closed surface of triangles that look outward.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    vertices: Vec<Vector>,
    triangles: Vec<[usize; 3]>,
    /// Of each triangle its own normal, those of its edges (0-1, 1-2, 2-0) and of its corners; of any length.
    normals: Vec<[Vector; 7]>,
    /// Numbers of triangles in the order of the leaves.
    order: Vec<usize>,
    nodes: Vec<Node>,
}

/// A box of the tree: a leaf with a range of `order`, or the number of its second part; the first follows it.
#[derive(Debug, Clone, PartialEq)]
struct Node {
    low: Vector,
    high: Vector,
    leaf: Option<[usize; 2]>,
    second: usize,
}

/// What keeps triangles from being a closed surface; none where they are one.
///
/// ```
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// assert_eq!(shapes::mesh::open(&corners, &faces), None);
/// assert!(shapes::mesh::open(&corners, &faces[..3]).unwrap().contains("3 of 6 edges"));
/// ```
#[must_use]
pub fn open(vertices: &[Vector], triangles: &[[usize; 3]]) -> Option<String> {
    if triangles.is_empty() {
        return Some("has no triangles".to_owned());
    }
    if triangles.iter().flatten().any(|k| *k >= vertices.len()) {
        return Some("has triangles with corners that are not there".to_owned());
    }
    if vertices.iter().flatten().any(|x| !x.is_finite()) {
        return Some("has corners without a place".to_owned());
    }
    let mut edges: BTreeMap<[usize; 2], [usize; 2]> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let [a, b] = [t[k], t[(k + 1) % 3]];
            edges.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
        }
    }
    let total = edges.len();
    let mut bad = edges
        .iter()
        .filter(|(_, ways)| **ways != [1, 1])
        .map(|(e, _)| *e);
    let [a, b] = bad.next()?;
    let count = 1 + bad.count();
    let told = |k: usize| {
        let [x, y, z] = vertices[k].map(|c| 1e3 * c);
        format!("({x:.4}, {y:.4}, {z:.4}) mm")
    };
    Some(format!(
        "is not closed: {count} of {total} edges do not belong to two triangles that go along them in opposite ways, the first \
         from {} to {}",
        told(a),
        told(b)
    ))
}

impl Mesh {
    /// The surface of triangles that are closed, as [`open`] says; turned outward if they look inward.
    #[must_use]
    pub fn new(vertices: Vec<Vector>, mut triangles: Vec<[usize; 3]>) -> Self {
        let volume: f64 = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|k| difference(vertices[k], vertices[0]));
                dot(a, cross(b, c))
            })
            .sum();
        if volume < 0.0 {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        let normals = normals(&vertices, &triangles);
        let mut mesh = Self {
            order: (0..triangles.len()).collect(),
            vertices,
            triangles,
            normals,
            nodes: Vec::new(),
        };
        mesh.grow(0, mesh.triangles.len());
        mesh
    }

    /// Number of triangles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there are no triangles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Lower and upper corner of the box around it \[m\].
    #[must_use]
    pub fn bounds(&self) -> [Vector; 2] {
        [self.nodes[0].low, self.nodes[0].high]
    }

    /// Corners of a triangle \[m\].
    pub(crate) fn corners(&self, triangle: usize) -> [Vector; 3] {
        self.triangles[triangle].map(|k| self.vertices[k])
    }

    /// Signed distance of a place \[m\], negative inside.
    #[must_use]
    pub fn distance(&self, place: Vector) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        self.seek(0, place, &mut best);
        let (square, side) = best;
        square.sqrt().copysign(side)
    }

    /// Finds the square of the distance, and the way along the normal, in a part of the tree if it is nearer than `best`.
    fn seek(&self, node: usize, place: Vector, best: &mut (f64, f64)) {
        let this = &self.nodes[node];
        if let Some([from, to]) = this.leaf {
            for &t in &self.order[from..to] {
                let (nearest, feature) = nearest(self.corners(t), place);
                let way = difference(place, nearest);
                let square = dot(way, way);
                if square < best.0 {
                    *best = (square, dot(way, self.normals[t][feature]));
                }
            }
            return;
        }
        let mut parts = [node + 1, this.second].map(|part| (self.nodes[part].away(place), part));
        if parts[1].0 < parts[0].0 {
            parts.swap(0, 1);
        }
        for (square, part) in parts {
            if square < best.0 {
                self.seek(part, place, best);
            }
        }
    }

    /// Makes the tree over a range of `order`: halves along the longest side of the box of the triangles' middles.
    fn grow(&mut self, from: usize, to: usize) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let (mut least, mut most) = (low, high);
        for &t in &self.order[from..to] {
            let corners = self.corners(t);
            for k in 0..3 {
                for c in corners {
                    low[k] = low[k].min(c[k]);
                    high[k] = high[k].max(c[k]);
                }
                least[k] = least[k].min(middle(corners)[k]);
                most[k] = most[k].max(middle(corners)[k]);
            }
        }
        let number = self.nodes.len();
        let leaf = (to - from <= LEAF).then_some([from, to]);
        self.nodes.push(Node {
            low,
            high,
            leaf,
            second: 0,
        });
        if leaf.is_some() {
            return;
        }
        let wide = |k: usize| most[k] - least[k];
        let axis = (1..3).fold(0, |best, k| if wide(k) > wide(best) { k } else { best });
        let mut part = self.order[from..to].to_vec();
        part.sort_by(|a, b| {
            let at = |t: usize| middle(self.corners(t))[axis];
            at(*a).total_cmp(&at(*b)).then(a.cmp(b))
        });
        self.order[from..to].copy_from_slice(&part);
        let half = from + (to - from) / 2;
        self.grow(from, half);
        self.nodes[number].second = self.nodes.len();
        self.grow(half, to);
    }
}

impl Node {
    /// Square of the distance of a place from the box.
    fn away(&self, place: Vector) -> f64 {
        (0..3)
            .map(|k| {
                (self.low[k] - place[k])
                    .max(place[k] - self.high[k])
                    .max(0.0)
            })
            .map(|d| d * d)
            .sum()
    }
}

fn middle([a, b, c]: [Vector; 3]) -> Vector {
    along(along(a, 1.0, b), 1.0, c).map(|x| x / 3.0)
}

/// Normals of triangles, of their edges and of their corners.
fn normals(vertices: &[Vector], triangles: &[[usize; 3]]) -> Vec<[Vector; 7]> {
    let unit = |v: Vector| {
        let size = length(v);
        if size > 0.0 { v.map(|c| c / size) } else { v }
    };
    let own = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|k| vertices[k]);
        unit(cross(difference(b, a), difference(c, a)))
    };
    let mut of_edges: BTreeMap<[usize; 2], Vector> = BTreeMap::new();
    let mut of_corners = vec![[0.0; 3]; vertices.len()];
    for t in triangles {
        let normal = own(t);
        for k in 0..3 {
            let [a, b, c] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
            let edge = of_edges.entry([a.min(b), a.max(b)]).or_insert([0.0; 3]);
            *edge = along(*edge, 1.0, normal);
            let [to_b, to_c] = [b, c].map(|k| unit(difference(vertices[k], vertices[a])));
            let angle = dot(to_b, to_c).clamp(-1.0, 1.0).acos();
            of_corners[a] = along(of_corners[a], angle, normal);
        }
    }
    let of = |t: &[usize; 3]| {
        let edge = |k: usize| {
            let [a, b] = [t[k], t[(k + 1) % 3]];
            of_edges
                .get(&[a.min(b), a.max(b)])
                .copied()
                .unwrap_or_default()
        };
        let [a, b, c] = t.map(|k| of_corners[k]);
        [own(t), edge(0), edge(1), edge(2), a, b, c]
    };
    triangles.iter().map(of).collect()
}

/// The place of a triangle nearest to `p`, and what it is: 0 within, 1 to 3 on an edge, 4 to 6 a corner (Ericson 2005,
/// section 5.1.5).
fn nearest([a, b, c]: [Vector; 3], p: Vector) -> (Vector, usize) {
    let (ab, ac) = (difference(b, a), difference(c, a));
    let ways = |from: Vector| {
        let ap = difference(p, from);
        (dot(ab, ap), dot(ac, ap))
    };
    let (d1, d2) = ways(a);
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, 4);
    }
    let (d3, d4) = ways(b);
    if d3 >= 0.0 && d4 <= d3 {
        return (b, 5);
    }
    let (d5, d6) = ways(c);
    if d6 >= 0.0 && d5 <= d6 {
        return (c, 6);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (along(a, d1 / (d1 - d3), ab), 1);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (along(a, d2 / (d2 - d6), ac), 3);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (along(b, share, difference(c, b)), 2);
    }
    let whole = va + vb + vc;
    (along(along(a, vb / whole, ab), vc / whole, ac), 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A ball of triangles: an octahedron whose edges are halved `times` times, corners on the sphere.
    fn ball(times: usize) -> (Vec<Vector>, Vec<[usize; 3]>) {
        let mut vertices: Vec<Vector> = Vec::new();
        for k in 0..3 {
            for side in [1.0, -1.0] {
                let mut v = [0.0; 3];
                v[k] = side;
                vertices.push(v);
            }
        }
        let mut triangles = Vec::new();
        for octant in 0..8_usize {
            let sign = |k: usize| (octant >> k) & 1;
            let t = [sign(0), 2 + sign(1), 4 + sign(2)];
            let turned = octant.count_ones() % 2 == 1;
            triangles.push(if turned { [t[0], t[2], t[1]] } else { t });
        }
        for _ in 0..times {
            let mut middles: BTreeMap<[usize; 2], usize> = BTreeMap::new();
            let mut finer = Vec::new();
            for [a, b, c] in triangles {
                let mut half = |a: usize, b: usize| {
                    *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                        let m = along(vertices[a], 1.0, vertices[b]);
                        let size = length(m);
                        vertices.push(m.map(|x| x / size));
                        vertices.len() - 1
                    })
                };
                let (ab, bc, ca) = (half(a, b), half(b, c), half(c, a));
                finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
            }
            triangles = finer;
        }
        (vertices, triangles)
    }

    #[test]
    fn distances_from_a_ball_have_the_error_of_its_triangles() {
        let mut errors = Vec::new();
        for times in [3, 4, 5] {
            let (vertices, triangles) = ball(times);
            assert_eq!(open(&vertices, &triangles), None);
            let mesh = Mesh::new(vertices, triangles);
            let mut worst = 0.0_f64;
            for k in 0..500 {
                let (angle, height) = (2.4 * f64::from(k), 1.9 * f64::from(k) / 500.0 - 0.95);
                let across = (1.0 - height * height).sqrt();
                for radius in [0.3, 0.9, 1.1, 3.0] {
                    let place = [
                        radius * across * angle.cos(),
                        radius * across * angle.sin(),
                        radius * height,
                    ];
                    worst = worst.max((mesh.distance(place) - (radius - 1.0)).abs());
                }
            }
            errors.push(worst);
        }
        // Edges halve: the error quarters.
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            assert!((3.4..4.6).contains(&ratio), "{errors:?}");
        }
    }

    #[test]
    fn every_side_of_a_sharp_needle_is_told() {
        // Corners and edges sharper than any normal of one triangle could tell.
        let vertices = vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.5, 0.05, 0.0],
            [0.5, 0.02, 4.0],
        ];
        let inward = vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
        assert_eq!(open(&vertices, &inward), None);
        let mesh = Mesh::new(vertices.clone(), inward);
        // Independent of the tree: inside where all planes are behind.
        let centre = middle([
            vertices[0],
            vertices[1],
            middle([vertices[2], vertices[3], vertices[2]]),
        ]);
        let mut inside = 0;
        for i in 0..40 {
            for j in 0..40 {
                for k in 0..40 {
                    let place = [
                        -0.2 + 0.034_71 * f64::from(i),
                        -0.05 + 0.003_13 * f64::from(j),
                        -0.3 + 0.110_9 * f64::from(k),
                    ];
                    let within = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]
                        .iter()
                        .all(|t| {
                            let [a, b, c] = t.map(|k: usize| vertices[k]);
                            let n = cross(difference(b, a), difference(c, a));
                            let [here, there] = [place, centre].map(|p| dot(n, difference(p, a)));
                            here * there > 0.0
                        });
                    inside += usize::from(within);
                    assert_eq!(mesh.distance(place) < 0.0, within, "{place:?}");
                }
            }
        }
        assert!(inside > 20, "{inside}");
    }

    #[test]
    fn what_is_not_closed_is_told() {
        let (vertices, triangles) = ball(1);
        let told = open(&vertices, &triangles[1..]).unwrap();
        assert!(told.contains("3 of 48 edges"), "{told}");
        let mut turned = triangles.clone();
        turned[0].swap(0, 1);
        assert!(open(&vertices, &turned).unwrap().contains("opposite ways"));
        assert!(open(&vertices, &[]).is_some() && open(&vertices[..3], &triangles).is_some());
        let mesh = Mesh::new(vertices, triangles);
        assert_eq!((mesh.len(), mesh.is_empty()), (32, false));
        assert!(mesh.distance([0.0; 3]) < -0.7 && mesh.distance([0.0, 0.0, PI]) > 2.0);
    }
}
