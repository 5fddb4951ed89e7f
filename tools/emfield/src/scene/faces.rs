//! Flat faces between which a liquid moves.

use schemars::JsonSchema;
use serde::Deserialize;
use shapes::check::{self, Misfit};
use shapes::{Axis, Face, Shape};

use super::{Geometry, Liquid, Scene};
use crate::liquid::room::{Room, Side};

/// A wall to which the liquid sticks.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// The face that it is.
    pub face: Face,
    /// Velocity at which it slides along itself; at rest when it is absent.
    #[schemars(extend("x-unit" = "m/s"), length(min = 2, max = 3))]
    pub velocity_m_s: Option<Vec<f64>>,
}

/// What the faces of the box are that the liquid fills at the start. The one that is not named is the free surface: one at
/// most, across from a mirror or a wall and between mirrors or periodic faces.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Faces {
    /// Axes along which what leaves through one face enters through the other.
    #[serde(default)]
    pub periodic: Vec<Axis>,
    /// Planes of symmetry: nothing flows through them and nothing drags along them, as along walls on which the liquid slips.
    #[serde(default)]
    pub mirror: Vec<Face>,
    /// Walls to which the liquid sticks.
    #[serde(default)]
    pub wall: Vec<Wall>,
}

impl Faces {
    /// The room of a box with these faces.
    #[must_use]
    pub fn room<const D: usize>(&self, shape: &Shape) -> Room<D> {
        let mut room = Room::default();
        let Shape::Box(own) = shape else {
            return room;
        };
        room.min = std::array::from_fn(|k| own.min_m.get(k).copied().unwrap_or(0.0));
        room.max = std::array::from_fn(|k| own.max_m.get(k).copied().unwrap_or(0.0));
        for axis in &self.periodic {
            if let Some(sides) = room.sides.get_mut(axis.index()) {
                *sides = [Side::Periodic; 2];
            }
        }
        let walls = self.wall.iter().map(|wall| {
            let velocity = wall.velocity_m_s.as_deref().unwrap_or(&[]);
            let each = |k: usize| velocity.get(k).copied().unwrap_or(0.0);
            (wall.face, Side::Wall(std::array::from_fn(each)))
        });
        let mirrors = self.mirror.iter().map(|face| (*face, Side::Mirror));
        for (face, side) in mirrors.chain(walls) {
            let (axis, up) = face.side();
            if let Some(sides) = room.sides.get_mut(axis) {
                sides[usize::from(up)] = side;
            }
        }
        room
    }

    pub(super) fn check(&self, scene: &Scene, liquid: &Liquid, misfits: &mut Vec<Misfit>) {
        self.check_faces(scene, liquid, misfits);
        self.check_walls(scene.geometry.dimensions(), misfits);
        if !self.wall.is_empty() && liquid.viscosity_pa_s.is_none() {
            let what = "a liquid without viscosity sticks to nothing: take \"mirror\", or \"viscosity_pa_s\" of the liquid";
            misfits.push(Misfit::at("/liquid/faces/wall", what));
        }
        let absent = [
            (liquid.electric.is_some(), "electric"),
            (liquid.magnetic.is_some(), "magnetic"),
            (liquid.heat.is_some(), "heat"),
            (liquid.equilibrium.is_some(), "equilibrium"),
        ];
        for (_, key) in absent.iter().filter(|(given, _)| *given) {
            let what = format!("a liquid between faces has no \"{key}\" yet: leave it away");
            misfits.push(Misfit::at(&format!("/liquid/{key}"), what));
        }
    }

    /// Walls that slide.
    fn check_walls(&self, dimensions: usize, misfits: &mut Vec<Misfit>) {
        for (k, wall) in self.wall.iter().enumerate() {
            let Some(velocity) = &wall.velocity_m_s else {
                continue;
            };
            let at = format!("/liquid/faces/wall/{k}/velocity_m_s");
            check::coordinates(velocity, &at, dimensions, misfits);
            let across = velocity.get(wall.face.side().0);
            if across.is_some_and(|v| *v != 0.0) {
                let what = "a wall slides along itself: 0 is wanted across it";
                misfits.push(Misfit::at(&at, what));
            }
        }
    }

    /// Which faces are named, and how often.
    fn check_faces(&self, scene: &Scene, liquid: &Liquid, misfits: &mut Vec<Misfit>) {
        let dimensions = scene.geometry.dimensions();
        let mut at = |key: &str, what: String| {
            misfits.push(Misfit::at(&format!("/liquid/faces{key}"), what));
        };
        if scene.geometry == Geometry::Axisymmetric {
            let what = "faces stand in a plane or in space: take \"plane\" or \"space\"";
            at("", what.to_owned());
        }
        if !matches!(liquid.shape, Shape::Box(_)) {
            at(
                "",
                "are those of a box: take \"box\" as the shape".to_owned(),
            );
        }
        let mut seen = [[0; 2]; 3];
        for (k, axis) in self.periodic.iter().enumerate() {
            let axis = axis.index();
            if axis >= dimensions {
                at(
                    &format!("/periodic/{k}"),
                    format!("there are {dimensions} axes"),
                );
            }
            seen[axis] = seen[axis].map(|n| n + 1);
        }
        let mirrors = self.mirror.iter().enumerate();
        let mirrors = mirrors.map(|(k, face)| (format!("/mirror/{k}"), *face));
        let walls = self.wall.iter().enumerate();
        let walls = walls.map(|(k, wall)| (format!("/wall/{k}/face"), wall.face));
        for (key, face) in mirrors.chain(walls) {
            let (axis, up) = face.side();
            if axis >= dimensions {
                at(&key, format!("there are {dimensions} axes"));
            }
            seen[axis][usize::from(up)] += 1;
            if seen[axis][usize::from(up)] > 1 {
                at(&key, "the face has been named before".to_owned());
            }
        }
        let free: Vec<(usize, usize)> = (0..dimensions)
            .flat_map(|axis| [(axis, 0), (axis, 1)])
            .filter(|(axis, up)| seen[*axis][*up] == 0)
            .collect();
        if free.len() > 1 {
            let what = format!(
                "{} faces are not named: at most one can be the free surface",
                free.len()
            );
            at("", what);
        }
        if let [(axis, _)] = free[..] {
            let beside = self.wall.iter().position(|w| w.face.side().0 != axis);
            if let Some(k) = beside {
                let what = "the free surface cannot move along a wall to which the liquid sticks: take \"mirror\" for faces beside it";
                at(&format!("/wall/{k}/face"), what.to_owned());
            }
        }
    }
}
