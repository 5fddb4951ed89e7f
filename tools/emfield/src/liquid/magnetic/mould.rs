//! Points of a ball and of the space about it, moved with the outline of a drop.
//!
//! What a harmonic of degree l has beside the ball of radius R, `a_l(n)`, moves points along the rays from the centre by
//!
//! ```text
//! (q^(l+1) inside, q^-(l+1) s(q) outside) a_l(n),      q = rho/R,
//! ```
//!
//! a polynomial of the place inside; s falls smoothly from 1 at the ball to 0 at q = 2.5, so that beyond all moves with the centre
//! alone and rows stay. Numbers of points stay the same, so that solutions go on and factors serve again; the
//! whole moves with the centre of the drop. What harmonics leave of the outline is not followed.

use rayon::prelude::*;
use wls::Stencils;

use crate::liquid::outline::Outline;
use crate::liquid::vector::{along, difference, direction, dot, length};
use crate::stencils::region::{Kind, Region};
use crate::stencils::sides::{Form, Sides};

/// Beyond so many radii from the centre points move with it alone.
const FAR: f64 = 2.5;
/// Rows reach so many spacings at most: supports that were enlarged reach farther than the form says.
const REACH: f64 = 6.0;

/// Points about a ball.
#[derive(Debug, Clone)]
pub struct Ball {
    /// The points: medium 1 is the ball.
    pub region: Region<3>,
    /// What each stands for in integrals over the ball \[m3\].
    pub weights: Vec<f64>,
    /// Its centre \[m\].
    pub centre: [f64; 3],
    /// Its radius \[m\].
    pub radius: f64,
    /// Points whose rows stay, and the fits of these.
    still: (Vec<bool>, Sides<3>),
    /// Fits that points inside media take with them when they move.
    bears: Stencils<3>,
}

impl Ball {
    /// Points about a ball, with what each stands for.
    ///
    /// # Errors
    /// Where fits cannot be made.
    pub fn new(
        region: Region<3>,
        weights: Vec<f64>,
        centre: [f64; 3],
        radius: f64,
        form: &Form,
    ) -> Result<Self, wls::Error> {
        let stays = |i: usize| {
            let away = length(&difference(&region.places[i], &centre));
            let reach = region.metrics[i].reach(REACH);
            matches!(region.kinds[i], Kind::Inside(0)) && away - reach > FAR * radius
        };
        let stays: Vec<bool> = (0..region.len()).map(stays).collect();
        let sides = Sides::some(&region, form, &|i| stays[i])?;
        let moves = |i: usize| matches!(region.kinds[i], Kind::Inside(_)) && !stays[i];
        let bears = Sides::bearing(&region, form, &moves)?;
        Ok(Self {
            region,
            weights,
            centre,
            radius,
            still: (stays, sides),
            bears,
        })
    }

    /// Whether the row of a point stays.
    #[must_use]
    pub fn stays(&self, i: usize) -> bool {
        self.still.0[i]
    }

    /// Fits that points inside media take with them when they move.
    #[must_use]
    pub fn bears(&self) -> &Stencils<3> {
        &self.bears
    }

    /// Fits of the rows that stay.
    #[must_use]
    pub fn still(&self) -> &Sides<3> {
        &self.still.1
    }
}

/// A drop into whose outline a ball is moved.
#[derive(Debug, Clone, Copy)]
pub struct Mould<'a> {
    /// Centre of the ball \[m\].
    pub centre: [f64; 3],
    /// Its radius \[m\].
    pub radius: f64,
    /// The drop.
    pub outline: &'a Outline,
}

impl Mould<'_> {
    /// Where a place of the ball, or about it, comes to lie \[m\], and by what its volume grows there.
    #[must_use]
    pub fn place(&self, x: &[f64; 3]) -> ([f64; 3], f64) {
        let way = difference(x, &self.centre);
        let q = length(&way) / self.radius;
        let n = if q > 0.0 {
            direction(&way)
        } else {
            [0.0, 0.0, 1.0]
        };
        let mut shares = self.outline.shares(&n);
        shares[0] -= self.radius;
        // The way over rho, and its slope over rho.
        let (mut longer, mut stretch) = (1.0, 1.0);
        let (share, falls) = faded(q);
        for (l, a) in shares.iter().enumerate() {
            let (degree, a) = (l as i32, a / self.radius);
            let over = f64::from(degree + 1);
            if q <= 1.0 {
                longer += q.powi(degree) * a;
                stretch += over * q.powi(degree) * a;
            } else {
                let power = q.powi(-degree - 2);
                longer += power * share * a;
                stretch += (q * falls - over * share) * power * a;
            }
        }
        let place = along(&self.outline.origin, q * self.radius * longer, &n);
        (place, longer * longer * stretch)
    }

    /// The points of a ball where they come to lie, and what they stand for then \[m3\].
    #[must_use]
    pub fn region(&self, ball: &Ball) -> (Region<3>, Vec<f64>) {
        let mut region = ball.region.clone();
        let moved: Vec<([f64; 3], f64)> =
            (region.places.par_iter().map(|x| self.place(x))).collect();
        let ray = |i: usize| direction(&difference(&ball.region.places[i], &self.centre));
        let metrics = region.metrics.par_iter_mut().enumerate();
        metrics.for_each(|(i, metric)| {
            if let Some(old) = metric.normal() {
                let n = ray(i);
                let side = dot(&old, &n).signum();
                *metric = metric.beside(self.outline.normal(&n).map(|c| side * c));
            }
        });
        for face in &mut region.faces {
            let n = ray(face.point as usize);
            let normal = self.outline.normal(&n);
            let larger = self.outline.radius(&n) / self.radius;
            face.area *= larger * larger / dot(&normal, &n);
            face.normal = normal;
        }
        let weights = ball.weights.iter().zip(&moved);
        let weights = weights.map(|(w, (_, grows))| w * grows).collect();
        for (place, (x, _)) in region.places.iter_mut().zip(&moved) {
            *place = *x;
        }
        (region, weights)
    }
}

/// s and its slope over q.
fn faded(q: f64) -> (f64, f64) {
    let t = ((q - 1.0) / (FAR - 1.0)).clamp(0.0, 1.0);
    let back = 1.0 - t;
    let value = back.powi(3) * (1.0 + 3.0 * t + 6.0 * t * t);
    (value, -30.0 * (t * back).powi(2) / (FAR - 1.0))
}

/// Points of the ball's medium: on its surface, and inside.
pub(super) fn within(region: &Region<3>) -> [Vec<usize>; 2] {
    let (mut on, mut inside) = (Vec::new(), Vec::new());
    for (i, kind) in region.kinds.iter().enumerate() {
        match kind {
            Kind::Interface(_) => on.push(i),
            Kind::Inside(1) => inside.push(i),
            _ => {}
        }
    }
    [on, inside]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Directions all round, and a drop of one harmonic about another centre than that of the ball.
    fn drop(origin: [f64; 3]) -> (Vec<[f64; 3]>, Outline) {
        let turn = PI * (3.0 - 5.0_f64.sqrt());
        let rays: Vec<[f64; 3]> = (0..900)
            .map(|k| {
                let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 900.0;
                let (sine, cosine) = (turn * f64::from(k)).sin_cos();
                let ring = (1.0 - z * z).sqrt();
                [ring * cosine, ring * sine, z]
            })
            .collect();
        let on = |n: &[f64; 3]| {
            let r = 2.0 * (1.0 + 0.1 * (1.5 * n[2] * n[2] - 0.5) + 0.05 * n[0]);
            along(&origin, r, n)
        };
        let points: Vec<[f64; 3]> = rays.iter().map(on).collect();
        let outline = Outline::new(&points, &rays, origin).unwrap();
        (rays, outline)
    }

    #[test]
    fn a_ball_comes_to_lie_in_its_drop_with_its_volume() {
        let origin = [1.0, -2.0, 0.5];
        let (rays, outline) = drop(origin);
        let mould = Mould {
            centre: [0.3; 3],
            radius: 1.8,
            outline: &outline,
        };
        for n in &rays {
            let (x, _) = mould.place(&along(&[0.3; 3], 1.8, n));
            let away = difference(&x, &origin);
            assert!((length(&away) - outline.radius(n)).abs() < 1e-12);
        }
        // The growth of volumes is that of the places: difference quotients inside and outside.
        for x in [[0.9, 0.1, 1.0], [2.4, 1.0, -0.7], [0.3, 0.3, 0.3]] {
            let step = 1e-5;
            let mut slopes = [[0.0; 3]; 3];
            for k in 0..3 {
                let mut way = [0.0; 3];
                way[k] = step;
                let ahead = mould.place(&along(&x, 1.0, &way)).0;
                let behind = mould.place(&along(&x, -1.0, &way)).0;
                slopes[k] = difference(&ahead, &behind).map(|c| c / (2.0 * step));
            }
            let [a, b, c] = slopes;
            let cross = [
                b[1] * c[2] - b[2] * c[1],
                b[2] * c[0] - b[0] * c[2],
                b[0] * c[1] - b[1] * c[0],
            ];
            let grows = mould.place(&x).1;
            assert!((dot(&a, &cross) / grows - 1.0).abs() < 1e-6, "{x:?}");
        }
    }
}
