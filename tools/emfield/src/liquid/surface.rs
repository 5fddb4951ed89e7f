//! The free surface: normal, curvature and rows of derivatives along it, by fits in axes aligned with the normal.

use neighbours::Tree;
use rayon::prelude::*;

use super::cell::{Bisector, cell, twice};
use super::chart::{Chart, Frame, Near, exponents};
use super::vector::{along, difference, direction, dot, length, spatial};

/// Radius of a support in spacings: twice as many points as monomials and more.
const RADIUS: f64 = 3.4;
/// A support grows by this factor until it has points enough.
const GROWTH: f64 = 1.2;
/// Growths at most.
const GROWTHS: usize = 12;
/// Fits of a point, each in the axes, and on the sphere, that the one before it found.
const TURNS: usize = 3;
/// Largest radius of a support over that of the sphere beside which the surface is fitted.
const CAP: f64 = 0.9;
/// Normals further apart than this cosine belong to another side.
pub(super) const SIDE: f64 = 0.0;
/// Times that a new point is moved onto the fit about it.
const SETTLES: usize = 3;

/// The surface near one of its points.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch<const D: usize> {
    /// Unit normal, out of the liquid.
    pub normal: [f64; D],
    /// Sum of the principal curvatures, that of a sphere 2/R \[1/m\].
    pub curvature: f64,
    /// Sum of their squares \[1/m2\].
    pub squares: f64,
    /// How far along the normal the fit passes from the point \[m\].
    pub offset: f64,
    /// Area that belongs to the point \[m2; m in a plane\].
    pub area: f64,
    /// Points of the fit, the own one among them.
    pub neighbours: Vec<u32>,
    /// Weights of the value of the fit.
    pub value: Vec<f64>,
    /// Weights of the Laplacian along the surface \[1/m2\].
    pub laplace: Vec<f64>,
    /// Weights of the gradient along the surface, in the axes of the scene \[1/m\].
    pub slope: Vec<[f64; D]>,
}

/// Why a surface has no fit at a point.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "the surface of the liquid has too few points for a fit at {place:?} m: {found} within {radius:.3e} m, {wanted} are wanted; take a smaller spacing"
)]
pub struct Bare {
    /// Where \[m\].
    pub place: Vec<f64>,
    /// Points found.
    pub found: usize,
    /// Points wanted.
    pub wanted: usize,
    /// Within this distance \[m\].
    pub radius: f64,
}

/// Points of a surface, with their normals, about.
#[derive(Debug, Clone, Copy)]
pub struct Sheet<'a, const D: usize> {
    /// Places \[m\].
    pub points: &'a [[f64; D]],
    /// Unit normals, out of the liquid.
    pub normals: &'a [[f64; D]],
}

/// Patches of all surface points, from about known `normals`.
///
/// # Errors
/// Where too few points are near.
pub fn patches<const D: usize>(
    points: &[[f64; D]],
    normals: &[[f64; D]],
    spacing: f64,
) -> Result<Vec<Patch<D>>, Bare> {
    beside(Sheet { points, normals }, points.len(), spacing)
}

/// Patches of the first `own` surface points; the others are images.
///
/// # Errors
/// Where too few points are near.
pub fn beside<const D: usize>(
    sheet: Sheet<'_, D>,
    own: usize,
    spacing: f64,
) -> Result<Vec<Patch<D>>, Bare> {
    let Sheet { points, normals } = sheet;
    let places: Vec<[f64; 3]> = points.iter().map(spatial).collect();
    let tree = Tree::new(&places);
    let exponents = exponents(D - 1);
    (0..own)
        .into_par_iter()
        .map(|i| {
            let seat = Seat {
                place: points[i],
                normal: normals[i],
            };
            let near = support(&seat, sheet, &tree, spacing, exponents.len())?;
            Ok(fit(&seat, points, &near, &exponents))
        })
        .collect()
}

/// Where a point of a surface stands, about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seat<const D: usize> {
    /// Place \[m\].
    pub place: [f64; D],
    /// Unit normal, out of the liquid.
    pub normal: [f64; D],
}

/// Patches of a surface at seats where it may have no points; the seats are moved onto it.
///
/// # Errors
/// Where too few points are near.
pub fn between<const D: usize>(
    sheet: Sheet<'_, D>,
    seats: &mut [Seat<D>],
    spacing: f64,
) -> Result<Vec<Patch<D>>, Bare> {
    let places: Vec<[f64; 3]> = sheet.points.iter().map(spatial).collect();
    let tree = Tree::new(&places);
    let exponents = exponents(D - 1);
    seats
        .par_iter_mut()
        .map(|seat| {
            let near = support(seat, sheet, &tree, spacing, exponents.len())?;
            for _ in 0..SETTLES {
                let patch = fit(seat, sheet.points, &near, &exponents);
                seat.place = along(&seat.place, patch.offset, &patch.normal);
                seat.normal = patch.normal;
            }
            Ok(fit(seat, sheet.points, &near, &exponents))
        })
        .collect()
}

fn support<const D: usize>(
    seat: &Seat<D>,
    sheet: Sheet<'_, D>,
    tree: &Tree,
    spacing: f64,
    terms: usize,
) -> Result<Near, Bare> {
    let normals = sheet.normals;
    let wanted = if D == 2 { terms + 2 } else { 2 * terms };
    let mut radius = RADIUS * spacing;
    let mut near = Vec::new();
    for _ in 0..GROWTHS {
        near.clear();
        tree.within(spatial(&seat.place), radius, |j, _| {
            if dot(&seat.normal, &normals[j]) > SIDE {
                near.push(j as u32);
            }
        });
        if near.len() >= wanted {
            near.sort_unstable();
            return Ok(Near {
                points: near,
                radius,
                spacing,
            });
        }
        radius *= GROWTH;
    }
    Err(Bare {
        place: seat.place.to_vec(),
        found: near.len(),
        wanted,
        radius,
    })
}

/// Unit vectors across a normal; the second is zero in a plane.
#[must_use]
pub fn tangents<const D: usize>(n: &[f64; D]) -> [[f64; D]; 2] {
    if D == 2 {
        let mut t = [0.0; D];
        (t[0], t[1]) = (-n[1], n[0]);
        return [t, [0.0; D]];
    }
    let least = (0..D).fold(0, |k, j| if n[j].abs() < n[k].abs() { j } else { k });
    let mut axis = [0.0; D];
    axis[least] = 1.0;
    let first = direction(&along(&axis, -dot(&axis, n), n));
    let mut second = [0.0; D];
    for (k, c) in second.iter_mut().enumerate() {
        let (a, b) = ((k + 1) % D, (k + 2) % D);
        *c = n[a] * first[b] - n[b] * first[a];
    }
    [first, second]
}

/// z(x, y) = sum a_k x^p y^q by weighted least squares, z along the normal, turned until the surface does not rise at the
/// point: then (2.44), Matsuzawa (2017), with its exponent put right, is kappa = -(z_xx + z_yy).
fn fit<const D: usize>(
    seat: &Seat<D>,
    points: &[[f64; D]],
    near: &Near,
    exponents: &[[i32; 2]],
) -> Patch<D> {
    let (mut normal, mut bow) = (seat.normal, 0.0_f64);
    let mut turn = 0;
    loop {
        let axes = tangents(&normal);
        let most = CAP / near.radius;
        let frame = Frame {
            normal,
            axes,
            bow: bow.clamp(-most, most),
        };
        let local = Chart::new(&seat.place, points, frame, near, exponents);
        let [offset, x, y, xx, xy, yy] = local.derivatives(D == 3);
        let rise = [x, y];
        turn += 1;
        if turn <= TURNS {
            let turned = along(&along(&normal, -rise[0], &axes[0]), -rise[1], &axes[1]);
            normal = direction(&turned);
            bow = -(xx + yy) / (D - 1) as f64;
            continue;
        }
        let steep = 1.0 + rise[0] * rise[0] + rise[1] * rise[1];
        let bent = xx * (1.0 + rise[1] * rise[1]) - 2.0 * rise[0] * rise[1] * xy
            + yy * (1.0 + rise[0] * rise[0]);
        let slope = |m: usize| {
            along(
                &axes[0].map(|a| a * local.weights[1][m]),
                local.weights[2][m],
                &axes[1],
            )
        };
        return Patch {
            normal,
            curvature: -bent / steep.powf(1.5),
            squares: xx * xx + 2.0 * xy * xy + yy * yy,
            offset,
            area: area(&seat.place, points, near, axes),
            value: local.weights[0].clone(),
            laplace: (0..near.points.len())
                .map(|m| local.weights[3][m] + local.weights[5][m])
                .collect(),
            slope: (0..near.points.len()).map(slope).collect(),
            neighbours: near.points.clone(),
        };
    }
}

/// The part of the tangent plane that is nearer to the point than to any neighbour.
fn area<const D: usize>(
    place: &[f64; D],
    points: &[[f64; D]],
    near: &Near,
    axes: [[f64; D]; 2],
) -> f64 {
    let ways = near
        .points
        .iter()
        .map(|&j| difference(&points[j as usize], place));
    let flat = ways.filter(|d| dot(d, d) > 0.0).map(|d| {
        let (x, y) = (dot(&d, &axes[0]), dot(&d, &axes[1]));
        // A step along the surface is as long as the way there, not as its shadow.
        let shadow = x.hypot(y);
        let longer = if shadow > 0.0 {
            length(&d) / shadow
        } else {
            1.0
        };
        [x * longer, y * longer]
    });
    if D == 2 {
        let (mut ahead, mut behind) = (f64::INFINITY, f64::INFINITY);
        for [x, _] in flat {
            if x > 0.0 {
                ahead = ahead.min(x);
            } else {
                behind = behind.min(-x);
            }
        }
        return 0.5 * (ahead + behind);
    }
    let bisectors = flat.map(|way| Bisector {
        way,
        half: 0.5 * (way[0] * way[0] + way[1] * way[1]),
    });
    0.5 * twice(&cell(bisectors.collect(), near.spacing))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Even points of a spheroid of some ratio of axes, as large as the unit sphere, and their normals.
    fn spheroid(many: usize, ratio: f64) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
        let wide = ratio.cbrt().recip();
        let axes = [wide, wide, ratio * wide];
        let golden = PI * (3.0 - 5.0_f64.sqrt());
        let all = (0..many).map(|k| {
            let z = 1.0 - (2.0 * k as f64 + 1.0) / many as f64;
            let (ring, angle) = ((1.0 - z * z).sqrt(), golden * k as f64);
            let e = [ring * angle.cos(), ring * angle.sin(), z];
            let x: [f64; 3] = std::array::from_fn(|k| axes[k] * e[k]);
            (x, direction(&std::array::from_fn(|k| e[k] / axes[k])))
        });
        all.unzip()
    }

    /// Root of the mean square of what is wrong with the curvature over that of the sphere, five spacings a radius.
    fn wrong(ratio: f64) -> f64 {
        let (points, normals) = spheroid(330, ratio);
        let wide = ratio.cbrt().recip();
        let axes = [wide, wide, ratio * wide];
        let found = patches(&points, &normals, 0.2).unwrap();
        let squares = points.iter().zip(&found).map(|(x, patch)| {
            let slope: [f64; 3] = std::array::from_fn(|k| x[k] / (axes[k] * axes[k]));
            let n = direction(&slope);
            let bent = (0..3).map(|k| (1.0 - n[k] * n[k]) / (axes[k] * axes[k]));
            let wanted = bent.sum::<f64>() / length(&slope);
            (patch.curvature - wanted).powi(2)
        });
        (squares.sum::<f64>() / points.len() as f64).sqrt() / 2.0
    }

    #[test]
    fn spheres_are_exact_and_spheroids_nearly() {
        for (ratio, most) in [(1.0, 1e-8), (0.6, 1.5e-2), (1.5, 1e-2), (2.0, 2e-2)] {
            let found = wrong(ratio);
            assert!(found < most, "{ratio}: {found:e}");
        }
    }
}
