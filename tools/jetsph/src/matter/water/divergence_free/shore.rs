//! Which particles of the water meet which points of a solid, and how its faces move there.

use std::collections::BTreeMap;

use kernels::Kernel;
use particles::{POSITION, Set};
use rayon::prelude::*;

use crate::matter::meeting::faces::{GIVING, Moving, PULLED, Place};
use crate::matter::meeting::sight::Sight;
use crate::matter::meeting::skin::DEFORMATION;
use crate::matter::meeting::touch::Touch;
use crate::matter::solid::tensor::cofactor;
use crate::matter::water::seen::Seen;
use crate::state::{ACCELERATION, MASS, State};

/// How much a flat face of a lattice gives way to an impulse, over a free cell: for those that have just been met.
const USUAL: f64 = 10.0;
/// Water per unit of parallel work.
const GRAIN: usize = 64;

/// Accelerations of the particles of a solid, the last forces of the water included \[m/s2\].
fn pushed(set: &Set) -> Vec<[f64; 3]> {
    let others = set.column(&ACCELERATION).iter();
    let both = others.zip(set.column(&PULLED));
    both.map(|(a, b)| [0, 1, 2].map(|k| a[k] + b[k])).collect()
}

/// A solid, one of its cells, and a part of a face of that.
pub(super) type Part = (usize, usize, usize);
/// Forces on parts \[N\].
pub(super) type Known = BTreeMap<Part, [f64; 3]>;

/// A solid beside the water.
pub struct Shore<K> {
    /// Who meets whom.
    pub sight: Sight<K>,
}

/// A point of a solid, as a particle of the water sees it.
pub(super) struct Partner {
    /// Which solid, which of all points.
    pub(super) shore: usize,
    pub(super) point: usize,
    pub(super) visitor: usize,
    pub(super) touch: Touch,
    /// What stands for water there: its volume, and that it is led.
    pub(super) seen: Seen,
    /// From the point to the particle \[m\], r^2 \[m2\], W and grad W = slope . dx.
    pub(super) dx: [f64; 3],
    pub(super) square: f64,
    pub(super) weight: f64,
    pub(super) slope: f64,
    /// Out of the solid, as the particle and as the solid sees it.
    pub(super) normal: [f64; 3],
    pub(super) outward: [f64; 3],
    /// The part of a face that yields, and how many that face has.
    pub(super) part: Part,
    pub(super) parts: f64,
    /// k \[m2\].
    pub(super) area: f64,
    /// u_f.n, without s J \[m/s\].
    pub(super) speed: f64,
}

impl Partner {
    /// What stands there, for water of a velocity \[m/s\]: how the two go against one another is counted twice.
    pub(super) fn led(&self, u: [f64; 3]) -> Seen {
        let n = self.normal;
        let more = self.speed - (u[0] * n[0] + u[1] * n[1] + u[2] * n[2]);
        Seen {
            u: [0, 1, 2].map(|k| u[k] + more * n[k]),
            ..self.seen
        }
    }
}

impl<K: Kernel> Shore<K> {
    /// s of a cell \[1/kg\].
    pub(super) fn softness(&self, state: &State, cell: usize) -> f64 {
        let set = &state.sets[self.sight.skin.set];
        let told = set.column(&GIVING)[cell];
        if told > 0.0 {
            told
        } else {
            USUAL / set.column(&MASS)[cell]
        }
    }

    /// The partners of each visitor.
    pub(super) fn partners(
        &self,
        state: &State,
        seen: &[Seen],
        place: (usize, usize),
        known: &Known,
        dt: f64,
    ) -> Vec<Vec<Partner>> {
        let (number, first) = place;
        let skin = &self.sight.skin;
        let set = &state.sets[skin.set];
        let accelerations = pushed(set);
        let (moving, pushed) = (Moving::of(set), Moving::pushed(set, &accelerations));
        let position = state.sets[self.sight.water].column(&POSITION);
        let of = |v: usize| -> Vec<Partner> {
            let (a, mirror) = self.sight.visitor(v);
            let own = position[a];
            let image = mirror.iter().fold(own, |x, plane| {
                let height = plane.height(own, x);
                [0, 1, 2].map(|k| x[k] - 2.0 * height * plane.normal[k])
            });
            let back = |x: [f64; 3]| mirror.iter().rev().fold(x, |x, plane| plane.mirrored(x));
            let each = self.sight.row(v).iter().map(|p| {
                let point = &skin.points[*p as usize];
                let dx = [0, 1, 2].map(|k| image[k] - point.x[k]);
                let square = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
                let touch = skin.touch(&moving, *p, dx, own, mirror);
                let outward = self.outward(state, &touch.place, dx);
                let normal = back(touch.seen(mirror, outward));
                let (dx, slope) = (back(dx), self.sight.kernel.slope(square.sqrt()));
                let along: f64 = (0..3).map(|k| dx[k] * normal[k]).sum();
                let cell = touch.place.cell;
                let (number_of_part, parts) = skin.part_of_face(&touch.place);
                let part = (number, cell, number_of_part);
                let face = moving.velocity(&touch.place);
                let push = pushed.velocity(&touch.place);
                let soft = parts * self.softness(state, cell);
                let force = known.get(&part).copied().unwrap_or_default();
                let speed =
                    (0..3).map(|k| outward[k] * (face[k] + dt * (push[k] - soft * force[k])));
                Partner {
                    shore: number,
                    point: first + *p as usize,
                    visitor: v,
                    seen: Seen {
                        volume: point.volume,
                        value: 1.0,
                        ..Seen::default()
                    },
                    part,
                    parts,
                    square,
                    weight: self.sight.kernel.value(square.sqrt()),
                    area: -seen[a].volume * point.volume * slope * along.max(0.0),
                    speed: speed.sum(),
                    touch,
                    dx,
                    slope,
                    normal,
                    outward,
                }
            });
            each.collect()
        };
        let all = (0..self.sight.visitors())
            .into_par_iter()
            .with_min_len(GRAIN);
        all.map(of).collect()
    }

    /// The normal of the face at a place; where there is none, towards the water at an offset \[m\].
    fn outward(&self, state: &State, place: &Place, towards: [f64; 3]) -> [f64; 3] {
        let shape = &state.sets[self.sight.skin.set].column(&DEFORMATION)[place.cell];
        let turned =
            cofactor(shape).map(|row| (0..3).map(|k| row[k] * place.depth[k]).sum::<f64>());
        let is_face = place.depth.iter().any(|x| x.abs() > 0.0);
        let normal = if is_face { turned } else { towards };
        let size = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        normal.map(|x| x / size.max(f64::MIN_POSITIVE))
    }
}
