//! What a scene says of the walls of electrostatics, and walls that stand for open space.

use run::property::{Arguments, Curve};
use run::{Failure, Fault};
use shapes::frame::{Vector, dot};

use super::region::walls;
use crate::electric::equations::Held;
use crate::scene::faults::PLACE;
use crate::scene::{Electrostatics, Scene};

/// An entry of the walls, ready to be evaluated.
struct Entry {
    /// Where its potential stands in the scene.
    at: String,
    faces: Option<Vec<usize>>,
    potential: Option<Curve>,
}

/// What a scene says of its walls.
pub(super) struct Walls<'a> {
    scene: &'a Scene,
    entries: Vec<Entry>,
    applied: Option<Vector>,
    /// Whether they stand for open space: the reaction of bodies adds to what is given.
    pub(super) open: bool,
}

impl<'a> Walls<'a> {
    pub(super) fn new(scene: &'a Scene, electrostatics: &Electrostatics) -> Result<Self, Failure> {
        let names = scene.domain.walls(scene.geometry);
        let mut entries = Vec::new();
        for (number, outer) in electrostatics.walls().iter().enumerate() {
            let at = format!("/electrostatics/outer/{number}/potential_v");
            let curve = outer.potential_v.as_ref().map(|p| p.compile(&at, &PLACE));
            let number = |name: &String| names.iter().position(|n| n == name);
            entries.push(Entry {
                at,
                faces: outer
                    .faces
                    .as_ref()
                    .map(|f| f.iter().filter_map(number).collect()),
                potential: curve.transpose()?,
            });
        }
        let applied = electrostatics.applied_field_v_m.as_ref();
        let applied = applied.map(|e| crate::cloud::region::vector(e));
        if entries.is_empty() && (applied.is_some() || electrostatics.open()) {
            let at = "/electrostatics/applied_potential_v";
            let curve = electrostatics.applied_potential_v.as_ref();
            let curve = curve.map(|p| p.compile(at, &PLACE)).transpose()?;
            entries.push(Entry {
                at: at.to_owned(),
                faces: None,
                potential: Some(curve.unwrap_or(Curve::Constant(0.0))),
            });
        }
        Ok(Self {
            scene,
            entries,
            applied,
            open: electrostatics.open(),
        })
    }

    fn names(entry: &Entry, wall: usize) -> bool {
        entry
            .faces
            .as_ref()
            .is_none_or(|faces| faces.contains(&wall))
    }

    /// Whether a wall lets no field through.
    pub(super) fn insulated(&self, wall: usize) -> bool {
        let entry = self.entries.iter().find(|e| Self::names(e, wall));
        entry.is_none_or(|e| e.potential.is_none())
    }

    /// What holds at a place in space on the walls: where several meet, a potential counts more than none.
    pub(super) fn held(&self, x: Vector) -> Result<Held, Failure> {
        let own = self.scene.geometry.coordinates(x);
        for wall in walls(self.scene, own) {
            let entry = self.entries.iter().find(|e| Self::names(e, wall));
            if let Some(value) = entry.and_then(|e| self.value(e, x)) {
                return Ok(Held::Potential(value?));
            }
        }
        Ok(Held::Insulated)
    }

    /// The potential of an entry at a place in space, that of the uniform field with it; none where nothing passes.
    fn value(&self, entry: &Entry, x: Vector) -> Option<Result<f64, Failure>> {
        let curve = entry.potential.as_ref()?;
        let uniform = self
            .applied
            .map_or(0.0, |e| dot(e, self.scene.geometry.coordinates(x)));
        Some(match curve.value(&Arguments::at(x, 0.0)) {
            Ok(value) => Ok(value - uniform),
            Err(error) => Err(Fault::at(&entry.at, error.to_string()).into()),
        })
    }

    /// The potential that is applied at a place in space, where walls are open \[V\].
    pub(super) fn applied(&self, x: Vector) -> Result<f64, Failure> {
        let value = self.entries.first().and_then(|e| self.value(e, x));
        value.unwrap_or(Ok(0.0))
    }
}
