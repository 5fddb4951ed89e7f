//! `pool-stefan`: a melting front that runs into a bar.

use artefact::Reader;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::neumann::front;
use crate::norms::relative;
use crate::particles::{measurement, number};
use crate::special::erf;

/// The case.
pub(super) struct PoolStefan;

impl Case for PoolStefan {
    fn name(&self) -> &'static str {
        "pool-stefan"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Neumann's solution, Carslaw and Jaeger (1959), section 11.2"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("front", 0.015),
            Target::error("temperature_l2", 0.015),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let spacing = 1e-3 / f64::from(1 << (level.clamp(1, 4) - 1));
        // A whole number of steps between frames, shortened as the square of the spacing.
        let steps = (300.0 * (1e-3 / spacing).powi(2)).round();
        let patch = serde_json::json!({"spacing_m": spacing, "time": {"step_s": 6.0 / steps}});
        let run = lab.run("poolsph", self.name(), &format!("level{level}"), &patch)?;
        let seen = Seen::read(&run)?;
        let exact = Exact::of(&run, seen.boundary)?;
        let errors = errors(&exact, &seen);
        measurement(run, seen.place.len(), errors)
    }
}

/// What the frames show of the bar.
struct Seen {
    /// x of the last particle that is held \[m\].
    boundary: f64,
    /// x of the free particles \[m\].
    place: Vec<f64>,
    /// When each was first seen liquid, halfway since the frame before \[s\].
    melted: Vec<Option<f64>>,
    /// At the end \[K\].
    temperature: Vec<f64>,
    end: f64,
}

impl Seen {
    fn read(run: &Finished) -> Result<Self, LabError> {
        let reader = Reader::open_kind(&run.artefact, "particle-frames", 1)?;
        let mut seen: Option<Self> = None;
        let mut before = 0.0;
        for frame in reader.frames("/particles")? {
            let frame = frame?;
            let wall = frame.u8("wall")?;
            let free: Vec<usize> = (0..wall.len()).filter(|a| wall[*a] == 0).collect();
            let seen = match &mut seen {
                Some(seen) => seen,
                None => {
                    let x = frame.position_vectors()?;
                    let held = (0..wall.len()).filter(|a| wall[*a] == 1);
                    seen.insert(Self {
                        boundary: held.map(|a| x[a][0]).fold(f64::NEG_INFINITY, f64::max),
                        place: free.iter().map(|a| x[*a][0]).collect(),
                        melted: vec![None; free.len()],
                        temperature: Vec::new(),
                        end: 0.0,
                    })
                }
            };
            let molten = frame.u8("molten")?;
            for (melted, a) in seen.melted.iter_mut().zip(&free) {
                if molten[*a] == 1 && melted.is_none() {
                    *melted = Some(0.5 * (before + frame.time_s));
                }
            }
            let temperature = frame.f64("temperature")?;
            seen.temperature = free.iter().map(|a| temperature[*a]).collect();
            seen.end = frame.time_s;
            before = frame.time_s;
        }
        seen.ok_or_else(|| LabError::Content {
            path: run.artefact.clone(),
            what: "it has no frames of /particles".to_owned(),
        })
    }
}

fn errors(exact: &Exact, seen: &Seen) -> Errors {
    let passages = seen.place.iter().zip(&seen.melted);
    let late = passages.filter_map(|(x, t)| t.filter(|t| *t > 0.5 * seen.end).map(|t| (x, t)));
    let misses: Vec<f64> = late
        .map(|(x, t)| (x - exact.boundary) / exact.front(t) - 1.0)
        .collect();
    // No passage at all is no success.
    let front = misses.iter().map(|m| m.abs()).fold(f64::NAN, f64::max);
    let at_end = |x: &f64| exact.temperature(*x, seen.end) - exact.start;
    let wanted: Vec<f64> = seen.place.iter().map(at_end).collect();
    let found: Vec<f64> = seen.temperature.iter().map(|t| t - exact.start).collect();
    let (l2, linf) = relative(&found, &wanted);
    Errors::from([
        ("front".to_owned(), front),
        ("temperature_l2".to_owned(), l2),
        ("temperature_linf".to_owned(), linf),
    ])
}

/// Neumann's solution with equal properties of both phases.
struct Exact {
    boundary: f64,
    hot: f64,
    melting: f64,
    start: f64,
    /// alpha \[m2/s\].
    diffusivity: f64,
    lambda: f64,
}

impl Exact {
    fn of(run: &Finished, boundary: f64) -> Result<Self, LabError> {
        let heat = number(run, "/heat/specific_heat_j_kg_k")?;
        let capacity = number(run, "/density_kg_m3")? * heat;
        let latent = number(run, "/heat/melting/latent_heat_j_kg")?;
        let melting = number(run, "/heat/melting/point_k")?;
        let hot = number(run, "/bodies/1/held_temperature_k")?;
        let start = number(run, "/bodies/0/temperature_k")?;
        Ok(Self {
            boundary,
            hot,
            melting,
            start,
            diffusivity: number(run, "/heat/thermal_conductivity_w_m_k")? / capacity,
            lambda: front(
                [hot - melting, melting - start].map(|by| heat * by / latent),
                1.0,
                1.0,
            ),
        })
    }

    fn front(&self, time: f64) -> f64 {
        2.0 * self.lambda * (self.diffusivity * time).sqrt()
    }

    fn temperature(&self, x: f64, time: f64) -> f64 {
        let eta = (x - self.boundary) / (2.0 * (self.diffusivity * time).sqrt());
        if eta < self.lambda {
            self.hot - (self.hot - self.melting) * erf(eta) / erf(self.lambda)
        } else {
            let part = (1.0 - erf(eta)) / (1.0 - erf(self.lambda));
            self.start + (self.melting - self.start) * part
        }
    }
}
