//! `report calculix`: temperatures of a run at the nodes of a mesh, as steps of CalculiX.
//!
//! The temperatures that a weld or a body had are handed over to a program that computes stresses and distortion, as its
//! prescribed temperatures: one step for each frame, over which it goes from one to the next linearly.

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use artefact::{Reader, must_not_be_read};
use run::Failure;
use serde_json::Value;

use super::field::Field;
use super::mesh::{Node, nodes};
use crate::draw::axes::number;
use crate::files::{CalculixFiles, print, save};
use crate::heat::{POINTS, Points};
use crate::mirror::Mirror;
use crate::moments;
use crate::weld::{PARTICLES, Plate, Weld};

/// Temperatures that change by less are not written again \[K\].
const SAME: f64 = 1e-3;

/// Writes the temperatures of the start, and the steps.
pub(crate) fn run(files: &CalculixFiles) -> Result<ExitCode, Failure> {
    let reader = Reader::open(&files.frames)?;
    reader.must_be_known()?;
    let mesh = std::fs::read_to_string(&files.mesh).map_err(|source| Failure::Io {
        path: files.mesh.clone(),
        action: "read",
        source,
    })?;
    let told = |what: String| Failure::Usage(format!("{}: {what}", files.mesh.display()));
    let nodes = nodes(&mesh, files.unit_m).map_err(told)?;
    let course = Course::new(&reader, nodes, files)?;
    for (part, text) in [("start", &course.start), ("steps", &course.steps)] {
        let out = path(&files.out, part);
        let read = [
            ("the mesh".to_owned(), files.mesh.as_path()),
            ("the frames".to_owned(), files.frames.as_path()),
        ];
        must_not_be_read(&out, read)?;
        save(&out, text)?;
    }
    print(&course.told(files))?;
    Ok(match course.outside() {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::from(3),
    })
}

/// The temperatures of all nodes over time, as CalculiX reads them.
struct Course {
    nodes: Vec<Node>,
    /// What each node has been given \[K\].
    shown: Vec<f64>,
    /// Nodes that some frame has no metal at.
    bare: Vec<bool>,
    /// The least temperature of the start \[K\].
    least: f64,
    /// What temperatures are counted from \[K\].
    off: f64,
    start: String,
    steps: String,
    count: usize,
}

impl Course {
    fn new(reader: &Reader, nodes: Vec<Node>, files: &CalculixFiles) -> Result<Self, Failure> {
        let (channel, spacing) = source(reader)?;
        let coldest = reader.frame(channel, 0)?.f64("temperature")?;
        let mut course = Self {
            shown: vec![f64::NAN; nodes.len()],
            bare: vec![false; nodes.len()],
            least: coldest.into_iter().fold(f64::INFINITY, f64::min),
            off: if files.celsius { 273.15 } else { 0.0 },
            start: String::new(),
            steps: String::new(),
            count: 0,
            nodes,
        };
        let mirror = Mirror::read(reader)?;
        let mut last = 0.0;
        for index in moments::every(reader.count(channel), files.every as usize) {
            let frame = reader.frame(channel, index)?;
            let (mut places, mut values) = (frame.position_vectors()?, frame.f64("temperature")?);
            let body = body(reader, channel, index)?;
            keep(&mut places, body.as_deref());
            keep(&mut values, body.as_deref());
            if let Some(mirror) = mirror {
                mirror.places(&mut places);
                mirror.values(&mut values);
            }
            let changed = course.changed(&Field::new(&places, &values, spacing));
            if index == 0 {
                let head = "*INITIAL CONDITIONS, TYPE=TEMPERATURE";
                course.start = format!("** {}: the start\n{head}\n{changed}", title(reader));
            } else {
                course.step(frame.time_s, frame.time_s - last, &changed);
            }
            last = frame.time_s;
        }
        if course.count == 0 {
            let what = "has one frame: a course of temperature needs two or more";
            return Err(Failure::Usage(format!(
                "{}: {what}",
                files.frames.display()
            )));
        }
        Ok(course)
    }

    /// A step to a time, of a length \[s\].
    fn step(&mut self, time: f64, length: f64, changed: &str) {
        let out = &mut self.steps;
        let _ = writeln!(
            out,
            "** to {time} s\n*STEP, INC=1000\n*STATIC\n{length}, {length}"
        );
        if !changed.is_empty() {
            let _ = write!(out, "*TEMPERATURE\n{changed}");
        }
        // What is asked for in a step is given in those after it too.
        if self.count == 0 {
            out.push_str("*NODE FILE\nU, NT\n*EL FILE\nS, E\n");
        }
        out.push_str("*END STEP\n");
        self.count += 1;
    }

    /// The temperatures that a frame changes.
    fn changed(&mut self, field: &Field<'_>) -> String {
        let mut out = String::new();
        for (k, node) in self.nodes.iter().enumerate() {
            let found = field.at(node.place);
            self.bare[k] |= found.is_none();
            let before = self.shown[k];
            let first = before.is_nan();
            let value = found.unwrap_or(if first { self.least } else { before });
            if first || (value - before).abs() > SAME {
                let _ = writeln!(out, "{}, {:.3}", node.number, value - self.off);
                self.shown[k] = value;
            }
        }
        out
    }

    fn outside(&self) -> usize {
        self.bare.iter().filter(|bare| **bare).count()
    }

    fn told(&self, files: &CalculixFiles) -> String {
        let [start, steps] = ["start", "steps"].map(|part| path(&files.out, part));
        let mut told = format!(
            "{} nodes, {} steps: include {} before the first step, and {} after it\n",
            self.nodes.len(),
            self.count,
            start.display(),
            steps.display()
        );
        if self.outside() > 0 {
            let _ = writeln!(
                told,
                "warning: {} of {} nodes lie in no metal in some frame: they keep what they had, and {} at the start",
                self.outside(),
                self.nodes.len(),
                number(self.least - self.off)
            );
        }
        told
    }
}

/// Which points of a frame belong to the body: of a weld neither walls nor spatter nor drops on their way; all where nothing tells.
fn body(reader: &Reader, channel: &str, index: usize) -> Result<Option<Vec<bool>>, Failure> {
    let frame = reader.frame(channel, index)?;
    if channel != PARTICLES || !frame.has("molten") {
        return Ok(None);
    }
    let weld = Weld::read(reader, index)?;
    let mut body = vec![false; frame.len()];
    for (own, row) in weld.row.iter().enumerate() {
        body[*row] |= weld.belongs(own);
    }
    Ok(Some(body))
}

fn keep<T>(all: &mut Vec<T>, body: Option<&[bool]>) {
    if let Some(body) = body {
        let mut of = body.iter();
        all.retain(|_| of.next() == Some(&true));
    }
}

/// The channel of points with temperatures, and their spacing \[m\].
fn source(reader: &Reader) -> Result<(&'static str, f64), Failure> {
    let path = reader.path().display();
    let with = |what: &str| Failure::Usage(format!("{path}: {what}"));
    let channel = [PARTICLES, POINTS]
        .into_iter()
        .find(|c| reader.count(c) > 0);
    let channel = channel.ok_or_else(|| with("has neither /particles nor /points"))?;
    if !reader.frame(channel, 0)?.has("temperature") {
        return Err(with("its points have no temperature"));
    }
    let spacing = match channel {
        PARTICLES => reader.json_at::<Plate>("/plate", 0)?.spacing_m,
        _ => Points::last(reader)?.map_or(0.0, |points| points.spacing()),
    };
    match spacing > 0.0 {
        true => Ok((channel, spacing)),
        false => Err(with("the spacing of its points is not known")),
    }
}

fn title(reader: &Reader) -> String {
    let title = reader.header().scene.get("title").and_then(Value::as_str);
    title
        .unwrap_or("a run")
        .lines()
        .next()
        .unwrap_or_default()
        .to_owned()
}

fn path(out: &Path, part: &str) -> std::path::PathBuf {
    let name = out.file_stem().unwrap_or_default().to_string_lossy();
    out.with_file_name(format!("{name}-{part}.inp"))
}
