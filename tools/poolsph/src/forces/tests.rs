//! A small pool for the tests of forces.

use crate::source::Place;
use crate::state::{Column, Metal, Particle, Phase, State};

/// A pool of 10 x 10 x 5 particles on a solid floor, gathered; its top face is z = 0 and the arc
/// stands over its middle.
pub(crate) fn pool(temperature: impl Fn([f64; 3]) -> f64) -> State {
    let d = 5e-4;
    let metal = Metal {
        density: 7850.0,
        spacing: d,
        smoothing_length: d,
    };
    let mut state = State::new(metal, vec![Column::Temperature, Column::Surface]);
    state.flowing = true;
    state.source = Some(Place {
        position: [0.0; 3],
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
                    phase: if k < 3 { Phase::Solid } else { Phase::Liquid },
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
    for a in 0..state.len() {
        if state.position[a][2] > -state.metal.spacing {
            state.surface[a].area = each;
            state.surface[a].normal = [0.0, 0.0, 1.0];
            state.surface[a].depth = 0.5 * state.metal.spacing;
        }
    }
}
