//! Liquid that freezes where it touches cold metal, and no longer slides on it.
//!
//! Where a liquid of T_l meets a solid of T_s of the same metal, the contact takes at once the temperature
//!
//! ```text
//! T_c = (T_l + T_s)/2        (Carslaw and Jaeger 1959, section 2.15, with equal sqrt(k rho c) on both sides)
//! ```
//!
//! Below the melting point a skin freezes there from the first moment on, and what lies on it is arrested (Schiaffino and
//! Sonin 1997, for the edge of a drop that spreads). The skin of the first milliseconds is some tenths of a millimetre
//! thick, no more than a particle: so the particle that touches is held as a whole, and what comes after it flows over it.
//! Of the flow this takes at most one layer of particles, less as these become finer. What is held keeps its heat, and
//! flows again as soon as the metal beneath it is warm.
//!
//! Nor does such metal draw the edge of the liquid on: what of it is bare, beside what is touched, is dry, and is no metal to the
//! surface ([`crate::surface::curvature`]). The edge goes on only where it hangs over.

use particles::Set;
use shapes::frame::{difference, squared};

use crate::near::{Near, Role};
use crate::state::{ENTHALPY, TEMPERATURE, WALL, marked};

use super::caloric::Caloric;

/// Distance in spacings up to which particles touch: between the first and the second neighbours of a lattice.
const TOUCHING: f64 = 1.2;

/// Stefan numbers of a solid, what it lacks to melt over the latent heat, up to which its liquid wets it, and from which on it does not.
const DRY: [f64; 2] = [0.5, 1.0];

/// Which particles freeze on contact, with its scratch.
#[derive(Debug, Default)]
pub(super) struct Contact {
    /// Of each member of [`Near`].
    cold: Vec<bool>,
    /// Of each member that its liquid touches: how little it would wet it.
    chilled: Vec<f64>,
}

impl Contact {
    /// Looks at all molten particles among the members of `near`, and at the solid ones beside them.
    pub(super) fn look(&mut self, near: &mut Near, metal: &Set, caloric: &Caloric) {
        self.cold.clear();
        self.cold.resize(near.len(), false);
        let Some(point) = caloric.melting_point() else {
            return;
        };
        let (enthalpy, temperature) = (metal.column(&ENTHALPY), metal.column(&TEMPERATURE));
        let wall = metal.column(&WALL);
        let reach = (TOUCHING * metal.matter.spacing).powi(2);
        let molten = |id: usize| caloric.is_liquid(enthalpy[id]);
        near.each_row(&mut self.cold, |a, row, cold| {
            let id = near.id[a] as usize;
            if near.role[a] == Role::Backing || !molten(id) || marked(wall, id) {
                return;
            }
            let chills = |b: usize| {
                let other = near.id[b] as usize;
                let solid = !near.role[b].flows() && !marked(wall, other) && !molten(other);
                solid
                    && 0.5 * (temperature[id] + temperature[other]) < point
                    && squared(difference(near.position[a], near.position[b])) < reach
            };
            *cold = row.index.iter().any(|b| chills(*b as usize));
        });
        self.dry(near, metal, caloric);
    }

    /// Finds how little each solid member of `near` is wetted: bare cold ones beside cold ones that are touched.
    fn dry(&mut self, near: &mut Near, metal: &Set, caloric: &Caloric) {
        let (enthalpy, wall) = (metal.column(&ENTHALPY), metal.column(&WALL));
        let reach = (TOUCHING * metal.matter.spacing).powi(2);
        let molten = |b: &u32| caloric.is_liquid(enthalpy[near.id[*b as usize] as usize]);
        self.chilled.clear();
        self.chilled.resize(near.len(), 0.0);
        near.each_row(&mut self.chilled, |a, row, chilled| {
            let id = near.id[a] as usize;
            let touched = |b: &u32| {
                let apart = difference(near.position[a], near.position[*b as usize]);
                molten(b) && squared(apart) < reach
            };
            if !marked(wall, id) && row.index.iter().any(touched) {
                *chilled = within(caloric.stefan(enthalpy[id]));
            }
        });
        let chilled = &self.chilled;
        let mut dry = std::mem::take(&mut near.dry);
        dry.resize(near.len(), 0.0);
        near.each_row(&mut dry, |a, row, dry| {
            let id = near.id[a] as usize;
            let own = within(caloric.stefan(enthalpy[id]));
            let beside = |b: &u32| chilled[near.images().original(*b as usize)] > 0.0;
            let bare = chilled[a] <= 0.0 && !marked(wall, id);
            *dry = if bare && row.index.iter().any(beside) {
                own
            } else {
                0.0
            };
        });
        near.dry = dry;
    }

    /// Whether the particle `id` freezes to what it touches.
    pub(super) fn holds(&self, near: &Near, id: usize) -> bool {
        near.member(id).is_some_and(|a| self.cold[a])
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.cold.capacity() + 8 * self.chilled.capacity()
    }
}

/// How little metal of this Stefan number is wetted.
fn within(stefan: f64) -> f64 {
    let [from, to] = DRY;
    ((stefan - from) / (to - from)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use particles::Matter;

    use super::*;
    use crate::heat::Phase;
    use crate::heat::caloric::tests::steel;
    use crate::stage::Stage;
    use crate::state::{PHASE, Particle, State, VELOCITY, phase};

    const METAL: Matter = Matter {
        density: 7850.0,
        spacing: 1e-3,
        smoothing_length: 1e-3,
    };
    /// Cells of the plate along x and y, of three layers beneath z = 0.
    const PLATE: i32 = 8;

    /// A layer of liquid two particles thick that slides on the middle of a plate, each of its temperature \[K\].
    fn sliding(liquid: f64, plate: f64, sticks: bool) -> (State, Phase) {
        let caloric = Arc::new(steel());
        let mut phase = Phase::new(caloric.clone(), None);
        if sticks {
            phase = phase.sticking();
        }
        let mut state = State::new(METAL);
        phase.declare(&mut state);
        state.flowing = true;
        let mut put = |[i, j, k]: [i32; 3], moves: bool| {
            let temperature = if moves { liquid } else { plate };
            let moving = if moves { phase::LIQUID } else { phase::SOLID };
            state.push(Particle {
                position: [i, j, k].map(|i| (f64::from(i) + 0.5) * METAL.spacing),
                velocity: [if moves { 0.3 } else { 0.0 }, 0.0, 0.0],
                phase: moving,
                droplet: false,
                wall: false,
                temperature,
                enthalpy: caloric.enthalpy(temperature),
            });
        };
        for cell in 0..3 * PLATE * PLATE {
            put(
                [cell % PLATE, cell / PLATE % PLATE, -1 - cell / PLATE.pow(2)],
                false,
            );
        }
        for cell in 0..2 * 16 {
            put([2 + cell % 4, 2 + cell / 4 % 4, cell / 16], true);
        }
        state.gather();
        (state, phase)
    }

    /// Numbers of moving and of held particles after a step; what rests has no speed.
    fn stepped(state: &mut State, phase: &mut Phase) -> [usize; 2] {
        state.gather();
        phase.advance(state, 1e-4).unwrap();
        let phases = state.metal.column(&PHASE);
        let speeds = state.metal.column(&VELOCITY);
        let rests = |a: usize| {
            !matches!(phases[a], phase::SOLID | phase::HELD) || squared(speeds[a]) <= 0.0
        };
        assert!((0..state.len()).all(rests));
        [phase::LIQUID, phase::HELD].map(|of| phases.iter().filter(|p| **p == of).count())
    }

    #[test]
    fn the_lowest_layer_of_a_liquid_is_held_on_cold_metal() {
        let (mut state, mut phase) = sliding(2100.0, 300.0, true);
        assert_eq!(stepped(&mut state, &mut phase), [16, 16]);
        assert_eq!(stepped(&mut state, &mut phase), [16, 16]);
        let figures = phase.figures();
        assert_eq!(figures[1].name, "held_particles");
        assert!((figures[1].value - 16.0).abs() < 0.5);
    }

    #[test]
    fn a_contact_at_the_melting_point_decides() {
        let point = steel().melting_point().unwrap();
        for (plate, held) in [(point - 400.0, 16), (point - 200.0, 0)] {
            let (mut state, mut phase) = sliding(point + 300.0, plate, true);
            assert_eq!(stepped(&mut state, &mut phase), [32 - held, held]);
        }
    }

    #[test]
    fn bare_cold_metal_beside_liquid_is_dry() {
        let lacks = |kelvin: f64| {
            let (mut state, mut phase) = sliding(2100.0, kelvin, true);
            stepped(&mut state, &mut phase);
            let near = &state.near;
            // Of the upper layer of the plate: beneath the liquid, and one and three cells beside it.
            [4.5, 1.5, 7.5].map(|x| {
                let at = |a: &usize| {
                    let [p, q, r] = near.position[*a].map(|x| x / METAL.spacing);
                    (p - x).abs() < 0.1 && (q - 2.5).abs() < 0.1 && (r + 0.5).abs() < 0.1
                };
                (0..near.len()).find(at).map(|a| near.dry[a])
            })
        };
        let caloric = steel();
        for kelvin in [300.0, 1500.0, 1700.0] {
            let stefan = caloric.stefan(caloric.enthalpy(kelvin));
            let exact = ((stefan - 0.5) / 0.5).clamp(0.0, 1.0);
            let [beneath, beside, farther] = lacks(kelvin);
            assert_eq!(beneath, Some(0.0));
            assert!(
                (beside.unwrap() - exact).abs() < 1e-12,
                "{beside:?} {exact}"
            );
            assert!(farther.unwrap_or(0.0) <= 0.0);
        }
    }

    #[test]
    fn what_is_held_flows_again_when_the_metal_beneath_is_warm() {
        let (mut state, mut phase) = sliding(2100.0, 300.0, true);
        stepped(&mut state, &mut phase);
        let caloric = steel();
        let plate = 3 * (PLATE * PLATE) as usize;
        state.metal.column_mut(&TEMPERATURE)[..plate].fill(1700.0);
        state.metal.column_mut(&ENTHALPY)[..plate].fill(caloric.enthalpy(1700.0));
        assert_eq!(stepped(&mut state, &mut phase), [32, 0]);
    }

    #[test]
    fn what_is_held_is_looked_at_where_nothing_flows_any_more() {
        let (mut state, mut phase) = sliding(2100.0, 300.0, true);
        let plate = 3 * (PLATE * PLATE) as usize;
        // The upper layer is gone.
        state.metal.column_mut(&PHASE)[plate + 16..].fill(phase::FLYING);
        assert_eq!(stepped(&mut state, &mut phase), [0, 16]);
        let caloric = steel();
        state.metal.column_mut(&TEMPERATURE)[..plate].fill(1700.0);
        state.metal.column_mut(&ENTHALPY)[..plate].fill(caloric.enthalpy(1700.0));
        assert_eq!(stepped(&mut state, &mut phase), [16, 0]);
    }

    #[test]
    fn liquid_slides_unless_the_scene_says_otherwise() {
        let (mut state, mut phase) = sliding(2100.0, 300.0, false);
        assert_eq!(stepped(&mut state, &mut phase), [32, 0]);
        assert_eq!(phase.figures().len(), 1);
        assert_eq!(phase.bytes(), 0);
    }
}
