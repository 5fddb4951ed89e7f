//! The coordinates of a weld: across it, along it, and up from the surface that its plate had.
//!
//! ```text
//! across = x t_y - y t_x,   along = x t_x + y t_y,   up = z - top
//! ```
//!
//! with t the level direction of welding. A weld along +y on a plate whose surface is z = 0 has the coordinates of its scene. The
//! direction is that of the source (`/plate`). Where no source moves (`/source`) it is that of the torches of the scene, from the first
//! corner of their path to the last.

use artefact::Reader;
use serde::Deserialize;
use serde_json::Value;

use super::Plate;

/// Part of a spacing by which paths may lie beside each other and be one line.
const SAME: f64 = 1.0;

/// Where the source is.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(crate) struct Source {
    x_m: f64,
    y_m: f64,
}

impl Source {
    /// Its place on the surface of the plate, as the scene has it \[m\].
    pub(crate) fn place(self) -> [f64; 2] {
        [self.x_m, self.y_m]
    }

    /// At the last moment of its channel that is not after `time`.
    ///
    /// # Errors
    /// When the channel cannot be read.
    pub(crate) fn at(reader: &Reader, time: f64) -> artefact::Result<Option<Self>> {
        if !reader.has("/source") {
            return Ok(None);
        }
        let times = reader.times("/source")?;
        let after = times.partition_point(|t| *t <= time + 1e-9);
        match after.checked_sub(1) {
            Some(index) => reader.json_at("/source", index).map(Some),
            None => Ok(None),
        }
    }
}

impl Source {
    /// Whether it has gone anywhere by the last of its moments.
    fn moves(reader: &Reader) -> artefact::Result<bool> {
        let Some(last) = reader.count("/source").checked_sub(1) else {
            return Ok(false);
        };
        let [from, to] = [0, last].map(|index| reader.json_at::<Self>("/source", index));
        let ([x, y], [u, v]) = (from?.place(), to?.place());
        Ok((u - x).hypot(v - y) > 0.0)
    }
}

/// The coordinates of a weld.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Way {
    /// Direction of welding in the plane x, y; a unit vector.
    along: [f64; 2],
    /// Height of the original surface \[m\].
    top: f64,
    /// Where the line of the torches lies across the weld \[m\]; none without torches, or where they go along several lines.
    line: Option<f64>,
    /// How far a torch strays from its line \[m\], where that is more than a spacing.
    strays: Option<f64>,
}

impl Default for Way {
    /// Along +y on the surface z = 0.
    fn default() -> Self {
        Self {
            along: [0.0, 1.0],
            top: 0.0,
            line: None,
            strays: None,
        }
    }
}

impl Way {
    /// The coordinates of the weld in a file.
    ///
    /// # Errors
    /// When the source cannot be read.
    pub(crate) fn of(reader: &Reader, plate: &Plate) -> artefact::Result<Self> {
        let torches = match Source::moves(reader)? {
            true => Vec::new(),
            false => torches(&reader.header().scene),
        };
        Ok(Self::new(plate, &torches))
    }

    /// Of a plate, and the paths of torches where these alone heat it.
    fn new(plate: &Plate, torches: &[Vec<[f64; 2]>]) -> Self {
        let told = plate.direction.and_then(|[x, y, _]| unit([x, y]));
        let moved = torches.iter().find_map(|path| direction(path));
        let along = moved.or(told).unwrap_or([0.0, 1.0]);
        let mut way = Self {
            along,
            top: plate.max_m.map_or(0.0, |corner| corner[2]),
            ..Self::default()
        };
        let same = SAME * plate.spacing_m;
        let lines = torches.iter().map(|path| path[0]);
        let lines: Vec<f64> = lines.map(|at| way.across(at)).collect();
        way.line = (lines.first().copied())
            .filter(|first| lines.iter().all(|line| (line - first).abs() <= same));
        let off = |path: &Vec<[f64; 2]>| {
            let from = way.across(path[0]);
            let away = path.iter().map(move |at| (way.across(*at) - from).abs());
            away.fold(0.0, f64::max)
        };
        way.strays = Some(torches.iter().map(off).fold(0.0, f64::max)).filter(|off| *off > same);
        way
    }

    /// Turns a place of the scene into across, along and up \[m\].
    pub(crate) fn turn(&self, at: &mut [f64; 3]) {
        let [x, y, z] = *at;
        if !self.is_y() {
            at[0] = self.across([x, y]);
            at[1] = self.along([x, y]);
        }
        at[2] = z - self.top;
    }

    /// Distance to the right of the line through the origin \[m\].
    pub(crate) fn across(&self, [x, y]: [f64; 2]) -> f64 {
        match self.is_y() {
            true => x,
            false => x * self.along[1] - y * self.along[0],
        }
    }

    /// Distance along the weld from the origin \[m\].
    pub(crate) fn along(&self, [x, y]: [f64; 2]) -> f64 {
        match self.is_y() {
            true => y,
            false => x * self.along[0] + y * self.along[1],
        }
    }

    /// Height of the plate's surface in the scene \[m\].
    pub(crate) fn top(&self) -> f64 {
        self.top
    }

    /// Where the line of the torches lies across the weld \[m\].
    pub(crate) fn line(&self) -> Option<f64> {
        self.line
    }

    /// How far a torch strays from its line \[m\], where that is more than a spacing.
    pub(crate) fn strays(&self) -> Option<f64> {
        self.strays
    }

    /// Whether the weld runs along +y, so that across is x and along is y.
    pub(crate) fn is_y(&self) -> bool {
        let [x, y] = self.along;
        x.abs() <= 0.0 && y > 0.0
    }

    /// Whether the weld runs in the plane x = const.
    pub(crate) fn in_plane(&self) -> bool {
        self.along[0].abs() <= f64::EPSILON
    }
}

/// The paths of the torches of a scene, seen from above; of their corners those that have coordinates.
fn torches(scene: &Value) -> Vec<Vec<[f64; 2]>> {
    let torches = scene.get("torches").and_then(Value::as_array);
    let path = |torch: &Value| {
        let points = torch.pointer("/path/points_m")?.as_array()?;
        let at = |p: &Value| Some([p.get(0)?.as_f64()?, p.get(1)?.as_f64()?]);
        let path: Vec<_> = points.iter().filter_map(at).collect();
        (!path.is_empty()).then_some(path)
    };
    torches.into_iter().flatten().filter_map(path).collect()
}

/// From the first corner of a path to the last; of one that comes back to its start, along its first leg.
fn direction(path: &[[f64; 2]]) -> Option<[f64; 2]> {
    let first = path.first()?;
    let from = |to: &[f64; 2]| unit([to[0] - first[0], to[1] - first[1]]);
    path.last()
        .and_then(from)
        .or_else(|| path.iter().find_map(from))
}

fn unit([x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let size = x.hypot(y);
    (size > 0.0 && size.is_finite()).then(|| [x / size, y / size])
}
