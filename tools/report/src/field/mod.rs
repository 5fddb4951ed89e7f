//! Points with electric and magnetic fields, as the last frame of a run shows them.

pub(crate) mod columns;
pub(crate) mod exact;
pub(crate) mod plane;
pub(crate) mod scene;

use artefact::Reader;

use columns::Columns;
use scene::Scene;

/// Channel of all points.
const POINTS: &str = "/points";
/// Channel of the points on interfaces.
const SURFACE: &str = "/surface";
/// Begin of the names of channels of lines.
const LINE: &str = "/line/";

/// What a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Within a medium.
    Inside,
    /// Where two media meet.
    Interface,
    /// On a wall of the domain.
    Wall,
}

/// A point where two media meet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Meeting {
    /// Its number among all points.
    pub(crate) point: usize,
    /// Media on both sides; the normal points from the first to the second.
    pub(crate) media: [u8; 2],
    /// Unit normal.
    pub(crate) normal: [f64; 3],
}

/// The points of a frame.
#[derive(Debug, Clone)]
pub(crate) struct Points {
    /// Simulated time \[s\].
    pub(crate) time: f64,
    /// Places \[m\].
    pub(crate) position: Vec<[f64; 3]>,
    /// Distance of neighbours \[m\].
    pub(crate) spacing: Vec<f64>,
    /// What each is.
    pub(crate) kind: Vec<Kind>,
    /// Medium of each; on interfaces the inner one.
    pub(crate) medium: Vec<u8>,
    /// Fields of all points; on interfaces those of the inner side.
    pub(crate) columns: Columns,
    /// Points on interfaces.
    pub(crate) meetings: Vec<Meeting>,
    /// Fields of points on interfaces.
    pub(crate) surface: Columns,
    /// What the scene says.
    pub(crate) scene: Scene,
}

impl Points {
    /// The last frame of the artefact; `None` when it has none, or no point in it.
    ///
    /// # Errors
    /// When a message cannot be read or a column is absent.
    pub(crate) fn last(reader: &Reader) -> artefact::Result<Option<Self>> {
        let Some(index) = reader.count(POINTS).checked_sub(1) else {
            return Ok(None);
        };
        let frame = reader.frame(POINTS, index)?;
        if frame.is_empty() {
            return Ok(None);
        }
        let kind = |k: &u8| match k {
            0 => Kind::Inside,
            1 => Kind::Interface,
            _ => Kind::Wall,
        };
        let position = frame.position_vectors()?;
        let (meetings, surface) = meetings(reader, position.len())?;
        Ok(Some(Self {
            time: frame.time_s,
            position,
            spacing: frame.f64("spacing")?,
            kind: frame.u8("kind")?.iter().map(kind).collect(),
            medium: frame.u8("medium")?.to_vec(),
            columns: Columns::of_frame(&frame),
            meetings,
            surface,
            scene: Scene::of(&reader.header().scene),
        }))
    }
}

/// Where media meet, of so many points.
fn meetings(reader: &Reader, count: usize) -> artefact::Result<(Vec<Meeting>, Columns)> {
    let Some(index) = reader.count(SURFACE).checked_sub(1) else {
        return Ok((Vec::new(), Columns::default()));
    };
    let frame = reader.frame(SURFACE, index)?;
    let points = frame.u32("point")?;
    if let Some(what) = unknown(points, count) {
        return Err(artefact::Error::Message {
            path: reader.path().to_path_buf(),
            channel: SURFACE.to_owned(),
            index,
            what,
        });
    }
    let (inner, outer) = (frame.u8("inner")?, frame.u8("outer")?);
    let normals = frame.vectors("normal")?;
    let one = |n: usize| Meeting {
        point: points[n] as usize,
        media: [inner[n], outer[n]],
        normal: normals[n],
    };
    let all = (0..points.len()).map(one).collect();
    Ok((all, Columns::of_frame(&frame)))
}

/// What is wrong with numbers of points, of which there are so many.
fn unknown(points: &[u32], count: usize) -> Option<String> {
    let beyond = points.iter().find(|point| **point as usize >= count)?;
    Some(format!(
        "point {beyond} is none of the {count} of '{POINTS}'"
    ))
}

/// Fields along the lines of a run at its end, by name in the order of the scene.
///
/// # Errors
/// When a table cannot be read.
pub(crate) fn lines(reader: &Reader, scene: &Scene) -> artefact::Result<Vec<(String, Columns)>> {
    let mut found = Vec::new();
    for name in &scene.lines {
        let channel = format!("{LINE}{name}");
        if let Some(last) = reader.count(&channel).checked_sub(1) {
            let table = reader.table_at(&channel, last)?;
            found.push((name.clone(), Columns::of_table(&table)));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_names_points_that_there_are() {
        assert_eq!(unknown(&[0, 600], 601), None);
        let told = unknown(&[3, 65307], 601).unwrap();
        assert!(told.contains("65307") && told.contains("601"), "{told}");
    }
}
