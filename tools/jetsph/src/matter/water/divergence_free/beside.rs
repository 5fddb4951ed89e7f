//! Solids beside water without sound.
//!
//! The points of a solid ([`crate::matter::meeting::skin`]) stand for water behind its face, as the water that a nozzle leads
//! does: the face f between the two moves with
//!
//! ```text
//! u_f = u + dt a + s (J - dt F) what its forces give it, the last ones F of the water included, and how it yields (`yielding`)
//! u_p = 2 (u_f.n) n - u_a       along the normal n of the face alone: water slips
//! p_p = sum_b V_b W_bp (p_b + rho f_b.(x_p - x_b))/sum_b V_b W_bp       (Adami, Hu and Adams 2012, eq. 27)
//! F_f = -sum_a 2 k_ap p_a n,   k_ap = -V_a V_p (dW/dr)/r x_ap.n
//! ```
//!
//! F in the second term is that of the equation of the pressure, -sum_a 2 K_a p_a: that which acts is a little different, and the
//! difference would be a leak.
//!
//! Forces act on the faces ([`crate::matter::meeting::faces`]), as those of water with sound do, so that cracks let water in and
//! whole faces do not. Solid and water take the impulse of the pressure at once, in the same step
//! ([`crate::stage::Stage::receive`]): a solid that got it a step later swung against water that is denser than itself.

use std::collections::BTreeMap;

use kernels::Kernel;
use particles::{Set, sweep};

use super::shore::{Known, Part, Partner, Shore};
use super::yielding::Yielding;
use crate::matter::meeting::faces::{
    BEND, BEND_PUSH, DEFORMATION_PUSH, GIVING, PRESSED, PULL, PULLED, TWIST, Taken, WARP, WARP_PUSH,
};
use crate::matter::water::seen::Seen;
use crate::stage::Figure;
use crate::state::State;

/// Force on a cell \[N\] and its moments, by rows of first, second and mixed derivatives.
type Charge = [[f64; 3]; 10];

/// All solids beside the water.
pub(super) struct Beside<K> {
    shores: Vec<Shore<K>>,
    /// Partners of each particle; nothing where no solid is.
    partners: Vec<Vec<Partner>>,
    /// Pressures at the points \[Pa\].
    pressure: Vec<f64>,
    /// What water meets.
    met: Vec<Part>,
    /// With what the last pressure pushed each of them \[N\].
    known: Known,
    /// Forces on cells with their moments, as columns of the solids have them.
    charges: Vec<(usize, usize, Charge)>,
    /// Whether the columns lack them, after a checkpoint was taken up.
    is_new: bool,
    /// Forces on each solid \[N\].
    pub(super) forces: Vec<[f64; 3]>,
}

impl<K: Kernel> Beside<K> {
    pub(super) fn new(shores: Vec<Shore<K>>) -> Self {
        Self {
            forces: vec![[0.0; 3]; shores.len()],
            shores,
            partners: Vec::new(),
            pressure: Vec::new(),
            met: Vec::new(),
            known: Known::new(),
            charges: Vec::new(),
            is_new: false,
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
            set.declare(&PULLED);
        }
    }

    /// Puts the forces into columns that lack them.
    pub(super) fn show(&mut self, state: &mut State) {
        if std::mem::take(&mut self.is_new) {
            for (shore, cell, charge) in &self.charges {
                let set = &mut state.sets[self.shores[*shore].sight.skin.set];
                set.column_mut(&PULL)[*cell] = charge[0];
                for (k, column) in [&TWIST, &BEND, &WARP].into_iter().enumerate() {
                    set.column_mut(column)[*cell].copy_from_slice(&charge[3 * k + 1..3 * k + 4]);
                }
            }
        }
    }

    /// Keeps the forces of the columns of a solid.
    fn keep(&mut self, number: usize, set: &Set) {
        let pressed = set.column(&PRESSED).iter().enumerate();
        for (cell, _) in pressed.filter(|(_, pressed)| **pressed > 0) {
            let mut charge = [[0.0; 3]; 10];
            charge[0] = set.column(&PULL)[cell];
            for (k, column) in [&TWIST, &BEND, &WARP].into_iter().enumerate() {
                charge[3 * k + 1..3 * k + 4].copy_from_slice(&set.column(column)[cell]);
            }
            self.charges.push((number, cell, charge));
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
        let mut slots: BTreeMap<Part, u32> = BTreeMap::new();
        let (mut rows, mut soft) = (Vec::new(), Vec::new());
        self.met.clear();
        for (a, partners) in self.partners.iter().enumerate() {
            let mut met: Vec<(u32, [f64; 3])> = Vec::new();
            for partner in partners {
                let shore = &self.shores[partner.shore];
                let slot = *slots.entry(partner.part).or_insert_with(|| {
                    let cell = partner.part.1;
                    soft.push(2.0 * density * partner.parts * shore.softness(state, cell));
                    self.met.push(partner.part);
                    soft.len() as u32 - 1
                });
                let area = partner.outward.map(|n| partner.area * n);
                if let Some((_, sum)) = met.iter_mut().find(|(part, _)| *part == slot) {
                    (0..3).for_each(|k| sum[k] += area[k]);
                } else {
                    met.push((slot, area));
                }
            }
            if !met.is_empty() {
                rows.push((a as u32, met));
            }
        }
        Yielding::of(self.partners.len(), rows, soft)
    }

    /// Notes with what the pressures \[Pa\] push each part, as their equation knows it.
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

    /// Puts forces on the solids: what pairs tell, and of what is left of the whole forces \[N\] a share by the size of that.
    pub(super) fn press(&mut self, state: &mut State, p: &[f64], whole: Vec<[f64; 3]>) {
        let mut told = vec![([0.0; 3], 0.0); self.len()];
        for (a, partners) in self.partners.iter().enumerate() {
            for partner in partners {
                let size = 2.0 * partner.area * p[a];
                let (sum, sizes) = &mut told[partner.shore];
                (0..3).for_each(|k| sum[k] -= size * partner.outward[k]);
                *sizes += size.abs();
            }
        }
        self.charges.clear();
        for number in 0..self.len() {
            let (sum, sizes) = told[number];
            let left = [0, 1, 2].map(|k| {
                if sizes > 0.0 {
                    (whole[number][k] - sum[k]) / sizes
                } else {
                    0.0
                }
            });
            let set = &mut state.sets[self.shores[number].sight.skin.set];
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
            taken.end(set);
            self.keep(number, set);
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
        size_of::<Partner>() * partners + 24 * self.partners.len()
    }

    /// What a checkpoint keeps; nothing without solids.
    pub(super) fn save(&self) -> Vec<f64> {
        let mut saved = Vec::new();
        if !self.shores.is_empty() {
            saved.extend(self.forces.as_flattened());
            saved.extend([self.known.len() as f64, self.charges.len() as f64]);
            for ((shore, cell, part), force) in &self.known {
                saved.extend([*shore as f64, *cell as f64, *part as f64]);
                saved.extend(force);
            }
            for (shore, cell, charge) in &self.charges {
                saved.extend([*shore as f64, *cell as f64]);
                saved.extend(charge.as_flattened());
            }
        }
        saved
    }

    /// Takes it back; gives the rest.
    pub(super) fn restore<'a>(&mut self, saved: &'a [f64]) -> &'a [f64] {
        if self.shores.is_empty() {
            return saved;
        }
        let (told, rest) = saved.split_at(3 * self.shores.len());
        self.forces.as_flattened_mut().copy_from_slice(told);
        let [known, charges, rest @ ..] = rest else {
            return rest;
        };
        let (parts, rest) = rest.split_at(6 * *known as usize);
        let (cells, rest) = rest.split_at(32 * *charges as usize);
        let each = parts.as_chunks::<6>().0.iter();
        let each = each.map(|[shore, cell, part, x, y, z]| {
            let part = (*shore as usize, *cell as usize, *part as usize);
            (part, [*x, *y, *z])
        });
        self.known = each.collect();
        let each = cells.as_chunks::<32>().0.iter();
        let each = each.map(|[shore, cell, numbers @ ..]| {
            let mut charge = [[0.0; 3]; 10];
            charge.as_flattened_mut().copy_from_slice(numbers);
            (*shore as usize, *cell as usize, charge)
        });
        self.charges = each.collect();
        self.is_new = true;
        rest
    }
}
