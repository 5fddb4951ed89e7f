//! The plane in which fields are shown: its window, the points about it, and the fields between them.

use super::columns::{Columns, Part, Quantity};
use super::scene::Geometry;
use super::{Kind, Points};
use crate::draw::contour::Grid;
use crate::heat::fit::{Fit, Sample};

/// Half of the slab whose points tell of a section in space, in distances of neighbours.
const SLAB: f64 = 1.7;
/// Room around bodies, as part of half of their extent: for fields around them, and for those within.
const ROOM: [f64; 2] = [0.65, 0.08];
/// Nodes along the longer side.
const NODES: f64 = 210.0;
/// Where a plane lies and how much of it is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    /// Axes to the right and upwards: 0, 1, 2 for x, y, z.
    pub(crate) axes: [usize; 2],
    /// The axis across, and where the plane cuts it \[m\]; `None` where points lie in the plane.
    pub(crate) cut: Option<(usize, f64)>,
    /// Ranges to the right and upwards \[m\].
    pub(crate) window: [[f64; 2]; 2],
}

/// A field at the nodes of a plane: one set for each medium in it, not a number far from it.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    /// Nodes to the right \[m\].
    pub(crate) across: Vec<f64>,
    /// Nodes upwards \[m\].
    pub(crate) up: Vec<f64>,
    /// Media and their values.
    pub(crate) media: Vec<(u8, Vec<f64>)>,
}

/// Weights of points at the nodes of a plane, medium by medium.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    /// Where it lies.
    pub(crate) view: View,
    across: Vec<f64>,
    up: Vec<f64>,
    media: Vec<Weights>,
}

/// Weights of the points of a medium at the nodes where it is.
#[derive(Debug, Clone)]
struct Weights {
    medium: u8,
    /// Point, and its number among interfaces where their outer side is of this medium.
    sources: Vec<(usize, Option<usize>)>,
    shares: Vec<Vec<(u32, f64)>>,
}

impl View {
    /// The whole domain: in space across an axis through the middle of the bodies.
    pub(crate) fn whole(points: &Points, across: usize) -> Self {
        let (axes, cut) = match points.scene.geometry {
            Geometry::Plane => ([0, 1], None),
            Geometry::Axisymmetric => ([0, 2], None),
            Geometry::Space => {
                let axes = [[1, 2], [0, 2], [0, 1]][across.min(2)];
                let middle = bodies(points).map_or(0.0, |b| middle(b[across]));
                (axes, Some((across, middle)))
            }
        };
        let bounds = bounds(points.position.iter());
        let window = axes.map(|k| bounds.map_or([0.0, 1.0], |b| b[k]));
        Self { axes, cut, window }
    }

    /// What lies about the bodies; the whole where there are none.
    pub(crate) fn near(points: &Points, across: usize) -> Self {
        Self::around(points, across, ROOM[0])
    }

    /// The bodies with little around them; the whole where there are none.
    pub(crate) fn close(points: &Points, across: usize) -> Self {
        Self::around(points, across, ROOM[1])
    }

    fn around(points: &Points, across: usize, part: f64) -> Self {
        let mut view = Self::whole(points, across);
        let Some(bodies) = bodies(points) else {
            return view;
        };
        let extent = bodies.iter().fold(0.0_f64, |m, [a, b]| m.max(b - a));
        let room = part * 0.5 * extent;
        for (range, axis) in view.window.iter_mut().zip(view.axes) {
            let [low, high] = bodies[axis];
            *range = [range[0].max(low - room), range[1].min(high + room)];
        }
        view
    }

    /// A place of the plane in space \[m\].
    pub(crate) fn place(&self, p: [f64; 2]) -> [f64; 3] {
        let mut place = [0.0; 3];
        if let Some((axis, at)) = self.cut {
            place[axis] = at;
        }
        place[self.axes[0]] = p[0];
        place[self.axes[1]] = p[1];
        place
    }

    /// A place in space: to the right, upwards, off the plane \[m\].
    pub(crate) fn project(&self, p: [f64; 3]) -> [f64; 3] {
        let off = self.cut.map_or(0.0, |(axis, at)| p[axis] - at);
        [p[self.axes[0]], p[self.axes[1]], off]
    }

    /// Whether the window holds a place, with room on all sides \[m\].
    pub(crate) fn holds(&self, at: [f64; 3], room: f64) -> bool {
        (0..2).all(|k| at[k] >= self.window[k][0] - room && at[k] <= self.window[k][1] + room)
    }
}

impl Plane {
    /// The plane of a view.
    pub(crate) fn new(points: &Points, view: View) -> Self {
        let size = view.window.map(|[a, b]| b - a);
        let step = size[0].max(size[1]) / NODES;
        let nodes = |k: usize| {
            let count = (size[k] / step).round().max(2.0) as usize;
            let at = |n: usize| view.window[k][0] + size[k] * n as f64 / count as f64;
            (0..=count).map(at).collect::<Vec<f64>>()
        };
        let mut plane = Self {
            view,
            across: nodes(0),
            up: nodes(1),
            media: Vec::new(),
        };
        let there = plane.there(points);
        let last = there.iter().flatten().copied().max().unwrap_or(0);
        for medium in 0..=last {
            let own = plane.weights(points, medium, &there);
            plane.media.extend(own);
        }
        plane
    }

    /// The medium at each node; `None` outside the domain.
    fn there(&self, points: &Points) -> Vec<Option<u8>> {
        let mut found = Vec::with_capacity(self.across.len() * self.up.len());
        for u in &self.across {
            for v in &self.up {
                let place = self.view.place([*u, *v]);
                let inside = points.scene.within(place);
                found.push(inside.then(|| points.scene.medium(place)));
            }
        }
        found
    }

    /// The points whose fields hold in a medium near the plane, as samples.
    fn samples(&self, points: &Points, medium: u8) -> (Vec<Sample>, Vec<(usize, Option<usize>)>) {
        let mut meeting = vec![None; points.position.len()];
        for (k, m) in points.meetings.iter().enumerate() {
            if m.media[1] == medium {
                meeting[m.point] = Some(k);
            }
        }
        let (mut samples, mut sources) = (Vec::new(), Vec::new());
        for (n, place) in points.position.iter().enumerate() {
            let own = points.medium[n] == medium;
            let beyond = meeting[n].filter(|_| !own && points.kind[n] == Kind::Interface);
            if !own && beyond.is_none() {
                continue;
            }
            let at = self.view.project(*place);
            let reach = points.spacing[n];
            if at[2].abs() <= SLAB * reach && self.view.holds(at, 3.0 * reach) {
                let value = reach;
                samples.push(Sample { at, value });
                sources.push((n, beyond));
            }
        }
        (samples, sources)
    }

    fn weights(&self, points: &Points, medium: u8, there: &[Option<u8>]) -> Option<Weights> {
        let (samples, sources) = self.samples(points, medium);
        let fit = Fit::new(samples)?;
        let high = self.up.len();
        let near = |i: usize, k: usize| {
            let rows = i.saturating_sub(1)..=(i + 1).min(self.across.len() - 1);
            rows.into_iter().any(|a| {
                let columns = k.saturating_sub(1)..=(k + 1).min(high - 1);
                columns
                    .into_iter()
                    .any(|b| there[a * high + b] == Some(medium))
            })
        };
        let mut shares = Vec::with_capacity(there.len());
        for (i, u) in self.across.iter().enumerate() {
            for (k, v) in self.up.iter().enumerate() {
                let close = near(i, k);
                shares.push(if close {
                    fit.shares([*u, *v])
                } else {
                    Vec::new()
                });
            }
        }
        Some(Weights {
            medium,
            sources,
            shares,
        })
    }

    /// A quantity in the plane; `None` where it is absent.
    pub(crate) fn field(&self, points: &Points, quantity: &Quantity) -> Option<Field> {
        let values = points.columns.values(quantity)?;
        let outer = beyond(&points.surface, quantity);
        let media = self
            .media
            .iter()
            .filter(|w| !quantity.conductors || points.scene.conducts(w.medium));
        let one = |w: &Weights| {
            let value = |n: u32| match w.sources[n as usize] {
                (point, None) => values[point],
                (point, Some(k)) => outer.as_ref().map_or(values[point], |o| o[k]),
            };
            (w.medium, w.evaluate(value))
        };
        Some(Field {
            across: self.across.clone(),
            up: self.up.clone(),
            media: media.map(one).collect(),
        })
    }

    /// Components of vectors to the right and upwards in the plane.
    pub(crate) fn arrows(
        &self,
        points: &Points,
        quantity: &Quantity,
        part: Part,
    ) -> Option<[Field; 2]> {
        let vectors = points.columns.vectors(quantity, part)?;
        let outer = points.surface.joined(&format!("{}_outer", quantity.stem));
        let of = |axis: usize| Field {
            across: self.across.clone(),
            up: self.up.clone(),
            media: self
                .media
                .iter()
                .filter(|w| !quantity.conductors || points.scene.conducts(w.medium))
                .map(|w| {
                    let value = |n: u32| match w.sources[n as usize] {
                        (point, None) => vectors[point][axis],
                        (point, Some(k)) => {
                            outer.as_ref().map_or(vectors[point][axis], |o| o[k][axis])
                        }
                    };
                    (w.medium, w.evaluate(value))
                })
                .collect(),
        };
        Some(self.view.axes.map(of))
    }
}

impl Weights {
    fn evaluate(&self, value: impl Fn(u32) -> f64) -> Vec<f64> {
        let at = |shares: &Vec<(u32, f64)>| match shares.as_slice() {
            [] => f64::NAN,
            all => all.iter().map(|(n, weight)| weight * value(*n)).sum(),
        };
        self.shares.iter().map(at).collect()
    }
}

impl Field {
    /// The value at a place of a medium; `None` where none is known.
    pub(crate) fn sample(&self, medium: u8, p: [f64; 2]) -> Option<f64> {
        let grid = self.grid(medium)?;
        grid.sample(p[0], p[1]).filter(|v| v.is_finite())
    }

    /// The nodes and values of a medium.
    pub(crate) fn grid(&self, medium: u8) -> Option<Grid<'_>> {
        let values = &self.media.iter().find(|(m, _)| *m == medium)?.1;
        Some(Grid {
            first: &self.across,
            second: &self.up,
            values,
        })
    }
}

/// Sizes of a quantity on the outer side of interfaces, where they are written.
fn beyond(surface: &Columns, quantity: &Quantity) -> Option<Vec<f64>> {
    let all = surface.joined(&format!("{}_outer", quantity.stem))?;
    let size = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    Some(all.iter().map(size).collect())
}

/// The middle of a range; zero where points miss it by little.
fn middle([low, high]: [f64; 2]) -> f64 {
    let middle = 0.5 * (low + high);
    if middle.abs() < 2e-3 * (high - low) {
        0.0
    } else {
        middle
    }
}

/// Ranges of the bodies along x, y and z \[m\].
fn bodies(points: &Points) -> Option<[[f64; 2]; 3]> {
    let own = |n: &usize| points.medium[*n] > 0;
    let all = (0..points.position.len()).filter(own);
    bounds(all.map(|n| &points.position[n]))
}

fn bounds<'a>(places: impl Iterator<Item = &'a [f64; 3]>) -> Option<[[f64; 2]; 3]> {
    places.fold(None, |all: Option<[[f64; 2]; 3]>, p| {
        let old = all.unwrap_or(p.map(|x| [x, x]));
        Some([0, 1, 2].map(|k| [old[k][0].min(p[k]), old[k][1].max(p[k])]))
    })
}
