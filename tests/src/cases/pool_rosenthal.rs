//! `pool-rosenthal`: a spot of heat that moves over a plate.
//!
//! ```text
//! T - T_0 = Q/(rho c) integral_0^t G_x G_y G_z d tau
//! G_x = N(x - x_s, sigma^2 + 2 alpha tau),  G_y = N(y - y_s(t - tau), sigma^2 + 2 alpha tau)
//! G_z = N(z - z_s, 2 alpha tau)
//! ```
//!
//! with N the normal distribution and each factor summed over the images in its two faces.

use std::f64::consts::TAU;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::norms::relative;
use crate::particles::{Frames, measurement, number};
use crate::spot::Spot;

/// Points of the quadrature over the square root of the elapsed time.
const POINTS: u32 = 400;
/// Particles that are compared.
const SAMPLES: usize = 4000;
/// How far from the spot \[m\].
const REACH: f64 = 0.008;

/// The case.
pub(super) struct PoolRosenthal;

impl Case for PoolRosenthal {
    fn name(&self) -> &'static str {
        "pool-rosenthal"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Eagar and Tsai (1983), eq. 9; far from the spot Rosenthal (1941)"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("temperature_linf", 0.02),
            Target::order("temperature_l2", 1.0),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing: f64 = [0.8e-3, 0.6e-3, 0.5e-3, 0.4e-3][level.clamp(1, 4) as usize - 1];
        // A whole number of steps, shortened as the square of the spacing.
        let steps = (500.0 * (0.6e-3 / spacing).powi(2)).round();
        let patch = serde_json::json!({"spacing_m": spacing, "time": {"step_s": 3.0 / steps}});
        let run = lab.run("poolsph", self.name(), &format!("level{level}"), &patch)?;
        let frames = Frames::read(&run.artefact, "temperature")?;
        let exact = Exact::of(&run)?;
        let start = number(&run, "/bodies/0/temperature_k")?;
        let Some(errors) = errors(&exact, &frames, start) else {
            return Err(LabError::Content {
                path: run.artefact.clone(),
                what: format!(
                    "no particle is within {REACH} m of the spot at its end: it has left the plate"
                ),
            });
        };
        measurement(run, frames.scalar[0].len(), errors)
    }
}

/// Errors about the spot; none where it has left the plate.
fn errors(exact: &Exact, frames: &Frames, start: f64) -> Option<Errors> {
    let last = frames.time.len() - 1;
    let (places, rises) = (&frames.position[last], &frames.scalar[last]);
    let spot = exact.place(frames.time[last]);
    let near = |x: &[f64; 3]| {
        let square: f64 = (0..3).map(|k| (x[k] - spot[k]).powi(2)).sum();
        square < REACH * REACH
    };
    let all: Vec<usize> = (0..places.len()).filter(|a| near(&places[*a])).collect();
    if all.is_empty() {
        return None;
    }
    let stride = all.len().div_ceil(SAMPLES);
    let some = || all.iter().step_by(stride);
    let found: Vec<f64> = some().map(|a| rises[*a] - start).collect();
    let rise = |a: &usize| exact.rise(places[*a], frames.time[last]);
    let wanted: Vec<f64> = some().map(rise).collect();
    let (l2, linf) = relative(&found, &wanted);
    Some(Errors::from([
        ("temperature_l2".to_owned(), l2),
        ("temperature_linf".to_owned(), linf),
    ]))
}

/// The exact solution.
struct Exact {
    spot: Spot,
    /// alpha \[m2/s\].
    diffusivity: f64,
    /// rho c \[J/(m3 K)\].
    capacity: f64,
    start: [f64; 3],
    velocity: [f64; 3],
    faces: [[f64; 2]; 3],
}

impl Exact {
    fn of(run: &Finished) -> Result<Self, LabError> {
        let vector = |at: &str| -> Result<[f64; 3], LabError> {
            let mut x = [0.0; 3];
            for (k, x) in x.iter_mut().enumerate() {
                *x = number(run, &format!("{at}/{k}"))?;
            }
            Ok(x)
        };
        let capacity = number(run, "/density_kg_m3")? * number(run, "/heat/specific_heat_j_kg_k")?;
        let (low, high) = (vector("/heat/faces/min_m")?, vector("/heat/faces/max_m")?);
        Ok(Self {
            spot: Spot::of(run)?,
            diffusivity: number(run, "/heat/thermal_conductivity_w_m_k")? / capacity,
            capacity,
            start: vector("/source/start_m")?,
            velocity: vector("/source/velocity_m_s")?,
            faces: [0, 1, 2].map(|k| [low[k], high[k]]),
        })
    }

    fn place(&self, time: f64) -> [f64; 3] {
        let at = |k: usize| self.start[k] + self.velocity[k] * time;
        // The spot is on the upper face.
        [at(0), at(1), self.faces[2][1]]
    }

    fn rise(&self, x: [f64; 3], time: f64) -> f64 {
        let width = time.sqrt() / f64::from(POINTS);
        let wide = self.spot.sigma * self.spot.sigma;
        let sum: f64 = (0..POINTS)
            .map(|k| {
                let root = (f64::from(k) + 0.5) * width;
                let tau = root * root;
                let (place, spread) = (self.place(time - tau), 2.0 * self.diffusivity * tau);
                let flat = |k: usize| images(x[k], place[k], wide + spread, self.faces[k]);
                // On the face itself, the image of the spot is the spot: half of the heat each.
                2.0 * root * flat(0) * flat(1) * images(x[2], place[2], spread, self.faces[2])
            })
            .sum();
        self.spot.power(f64::INFINITY) / self.capacity * sum * width
    }
}

/// Normal distribution around `s` and its images in two faces.
fn images(x: f64, s: f64, variance: f64, [low, high]: [f64; 2]) -> f64 {
    let around = |centre: f64| (-0.5 * (x - centre).powi(2) / variance).exp();
    let period = 2.0 * (high - low);
    let both = |n: i32| {
        let shift = f64::from(n) * period;
        around(s + shift) + around(2.0 * high - s + shift)
    };
    (both(-1) + both(0) + both(1)) / (TAU * variance).sqrt()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn exact(sigma: f64) -> Exact {
        Exact {
            spot: Spot {
                peak: 100.0 / (TAU * sigma * sigma),
                sigma,
            },
            diffusivity: 1e-5,
            capacity: 4e6,
            start: [0.0; 3],
            velocity: [0.0, 0.01, 0.0],
            faces: [[-1.0, 1.0], [-1.0, 1.0], [-1.0, 0.0]],
        }
    }

    #[test]
    fn a_small_spot_in_a_large_plate_is_rosenthals() {
        let exact = exact(1e-4);
        for x in [
            [0.0_f64, -0.004, 0.0],
            [0.002, 0.001, -0.001],
            [0.0, 0.0, -0.004],
        ] {
            let r = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
            let conductivity = 40.0;
            let rosenthal = 100.0 / (TAU * conductivity * r) * (-0.01 * (x[1] + r) / 2e-5).exp();
            let found = exact.rise([x[0], x[1] + 0.1, x[2]], 10.0);
            assert!(
                (found / rosenthal - 1.0).abs() < 0.01,
                "{found} {rosenthal}"
            );
        }
    }

    #[test]
    fn a_resting_spot_heats_its_centre_as_the_closed_form_says() {
        // Carslaw and Jaeger (1959): Q / (pi^1.5 k sigma sqrt 2) atan(sqrt(2 alpha t) / sigma).
        let mut exact = exact(2e-3);
        exact.velocity = [0.0; 3];
        let time = 0.5_f64;
        let closed = 100.0 / (PI.powf(1.5) * 40.0 * 2e-3 * 2.0_f64.sqrt())
            * ((2e-5 * time).sqrt() / 2e-3).atan();
        assert!((exact.rise([0.0; 3], time) / closed - 1.0).abs() < 1e-4);
    }
}
