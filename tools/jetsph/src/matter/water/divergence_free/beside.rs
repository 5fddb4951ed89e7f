//! Solids beside water without sound.
//!
//! The points of a solid ([`crate::matter::meeting::skin`]) stand for water behind its face, as the water that a nozzle leads
//! does: the face f between the two moves with
//!
//! ```text
//! u_f = u + dt a - s dt F       of the face itself, less what its yielding counts from (`yielding`)
//! u_p = 2 (u_f.n) n - u_a       along the normal n of the face alone: water slips
//! p_p = sum_b V_b W_bp (p_b + rho f_b.(x_p - x_b))/sum_b V_b W_bp       (Adami, Hu and Adams 2012, eq. 27)
//! F_f = -sum_a 2 k_ap p_a n,   k_ap = -V_a V_p (dW/dr)/r x_ap.n
//! ```
//!
//! F there is the last force as the equation of the pressure has it, -sum_a 2 K_a p_a: that which acts is a little different, and the
//! difference would be a leak.
//!
//! Forces act on the faces ([`crate::matter::meeting::faces`]), as those of water with sound do, so that cracks let water in and
//! whole faces do not. The water has its impulse at once, the solid in its next step; what is under way is kept account of (`ledger`).

use std::collections::BTreeMap;

use kernels::Kernel;
use particles::{POSITION, sweep};
use rayon::prelude::*;

use super::ledger::Ledger;
use super::yielding::Yielding;
use crate::matter::meeting::faces::{
    BEND, BEND_PUSH, DEFORMATION_PUSH, GIVING, Moving, PRESSED, PULL, Place, TWIST, Taken, WARP,
    WARP_PUSH,
};
use crate::matter::meeting::sight::Sight;
use crate::matter::meeting::skin::DEFORMATION;
use crate::matter::meeting::touch::Touch;
use crate::matter::solid::tensor::cofactor;
use crate::matter::water::seen::Seen;
use crate::stage::{Entry, Figure};
use crate::state::{MASS, State};

/// How much a flat face of a lattice gives way to an impulse, over a free cell: for those that have just been met.
const USUAL: f64 = 5.7;
/// Water per unit of parallel work.
const GRAIN: usize = 64;

/// Forces on cells by solids and cells \[N\].
type Known = BTreeMap<(usize, usize), [f64; 3]>;

/// A solid beside the water.
pub struct Shore<K> {
    /// Who meets whom.
    pub sight: Sight<K>,
}

/// A point of a solid, as a particle of the water sees it.
pub(super) struct Partner {
    /// Which solid, which of all points.
    shore: usize,
    point: usize,
    visitor: usize,
    touch: Touch,
    /// What stands for water there: its volume, and that it is led.
    pub(super) seen: Seen,
    /// From the point to the particle \[m\], r^2 \[m2\], W and grad W = slope . dx.
    pub(super) dx: [f64; 3],
    pub(super) square: f64,
    weight: f64,
    pub(super) slope: f64,
    /// Out of the solid, as the particle and as the solid sees it.
    pub(super) normal: [f64; 3],
    outward: [f64; 3],
    /// k \[m2\].
    area: f64,
    /// u_f.n \[m/s\].
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

/// All solids beside the water.
pub(super) struct Beside<K> {
    shores: Vec<Shore<K>>,
    ledgers: Vec<Ledger>,
    /// Partners of each particle; nothing where no solid is.
    partners: Vec<Vec<Partner>>,
    /// Pressures at the points \[Pa\].
    pressure: Vec<f64>,
    /// Which cells water meets, by solids.
    met: Vec<(usize, usize)>,
    /// With what the last pressure pushed each of them \[N\].
    known: Known,
    /// Forces on each solid \[N\].
    pub(super) forces: Vec<[f64; 3]>,
}

impl<K: Kernel> Beside<K> {
    pub(super) fn new(shores: Vec<Shore<K>>) -> Self {
        Self {
            ledgers: vec![Ledger::default(); shores.len()],
            forces: vec![[0.0; 3]; shores.len()],
            shores,
            partners: Vec::new(),
            pressure: Vec::new(),
            met: Vec::new(),
            known: BTreeMap::new(),
        }
    }

    /// Number of solids.
    pub(super) fn len(&self) -> usize {
        self.shores.len()
    }

    /// Whom a particle meets.
    #[inline(always)]
    pub(super) fn of(&self, a: usize) -> &[Partner] {
        self.partners.get(a).map_or(&[], Vec::as_slice)
    }

    pub(super) fn declare(&self, state: &mut State) {
        for shore in &self.shores {
            let set = &mut state.sets[shore.sight.skin.set];
            set.declare(&PULL);
            [TWIST, BEND, WARP, DEFORMATION_PUSH, BEND_PUSH, WARP_PUSH]
                .iter()
                .for_each(|c| set.declare(c));
            set.declare(&PRESSED);
            set.declare(&GIVING);
        }
    }

    /// Puts forces into columns that lack them.
    pub(super) fn show(&mut self, state: &mut State) {
        for (shore, ledger) in self.shores.iter().zip(&mut self.ledgers) {
            ledger.look(&mut state.sets[shore.sight.skin.set]);
        }
    }

    /// Counts what the solids got in a step of `dt` \[s\].
    pub(super) fn march(&mut self, state: &State, dt: f64, entry: &mut Entry) {
        for (shore, ledger) in self.shores.iter().zip(&mut self.ledgers) {
            let got = ledger.march(&state.sets[shore.sight.skin.set], dt);
            entry.spent -= got.work;
            (0..3).for_each(|k| entry.impulse[k] += got.impulse[k]);
        }
    }

    /// Finds who meets whom, and how faces move after a step of `dt` \[s\]; `seen` are the particles of the water, and `is_led` tells
    /// which a nozzle leads.
    pub(super) fn look(
        &mut self,
        state: &State,
        seen: &[Seen],
        dt: f64,
        is_led: impl Fn(&Seen) -> bool,
    ) {
        self.partners.clear();
        self.partners.resize_with(seen.len(), Vec::new);
        let mut first = 0;
        for (number, shore) in self.shores.iter_mut().enumerate() {
            shore.sight.look(state);
            let found = shore.partners(state, seen, (number, first), &self.known, dt);
            for (v, partners) in found.into_iter().enumerate() {
                let (a, _) = shore.sight.visitor(v);
                if !is_led(&seen[a]) {
                    self.partners[a].extend(partners);
                }
            }
            first += shore.sight.skin.points.len();
        }
        self.pressure.clear();
        self.pressure.resize(first, 0.0);
    }

    /// How the solids yield, for water of `density` \[kg/m3\].
    pub(super) fn yielding(&mut self, state: &State, density: f64) -> Yielding {
        let cells = self
            .shores
            .iter()
            .map(|s| state.sets[s.sight.skin.set].len());
        let mut slots: Vec<Vec<u32>> = cells.map(|n| vec![u32::MAX; n]).collect();
        let (mut rows, mut soft) = (Vec::new(), Vec::new());
        self.met.clear();
        for (a, partners) in self.partners.iter().enumerate() {
            let mut met: Vec<(u32, [f64; 3])> = Vec::new();
            for partner in partners {
                let (cell, shore) = (partner.touch.place.cell, &self.shores[partner.shore]);
                let slot = &mut slots[partner.shore][cell];
                if *slot == u32::MAX {
                    *slot = soft.len() as u32;
                    soft.push(2.0 * density * shore.softness(state, cell));
                    self.met.push((partner.shore, cell));
                }
                let area = partner.outward.map(|n| partner.area * n);
                if let Some((_, sum)) = met.iter_mut().find(|(cell, _)| cell == slot) {
                    (0..3).for_each(|k| sum[k] += area[k]);
                } else {
                    met.push((*slot, area));
                }
            }
            if !met.is_empty() {
                rows.push((a as u32, met));
            }
        }
        Yielding::of(self.partners.len(), rows, soft)
    }

    /// Notes with what the pressures \[Pa\] push each cell, as their equation knows it.
    pub(super) fn note(&mut self, p: &[f64], yielding: &Yielding) {
        let forces = yielding.forces(p);
        self.known = self.met.iter().copied().zip(forces).collect();
    }

    /// p_p, the mean around each point; `pushed` tells f \[m/s2\].
    pub(super) fn reach(&mut self, p: &[f64], seen: &[Seen], density: f64, pushed: &[[f64; 3]]) {
        let mut sums = vec![[0.0; 2]; self.pressure.len()];
        for (a, partners) in self.partners.iter().enumerate() {
            for partner in partners {
                let rise: f64 = (0..3).map(|k| pushed[a][k] * partner.dx[k]).sum();
                let weight = seen[a].volume * partner.weight;
                let [sum, weights] = &mut sums[partner.point];
                *sum += weight * (p[a] - density * rise);
                *weights += weight;
            }
        }
        let mean = |[sum, weights]: [f64; 2]| if weights > 0.0 { sum / weights } else { 0.0 };
        sweep::fill(&mut self.pressure, |point| mean(sums[point]));
    }

    /// p_p \[Pa\].
    #[inline(always)]
    pub(super) fn pressure(&self, partner: &Partner) -> f64 {
        self.pressure[partner.point]
    }

    /// Adds what particle `a` of pressure `p` \[Pa\] tells of the forces \[N\]: on the walls, which come first, and on the solids.
    pub(super) fn across(&self, a: usize, p: f64, forces: &mut [[f64; 3]]) {
        let walls = self.shores.first().map_or(0, |s| s.sight.walls());
        let (on_walls, on_solids) = forces.split_at_mut(walls);
        for partner in self.of(a) {
            let size = 2.0 * partner.area * p;
            let (_, mirror) = self.shores[partner.shore].sight.visitor(partner.visitor);
            let rest = [0, 1, 2].map(|k| size * (partner.outward[k] - partner.normal[k]));
            partner.touch.bear(mirror, rest, on_walls);
            (0..3).for_each(|k| on_solids[partner.shore][k] -= size * partner.outward[k]);
        }
    }

    /// Gives the solids their forces, which have given the water its impulse over a step of `dt` \[s\]: what pairs tell, and of what is left of
    /// the whole forces \[N\] a share by the size of that.
    pub(super) fn press(&mut self, state: &mut State, p: &[f64], whole: Vec<[f64; 3]>, dt: f64) {
        let mut told = vec![([0.0; 3], 0.0); self.len()];
        for (a, partners) in self.partners.iter().enumerate() {
            for partner in partners {
                let size = 2.0 * partner.area * p[a];
                let (sum, sizes) = &mut told[partner.shore];
                (0..3).for_each(|k| sum[k] -= size * partner.outward[k]);
                *sizes += size.abs();
            }
        }
        for (number, shore) in self.shores.iter().enumerate() {
            let (sum, sizes) = told[number];
            let left = [0, 1, 2].map(|k| {
                if sizes > 0.0 {
                    (whole[number][k] - sum[k]) / sizes
                } else {
                    0.0
                }
            });
            let set = &mut state.sets[shore.sight.skin.set];
            let mut taken = Taken::begin(set);
            let pressed = set.column_mut(&PRESSED);
            pressed.fill(0);
            for (a, partners) in self.partners.iter().enumerate() {
                for partner in partners.iter().filter(|partner| partner.shore == number) {
                    let size = 2.0 * partner.area * p[a];
                    let force = [0, 1, 2].map(|k| size.abs() * left[k] - size * partner.outward[k]);
                    taken.add(&partner.touch.place, force);
                    pressed[partner.touch.place.cell] = 1;
                }
            }
            self.ledgers[number].renew(set, taken, dt);
        }
        self.forces = whole;
    }

    /// Force of the water on each solid along each of `axes`.
    pub(super) fn figures(&self, state: &State) -> impl Iterator<Item = Figure> {
        let each = self.shores.iter().zip(&self.forces);
        each.flat_map(|(shore, force)| {
            let name = state.sets[shore.sight.skin.set].name();
            let axes = ["x", "y", "z"].iter().zip(*force).take(state.dimensions);
            axes.map(move |(axis, value)| Figure {
                name: format!("water_force_on_{name}_{axis}"),
                unit: "N",
                value,
            })
        })
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let partners = self.partners.iter().map(Vec::capacity).sum::<usize>();
        let ledgers = self.ledgers.iter().map(Ledger::bytes).sum::<usize>();
        size_of::<Partner>() * partners + 24 * self.partners.len() + ledgers
    }

    /// What a checkpoint keeps; nothing without solids.
    pub(super) fn save(&self) -> Vec<f64> {
        let mut saved = Vec::new();
        if !self.shores.is_empty() {
            saved.extend(self.forces.as_flattened());
            self.ledgers
                .iter()
                .for_each(|ledger| ledger.save(&mut saved));
            saved.push(self.known.len() as f64);
            for ((shore, cell), [x, y, z]) in &self.known {
                saved.extend([*shore as f64, *cell as f64, *x, *y, *z]);
            }
        }
        saved
    }

    /// Takes it back; gives the rest.
    pub(super) fn restore<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        if self.shores.is_empty() {
            return saved;
        }
        let mut rest = saved;
        for force in self.forces.as_flattened_mut() {
            if let Some((first, others)) = rest.split_first() {
                (*force, rest) = (*first, others);
            }
        }
        for ledger in &mut self.ledgers {
            rest = ledger.restore(rest);
        }
        self.known.clear();
        if let Some((count, others)) = rest.split_first() {
            let (all, others) = others.split_at(5 * *count as usize);
            for [shore, cell, x, y, z] in all.as_chunks::<5>().0 {
                self.known
                    .insert((*shore as usize, *cell as usize), [*x, *y, *z]);
            }
            rest = others;
        }
        rest
    }
}

impl<K: Kernel> Shore<K> {
    /// s of a cell \[1/kg\].
    fn softness(&self, state: &State, cell: usize) -> f64 {
        let set = &state.sets[self.sight.skin.set];
        let told = set.column(&GIVING)[cell];
        if told > 0.0 {
            told
        } else {
            USUAL / set.column(&MASS)[cell]
        }
    }

    /// The partners of each visitor.
    fn partners(
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
        let (moving, pushed) = (Moving::of(set), Moving::pushed(set));
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
                let (cell, soft) = (touch.place.cell, self.softness(state, touch.place.cell));
                let face = moving.velocity(&touch.place);
                let push = pushed.velocity(&touch.place);
                let force = known.get(&(number, cell)).copied().unwrap_or_default();
                let speed =
                    (0..3).map(|k| outward[k] * (face[k] + dt * push[k] - soft * dt * force[k]));
                Partner {
                    shore: number,
                    point: first + *p as usize,
                    visitor: v,
                    seen: Seen {
                        volume: point.volume,
                        value: 1.0,
                        ..Seen::default()
                    },
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
