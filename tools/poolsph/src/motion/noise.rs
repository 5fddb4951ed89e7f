//! Damping of motion that the particles cannot resolve.
//!
//! Weight packs the particles below a free surface closer than the lattice: until the surface layer
//! is as dense as the inside, now and then one slips into a gap, and each slip sets free more energy
//! than a pool at rest may have (a fall of d/5 in a pool of 216 particles: 2 % of sqrt(g H)). The
//! viscosity of metal damps such motion within seconds only. With the difference to the neighbourhood
//! as operator,
//!
//! ```text
//! (L u)_a = nu sum_b W_ab (u_a - u_b)        d u/dt = -sqrt(g/d) L L u
//! ```
//!
//! the shortest waves decay as fast as a particle falls by its own diameter, and those of many
//! spacings hardly: a wave k has L = 0.14 (k d)^2 for h = d, so that the rate goes with (k d)^4. L is
//! symmetric: momentum is kept, and energy can only fall. Without gravity nothing is packed and nothing
//! damped. What viscosity takes back ([`Viscosity::spared`]) is of the same form and goes the same way.

use particles::Matter;
use rayon::prelude::*;
use shapes::frame::along;

use super::around::Around;
use super::lattice::Lattice;
use super::viscosity::Viscosity;
use crate::near::Near;
use crate::sweep::GRAIN;

/// Largest part of a mode that a step may take.
const PART: f64 = 0.5;

/// The damping, with its scratch, in the order of [`Near`].
#[derive(Debug, Clone)]
pub struct Noise {
    /// sqrt(g/d) \[1/s\].
    rate: f64,
    /// nu \[m3\].
    volume: f64,
    first: Vec<[f64; 3]>,
}

impl Noise {
    /// The damping for particles of `metal` under `gravity` \[m/s2\].
    #[must_use]
    pub fn new(gravity: f64, metal: Matter) -> Self {
        Self {
            rate: (gravity / metal.spacing).sqrt(),
            volume: 1.0 / Lattice::of(metal).number,
            first: Vec::new(),
        }
    }

    /// True if there is anything to damp.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.rate > 0.0
    }

    /// Adds to `predicted` what `near.velocity` loses in `dt` \[s\], and what `viscosity` gives back of what it
    /// took; `around` holds the sums of this velocity, and then those of L u with the rates of both.
    pub fn damp(
        &mut self,
        near: &Near,
        around: &mut Around,
        viscosity: &Viscosity,
        dt: f64,
        predicted: &mut [[f64; 3]],
    ) {
        let (lost, volume) = ((self.rate * dt).min(PART), self.volume);
        self.first.clear();
        self.first.resize(near.len(), [0.0; 3]);
        let rows = self.first.par_iter_mut().zip(&around.sums).enumerate();
        rows.with_min_len(GRAIN).for_each(|(a, (first, sum))| {
            let part = dt * viscosity.spared(near, sum[3], a) - lost;
            *first = difference(&near.velocity[a], sum, part * volume);
        });
        near.complete(&mut self.first, |u, _, turn| turn.difference(u));
        around.sum(near, &self.first);
        let rows = predicted.par_iter_mut().zip(&self.first).zip(&around.sums);
        rows.with_min_len(GRAIN).for_each(|((out, own), sum)| {
            *out = along(*out, 1.0, difference(own, sum, volume));
        });
    }

    /// Bytes held.
    #[must_use]
    pub fn bytes(&self) -> usize {
        24 * self.first.capacity()
    }
}

/// `scale` times the sum of W (u_a - u_b) over liquid neighbours, from the `sum` of W u_b and W.
#[inline]
fn difference(own: &[f64; 3], sum: &[f64; 4], scale: f64) -> [f64; 3] {
    std::array::from_fn(|i| scale * (sum[3] * own[i] - sum[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Law;
    use crate::state::{Particle, State, phase};

    const METAL: Matter = Matter {
        density: 7850.0,
        spacing: 0.5e-3,
        smoothing_length: 0.5e-3,
    };

    /// What a block of 10 cells along each edge that moves as `velocity` says loses in 1 s.
    fn lost(velocity: impl Fn([i32; 3]) -> f64) -> (Near, Vec<[f64; 3]>) {
        let mut state = State::new(METAL);
        state.flowing = true;
        for cell in 0..1000 {
            let index = [cell % 10, cell / 10 % 10, cell / 100];
            state.push(Particle {
                position: index.map(|i| METAL.spacing * (f64::from(i) + 0.5)),
                velocity: [velocity(index), 0.0, 0.0],
                phase: phase::LIQUID,
                droplet: false,
                wall: false,
                temperature: 0.0,
                enthalpy: 0.0,
            });
        }
        state.gather();
        let mut noise = Noise::new(9.8, METAL);
        noise.rate *= 1e-6;
        let mut change = vec![[0.0; 3]; state.near.len()];
        let mut around = Around::default();
        around.sum(&state.near, &state.near.velocity);
        let none = Viscosity::new(Law::Uniform(0.0), METAL);
        noise.damp(&state.near, &mut around, &none, 1.0, &mut change);
        for x in change.iter_mut().flatten() {
            *x *= 1e6;
        }
        (state.near, change)
    }

    fn middle(near: &Near, a: usize) -> bool {
        let inner = |x: f64| (x / METAL.spacing - 5.0).abs() < 1.0;
        near.position[a].iter().all(|x| inner(*x))
    }

    #[test]
    fn the_shortest_wave_decays_as_a_particle_falls() {
        let sign = |i: i32| if i % 2 == 0 { 1.0 } else { -1.0 };
        let (near, change) = lost(|[i, j, k]| sign(i) * sign(j) * sign(k));
        // The sum of the lattice for this wave, by the values of W at 1, sqrt 2 and sqrt 3.
        let w = |r: f64| near.kernel.value(r * METAL.spacing);
        let (edge, face, room) = (6.0 * w(1.0), 12.0 * w(2_f64.sqrt()), 8.0 * w(3_f64.sqrt()));
        let number = w(0.0) + edge + face + room;
        let rate = (9.8 / METAL.spacing).sqrt() * (2.0 * (edge + room) / number).powi(2);
        let mut seen = 0;
        for a in (0..near.len()).filter(|a| middle(&near, *a)) {
            assert!((change[a][0] / near.velocity[a][0] + rate).abs() < 1e-6 * rate);
            seen += 1;
        }
        assert_eq!(seen, 8);
    }

    #[test]
    fn flow_that_is_resolved_does_not_feel_it() {
        // A parabola has a constant L u, and L of that is zero.
        let (near, change) = lost(|[_, _, k]| f64::from(k * k));
        for a in (0..near.len()).filter(|a| middle(&near, *a)) {
            assert!(change[a][0].abs() < 1e-9, "{:?}", change[a]);
        }
    }

    #[test]
    fn momentum_stays_and_energy_falls() {
        let (near, change) = lost(|[i, j, k]| f64::from((7 * i + 5 * j * k) % 11) - 3.0);
        let sum: f64 = change.iter().map(|u| u[0]).sum();
        let size: f64 = change.iter().map(|u| u[0].abs()).sum();
        assert!(sum.abs() < 1e-12 * size, "{sum} of {size}");
        let power: f64 = change
            .iter()
            .zip(&near.velocity)
            .map(|(c, u)| c[0] * u[0])
            .sum();
        assert!(power < 0.0, "{power}");
    }
}
