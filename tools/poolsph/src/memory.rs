//! Memory that a run takes beyond the columns of its particles at the start, told before it.
//!
//! Bytes of a particle were measured on half a million of them, with 2h of one to 1.6 spacings: lists of neighbours grow with the
//! neighbours within 2h, `n = 4/3 pi (2h/d)^3`.

use std::f64::consts::PI;

use crate::motion::Method;
use crate::scene::Scene;
use crate::state::State;

/// Neighbours and what stages read of them: bytes of a particle, and of each neighbour.
const NEAR: [f64; 2] = [170.0, 30.0];
/// What two liquids need beside one: bytes of a liquid particle, measured on 110,592 of them with tension between both.
const BOTH: f64 = 640.0;
/// Links of conduction: bytes of a neighbour.
const LINKS: f64 = 24.0;
/// Cells, the frame that is written and what else each particle needs.
const OTHER: f64 = 300.0;
/// Contacts of each grain, their lists and their scratch: measured on 3.5e6 grains of a lattice on which they touch.
const CONTACTS: f64 = 900.0;

/// Bytes at work for each particle of a flow.
fn motion(method: Method) -> f64 {
    match method {
        Method::Projection => 290.0,
        Method::DivergenceFree => 615.0,
        Method::Homogenising => 190.0,
    }
}

/// Particles that wires bring until the end, at most.
#[must_use]
pub fn fed(scene: &Scene) -> f64 {
    let end = scene.time.end_s;
    let born = scene.wires().map(|wire| {
        let period = scene.droplet_period(&wire).unwrap_or(end).max(scene.step());
        let across = wire.droplets.radius_m / scene.metal().spacing;
        4.0 / 3.0 * PI * across.powi(3) * ((end / period).floor() + 1.0)
    });
    born.sum()
}

/// Names and bytes of what a run takes beyond the columns of `state`.
#[must_use]
pub fn beyond(scene: &Scene, state: &State) -> Vec<(&'static str, u64)> {
    let mut parts = of_metal(scene, state);
    let grains = state.grains.as_ref().map_or(0, |grains| grains.len());
    parts.push(("contacts", grains as f64 * CONTACTS));
    parts.retain(|(_, bytes)| *bytes >= 1.0);
    let whole = |(name, bytes)| (name, bytes as u64);
    parts.into_iter().map(whole).collect()
}

fn of_metal(scene: &Scene, state: &State) -> Vec<(&'static str, f64)> {
    if !scene.has_metal() {
        return Vec::new();
    }
    let (metal, fed) = (state.metal.matter, fed(scene));
    let number = state.len() as f64 + fed;
    // What melts later is not known: of metal that rests, its links alone are counted.
    let melts = scene
        .heat
        .as_ref()
        .is_some_and(|heat| heat.melting.is_some());
    let liquid = if melts {
        state.liquid() as f64 + fed
    } else {
        number
    };
    let neighbours = 4.0 / 3.0 * PI * (metal.support() / metal.spacing).powi(3);
    let own = state.metal.declared().map(|held| held.bytes() as f64);
    let mut parts = vec![(
        "droplets",
        fed * own.sum::<f64>() / (state.len() as f64).max(1.0),
    )];
    if let Some(flow) = &scene.flow {
        parts.push(("near", liquid * (NEAR[0] + NEAR[1] * neighbours)));
        parts.push(("motion", liquid * motion(flow.method)));
        if scene.slag.is_some() {
            parts.push(("slag", liquid * BOTH));
        }
    }
    if scene.heat.is_some() {
        let rests = if scene.flow.is_some() {
            number - liquid
        } else {
            number
        };
        parts.push(("conduction", rests * LINKS * neighbours));
    }
    parts.push(("cells and frames", number * OTHER));
    parts
}
