//! Droplets from the wire: born at a height, falling at one speed, part of the pool once they reach it.
//!
//! A droplet is the lattice of spacing d within a radius around its centre, 19 particles for
//! 0.75 mm and d = 0.5 mm in layers of 5, 9 and 5 (Komen 2019, section 4.3, fig. 4.9). In flight
//! it keeps its temperature and meets nobody. It joins the liquid when a particle of it comes
//! within the support of the kernel of anything that does not fly; before the flow has started,
//! where it would touch, and rests there.
//!
//! Print gives a droplet every 0.1 s and means 10 ms; 19 particles of volume d^3 carry the volume of
//! the wire feed with a longer period. Lattices of other spacings hold other volumes within the radius, so that a scene
//! best says the feed, and droplets come as often as they carry it.
//!
//! Beside the droplets upon the axis of the source, arcs may have wires of their own (key `arcs`).
//!
//! Where the source goes along a mirror plane, half of each droplet is born. Its layers stand half a spacing and more from the plane, so
//! that with their images they are a droplet whose lattice the plane halves. The feed of the scene is that of the whole wire.

mod ground;
mod wire;

use run::Fault;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use steps::Figure;

use crate::stage::{Stage, StageError};
use crate::state::{DROPLET, State};

pub use wire::Wire;

/// Droplets from the wire (key `droplets`).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Time between two droplets \[s\]; the first is born at time 0. Where it is absent, `feed_m3_s` decides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "s", "exclusiveMinimum" = 0.0))]
    pub period_s: Option<f64>,
    /// Volume of wire that melts per second \[m3/s\]: the time between droplets is their volume over this, whatever the number of
    /// particles in a droplet. Ignored where `period_s` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "m3/s", "exclusiveMinimum" = 0.0))]
    pub feed_m3_s: Option<f64>,
    /// Lattice points within this radius make a droplet \[m\].
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub radius_m: f64,
    /// Height of its centre above the source at birth \[m\].
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub height_m: f64,
    /// Speed of its fall \[m/s\].
    #[schemars(extend("x-unit" = "m/s", "exclusiveMinimum" = 0.0))]
    pub speed_m_s: f64,
    /// Temperature until it reaches the pool \[K\]; needed where the scene has heat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "K", "exclusiveMinimum" = 0.0))]
    pub temperature_k: Option<f64>,
}

impl Parameters {
    /// Time between two droplets of particles of the spacing \[m\] \[s\]: T = N d^3 / V', N particles each, V' the feed; half of
    /// each side of a mirror.
    #[must_use]
    pub fn period(&self, spacing: f64, mirror: Option<Mirror>) -> Option<f64> {
        let sides = if mirror.is_some() { 2.0 } else { 1.0 };
        let volume =
            || sides * shape(self.radius_m, spacing, mirror).len() as f64 * spacing.powi(3);
        self.period_s
            .or_else(|| self.feed_m3_s.map(|feed| volume() / feed))
    }

    /// The mirror plane that halves droplets of a source that starts at a place \[m\], among mirrors by axis, whether the
    /// metal is below the plane, and place \[m\].
    ///
    /// # Errors
    /// A mirror that a droplet would reach through, and more than one that halves it.
    pub fn mirror(
        &self,
        start: [f64; 3],
        velocity: [f64; 3],
        mirrors: &[(Mirror, f64)],
    ) -> Result<Option<Mirror>, Fault> {
        let mut halves = None;
        for (mirror, plane) in mirrors.iter().filter(|(mirror, _)| mirror.axis < 2) {
            let off = (start[mirror.axis] - plane).abs();
            let along = velocity[mirror.axis].abs() <= f64::MIN_POSITIVE;
            let on = off <= 1e-6 * self.radius_m && along;
            if on && halves.is_none() {
                halves = Some(*mirror);
            } else if on || (off < self.radius_m && along) {
                let what = format!(
                    "{off} m from the axis of the droplets, of the radius {} m: a mirror halves them or is out of their reach",
                    self.radius_m
                );
                return Err(Fault::at("/faces/mirror", what));
            }
        }
        Ok(halves)
    }
}

/// A mirror plane by its axis, and on which side of it the metal is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mirror {
    /// Number of the axis across it.
    pub axis: usize,
    /// Whether the metal lies towards lesser values.
    pub below: bool,
}

/// Lattice points of spacing `d` within `radius` of the origin, layer by layer from below; of a droplet that a mirror halves, those on
/// the side of the metal.
#[must_use]
pub fn shape(radius: f64, d: f64, mirror: Option<Mirror>) -> Vec<[f64; 3]> {
    let n = (radius / d + 1e-9).floor() as i64 + 1;
    let mut points = Vec::new();
    for k in -n..=n {
        for j in -n..=n {
            for i in -n..=n {
                let mut point = [i, j, k].map(|c| c as f64 * d);
                if let Some(Mirror { axis, below }) = mirror {
                    point[axis] += 0.5 * d;
                    if (point[axis] > 0.0) == below {
                        continue;
                    }
                }
                let square: f64 = point.iter().map(|x| x * x).sum();
                if square <= radius * radius * (1.0 + 1e-9) {
                    points.push(point);
                }
            }
        }
    }
    points
}

/// The stage that makes and moves droplets, of one wire or several; phases are those of the first.
pub struct Droplets(Vec<Wire>);

impl Droplets {
    /// Droplets of wires.
    #[must_use]
    pub fn of(wires: Vec<Wire>) -> Self {
        Self(wires)
    }
}

impl Stage for Droplets {
    fn name(&self) -> &'static str {
        "droplets"
    }

    fn declare(&self, state: &mut State) {
        state.metal.declare(&DROPLET);
    }

    fn advance(&mut self, state: &mut State, dt: f64) -> Result<(), StageError> {
        let Some(mut place) = state.source else {
            return Err(StageError::Data("droplets fall from no source".to_owned()));
        };
        for (number, wire) in self.0.iter_mut().enumerate() {
            let phase = wire.advance(state, place.position, dt);
            if number == 0 {
                (place.phase, place.droplets) = (phase, wire.born());
            }
        }
        state.source = Some(place);
        Ok(())
    }

    fn follows(&self, state: &State) -> f64 {
        let each = self.0.iter().map(|wire| wire.follows(state));
        each.fold(f64::INFINITY, f64::min)
    }

    fn next(&self, _: f64) -> Option<f64> {
        self.0.iter().map(Wire::next).reduce(f64::min)
    }

    fn figures(&self) -> Vec<Figure> {
        let figure = |name, unit, value| Figure { name, unit, value };
        let born = self.0.iter().map(|wire| wire.born() as f64).sum();
        let energy = self.0.iter().map(Wire::energy).sum();
        vec![
            figure("droplets", "1", born),
            figure("energy_in_droplets_j", "J", energy),
        ]
    }

    fn warnings(&self) -> Vec<String> {
        let wires = self.0.iter().enumerate();
        wires.filter_map(|(k, wire)| wire.warning(k)).collect()
    }

    /// What is kept of each wire, with its length before it where there are several.
    fn save(&self) -> Vec<f64> {
        if let [wire] = self.0.as_slice() {
            return wire.save();
        }
        let each = self.0.iter().map(Wire::save);
        each.flat_map(|kept| [vec![kept.len() as f64], kept].concat())
            .collect()
    }

    fn restore(&mut self, saved: &[f64]) {
        if let [wire] = self.0.as_mut_slice() {
            wire.restore(saved);
            return;
        }
        let mut left = saved;
        for wire in &mut self.0 {
            let Some((length, rest)) = left.split_first() else {
                return;
            };
            let (own, others) = rest.split_at((*length as usize).min(rest.len()));
            wire.restore(own);
            left = others;
        }
    }
}

#[cfg(test)]
mod tests;
