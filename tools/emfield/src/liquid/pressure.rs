//! The pressure that keeps the velocity free of divergence, with the surface as it will be.
//!
//! Inside, (2.49) of Matsuzawa (2017): `div grad p = rho/tau div u*`. On the surface p is given by its tension at the **end**
//! of the stage: the surface there lies `tau n . u` from where the stage began, and `u = u* - tau/rho grad p`, so that with
//! `dkappa/dn = K = -(Laplacian along the surface + kappa1^2 + kappa2^2)`
//!
//! ```text
//! p + gamma tau^2/rho K (n . grad p) = p_gas + gamma kappa + gamma K n . (x- + tau u* - x~) + 2 mu du_n/dn - t_n
//! ```
//!
//! with kappa that of the predicted surface x~ and t_n the outward traction of fields, which lowers the pressure (2.40 has the
//! other sign): at the surface `-p + 2 mu du_n/dn + gamma kappa = -p_gas + t_n`. Waves of the surface that a step does not
//! resolve are damped, and none has a limit of the step. The slope `q = n . grad p` of each surface point is an unknown of
//! its own: rows stay short. Where faces bear the weight of the liquid ([`super::room`]), K has `-rho g . n` beside `gamma K`, and
//! the surface `-rho g . (x~ - c)`.
//!
//! On a wall with the normal n, `n . grad p = rho/tau n . (u* - u)` and what friction adds to it. Without a free surface p is
//! known but for a constant, and its sources are made to add up: one even source is found beside it, and its mean is zero.

use krylov::{Keep, Method, Options, Rows, Rule, Solved, System};
use rayon::prelude::*;
use wls::Stencils;

use super::room::images::Images;
use super::surface::Patch;
use super::vector::dot;

/// Entries of factors below this share of their row are dropped.
const DROP: f64 = 1e-2;
/// Most entries of factors over those of the rows.
const FILL: f64 = 1.5;

/// Residual, over the wanted one of the whole pressure, below which its differences are no longer sought.
const ENOUGH: f64 = 1e-2;

/// What the pressure obeys in a stage.
#[derive(Debug, Clone, Copy)]
pub struct Conditions<'a, const D: usize> {
    /// Rows of derivatives.
    pub rows: &'a Stencils<D>,
    /// The surface, whose points come first.
    pub patches: &'a [Patch<D>],
    /// Unit of lengths \[m\].
    pub spacing: f64,
    /// Surface tension times square of the stage over density \[m3\].
    pub stiffness: f64,
    /// Images beyond faces.
    pub images: &'a Images<D>,
    /// Normals of points on walls, which follow those of the surface.
    pub held: &'a [[f64; D]],
    /// Gravity that faces bear times the square of the stage \[m\].
    pub fall: [f64; D],
}

/// K f at surface point `own`: what a displacement f along the normal adds to the curvature.
pub fn bending<const D: usize>(patch: &Patch<D>, own: usize, f: impl Fn(usize) -> f64) -> f64 {
    let near = patch.neighbours.iter().zip(&patch.laplace);
    let along: f64 = near.map(|(&j, w)| w * f(j as usize)).sum();
    -(along + patch.squares * f(own))
}

/// Incomplete factors by size.
fn options() -> Options {
    Options {
        method: Method::Incomplete(Keep::Threshold {
            drop: DROP,
            fill: FILL,
        }),
        ..Options::default()
    }
}

/// A system of these rows, with the factors of one nearby where it is given.
///
/// # Errors
/// Where rows cannot be solved.
pub(super) fn served(
    rows: Rows<f64>,
    options: Options,
    nearby: Option<System<f64, f64>>,
) -> Result<System<f64, f64>, krylov::Error> {
    match nearby {
        Some(mut system) if system.len() == rows.len() => {
            system.renew(rows)?;
            Ok(system)
        }
        _ => System::new(rows, Vec::new(), options),
    }
}

/// The equations of the pressure of a stage.
pub struct Equations<'a, const D: usize> {
    conditions: Conditions<'a, D>,
    system: System<f64, f64>,
    /// Where there is no free surface.
    loose: Option<Loose>,
}

/// A pressure that is known but for a constant: that of the last point is zero instead of its own equation.
struct Loose {
    /// The equation of that point.
    row: Vec<(usize, f64)>,
    /// The pressure of one even source, and what it leaves of that equation.
    even: Vec<f64>,
    left: f64,
}

impl Loose {
    /// What a pressure leaves of the equation of the last point.
    fn left(&self, right: f64, pressure: &[f64]) -> f64 {
        let all = self.row.iter().map(|(j, w)| w * pressure[*j]);
        right - all.sum::<f64>()
    }
}

impl<'a, const D: usize> Equations<'a, D> {
    /// Makes them, for `n` points.
    ///
    /// # Errors
    /// Where the equations have no solution.
    pub fn new(conditions: Conditions<'a, D>, n: usize) -> Result<Self, krylov::Error> {
        Self::served(conditions, n, None)
    }

    /// The same with the factors of equations nearby, where they are given.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn served(
        conditions: Conditions<'a, D>,
        n: usize,
        nearby: Option<System<f64, f64>>,
    ) -> Result<Self, krylov::Error> {
        let Conditions {
            rows,
            patches,
            spacing,
            stiffness,
            images,
            held,
            fall,
        } = conditions;
        let surface = patches.len();
        let square = spacing * spacing;
        let stiff = stiffness / spacing;
        let pinned = surface == 0;
        let at = |j: usize| images.origin(j) as u32;
        let matrix = Rows::gathered(n + surface, 0.0, |i, row| {
            if i >= n {
                let own = i - n;
                row.push((i as u32, 1.0));
                for k in 0..D {
                    let factor = -spacing * patches[own].normal[k];
                    let slopes = rows.derivative(own, k).iter();
                    row.extend(slopes.map(|(j, w)| (at(j), factor * w)));
                }
            } else if i < surface {
                let patch = &patches[i];
                row.push((i as u32, 1.0));
                let heavy = dot(&fall, &patch.normal) / spacing;
                row.push(((n + i) as u32, -stiff * patch.squares - heavy));
                let along = patch.neighbours.iter().zip(&patch.laplace);
                row.extend(along.map(|(&j, w)| (n as u32 + at(j as usize), -stiff * w)));
            } else if let Some(normal) = held.get(i - surface) {
                for (k, c) in normal.iter().enumerate() {
                    let slopes = rows.derivative(i, k).iter();
                    row.extend(slopes.map(|(j, w)| (at(j), spacing * c * w)));
                }
            } else if pinned && i + 1 == n {
                row.push((i as u32, 1.0));
            } else {
                let all = rows.laplacian(i).iter();
                row.extend(all.map(|(j, w)| (at(j), -square * w)));
            }
        });
        let system = served(matrix, options(), nearby)?;
        let mut made = Self {
            conditions,
            system,
            loose: None,
        };
        if pinned {
            made.loosen(n);
        }
        Ok(made)
    }

    /// The system with its factors.
    pub fn into_system(self) -> System<f64, f64> {
        self.system
    }

    /// Finds what an even source does.
    fn loosen(&mut self, n: usize) {
        let Conditions {
            rows,
            images,
            spacing,
            held,
            ..
        } = self.conditions;
        let square = spacing * spacing;
        let all = rows.laplacian(n - 1).iter();
        let mut loose = Loose {
            row: all.map(|(j, w)| (images.origin(j), -square * w)).collect(),
            even: Vec::new(),
            left: 1.0,
        };
        let mut sides = vec![[1.0]; n];
        sides[..held.len()].fill([0.0]);
        sides[n - 1] = [0.0];
        let mut even = vec![[0.0]; n];
        self.system.solve(&sides, &mut even, Rule::default());
        loose.even = even.as_flattened().to_vec();
        loose.left = loose.left(1.0, &loose.even);
        self.loose = Some(loose);
    }

    /// Solves where there is no free surface: `p = p0 - s p1`, with the even source s that the last equation wants.
    fn solve_loose(
        &mut self,
        loose: &Loose,
        right: &[f64],
        pressure: &mut [f64],
        rule: Rule<'_>,
    ) -> Solved {
        let (n, held) = (right.len(), self.conditions.held.len());
        let square = self.conditions.spacing * self.conditions.spacing;
        let mut sides: Vec<[f64; 1]> = right.iter().map(|r| [-square * r]).collect();
        for (side, r) in sides.iter_mut().zip(&right[..held]) {
            *side = [*r];
        }
        let last = sides[n - 1][0];
        sides[n - 1] = [0.0];
        let off = pressure[n - 1];
        let mut unknown: Vec<[f64; 1]> = pressure.iter().map(|p| [p - off]).collect();
        let solved = self.system.solve(&sides, &mut unknown, rule);
        let even = loose.left(last, unknown.as_flattened()) / loose.left;
        for ((p, x), e) in pressure.iter_mut().zip(&unknown).zip(&loose.even) {
            *p = x[0] - even * e;
        }
        let mean = pressure.iter().sum::<f64>() / n as f64;
        pressure.iter_mut().for_each(|p| *p -= mean);
        solved
    }

    /// Solves for the pressure; `right` is `rho/tau div u*` inside and what stands on the right of the condition on the
    /// surface, on walls the slope along their normal times the spacing; `pressure` the first guess.
    pub fn solve(&mut self, right: &[f64], pressure: &mut [f64], rule: Rule<'_>) -> Solved {
        if let Some(loose) = self.loose.take() {
            let solved = self.solve_loose(&loose, right, pressure, rule);
            self.loose = Some(loose);
            return solved;
        }
        let Conditions {
            rows,
            patches,
            spacing,
            images,
            held,
            ..
        } = self.conditions;
        let (n, surface) = (right.len(), patches.len());
        let walled = surface + held.len();
        let square = spacing * spacing;
        // Slopes know no constant: what all of the surface has in common is no part of what is solved for.
        let even = right[..surface].iter().sum::<f64>() / surface as f64;
        let whole: f64 = right[..surface].iter().map(|r| r * r).sum();
        let wide = images.scalars(pressure);
        let slope = |s: usize| -> f64 {
            let gradient = rows.gradient_of(&wide, s);
            spacing * dot(&patches[s].normal, &gradient)
        };
        let mut unknown: Vec<[f64; 1]> = pressure.iter().map(|p| [*p - even]).collect();
        unknown.extend((0..surface).map(|s| [slope(s)]));
        let side = |i: usize| {
            if i < surface {
                right[i] - even
            } else if i < walled {
                right[i]
            } else {
                -square * right[i]
            }
        };
        let mut sides: Vec<[f64; 1]> = (0..n).into_par_iter().map(|i| [side(i)]).collect();
        sides.resize(n + surface, [0.0]);
        let rule = Rule {
            floor: ENOUGH * rule.reduction * whole.sqrt(),
            ..rule
        };
        let solved = self.system.solve(&sides, &mut unknown, rule);
        for (p, x) in pressure.iter_mut().zip(&unknown) {
            *p = x[0] + even;
        }
        solved
    }
}
