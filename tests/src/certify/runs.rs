//! The points of a plan: cheap ones first, within a budget, taken up again where they were left.
//!
//! Each stage of a point is made through `pipelines/rerun`, which makes nothing twice and goes on from a checkpoint. A stage
//! that a knob does not reach is the base's. What would not end within the budget, by the power law of the times of its own
//! series, is not begun; what runs out of it is interrupted, writes its checkpoint, and ends in the next call.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::figures::{self, Reading};
use super::plan::{Plan, Series, Stage};
pub use super::point::Point;
use crate::lab::{Lab, LabError, read_json};

/// A point to be run.
struct Wanted<'a> {
    name: String,
    knob: Option<(&'a str, &'a str)>,
    size: Option<f64>,
    base: f64,
    /// Power of the size by which the time goes, until the series tells better.
    power: f64,
    patch: Value,
}

/// A cube of points times as many steps.
const SPACING_POWER: f64 = -4.0;
/// As many steps.
const STEP_POWER: f64 = -1.0;
/// A tolerance: steps of an order of two or so, or iterations that gain a digit each few.
const TOLERANCE_POWER: f64 = -0.5;

/// Runs what the budget allows; the base is always run.
///
/// # Errors
/// When the base fails, or a program cannot be started.
pub fn run(lab: &Lab, plan: &Plan, budget: Duration) -> Result<Vec<Point>, LabError> {
    let begin = Instant::now();
    let mut wanted = wanted(plan);
    // Coarse before fine: a series' own times then tell what its next point would take.
    wanted[1..].sort_by(|a, b| ease(b).total_cmp(&ease(a)));
    let mut done: Vec<Point> = Vec::new();
    for point in &wanted {
        let left = budget.saturating_sub(begin.elapsed());
        let expected = expected(&done, point);
        let made = is_made(lab, plan, point);
        let patient = point.knob.is_none() || made;
        if !patient && expected.is_some_and(|s| s > left.as_secs_f64()) {
            let words = format!(
                "it would take some {:.0} s, and {:.0} s of the budget are left",
                expected.unwrap_or(0.0),
                left.as_secs_f64()
            );
            done.push(point.left_out(words));
            continue;
        }
        eprintln_progress(&point.name, expected);
        let limit = if patient { None } else { Some(left) };
        match one(lab, plan, point, limit) {
            Ok(mut finished) => {
                if let Some(base) = done.first() {
                    finished.keep_what_is_as_in(base);
                }
                done.push(finished);
            }
            Err(error) if point.knob.is_some() => done.push(point.left_out(error.to_string())),
            Err(error) => return Err(error),
        }
    }
    Ok(done)
}

#[allow(clippy::print_stderr, reason = "long work tells where it is")]
fn eprintln_progress(name: &str, expected: Option<f64>) {
    match expected {
        Some(s) => eprintln!("certify: {name}, some {s:.0} s"),
        None => eprintln!("certify: {name}"),
    }
}

/// Names of all runs of a plan.
#[must_use]
pub fn names(plan: &Plan) -> Vec<String> {
    wanted(plan).into_iter().map(|point| point.name).collect()
}

/// The base and every point of every knob.
fn wanted(plan: &Plan) -> Vec<Wanted<'_>> {
    let mut all = vec![Wanted {
        name: "base".to_owned(),
        knob: None,
        size: None,
        base: 1.0,
        power: 0.0,
        patch: Value::Null,
    }];
    for knob in &plan.knobs {
        let own = (knob.name.as_str(), knob.stage.as_str());
        match &knob.series {
            Series::Refined {
                base, points, unit, ..
            } => all.extend(points.iter().map(|p| Wanted {
                name: format!("{}-{}", knob.name, p.size),
                knob: Some(own),
                size: Some(p.size),
                base: *base,
                power: match unit.as_str() {
                    "s" => STEP_POWER,
                    "m" => SPACING_POWER,
                    _ => TOLERANCE_POWER,
                },
                patch: p.patch.clone(),
            })),
            Series::Varied { patches } => {
                all.extend(patches.iter().enumerate().map(|(i, patch)| Wanted {
                    name: format!("{}-{}", knob.name, i + 1),
                    knob: Some(own),
                    size: None,
                    base: 1.0,
                    power: 0.0,
                    patch: patch.clone(),
                }));
            }
        }
    }
    all
}

/// Coarser than the base is easy, finer is hard.
fn ease(point: &Wanted<'_>) -> f64 {
    point.size.map_or(1.0, |size| size / point.base)
}

/// What a point would take, by the times of its series, the base among them \[s\].
fn expected(done: &[Point], point: &Wanted<'_>) -> Option<f64> {
    let base = done.first()?.run_time_s?;
    let (Some(size), Some((knob, _))) = (point.size, point.knob) else {
        return Some(base);
    };
    let ratio = size / point.base;
    let mut told: Vec<(f64, f64)> = vec![(1.0, base)];
    for other in done.iter().filter(|p| p.knob.as_deref() == Some(knob)) {
        if let (Some(size), Some(time)) = (other.size, other.run_time_s) {
            told.push((size / point.base, time));
        }
    }
    let power = match told.as_slice() {
        [_] => point.power,
        [(a, s), .., (b, t)] => ((t / s).ln() / (b / a).ln()).clamp(-6.0, 0.0),
        [] => 0.0,
    };
    Some(base * ratio.powf(power))
}

impl Wanted<'_> {
    fn left_out(&self, why: String) -> Point {
        Point {
            name: self.name.clone(),
            knob: self.knob.map(|(name, _)| name.to_owned()),
            size: self.size,
            patch: self.patch.clone(),
            figures: BTreeMap::new(),
            run_time_s: None,
            processor_s: None,
            peak_memory_bytes: None,
            points: None,
            missing: Some(why),
            warnings: Vec::new(),
            scenes: BTreeMap::new(),
            frozen: BTreeMap::new(),
        }
    }

    /// Whether the patch reaches a stage: the stage itself, or one that reads from it.
    fn reaches(&self, plan: &Plan, stage: &Stage) -> bool {
        let Some((_, turned)) = self.knob else {
            return true;
        };
        plan.reaches(turned, &stage.name)
    }
}

/// Where the artefact of a stage of a point is, or will be.
fn place(lab: &Lab, plan: &Plan, point: &Wanted<'_>, stage: &Stage) -> PathBuf {
    if let Some(made) = made_by_study(lab, plan, point, stage) {
        return made;
    }
    let name = if point.reaches(plan, stage) {
        point.name.as_str()
    } else {
        "base"
    };
    lab.out
        .join(&plan.study)
        .join(name)
        .join(format!("{}.mcap", stage.name))
}

/// What the study itself has made of a stage that no knob reaches.
fn made_by_study(lab: &Lab, plan: &Plan, point: &Wanted<'_>, stage: &Stage) -> Option<PathBuf> {
    let base = point.knob.is_none() || !point.reaches(plan, stage);
    let made = lab.root.join(stage.made.as_ref().filter(|_| base)?);
    made.is_file().then_some(made)
}

fn is_made(lab: &Lab, plan: &Plan, point: &Wanted<'_>) -> bool {
    plan.stages
        .iter()
        .all(|s| place(lab, plan, point, s).is_file())
}

/// Makes one point and reads its figures.
fn one(
    lab: &Lab,
    plan: &Plan,
    point: &Wanted<'_>,
    limit: Option<Duration>,
) -> Result<Point, LabError> {
    let begin = Instant::now();
    let mut found = point.left_out(String::new());
    found.missing = None;
    let (mut time, mut work, mut memory) = (0.0, Some(0.0), None);
    for stage in plan.stages.iter().filter(|s| point.reaches(plan, s)) {
        let left = limit.map(|l| l.saturating_sub(begin.elapsed()));
        let record = make(lab, plan, point, stage, left)?;
        time += record["wall_s"].as_f64().unwrap_or(0.0);
        work = work.zip(record["processor_s"].as_f64()).map(|(a, b)| a + b);
        memory = memory.max(record["peak_memory_bytes"].as_u64());
        found.points = record["points"].as_u64().or(record["particles"].as_u64());
        if let Some(hash) = record["scene_hash"].as_str() {
            found.scenes.insert(stage.name.clone(), hash.to_owned());
        }
        let warnings = record["warnings"].as_array().into_iter().flatten();
        let words = warnings.filter_map(Value::as_str);
        (found.warnings).extend(words.map(|w| format!("{}: {w}", stage.name)));
    }
    for figure in &plan.figures {
        let stage = plan.stages.iter().find(|s| s.name == figure.stage);
        let Some(stage) = stage else { continue };
        match figures::read(lab, figure, &place(lab, plan, point, stage)) {
            Ok(Reading { value, frozen }) => {
                found.figures.insert(figure.name.clone(), value);
                found
                    .frozen
                    .extend(frozen.map(|frozen| (figure.name.clone(), frozen)));
            }
            // A coarse run may not have what the study has: a block that is never in two.
            Err(LabError::Content { what, .. }) if point.knob.is_some() => {
                found.warnings.push(format!("no {}: {what}", figure.name));
            }
            Err(error) => return Err(error),
        }
    }
    found.run_time_s = Some(time);
    found.processor_s = work;
    found.peak_memory_bytes = memory;
    Ok(found)
}

/// Makes the artefact of a stage where it is not made yet; its run record.
fn make(
    lab: &Lab,
    plan: &Plan,
    point: &Wanted<'_>,
    stage: &Stage,
    left: Option<Duration>,
) -> Result<Value, LabError> {
    let out = place(lab, plan, point, stage);
    if made_by_study(lab, plan, point, stage).is_some() {
        return read_json(&out.with_extension("run.json"));
    }
    let line = Line::of(lab, plan, point, stage)?;
    let program = lab.programs.join(&stage.tool);
    let mut command = Command::new(lab.root.join("pipelines/rerun"));
    command
        .current_dir(&lab.root)
        .arg(&out)
        .arg(&program)
        .args(&line.reads)
        .arg("--");
    if let Some(left) = left {
        // An interrupted stage writes its checkpoint.
        command.args(["timeout", "--signal=INT", "--kill-after=60"]);
        command.arg(format!("{}", left.as_secs().max(1)));
    }
    command.arg(&program).args(&line.words);
    command.arg("--out").arg(&out);
    let threads = lab.threads.to_string();
    command.args(["--threads", &threads, "--progress", "none", "-q"]);
    let output = command.output().map_err(io(&program))?;
    if !output.status.success() {
        return Err(LabError::Tool {
            command: format!("{} {}", program.display(), line.words.join(" ")),
            code: output.status.code(),
            stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
        });
    }
    read_json(&out.with_extension("run.json"))
}

/// What a stage of a point is told, and the files that it reads.
struct Line {
    words: Vec<String>,
    reads: Vec<PathBuf>,
}

impl Line {
    /// Scene, patches and inputs; the patch of the point is written beside its output.
    fn of(lab: &Lab, plan: &Plan, point: &Wanted<'_>, stage: &Stage) -> Result<Self, LabError> {
        let out = place(lab, plan, point, stage);
        let folder = out.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder).map_err(io(folder))?;
        let mut patches: Vec<PathBuf> = stage.patches.iter().map(PathBuf::from).collect();
        if point.knob.is_some_and(|(_, turned)| turned == stage.name) {
            let patch = folder.join(format!("{}.patch.json", stage.name));
            std::fs::write(&patch, point.patch.to_string()).map_err(io(&patch))?;
            patches.push(patch);
        }
        let mut words: Vec<String> = vec!["run".into(), stage.scene.clone()];
        let mut reads: Vec<PathBuf> = vec![lab.root.join(&stage.scene)];
        for patch in patches {
            words.extend(["--patch".to_owned(), patch.display().to_string()]);
            reads.push(patch);
        }
        for input in &stage.inputs {
            let of = input.stage.as_deref();
            let file = match plan.stages.iter().find(|s| Some(s.name.as_str()) == of) {
                Some(earlier) => place(lab, plan, point, earlier),
                None => PathBuf::from(input.file.clone().unwrap_or_default()),
            };
            let named = format!("{}={}", input.name, file.display());
            words.extend(["--input".to_owned(), named]);
            reads.push(file);
        }
        Ok(Self { words, reads })
    }
}

fn io(path: &Path) -> impl FnOnce(std::io::Error) -> LabError {
    let path = path.to_owned();
    move |source| LabError::Io { path, source }
}
