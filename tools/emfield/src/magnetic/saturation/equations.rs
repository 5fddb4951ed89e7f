//! Media whose permeability depends on the field.
//!
//! In each the field is split into that of one reluctivity and the rest, `H = nu_0 B - P` with `P = (nu_0 - nu) B` and
//! `nu = H/B` (Hantila 1975, Rev. Roum. Sci. Techn., Électrotechn. Énerg. 20, 397): the rows keep `nu_0`, and P stands on the
//! right. Reluctivities are over that of the surroundings, as in [`crate::magnetic::medium::interface`].
//!
//! - Inside, `curl H = J` is `-nu lap A + grad nu x B = -mu_a sigma dA/dt`, where `grad nu = (dnu/dB / B) (B . grad) B` by
//!   components. The row of A keeps its Laplacian and its rate m, `lap A + m`, less what is left of that equation over a
//!   reluctivity `nu_1`. What `nu_1` is the solution does not know: with the mean of `H/B` and `dH/dB` at the point each
//!   step shrinks what is left, whatever the level of saturation.
//! - Where currents flow P is differentiated instead, see `flow`.
//! - On an interface the field along it is continuous: `n x (P_b - P_a)` stands on the right of the jump of
//!   `nu_0 n x curl A`. Slopes on the side of such a medium do not know the Laplacian. P is not taken from B at once, which
//!   would grow beyond bounds where a circuit of iron is closed and the field is given: of the flux density `B` and the
//!   field `nu_0 B - P` that a solve has found along the face, `nu_0 B + (nu_0 B - P)` is kept, and the medium takes of it
//!   what its curve says, `nu_0 b + H(b)`. So waves are kept on a line that ends in something that is not linear (Lobry,
//!   Trécat and Broche 1996, IEEE Trans. Magn. 32, 559); whatever `nu_0`, no step grows.
//! - Seen from afar the multipoles of bound currents have those of P beside those of `(1 - nu_0) B`.
//!
//! All derivatives are those of the rows, so that `nu_0` and `nu_1` cancel in the solution.

use rayon::prelude::*;
use shapes::frame::{along, cross, difference, dot, length};
use wls::{Row, Stencils};

use crate::magnetic::medium::law::Curve;
use crate::magnetic::source::C;
use crate::magnetic::unknown::{Unknown, component, local};
use crate::stencils::region::Region;
use crate::stencils::sides::Sides;

/// Distance from an axis, in spacings, at which what is proportional to it is taken.
const BESIDE: f64 = 1e-2;

/// P on both sides of faces \[T\].
pub type Sheets = Vec<[[f64; 3]; 2]>;

/// Points and faces of media whose permeability depends on the field.
pub struct Saturation<'a, const D: usize> {
    pub(crate) region: &'a Region<D>,
    pub(crate) sides: &'a Sides<D>,
    pub(crate) unknown: Unknown,
    pub(crate) media: Vec<Option<Medium<'a>>>,
    pub(crate) points: Vec<Point<D>>,
    pub(crate) faces: Vec<Face>,
    /// Fields on walls by multipole.
    pub(crate) walls: Vec<Vec<f64>>,
    /// By point, where it stands among the points or faces here.
    pub(crate) slots: Vec<u32>,
}

/// A medium.
pub(crate) struct Medium<'a> {
    pub(crate) curve: &'a Curve,
    /// Permeability of the surroundings \[H/m\].
    pub(crate) around: f64,
    /// Reluctivity in the rows.
    pub(crate) level: f64,
    pub(crate) conducts: bool,
}

/// A point inside such a medium.
pub(crate) struct Point<const D: usize> {
    pub(crate) number: usize,
    pub(crate) medium: u16,
    /// Flux density of the sources where their wave is 1 \[T\], and its derivatives along the coordinates.
    pub(crate) source: [f64; 3],
    pub(crate) slopes: [[f64; 3]; D],
    /// By multipole, what P is multiplied with.
    pub(crate) seen: Vec<[f64; 3]>,
    /// Whether currents flow there, and P is known all around.
    pub(crate) flows: bool,
}

/// A face one or both sides of which are such media.
pub(crate) struct Face {
    pub(crate) number: usize,
    pub(crate) point: usize,
    pub(crate) normal: [f64; 3],
    /// Flux density of the sources where their wave is 1 \[T\].
    pub(crate) source: [f64; 3],
    /// By multipole, what P on the inner side is multiplied with.
    pub(crate) seen: Vec<[f64; 3]>,
}

/// A field as the media see it.
pub struct Seen<const K: usize> {
    /// Flux density inside, by point \[T\].
    pub inside: Vec<[f64; 3]>,
    /// On both sides of faces; zero where a side is no such medium.
    pub on: Sheets,
    pub(crate) rows: Vec<[f64; K]>,
}

impl Medium<'_> {
    /// `(nu_0 - nu) B`.
    pub(crate) fn rest(&self, flux: [f64; 3]) -> [f64; 3] {
        let local = self.curve.at(length(flux));
        flux.map(|b| (self.level - self.around * local.reluctivity) * b)
    }
}

/// A row of values with several components.
fn sum<const K: usize>(row: Row<'_>, a: &[[f64; K]]) -> [f64; K] {
    let mut sum = [0.0; K];
    for (j, w) in row.iter() {
        sum = std::array::from_fn(|k| sum[k] + w * a[j][k]);
    }
    sum
}

/// Slopes of a row of stencils, by axis.
fn slopes<const D: usize, const K: usize>(
    stencils: &Stencils<D>,
    i: usize,
    a: &[[f64; K]],
) -> [[f64; K]; D] {
    std::array::from_fn(|axis| sum(stencils.derivative(i, axis), a))
}

impl<'a, const D: usize> Saturation<'a, D> {
    /// The place of a point; of one on an axis that of one beside it.
    pub(crate) fn beside(&self, i: usize) -> [f64; D] {
        let mut place = self.region.places[i];
        if self.region.axial && place[0] == 0.0 {
            place[0] = BESIDE * self.region.metrics[i].spacing();
        }
        place
    }

    /// Whether any of the media conducts.
    #[must_use]
    pub fn conducts(&self) -> bool {
        self.media.iter().flatten().any(|medium| medium.conducts)
    }

    /// The point of an entry of what is seen inside, and after these on faces.
    #[must_use]
    pub fn place(&self, entry: usize) -> usize {
        match self.points.get(entry) {
            Some(point) => point.number,
            None => self.faces[(entry - self.points.len()) / 2].point,
        }
    }

    /// The field of the reaction `a`, by point, and sources with this wave; `moved` is what rates put into the rows, by
    /// point, or nothing.
    #[must_use]
    pub fn look<const K: usize>(&self, a: &[[f64; K]], wave: f64, moved: &[[f64; K]]) -> Seen<K> {
        let inside = self.points.par_iter().map(|point| {
            let moved = moved.get(point.number).copied().unwrap_or([0.0; K]);
            self.inside(point, a, wave, moved)
        });
        let (rows, inside): (Vec<[f64; K]>, Vec<[f64; 3]>) = inside.unzip();
        let on = self.faces.par_iter().map(|face| self.on(face, a, wave));
        let mut seen = Seen {
            inside,
            on: on.collect(),
            rows,
        };
        if self.conducts() {
            self.flow(&mut seen);
        }
        seen
    }

    /// P of a field on both sides of faces.
    #[must_use]
    pub fn sheets<const K: usize>(&self, seen: &Seen<K>) -> Sheets {
        let face = |(face, flux): (&Face, &[[f64; 3]; 2])| {
            let media = self.both(face);
            [0, 1].map(|k| media[k].map_or([0.0; 3], |medium| medium.rest(flux[k])))
        };
        self.faces.iter().zip(&seen.on).map(face).collect()
    }

    /// The media on both sides of a face, where they are such.
    fn both(&self, face: &Face) -> [Option<&Medium<'a>>; 2] {
        let own = &self.region.faces[face.number];
        [own.inner, own.outer].map(|m| self.media[m as usize].as_ref())
    }

    /// The next P on both sides of faces, from the field of a solve with these, and how far the flux densities that they
    /// belong to are from those found \[T\].
    #[must_use]
    pub fn next<const K: usize>(&self, seen: &Seen<K>, sheets: &Sheets) -> (Sheets, Sheets) {
        let one = |medium: &Medium<'_>, normal: [f64; 3], flux: [f64; 3], rest: [f64; 3]| {
            let level = medium.level;
            let through = dot(flux, normal);
            let tangential = along(flux, -through, normal);
            let rest = along(rest, -dot(rest, normal), normal);
            let kept: [f64; 3] = std::array::from_fn(|k| 2.0 * level * tangential[k] - rest[k]);
            let size = length(kept);
            let [level, wanted] = [level, size].map(|part| part / medium.around);
            let t = medium.curve.along(through, level, wanted);
            let own = kept.map(|w| if size > 0.0 { w / size * t } else { 0.0 });
            let rest = medium.rest(along(own, through, normal));
            (rest, std::array::from_fn(|k| own[k] - tangential[k]))
        };
        let face = |number: usize| {
            let face = &self.faces[number];
            let media = self.both(face);
            let side = |k: usize| {
                let (flux, rest) = (seen.on[number][k], sheets[number][k]);
                // Beside an axis the normal is not quite one of length 1.
                let unit = face.normal.map(|n| n / length(face.normal));
                media[k].map_or(([0.0; 3], [0.0; 3]), |medium| one(medium, unit, flux, rest))
            };
            let [a, b] = [0, 1].map(side);
            ([a.0, b.0], [a.1, b.1])
        };
        (0..self.faces.len()).into_par_iter().map(face).unzip()
    }

    /// Right sides of a field and of P on faces, by point.
    #[must_use]
    pub fn right<const K: usize>(&self, seen: &Seen<K>, sheets: &Sheets) -> Vec<[f64; K]> {
        let mut right = vec![[0.0; K]; self.region.len()];
        let mut moments = vec![[0.0; K]; self.walls.len()];
        for ((point, row), flux) in self.points.iter().zip(&seen.rows).zip(&seen.inside) {
            right[point.number] = *row;
            if let Some(medium) = &self.media[point.medium as usize] {
                count(&mut moments, medium.rest(*flux), &point.seen);
            }
        }
        for (face, [inner, outer]) in self.faces.iter().zip(sheets) {
            let sheet = cross(face.normal, difference(*outer, *inner));
            right[face.point] = self.component(&self.beside(face.point), sheet);
            count(&mut moments, *inner, &face.seen);
        }
        for (walls, moment) in self.walls.iter().zip(moments) {
            for (right, wall) in right.iter_mut().zip(walls) {
                *right = std::array::from_fn(|k| right[k] + moment[k] * wall);
            }
        }
        right
    }

    /// Right side of a point inside, and flux density there.
    fn inside<const K: usize>(
        &self,
        point: &Point<D>,
        a: &[[f64; K]],
        wave: f64,
        moved: [f64; K],
    ) -> ([f64; K], [f64; 3]) {
        let i = point.number;
        let Some(medium) = &self.media[point.medium as usize] else {
            return ([0.0; K], [0.0; 3]);
        };
        let (stencils, place) = (&self.sides.own, self.beside(i));
        let second = |b: usize, c: usize| sum(stencils.second(i, b, c), a);
        let seconds: [[[f64; K]; D]; D] =
            std::array::from_fn(|b| std::array::from_fn(|c| second(b, c)));
        let mut slopes = slopes(stencils, i, a);
        let mut laplacian = sum(stencils.laplacian(i), a);
        if self.region.axial {
            let off = place[0] - self.region.places[i][0];
            let drift = match off > 0.0 {
                true => seconds[0][0][0],
                false => slopes[0][0] / place[0],
            };
            laplacian[0] += self.unknown.around() * drift;
            slopes[0][0] += off * seconds[0][0][0];
        }
        let flux = along(self.curl(&place, a[i], slopes), wave, point.source);
        let here = medium.curve.at(length(flux));
        let mut gradient = [0.0; 3];
        for axis in 0..D {
            let mut slope = self.curl(&place, slopes[axis], seconds[axis]);
            if self.region.axial && axis == 0 {
                // B = (-r du/dz, 2 u + r du/dr).
                slope[0] -= slopes[1][0];
                slope[2] += slopes[0][0];
            }
            let slope = along(slope, wave, point.slopes[axis]);
            let mut unit = [0.0; D];
            unit[axis] = medium.around * here.bend * dot(flux, slope);
            gradient = along(gradient, 1.0, self.region.raise(unit));
        }
        let turned: [f64; K] = self.component(&place, cross(gradient, flux));
        let reluctivity = medium.around * here.reluctivity;
        let mean = 0.5 * (reluctivity + medium.around * here.slope);
        let over = match medium.conducts {
            true => mean.max(medium.level),
            false => mean,
        };
        let row = std::array::from_fn(|k| {
            let left = reluctivity * laplacian[k] - turned[k] + medium.level * moved[k];
            laplacian[k] + moved[k] - left / over
        });
        (row, flux)
    }

    /// Flux density on both sides of a face.
    fn on<const K: usize>(&self, face: &Face, a: &[[f64; K]], wave: f64) -> [[f64; 3]; 2] {
        let place = self.beside(face.point);
        let media = self.both(face);
        [(0, &self.sides.inner), (1, &self.sides.outer)].map(|(k, stencils)| {
            if media[k].is_none() {
                return [0.0; 3];
            }
            let slopes = slopes(stencils, face.point, a);
            along(self.curl(&place, a[face.point], slopes), wave, face.source)
        })
    }

    /// Flux density of values and slopes, these by axis.
    fn curl<const K: usize>(
        &self,
        place: &[f64; D],
        value: [f64; K],
        slopes: [[f64; K]; D],
    ) -> [f64; 3] {
        let value = value.map(C::from);
        let slopes: [[C; D]; K] =
            std::array::from_fn(|k| std::array::from_fn(|axis| C::from(slopes[axis][k])));
        let (_, flux) = local(self.unknown, place, &value, &value, &slopes);
        flux.map(|b| b.re)
    }

    /// A current as the unknown has it.
    fn component<const K: usize>(&self, place: &[f64; D], vector: [f64; 3]) -> [f64; K] {
        let found: [C; K] = component(self.unknown, place, &vector.map(C::from));
        found.map(|c| c.re)
    }
}

/// Adds what P at a point gives to moments: along what is given around it in a plane and about an axis, across in space.
fn count<const K: usize>(moments: &mut [[f64; K]], rest: [f64; 3], seen: &[[f64; 3]]) {
    for (moment, seen) in moments.iter_mut().zip(seen) {
        if K == 3 {
            let more = cross(rest, *seen);
            *moment = std::array::from_fn(|k| moment[k] + more[k]);
        } else {
            moment[0] += dot(rest, *seen);
        }
    }
}
