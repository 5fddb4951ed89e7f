//! A look before a run, read from an artefact of kind `preview`.

use std::path::Path;

use artefact::Reader;
use run::preview::{KIND, LOOK, Look, Mark, Marked, POINTS, VERSION};

/// What would be there.
#[derive(Debug, Clone)]
pub(crate) struct Preview {
    /// Title of the scene, where it has one.
    pub(crate) title: Option<String>,
    /// The program that would run.
    pub(crate) tool: String,
    /// Names and marks.
    pub(crate) look: Look,
    /// Places \[m\].
    pub(crate) place: Vec<[f64; 3]>,
    /// Extents \[m\].
    pub(crate) size: Vec<[f64; 3]>,
    /// Number of the material.
    pub(crate) material: Vec<u32>,
    /// Number of the condition; 0 without one.
    pub(crate) condition: Vec<u32>,
}

impl Preview {
    /// Reads the artefact.
    ///
    /// # Errors
    /// Another kind of file, or a damaged one.
    pub(crate) fn read(path: &Path) -> artefact::Result<Self> {
        let reader = Reader::open_sound(path, KIND, VERSION.major)?;
        let frame = reader.frame(POINTS, 0)?;
        let [x, y, z] = ["size_x", "size_y", "size_z"].map(|name| frame.f64(name));
        let (x, y, z) = (x?, y?, z?);
        let header = reader.header();
        Ok(Self {
            title: header.scene["title"].as_str().map(str::to_owned),
            tool: header.tool.clone(),
            look: reader.json_at(LOOK, 0)?,
            place: frame.position_vectors()?,
            size: (0..x.len()).map(|i| [x[i], y[i], z[i]]).collect(),
            material: frame.u32("material")?.to_vec(),
            condition: frame.u32("condition")?.to_vec(),
        })
    }

    /// The name of a material.
    pub(crate) fn material_name(&self, number: u32) -> &str {
        let names = &self.look.materials;
        names.get(number as usize).map_or("?", String::as_str)
    }

    /// The name of a condition above 0.
    pub(crate) fn condition_name(&self, number: u32) -> &str {
        let place = (number as usize).wrapping_sub(1);
        self.look.conditions.get(place).map_or("?", String::as_str)
    }

    /// The box around points, and around marks that are no wall \[m\]; none without either.
    pub(crate) fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let points = self.place.iter().zip(&self.size).map(|(x, size)| {
            [-0.5, 0.5].map(|side| std::array::from_fn(|k| x[k] + side * size[k]))
        });
        let marks = self.look.marks.iter().filter(|m| m.kind != Marked::Wall);
        let places = marks.flat_map(|mark| mark.lines_m.iter().flatten());
        let all = points.chain(places.map(|place| [*place, *place]));
        all.reduce(|[low, high]: [[f64; 3]; 2], [from, to]| {
            [
                std::array::from_fn(|k| low[k].min(from[k])),
                std::array::from_fn(|k| high[k].max(to[k])),
            ]
        })
    }

    /// The place that sections go through \[m\]: the start of the axis, or the middle of all.
    pub(crate) fn middle(&self) -> [f64; 3] {
        let axis = self.look.marks.iter().find(|m| m.kind == Marked::Axis);
        let start = axis.and_then(|mark| mark.lines_m.first()?.first());
        let [low, high] = self.bounds().unwrap_or_default();
        let middle = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
        start.copied().unwrap_or(middle)
    }

    /// Marks of a kind.
    pub(crate) fn marks(&self, kind: Marked) -> impl Iterator<Item = &Mark> {
        self.look.marks.iter().filter(move |mark| mark.kind == kind)
    }
}
