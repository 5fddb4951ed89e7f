//! Memory that a run takes beyond the columns of its particles at the start, told before it.
//!
//! Bytes of a particle of water were measured on 140,000 in the plane and 216,000 (440,000 without sound) in space, with h of 1.5
//! and 2 spacings: lists grow with the neighbours within 2h.

use std::f64::consts::PI;

use run::property::Property;

use crate::scene::{Method, Scene, WaterScene};
use crate::state::State;

/// Bytes of a particle, and of each neighbour, of water with sound.
const SOUNDING: [f64; 2] = [430.0, 3.1];
/// The same without sound.
const SOUNDLESS: [f64; 2] = [300.0, 23.0];

/// Particles that nozzles of constant speed bring until the end; none where outlets take water away, or a speed varies: how many
/// are there at once is not known then.
#[must_use]
pub fn fed(scene: &Scene, water: &WaterScene) -> f64 {
    if !water.outlets.is_empty() {
        return 0.0;
    }
    let brought = water.nozzles.iter().map(|nozzle| {
        let Property::Constant(speed) = nozzle.speed_m_s else {
            return 0.0;
        };
        let end = nozzle.end_s.unwrap_or(f64::INFINITY).min(scene.time.end_s);
        let section = match scene.dimensions {
            2 => nozzle.width_m,
            _ => 0.25 * PI * nozzle.width_m * nozzle.width_m,
        };
        section * speed.max(0.0) * (end - nozzle.start_s).max(0.0)
    });
    brought.sum::<f64>() / water.spacing_m.powi(scene.dimensions as i32)
}

/// Names and bytes of what a run takes beyond the columns of `state`.
#[must_use]
pub fn beyond(scene: &Scene, state: &State) -> Vec<(&'static str, u64)> {
    let Some(water) = &scene.water else {
        return Vec::new();
    };
    let sets = state.sets.iter().filter(|set| set.name() == "water");
    let (count, bytes) = sets.fold((0.0, 0.0), |(n, b), set| {
        (n + set.len() as f64, b + set.bytes() as f64)
    });
    let fed = fed(scene, water);
    let reach = 2.0 * water.smoothing;
    let neighbours = match scene.dimensions {
        2 => PI * reach * reach,
        _ => 4.0 / 3.0 * PI * reach.powi(3),
    };
    let [own, each] = match water.method {
        Method::WeaklyCompressible => SOUNDING,
        Method::DivergenceFree => SOUNDLESS,
    };
    let lists = (count + fed) * (own + each * neighbours);
    let mut parts = vec![("lists and work", lists as u64)];
    if count > 0.0 && fed >= 1.0 {
        parts.push(("water from nozzles", (fed * bytes / count) as u64));
    }
    parts
}
