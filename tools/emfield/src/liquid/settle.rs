//! After a step: the surface on its fit (2.2.4, Matsuzawa 2017), its volume, and points apart.

use rayon::prelude::*;
use wls::{Error, Stencils};

use super::fill::pushes;
use super::matter::{Matter, Step};
use super::operators::{Points, values};
use super::room::images::Images;
use super::step::Liquid;
use super::surface::Patch;
use super::vector::{across, along, dot, length};

/// Part of the way to the fitted surface that a step goes.
const SMOOTHED: f64 = 0.5;
/// Points that neighbours push less far, in spacings, stay.
const CALM: f64 = 0.03;
/// Part of a push that a step follows.
const YIELD: f64 = 0.3;

impl<const D: usize> Liquid<D> {
    /// Lets velocities of points that go with the liquid go over into the values of fits, by `dt (1/T + |u|/h)`, and by `least` at
    /// least: T is `sqrt(rho h^3/gamma)`, the time of a ripple as long as the spacing h, and u the fastest.
    ///
    /// Fits through their own points see waves of two spacings. One-sided gradients and divergences of them are no pair, and let
    /// such waves grow beneath the surface: without this a drop of 5 spacings a radius broke after 1.5 periods at Oh 0.005 and
    /// 1.03:1.
    ///
    /// # Errors
    /// Where points coincide.
    pub fn quiet(&mut self, matter: &Matter<D>, step: Step<'_>, least: f64) -> Result<(), Error> {
        let Step { way, dt } = step;
        let h = way.spacing;
        let fastest = self.velocity.iter().map(length).fold(0.0, f64::max);
        let ripples = (matter.tension / (matter.density * h.powi(3))).sqrt();
        let share = (dt * (ripples + fastest / h)).clamp(least, 1.0);
        let points = Points {
            all: &self.position,
            own: self.position.len(),
        };
        let fits = values(points, way)?;
        let old = &self.velocity;
        let each = (0..old.len()).into_par_iter();
        let new = each.map(|i| {
            let rest = old[i].map(|c| (1.0 - share) * c);
            let fit = fits.value(i).iter();
            fit.fold(rest, |sum, (j, w)| along(&sum, share * w, &old[j]))
        });
        self.velocity = new.collect();
        Ok(())
    }

    /// Moves surface points toward the fitted surface, as a whole neither out nor in, by what the fit of the offsets leaves of
    /// them: what the fits know of a shape to a part `e` is then damped by `e^2`, the ripples that they do not know as before.
    pub fn smooth(&mut self, patches: &[Patch<D>], images: &Images<D>) {
        let known = |p: &Patch<D>| -> f64 {
            let near = p.neighbours.iter().zip(&p.value);
            near.map(|(&j, w)| w * patches[images.origin(j as usize)].offset)
                .sum()
        };
        let moves: Vec<f64> = patches.iter().map(|p| p.offset - known(p)).collect();
        let area: f64 = patches.iter().map(|p| p.area).sum();
        let out: f64 = patches.iter().zip(&moves).map(|(p, m)| p.area * m).sum();
        let mean = out / area;
        for ((x, p), m) in self.position.iter_mut().zip(patches).zip(&moves) {
            *x = along(x, SMOOTHED * (m - mean), &p.normal);
        }
    }

    /// Moves the surface evenly along its normals by `distance` \[m\].
    pub fn swell(&mut self, distance: f64) {
        for (x, n) in self.position.iter_mut().zip(&self.normal) {
            *x = along(x, distance, n);
        }
    }

    /// Moves the free face of a room evenly across it by `distance` \[m\].
    pub fn lift(&mut self, distance: f64) {
        let Some((axis, up)) = self.room.free() else {
            return;
        };
        let surface = self.surface();
        for x in &mut self.position[..surface] {
            x[axis] += if up { distance } else { -distance };
        }
    }

    /// Moves points that have come too close apart, those of the surface along it; they take the values of their new
    /// places.
    pub fn spread(
        &mut self,
        rows: &Stencils<D>,
        images: &Images<D>,
        patches: &[Patch<D>],
        spacing: f64,
    ) {
        let surface = patches.len();
        let mut push = self.pushed_apart(self.position.len(), spacing);
        let shell = self.pushed_apart(surface, spacing);
        for (s, (p, along_surface)) in push.iter_mut().zip(&shell).enumerate() {
            *p = across(along_surface, &patches[s].normal);
        }
        let walls = surface..surface + self.room.held.len();
        push[walls].fill([0.0; D]);
        let velocity = images.vectors(&self.velocity).into_owned();
        let rate = images.vectors(&self.rate).into_owned();
        let pressure = images.scalars(&self.pressure).into_owned();
        for (i, p) in push.iter().enumerate() {
            if length(p) < CALM * spacing {
                continue;
            }
            let step = p.map(|c| YIELD * c);
            self.position[i] = along(&self.position[i], 1.0, &step);
            let [v, r] = [&velocity, &rate].map(|f| carried(rows, f, i, &step));
            self.velocity[i] = along(&self.velocity[i], 1.0, &v);
            self.rate[i] = along(&self.rate[i], 1.0, &r);
            self.pressure[i] += dot(&rows.gradient_of(&pressure, i), &step);
        }
    }
}

impl<const D: usize> Liquid<D> {
    /// How far the first `count` points push each other, with their images \[m\].
    fn pushed_apart(&self, count: usize, spacing: f64) -> Vec<[f64; D]> {
        let (all, _) = self.room.images(&self.position[..count], spacing);
        pushes(&all, count, spacing)
    }
}

/// `(step . grad) f`.
fn carried<const D: usize>(
    rows: &Stencils<D>,
    field: &[[f64; D]],
    i: usize,
    step: &[f64; D],
) -> [f64; D] {
    let mut sum = [0.0; D];
    for (a, part) in step.iter().enumerate() {
        for (j, w) in rows.derivative(i, a).iter() {
            sum = along(&sum, part * w, &field[j]);
        }
    }
    sum
}
