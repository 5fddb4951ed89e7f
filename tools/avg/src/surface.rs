//! Where the surface of the metal is above a place of the plan.
//!
//! The share of metal, smoothed by the kernel, is
//!
//! ```text
//! C(x) = V sum_b W(|x - x_b|)
//! ```
//!
//! and one half on a plane surface, half a spacing above the outermost particles of a lattice. The
//! surface above a place is the highest point of its vertical where C comes up to one half. What
//! overhangs hides what is below, as an arc above sees it. A surface that bends is moved towards the
//! side that it bends to by half the variance of the kernel along a line, 0.15 h^2, times the sum of
//! its curvatures; particles drawn together at the surface by a fifth move it outwards by 0.12 h.

use kernels::CubicSpline;
use neighbours::Grid;

use crate::cloud::Cloud;
use crate::mean::Smoothing;

/// Share of metal on the surface.
const SURFACE: f64 = 0.5;
/// Steps down the vertical, per smoothing length.
const STEPS: f64 = 4.0;
/// Halvings of the step that holds the surface.
const HALVINGS: u32 = 14;

/// Height of the surface above a place of the plan \[m\]; `None` without metal there. `flat` holds
/// the shadows of the particles of `cloud` on the plan.
#[must_use]
pub fn height(cloud: &Cloud, flat: &Grid, place: [f64; 2], smoothing: &Smoothing) -> Option<f64> {
    let kernel = CubicSpline::<3>::new(smoothing.length);
    let column = Column::new(cloud, flat, place, &kernel);
    let top = column.near.first()?[1];
    let bottom = column.near.last()?[1];
    let is_metal = |z: f64| smoothing.volume * column.sum(z, &kernel) >= SURFACE;
    let step = smoothing.length / STEPS;
    let mut above = top + kernel.support();
    loop {
        let below = above - step;
        if below < bottom {
            return None;
        }
        if is_metal(below) {
            return Some(between(below, above, is_metal));
        }
        above = below;
    }
}

/// Halves the interval of which the lower end is metal and the upper one is not.
fn between(mut below: f64, mut above: f64, is_metal: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (below + above);
        if is_metal(middle) {
            below = middle;
        } else {
            above = middle;
        }
    }
    0.5 * (below + above)
}

/// The particles around a vertical.
struct Column {
    /// Square of the distance from the vertical \[m2\] and height \[m\], from the highest down.
    near: Vec<[f64; 2]>,
}

impl Column {
    fn new(cloud: &Cloud, flat: &Grid, [x, y]: [f64; 2], kernel: &CubicSpline<3>) -> Self {
        let support = kernel.support();
        let mut near = Vec::new();
        flat.runs([x, y, 0.0], support, |run| {
            for k in run {
                let shadow = flat.sorted()[k];
                let (dx, dy) = (shadow[0] - x, shadow[1] - y);
                let square = dx * dx + dy * dy;
                if square < support * support {
                    near.push([square, cloud.position[flat.order()[k] as usize][2]]);
                }
            }
        });
        near.sort_by(|a, b| b[1].total_cmp(&a[1]));
        Self { near }
    }

    /// Sum of the kernel over the particles around height `z` \[1/m3\].
    fn sum(&self, z: f64, kernel: &CubicSpline<3>) -> f64 {
        let support = kernel.support();
        let from = self.near.partition_point(|n| n[1] >= z + support);
        self.near[from..]
            .iter()
            .take_while(|n| n[1] > z - support)
            .map(|n| kernel.value((n[0] + (n[1] - z).powi(2)).sqrt()))
            .sum()
    }
}
