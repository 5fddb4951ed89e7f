//! A run of a study of jets: its channels, and what their particles are.

use std::path::Path;

use ::run::Failure;
use artefact::{Frame, Reader, Record};
use serde_json::Value;

use crate::picture::jet::{Dot, What, Window};

/// A run.
pub(super) struct Run {
    /// What the page calls it.
    pub(super) name: String,
    /// Its artefact.
    pub(super) reader: Reader,
    /// Whether it lies in the plane.
    plane: bool,
    /// Its bodies: channel and half the spacing \[mm\].
    bodies: Vec<(String, f64)>,
}

/// How far the cut has come: depth and width \[mm\].
pub(super) type Cut = [f64; 2];

impl Run {
    /// Opens it.
    pub(super) fn open(name: &str, path: &Path) -> Result<Self, Failure> {
        let reader = Reader::open_kind(path, "jet-frames", 1)?;
        let scene = &reader.header().scene;
        let half = |of: &Value| 500.0 * of["spacing_m"].as_f64().unwrap_or(1e-3);
        let solids = scene["solids"].as_array();
        let mut bodies: Vec<(String, f64)> = solids
            .into_iter()
            .flatten()
            .map(|s| {
                (
                    format!("/{}", s["name"].as_str().unwrap_or_default()),
                    half(s),
                )
            })
            .collect();
        if scene.get("water").is_some_and(Value::is_object) {
            bodies.push(("/water".to_owned(), half(&scene["water"])));
        }
        bodies.retain(|(channel, _)| reader.has(channel));
        Ok(Self {
            name: name.to_owned(),
            plane: scene["dimensions"].as_u64() == Some(2),
            bodies,
            reader,
        })
    }

    /// Number of frames.
    pub(super) fn frames(&self) -> usize {
        let counts = self
            .bodies
            .iter()
            .map(|(channel, _)| self.reader.count(channel));
        counts.max().unwrap_or(0)
    }

    /// Time of a frame \[s\].
    pub(super) fn time(&self, index: usize) -> Result<f64, Failure> {
        let mut own = self.bodies.iter().map(|(channel, _)| channel);
        let channel = own.find(|channel| index < self.reader.count(channel));
        match channel {
            Some(channel) => Ok(self.reader.time(channel, index)?),
            None => Ok(0.0),
        }
    }

    /// The axis that points up.
    fn up(&self) -> usize {
        if self.plane { 1 } else { 2 }
    }

    /// Title of the axis that points up.
    pub(super) fn up_title(&self) -> &'static str {
        if self.plane { "y [mm]" } else { "z [mm]" }
    }

    fn frame(&self, channel: &str, index: usize) -> Result<Option<Frame>, Failure> {
        if index < self.reader.count(channel) {
            Ok(Some(self.reader.frame(channel, index)?))
        } else {
            Ok(None)
        }
    }

    /// y of the slice that is shown in space \[mm\]: through the first nozzle, without any y = 0.
    fn middle(&self) -> f64 {
        let exit = self
            .reader
            .header()
            .scene
            .pointer("/water/nozzles/0/exit_m/1");
        exit.and_then(Value::as_f64).map_or(0.0, |y| 1e3 * y)
    }

    /// Time \[s\] and particles of a frame, in space those of a slice through the first nozzle.
    pub(super) fn dots(&self, index: usize) -> Result<(f64, Vec<Dot>), Failure> {
        let (mut time, mut dots) = (0.0, Vec::new());
        let middle = self.middle();
        for (channel, radius) in &self.bodies {
            let Some(frame) = self.frame(channel, index)? else {
                continue;
            };
            time = frame.time_s;
            let broken = if frame.has("broken") {
                frame.u8("broken")?.to_vec()
            } else {
                Vec::new()
            };
            for (a, x) in frame.position_vectors()?.iter().enumerate() {
                if !self.plane && (1e3 * x[1] - middle).abs() > 1.2 * radius {
                    continue;
                }
                let what = match (channel.as_str(), broken.get(a)) {
                    ("/water", _) => What::Water,
                    (_, Some(1)) => What::Broken,
                    _ => What::Solid,
                };
                dots.push(Dot {
                    at: [1e3 * x[0], 1e3 * x[self.up()]],
                    radius: *radius,
                    what,
                });
            }
        }
        Ok((time, dots))
    }

    /// The window that holds the solids at the start with room about them, and the exits of the nozzles.
    pub(super) fn window(&self) -> Result<Window, Failure> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut take = |at: [f64; 2], radius: f64| {
            for k in 0..2 {
                low[k] = low[k].min(at[k] - radius);
                high[k] = high[k].max(at[k] + radius);
            }
        };
        for dot in self.dots(0)?.1 {
            take(dot.at, dot.radius);
        }
        let nozzles = self.reader.header().scene["water"]["nozzles"].as_array();
        for nozzle in nozzles.into_iter().flatten() {
            let exit = |k: usize| 1e3 * nozzle["exit_m"][k].as_f64().unwrap_or(0.0);
            take([exit(0), exit(self.up())], 0.0);
        }
        let room = 0.15 * (high[0] - low[0]);
        Ok(Window {
            x: [low[0] - room, high[0] + room],
            y: [low[1] - 0.6 * room, high[1] + 0.4 * room],
        })
    }

    /// Whether a place of the picture \[mm\] is in a wall: a box or a half space of the scene.
    pub(super) fn is_wall(&self, at: [f64; 2]) -> bool {
        let place = if self.plane {
            [at[0], at[1], 0.0]
        } else {
            [at[0], self.middle(), at[1]]
        };
        let walls = self.reader.header().scene["walls"].as_array();
        walls.into_iter().flatten().any(|wall| {
            let number = |of: &Value, k: usize| 1e3 * of[k].as_f64().unwrap_or(0.0);
            let plane = &wall["body"]["half_space"];
            let boxed = &wall["body"]["box"];
            let axes = if self.plane { 2 } else { 3 };
            if plane.is_object() {
                let above = |k: usize| {
                    (place[k] - number(&plane["point_m"], k)) * number(&plane["normal"], k)
                };
                return (0..axes).map(above).sum::<f64>() < 0.0;
            }
            boxed.is_object()
                && (0..axes).all(|k| {
                    place[k] > number(&boxed["min_m"], k) && place[k] < number(&boxed["max_m"], k)
                })
        })
    }

    /// How far the cut of the solids has come at each frame: from their upper faces to the lowest broken particle, and
    /// from the leftmost to the rightmost, by their places at the start.
    pub(super) fn cut(&self) -> Result<Vec<(f64, Cut)>, Failure> {
        let mut course = Vec::new();
        for index in 0..self.frames() {
            let mut cut = [0.0_f64; 2];
            let mut time = None;
            for (channel, radius) in self
                .bodies
                .iter()
                .filter(|(channel, _)| channel != "/water")
            {
                let (Some(first), Some(frame)) =
                    (self.frame(channel, 0)?, self.frame(channel, index)?)
                else {
                    continue;
                };
                if !frame.has("broken") {
                    continue;
                }
                time = Some(frame.time_s);
                let start = first.position_vectors()?;
                let top = start
                    .iter()
                    .fold(f64::NEG_INFINITY, |m, x| m.max(x[self.up()]));
                let (mut low, mut left, mut right) = (top, f64::INFINITY, f64::NEG_INFINITY);
                for (x, broken) in start.iter().zip(frame.u8("broken")?) {
                    if *broken > 0 {
                        low = low.min(x[self.up()] - 2e-3 * radius);
                        left = left.min(x[0] - 1e-3 * radius);
                        right = right.max(x[0] + 1e-3 * radius);
                    }
                }
                cut[0] = cut[0].max(1e3 * (top - low));
                cut[1] = cut[1].max(1e3 * (right - left).max(0.0));
            }
            course.extend(time.map(|time| (time, cut)));
        }
        Ok(course)
    }

    /// Its balances.
    pub(super) fn balances(&self) -> Result<Vec<(f64, Record)>, Failure> {
        if !self.reader.has("/balance") {
            return Ok(Vec::new());
        }
        Ok(self.reader.records("/balance")?)
    }
}
