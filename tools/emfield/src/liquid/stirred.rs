//! What fields do to a liquid within a step, and what of a force stirs alone.
//!
//! A force density T is parted into `g - grad phi`. With `lap phi = - div T`, and phi on the surface so that g has no part along
//! the normal there, g has no sources and moves no surface: it drives vortices alone, and phi is a part of the pressure. In this
//! way a force within a skin that is thinner than the spacing errs in what it stirs, not in what it lifts or bends.

use run::Failure;

use super::effort::{Effort, failed};
use super::operators::{divergence, operators};
use super::pressure::{Conditions, Equations};
use super::room::images::Images;
use super::step::{Liquid, Matter, Way};
use super::surface::patches;
use super::vector::{across, along};

impl<const D: usize> Liquid<D> {
    /// The traction of fields after some time, as it changes now \[Pa\].
    pub(super) fn pulled(&self, time: f64) -> Vec<f64> {
        let [now, rate] = &self.pull;
        let rate = |i: usize| rate.get(i).copied().unwrap_or(0.0);
        let each = now.iter().enumerate();
        each.map(|(i, p)| p + time * rate(i)).collect()
    }

    /// Acceleration by the force of fields after some time \[m/s2\].
    pub(super) fn pushed(&self, matter: &Matter<D>, time: f64) -> Vec<[f64; D]> {
        let [now, rate] = &self.force;
        let each = now.iter().zip(rate);
        each.map(|(f, r)| along(f, time, r).map(|f| f / matter.density))
            .collect()
    }

    /// Leaves of a force density what stirs alone; `phi` is given on the surface \[Pa\]. All of phi, by point.
    ///
    /// # Errors
    /// Where fits or equations cannot be made.
    pub fn stirred(
        &self,
        force: &mut [[f64; D]],
        phi: &[f64],
        way: &Way,
        effort: &mut Effort,
    ) -> Result<Vec<f64>, Failure> {
        let n = self.position.len();
        let rows = operators(&self.position, way).map_err(|e| failed(&e))?;
        let surface = &self.position[..phi.len()];
        let patches = patches(surface, &self.normal, way.spacing).map_err(|e| failed(&e))?;
        let images = Images::none(n);
        let conditions = Conditions {
            rows: &rows,
            patches: &patches,
            spacing: way.spacing,
            stiffness: 0.0,
            images: &images,
            held: &[],
            fall: [0.0; D],
        };
        let inside = (phi.len()..n).map(|i| -divergence(&rows, force, i));
        let right: Vec<f64> = phi.iter().copied().chain(inside).collect();
        let mut found = right[..phi.len()].to_vec();
        found.resize(n, phi.iter().sum::<f64>() / phi.len() as f64);
        let mut equations = Equations::new(conditions, n).map_err(|e| failed(&e))?;
        effort.add(&equations.solve(&right, &mut found, way.rule()))?;
        for (i, f) in force.iter_mut().enumerate() {
            *f = along(f, 1.0, &rows.gradient_of(&found, i));
            if let Some(patch) = patches.get(i) {
                *f = across(f, &patch.normal);
            }
        }
        Ok(found)
    }
}
