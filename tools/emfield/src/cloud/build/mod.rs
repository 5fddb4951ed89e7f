//! From a layout to its points, step by step.
//!
//! 1. `count`: whether there is room for them;
//! 2. `surface`: a [`seed`] for each point of a surface, of the `areas` that they stand for; `faces`: where bodies touch;
//! 3. `layers` along normals, and points across `gaps`; `inner`: these and lattices between them;
//! 4. `cells`: what each point of a conductor stands for.

mod areas;
mod cells;
pub(crate) mod count;
mod faces;
mod gaps;
mod inner;
mod layers;
pub(crate) mod seed;
pub(crate) mod surface;

use run::Fault;
use shapes::Body;
use shapes::frame::{Vector, along, difference, direction};
use shapes::shape::{Disc, Shape, Sphere};

use self::layers::{Column, thicknesses};
use self::surface::Seed;
use crate::cloud::lattice::{self, Node};
use crate::cloud::layout::{Layout, SURROUNDINGS, Solid, Wall};
use crate::cloud::occupied::Occupied;
use crate::cloud::points::{Layers, Points};
use crate::cloud::{Class, Cloud, Counts, Filling, Metric};
use crate::geometry::Geometry;

/// Least width of a body over its spacing: the points of a smaller one hang together with each other alone.
const NARROW: f64 = 0.5;

/// The points of a layout; see [`Cloud::new`].
pub(crate) fn cloud(mut layout: Layout, filling: &Filling<'_>) -> Result<Cloud, Vec<Fault>> {
    check_sizes(&layout, filling)?;
    let points = filling.points;
    let plans = plans(&points.layers, &mut layout);
    let mut builder = Builder::new(layout, points);
    let nodes = lattice::nodes(&builder.layout);
    let mut columns = builder.surfaces()?;
    let walls = points.wall_layers.as_ref();
    let wall = builder.wall(&nodes, walls);
    columns.extend(wall);
    builder.layers(&mut columns, &plans, walls);
    builder.lattices(&nodes, &columns, points.arrangement);
    builder.shake(points);
    builder.extra(&points.extra_m)?;
    let mut cloud = builder.cloud;
    cells::fill(&filling.shares, &builder.layout, &columns, &mut cloud);
    finish(&mut cloud);
    Ok(cloud)
}

/// Refuses bodies that points cannot follow, and more points than there is room for.
fn check_sizes(layout: &Layout, filling: &Filling<'_>) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    for (k, solid) in layout.solids.iter().enumerate() {
        let size = solid.widths(layout.dimensions);
        let widest = size.fold(0.0, f64::max);
        if !widest.is_finite() {
            faults.push(Fault::at(
                &format!("/bodies/{k}/shape"),
                "the body has no end",
            ));
        } else if widest < NARROW {
            let what = format!(
                "the body is {widest:.1e} spacings of {} m wide, which points around it cannot follow; at least {NARROW}",
                solid.spacing
            );
            faults.push(Fault::at(&format!("/bodies/{k}/shape"), what));
        }
    }
    if faults.is_empty() {
        count::check(layout, filling)
    } else {
        Err(faults)
    }
}

/// Thickness of the layers of each body, inside and outside; the layout learns how far they reach.
fn plans(layers: &Layers, layout: &mut Layout) -> Vec<[Vec<f64>; 2]> {
    let plan = |solid: &mut Solid| {
        let sides = [layers.inside, layers.outside].map(|n| thicknesses(layers, solid.spacing, n));
        solid.reach = [0, 1].map(|side| sides[side].iter().sum());
        sides
    };
    layout.solids.iter_mut().map(plan).collect()
}

/// A cloud in the making.
pub(crate) struct Builder {
    pub(crate) layout: Layout,
    /// Points on surfaces and in layers, with the spacing of each: lattices keep clear of them.
    pub(crate) occupied: Occupied,
    pub(crate) sizes: Vec<f64>,
    /// Greatest spacing of points on surfaces and in layers \[m\].
    pub(crate) widest: f64,
    pub(crate) cloud: Cloud,
}

impl Builder {
    fn new(layout: Layout, points: &Points) -> Self {
        let bodies = layout.solids.iter().map(|solid| solid.name.clone());
        Self {
            occupied: Occupied::new(layout.spacing),
            sizes: Vec::new(),
            widest: 0.0,
            cloud: Cloud {
                geometry: layout.geometry,
                media: std::iter::once(SURROUNDINGS.to_owned())
                    .chain(bodies)
                    .collect(),
                wall: layout.wall.clone(),
                faces: layout.wall.faces(layout.geometry),
                pitch: points.spacing_m,
                further: points.extra_m.len(),
                position: Vec::new(),
                spacing: Vec::new(),
                class: Vec::new(),
                metric: Vec::new(),
                feet: Vec::new(),
                surface: Vec::new(),
                cells: Vec::new(),
                counts: Counts::default(),
            },
            layout,
        }
    }

    pub(crate) fn push(&mut self, x: Vector, spacing: f64, class: Class, metric: Metric) -> u32 {
        self.cloud.position.push(x);
        self.cloud.spacing.push(spacing);
        self.cloud.class.push(class);
        self.cloud.metric.push(metric);
        self.cloud.len() as u32 - 1
    }

    /// Points on the wall: nodes of the lattice on a box, a surface of its own on a ball.
    fn wall(&mut self, nodes: &[Node], layers: Option<&Layers>) -> Vec<Column> {
        let before = self.cloud.len();
        let mut columns = Vec::new();
        match self.layout.wall.clone() {
            Wall::Box { .. } => {
                for node in nodes {
                    if let Some(face) = node.face {
                        self.outer(node.place, node.spacing, face);
                    }
                }
            }
            Wall::Ball { centre, radius } => {
                for seed in self.ball(centre, radius, layers.is_some()) {
                    if self.layout.axisymmetric() && seed.place[0] < 0.0 {
                        continue;
                    }
                    if let Some(point) = self.outer(seed.place, seed.spacing, 0) {
                        let media = [self.medium_at_wall(&seed), 0];
                        columns.push(Column::bare(seed, point, None, media));
                    }
                }
            }
        }
        self.cloud.counts.outer = self.cloud.len() - before;
        columns
    }

    /// Points that are given one by one, as they are.
    fn extra(&mut self, places: &[Vec<f64>]) -> Result<(), Vec<Fault>> {
        let mut faults = Vec::new();
        for (number, place) in places.iter().enumerate() {
            let x = crate::cloud::layout::vector(place);
            if self.layout.depth(x) <= 0.0 {
                let at = format!("/points/extra_m/{number}");
                faults.push(Fault::at(&at, "the point does not lie within the domain"));
                continue;
            }
            let spacing = self.layout.wanted(x, 0.0);
            let class = Class::Inside(self.layout.medium(x));
            self.push(x, spacing, class, Metric::Round);
            self.cloud.counts.lattice += 1;
        }
        if faults.is_empty() {
            Ok(())
        } else {
            Err(faults)
        }
    }

    fn medium_at_wall(&self, seed: &Seed) -> u16 {
        self.layout
            .medium(along(seed.place, -1e-4 * seed.spacing, seed.normal))
    }

    fn ball(&self, centre: Vector, radius: f64, layered: bool) -> Vec<Seed> {
        let name = None;
        let shape = if self.layout.dimensions == 3 {
            let centre_m = centre.to_vec();
            Shape::Sphere(Sphere {
                name,
                centre_m,
                radius_m: radius,
            })
        } else {
            let centre_m = centre[..2].to_vec();
            Shape::Disc(Disc {
                name,
                centre_m,
                radius_m: radius,
            })
        };
        let body = Body::new(&shape, self.layout.dimensions);
        let mut spacing = self.layout.largest;
        for k in 0..2 * self.layout.dimensions {
            let mut x = centre;
            x[k / 2] += if k % 2 == 0 { -radius } else { radius };
            spacing = spacing.min(self.layout.wanted(x, 0.0));
        }
        if layered {
            spacing = spacing.min(self.layout.spacing);
        }
        self.on_axis(surface::seeds(
            &body,
            self.layout.dimensions,
            spacing,
            spacing,
            &|_| spacing,
        ))
    }

    fn outer(&mut self, x: Vector, spacing: f64, face: u8) -> Option<u32> {
        if self.occupied.any(x, 0.3 * spacing, |_, _, _| true) {
            return None;
        }
        let inward = match &self.layout.wall {
            Wall::Ball { centre, .. } => direction(difference(*centre, x)),
            Wall::Box { low, high, .. } => std::array::from_fn(|k| {
                if k < self.layout.dimensions {
                    (0.5 * (low[k] + high[k]) - x[k]).signum()
                } else {
                    0.0
                }
            }),
        };
        let medium = self.layout.medium(along(x, 1e-6 * spacing, inward));
        Some(self.push(x, spacing, Class::Outer { medium, face }, Metric::Round))
    }
}

/// Turns coordinates of the scene into places in space.
fn finish(cloud: &mut Cloud) {
    let geometry = cloud.geometry;
    if geometry != Geometry::Axisymmetric {
        return;
    }
    for (surface, x) in cloud.surface.iter_mut().zip(&cloud.position) {
        surface.area *= std::f64::consts::TAU * x[0];
        surface.normal = geometry.place(surface.normal);
    }
    for x in &mut cloud.position {
        *x = geometry.place(*x);
    }
    for foot in &mut cloud.feet {
        foot.place = geometry.place(foot.place);
        foot.curvature.along = geometry.place(foot.curvature.along);
    }
    for metric in &mut cloud.metric {
        if let Metric::Layered { normal, .. } = metric {
            *normal = geometry.place(*normal);
        }
    }
}
