//! Where two liquids meet.
//!
//! Each pair of particles is two layers in series, so that the acceleration is the same on both sides however their
//! densities differ:
//!
//! ```text
//! 1/rho grad p = 1/rho_0 B sum_b s x_ab beta_ab (p_b - p_a)        beta_ab = 2 rho_0/(rho_a + rho_b)
//! ```
//!
//! with the density rho_0 of the metal, and so in the equation of p. What is known of p beforehand is known in each liquid by its
//! own density ([`super::weight`]), p = p' + rho a.(x - x_0) + p_0, and p jumps by the tension. Both are jumps of p' that a
//! pair takes out before it differs (Kang, Fedkiw and Liu 2000):
//!
//! ```text
//! p'_b - p'_a + J_ab        J_ab = (rho_b - rho_a) a.((x_a + x_b)/2 - x_0) - gamma kappa     (b slag; + where a is)
//! ```
//!
//! So layers at rest are at rest however their particles lie along the interface, and a drop has its pressure. x_0 is the
//! middle of the interface. Its curvature is that of the surface that slag has where the metal is taken away
//! ([`crate::surface::curvature`]); solids beside it count as what they touch, so that it meets them at right angles.
//! Particles are shifted along the interface alone: it goes with the flow, and nothing is mixed by what keeps them even.

use kernels::moments::{Moments, inverse, times, within};
use particles::Matter;
use shapes::frame::{along, difference, dot, squared};

use super::filled::Filled;
use super::islands::Islands;
use super::operators::Sums;
use super::slip::{self, Sides};
use super::weight::Weight;
use crate::near::{Liquids, Near, Role};
use crate::surface::curvature::Curvature;

/// Weight of the neighbours of its own liquid, in parts of the lattice's, from which on they begin to tell, and wholly tell, what a
/// particle does along the interface. One beside a plane interface has 0.67.
const TRUST: [f64; 2] = [0.45, 0.60];

/// What a particle has of both liquids around it.
#[derive(Debug, Clone, Copy, Default)]
struct Meeting {
    /// Sum of w beta over the liquid \[1/m5\].
    weight: f64,
    /// Sum of w beta J \[Pa/m5\].
    jump: f64,
    /// Sum of s x beta J \[Pa/m4\].
    pull: [f64; 3],
    /// Unit vector towards the other liquid; zero where there is none.
    normal: [f64; 3],
    /// B of the neighbours of its own liquid and of solids \[m3\], and how far they alone tell what goes on along the interface.
    own: Moments,
    trust: f64,
}

impl Meeting {
    /// Of a gradient by all neighbours and one by those of its own liquid: across the interface the first, along it the second.
    #[inline]
    fn blend(&self, all: [f64; 3], own: [f64; 3]) -> [f64; 3] {
        if self.trust <= 0.0 {
            return all;
        }
        let apart = difference(own, all);
        let slip = along(apart, -dot(apart, self.normal), self.normal);
        along(all, self.trust, slip)
    }
}

/// The interface with its scratch, `[m]` in the order of [`Near`]; empty where there is one liquid.
#[derive(Debug, Clone, Default)]
pub(super) struct Interface {
    rows: Vec<Meeting>,
    /// Operators of the divergence.
    sides: Vec<Sides>,
    /// D u times these, `[m + images]`.
    stretched: Vec<Sides>,
    /// Sum of the middles of the pairs of a row that meet, and their number.
    middles: Vec<[f64; 4]>,
    /// p' that slag sees at solids \[Pa\].
    pub(super) beyond: Vec<f64>,
    /// Whether slag is there, or is what a solid touches, `[m + images]`.
    side: Vec<bool>,
    /// kappa at slag \[1/m\], `[m + images]`; empty without tension.
    kappa: Vec<f64>,
    curvature: Option<Box<Curvature>>,
}

impl Interface {
    /// Finds where it is and how it bends; gives a place in its middle.
    pub(super) fn find(&mut self, near: &Near, metal: Matter) -> Option<[f64; 3]> {
        let liquids = near.liquids.as_ref()?;
        if liquids.tension > 0.0 {
            self.bend(near, liquids, metal);
        }
        self.middles.resize(near.len(), [0.0; 4]);
        near.each_row(&mut self.middles, |a, row, sum| {
            *sum = [0.0; 4];
            if near.role[a] == Role::Liquid {
                for (b, _) in row.slopes().filter(|(b, _)| near.role[*b].flows()) {
                    if !liquids.alike(a, b) {
                        let [x, y, z] = middle(near, a, b);
                        *sum = [sum[0] + x, sum[1] + y, sum[2] + z, sum[3] + 1.0];
                    }
                }
            }
        });
        let all = self.middles.iter().fold([0.0; 4], |all, sum| {
            std::array::from_fn(|k| all[k] + sum[k])
        });
        let [x, y, z, count] = all;
        (count > 0.0).then(|| [x, y, z].map(|x| x / count))
    }

    /// The curvature of slag, metal taken away.
    fn bend(&mut self, near: &Near, liquids: &Liquids, metal: Matter) {
        self.touch(near, liquids);
        let new = || Box::new(Curvature::new(metal));
        let curvature = self.curvature.get_or_insert_with(new);
        curvature.measure_part(near, &self.side);
        let known = &curvature.mean;
        self.kappa.resize(near.len(), 0.0);
        // What lies too deep to tell has the mean of its neighbours.
        near.each_row(&mut self.kappa, |a, row, kappa| {
            *kappa = known[a].unwrap_or_else(|| {
                let around = row.slopes();
                let around = around.map(|(b, _)| near.images().original(b));
                let around = around.filter_map(|b| known[b]);
                let (sum, count) =
                    around.fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
                if count > 0.0 { sum / count } else { 0.0 }
            });
        });
        near.complete(&mut self.kappa, |kappa, _, _| kappa);
    }

    /// Finds on which side of the interface solids lie: that of most of the liquid that they touch, and those behind them alike.
    fn touch(&mut self, near: &Near, liquids: &Liquids) {
        self.side.clear();
        self.side
            .extend((0..near.len()).map(|a| near.role[a] == Role::Liquid && liquids.is_slag(a)));
        let liquid = |b: usize| near.role[b].flows();
        let mut balance = vec![0.0_f64; near.len()];
        near.each_row(&mut balance, |a, row, balance| {
            if near.role[a] == Role::Wet {
                for (b, slope) in row.slopes().filter(|(b, _)| liquid(*b)) {
                    *balance -= if liquids.is_slag(b) { slope } else { -slope };
                }
            }
        });
        // Those that touch no liquid lie as those before them do.
        let mut behind = vec![0.0_f64; near.len()];
        near.each_row(&mut behind, |a, row, behind| {
            if near.role[a] == Role::Wet && balance[a] == 0.0 {
                let solid = row.values().filter(|(b, _)| *b < balance.len());
                *behind = solid.map(|(b, w)| w * signum(balance[b])).sum();
            }
        });
        for (balance, behind) in balance.iter_mut().zip(&behind) {
            *balance += behind;
        }
        for a in (0..near.len()).filter(|a| near.role[*a] == Role::Wet) {
            let sign = signum(balance[a]);
            for b in near.lists.row(a).iter().map(|b| *b as usize) {
                if b < near.len() && near.role[b] == Role::Backing {
                    let far = squared(difference(near.position[a], near.position[b])).sqrt();
                    balance[b] += sign * near.kernel.value(far);
                }
            }
        }
        for (a, side) in self.side.iter_mut().enumerate() {
            *side |= near.role[a] != Role::Liquid && balance[a] > 0.0;
        }
        near.complete(&mut self.side, |side, _, _| side);
    }

    /// What pairs have of both liquids, after the weight is known; `rows` tell where the free surface is. There both move together: what
    /// is left to one of them alone is an edge, by which no slope is told.
    pub(super) fn meet(
        &mut self,
        near: &Near,
        islands: &Islands,
        weight: &Weight,
        rows: &[Sums],
        filled: Filled,
    ) {
        let Some(liquids) = &near.liquids else {
            return;
        };
        let kappa = &self.kappa;
        let jump = |a: usize, b: usize| {
            let denser = (liquids.density(b) - liquids.density(a)) / liquids.densities()[0];
            let borne = denser * weight.of_metal(islands, a, middle(near, a, b));
            if kappa.is_empty() {
                return borne;
            }
            // Where the free surface begins, the interface ends.
            let ends = [a, b].map(|a| rows[near.images().original(a)].missing > 0.0);
            if ends != [false; 2] {
                return borne;
            }
            let pulled = liquids.tension * kappa[if liquids.is_slag(b) { b } else { a }];
            borne - if liquids.is_slag(b) { pulled } else { -pulled }
        };
        self.rows.resize(near.len(), Meeting::default());
        near.each_row(&mut self.rows, |a, row, out| {
            *out = Meeting::default();
            if near.role[a] != Role::Liquid {
                return;
            }
            for (b, slope) in row.slopes().filter(|(b, _)| near.role[*b].flows()) {
                let share = liquids.share(a, b);
                out.weight -= slope * share;
                if !liquids.alike(a, b) {
                    let (x, jump) = (difference(near.position[a], near.position[b]), jump(a, b));
                    out.jump -= slope * share * jump;
                    out.pull = along(out.pull, slope * share * jump, x);
                    out.normal = along(out.normal, slope, x);
                }
            }
            let size = squared(out.normal).sqrt();
            if size > 0.0 {
                out.normal = out.normal.map(|x| x / size);
                if rows[a].missing > 0.0 {
                    return;
                }
                let alike = |b: usize| !near.role[b].flows() || liquids.alike(a, b);
                let (mut fill, mut moments) = (0.0, [0.0; 6]);
                for (b, slope) in row.slopes().filter(|(b, _)| alike(*b)) {
                    let x = difference(near.position[a], near.position[b]);
                    let [p, q, r] = x.map(|x| -slope * x);
                    let squares = [p * x[0], q * x[1], r * x[2], p * x[1], p * x[2], q * x[2]];
                    moments = std::array::from_fn(|i| moments[i] + squares[i]);
                    fill -= slope;
                }
                out.trust = within(fill / filled.weight, TRUST);
                out.own = inverse(moments, filled.moment, 1.0);
            }
        });
    }

    /// Sum of w beta over the liquid, and of w beta J, of the particle `a` with the sums `row`.
    #[inline]
    pub(super) fn terms(&self, a: usize, row: &Sums) -> [f64; 2] {
        let meeting = self.rows.get(a);
        meeting.map_or([row.liquid, 0.0], |meeting| [meeting.weight, meeting.jump])
    }

    /// rho of the lightest liquid that the particle `a` touches, over that of the metal. Damped by it, and not by its own, what single
    /// particles do keeps momentum, and a light one is not thrown off.
    #[inline]
    pub(super) fn lightest(&self, near: &Near, a: usize) -> f64 {
        match self.rows.get(a) {
            Some(meeting) if squared(meeting.normal) > 0.0 => near.heaviness(a) * near.slowness(a),
            _ => near.heaviness(a),
        }
    }

    /// The part of `way` of the particle `a` that does not lead through the interface.
    #[inline]
    pub(super) fn along(&self, a: usize, way: [f64; 3]) -> [f64; 3] {
        match self.rows.get(a) {
            Some(Meeting { normal, .. }) => along(way, -dot(way, *normal), *normal),
            None => way,
        }
    }

    /// grad p' rho_0/rho with the jumps taken out, as [`super::DivergenceFree`] has it for one liquid; p' of the liquid and of
    /// solids as metal sees it is `total`, upon the surface `upon`.
    pub(super) fn differ(
        &self,
        near: &Near,
        rows: &[Sums],
        total: &[f64],
        upon: &[f64],
        slope: &mut [[f64; 3]],
    ) {
        let Some(liquids) = &near.liquids else {
            return;
        };
        let (beyond, meetings) = (&self.beyond, &self.rows);
        near.each_row(slope, |a, row, out| {
            *out = [0.0; 3];
            if near.role[a] != Role::Liquid {
                return;
            }
            let (own, meeting) = (liquids.share(a, a), &meetings[a]);
            let open = rows[a].open.map(|x| 2.0 * own * (total[a] - upon[a]) * x);
            let (mut sum, mut alike) = (along(open, 1.0, meeting.pull), [0.0; 3]);
            for (b, slope) in row.slopes() {
                let x = difference(near.position[a], near.position[b]);
                if near.role[b].flows() && !liquids.alike(a, b) {
                    let part = slope * liquids.share(a, b);
                    sum = along(sum, part * (total[b] - total[a]), x);
                    continue;
                }
                let walls = liquids.is_slag(a) && !near.role[b].flows();
                let p = if walls { beyond[b] } else { total[b] };
                let part = slope * own * (p - total[a]);
                sum = along(sum, part, x);
                alike = along(alike, part, x);
            }
            *out = meeting.blend(times(rows[a].inverse, sum), times(meeting.own, alike));
        });
    }

    /// The operators of the divergence, of the sums `rows`.
    pub(super) fn take_sides(&mut self, rows: &[Sums]) {
        let meetings = self.rows.iter().zip(rows);
        self.sides.clear();
        self.sides.extend(meetings.map(|(meeting, row)| {
            Sides::of(row.present, meeting.own, meeting.normal, meeting.trust)
        }));
    }

    /// The divergence of the velocity `u` beside the interface, along which both liquids may slip.
    pub(super) fn slip(&self, near: &Near, u: &[[f64; 3]], rows: &mut [Sums]) {
        if let Some(liquids) = &near.liquids {
            let beside = |a: usize| self.beside(a);
            slip::divergence(near, liquids, &self.sides, u, beside, rows);
        }
    }

    /// -D^T rho D u of the velocity `u` of particles and images, over the density of the metal; D counts where `counts` says.
    pub(super) fn damp(
        &mut self,
        near: &Near,
        u: &[[f64; 3]],
        counts: impl Fn(usize) -> bool + Sync,
        change: &mut Vec<[f64; 3]>,
    ) {
        if let Some(liquids) = &near.liquids {
            let mut stretched = std::mem::take(&mut self.stretched);
            stretched.resize(near.len(), Sides::default());
            let weight = |a: usize| self.lightest(near, a);
            let weight = |a: usize| if counts(a) { weight(a) } else { 0.0 };
            slip::stretch(near, liquids, &self.sides, u, weight, &mut stretched);
            slip::relax(near, liquids, &stretched, change);
            self.stretched = stretched;
        }
    }

    /// Whether `a` lies beside the other liquid.
    #[inline]
    pub(super) fn beside(&self, a: usize) -> bool {
        self.rows.get(a).is_some_and(|meeting| meeting.trust > 0.0)
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Meeting>() * self.rows.capacity()
            + size_of::<Sides>() * (self.sides.capacity() + self.stretched.capacity())
            + 32 * self.middles.capacity()
            + 8 * (self.beyond.capacity() + self.kappa.capacity())
            + self.side.capacity()
            + self
                .curvature
                .as_ref()
                .map_or(0, |curvature| curvature.bytes())
    }
}

/// 1, -1, or 0 of nothing.
fn signum(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// Halfway between two particles.
#[inline]
fn middle(near: &Near, a: usize, b: usize) -> [f64; 3] {
    let (x, y) = (near.position[a], near.position[b]);
    std::array::from_fn(|k| 0.5 * (x[k] + y[k]))
}
