//! Points inside that follow the surface instead of the liquid.
//!
//! What currents stir turns round within a drop whose shape stays. Points that go with it crowd where it meets the surface; so they move
//! at w with `div grad w = 0` and that of the surface on it, `w = U + ((u - U) . n) n` with U of the whole: their distances stay
//! nearly what they were. The liquid then passes them at u - w ([`super::drift`]).

use krylov::{Keep, Method, Options, Rows, Rule, System};
use run::Failure;
use wls::Stencils;

use super::effort::{Effort, failed};
use super::step::Liquid;
use super::vector::{along, difference, dot};

impl<const D: usize> Liquid<D> {
    /// Velocities of the points of a liquid that moves at `velocity` \[m/s\].
    #[must_use]
    pub fn moved(&self, velocity: &[[f64; D]]) -> Vec<[f64; D]> {
        if self.follow.is_empty() {
            let mut moved = velocity.to_vec();
            for (w, n) in moved.iter_mut().zip(&self.normal) {
                *w = n.map(|c| c * dot(w, n));
            }
            return moved;
        }
        let mut moved = self.follow.clone();
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
        surface: &[[f64; D]],
        (spacing, rule): (f64, Rule<'_>),
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let (on, n) = (surface.len(), self.follow.len());
        let square = spacing * spacing;
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
        let mut sides = vec![[0.0; D]; n];
        sides[..on].copy_from_slice(surface);
        self.follow[..on].copy_from_slice(surface);
        effort.add(&system.solve(&sides, &mut self.follow, rule))
    }
}
