//! Damping of what single particles of the surface do against those around them.
//!
//! The curvature is that of a piece of surface some spacings wide, and what one particle does against its neighbours does not
//! change it: nothing calls it back, and the scatter of curvature from place to place drives it on. With the difference
//! to the linear fit of the velocities around,
//!
//! ```text
//! (D u)_a = u_a - sum_b c_ab u_b,   c_ab = W_ab (alpha_a + beta_a . x_ba)        d u/dt = -1/(2 t) D^T D u
//! ```
//!
//! at the particles a of the surface, the shortest waves decay in about the time t in which they go half their length
//! ([`crate::forces::capillary`]). D of a linear field is
//! nothing: translation, rotation and the stretching of a drop in its second mode are left as they are, waves of many
//! spacings nearly so (D goes with the second derivative, its effect with the fourth). Momentum and angular momentum are kept, and
//! energy can only fall, as D^T D is symmetric and not negative.

use shapes::frame::{along, difference, dot, squared};

use super::interface::Interface;
use crate::near::{Near, Role};

/// Part of D^T D u that is taken in the time of the shortest waves of the surface.
const STRENGTH: f64 = 0.5;
/// Most of D^T D that a step takes; at the edge of a body its largest mode is some nine times what it is for a single particle.
const PART: f64 = 0.15;
/// Least determinant of the moments, over the cube of their mean, that tells a slope.
const FLAT: f64 = 1e-3;
/// Most that the magnitudes of c add up to. At a plane surface they add up to little more than one; fits that reach far beyond
/// their neighbours have more, and what they damp they would drive on.
const FAR: f64 = 2.5;

/// Scratch, `[m]` in the order of [`Near`].
#[derive(Debug, Clone, Default)]
pub(super) struct Ripples {
    /// alpha \[m3\], beta \[m2\]; zero off the surface.
    fit: Vec<[f64; 4]>,
    /// D u \[m/s\].
    apart: Vec<[f64; 3]>,
    change: Vec<[f64; 3]>,
}

/// Those of the row's neighbours that are liquid, with W and the way to them.
fn liquid<'a>(
    near: &'a Near,
    a: usize,
    row: crate::near::Row<'a>,
) -> impl Iterator<Item = (usize, f64, [f64; 3])> + 'a {
    let index = row.index.iter().map(|b| *b as usize).zip(row.value);
    index
        .filter(|(b, _)| near.role[*b] == Role::Liquid)
        .map(move |(b, w)| (b, *w, difference(near.position[b], near.position[a])))
}

impl Ripples {
    /// Damps the motion in `near.velocity` for a step of the `part` of the time of the shortest waves at the particles of the
    /// `surface`, free or between two liquids.
    pub(super) fn damp(
        &mut self,
        near: &Near,
        surface: impl Fn(usize) -> bool + Sync,
        interface: &Interface,
        part: f64,
        predicted: &mut [[f64; 3]],
    ) {
        let part = (STRENGTH * part).min(PART);
        self.fit.resize(near.len(), [0.0; 4]);
        near.each_row(&mut self.fit, |a, row, fit| {
            *fit = [0.0; 4];
            if near.role[a] == Role::Liquid && surface(a) {
                *fit = weights(liquid(near, a, row));
                let far = liquid(near, a, row).map(|(_, w, x)| w * share(*fit, x).abs());
                if far.sum::<f64>() > FAR {
                    // The mean reaches nowhere.
                    let all: f64 = liquid(near, a, row).map(|(_, w, _)| w).sum();
                    *fit = [1.0 / all, 0.0, 0.0, 0.0];
                }
            }
        });
        let fit = &self.fit;
        self.apart.resize(near.len(), [0.0; 3]);
        near.each_row(&mut self.apart, |a, row, apart| {
            *apart = [0.0; 3];
            if fit[a][0] > 0.0 {
                let own = liquid(near, a, row).fold(near.velocity[a], |sum, (b, w, x)| {
                    along(sum, -w * share(fit[a], x), near.velocity[b])
                });
                *apart = own.map(|u| interface.lightest(near, a) * u);
            }
        });
        let apart = &self.apart;
        self.change.resize(near.len(), [0.0; 3]);
        near.each_row(
            &mut self.change,
            #[inline(always)]
            |a, row, change| {
                *change = [0.0; 3];
                if near.role[a] == Role::Liquid {
                    // Off the surface nothing is apart.
                    let around = row.values().filter(|(b, _)| {
                        fit.get(*b).is_some_and(|fit| fit[0] > 0.0) && near.role[*b] == Role::Liquid
                    });
                    *change = around.fold(apart[a], |sum, (b, w)| {
                        let way = difference(near.position[a], near.position[b]);
                        along(sum, -w * share(fit[b], way), apart[b])
                    });
                }
            },
        );
        for (a, (u, change)) in predicted.iter_mut().zip(&self.change).enumerate() {
            *u = along(*u, -part / near.heaviness(a), *change);
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        (32 + 2 * 24) * self.fit.capacity()
    }
}

/// alpha + beta . x.
#[inline(always)]
fn share([alpha, x, y, z]: [f64; 4], way: [f64; 3]) -> f64 {
    alpha + dot([x, y, z], way)
}

/// alpha and beta of the weighted linear fit, read at the particle itself; zero where its neighbours span no space.
fn weights(around: impl Iterator<Item = (usize, f64, [f64; 3])>) -> [f64; 4] {
    let (mut sum, mut first, mut second) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
    for (_, w, x) in around {
        sum += w;
        first = along(first, w, x);
        for (line, part) in second.iter_mut().zip(x) {
            *line = along(*line, w * part, x);
        }
    }
    if sum <= 0.0 {
        return [0.0; 4];
    }
    // Moments about the mean place m: the fit there is the mean, and its slope is what M of the deviations tells.
    let mean = first.map(|x| x / sum);
    for (line, part) in second.iter_mut().zip(mean) {
        *line = along(*line, -sum * part, mean);
    }
    let size = (second[0][0] + second[1][1] + second[2][2]) / 3.0;
    let cofactor = |i: usize, j: usize| {
        let (r, s, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        second[r][c] * second[s][d] - second[r][d] * second[s][c]
    };
    let determinant: f64 = (0..3).map(|j| second[0][j] * cofactor(0, j)).sum();
    if size <= 0.0 || determinant <= FLAT * size.powi(3) || squared(mean) <= 0.0 {
        return [1.0 / sum, 0.0, 0.0, 0.0].map(|x| {
            if determinant > FLAT * size.powi(3) {
                x
            } else {
                0.0
            }
        });
    }
    // u(0) = mean u - m . M^-1 sum w (x - m) u: c_b = w (1/sum - m.M^-1 (x - m)).
    let turned: [f64; 3] =
        [0, 1, 2].map(|i| (0..3).map(|j| cofactor(i, j) * mean[j]).sum::<f64>() / determinant);
    let [x, y, z] = turned.map(|x| -x);
    [1.0 / sum + dot(turned, mean), x, y, z]
}
