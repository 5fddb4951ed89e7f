//! Links within the support of the kernel, and the weights that the kernel gives them.

use std::sync::Arc;

use kernels::CubicSpline;
use krylov::Pattern;
use neighbours::{Grid, Lists};

use super::OperatorError;
use crate::cloud::Cloud;
use shapes::frame::{Vector, difference, dot, length};

/// A link steeper than this against a face is whole; one along the face has half of its cross-section outside.
const STEEP: f64 = 0.3;

/// Pattern and weights of the pair form, `a_ij = 2 V_i V_j F_ij`, with the volumes as they would be far from any
/// surface (in print all particles have one mass, those of the surface too), and of each link the part of its
/// cross-section that lies inside the body.
///
/// The sum that stands for the integral of `F r^2` is not exactly the number of dimensions, however fine the
/// points; the weights are divided by its value on a plain lattice, so that the diffusivity is right.
///
/// # Errors
/// When a point has no neighbour.
pub fn pair(cloud: &Cloud, smoothing: f64) -> Result<(Arc<Pattern>, Vec<f64>), OperatorError> {
    let faces = Faces::of(cloud);
    let full: Vec<f64> = (0..cloud.share.len())
        .map(|i| cloud.share[i] * f64::from(1_u32 << faces.at(i).len().min(3)))
        .collect();
    let pattern = Arc::new(search(cloud, smoothing)?);
    let scale = 2.0 / lattice_moment(smoothing, cloud.dimensions);
    let mut weight = vec![0.0; pattern.columns().len()];
    fill(&pattern, &mut weight, |i, j| {
        let d = difference(cloud.position[j], cloud.position[i]);
        let h = 0.5 * smoothing * (cloud.spacing[i] + cloud.spacing[j]);
        let force = -slope(length(d), h, cloud.dimensions);
        let inside = faces.inside(i, d) * faces.inside(j, d);
        scale * force * (full[i] * full[j] * inside.sqrt())
    });
    Ok((pattern, weight))
}

/// Sets one value per link, on all threads.
pub(super) fn fill(
    pattern: &Pattern,
    values: &mut [f64],
    each: impl Fn(usize, usize) -> f64 + Sync,
) {
    rows(pattern, values, |i, columns, values| {
        for (value, j) in values.iter_mut().zip(columns) {
            *value = each(i, *j as usize);
        }
    });
}

/// Hands each row of values over, on all threads.
pub(crate) fn rows<T: Send>(
    pattern: &Pattern,
    values: &mut [T],
    each: impl Fn(usize, &[u32], &mut [T]) + Sync,
) {
    divide(pattern, 0..pattern.rows(), values, &each);
}

/// Rows that are not worth dividing.
const ROWS: usize = 512;

fn divide<T: Send>(
    pattern: &Pattern,
    range: std::ops::Range<usize>,
    values: &mut [T],
    each: &(impl Fn(usize, &[u32], &mut [T]) + Sync),
) {
    if range.len() > ROWS {
        let half = range.start + range.len() / 2;
        let cut = pattern.offsets()[half] - pattern.offsets()[range.start];
        let (low, high) = values.split_at_mut(cut);
        rayon::join(
            || divide(pattern, range.start..half, low, each),
            || divide(pattern, half..range.end, high, each),
        );
        return;
    }
    let begin = pattern.offsets()[range.start];
    for i in range {
        let row = pattern.row(i);
        let columns = &pattern.columns()[row.clone()];
        each(i, columns, &mut values[row.start - begin..row.end - begin]);
    }
}

/// The points within the support of each other.
fn search(cloud: &Cloud, smoothing: f64) -> Result<Pattern, OperatorError> {
    let greatest = cloud.spacing.iter().fold(0.0_f64, |m, s| m.max(*s));
    // A lattice point at exactly the support has no weight; rounding must not make it a link.
    let support = 2.0 * smoothing * (1.0 - 1e-9);
    let radius = support * greatest;
    let (mut grid, mut lists) = (Grid::new(radius), Lists::new());
    grid.bin(&cloud.position);
    lists.build(
        grid.search(&cloud.position, radius),
        |_| true,
        |i, j| {
            let reach = 0.5 * support * (cloud.spacing[i] + cloud.spacing[j]);
            let d = difference(cloud.position[j], cloud.position[i]);
            dot(d, d) < reach * reach
        },
    );
    let mut offsets = Vec::with_capacity(cloud.position.len() + 1);
    let mut columns = Vec::with_capacity(lists.pairs());
    offsets.push(0);
    for i in 0..cloud.position.len() {
        let row = lists.row(i);
        if row.is_empty() && cloud.position.len() > 1 {
            return Err(OperatorError::Alone(cloud.position[i]));
        }
        columns.extend_from_slice(row);
        offsets.push(columns.len());
    }
    Ok(Pattern::new(offsets, columns))
}

/// (dW/dr)/r of the cubic spline.
fn slope(r: f64, h: f64, dimensions: usize) -> f64 {
    match dimensions {
        2 => CubicSpline::<2>::new(h).slope(r),
        _ => CubicSpline::<3>::new(h).slope(r),
    }
}

/// `sum V F r^2 / D` over a plain lattice: one but for the quadrature error of the kernel.
fn lattice_moment(smoothing: f64, dimensions: usize) -> f64 {
    let reach = (2.0 * smoothing).ceil() as i32;
    let depth = if dimensions == 3 { reach } else { 0 };
    let mut sum = 0.0;
    for i in -reach..=reach {
        for j in -reach..=reach {
            for k in -depth..=depth {
                let square = f64::from(i * i + j * j + k * k);
                if square > 0.0 {
                    sum -= slope(square.sqrt(), smoothing, dimensions) * square;
                }
            }
        }
    }
    sum / dimensions as f64
}

/// Normals of the faces on which each point lies.
struct Faces {
    offsets: Vec<usize>,
    normals: Vec<Vector>,
}

impl Faces {
    fn of(cloud: &Cloud) -> Self {
        let mut on: Vec<_> = cloud
            .patches
            .iter()
            .filter(|p| cloud.depth(p) < 1e-6 * cloud.spacing[p.point as usize])
            .collect();
        on.sort_by_key(|p| (p.point, p.face));
        let (mut offsets, mut normals) = (vec![0], Vec::new());
        let mut rest = on.as_slice();
        for i in 0..cloud.position.len() {
            let end = rest.partition_point(|p| p.point as usize <= i);
            for run in rest[..end].chunk_by(|a, b| a.face == b.face) {
                normals.push(run[0].normal);
            }
            rest = &rest[end..];
            offsets.push(normals.len());
        }
        Self { offsets, normals }
    }

    fn at(&self, i: usize) -> &[Vector] {
        &self.normals[self.offsets[i]..self.offsets[i + 1]]
    }

    /// Part of the cross-section of a link in direction `d` from point `i` that lies inside.
    fn inside(&self, i: usize, d: Vector) -> f64 {
        let r = length(d);
        self.at(i)
            .iter()
            .map(|n| 0.5 + 0.5 * (dot(d, *n).abs() / (STEEP * r)).min(1.0))
            .product()
    }
}
