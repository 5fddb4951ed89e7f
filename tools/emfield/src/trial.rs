//! What a run will take of time and memory, from the same scene with fewer points.
//!
//! The scene is solved with all spacings larger by one ratio, so that it has a few thousand points. Each stage then counts by
//! the points: stencils, rows, multigrid and products have as much work at each; direct factors, and the products of incomplete
//! ones, have more the more points there are.

use std::time::Instant;

use artefact::{Header, Version};
use run::{Estimate, Failure, Taken, duration, trial};

use crate::assemble;
use crate::cloud::{Cloud, setup};
use crate::scene::currents::Transient;
use crate::scene::method::Way;
use crate::scene::{Geometry, Scene};

/// Points of a trial, about: more than are solved directly unless a scene asks for it.
const FEW: f64 = 5000.0;
/// More points than these are made fewer.
const MANY: f64 = 1.5;
/// Spacings that bodies of a trial are wide at least: points of smaller ones want larger supports.
const WIDTH: f64 = 8.0;
/// Steps of the march of a trial.
const STEPS: u64 = 3;
/// Ratio of spacings up to which two scenes count as the same.
const CLOSE: f64 = 1.02;
/// How often a coarser scene is tried.
const TRIES: usize = 6;

/// What holds memory, with the stage that makes it.
const HELD: [(&str, &str); 3] = [
    ("weights", "weights"),
    ("equations", "assemble"),
    ("factors", "factorise"),
];
/// What time is told of, with its stage.
const TOLD: [(&str, &str); 4] = [
    ("weights", "weights"),
    ("factors", "factorise"),
    ("solution", "solve"),
    ("march", "march"),
];

/// Points of a scene.
#[derive(Debug)]
pub(crate) struct Planned {
    pub(crate) cloud: Cloud,
    /// What they took \[s\].
    seconds: f64,
}

impl Planned {
    /// The points of a scene, and how long it takes to make them.
    ///
    /// # Errors
    /// Where bodies and spacings do not suit each other.
    pub(crate) fn new(scene: &Scene) -> Result<Self, Failure> {
        let began = Instant::now();
        let cloud = setup::cloud(scene)?;
        let seconds = began.elapsed().as_secs_f64();
        Ok(Self { cloud, seconds })
    }
}

/// Time and memory of a run.
///
/// # Errors
/// Those of the trial.
pub(crate) fn estimate(scene: &Scene, planned: &Planned) -> Result<Estimate, Failure> {
    let few = fewer(scene, planned.cloud.len());
    let (steps, frames) = march(scene);
    let small = few.as_ref().map_or(&planned.cloud, |(_, cloud)| cloud);
    let own = few.as_ref().map_or(scene, |(scene, _)| scene);
    let own = shortened(own);
    let ratio = planned.cloud.len() as f64 / small.len() as f64;
    let header = Header {
        kind: "point-fields".to_owned(),
        version: Version::new(1, 0),
        tool: "emfield".to_owned(),
        tool_version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: serde_json::Value::Null,
        inputs: std::collections::BTreeMap::new(),
    };
    let taken = trial(header, |session| assemble::solve(&own, small, session))?;
    let (taken_steps, taken_frames) = march(&own);
    let more = More {
        ratio,
        way: scene.solver.way,
        space: scene.geometry == Geometry::Space,
        steps: steps as f64 / taken_steps.max(1) as f64,
        grows: transient(scene).is_some_and(|t| t.adaptive.is_some()),
        frames: frames as f64 / taken_frames as f64,
        judged: assemble::far::judged(scene),
    };
    Ok(told(&taken, &more, planned, small.len(), steps))
}

/// The scene with fewer points and these, unless it has few or can have no fewer.
fn fewer(scene: &Scene, points: usize) -> Option<(Scene, Cloud)> {
    let many = |points: usize| points as f64 > MANY * FEW;
    let dimensions = scene.geometry.dimensions() as f64;
    let (mut least, mut most, mut now) = (1.0, setup::layout(scene).narrowest() / WIDTH, points);
    let mut found = None;
    for _ in 0..TRIES {
        if !many(now) {
            break;
        }
        // Layers keep their number: fewer points go than the spacing says.
        let by = (least * (now as f64 / FEW).powf(1.0 / dimensions)).min(most);
        if by < CLOSE * least {
            break;
        }
        let coarse = coarser(scene, by);
        match setup::cloud(&coarse) {
            Ok(cloud) => {
                (least, now) = (by, cloud.len());
                found = Some((coarse, cloud));
            }
            // A body is too small for so few.
            Err(_) => most = by.sqrt() * least.sqrt(),
        }
    }
    found
}

/// A scene with all spacings larger by a ratio.
fn coarser(scene: &Scene, by: f64) -> Scene {
    let mut coarse = scene.clone();
    let larger = |length: &mut Option<f64>| {
        if let Some(length) = length {
            *length *= by;
        }
    };
    let points = &mut coarse.points;
    points.spacing_m *= by;
    larger(&mut points.layers.first_m);
    if let Some(layers) = &mut points.wall_layers {
        larger(&mut layers.first_m);
    }
    larger(&mut points.largest_m);
    for finer in &mut points.refinements {
        finer.spacing_m *= by;
    }
    points.extra_m.clear();
    for body in &mut coarse.bodies {
        larger(&mut body.spacing_m);
    }
    coarse
}

/// A scene whose march has a few steps.
fn shortened(scene: &Scene) -> Scene {
    let mut short = scene.clone();
    let march = short.eddy_currents.as_mut();
    if let Some(transient) = march.and_then(|e| e.transient.as_mut()) {
        transient.end_s = transient.end_s.min(STEPS as f64 * transient.step_s);
        short.output.at_s.clear();
        short.output.every_s = None;
    }
    short
}

fn transient(scene: &Scene) -> Option<&Transient> {
    let march = scene.eddy_currents.as_ref();
    march.and_then(|e| e.transient.as_ref())
}

/// Steps and frames of the march of a scene; no step and one frame where there is none.
fn march(scene: &Scene) -> (u64, u64) {
    transient(scene).map_or((0, 1), |transient| {
        let steps = transient.steps(&scene.output);
        (steps.count(), 1 + steps.instants())
    })
}

/// How much more a run has than its trial.
struct More {
    /// Points.
    ratio: f64,
    way: Way,
    space: bool,
    steps: f64,
    /// Whether steps grow, so that it has fewer.
    grows: bool,
    frames: f64,
    /// Whether its far field is judged, as that of a trial with larger spacings may be.
    judged: bool,
}

impl More {
    /// How many times the seconds and the bytes of a stage.
    fn times(&self, stage: &str) -> (f64, f64) {
        // Fill and work of factors in nested dissection (George 1973); iterations with incomplete factors grow as the points
        // along an edge.
        let (work, fill, edge) = if self.space {
            (2.0, 4.0 / 3.0, 1.0 / 3.0)
        } else {
            (1.5, 1.1, 0.5)
        };
        let linear = self.ratio;
        let grown = |power: f64| self.ratio.powf(power);
        match (stage, self.way) {
            ("factorise", Way::Direct) => (grown(work), grown(fill)),
            ("solve", Way::Direct) => (grown(fill), linear),
            ("march", Way::Direct) => (self.steps * grown(fill), linear),
            ("solve", Way::Ilu0 | Way::Ilut) => (grown(1.0 + edge), linear),
            ("march", Way::Ilu0 | Way::Ilut) => (self.steps * grown(1.0 + edge), linear),
            ("march", _) => (self.steps * linear, linear),
            // Places that do not grow with the points.
            ("probes" | "enclosures", _) => (self.frames, 1.0),
            ("fields" | "write", _) => (self.frames * linear, linear),
            _ => (linear, linear),
        }
    }
}

fn told(taken: &Taken, more: &More, planned: &Planned, few: usize, steps: u64) -> Estimate {
    let once = |name: &str| more.judged || name != "far field";
    let seconds = |name: &str| match once(name) {
        true => taken.of(name).0 * more.times(name).0,
        false => 0.0,
    };
    let made = ["points", "scene", "plan"];
    let stages = taken.parts.iter().filter(|p| !made.contains(&&p.name[..]));
    let all: f64 = stages.map(|p| seconds(&p.name)).sum();
    // What a stage made may be let go of before another makes more.
    let kept: u64 = HELD.iter().map(|(_, stage)| taken.of(stage).1).sum();
    let share = (taken.most as f64 / kept.max(1) as f64).min(1.0);
    let held = |(name, stage): &(&'static str, &str)| {
        let bytes = taken.of(stage).1 as f64 * share * more.times(stage).1;
        (*name, bytes as u64)
    };
    let mut memory: Vec<(&'static str, u64)> = HELD.iter().map(held).collect();
    let rest = taken.most.saturating_sub(kept) as f64 * more.ratio;
    memory.push(("for a while", rest as u64));
    // The points are in the plan already.
    let program = taken.before.saturating_sub(planned.cloud.bytes());
    memory.push(("program", program));
    memory.retain(|m| m.1 > 0);
    let parts: Vec<String> = TOLD
        .iter()
        .filter(|(_, stage)| taken.of(stage).0 > 0.0)
        .map(|(name, stage)| format!("{name} {}", duration(seconds(stage))))
        .collect();
    let march = if steps > 0 {
        let most = if more.grows { " at most" } else { "" };
        format!(" and {} of {steps} steps{most}", steps.min(STEPS))
    } else {
        String::new()
    };
    Estimate {
        seconds: planned.seconds + all,
        basis: format!(
            "points {}, {}; from {few} points{march}, if iterations stay as many",
            duration(planned.seconds),
            parts.join(", ")
        ),
        memory,
    }
}
