//! Points inside that follow the surface instead of the liquid.
//!
//! What currents stir turns round within a drop whose shape stays. Points that go with it crowd where it meets the surface; so they move
//! at w with `div grad w = 0` and that of the surface on it, `w = U + ((u - U) . n) n` with U of the whole: their distances stay
//! nearly what they were. The liquid then passes them at u - w ([`super::drift`]).

use krylov::{Keep, Method, Options, Rows, System};
use run::Failure;
use wls::Stencils;

use super::effort::{Effort, failed};
use super::matter::Way;
use super::room::images::Images;
use super::step::Liquid;
use super::vector::{along, difference, dot, spatial};

impl<const D: usize> Liquid<D> {
    /// Velocities of the points of a liquid that moves at `velocity` \[m/s\].
    #[must_use]
    pub fn moved(&self, velocity: &[[f64; D]]) -> Vec<[f64; D]> {
        if self.loose() {
            return velocity.to_vec();
        }
        if self.follow.is_empty() {
            let mut moved = velocity.to_vec();
            for (w, n) in moved.iter_mut().zip(&self.normal) {
                *w = n.map(|c| c * dot(w, n));
            }
            return moved;
        }
        let mut moved = self.follow.clone();
        if self.room.bounds() {
            for ((w, u), n) in moved.iter_mut().zip(velocity).zip(&self.normal) {
                *w = n.map(|c| c * dot(u, n));
            }
            return moved;
        }
        let share = (velocity.len() as f64).recip();
        let sum = |sum: [f64; D], u: &[f64; D]| along(&sum, share, u);
        let whole = velocity.iter().fold([0.0; D], sum);
        for ((w, u), n) in moved.iter_mut().zip(velocity).zip(&self.normal) {
            *w = along(&whole, dot(&difference(u, &whole), n), n);
        }
        moved
    }

    /// Lets points inside follow those of the surface, which come first and have moved at `surface`.
    ///
    /// # Errors
    /// Where the equations have no solution.
    pub fn follow_surface(
        &mut self,
        rows: &Stencils<D>,
        images: &Images<D>,
        surface: &[[f64; D]],
        way: &Way,
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        if self.room.bounds() {
            return self.follow_in_room(rows, images, surface, way, effort);
        }
        let (on, n) = (surface.len(), self.follow.len());
        let square = way.spacing * way.spacing;
        let matrix = Rows::gathered(n, 0.0, |i, row| {
            if i < on {
                row.push((i as u32, 1.0));
            } else {
                let all = rows.laplacian(i).iter();
                row.extend(all.map(|(j, w)| (j as u32, -square * w)));
            }
        });
        let options = Options {
            method: Method::Incomplete(Keep::PATTERN),
            ..Options::default()
        };
        let mut system = System::new(matrix, Vec::new(), options).map_err(|e| failed(&e))?;
        let mut sides = vec![[0.0; 3]; n];
        for (side, w) in sides.iter_mut().zip(surface) {
            *side = spatial(w);
        }
        self.follow[..on].copy_from_slice(surface);
        let mut unknown: Vec<[f64; 3]> = self.follow.iter().map(spatial).collect();
        let solved = system.solve(&sides, &mut unknown, way.rule());
        for (w, x) in self.follow.iter_mut().zip(&unknown) {
            *w = std::array::from_fn(|k| x[k]);
        }
        effort.add(&solved)
    }

    /// The same within faces, component by component, since mirrors turn each its own way; points on walls stay.
    fn follow_in_room(
        &mut self,
        rows: &Stencils<D>,
        images: &Images<D>,
        surface: &[[f64; D]],
        way: &Way,
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let (on, n) = (surface.len(), self.follow.len());
        if on == 0 {
            return Ok(());
        }
        let fixed = on + self.room.held.len();
        let square = way.spacing * way.spacing;
        for k in 0..D {
            let matrix =
                Rows::gathered(n, 0.0, |i, row| {
                    if i < fixed {
                        row.push((i as u32, 1.0));
                    } else {
                        let all = rows.laplacian(i).iter();
                        row.extend(all.map(|(j, w)| {
                            (images.origin(j) as u32, -square * images.sign(j, k) * w)
                        }));
                    }
                });
            let options = Options {
                method: Method::Incomplete(Keep::PATTERN),
                ..Options::default()
            };
            let mut system = System::new(matrix, Vec::new(), options).map_err(|e| failed(&e))?;
            let mut sides = vec![[0.0]; n];
            let mut unknown: Vec<[f64; 1]> = self.follow.iter().map(|w| [w[k]]).collect();
            for (i, w) in surface.iter().enumerate() {
                (sides[i], unknown[i]) = ([w[k]], [w[k]]);
            }
            effort.add(&system.solve(&sides, &mut unknown, way.rule()))?;
            for (w, x) in self.follow.iter_mut().zip(&unknown) {
                w[k] = x[0];
            }
        }
        Ok(())
    }
}
