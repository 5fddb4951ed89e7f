//! From a scene to sets of particles and the list of stages: the only place that asks what a scene contains.

mod water;

use particles::{Matter, POSITION, Set};
use run::Fault;
use run::property::{Arguments, Property};

use crate::march::March;
use crate::matter::lattice::{Filling, Lattice};
use crate::matter::solid::bound::{self, Anchor, Load};
use crate::matter::solid::cell::Cell;
use crate::matter::solid::elastic::REST;
use crate::matter::solid::law::Law;
use crate::matter::solid::{Body, Elastic};
use crate::motion::gravity::Gravity;
use crate::motion::repulsion::{Repulsion, Wall};
use crate::scene::{RepulsionScene, Scene, Solid, WallScene};
use crate::stage::Stage;
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// A scene put together.
pub struct Assembled {
    /// All particles.
    pub state: State,
    /// All stages in the order of a step.
    pub march: March,
    /// Physics that the scene leaves out, and why.
    pub left_out: Vec<(&'static str, String)>,
}

/// Puts a scene together.
///
/// # Errors
/// Every fault that can be found at once.
pub fn assemble(scene: &Scene) -> Result<Assembled, Vec<Fault>> {
    let faults = scene.faults();
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut state = State::new(scene.dimensions);
    let mut stages: Vec<Box<dyn Stage>> = Vec::new();
    let mut faults = Vec::new();
    for (i, solid) in scene.solids.iter().enumerate() {
        match elastic(scene, solid, &mut state) {
            Ok(stage) => stages.push(stage),
            Err(fault) => faults.push(fault.within(&format!("/solids/{i}"))),
        }
    }
    let mut left_out = Vec::new();
    let mut last = Vec::new();
    if let Some(of) = &scene.water {
        match water::water(scene, of, &mut state) {
            Ok((stage, after)) => {
                stages.push(stage);
                last = after;
            }
            Err(fault) => faults.push(fault.within("/water")),
        }
    } else {
        left_out.push(("water", "no key 'water'".to_owned()));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    if let Some(gravity) = &scene.gravity_m_s2 {
        stages.push(Box::new(Gravity::new(vector(Some(gravity)))));
    }
    for wall in &scene.walls {
        if let Some(of) = &wall.repulsion {
            stages.push(repulsion(wall, of, &state));
        }
    }
    stages.append(&mut last);
    for stage in &stages {
        stage.declare(&mut state);
    }
    if scene.solids.len() == 1 {
        left_out.push(("contact", "one solid".to_owned()));
    }
    Ok(Assembled {
        state,
        march: March { stages },
        left_out,
    })
}

/// The stage of a wall that pushes.
fn repulsion(wall: &WallScene, of: &RepulsionScene, state: &State) -> Box<dyn Stage> {
    let law = |set: &Set| Repulsion {
        strength: of.strength_m2_s2,
        range: of.range_m.unwrap_or(set.matter.spacing),
        exponents: [of.exponent_near, of.exponent_far],
    };
    let body = shapes::Body::new(&wall.body, state.dimensions);
    let laws = state.sets.iter().map(law).collect();
    Box::new(Wall::new(wall.name.clone(), body, laws))
}

/// The particles of a solid and its stage.
fn elastic(scene: &Scene, solid: &Solid, state: &mut State) -> Result<Box<dyn Stage>, Fault> {
    let dimensions = scene.dimensions;
    let shape = shapes::Body::new(&solid.body, dimensions);
    let filling = Filling {
        spacing: solid.spacing_m,
        turned: solid
            .lattice
            .map_or(0.0, |lattice| lattice.turned_deg.to_radians()),
        jitter: solid.lattice.map_or(0.0, |lattice| lattice.jitter),
        dimensions,
    };
    let lattice = Lattice::fill(&shape, &filling).map_err(|what| Fault::at("/spacing_m", what))?;
    if lattice.places.is_empty() {
        return Err(Fault::at(
            "/body",
            format!(
                "holds no particle: too thin for a spacing of {} m",
                solid.spacing_m
            ),
        ));
    }
    let (anchors, loads) = bounds(solid, &shape, &lattice, dimensions)?;
    let plane = (dimensions == 2).then(|| scene.plane.unwrap_or_default());
    let cell = Cell::new(Law::new(&solid.elastic, plane), lattice.cell, dimensions);
    let body = Body {
        set: state.sets.len(),
        cell,
        size: lattice.cell,
        anchor_rest: anchors
            .iter()
            .map(|anchor| lattice.own(anchor.place))
            .collect(),
        anchors,
        loads,
        damping: solid.damping_1_s.unwrap_or(0.0),
    };
    let mut set = particles(solid, &lattice, state)?;
    set.column_mut(&MASS)
        .fill(solid.density_kg_m3 * cell.volume);
    let (stage, loose): (Box<dyn Stage>, Vec<usize>) = if dimensions == 2 {
        let (stage, loose) = Elastic::<2, 5>::new(body, &set);
        (Box::new(stage), loose)
    } else {
        let (stage, loose) = Elastic::<4, 9>::new(body, &set);
        (Box::new(stage), loose)
    };
    if let Some(a) = loose.first() {
        let what = format!(
            "{} m leaves {} particles with too few neighbours, the first at {}: the body wants 2 of them across at least",
            solid.spacing_m,
            loose.len(),
            crate::stage::place_text(lattice.places[*a])
        );
        return Err(Fault::at("/spacing_m", what));
    }
    state.sets.push(set);
    Ok(stage)
}

/// The particles of a solid with their places and velocities.
fn particles(solid: &Solid, lattice: &Lattice, state: &mut State) -> Result<Set, Fault> {
    let matter = Matter {
        density: solid.density_kg_m3,
        spacing: solid.spacing_m,
        smoothing_length: 1.5 * solid.spacing_m,
    };
    let mut set = Set::new(solid.name.clone(), matter);
    set.declare(&VELOCITY);
    set.declare(&ACCELERATION);
    set.declare(&MASS);
    set.declare(&REST);
    for place in &lattice.places {
        let row = set.push(&mut state.ids);
        set.column_mut(&POSITION)[row] = *place;
        set.column_mut(&REST)[row] = lattice.own(*place);
    }
    for (axis, property) in solid.velocity_m_s.iter().flatten().enumerate() {
        velocity(property, axis, &mut set)?;
    }
    Ok(set)
}

fn velocity(property: &Property, axis: usize, set: &mut Set) -> Result<(), Fault> {
    let at = format!("/velocity_m_s/{axis}");
    let curve = property.compile(&at, &["x", "y", "z", "r"])?;
    let places = set.column(&POSITION).to_vec();
    for (u, place) in set.column_mut(&VELOCITY).iter_mut().zip(places) {
        let value = curve.value(&Arguments::at(place, 0.0));
        u[axis] = value.map_err(|error| Fault::at(&at, error.to_string()))?;
    }
    Ok(())
}

/// Anchors and loads of a solid.
fn bounds(
    solid: &Solid,
    shape: &shapes::Body,
    lattice: &Lattice,
    dimensions: usize,
) -> Result<(Vec<Anchor>, Vec<Load>), Fault> {
    let (mut anchors, mut loads) = (Vec::new(), Vec::new());
    let next_to = |on: &[String], within: Option<&shapes::Shape>, at: &str| {
        let within = within.map(|shape| shapes::Body::new(shape, dimensions));
        let found = bound::next_to(shape, lattice, on, (within.as_ref(), dimensions));
        let found = found.map_err(|what| Fault::at(&format!("{at}/on"), what))?;
        if found.is_empty() {
            return Err(Fault::at(
                at,
                "no particle is next to this part of the surface",
            ));
        }
        Ok(found)
    };
    for (k, clamp) in solid.clamps.iter().enumerate() {
        let pieces = next_to(&clamp.on, clamp.within.as_ref(), &format!("/clamps/{k}"))?;
        anchors.extend(bound::anchors(
            &pieces,
            vector(clamp.velocity_m_s.as_deref()),
        ));
    }
    for (k, load) in solid.loads.iter().enumerate() {
        let pieces = next_to(&load.on, load.within.as_ref(), &format!("/loads/{k}"))?;
        loads.extend(bound::loads(
            &pieces,
            lattice,
            vector(Some(&load.traction_pa)),
        ));
    }
    Ok((anchors, loads))
}

/// Numbers of a scene as a vector.
fn vector(numbers: Option<&[f64]>) -> [f64; 3] {
    std::array::from_fn(|k| numbers.and_then(|n| n.get(k)).copied().unwrap_or(0.0))
}
