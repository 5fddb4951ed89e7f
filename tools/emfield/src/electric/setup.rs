//! From a scene to what its electrostatics has given: permittivities, electrodes and walls; and what is wrong with these.

use run::property::{Arguments, Curve};
use run::{Failure, Fault, Session};
use shapes::Body;
use shapes::frame::{Vector, dot};

use super::equations::{Held, Problem};
use super::open::walls::AT;
use super::solution::{self, Given};
use crate::cloud::layout::vector;
use crate::cloud::{Class, Cloud};
use crate::frames::Found;
use crate::scene::faults::PLACE;
use crate::scene::{Electrostatics, Interfaces, Scene};
use crate::solve::Numerics;
use crate::stencils::setup::{region, walls};
use crate::surface::enclosing::Enclosing;
use crate::surface::halfway::halfway;

/// Gap over spacing below which electrodes count as touching: far less than points can resolve.
const TOUCH: f64 = 0.03;
/// Potentials whose difference is this part of theirs are the same.
const SAME: f64 = 1e-9;

/// Solves the electrostatics of a scene in `D` coordinates; `around` are surfaces through which forces are wanted.
///
/// # Errors
/// Where a stencil cannot be made, a formula has no value, or the solve breaks down.
pub(crate) fn electrostatics<const D: usize>(
    scene: &Scene,
    electrostatics: &Electrostatics,
    cloud: &Cloud,
    numerics: Numerics,
    around: Vec<Enclosing>,
    session: &mut Session,
) -> Result<Found, Failure> {
    let walls = Walls::new(cloud, electrostatics)?;
    let region = region::<D>(scene, cloud, &|wall| walls.insulated(wall)).straight();
    let applied = |x| walls.applied(x);
    let given = Given {
        problem: problem(scene, cloud, &walls)?,
        smeared: matches!(scene.method.interfaces, Interfaces::Smeared(_)),
        numerics,
        applied: walls.open.then_some(&applied),
    };
    solution::found(cloud, &region, &given, around, session)
}

/// What is given where.
fn problem(scene: &Scene, cloud: &Cloud, outer: &Walls<'_>) -> Result<Problem, Failure> {
    let mut held = vec![None; cloud.len()];
    for (i, held) in held.iter_mut().enumerate() {
        if let Class::Outer { .. } = cloud.class[i] {
            *held = Some(outer.held(cloud.position[i])?);
        }
    }
    Ok(Problem {
        permittivity: (0..cloud.media.len())
            .map(|m| scene.medium(m).relative_permittivity)
            .collect(),
        electrodes: std::iter::once(None)
            .chain(scene.bodies.iter().map(|b| b.potential_v))
            .collect(),
        held,
    })
}

/// An entry of the walls, ready to be evaluated.
struct Entry {
    /// Where its potential stands in the scene.
    at: String,
    faces: Option<Vec<usize>>,
    potential: Option<Curve>,
}

/// What a scene says of its walls.
struct Walls<'a> {
    cloud: &'a Cloud,
    entries: Vec<Entry>,
    applied: Option<Vector>,
    /// Whether they stand for open space: the reaction of bodies adds to what is given.
    open: bool,
}

impl<'a> Walls<'a> {
    fn new(cloud: &'a Cloud, electrostatics: &Electrostatics) -> Result<Self, Failure> {
        let names = &cloud.faces;
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
        let applied = applied.map(|e| vector(e));
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
            cloud,
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
    fn insulated(&self, wall: usize) -> bool {
        let entry = self.entries.iter().find(|e| Self::names(e, wall));
        entry.is_none_or(|e| e.potential.is_none())
    }

    /// What holds at a place in space on the walls: where several meet, a potential counts more than none.
    fn held(&self, x: Vector) -> Result<Held, Failure> {
        let own = self.cloud.geometry.coordinates(x);
        for wall in walls(self.cloud, own) {
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
            .map_or(0.0, |e| dot(e, self.cloud.geometry.coordinates(x)));
        Some(match curve.value(&Arguments::at(x, 0.0)) {
            Ok(value) => Ok(value - uniform),
            Err(error) => Err(Fault::at(&entry.at, error.to_string()).into()),
        })
    }

    /// The potential that is applied at a place in space, where walls are open \[V\].
    fn applied(&self, x: Vector) -> Result<f64, Failure> {
        let value = self.entries.first().and_then(|e| self.value(e, x));
        value.unwrap_or(Ok(0.0))
    }
}

/// Refuses electrodes that touch walls or each other at different potentials.
///
/// # Errors
/// The short circuits, each with its place; what a potential of a wall cannot tell.
pub(crate) fn shorts(
    scene: &Scene,
    electrostatics: &Electrostatics,
    cloud: &Cloud,
) -> Result<(), Failure> {
    let dimensions = scene.geometry.dimensions();
    let electrodes: Vec<(usize, f64, Body)> = scene
        .bodies
        .iter()
        .enumerate()
        .filter_map(|(k, b)| Some((k, b.potential_v?, Body::new(&b.shape, dimensions))))
        .collect();
    if electrodes.is_empty() {
        return Ok(());
    }
    let walls = Walls::new(cloud, electrostatics)?;
    let mut faults: Vec<Option<Fault>> = vec![None; scene.bodies.len()];
    for (i, x) in cloud.position.iter().enumerate() {
        let own = scene.geometry.coordinates(*x);
        let touching = electrodes
            .iter()
            .filter(|(.., body)| body.distance(own) < TOUCH * cloud.spacing[i]);
        let (given, name) = match cloud.class[i] {
            // Nothing is held there.
            Class::Outer { .. } if walls.open => continue,
            Class::Outer { face, .. } => match walls.held(*x)? {
                Held::Potential(v) => {
                    let name = cloud.faces[face as usize];
                    (v, format!("the wall {name}"))
                }
                Held::Insulated => continue,
            },
            Class::Interface { inner, .. } => match electrode(scene, inner) {
                Some((v, name)) => (v, format!("the electrode {name}")),
                None => continue,
            },
            Class::Inside(_) => continue,
        };
        for (k, v, _) in touching {
            if (v - given).abs() > SAME * v.abs().max(given.abs()) {
                faults[*k].get_or_insert_with(|| short(*k, *v, given, &name, *x));
            }
        }
    }
    let faults: Vec<Fault> = faults.into_iter().flatten().collect();
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults.into())
    }
}

/// Potential and name of a medium that is an electrode.
fn electrode(scene: &Scene, medium: u16) -> Option<(f64, &str)> {
    let body = &scene.bodies[(medium as usize).checked_sub(1)?];
    Some((body.potential_v?, &body.name))
}

fn short(k: usize, own: f64, other: f64, name: &str, [x, y, z]: Vector) -> Fault {
    let what = format!(
        "{own} V touches {name} at {other} V at ({x:.3e}, {y:.3e}, {z:.3e}) m, a short circuit: give both one potential, or leave a gap of more than {TOUCH} spacings"
    );
    Fault::at(&format!("/bodies/{k}/potential_v"), what)
}

/// Refuses bodies that reach a wall that is open, or leave no room before it.
///
/// # Errors
/// The body or the room.
pub(crate) fn room(electrostatics: &Electrostatics, cloud: &Cloud) -> Result<(), Fault> {
    if !electrostatics.open() || cloud.surface.is_empty() {
        return Ok(());
    }
    for (class, [x, y, z]) in cloud.class.iter().zip(&cloud.position) {
        if let Class::Outer { medium, face } = class
            && *medium > 0
        {
            let wall = cloud.faces[*face as usize];
            let name = &cloud.media[*medium as usize];
            let what = format!(
                "{name} touches the wall {wall} at ({x:.3e}, {y:.3e}, {z:.3e}) m: multipoles hold beyond all bodies; leave room, or give the potentials of the walls"
            );
            return Err(Fault::at(AT, what));
        }
    }
    let (_, room) = halfway(cloud);
    let spacing = cloud.pitch;
    if room < spacing {
        let what = format!(
            "bodies come as near as {:.3e} m to the walls, and the surface between them over which multipoles are counted wants room for two spacings of {spacing:.3e} m: move the walls away, or take finer points",
            2.0 * room
        );
        return Err(Fault::at(AT, what));
    }
    Ok(())
}
