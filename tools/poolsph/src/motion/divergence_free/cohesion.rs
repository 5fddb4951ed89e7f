//! Tension of what is too small to show a surface.
//!
//! A curvature needs some particles along the surface. A particle that leaves a pool, a drop of a few and the neck between
//! two have none to tell, and a pressure upon them holds nothing together: what a splash throws up would never come
//! back. There the pull of pairs stands for the tension (Komen 2019, eq. 4.1, with a distance at rest):
//!
//! ```text
//! F_ab = s_ab (c gamma d f(r/d) + D(r/d) sqrt(gamma m) (u_b - u_a).e) e
//! f(q) = (q - q_0)/(1 - q_0)  (q < 1),   2 - q  (q < 2)                   D(q) = D_0 min(1, 2 - q)
//! ```
//!
//! with the c of a continuum, so that to take a particle from a plane surface costs 4.9 gamma d^2, the energy of the
//! surface of a ball of its volume (4.8 gamma d^2); it needs 3.1 sqrt(gamma/(rho d)) to get away. The second part takes what
//! pairs swing against one another, below what particles resolve. s goes from nothing to one as
//! neighbours become few ([`FEW`]): a plane surface and a film of one layer have more. The edge of such a film, which has no
//! curvature either, is pulled by 1.13 times the 2 gamma per length of its two faces. Solid metal pulls as well.
//! Where a pair is too close, in a crowd as well, what it still approaches is damped alike, and its particles are moved
//! apart. Forces act along the line of a pair: momentum and angular momentum are kept.

use kernels::moments::within;
use particles::Matter;
use shapes::frame::{along, difference, dot, squared};

use super::filled::Filled;
use super::openness::lack;
use crate::forces::tension::mean_field;
use crate::near::{Near, Role};

/// Lack of neighbours, in parts of the lattice's, from which on pairs pull, and at which they do so wholly. A plane surface lacks 0.22,
/// a thread of two by two particles 0.41, a film of one layer 0.44, its edge and a thread of one by two 0.60, a row 0.77, a
/// particle on top of a plane surface 0.78.
const FEW: [f64; 2] = [0.45, 0.60];
/// q_0: distance at which a pair rests, in spacings.
const REST: f64 = 0.75;
/// D_0.
const DAMPED: f64 = 0.5;
/// Distances of a pair in spacings at which it is too close, and from which on it is not.
const CLOSE: [f64; 2] = [0.70, 0.80];
/// Part of what a pair is too close that a step takes.
const PARTED: f64 = 0.2;

/// What pairs change.
#[derive(Debug, Clone, Copy, Default)]
struct Change {
    /// Of the velocity \[m/s\].
    velocity: [f64; 3],
    /// Of the place \[m\].
    place: [f64; 3],
}

/// The pull of pairs with its scratch, `[m]` in the order of [`Near`].
#[derive(Debug, Clone)]
pub(super) struct Cohesion {
    /// c.
    strength: f64,
    /// Mass of a particle \[kg\].
    mass: f64,
    /// s of each particle.
    few: Vec<f64>,
    changes: Vec<Change>,
}

impl Cohesion {
    /// That of particles of `metal`.
    pub(super) fn new(metal: Matter) -> Self {
        Self {
            strength: mean_field(metal),
            mass: metal.mass(),
            few: Vec::new(),
            changes: Vec::new(),
        }
    }

    /// Adds what pairs change within `dt` \[s\] to `predicted`.
    pub(super) fn pull(
        &mut self,
        near: &Near,
        filled: Filled,
        dt: f64,
        predicted: &mut [[f64; 3]],
    ) {
        self.count(near, filled);
        let few = &self.few;
        let d = filled.spacing;
        let closest = (CLOSE[1] * d).powi(2);
        let strength = self.strength;
        let mass = |a: usize| self.mass * near.heaviness(a);
        self.changes.resize(near.len(), Change::default());
        near.each_row(&mut self.changes, |a, row, change| {
            *change = Change::default();
            if near.role[a] != Role::Liquid {
                return;
            }
            for b in row.index.iter().map(|b| *b as usize) {
                let of = near.images().original(b);
                let way = difference(near.position[b], near.position[a]);
                let (square, pulled) = (squared(way), few[a].max(few[of]));
                if (pulled <= 0.0 && square >= closest) || square <= 0.0 {
                    continue;
                }
                let flows = near.role[b].flows();
                let gamma = if flows {
                    0.5 * (near.tension[a] + near.tension[of])
                } else {
                    near.tension[a] * (1.0 - near.dry.get(of).copied().unwrap_or(0.0))
                };
                let far = square.sqrt();
                let apart = dot(difference(near.velocity[b], near.velocity[a]), way) / far;
                let q = far / d;
                let held = if apart < 0.0 {
                    pulled.max(1.0 - within(q, CLOSE))
                } else {
                    pulled
                };
                let both = if flows {
                    0.5 * (mass(a) + mass(of))
                } else {
                    mass(a)
                };
                let damping = DAMPED * (2.0 - q).clamp(0.0, 1.0) * (gamma * both).sqrt();
                let force = pulled * strength * gamma * d * pull(q) + held * damping * apart;
                change.velocity = along(change.velocity, dt / mass(a) * force / far, way);
                let overlap = PARTED * (CLOSE[0] * d - far).max(0.0);
                let theirs = if flows { 0.5 } else { 1.0 };
                change.place = along(change.place, -theirs * overlap / far, way);
            }
        });
        for (u, change) in predicted.iter_mut().zip(&self.changes) {
            *u = along(*u, 1.0, change.velocity);
        }
    }

    /// Moves particles apart that were too close when they were pulled.
    pub(super) fn part(&self, near: &mut Near) {
        for (x, change) in near.position.iter_mut().zip(&self.changes) {
            *x = along(*x, 1.0, change.place);
        }
    }

    /// Finds s.
    fn count(&mut self, near: &Near, filled: Filled) {
        let few = |a: usize| match near.role[a] {
            Role::Liquid => within(lack(near, filled, a), FEW),
            _ => 0.0,
        };
        self.few.clear();
        self.few.extend((0..near.len()).map(few));
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        (8 + size_of::<Change>()) * self.few.capacity()
    }
}

/// f at the distance `q` in spacings.
fn pull(q: f64) -> f64 {
    if q < 1.0 {
        (q - REST) / (1.0 - REST)
    } else {
        (2.0 - q).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tests::{METAL, block};
    use crate::state::{State, VELOCITY, phase};
    use particles::POSITION;
    use shapes::frame::cross;

    /// gamma [N/m] of a pool, and the step [s].
    const GAMMA: f64 = 1.3;
    const DT: f64 = 1e-5;

    /// What pairs change in the liquid cells of a box, each shifted and driven by random parts of d and of 1 m/s.
    fn changed(
        cells: [i32; 3],
        liquid: impl Fn([i32; 3]) -> bool,
        shaken: f64,
        driven: f64,
    ) -> (State, Vec<[f64; 3]>, Cohesion) {
        let mut seed = 3_u64;
        let mut random = |size: f64| {
            [0; 3].map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                size * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
            })
        };
        let phase = |cell| {
            if liquid(cell) {
                phase::LIQUID
            } else {
                phase::FLYING
            }
        };
        let mut state = block(cells, phase, |_| [0.0; 3]);
        let (places, velocities) = state.metal.columns_mut((&POSITION, &VELOCITY));
        for (x, u) in places.iter_mut().zip(velocities) {
            *x = along(*x, METAL.spacing, random(shaken));
            *u = random(driven);
        }
        state.gather();
        state.near.tension = vec![GAMMA; state.near.len()];
        let mut cohesion = Cohesion::new(METAL);
        let mut change = vec![[0.0; 3]; state.near.len()];
        cohesion.pull(&state.near, Filled::of(METAL), DT, &mut change);
        (state, change, cohesion)
    }

    #[test]
    fn what_shows_a_surface_is_left_as_it_is() {
        for cells in [[6, 6, 6], [8, 8, 2], [12, 12, 1]] {
            // But for the edges of films and the corners of a cube, where no curvature is resolved.
            let (state, change, _) = changed(cells, |_| true, 0.0, 0.0);
            let inside = |a: usize, i: usize, edge: f64| {
                let x = state.near.position[a][i] / METAL.spacing;
                x > edge && x < f64::from(cells[i]) - edge
            };
            let film = cells[2] < 6;
            let resolved = |a: &usize| match film {
                true => (0..2).all(|i| inside(*a, i, 2.6)),
                false => (0..3).any(|i| inside(*a, i, 2.6)),
            };
            let mut moved = (0..change.len()).filter(resolved);
            assert!(moved.all(|a| squared(change[a]) <= 0.0), "{cells:?}");
        }
    }

    #[test]
    fn the_edge_of_a_film_has_the_tension_of_both_its_faces() {
        // 2 gamma per length of edge (Taylor 1959, Culick 1960).
        let (state, change, _) = changed([12, 12, 1], |_| true, 0.0, 0.0);
        let d = METAL.spacing;
        let cell = |a: usize, i: usize| state.near.position[a][i] / d;
        let edge = |a: &usize| cell(*a, 0) < 1.0 && (4.0..8.0).contains(&cell(*a, 1));
        let edge: Vec<usize> = (0..change.len()).filter(edge).collect();
        assert_eq!(edge.len(), 4);
        for a in edge {
            let force = METAL.mass() / DT * change[a][0] / (2.0 * GAMMA * d);
            assert!((force - 1.0).abs() < 0.15, "{force}");
        }
    }

    #[test]
    fn a_splash_keeps_momentum_and_loses_energy() {
        let (state, change, mut cohesion) = changed(
            [5, 5, 5],
            |[i, j, k]| (i + 2 * j + 3 * k) % 5 == 0,
            0.9,
            1.0,
        );
        let near = &state.near;
        let size: f64 = change.iter().map(|u| squared(*u).sqrt()).sum();
        assert!(size > 0.0);
        let (mut sum, mut turned, mut parted) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for (a, change) in change.iter().enumerate() {
            sum = along(sum, 1.0, *change);
            turned = along(
                turned,
                1.0 / METAL.spacing,
                cross(near.position[a], *change),
            );
            parted = along(parted, 1.0 / METAL.spacing, cohesion.changes[a].place);
        }
        for x in sum.into_iter().chain(turned).chain(parted) {
            assert!(
                x.abs() < 1e-13 * size.max(1.0),
                "{sum:?} {turned:?} {parted:?}"
            );
        }
        // Pairs that rest against one another lose nothing; all others do.
        let work = |change: &[[f64; 3]]| {
            let work = change.iter().zip(&near.velocity);
            work.map(|(change, u)| dot(*change, *u)).sum::<f64>()
        };
        cohesion.strength = 0.0;
        let mut damped = vec![[0.0; 3]; near.len()];
        cohesion.pull(near, Filled::of(METAL), DT, &mut damped);
        assert!(work(&damped) < 0.0);
    }

    #[test]
    fn leaving_a_plane_costs_the_surface_of_a_ball() {
        // int F dr over the pairs of a particle of the outermost layer, which the particles of a plane lattice pull wholly.
        let d = METAL.spacing;
        let reach = || -2..=2;
        let mut cost = 0.0;
        for (i, j, k) in
            reach().flat_map(|i| reach().flat_map(move |j| (-2..=0).map(move |k| (i, j, k))))
        {
            let q = f64::from(i * i + j * j + k * k).sqrt();
            let parts = 1000;
            let width = (2.0 - q).max(0.0) / f64::from(parts);
            if q > 0.0 {
                let pulls = (0..parts).map(|p| pull(q + (f64::from(p) + 0.5) * width));
                cost += mean_field(METAL) * width * pulls.sum::<f64>();
            }
        }
        let volume = d.powi(3);
        let ball = (36.0 * std::f64::consts::PI).cbrt() * volume.powf(2.0 / 3.0) / (d * d);
        assert!((cost / ball - 1.0).abs() < 0.03, "{cost} {ball}");
    }
}
