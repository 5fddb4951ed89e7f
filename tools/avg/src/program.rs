//! The program: plan, run, record.

use std::time::Instant;

use artefact::{Reader, Version};
use run::{Estimate, Failure, Fault, Input, Inputs, Plan as Shown, Session, Tool};

use crate::assemble::{AverageError, Plan};
use crate::average::{Averages, Averaging};
use crate::fields;
use crate::heat_map::{HEAT_MAP, HeatMaps, Told};
use crate::resume;
use crate::scene::Scene;

/// Kind and major version of the frames that are averaged.
const FRAMES: (&str, u32) = ("particle-frames", 1);
/// Fewer droplets in a phase than this give no standard error.
const FEW_DROPLETS: usize = 2;

/// Averages of particle frames.
#[derive(Debug)]
pub struct Avg;

/// Frames and what is to be averaged of them.
#[derive(Debug)]
pub struct Ready {
    scene: Scene,
    reader: Reader,
    plan: Plan,
}

impl Tool for Avg {
    const NAME: &'static str = "avg";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const ABOUT: &'static str =
        "Averages particle frames over time and over equal phases of the droplet period.";
    const EXAMPLE: &'static str = "target/release/avg run pipelines/gmaw-300a/avg.json \
         --input frames=build/gmaw-300a/pool.mcap --out build/gmaw-300a/mean.mcap";
    const SCENE_KIND: &'static str = "avg.scene";
    const ARTEFACT_KIND: &'static str = "mean-fields";
    const ARTEFACT_VERSION: Version = Version::new(1, 4);
    const INPUTS: &'static [Input] = &[Input {
        name: "frames",
        what: "particle frames to average (particle-frames 1.x)",
        required: true,
    }];

    type Scene = Scene;
    type Ready = Ready;

    fn prepare(scene: Scene, inputs: Inputs) -> Result<Ready, Failure> {
        let faults = scene.faults();
        if !faults.is_empty() {
            let located = |(path, what): (String, String)| Fault::at(&path, what);
            return Err(faults.into_iter().map(located).collect::<Vec<_>>().into());
        }
        let reader = Reader::open_kind(inputs.path("frames")?, FRAMES.0, FRAMES.1)?;
        let plan = Plan::new(&scene, &reader).map_err(failure)?;
        Ok(Ready {
            scene,
            reader,
            plan,
        })
    }

    fn plan(ready: &Ready) -> Result<Shown, Failure> {
        Ok(shown(&ready.plan, &ready.scene))
    }

    fn estimate(ready: Ready) -> Result<Option<Estimate>, Failure> {
        let Ready { reader, plan, .. } = ready;
        let mut averaging = Averaging::new(&plan);
        if plan.frames.is_empty() {
            return Ok(None);
        }
        let began = Instant::now();
        let cloud = averaging.read(&reader, 0).map_err(failure)?;
        averaging.take(&cloud);
        let each = began.elapsed().as_secs_f64();
        Ok(Some(Estimate {
            seconds: each * plan.frames.len() as f64,
            basis: format!("{:.2} ms a frame, as the first", 1e3 * each),
            memory: Vec::new(),
        }))
    }

    fn run(ready: Ready, session: &mut Session) -> Result<(), Failure> {
        let Ready { reader, plan, .. } = ready;
        let mut averaging = Averaging::new(&plan);
        let total = plan.frames.len() as u64;
        let taken = match session.restored() {
            Some(mut checkpoint) => resume::restore(&mut checkpoint, &mut averaging)?,
            None => 0,
        };
        for done in taken..plan.frames.len() {
            let cloud = session.timed("read", || averaging.read(&reader, done));
            let cloud = cloud.map_err(failure)?;
            let map = session.timed("mean", || averaging.take(&cloud));
            told(session, &plan, map)?;
            session.progress(done as u64 + 1, total, || {
                vec![
                    ("time", cloud.time, "s"),
                    ("phase", cloud.phase as f64, "1"),
                ]
            });
            session.keep(|checkpoint| resume::save(checkpoint, &averaging, done + 1))?;
        }
        let maps = averaging.maps.take();
        if let Some(mut maps) = maps {
            told(session, &plan, maps.rest())?;
            mean_map(session, &plan, &maps)?;
        }
        let averages = averaging.finish();
        for (channel, time, table) in fields::tables(&plan, &averages) {
            session.table(&channel, time, &table)?;
        }
        close(session, &plan, &averages);
        Ok(())
    }
}

/// Writes a map of heat and what is told of its places.
fn told(session: &mut Session, plan: &Plan, map: Option<Told>) -> Result<(), Failure> {
    let Some((time, table, places)) = map else {
        return Ok(());
    };
    let table = fields::at_source(plan, table.in_precision(plan.precision));
    session.table(&format!("/{HEAT_MAP}"), time, &table)?;
    let mut places = places.iter();
    places.try_for_each(|(channel, record)| session.record(channel, time, record))
}

/// Writes the mean map and the heat of each way.
fn mean_map(session: &mut Session, plan: &Plan, maps: &HeatMaps) -> Result<(), Failure> {
    let Some(mean) = maps.mean() else {
        session.warn("heat_map: one frame is no interval, and there is no map".to_owned());
        return Ok(());
    };
    let mean = fields::at_source(plan, mean.in_precision(plan.precision));
    session.table(&format!("/{HEAT_MAP}/time_mean"), 0.0, &mean)?;
    for (way, heat) in maps.totals() {
        session.closing(&format!("map_{way}"), "J", heat);
    }
    for (way, heat) in maps.beyond() {
        session.closing(&format!("beyond_map_{way}"), "J", heat);
        session.note(format!(
            "{heat:.3e} J of {way} came to metal beyond the map: \"map_{way}\" is without it"
        ));
    }
    Ok(())
}

/// What the scene asked for and the frames do not hold is a fault of the scene.
fn failure(error: AverageError) -> Failure {
    let text = error.to_string();
    match error {
        AverageError::Artefact(e) => e.into(),
        AverageError::Landed => Fault::at("/landed", text).into(),
        AverageError::NoSpacing => Fault::at("", text).into(),
        AverageError::NoFrames { .. } => Fault::at("/time", text).into(),
        AverageError::TooMany { section, .. } => {
            Fault::at(&format!("/sections/{section}"), text).into()
        }
        AverageError::Rings { .. } => Fault::at("/profile/radius_m", text).into(),
        AverageError::Cells { .. } | AverageError::Untold { .. } => {
            Fault::at("/heat_map", text).into()
        }
        AverageError::NoSource { .. } => Failure::Other(text),
    }
}

fn shown(plan: &Plan, scene: &Scene) -> Shown {
    let points: usize = plan.sections.iter().map(crate::grid::Section::len).sum();
    let mut shown = Shown::new()
        .stage("read")
        .stage("mean")
        .count("frames", plan.frames.len() as u64)
        .count("phases", plan.phases as u64)
        .count("grid points", points as u64)
        .count("particles in a frame", plan.particles as u64)
        .column("velocity", "m/s")
        .memory("ensembles", plan.ensemble_bytes())
        .memory("one frame", plan.frame_bytes());
    for (channel, messages, bytes) in fields::volume(plan) {
        shown = shown.output(&channel, messages, bytes);
    }
    if plan.temperature {
        shown = shown.column("temperature", "K");
    } else {
        shown = shown.left_out("temperature", "the frames carry none");
    }
    match &plan.rings {
        Some(rings) => shown = shown.count("rings of the profile", rings.len() as u64),
        None => shown = shown.left_out("profile", "the scene names no 'profile'"),
    }
    match &plan.heat_maps {
        Some(maps) => {
            let [cells, places] = maps.size();
            shown = shown
                .count("cells of the heat map", cells as u64)
                .count("places of the heat map", places as u64);
        }
        None => shown = shown.left_out("heat map", "the scene names no 'heat_map'"),
    }
    if scene.follow.is_none() {
        shown = shown.left_out("moving frame of reference", "the scene names no 'follow'");
    }
    if scene.phases.is_none() {
        shown = shown.left_out("phases of the droplets", "the scene names no 'phases'");
    }
    shown
}

fn close(session: &mut Session, plan: &Plan, averages: &Averages) {
    for name in averages.empty(plan) {
        session.warn(format!(
            "no frame has metal in '{name}': look at its place and extent, which are in metres"
        ));
    }
    session.closing("frames", "1", plan.frames.len() as f64);
    if let (Some(rings), Some(profile)) = (&plan.rings, &averages.profile) {
        let [net, below] = profile.volumes(rings);
        session.closing("profile_net_volume", "m3", net);
        session.closing("profile_depression", "m3", below);
        if let Some(what) = profile.uncovered(rings) {
            session.warn(what);
        }
    }
    if let Some(period) = plan.period {
        session.closing("droplet_period", "s", period);
    }
    let Some(ensemble) = averages.ensembles.first() else {
        return;
    };
    let least = ensemble.frames.iter().min().copied().unwrap_or(0);
    if least == 0 {
        let empty = ensemble.frames.iter().filter(|n| **n == 0).count();
        session.warn(format!(
            "{empty} of {} phases have no frame: the frames were not written at these phases",
            plan.phases
        ));
    } else if plan.phases > 1 {
        alone(session, averages);
    } else if plan.parts.count < 2 {
        session.note("one frame: its means have no standard error");
    }
    if plan.phases > 1 {
        session.closing("frames_least_in_a_phase", "1", f64::from(least));
        session.closing("drops", "1", averages.drops.1 as f64);
    }
}

/// Tells phases whose means are of one droplet.
fn alone(session: &mut Session, averages: &Averages) {
    let droplets = averages.drops.0.iter();
    let alone = droplets.filter(|n| **n < FEW_DROPLETS).count();
    if alone > 0 {
        let phases = averages.drops.0.len();
        session.warn(format!(
            "{alone} of {phases} phases show one droplet only: their means have no standard error"
        ));
    }
}
