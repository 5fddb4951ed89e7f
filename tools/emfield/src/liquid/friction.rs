//! Viscosity: the velocity at the end of a stage with its own friction, and no shear on the surface.
//!
//! `u - tau nu div grad u = u0`, all components together. On the surface the fits of the Laplacian know the slope of the
//! velocity along the normal, which the gas does not shear and which has no divergence: with the gradient along the surface
//!
//! ```text
//! du/dn = g(u) = -(grad_s u) . n - n (div_s u)
//! ```
//!
//! (the first term: no tangential stress; the second: div u = 0). A field that drags the charges of the surface along it by the
//! tangential traction t adds t/mu to that slope. The normal stress `2 mu du_n/dn = 2 mu n . g(u)` belongs to
//! the pressure. The balance along the outward normal is `-p + 2 mu du_n/dn = -p_gas - gamma kappa`, so that it **raises** p
//! where the liquid is drawn outward.

use krylov::{Method, Options, Rows, Rule, Solved, System};
use wls::Stencils;

use super::matter::Way;
use super::operators::sloped;
use super::pressure::served;
use super::room::images::Images;
use super::surface::Patch;
use super::vector::{along, dot};

/// Share of the largest entry beside the diagonal of a row below which factors know nothing of an entry.
const LARGE: f64 = 0.1;

/// Why there are no equations.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A fit fails.
    #[error(transparent)]
    Fit(#[from] wls::Error),
    /// Rows cannot be solved.
    #[error(transparent)]
    Rows(#[from] krylov::Error),
}

/// What friction knows of a liquid.
#[derive(Debug, Clone, Copy)]
pub struct Ground<'a, const D: usize> {
    /// Rows of derivatives.
    pub inside: &'a Stencils<D>,
    /// The surface, whose points come first.
    pub patches: &'a [Patch<D>],
    /// Images beyond faces.
    pub images: &'a Images<D>,
    /// Points on walls, which follow those of the surface: their velocity is given.
    pub held: usize,
    /// Fits pass through the value of their own point.
    pub through: bool,
}

/// The equations of a velocity.
pub struct Friction {
    system: System<f64, f64>,
    /// What a unit of slope along the normal adds to the right side at points of the surface \[m\].
    slopes: Vec<f64>,
}

impl Friction {
    /// Makes them; `points` have their images behind them, and `diffusion` is `tau nu` \[m2\]. Factors of equations nearby
    /// serve where they are given.
    ///
    /// # Errors
    /// Where fits or equations cannot be made.
    pub fn new<const D: usize>(
        points: &[[f64; D]],
        ground: Ground<'_, D>,
        way: &Way,
        diffusion: f64,
        nearby: Option<System<f64, f64>>,
    ) -> Result<Self, Error> {
        let Ground {
            inside,
            patches,
            images,
            held,
            through,
        } = ground;
        let surface = sloped(points, patches, way, through)?;
        let number = |j: usize, b: usize| (D * images.origin(j) + b) as u32;
        let walls = patches.len()..patches.len() + held;
        let matrix = Rows::gathered(D * images.own(), 0.0, |row, entries| {
            let (i, b) = (row / D, row % D);
            entries.push((number(i, b), 1.0));
            if walls.contains(&i) {
                return;
            }
            let part = |j: usize, c: usize| -diffusion * images.sign(j, c);
            let Some(patch) = patches.get(i) else {
                let all = inside.laplacian(i).iter();
                entries.extend(all.map(|(j, w)| (number(j, b), part(j, b) * w)));
                return;
            };
            let laplacian = surface.laplacian(i);
            entries.extend(
                laplacian
                    .iter()
                    .map(|(j, w)| (number(j, b), part(j, b) * w)),
            );
            let share: f64 = laplacian.conditions().sum();
            for (&j, slope) in patch.neighbours.iter().zip(&patch.slope) {
                for c in 0..D {
                    let g = -(slope[b] * patch.normal[c] + patch.normal[b] * slope[c]);
                    entries.push((number(j as usize, c), part(j as usize, c) * share * g));
                }
            }
        });
        // Diffusion within a stage reaches a few spacings at most.
        let options = Options {
            method: Method::IncompleteOfLarge(LARGE),
            ..Options::default()
        };
        let system = served(matrix, options, nearby)?;
        let slopes = (0..patches.len())
            .map(|i| diffusion * surface.laplacian(i).conditions().sum::<f64>())
            .collect();
        Ok(Self { system, slopes })
    }

    /// The system with its factors.
    pub fn into_system(self) -> System<f64, f64> {
        self.system
    }

    /// Adds to velocities before friction what slopes `drag` along the normal, of points of the surface, bring \[1/s\].
    pub fn drag<const D: usize>(&self, right: &mut [[f64; D]], drag: impl Fn(usize) -> [f64; D]) {
        for (i, (right, slope)) in right.iter_mut().zip(&self.slopes).enumerate() {
            *right = along(right, *slope, &drag(i));
        }
    }

    /// Solves for the velocity, which is the first guess.
    pub fn solve<const D: usize>(
        &mut self,
        right: &[[f64; D]],
        velocity: &mut [[f64; D]],
        rule: Rule<'_>,
    ) -> Solved {
        let sides: Vec<[f64; 1]> = right.as_flattened().iter().map(|v| [*v]).collect();
        let mut unknown: Vec<[f64; 1]> = velocity.as_flattened().iter().map(|v| [*v]).collect();
        let solved = self.system.solve(&sides, &mut unknown, rule);
        for (v, x) in velocity.as_flattened_mut().iter_mut().zip(&unknown) {
            *v = x[0];
        }
        solved
    }
}

/// `du_n/dn = n . g(u)` at a point of the surface \[1/s\].
#[must_use]
pub fn stretch<const D: usize>(patch: &Patch<D>, velocity: &[[f64; D]]) -> f64 {
    let near = patch.neighbours.iter().zip(&patch.slope);
    -near
        .map(|(&j, slope)| dot(slope, &velocity[j as usize]))
        .sum::<f64>()
}
