//! Fields on a closed surface around bodies.
//!
//! At each place of the surface, value and slope of the unknown are those of a polynomial fitted to the points about it,
//! of the medium there alone, which obeys its equation: `lap u = 0`, about an axis with its first derivatives at the
//! place. What sources give is added exactly, by the caller.

use rayon::prelude::*;
use run::{Failure, Session};
use wls::{Condition, Error, Plan, Rules, Search, Stencils, Wants};

use crate::cloud::Cloud;
use crate::magnetic::source::C;
use crate::magnetic::unknown::{Unknown, along, local};
use crate::stencils::mirror::Mirror;
use crate::stencils::region::Region;
use crate::stencils::sides::Form;
use crate::surface::enclosing::Enclosing;
use crate::surface::halfway::about;

/// A closed surface with the fits of points about its places.
#[derive(Debug, Clone)]
pub struct Enclosed<const D: usize> {
    /// The surface.
    pub surface: Enclosing,
    places: Vec<[f64; D]>,
    fits: Stencils<D>,
    /// The point that each point or image beyond an axis stands for.
    origin: Vec<u32>,
}

/// Fits of the points about surfaces.
///
/// # Errors
/// Where too few points lie about one.
pub(crate) fn all<const D: usize>(
    surfaces: Vec<Enclosing>,
    region: &Region<D>,
    form: &Form,
    session: &mut Session,
) -> Result<Vec<Enclosed<D>>, Failure> {
    if surfaces.is_empty() {
        return Ok(Vec::new());
    }
    session.timed("enclosures", || {
        let each = surfaces.into_iter().map(|surface| {
            let name = surface.name.clone();
            let failed = |error: Error| Failure::Other(format!("enclosure {name}: {error}"));
            Enclosed::new(region, form, surface).map_err(failed)
        });
        each.collect()
    })
}

/// A surface about all bodies with fits of the points about it, where one has room and no other holds all bodies.
pub(crate) fn about_all<const D: usize>(
    cloud: &Cloud,
    region: &Region<D>,
    form: &Form,
    others: &[Enclosed<D>],
    session: &mut Session,
) -> Option<Enclosed<D>> {
    let all = |one: &Enclosed<D>| {
        let mut points = cloud.surface.iter().map(|s| s.point as usize);
        points.all(|i| one.surface.within[i])
    };
    if others.iter().any(all) {
        return None;
    }
    let surface = about(cloud)?;
    // Where no fit can be made nothing can be checked.
    session.timed("enclosures", || Enclosed::new(region, form, surface).ok())
}

/// What was found, at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reaction {
    /// Vector potential \[V s/m\].
    pub potential: [C; 3],
    /// Flux density \[T\].
    pub flux: [C; 3],
}

/// Fits about places, of points in or on one medium.
struct About<'a, const D: usize> {
    region: &'a Region<D>,
    origin: &'a [u32],
    places: &'a [[f64; D]],
    medium: u16,
    /// How many times `1/r d/dr` the equation has about an axis.
    around: f64,
}

/// The point that a point or image stands for.
fn point(origin: &[u32], j: usize) -> usize {
    origin.get(j).map_or(j, |o| *o as usize)
}

impl<const D: usize> Rules<D> for About<'_, D> {
    fn allowed(&self, _: usize, j: usize) -> bool {
        self.region.touches(point(self.origin, j), self.medium)
    }

    fn conditions(&self, i: usize, conditions: &mut Vec<Condition<D>>) {
        if !self.region.axial {
            conditions.push(Condition::Harmonic);
            return;
        }
        let at = self.places[i];
        let mut drift = [0.0; D];
        drift[0] = self.around / at[0];
        conditions.push(Condition::Drift { at, drift });
    }
}

impl<const D: usize> Enclosed<D> {
    /// Makes the fits.
    ///
    /// # Errors
    /// Where too few points lie about a place.
    pub fn new(region: &Region<D>, form: &Form, surface: Enclosing) -> Result<Self, Error> {
        let form = Form {
            order: form.order.max(2),
            ..*form
        };
        let form = if region.axial {
            form.for_potentials()
        } else {
            form.for_harmonics(D)
        };
        let wants = Wants {
            value: true,
            gradient: true,
            ..Wants::default()
        };
        let plan = Plan {
            interpolating: false,
            ..form.plan::<D>(wants)
        };
        let places: Vec<[f64; D]> = surface.places.iter().map(|x| region.lower(*x)).collect();
        let mirror = Mirror::new(region);
        let search = Search::new(mirror.cloud())?;
        let rules = About {
            region,
            origin: mirror.origin(),
            places: &places,
            medium: surface.medium,
            around: form.around,
        };
        let fits = Stencils::at(&search, &plan, &places, &rules)?;
        let origin = mirror.origin().to_vec();
        Ok(Self {
            surface,
            places,
            fits,
            origin,
        })
    }

    /// Slopes of a potential at a place, in space.
    fn slope(&self, region: &Region<D>, place: usize, potential: &[f64]) -> [f64; 3] {
        let own = |j: usize| potential[point(&self.origin, j)];
        let along = |axis: usize| self.fits.derivative(place, axis).apply_with(own);
        region.raise(std::array::from_fn(along))
    }

    /// The field `-grad V` of a potential by point, at each place \[V/m\].
    #[must_use]
    pub fn electric(&self, region: &Region<D>, potential: &[f64]) -> Vec<[C; 3]> {
        let field = |n: usize| self.slope(region, n, potential).map(|x| C::from(-x));
        (0..self.places.len()).into_par_iter().map(field).collect()
    }

    /// The integral over the surface of a potential and of its slope along the normal, times two numbers of each place,
    /// as weights of points.
    #[must_use]
    pub fn integral(&self, region: &Region<D>, times: impl Fn(usize) -> (f64, f64)) -> Vec<f64> {
        let mut weights = vec![0.0; region.len()];
        let surface = &self.surface;
        for (place, (normal, area)) in surface.normals.iter().zip(&surface.areas).enumerate() {
            let (value, slope) = times(place);
            for (j, w) in self.fits.value(place).iter() {
                weights[point(&self.origin, j)] += area * value * w;
            }
            for (axis, n) in region.lower(*normal).iter().enumerate() {
                for (j, w) in self.fits.derivative(place, axis).iter() {
                    weights[point(&self.origin, j)] += area * slope * n * w;
                }
            }
        }
        weights
    }

    /// Vector potential of what was found, by point, and its curl, at each place.
    #[must_use]
    pub fn magnetic<const K: usize>(&self, unknown: Unknown, found: &[[C; K]]) -> Vec<Reaction> {
        let fields = |n: usize| {
            let part = |j: usize, k: usize| found[point(&self.origin, j)][k];
            let value = |k: usize| self.fits.value(n).apply_with(|j| part(j, k));
            let slope = |k: usize, axis: usize| {
                let row = self.fits.derivative(n, axis);
                row.apply_with(|j| part(j, k))
            };
            let own: [C; K] = std::array::from_fn(value);
            let slopes: [[C; D]; K] =
                std::array::from_fn(|k| std::array::from_fn(|axis| slope(k, axis)));
            let (potential, flux) = local(unknown, &self.places[n], &own, &own, &slopes);
            Reaction { potential, flux }
        };
        (0..self.places.len()).into_par_iter().map(fields).collect()
    }

    /// Values of the unknown by place as vector potentials in space \[V s/m\].
    #[must_use]
    pub fn potential<const K: usize>(&self, unknown: Unknown, values: &[[C; K]]) -> Vec<[C; 3]> {
        let each = self.places.iter().zip(values);
        each.map(|(place, value)| along(unknown, place, value))
            .collect()
    }
}
