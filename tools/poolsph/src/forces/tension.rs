//! Surface tension as cohesion between particles, smoothed (Komen 2019, eqs 4.1, 4.2 and 4.8).
//!
//! ```text
//! F_ab = c gamma h f(|x_ab|/h) e_ab      f(q) = q (q < 1),  2 - q (q < 2),  0
//! ```
//!
//! towards the neighbour; e_ab stands where print has none. Inside the metal the pulls cancel. At
//! a free surface they leave an inward force, whose moment over the depth is the tension, and a
//! constant cohesive pressure, which holds the liquid together where the flow would tear it. Solid
//! metal pulls like liquid, so its own liquid wets it.
//!
//! Print smooths the force by three kernel means, which lose momentum at a surface. Here a mean is
//! an exchange between pairs, `chi_a += V_0 sum_b W_ab (chi_b - chi_a)`: the same inside, and the
//! sum over all particles is kept. Without it single pulls lock the particles in place like
//! grains, and a drop behaves as if its tension were a tenth.
//!
//! With S for one exchange, print has S^3; here it is S^3 (2 - S), which takes as much from single particles
//! and less from what is wide. Each exchange moves the tension deeper below the surface, by about d/2 for
//! S^3: a hollow of radius R pulls as one of R + d/2. Of 2 gamma/R a continuum has with S^3, in hollows of 2, 3, 4 and 6 d, 79, 85,
//! 90 and 94 %, with S^3 (2 - S) 86, 91, 94 and 97 %; in a ball of 3 d 78 and 105 %, in larger ones 4 to 8 and 5 to 15 % more.
//!
//! The exchange spreads the pull over more depth, so that the tension grows by a factor
//! (`GAIN`) while the cohesive pressure stays. c follows from the continuum limit
//! ([`mean_field`], 1.232 for h = d; print: 1.2) and this factor.

use particles::Matter;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use neighbours::ROWS;
use shapes::frame::{along, difference, dot, squared};
use steps::Limit;

use crate::faces::Turn;
use crate::motion::lattice::Lattice;
use crate::near::{Near, Role};
use crate::stage::{Stage, StageError};
use crate::state::State;

/// Kernel means of the force (Komen 2019, section 4.2.1).
const SMOOTHINGS: u32 = 3;

/// Tension in drops over that of the continuum limit: the mechanical pressure inside of shaken drops, times R/2;
/// mean of 9 drops of 9 to 14 particle diameters radius, with mu/sqrt(rho gamma R) from 0.0004 to 0.009.
/// At a flat face of a continuum it is 2.05.
const GAIN: f64 = 1.97;

/// The surface tension.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// gamma \[N/m\].
    #[schemars(range(min = 0.0), extend("x-unit" = "N/m"))]
    pub surface_tension_n_m: f64,
}

/// The stage that pulls the surface together.
pub struct Tension {
    /// c gamma \[N/m\].
    strength: f64,
    /// 1 / lattice number \[m3\].
    exchange: f64,
    /// Longest step \[s\].
    limit: f64,
    /// Pull \[N\], zero for solid particles; the fourth place pads.
    pull: Vec<[f64; 4]>,
    smooth: Vec<[f64; 4]>,
    /// Sum of the pulls that went into the exchanges; the last counts backwards.
    total: Vec<[f64; 4]>,
    /// Part of its pull that a particle keeps in an exchange.
    kept: Vec<f64>,
}

/// c of the continuum without smoothing: gamma = pi n^2/8 int F r^4 dr for a pair force F and
/// number density n (Kirkwood and Buff 1949, without correlation); 1.232 (d/h)^6.
#[must_use]
pub fn mean_field(metal: Matter) -> f64 {
    // int f q^4 dq = 1/6 from 0 to 1, 2 (2^5 - 1)/5 - (2^6 - 1)/6 from 1 to 2.
    let integral = 1.0 / 6.0 + 62.0 / 5.0 - 63.0 / 6.0;
    let ratio = metal.spacing / metal.smoothing_length;
    8.0 / (std::f64::consts::PI * integral) * ratio.powi(6)
}

impl Tension {
    /// The tension of `metal`.
    #[must_use]
    pub fn new(parameters: Parameters, metal: Matter) -> Self {
        let gamma = parameters.surface_tension_n_m;
        Self {
            strength: mean_field(metal) * gamma / GAIN,
            exchange: 1.0 / Lattice::of(metal).number,
            limit: (metal.mass() / (2.0 * std::f64::consts::PI * gamma)).sqrt(),
            pull: Vec::new(),
            smooth: Vec::new(),
            total: Vec::new(),
            kept: Vec::new(),
        }
    }

    /// Pull on each liquid particle \[N\] and its share of the mechanical pressure; what a
    /// particle keeps in an exchange.
    fn pull(&mut self, near: &mut Near, metal: Matter) {
        let (h, strength, exchange) = (metal.smoothing_length, self.strength, self.exchange);
        let share = 1.0 / (6.0 * metal.volume());
        let (position, role) = (&near.position, &near.role);
        self.pull.resize(near.len(), [0.0; 4]);
        self.kept.resize(near.len(), 0.0);
        self.pull
            .par_chunks_mut(ROWS)
            .zip(self.kept.par_chunks_mut(ROWS))
            .zip(near.virial.par_chunks_mut(ROWS))
            .zip(near.lists.chunks())
            .zip(&near.pairs)
            .for_each(|((((pull, kept), virial), chunk), pairs)| {
                for (k, ((pull, kept), virial)) in pull.iter_mut().zip(kept).zip(virial).enumerate()
                {
                    (*pull, *kept) = ([0.0; 4], 1.0);
                    let a = chunk.first() + k;
                    if role[a] != Role::Liquid {
                        continue;
                    }
                    let (mut sum, mut stretched, mut given) = ([0.0; 3], 0.0, 0.0);
                    for (&b, &w) in chunk.row(k).iter().zip(&pairs.value[chunk.range(k)]) {
                        let dx = difference(position[b as usize], position[a]);
                        let square = squared(dx);
                        let q = square.sqrt() / h;
                        // f(q)/q, times c gamma: the force over the distance.
                        let stiffness = strength * ((2.0 - q).max(0.0) / q).min(1.0);
                        sum = along(sum, stiffness, dx);
                        stretched += stiffness * square;
                        given += f64::from(u8::from(role[b as usize].flows())) * w;
                    }
                    *pull = [sum[0], sum[1], sum[2], 0.0];
                    *kept = 1.0 - exchange * given;
                    *virial -= share * stretched;
                }
            });
        near.complete(&mut self.pull, turned);
    }

    /// One exchange of the pull between liquid neighbours (eq. 4.8). The pull of solid ones is
    /// zero, so that the sum may run over all.
    fn smooth(&mut self, near: &Near) {
        let (pull, kept, role) = (&self.pull, &self.kept, &near.role);
        let exchange = self.exchange;
        self.smooth.resize(near.len(), [0.0; 4]);
        near.each_row(&mut self.smooth, |a, row, out| {
            *out = [0.0; 4];
            if role[a] == Role::Liquid {
                let sum = row.values().fold([0.0; 4], |sum, (b, w)| {
                    let other = pull[b];
                    std::array::from_fn(|i| sum[i] + w * other[i])
                });
                let own = pull[a];
                *out = std::array::from_fn(|i| kept[a] * own[i] + exchange * sum[i]);
            }
        });
        near.complete(&mut self.smooth, turned);
        std::mem::swap(&mut self.pull, &mut self.smooth);
    }

    /// Share of the exchanged forces in the mechanical pressure. They are linear in the pull, so
    /// that those of all exchanges are those of the sum of the pulls.
    fn strain(&self, near: &mut Near, metal: Matter) {
        let share = self.exchange / (6.0 * metal.volume());
        let total = &self.total;
        near.each_virial(|near, a, row, virial| {
            if near.role[a] == Role::Liquid {
                let liquid = row.values().filter(|(b, _)| near.role[*b].flows());
                let sum = liquid.fold(0.0, |sum, (b, w)| {
                    let force = difference(three(total[b]), three(total[a]));
                    sum + w * dot(force, difference(near.position[a], near.position[b]))
                });
                *virial += share * sum;
            }
        });
    }
}

/// Adds `part` of each pull to the total of what went into the exchanges.
fn gather(total: &mut [[f64; 4]], part: f64, pull: &[[f64; 4]]) {
    for (total, pull) in total.iter_mut().zip(pull) {
        *total = std::array::from_fn(|i| total[i] + part * pull[i]);
    }
}

/// The pull on an image.
fn turned([x, y, z, pad]: [f64; 4], _: usize, turn: &Turn) -> [f64; 4] {
    let [x, y, z] = turn.vector([x, y, z]);
    [x, y, z, pad]
}

fn three([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

impl Stage for Tension {
    fn name(&self) -> &'static str {
        "tension"
    }

    fn limit(&self, _: &State) -> Option<Limit> {
        // The pull of the begin of a step acts until its end: no part of it is taken anew.
        Some(Limit::refusing("capillary", self.limit))
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let metal = state.metal.matter;
        let near = &mut state.near;
        self.pull(near, metal);
        self.total.clear();
        self.total.resize(self.pull.len(), [0.0; 4]);
        for _ in 0..SMOOTHINGS {
            gather(&mut self.total, 1.0, &self.pull);
            self.smooth(near);
        }
        // S^3 (2 - S) = S^3 + (S^3 - S^4): what one more exchange takes is given back.
        gather(&mut self.total, -1.0, &self.pull);
        self.smooth(near);
        self.strain(near, metal);
        let volume = metal.volume();
        // After the swap `smooth` holds what the last exchange began with.
        for ((force, thrice), further) in near.force.iter_mut().zip(&self.smooth).zip(&self.pull) {
            let pull = std::array::from_fn(|i| 2.0 * thrice[i] - further[i]);
            *force = along(*force, 1.0 / volume, pull);
        }
        Ok(())
    }

    fn bytes(&self) -> usize {
        32 * (self.pull.capacity() + self.smooth.capacity() + self.total.capacity())
            + 8 * self.kept.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::{Particle, phase};

    const METAL: Matter = Matter {
        density: 7850.0,
        spacing: 0.5e-3,
        smoothing_length: 0.5e-3,
    };

    /// Cells of a box of 12 x 12 x 16; solid below `floor` layers. `shake` moves them by parts of d.
    fn pool(floor: i32, shake: f64) -> State {
        let mut state = State::new(METAL);
        state.flowing = true;
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for cell in 0..12 * 12 * 16 {
            let (i, j, k) = (cell % 12, cell / 12 % 12, cell / 144);
            let at = [i, j, k].map(|i| METAL.spacing * (f64::from(i) + shake * random()));
            state.push(Particle {
                position: at,
                velocity: [0.0; 3],
                phase: if k < floor {
                    phase::SOLID
                } else {
                    phase::LIQUID
                },
                droplet: false,
                wall: false,
                temperature: 0.0,
                enthalpy: 0.0,
            });
        }
        state.gather();
        let mut tension = Tension::new(
            Parameters {
                surface_tension_n_m: 1.0,
            },
            METAL,
        );
        tension.advance(&mut state, 1e-4).unwrap();
        state
    }

    #[test]
    fn printed_coefficient_is_that_of_the_continuum() {
        assert!((mean_field(METAL) - 1.232).abs() < 1e-3);
    }

    #[test]
    fn forces_within_the_liquid_add_up_to_nothing() {
        let state = pool(0, 0.3);
        let mut sum = [0.0; 3];
        let mut size = 0.0;
        for force in &state.near.force {
            sum = along(sum, 1.0, *force);
            size += squared(*force).sqrt();
        }
        assert!(squared(sum).sqrt() < 1e-12 * size, "{sum:?} of {size}");
    }

    #[test]
    fn its_own_solid_wets() {
        // Pull in a column through the middle: none at the foot, inwards at the free top, and
        // over all depth the cohesive pressure.
        let state = pool(4, 0.0);
        let near = &state.near;
        let middle = |a: &usize| {
            let place = near.position[*a];
            (0..2).all(|axis| (place[axis] / METAL.spacing - 6.0).abs() < 0.5)
        };
        let column: Vec<usize> = (0..near.len()).filter(middle).collect();
        let force = |layer: f64| {
            let at = |a: &&usize| (near.position[**a][2] / METAL.spacing - layer).abs() < 0.5;
            near.force[*column.iter().find(at).unwrap()][2]
        };
        assert!(force(4.0).abs() < 1e-9 * force(15.0).abs());
        assert!(force(15.0) < 0.0 && force(14.0) < 0.0);
        let pressure: f64 = column.iter().map(|a| near.force[*a][2]).sum::<f64>() * -METAL.spacing;
        // Half the sum over the pairs of F z^2/r per volume, on the lattice.
        let (mut exact, c) = (0.0, mean_field(METAL) / GAIN);
        for cell in 0..343 {
            let [x, y, z] = [cell % 7, cell / 7 % 7, cell / 49].map(|i| f64::from(i - 3));
            let q = (x * x + y * y + z * z).sqrt();
            let tent = if q < 1.0 { q } else { (2.0 - q).max(0.0) };
            exact += 0.5 * c * tent * z * z / q.max(1.0) / METAL.spacing;
        }
        assert!(
            (pressure - exact).abs() < 1e-9 * exact,
            "{pressure} {exact}"
        );
    }
}
