//! A small pool for the tests of forces.

use particles::{Matter, POSITION};

use crate::patch::{self, AREA, DEPTH, NORMAL, Patch, Patches};
use crate::source::Place;
use crate::state::{Particle, State, TEMPERATURE, phase};

/// A pool of 10 x 10 x 5 particles on a solid floor, gathered; its top face is z = 0 and the arc
/// stands over its middle.
pub(crate) fn pool(temperature: impl Fn([f64; 3]) -> f64) -> State {
    let d = 5e-4;
    let metal = Matter {
        density: 7850.0,
        spacing: d,
        smoothing_length: d,
    };
    let mut state = State::new(metal);
    state.metal.declare(&TEMPERATURE);
    patch::declare(&mut state.metal);
    state.flowing = true;
    state.source = Some(Place {
        position: [0.0; 3],
        way: [0.0; 3],
        phase: 0.0,
        droplets: 0,
    });
    for k in 0..8 {
        for j in 0..10 {
            for i in 0..10 {
                let position = [i - 5, j - 5, k - 8].map(|c| (f64::from(c) + 0.5) * d);
                state.push(Particle {
                    position,
                    velocity: [0.0; 3],
                    phase: if k < 3 { phase::SOLID } else { phase::LIQUID },
                    droplet: false,
                    wall: false,
                    temperature: temperature(position),
                    enthalpy: 0.0,
                });
            }
        }
    }
    state.gather();
    state
}

/// Gives the particles of the top layer the area `each` \[m2\] and a normal upwards, half a spacing below the surface.
pub(crate) fn on_top(state: &mut State, each: f64) {
    let d = state.metal.matter.spacing;
    let columns = (&POSITION, &AREA, &NORMAL, &DEPTH);
    let (places, areas, normals, depths) = state.metal.columns_mut(columns);
    for a in (0..places.len()).filter(|a| places[*a][2] > -d) {
        (areas[a], normals[a], depths[a]) = (each, [0.0, 0.0, 1.0], 0.5 * d);
    }
}

/// Changes the patches of all particles.
pub(crate) fn change(state: &mut State, shape: impl Fn(&mut Patch)) {
    let mut patches: Vec<Patch> = Patches::of(&state.metal).iter().collect();
    patches.iter_mut().for_each(shape);
    patch::put(&mut state.metal, patches.into_iter().enumerate());
}
