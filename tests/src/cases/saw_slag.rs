//! `saw-slag`: liquid metal that freezes under cold slag, which is a second liquid.

use std::f64::consts::PI;

use artefact::{Frame, Reader};
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::neumann::{front, halved};
use crate::norms::relative;
use crate::particles::number;
use crate::special::erf;

/// Depth of the metal over sqrt(alpha t) at the end, and height of the slag over its own.
const REACHES: [f64; 2] = [5.5, 6.5];
/// Columns of particles along each side.
const SIDE: f64 = 3.0;
/// Steps on level 1.
const STEPS: f64 = 600.0;
/// Frames of a run.
const FRAMES: f64 = 300.0;
/// Part of a range of temperatures that rounding takes.
const ROUNDED: f64 = 1e-9;

/// The case.
pub(super) struct SawSlag;

impl Case for SawSlag {
    fn name(&self) -> &'static str {
        "saw-slag"
    }

    fn tool(&self) -> &'static str {
        "poolsph"
    }

    fn reference(&self) -> &'static str {
        "Neumann's solution for two half-spaces that touch, each with a front, Carslaw and Jaeger (1959), section 11.2"
    }

    fn targets(&self) -> Vec<Target> {
        vec![
            Target::error("front_metal", 0.015),
            Target::error("front_slag", 0.015),
            Target::error("temperature_metal", 0.015),
            Target::error("temperature_slag", 0.015),
            Target::error("energy", 1e-10),
        ]
    }

    fn measure(&self, lab: &Lab, level: u32, _: &str) -> Result<Measurement, LabError> {
        let first = lab.run("poolsph", self.name(), &format!("scene{level}"), &json!({}))?;
        let patch = Column::of(&first)?.patch(&first, level);
        let run = lab.varied(&first, &format!("level{level}"), &patch)?;
        let column = Column::of(&run)?;
        let exact = Exact::of(&column);
        let (points, errors) = errors(&run, &column, &exact)?;
        Ok(Measurement::of(run, points, column.spacing, errors))
    }
}

/// One of both liquids.
struct Liquid {
    conductivity: f64,
    heat: f64,
    latent: f64,
    melting: f64,
    start: f64,
    density: f64,
}

impl Liquid {
    fn of(run: &Finished, heat: &str, body: u8, density: &str) -> Result<Self, LabError> {
        let at = |key: &str| number(run, &format!("{heat}/{key}"));
        Ok(Self {
            conductivity: at("thermal_conductivity_w_m_k")?,
            heat: at("specific_heat_j_kg_k")?,
            latent: at("melting/latent_heat_j_kg")?,
            melting: at("melting/point_k")?,
            start: number(run, &format!("/bodies/{body}/temperature_k"))?,
            density: number(run, density)?,
        })
    }

    fn diffusivity(&self) -> f64 {
        self.conductivity / (self.density * self.heat)
    }

    /// The constant of its front where the face has a temperature \[K\].
    fn constant(&self, face: f64) -> f64 {
        let behind = (face - self.melting).abs() * self.heat / self.latent;
        let beyond = (self.melting - self.start).abs() * self.heat / self.latent;
        front([behind, beyond], 1.0, 1.0)
    }

    /// Heat through the face times the root of time, in magnitude.
    fn passes(&self, face: f64) -> f64 {
        let across = self.conductivity * (face - self.melting).abs();
        across / (self.diffusivity().sqrt() * erf(self.constant(face)))
    }

    /// T at a distance from the face \[m\] \[K\].
    fn temperature(&self, face: f64, away: f64, time: f64) -> f64 {
        let eta = away / (2.0 * (self.diffusivity() * time).sqrt());
        let constant = self.constant(face);
        if eta < constant {
            face + (self.melting - face) * erf(eta) / erf(constant)
        } else {
            let part = (1.0 - erf(eta)) / (1.0 - erf(constant));
            self.start + (self.melting - self.start) * part
        }
    }

    /// How far its front has gone \[m\].
    fn front(&self, face: f64, time: f64) -> f64 {
        2.0 * self.constant(face) * (self.diffusivity() * time).sqrt()
    }
}

/// The scene.
struct Column {
    spacing: f64,
    depth: f64,
    end: f64,
    metal: Liquid,
    slag: Liquid,
}

impl Column {
    fn of(run: &Finished) -> Result<Self, LabError> {
        Ok(Self {
            spacing: number(run, "/spacing_m")?,
            depth: -number(run, "/bodies/0/shape/box/min_m/2")?,
            end: number(run, "/time/end_s")?,
            metal: Liquid::of(run, "/heat", 0, "/density_kg_m3")?,
            slag: Liquid::of(run, "/slag/heat", 1, "/slag/density_kg_m3")?,
        })
    }

    /// Heat that the metal has given at the end \[J\].
    fn given(&self, exact: &Exact) -> f64 {
        let area = (SIDE * self.spacing).powi(2);
        2.0 * area * self.metal.passes(exact.face) * (self.end / PI).sqrt()
    }

    /// Both on a lattice `2^(1 - level)` times as wide, until heat has gone a fifth of the depth of the metal.
    fn patch(&self, first: &Finished, level: u32) -> Value {
        let scale = 0.5_f64.powi(level.clamp(1, 5) as i32 - 1);
        let d = self.spacing * scale;
        let end = (self.depth / REACHES[0]).powi(2) / self.metal.diffusivity();
        let steps = (STEPS / (scale * scale)).round();
        let reached = REACHES[1] * (self.slag.diffusivity() * end).sqrt();
        let height = (reached / self.spacing).ceil() * self.spacing;
        let side = SIDE * d;
        let boxes = [[-self.depth, 0.0], [0.0, height]];
        let mut bodies = first.scene["bodies"].clone();
        for (body, [low, high]) in boxes.into_iter().enumerate() {
            bodies[body]["shape"] =
                json!({"box": {"min_m": [0, 0, low], "max_m": [side, side, high]}});
        }
        json!({
            "spacing_m": d,
            "time": {"step_s": end / steps, "end_s": end},
            "bodies": bodies,
            "faces": {"min_m": [0, 0, -self.depth], "max_m": [side, side, height]},
            "output": {"particles_interval_s": end / FRAMES, "balance_interval_s": end}
        })
    }
}

/// Neumann's solution on both sides of the face.
struct Exact {
    /// T of the face \[K\].
    face: f64,
}

impl Exact {
    fn of(column: &Column) -> Self {
        let (metal, slag) = (&column.metal, &column.slag);
        let range = 1e-6 * (metal.melting - slag.melting);
        let ends = [slag.melting + range, metal.melting - range];
        let face = halved(ends[0], ends[1], |face| {
            metal.passes(face) > slag.passes(face)
        });
        Self { face }
    }
}

/// Number of particles, and errors of fronts, temperatures and energy.
fn errors(run: &Finished, column: &Column, exact: &Exact) -> Result<(u64, Errors), LabError> {
    let reader = Reader::open_kind(&run.artefact, "particle-frames", 1)?;
    let mut passages = Passages::default();
    let (mut found, mut wanted) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
    for frame in reader.frames("/particles")? {
        let frame: Frame = frame?;
        passages.take(&frame, column)?;
        found.iter_mut().chain(&mut wanted).for_each(Vec::clear);
        let slag = frame.u8("slag")?;
        let warm = frame
            .position_vectors()?
            .into_iter()
            .zip(frame.f64("temperature")?);
        for ((x, t), slag) in warm.zip(slag) {
            let side = usize::from(*slag);
            let own = [&column.metal, &column.slag][side];
            found[side].push(t - own.start);
            wanted[side].push(own.temperature(exact.face, x[2].abs(), frame.time_s) - own.start);
        }
    }
    let [metal, slag] = [0, 1].map(|side| relative(&found[side], &wanted[side]).0);
    let [front_metal, front_slag] = passages.errors(column, exact);
    let points = (found[0].len() + found[1].len()) as u64;
    let errors = [
        ("front_metal", front_metal),
        ("front_slag", front_slag),
        ("temperature_metal", metal),
        ("temperature_slag", slag),
        ("energy", energy(run, &reader)?.abs() / column.given(exact)),
    ];
    Ok((
        points,
        errors.map(|(name, error)| (name.to_owned(), error)).into(),
    ))
}

/// When the front came to each particle and when it left it, from temperatures, which stand still between \[s\].
#[derive(Default)]
struct Passages {
    away: Vec<f64>,
    slag: Vec<bool>,
    came: Vec<Option<f64>>,
    left: Vec<Option<f64>>,
    before: f64,
}

impl Passages {
    fn take(&mut self, frame: &Frame, column: &Column) -> Result<(), LabError> {
        let temperature = frame.f64("temperature")?;
        self.away = frame
            .position_vectors()?
            .iter()
            .map(|x| x[2].abs())
            .collect();
        self.slag = frame.u8("slag")?.iter().map(|slag| *slag > 0).collect();
        self.came.resize(self.away.len(), None);
        self.left.resize(self.away.len(), None);
        let now = Some(0.5 * (self.before + frame.time_s));
        for (a, t) in temperature.iter().enumerate() {
            // From the side of the start to that of the face.
            let own = if self.slag[a] {
                &column.slag
            } else {
                &column.metal
            };
            let way = (t - own.melting) * (own.melting - own.start).signum();
            let rounding = ROUNDED * own.melting;
            if way >= -rounding && self.came[a].is_none() {
                self.came[a] = now;
            }
            if way > rounding && self.left[a].is_none() {
                self.left[a] = now;
            }
        }
        self.before = frame.time_s;
        Ok(())
    }

    /// Errors of both fronts where they were last seen, over their ways: a front stands in the middle of a particle at the mean of the roots
    /// of both times.
    fn errors(&self, column: &Column, exact: &Exact) -> [f64; 2] {
        let mut last = [(0.0, f64::NAN); 2];
        for (a, away) in self.away.iter().enumerate() {
            let (Some(came), Some(left)) = (self.came[a], self.left[a]) else {
                continue;
            };
            let time = (0.5 * (came.sqrt() + left.sqrt())).powi(2);
            let side = usize::from(self.slag[a]);
            let own = [&column.metal, &column.slag][side];
            if *away > last[side].0 {
                last[side] = (*away, (away / own.front(exact.face, time) - 1.0).abs());
            }
        }
        last.map(|(_, error)| error)
    }
}

/// Change of all heat \[J\].
fn energy(run: &Finished, reader: &Reader) -> Result<f64, LabError> {
    let records = reader.records("/balance")?;
    let of = |k: usize| {
        records
            .get(k)
            .and_then(|(_, record)| record.get("energy_stored_j").ok())
    };
    match (of(0), of(records.len().saturating_sub(1))) {
        (Some(first), Some(last)) => Ok(last - first),
        _ => Err(LabError::Content {
            path: run.artefact.clone(),
            what: "has no 'energy_stored_j' in /balance".to_owned(),
        }),
    }
}
