//! What is written: fields of points and surfaces, probes, lines, totals.

mod sample;

use artefact::{Frame, Record, Table};
use run::{Failure, Session};
use shapes::frame::{Vector, length};

pub use sample::Samples;

use crate::cloud::{Class, Cloud};
use crate::scene::Scene;

/// Values of a quantity at all points.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name; components of a vector end in `_x`, `_y`, `_z`.
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// One value per point; on interfaces that of the inner side.
    pub values: Vec<f64>,
    /// Values of the outer side of interfaces, one per surface point; empty where the quantity is continuous.
    pub beyond: Vec<f64>,
    /// It has no Laplacian inside any medium.
    pub harmonic: bool,
}

impl Column {
    /// The same, known to have no Laplacian inside any medium.
    #[must_use]
    pub fn without_laplacian(self) -> Self {
        Self {
            harmonic: true,
            ..self
        }
    }

    /// A continuous quantity.
    #[must_use]
    pub fn new(name: &str, unit: &'static str, values: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            unit,
            values,
            beyond: Vec::new(),
            harmonic: false,
        }
    }

    /// The components of a vector, with its values beyond interfaces if it jumps there.
    #[must_use]
    pub fn vector(
        name: &str,
        unit: &'static str,
        values: &[Vector],
        beyond: &[Vector],
    ) -> [Self; 3] {
        [('x', 0), ('y', 1), ('z', 2)].map(|(axis, k)| Self {
            name: format!("{name}_{axis}"),
            unit,
            values: values.iter().map(|v| v[k]).collect(),
            beyond: beyond.iter().map(|v| v[k]).collect(),
            harmonic: false,
        })
    }
}

/// What has been found at an instant.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// Quantities of all points.
    pub columns: Vec<Column>,
    /// Quantities of surface points.
    pub surface: Vec<Column>,
    /// Totals: name, unit, value.
    pub totals: Vec<(String, &'static str, f64)>,
    /// Forces known in several ways that disagree.
    pub doubts: Vec<Doubt>,
}

/// What to say of a force whose ways disagree.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubt {
    /// What the force acts on.
    pub of: String,
    /// How far the ways are apart, over the size of the force.
    pub share: f64,
    /// In words.
    pub what: String,
}

impl Found {
    /// Takes what another physics has found.
    pub fn join(&mut self, other: Self) {
        self.columns.extend(other.columns);
        self.surface.extend(other.surface);
        self.totals.extend(other.totals);
        self.doubts.extend(other.doubts);
    }
}

/// Writes everything of an instant.
///
/// # Errors
/// When a value is no number or the disk refuses.
pub fn write(
    scene: &Scene,
    cloud: &Cloud,
    samples: &Samples,
    time: f64,
    found: &Found,
    session: &mut Session,
) -> Result<(), Failure> {
    session.frame("/points", time, &points(scene, cloud, found))?;
    if scene.output.surface && !cloud.surface.is_empty() {
        session.frame("/surface", time, &surface(scene, cloud, found))?;
    }
    if !scene.output.probes.is_empty() {
        let mut record = Record::new();
        for (k, probe) in scene.output.probes.iter().enumerate() {
            for column in &found.columns {
                let name = format!("{}.{}", probe.name, column.name);
                record = record.with(&name, column.unit, samples.value(k, column));
            }
        }
        session.record("/probes", time, &record)?;
    }
    let mut first = scene.output.probes.len();
    for line in &scene.output.lines {
        let places = &samples.places[first..first + line.points];
        let along = places.iter().map(|x| {
            let d = shapes::frame::difference(*x, places[0]);
            length(d)
        });
        let mut table = Table::new(line.points).column("distance_m", "m", along);
        for (axis, k) in [('x', 0), ('y', 1), ('z', 2)] {
            table = table.column(&format!("{axis}_m"), "m", places.iter().map(|x| x[k]));
        }
        for column in &found.columns {
            let values = (0..line.points).map(|n| samples.value(first + n, column));
            table = table.column(&column.name, column.unit, values);
        }
        session.table(&format!("/line/{}", line.name), time, &table)?;
        first += line.points;
    }
    let mut record = Record::new();
    for (name, unit, value) in &found.totals {
        record = record.with(name, unit, *value);
        session.closing(name, unit, *value);
    }
    if !found.totals.is_empty() {
        session.record("/totals", time, &record)?;
    }
    Ok(())
}

fn frame(scene: &Scene) -> Frame {
    Frame::new(scene.output.precision.into())
}

/// Places, kinds and fields of all points.
fn points(scene: &Scene, cloud: &Cloud, found: &Found) -> Frame {
    let kind = |class: &Class| match class {
        Class::Inside(_) => 0,
        Class::Interface { .. } => 1,
        Class::Outer { .. } => 2,
    };
    let medium = |class: &Class| match class {
        Class::Inside(m) | Class::Outer { medium: m, .. } => *m,
        Class::Interface { inner, .. } => *inner,
    };
    let mut frame = frame(scene)
        .positions(cloud.position.iter().copied())
        .scalar("spacing", "m", cloud.spacing.iter().copied())
        .flag("kind", cloud.class.iter().map(kind));
    frame = media(frame, "medium", cloud.class.iter().map(medium));
    if scene.eddy_currents.is_some() {
        frame = frame.scalar(
            "volume",
            units(scene).1,
            cloud.cells.iter().map(|c| c.volume),
        );
    }
    for column in &found.columns {
        frame = frame.scalar(&column.name, column.unit, column.values.iter().copied());
    }
    frame
}

/// Adds a column of media, in a byte where their numbers fit.
fn media(frame: Frame, name: &str, of: impl Iterator<Item = u16> + Clone) -> Frame {
    let small: Result<Vec<u8>, _> = of.clone().map(u8::try_from).collect();
    match small {
        Ok(small) => frame.flag(name, small),
        Err(_) => frame.id(name, of.map(u32::from)),
    }
}

/// Units of area and volume: per metre of depth in a plane.
fn units(scene: &Scene) -> (&'static str, &'static str) {
    match scene.geometry {
        crate::geometry::Geometry::Plane => ("m", "m2"),
        _ => ("m2", "m3"),
    }
}

/// Places, normals and what acts on the surfaces of bodies.
fn surface(scene: &Scene, cloud: &Cloud, found: &Found) -> Frame {
    let places = cloud
        .surface
        .iter()
        .map(|s| cloud.position[s.point as usize]);
    let mut frame = frame(scene)
        .positions(places)
        .vector("normal", "1", cloud.surface.iter().map(|s| s.normal))
        .scalar("area", units(scene).0, cloud.surface.iter().map(|s| s.area))
        .id("point", cloud.surface.iter().map(|s| s.point));
    frame = media(frame, "inner", cloud.surface.iter().map(|s| s.inner));
    frame = media(frame, "outer", cloud.surface.iter().map(|s| s.outer));
    for column in &found.surface {
        frame = frame.scalar(&column.name, column.unit, column.values.iter().copied());
    }
    frame
}
