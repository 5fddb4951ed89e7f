//! Points of a body and the surface that each of them owns.
//!
//! A cloud is all that the operators know of geometry: where points are, how far apart, how much of the body
//! each stands for, and which pieces of surface, with area, normal and middle, each owns. A point on the surface
//! owns pieces at no depth; a point of a cut lattice lies some way below its pieces.

mod closure;
mod cut;
mod lattice;
pub mod points;
mod rings;
pub mod room;
mod shells;
mod shift;

use points::{Arrangement, Points};
use shapes::frame::{Vector, along, difference, dot};
use shapes::surface::{self, Piece};
use shapes::{Body, Kind};

/// A piece of surface and the point that owns it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// The point.
    pub point: u32,
    /// Number of the face, in [`Cloud::faces`].
    pub face: u32,
    /// Area \[m2\]; length \[m\] in a plane scene.
    pub area: f64,
    /// Out of the body.
    pub normal: Vector,
    /// Middle \[m\].
    pub place: Vector,
}

/// Points of a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    /// 2 or 3.
    pub dimensions: usize,
    /// Places \[m\].
    pub position: Vec<Vector>,
    /// Distance to the neighbours, about \[m\].
    pub spacing: Vec<f64>,
    /// Volume that the point stands for by construction \[m3; m2 in a plane scene\].
    pub share: Vec<f64>,
    /// Pieces of the surface.
    pub patches: Vec<Patch>,
    /// Names of the faces.
    pub faces: Vec<String>,
    /// Whether it is a plain lattice, of one spacing along every axis.
    pub lattice: bool,
}

/// Why a body cannot be filled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CloudError {
    /// Only single primitives have an arrangement of their own.
    #[error(
        "a fitted arrangement needs a box, disc, cylinder or sphere; write \"arrangement\": \"cut\" for ellipsoids and compositions"
    )]
    NotSingle,
    /// The body has no end.
    #[error("the body has no end along {0}")]
    Endless(char),
    /// No point is inside.
    #[error("no point lies inside the body at this spacing of {0} m")]
    Empty(f64),
    /// More points than can be numbered.
    #[error("{0:.3e} points at this spacing; at most 2e9")]
    TooMany(f64),
    /// An extra point is outside.
    #[error("the point at ({}, {}, {}) m is not inside the body", .0[0], .0[1], .0[2])]
    Outside(Vector),
}

/// Most points of a cloud.
const MOST: f64 = 2e9;

impl Cloud {
    /// Fills a body with points.
    ///
    /// # Errors
    /// [`CloudError`].
    pub fn fill(body: &Body, points: &Points, dimensions: usize) -> Result<Self, CloudError> {
        let [low, high] = body.bounds();
        for k in 0..dimensions {
            if !(high[k] - low[k]).is_finite() {
                return Err(CloudError::Endless(['x', 'y', 'z'][k]));
            }
        }
        let cells: f64 = (0..dimensions)
            .map(|k| (high[k] - low[k]) / points.spacing_m + 1.0)
            .product();
        if cells > MOST {
            return Err(CloudError::TooMany(cells));
        }
        let mut cloud = match points.arrangement {
            Arrangement::Cut => cut::fill(body, points, dimensions)?,
            Arrangement::Fitted => Self::fitted(body, points, dimensions)?,
        };
        cloud.add(body, points)?;
        closure::close(&mut cloud);
        if cloud.position.is_empty() {
            return Err(CloudError::Empty(points.spacing_m));
        }
        Ok(cloud)
    }

    fn fitted(body: &Body, points: &Points, dimensions: usize) -> Result<Self, CloudError> {
        let primitive = body.single().ok_or(CloudError::NotSingle)?;
        let mut cloud = match &primitive.kind {
            &Kind::Box(half) => lattice::fill(half, points, dimensions),
            &Kind::Cylinder { radius, half } => rings::fill(radius, half, points, dimensions),
            &Kind::Ball(radius) => shells::fill(radius, points),
            Kind::Ellipsoid(_) | Kind::HalfSpace | Kind::Mesh(_) => {
                return Err(CloudError::NotSingle);
            }
        };
        for x in &mut cloud.position {
            *x = primitive.frame.place(*x);
        }
        for patch in &mut cloud.patches {
            patch.place = primitive.frame.place(patch.place);
            patch.normal = primitive.frame.turn(patch.normal);
        }
        cloud.faces = surface::names(body, dimensions);
        shift::inner_points(&mut cloud, points);
        Ok(cloud)
    }

    /// Adds further points.
    fn add(&mut self, body: &Body, points: &Points) -> Result<(), CloudError> {
        for extra in &points.extra_m {
            let x = std::array::from_fn(|k| extra.get(k).copied().unwrap_or(0.0));
            if body.distance(x) >= 0.0 {
                return Err(CloudError::Outside(x));
            }
            self.position.push(x);
            self.spacing.push(points.spacing_m);
            self.share
                .push(points.spacing_m.powi(self.dimensions as i32));
            self.lattice = false;
        }
        Ok(())
    }

    /// Adds a point.
    fn push(&mut self, x: Vector, spacing: f64, share: f64) -> u32 {
        self.position.push(x);
        self.spacing.push(spacing);
        self.share.push(share);
        self.position.len() as u32 - 1
    }

    /// How far a patch lies above its point \[m\].
    #[must_use]
    pub fn depth(&self, patch: &Patch) -> f64 {
        let x = self.position[patch.point as usize];
        dot(patch.normal, difference(patch.place, x))
    }

    /// Gives each piece of surface to the nearest point that lies below it.
    fn own(&mut self, pieces: &[Piece], spacing: f64) {
        let mut grid = neighbours::Grid::new(spacing);
        grid.bin(&self.position);
        for piece in pieces {
            if let Some(point) = nearest(&grid, piece, spacing) {
                self.patches.push(Patch {
                    point,
                    face: piece.face as u32,
                    area: piece.area,
                    normal: piece.normal,
                    place: piece.place,
                });
            }
        }
        self.merge();
    }

    /// Makes one patch of the pieces of a face that a point owns: same area, same sum of normals, same middle.
    fn merge(&mut self) {
        self.patches.sort_by_key(|p| (p.point, p.face));
        let mut merged: Vec<Patch> = Vec::new();
        for run in self
            .patches
            .chunk_by(|a, b| (a.point, a.face) == (b.point, b.face))
        {
            let area: f64 = run.iter().map(|p| p.area).sum();
            let sum = |of: fn(&Patch) -> Vector| {
                run.iter()
                    .fold([0.0; 3], |s, p| along(s, p.area / area, of(p)))
            };
            let normal = sum(|p| p.normal);
            merged.push(Patch {
                normal: shapes::frame::direction(normal),
                place: sum(|p| p.place),
                area,
                ..run[0]
            });
        }
        self.patches = merged;
    }
}

/// The point nearest to a piece among those below it.
fn nearest(grid: &neighbours::Grid, piece: &Piece, spacing: f64) -> Option<u32> {
    let mut reach = 1.5 * spacing;
    for _ in 0..6 {
        let mut best: Option<(f64, u32)> = None;
        grid.runs(piece.place, reach, |run| {
            for (x, index) in grid.sorted()[run.clone()].iter().zip(&grid.order()[run]) {
                let away = difference(piece.place, *x);
                let square = dot(away, away);
                let below = dot(away, piece.normal) > 0.0;
                if below && square < reach * reach && best.is_none_or(|b| (square, *index) < b) {
                    best = Some((square, *index));
                }
            }
        });
        if let Some((_, index)) = best {
            return Some(index);
        }
        reach *= 2.0;
    }
    None
}

/// Offsets between 0 and 1 of `steps` intervals, each `ratio` times the one before it.
fn graded(steps: usize, ratio: Option<f64>) -> Vec<f64> {
    let ratio = ratio.unwrap_or(1.0);
    if (ratio - 1.0).abs() < 1e-12 {
        return (0..=steps).map(|i| i as f64 / steps as f64).collect();
    }
    let whole = ratio.powi(steps as i32) - 1.0;
    (0..=steps)
        .map(|i| (ratio.powi(i as i32) - 1.0) / whole)
        .collect()
}

/// Width that each of the nodes stands for: half of the gaps beside it.
fn widths(nodes: &[f64]) -> Vec<f64> {
    let last = nodes.len() - 1;
    (0..=last)
        .map(|i| 0.5 * (nodes[(i + 1).min(last)] - nodes[i.saturating_sub(1)]))
        .collect()
}

/// The greater of the gaps beside each node.
fn gaps(nodes: &[f64]) -> Vec<f64> {
    let last = nodes.len() - 1;
    (0..=last)
        .map(|i| {
            let before = if i > 0 { nodes[i] - nodes[i - 1] } else { 0.0 };
            let after = if i < last {
                nodes[i + 1] - nodes[i]
            } else {
                0.0
            };
            before.max(after)
        })
        .collect()
}

#[cfg(test)]
mod tests;
