//! Thermocouples: temperatures at places in the metal.
//!
//! The temperature at a place x is that of the plane through the particles about it, by moving least squares
//!
//! ```text
//! minimise sum_a W(|x_a - x|) (T_a - c - g . (x_a - x))^2,      T(x) = c
//! ```
//!
//! which is exact for linear fields, beside a face too. Where particles lie on one plane or line it is their weighted mean, and where
//! there is none within the kernel that of the nearest. How far the nearest is, is told with every reading: a couple that stands more than a
//! particle diameter off the metal reads nothing that it touches.

use artefact::Record;
use kernels::CubicSpline;
use particles::POSITION;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::state::{PHASE, State, TEMPERATURE, WALL, marked, phase};

/// Smoothing length over the particle diameter.
const SMOOTHING: f64 = 1.2;
/// A pivot below this part of the weights is none: the particles lie on a plane.
const FLAT: f64 = 1e-6;

/// A place whose temperature is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name: a column of the table.
    #[schemars(regex(pattern = "^[A-Za-z0-9_-]+$"))]
    pub name: String,
    /// Place; it does not move with the metal.
    #[schemars(extend("x-unit" = "m"))]
    pub place_m: [f64; 3],
}

/// What a probe reads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// \[K\]; 0 where there is no metal at all.
    pub temperature: f64,
    /// Distance of the nearest particle \[m\]; infinite where there is none.
    pub away: f64,
}

/// Channel of the readings.
pub const CHANNEL: &str = "/probes";

/// Readings of all probes: the temperature of each under its name, and how far the metal is as `NAME.away`.
#[must_use]
pub fn record(probes: &[Probe], state: &State) -> Record {
    let time = Record::new().with("time_s", "s", state.time);
    probes.iter().fold(time, |record, probe| {
        let Reading { temperature, away } = read(state, probe.place_m);
        // A file holds numbers alone: beyond everything is as far as the state can tell.
        let away = if away.is_finite() { away } else { f64::MAX };
        record
            .with(&probe.name, "K", temperature)
            .with(&format!("{}.away", probe.name), "m", away)
    })
}

/// The temperature at a place, of all metal but what flies and the container.
#[must_use]
pub fn read(state: &State, place: [f64; 3]) -> Reading {
    let kernel = CubicSpline::<3>::new(SMOOTHING * state.metal.matter.spacing);
    let mut nearest = (f64::INFINITY, 0.0);
    let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
    let (wall, phases) = (state.metal.column(&WALL), state.metal.column(&PHASE));
    let temperatures = state.metal.column(&TEMPERATURE);
    for (a, x) in state.metal.column(&POSITION).iter().enumerate() {
        if marked(wall, a) || phases[a] == phase::FLYING {
            continue;
        }
        let away: [f64; 3] = std::array::from_fn(|k| x[k] - place[k]);
        let r = away.iter().map(|d| d * d).sum::<f64>().sqrt();
        let t = temperatures[a];
        if r < nearest.0 {
            nearest = (r, t);
        }
        let weight = kernel.value(r) / kernel.value(0.0);
        if weight > 0.0 {
            let [x, y, z] = away.map(|d| d / state.metal.matter.spacing);
            let basis = [1.0, x, y, z];
            for i in 0..4 {
                right[i] += weight * basis[i] * t;
                for j in 0..4 {
                    matrix[i][j] += weight * basis[i] * basis[j];
                }
            }
        }
    }
    let mean = (matrix[0][0] > 0.0).then(|| right[0] / matrix[0][0]);
    let temperature = solved(matrix, right).or(mean).unwrap_or(nearest.1);
    Reading {
        temperature,
        away: nearest.0,
    }
}

/// The first unknown of a symmetric positive system; none where it is singular.
fn solved(mut matrix: [[f64; 4]; 4], mut right: [f64; 4]) -> Option<f64> {
    let least = FLAT * matrix[0][0];
    // Gauss's elimination from the last unknown up, so that the first is left.
    for k in (1..4).rev() {
        let pivot = matrix[k][k];
        if pivot <= least {
            return None;
        }
        for i in 0..k {
            let factor = matrix[i][k] / pivot;
            let row = matrix[k];
            for (cell, below) in matrix[i].iter_mut().zip(row).take(k) {
                *cell -= factor * below;
            }
            right[i] -= factor * right[k];
        }
    }
    (matrix[0][0] > least).then(|| right[0] / matrix[0][0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::{ENTHALPY, Particle};
    use particles::Matter;

    fn metal(field: impl Fn([f64; 3]) -> f64) -> State {
        let metal = Matter {
            density: 1000.0,
            spacing: 0.1,
            smoothing_length: 0.1,
        };
        let mut state = State::new(metal);
        state.metal.declare(&TEMPERATURE);
        state.metal.declare(&ENTHALPY);
        for i in 0..1000_u32 {
            // Shaken by a fraction that follows from the number.
            let at = [i % 10, i / 10 % 10, i / 100];
            let shaken = |k: usize| 0.02 * (f64::from(i * 7 + k as u32 * 13) * 0.7).sin();
            let position = std::array::from_fn(|k| 0.1 * (f64::from(at[k]) + 0.5) + shaken(k));
            state.push(Particle {
                position,
                velocity: [0.0; 3],
                phase: phase::SOLID,
                droplet: false,
                wall: false,
                temperature: field(position),
                enthalpy: 0.0,
            });
        }
        state
    }

    #[test]
    fn linear_fields_are_read_exactly_inside_and_at_faces() {
        let field = |x: [f64; 3]| 300.0 + 40.0 * x[0] - 7.0 * x[1] + 11.0 * x[2];
        let state = metal(field);
        for place in [
            [0.512, 0.333, 0.48],
            [0.0, 0.5, 0.5],
            [1.0, 1.0, 1.0],
            [0.05; 3],
        ] {
            let found = read(&state, place);
            assert!(
                (found.temperature - field(place)).abs() < 1e-9,
                "{place:?} {found:?}"
            );
            assert!(found.away < 0.12);
        }
    }

    #[test]
    fn a_probe_off_the_metal_says_so() {
        let state = metal(|_| 500.0);
        let found = read(&state, [0.5, 0.5, 2.0]);
        assert!((found.temperature - 500.0).abs() < 1e-9 && found.away > 0.9);
        let probes = [Probe {
            name: "a".to_owned(),
            place_m: [0.5, 0.5, 2.0],
        }];
        let record = record(&probes, &state);
        assert!((record.get("a").unwrap() - 500.0).abs() < 1e-9);
        assert!(record.get("a.away").unwrap() > 0.9);
    }

    #[test]
    fn what_lies_on_a_plane_is_read_by_its_mean() {
        let singular = [[1.0, 0.0, 0.0, 0.0]; 4];
        assert_eq!(solved(singular, [1.0; 4]), None);
    }
}
