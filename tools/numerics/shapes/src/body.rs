//! Bodies: primitives and what is composed of them.
//!
//! A body is known by its signed distance: negative inside. That of a composition is the greatest or least of
//! its parts' (a lower bound of the true distance, with the right sign everywhere), which is all that the
//! arrangement of points and the search for surfaces ask for.

use std::sync::Arc;

use crate::ellipsoid::Ellipsoid;
use crate::frame::{Frame, Vector, along, direction, length};
use crate::mesh::Mesh;
use crate::shape::{BoxShape, EllipsoidShape, Shape, Stl};

/// What a primitive is, in its own frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// Half extents \[m\]; infinite along z in a plane scene.
    Box(Vector),
    /// Radius and half length \[m\]; a disc is endless.
    Cylinder {
        /// Radius \[m\].
        radius: f64,
        /// Half length \[m\].
        half: f64,
    },
    /// Radius \[m\].
    Ball(f64),
    /// Semi-axes; endless along z in a plane scene.
    Ellipsoid(Ellipsoid),
    /// All below the plane of its x and y.
    HalfSpace,
    /// A closed surface of triangles about the origin of the frame.
    Mesh(Arc<Mesh>),
}

/// A primitive where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Primitive {
    /// Its frame.
    pub frame: Frame,
    /// What it is.
    pub kind: Kind,
    /// Name in the scene.
    pub name: Option<String>,
    /// Whether it is cut away, so that its faces look inward.
    pub cut: bool,
}

/// A composition of primitives.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Tree {
    Leaf(usize),
    Any(Vec<Tree>),
    All(Vec<Tree>),
    First(Vec<Tree>),
}

/// A body or region.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// All primitives, in the order of the scene.
    pub primitives: Vec<Primitive>,
    pub(crate) tree: Tree,
}

impl Primitive {
    /// Signed distance \[m\], negative inside.
    #[must_use]
    pub fn distance(&self, x: Vector) -> f64 {
        let q = self.frame.own(x);
        match &self.kind {
            Kind::Box(half) => rectangular([0, 1, 2].map(|k| q[k].abs() - half[k])),
            Kind::Cylinder { radius, half } => rectangular([
                q[0].hypot(q[1]) - *radius,
                q[2].abs() - *half,
                f64::NEG_INFINITY,
            ]),
            Kind::Ball(radius) => length(q) - *radius,
            Kind::Ellipsoid(e) => e.distance(q),
            Kind::HalfSpace => q[2],
            Kind::Mesh(mesh) => mesh.distance(q),
        }
    }

    /// The same with all faces moved out of the body by a distance \[m\]; none where nothing would be left of it.
    fn grown(&self, distance: f64) -> Option<Self> {
        let by = if self.cut { -distance } else { distance };
        let mut grown = self.clone();
        let left = match &mut grown.kind {
            Kind::Box(half) => {
                *half = half.map(|h| h + by);
                half.iter().all(|h| *h > 0.0)
            }
            Kind::Cylinder { radius, half } => {
                *radius += by;
                *half += by;
                *radius > 0.0 && *half > 0.0
            }
            Kind::Ball(radius) => {
                *radius += by;
                *radius > 0.0
            }
            Kind::Ellipsoid(e) => e.grown(by).is_some_and(|more| {
                *e = more;
                true
            }),
            Kind::HalfSpace => {
                let frame = &mut grown.frame;
                frame.origin = along(frame.origin, by, frame.axes[2]);
                true
            }
            // Its triangles would part.
            Kind::Mesh(_) => false,
        };
        left.then_some(grown)
    }

    /// Corners of a box that holds it \[m\]; infinite where it has no end.
    fn bounds(&self) -> [Vector; 2] {
        let half = match &self.kind {
            Kind::Box(half) => *half,
            Kind::Cylinder { radius, half } => [*radius, *radius, *half],
            Kind::Ball(radius) => [*radius; 3],
            Kind::Ellipsoid(e) => e.half.map(|h| h + e.beyond),
            Kind::HalfSpace => [f64::INFINITY; 3],
            // Its frame stands in the middle of the box around it.
            Kind::Mesh(mesh) => mesh.bounds()[1],
        };
        let reach: Vector = std::array::from_fn(|k| {
            let part = |axis: usize| {
                let cosine = self.frame.axes[axis][k].abs();
                if cosine > 1e-12 {
                    cosine * half[axis]
                } else {
                    0.0
                }
            };
            match &self.kind {
                Kind::Ellipsoid(e) => {
                    let own = [0, 1, 2].map(|a| part(a) - e.beyond * self.frame.axes[a][k].abs());
                    length(own) + e.beyond
                }
                _ => part(0) + part(1) + part(2),
            }
        });
        let origin = self.frame.origin;
        [
            std::array::from_fn(|k| origin[k] - reach[k]),
            std::array::from_fn(|k| origin[k] + reach[k]),
        ]
    }
}

/// Distance from distances along independent directions.
fn rectangular(d: [f64; 3]) -> f64 {
    let inside = d[0].max(d[1]).max(d[2]).min(0.0);
    let outside = d.map(|d| d.max(0.0));
    inside + length(outside)
}

impl Body {
    /// A body of a scene with `dimensions` 2 or 3, whose shapes have been checked.
    #[must_use]
    pub fn new(shape: &Shape, dimensions: usize) -> Self {
        let mut primitives = Vec::new();
        let mut builder = Builder {
            dimensions,
            primitives: &mut primitives,
        };
        let tree = builder.tree(shape, &Frame::SCENE, false);
        Self { primitives, tree }
    }

    /// Signed distance \[m\], negative inside; outside of a composition a lower bound.
    #[must_use]
    pub fn distance(&self, x: Vector) -> f64 {
        self.of(&self.tree, x)
    }

    /// Whether a place is inside.
    #[must_use]
    pub fn holds(&self, x: Vector) -> bool {
        self.distance(x) <= 0.0
    }

    /// Direction in which the distance rises fastest.
    #[must_use]
    pub fn normal(&self, x: Vector, step: f64) -> Vector {
        let slope = |k: usize| {
            let (mut low, mut high) = (x, x);
            low[k] -= step;
            high[k] += step;
            self.distance(high) - self.distance(low)
        };
        let gradient = [slope(0), slope(1), slope(2)];
        if length(gradient) > 0.0 {
            direction(gradient)
        } else {
            [0.0; 3]
        }
    }

    pub(crate) fn of(&self, tree: &Tree, x: Vector) -> f64 {
        let each = |trees: &'_ [Tree], of: fn(f64, f64) -> f64, from: f64| {
            let distances = trees.iter().map(|t| self.of(t, x));
            distances.fold(from, of)
        };
        match tree {
            Tree::Leaf(k) => self.primitives[*k].distance(x),
            Tree::Any(trees) => each(trees, f64::min, f64::INFINITY),
            Tree::All(trees) => each(trees, f64::max, f64::NEG_INFINITY),
            Tree::First(trees) => {
                each(&trees[1..], |least, d| least.max(-d), self.of(&trees[0], x))
            }
        }
    }

    /// Corners of a box that holds the body \[m\]; infinite where it has no end.
    #[must_use]
    pub fn bounds(&self) -> [Vector; 2] {
        self.bounds_of(&self.tree)
    }

    fn bounds_of(&self, tree: &Tree) -> [Vector; 2] {
        let join = |trees: &[Tree], low: fn(f64, f64) -> f64, high: fn(f64, f64) -> f64| {
            let all = trees.iter().map(|t| self.bounds_of(t));
            all.reduce(|a, b| {
                [
                    std::array::from_fn(|k| low(a[0][k], b[0][k])),
                    std::array::from_fn(|k| high(a[1][k], b[1][k])),
                ]
            })
            .unwrap_or([[0.0; 3]; 2])
        };
        match tree {
            Tree::Leaf(k) => self.primitives[*k].bounds(),
            Tree::Any(trees) => join(trees, f64::min, f64::max),
            Tree::All(trees) => join(trees, f64::max, f64::min),
            Tree::First(trees) => self.bounds_of(&trees[0]),
        }
    }

    /// The body with all its faces moved outward by a distance \[m\]: a box stays a box. None where that fills what is
    /// cut away from it.
    ///
    /// ```
    /// use shapes::Body;
    /// let ball = r#"{"sphere": {"centre_m": [0, 0, 0], "radius_m": 2}}"#;
    /// let ball = Body::new(&serde_json::from_str(ball)?, 3);
    /// assert_eq!(ball.grown(0.5).map(|b| b.distance([3.0, 0.0, 0.0])), Some(0.5));
    /// # Ok::<(), serde_json::Error>(())
    /// ```
    #[must_use]
    pub fn grown(&self, distance: f64) -> Option<Self> {
        let primitives = self.primitives.iter().map(|p| p.grown(distance));
        Some(Self {
            primitives: primitives.collect::<Option<_>>()?,
            tree: self.tree.clone(),
        })
    }

    /// The one primitive that the body is, if it is not composed.
    #[must_use]
    pub fn single(&self) -> Option<&Primitive> {
        match (&self.tree, self.primitives.as_slice()) {
            (Tree::Leaf(_), [primitive]) => Some(primitive),
            _ => None,
        }
    }
}

/// Turns shapes of a scene into primitives and their composition.
struct Builder<'a> {
    dimensions: usize,
    primitives: &'a mut Vec<Primitive>,
}

/// Coordinates of a scene; a plane scene has no z.
fn vector(coordinates: &[f64]) -> Vector {
    std::array::from_fn(|k| coordinates.get(k).copied().unwrap_or(0.0))
}

/// A surface about the middle of the box around it, and where that middle stands \[m\].
fn surface(stl: &Stl) -> (Kind, Vector) {
    let mut vertices = stl.vertices_m.clone().unwrap_or_default();
    let triangles = stl.triangles.clone().unwrap_or_default();
    let end =
        |k: usize, of: fn(f64, f64) -> f64, from: f64| vertices.iter().map(|v| v[k]).fold(from, of);
    let middle: Vector = std::array::from_fn(|k| {
        0.5 * (end(k, f64::min, f64::INFINITY) + end(k, f64::max, f64::NEG_INFINITY))
    });
    for vertex in &mut vertices {
        *vertex = along(*vertex, -1.0, middle);
    }
    let origin = stl.at_m.as_deref().map_or([0.0; 3], vector);
    let kind = Kind::Mesh(Arc::new(Mesh::new(vertices, triangles)));
    (kind, along(origin, 1.0, middle))
}

impl Builder<'_> {
    fn leaf(&mut self, frame: Frame, kind: Kind, name: Option<&String>, cut: bool) -> Tree {
        self.primitives.push(Primitive {
            frame,
            kind,
            name: name.cloned(),
            cut,
        });
        Tree::Leaf(self.primitives.len() - 1)
    }

    fn tree(&mut self, shape: &Shape, outer: &Frame, cut: bool) -> Tree {
        let at = |origin: Vector| Frame {
            origin,
            ..Frame::SCENE
        };
        match shape {
            Shape::Box(b) => {
                let (middle, half) = self.cuboid(b);
                let frame = at(middle).within(outer);
                self.leaf(frame, Kind::Box(half), b.name.as_ref(), cut)
            }
            Shape::Cylinder(c) => {
                let frame = Frame::upright(vector(&c.centre_m), c.axis.index()).within(outer);
                let kind = Kind::Cylinder {
                    radius: c.radius_m,
                    half: 0.5 * c.length_m,
                };
                self.leaf(frame, kind, c.name.as_ref(), cut)
            }
            Shape::Disc(d) => {
                let kind = Kind::Cylinder {
                    radius: d.radius_m,
                    half: f64::INFINITY,
                };
                let frame = at(vector(&d.centre_m)).within(outer);
                self.leaf(frame, kind, d.name.as_ref(), cut)
            }
            Shape::Sphere(s) => {
                let frame = at(vector(&s.centre_m)).within(outer);
                self.leaf(frame, Kind::Ball(s.radius_m), s.name.as_ref(), cut)
            }
            Shape::Ellipsoid(e) => {
                let frame = at(vector(&e.centre_m)).within(outer);
                self.leaf(frame, self.ellipsoid(e), e.name.as_ref(), cut)
            }
            Shape::HalfSpace(h) => {
                let frame = Frame::facing(vector(&h.point_m), vector(&h.normal)).within(outer);
                self.leaf(frame, Kind::HalfSpace, h.name.as_ref(), cut)
            }
            Shape::Stl(stl) => {
                let (kind, middle) = surface(stl);
                self.leaf(at(middle).within(outer), kind, stl.name.as_ref(), cut)
            }
            Shape::Turned(t) => {
                let about = t.about_m.as_deref().map_or([0.0; 3], vector);
                let turn = Frame::turned(t.axis.index(), t.angle_deg.to_radians(), about);
                self.tree(&t.shape, &turn.within(outer), cut)
            }
            Shape::Union(shapes) => Tree::Any(self.trees(shapes, outer, cut)),
            Shape::Intersection(shapes) => Tree::All(self.trees(shapes, outer, cut)),
            Shape::Difference(shapes) => {
                let mut trees = self.trees(&shapes[..1], outer, cut);
                trees.extend(self.trees(&shapes[1..], outer, !cut));
                Tree::First(trees)
            }
        }
    }

    /// Middle and half extents of a box.
    fn cuboid(&self, b: &BoxShape) -> (Vector, Vector) {
        let (low, high) = (vector(&b.min_m), vector(&b.max_m));
        let mut half: Vector = std::array::from_fn(|k| 0.5 * (high[k] - low[k]));
        if self.dimensions == 2 {
            half[2] = f64::INFINITY;
        }
        (std::array::from_fn(|k| 0.5 * (high[k] + low[k])), half)
    }

    fn ellipsoid(&self, e: &EllipsoidShape) -> Kind {
        let mut half = vector(&e.semi_axes_m);
        if self.dimensions == 2 {
            half[2] = f64::INFINITY;
        }
        Kind::Ellipsoid(Ellipsoid { half, beyond: 0.0 })
    }

    fn trees(&mut self, shapes: &[Shape], outer: &Frame, cut: bool) -> Vec<Tree> {
        shapes.iter().map(|s| self.tree(s, outer, cut)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(text: &str, dimensions: usize) -> Body {
        Body::new(&serde_json::from_str(text).unwrap(), dimensions)
    }

    #[test]
    fn distances_of_primitives() {
        let block = body(r#"{"box": {"min_m": [0, 0, 0], "max_m": [2, 4, 6]}}"#, 3);
        assert!((block.distance([1.0, 1.0, 3.0]) + 1.0).abs() < 1e-15);
        assert!((block.distance([5.0, 8.0, 3.0]) - 5.0).abs() < 1e-15);
        let bar = body(
            r#"{"cylinder": {"centre_m": [0, 0, 1], "axis": "x", "radius_m": 2, "length_m": 2}}"#,
            3,
        );
        assert!((bar.distance([0.0, 0.0, 1.0]) + 1.0).abs() < 1e-15);
        assert!((bar.distance([4.0, 6.0, 1.0]) - 5.0).abs() < 1e-15);
        let plane = body(
            r#"{"half_space": {"point_m": [1, 0], "normal": [1, 1]}}"#,
            2,
        );
        assert!((plane.distance([2.0, 1.0, 0.0]) - 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn compositions_have_the_right_sign() {
        let ring = body(
            r#"{"difference": [{"disc": {"centre_m": [0, 0], "radius_m": 2}},
                               {"disc": {"name": "hole", "centre_m": [0.5, 0], "radius_m": 1}}]}"#,
            2,
        );
        assert!(ring.holds([-1.0, 0.0, 0.0]) && !ring.holds([0.5, 0.0, 0.0]));
        assert!(!ring.holds([2.1, 0.0, 0.0]));
        assert!(ring.primitives[1].cut && !ring.primitives[0].cut);
        let n = ring.normal([-0.45, 0.0, 0.0], 1e-6);
        assert!(
            (n[0] - 1.0).abs() < 1e-9,
            "the hole's face looks into the hole"
        );
        assert_eq!(ring.bounds()[1][..2], [2.0, 2.0]);
    }

    #[test]
    fn what_is_cut_away_shrinks_where_a_body_grows() {
        let ring = body(
            r#"{"difference": [{"disc": {"centre_m": [0, 0], "radius_m": 2}},
                               {"box": {"min_m": [-1, -0.5], "max_m": [1, 0.5]}}]}"#,
            2,
        );
        let grown = ring.grown(0.25).unwrap();
        assert!((grown.distance([2.5, 0.0, 0.0]) - 0.25).abs() < 1e-15);
        assert!((grown.distance([0.5, 0.0, 0.0]) - 0.25).abs() < 1e-15);
        assert!(grown.distance([0.0, 0.3, 0.0]) < 0.0);
        assert!(ring.grown(0.6).is_none());
        let below = body(
            r#"{"half_space": {"point_m": [0, 1], "normal": [0, 2]}}"#,
            2,
        );
        let grown = below.grown(0.5).unwrap();
        assert!((grown.distance([7.0, 2.0, 0.0]) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_turned_box_lies_where_it_should() {
        let turned = body(
            r#"{"turned": {"angle_deg": 90, "shape": {"box": {"min_m": [0, 0], "max_m": [2, 1]}}}}"#,
            2,
        );
        assert!(turned.holds([-0.5, 1.5, 0.0]) && !turned.holds([1.5, 0.5, 0.0]));
        let [low, high] = turned.bounds();
        assert!((low[0] + 1.0).abs() < 1e-12 && (high[1] - 2.0).abs() < 1e-12);
    }
}
