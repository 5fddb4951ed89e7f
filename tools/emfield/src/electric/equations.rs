//! Electrostatics: `div(eps grad V) = 0` (Matsuzawa 2017, eq. 2.60).
//!
//! One row for each point. Inside a medium the Laplacian is zero, from points of that medium and its
//! interfaces alone. On an interface the displacement along the normal is continuous,
//! `eps_a n.grad_a V - eps_b n.grad_b V = 0`, with a gradient from either side. On walls the
//! potential is given, or nothing passes.

use krylov::Rows;
use rayon::prelude::*;
use wls::{Error, Search, Stencils, Wants};

use crate::stencils::mirror::Mirror;
use crate::stencils::region::{Counted, Kind, Region};
use crate::stencils::sides::{Form, Sides, along_normal};

/// What holds at a point of a wall or of an electrode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Held {
    /// The potential \[V\].
    Potential(f64),
    /// No field passes through the wall.
    Insulated,
}

/// A problem of electrostatics.
#[derive(Debug, Clone, Default)]
pub struct Problem {
    /// Relative permittivity by medium.
    pub permittivity: Vec<f64>,
    /// Potential of media that are electrodes \[V\].
    pub electrodes: Vec<Option<f64>>,
    /// What holds at walls, by point; `None` elsewhere.
    pub held: Vec<Option<Held>>,
}

/// Least share of a Laplacian in a comparison over that of the square of the spacing; usual are 0.2 to 0.4.
const FLAT: f64 = 0.02;

/// A system of equations: rows and right side.
pub type Equations = (Rows<f64>, Vec<[f64; 1]>);

impl Problem {
    /// The potential that is given at point `i`.
    fn given<const D: usize>(&self, region: &Region<D>, i: usize) -> Option<f64> {
        if let Some(Held::Potential(v)) = self.held[i] {
            return Some(v);
        }
        let electrode = |m: u16| self.electrodes.get(m as usize).copied().flatten();
        match region.kinds[i] {
            Kind::Inside(m) => electrode(m),
            Kind::Wall { medium, .. } => electrode(medium),
            Kind::Interface(face) => {
                let face = &region.faces[face as usize];
                electrode(face.inner).or(electrode(face.outer))
            }
        }
    }

    /// Rows with one-sided stencils.
    #[must_use]
    pub fn rows<const D: usize>(&self, region: &Region<D>, sides: &Sides<D>) -> Equations {
        self.rows_of(region, |_| sides)
    }

    /// The same where points have their stencils from different times.
    #[must_use]
    pub fn rows_of<'a, const D: usize>(
        &self,
        region: &Region<D>,
        of: impl Fn(usize) -> &'a Sides<D> + Sync,
    ) -> Equations {
        self.gather(region, |i, row| {
            let (size, sides) = (self.size(region, i), of(i));
            match region.kinds[i] {
                Kind::Inside(_) if sides.wall.is_some() => {
                    compare(region, &sides.own, i, |j, w| push(row, j, size * w));
                }
                Kind::Inside(_) => flow(region, &sides.own, i, |j, w| push(row, j, -size * w)),
                Kind::Interface(face) => {
                    let face = &region.faces[face as usize];
                    let [a, b] = [face.inner, face.outer].map(|m| self.permittivity[m as usize]);
                    let n = face.normal;
                    along_normal(&sides.inner, i, n, size * a, |j, w| push(row, j, w));
                    along_normal(&sides.outer, i, n, -size * b, |j, w| push(row, j, w));
                }
                Kind::Wall { .. } => {
                    let n = region.wall_normals[i];
                    along_normal(sides.at_walls(), i, n, size, |j, w| push(row, j, w));
                }
            }
        })
    }

    /// What makes the equation of a point a flux of displacement over `eps0`: volume and permittivity of its cell, area of
    /// an interface, area and permittivity at a wall; about an axis by the radian.
    fn size<const D: usize>(&self, region: &Region<D>, i: usize) -> f64 {
        let area = region.metrics[i].spacing().powi(D as i32 - 1);
        let flat = match region.kinds[i] {
            Kind::Inside(_) => return self.cell(region, i),
            Kind::Interface(_) => area,
            Kind::Wall { medium, .. } => self.permittivity[medium as usize] * area,
        };
        flat * turn(region, i)
    }

    /// The same for a point with a Laplacian, wherever it is.
    fn cell<const D: usize>(&self, region: &Region<D>, i: usize) -> f64 {
        let eps = self.permittivity[region.medium(i) as usize];
        eps * region.metrics[i].volume() * turn(region, i)
    }

    fn gather<const D: usize>(
        &self,
        region: &Region<D>,
        each: impl Fn(usize, &mut Vec<(u32, f64)>) + Sync,
    ) -> Equations {
        let given: Vec<Option<f64>> = (0..region.len()).map(|i| self.given(region, i)).collect();
        let rows = Rows::gathered(region.len(), 0.0, |i, row| {
            if given[i].is_some() {
                push(row, i, 1.0);
            } else {
                each(i, row);
            }
        });
        let right = given.iter().map(|v| [v.unwrap_or(0.0)]).collect();
        (rows, right)
    }

    /// Field `-grad V` \[V/m\] (eq. 2.61), on interfaces that of the inner and of the outer side.
    #[must_use]
    pub fn field<const D: usize>(
        region: &Region<D>,
        sides: &Sides<D>,
        potential: &[f64],
        inner: bool,
    ) -> Vec<[f64; D]> {
        let gradients = sides.gradients(region, potential, inner);
        gradients.into_iter().map(|g| g.map(|x| -x)).collect()
    }
}

/// Stencils of the paper's form, which has no points on interfaces: those count as inner ones.
#[derive(Debug, Clone)]
pub struct Smeared<const D: usize> {
    laplacian: Stencils<D>,
    gradient: Stencils<D>,
}

impl<const D: usize> Smeared<D> {
    /// Makes them.
    ///
    /// # Errors
    /// Where points are alone, coincide or lie in a plane.
    pub fn new(region: &Region<D>, form: &Form) -> Result<Self, Error> {
        let mirror = Mirror::new(region);
        let search = Search::new(mirror.cloud())?;
        let laplacian = Wants {
            laplacian: true,
            hessian: region.axial,
            gradient: true,
            ..Wants::default()
        };
        let gradient = Wants {
            gradient: true,
            ..Wants::default()
        };
        Ok(Self {
            laplacian: mirror.stencils(&search, &form.plan::<D>(laplacian), &wls::Everything)?,
            gradient: mirror.stencils(&search, &form.plan::<D>(gradient), &Counted(region))?,
        })
    }

    /// Rows `sum_j 2 eps_i eps_j / (eps_i + eps_j) w_ij (V_j - V_i) = 0`: stencils cross interfaces.
    #[must_use]
    pub fn rows(&self, problem: &Problem, region: &Region<D>) -> Equations {
        let eps = |i: usize| problem.permittivity[region.medium(i) as usize];
        problem.gather(region, |i, row| {
            if let Kind::Wall { .. } = region.kinds[i] {
                let n = region.wall_normals[i];
                let size = problem.size(region, i);
                along_normal(&self.gradient, i, n, size, |j, w| push(row, j, w));
                return;
            }
            let mut plain = Vec::new();
            let size = problem.cell(region, i);
            let add = |j: usize, w: f64| plain.push((j, -size * w));
            flow(region, &self.laplacian, i, add);
            let own = eps(i);
            for (j, w) in plain {
                let other = eps(j);
                let k = 2.0 * other / (own + other);
                push(row, j, k * w);
                push(row, i, -k * w);
            }
        })
    }

    /// Field `-grad V` \[V/m\] from points of the same medium alone.
    #[must_use]
    pub fn field(&self, potential: &[f64]) -> Vec<[f64; D]> {
        let gradient = self.gradient.apply_gradient(potential);
        gradient.into_par_iter().map(|g| g.map(|x| -x)).collect()
    }
}

/// Length per radian of a turn about the axis of symmetry; one without an axis.
fn turn<const D: usize>(region: &Region<D>, i: usize) -> f64 {
    if region.axial {
        region.places[i][0].max(0.25 * region.metrics[i].spacing())
    } else {
        1.0
    }
}

/// Adds up how far the value at point `i` lies above the harmonic polynomial that fits it and its neighbours best. Of
/// a field with a Laplacian that is `-c` times the Laplacian, and the sum is divided by `c`. It is as if the point had
/// not been among those fitted: that multiplies all weights by the same.
fn compare<const D: usize>(
    region: &Region<D>,
    stencils: &Stencils<D>,
    i: usize,
    mut add: impl FnMut(usize, f64),
) {
    let place = region.places[i];
    let square = |j: usize| -> f64 {
        let other = region.places[j];
        (0..D).map(|k| (other[k] - place[k]).powi(2)).sum()
    };
    let value = stencils.value(i);
    let share: f64 = value.iter().map(|(j, w)| w * square(j)).sum();
    let cell = region.metrics[i].volume().powf(2.0 / D as f64);
    let factor = (share / (2.0 * D as f64)).max(FLAT * cell).recip();
    add(i, factor);
    for (j, w) in value.iter() {
        add(j, -factor * w);
    }
}

/// Adds up the Laplacian of point `i`; about an axis of symmetry with `1/r d/dr`, which is
/// `d2/dr2` on the axis.
pub(crate) fn flow<const D: usize>(
    region: &Region<D>,
    stencils: &Stencils<D>,
    i: usize,
    mut add: impl FnMut(usize, f64),
) {
    stencils.laplacian(i).iter().for_each(|(j, w)| add(j, w));
    if region.axial {
        around(region, stencils, i, 1.0, add);
    }
}

/// Adds `count / r d/dr` at point `i`.
pub(crate) fn around<const D: usize>(
    region: &Region<D>,
    stencils: &Stencils<D>,
    i: usize,
    count: f64,
    mut add: impl FnMut(usize, f64),
) {
    let r = region.places[i][0];
    if r == 0.0 {
        for (j, w) in stencils.second(i, 0, 0).iter() {
            add(j, count * w);
        }
    } else {
        for (j, w) in stencils.derivative(i, 0).iter() {
            add(j, count / r * w);
        }
    }
}

fn push(row: &mut Vec<(u32, f64)>, j: usize, w: f64) {
    row.push((j as u32, w));
}
