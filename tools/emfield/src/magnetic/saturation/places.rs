//! Which points and faces have media whose permeability depends on the field, and what sources give there.

use rayon::prelude::*;

use crate::magnetic::diffusion::Ground;
use crate::magnetic::medium::interface::{Permeable, curl};
use crate::magnetic::medium::law::{Curve, Law};
use crate::magnetic::open::multipoles::Multipoles;
use crate::magnetic::saturation::equations::{Face, Medium, Point, Saturation};
use crate::magnetic::source::{MU0, Source};
use crate::stencils::region::Kind;

/// Step of the gradient of sources, in spacings.
const STEP: f64 = 0.1;

/// The reluctivity of a medium in the rows, over that of surroundings of permeability `around`: the geometric mean of that in
/// weak fields and beyond saturation.
#[must_use]
pub fn level(curve: &Curve, around: f64) -> f64 {
    around * (curve.at(0.0).slope / MU0).sqrt()
}

impl<'a, const D: usize> Saturation<'a, D> {
    /// Of the media of a scene by their laws; `conducts` tells which conduct.
    #[must_use]
    pub fn new(
        ground: Ground<'a, D>,
        permeable: &Permeable,
        laws: &'a [Law],
        conducts: &[bool],
        source: &Source,
        multipoles: Option<&Multipoles>,
    ) -> Self {
        let medium = |(m, law): (usize, &'a Law)| match law {
            Law::Constant(_) => None,
            Law::Curve(curve) => Some(Medium {
                curve,
                around: permeable.around(),
                level: permeable.weight(m as u16),
                conducts: conducts[m],
            }),
        };
        let Ground {
            region,
            sides,
            unknown,
        } = ground;
        let mut made = Self {
            region,
            sides,
            unknown,
            media: laws.iter().enumerate().map(medium).collect(),
            points: Vec::new(),
            faces: Vec::new(),
            walls: multipoles.map_or(Vec::new(), |m| m.fields.clone()),
            slots: Vec::new(),
        };
        let curved = |m: u16| made.media[m as usize].is_some();
        let point = |number: usize| match region.kinds[number] {
            Kind::Inside(m) if curved(m) => Some(made.point(number, m, source, multipoles)),
            _ => None,
        };
        let points = (0..region.len()).into_par_iter().filter_map(point);
        let points: Vec<Point<D>> = points.collect();
        let face = |number: usize| {
            let [a, b] = [region.faces[number].inner, region.faces[number].outer].map(curved);
            // A point on an interface stands for a volume of the inner medium.
            let seen = multipoles.filter(|_| a);
            (a || b).then(|| made.face(number, permeable, source, seen))
        };
        let faces = (0..region.faces.len()).into_par_iter().filter_map(face);
        let faces = faces.collect();
        (made.points, made.faces) = (points, faces);
        if made.conducts() {
            made.slots = made.slots();
        }
        made
    }

    fn point(
        &self,
        number: usize,
        medium: u16,
        source: &Source,
        multipoles: Option<&Multipoles>,
    ) -> Point<D> {
        let place = self.beside(number);
        let step = STEP * self.region.metrics[number].spacing();
        let at = |axis: usize, n: f64| {
            let mut beside = place;
            beside[axis] += n * step;
            source.flux_at(self.region.raise(beside)).map(|b| b.re)
        };
        let slope = |axis: usize| -> [f64; 3] {
            // Of the fourth order.
            let [a, b, c, d] = [1.0, -1.0, 2.0, -2.0].map(|n| at(axis, n));
            std::array::from_fn(|k| (8.0 * (a[k] - b[k]) - (c[k] - d[k])) / (12.0 * step))
        };
        Point {
            number,
            medium,
            source: at(0, 0.0),
            slopes: std::array::from_fn(slope),
            seen: self.seen(number, multipoles),
            flows: self.flows(number, medium),
        }
    }

    /// Whether currents flow at a point inside a medium, the neighbours of which are inside it or on its interfaces.
    fn flows(&self, number: usize, medium: u16) -> bool {
        let conducts = self.media[medium as usize]
            .as_ref()
            .is_some_and(|m| m.conducts);
        let mut neighbours = self.sides.own.neighbours(number).iter();
        conducts && neighbours.all(|j| !matches!(self.region.kinds[*j as usize], Kind::Wall { .. }))
    }

    /// Where each point stands among the points or faces here.
    fn slots(&self) -> Vec<u32> {
        let mut slots = vec![u32::MAX; self.region.len()];
        let points = self.points.iter().map(|p| p.number);
        let faces = self.faces.iter().map(|f| f.point);
        for (slot, number) in points.enumerate().chain(faces.enumerate()) {
            slots[number] = slot as u32;
        }
        slots
    }

    fn face(
        &self,
        number: usize,
        permeable: &Permeable,
        source: &Source,
        multipoles: Option<&Multipoles>,
    ) -> Face {
        let own = &self.region.faces[number];
        let point = own.point as usize;
        let (place, mut normal) = (self.beside(point), own.normal);
        if self.region.axial && self.region.places[point][0] == 0.0 {
            normal[0] = permeable.turn_at(self.region, point) * place[0];
        }
        Face {
            number,
            point,
            normal: self.region.raise(normal),
            source: source.flux_at(self.region.raise(place)).map(|b| b.re),
            seen: self.seen(point, multipoles),
        }
    }

    fn seen(&self, i: usize, multipoles: Option<&Multipoles>) -> Vec<[f64; 3]> {
        let Some(multipoles) = multipoles else {
            return Vec::new();
        };
        let one = |(value, gradient): (f64, [f64; D])| -> [f64; 3] {
            let seen = match D {
                3 => self.region.raise(gradient),
                _ => curl(self.region, i, value, gradient),
            };
            seen.map(|s| multipoles.weights[i] * s)
        };
        let all = multipoles.regular(self.region, i);
        all.into_iter().map(one).collect()
    }
}
