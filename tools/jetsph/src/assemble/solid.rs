//! The solids of a scene: their sets, stages and contacts.

use kernels::CubicSpline;
use particles::{Matter, POSITION, Set};
use run::Fault;
use run::property::{Arguments, Property};

use crate::matter::lattice::{Filling, Lattice};
use crate::matter::meeting::contact::{Contact, Party};
use crate::matter::meeting::faces::Cells;
use crate::matter::shares::shares;
use crate::matter::solid::bound::{self, Anchor, Load};
use crate::matter::solid::cell::Cell;
use crate::matter::solid::elastic::REST;
use crate::matter::solid::law::Law;
use crate::matter::solid::shocks::{ShockViscosity, Shocks};
use crate::matter::solid::tensor::Matrix;
use crate::matter::solid::updated::{Hooke, Updated};
use crate::matter::solid::{Body, Elastic};
use crate::matter::water::friction::{Artificial, BothWays};
use crate::scene::{Scene, Solid, UpdatedForm};
use crate::stage::Stage;
use crate::state::{ACCELERATION, MASS, State, VELOCITY};

/// h over d of a solid.
const SMOOTHING: f64 = 1.5;

/// What others need to know of a solid.
pub(super) struct Made {
    /// Number of its set.
    pub(super) set: usize,
    /// Size of its cells \[m\].
    pub(super) size: [f64; 3],
    /// Stiffness of a cell under compression, M V/d^2 \[N/m\].
    stiffness: f64,
    /// How deep its particles lie below its surface at rest \[m\]; none where it can break.
    depths: Vec<f64>,
    /// Speed of its compression waves \[m/s\].
    sound: f64,
    /// Whether it has the updated form: water sees its particles as they stand.
    pub(super) is_updated: bool,
    /// Its cells where there is water that presses on their faces.
    pub(super) cells: Option<Cells>,
}

/// All solids with their stages; what cannot be made is told.
pub(super) fn solids(
    scene: &Scene,
    state: &mut State,
    faults: &mut Vec<Fault>,
) -> (Vec<Made>, Vec<Box<dyn Stage>>) {
    let (mut solids, mut stages) = (Vec::new(), Vec::new());
    for (i, of) in scene.solids.iter().enumerate() {
        match solid(scene, of, state) {
            Ok((stage, made)) => {
                if let Some(of) = &of.artificial_viscosity {
                    stages.push(shocks(of, &made, state));
                }
                stages.push(stage);
                solids.push(made);
            }
            Err(fault) => faults.push(fault.within(&format!("/solids/{i}"))),
        }
    }
    (solids, stages)
}

/// The particles of a solid and its stage.
fn solid(scene: &Scene, solid: &Solid, state: &mut State) -> Result<(Box<dyn Stage>, Made), Fault> {
    let dimensions = scene.dimensions;
    let (shape, lattice) = filled(solid, dimensions)?;
    let (anchors, loads) = bounds(solid, &shape, &lattice, dimensions)?;
    let plane = (dimensions == 2).then(|| scene.plane.unwrap_or_default());
    let cell = Cell::new(Law::new(&solid.elastic, plane), lattice.cell, dimensions);
    let body = Body {
        set: state.sets.len(),
        cell,
        size: lattice.cell,
        shares: shares(&shape, &lattice, dimensions),
        anchor_rest: anchors
            .iter()
            .map(|anchor| lattice.own(anchor.place))
            .collect(),
        anchors,
        loads,
        damping: solid.damping_1_s.unwrap_or(0.0),
    };
    let mut set = particles(solid, &lattice, state)?;
    for (a, mass) in set.column_mut(&MASS).iter_mut().enumerate() {
        *mass = solid.density_kg_m3 * cell.volume * body.share(a);
    }
    let (stage, loose) = if let Some(form) = solid.updated_form {
        (
            updated(solid, form, &lattice, state.sets.len(), dimensions),
            Vec::new(),
        )
    } else if dimensions == 2 {
        staged::<2, 5>(body, &set, solid, &lattice)
    } else {
        staged::<4, 9>(body, &set, solid, &lattice)
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
    let depth = |x: &[f64; 3]| (-shape.distance(*x)).max(0.0);
    let depths = match solid.fracture {
        None => lattice.places.iter().map(depth).collect(),
        Some(_) => Vec::new(),
    };
    let modulus = cell.law.lame + 2.0 * cell.law.shear;
    let spacing = spacing(lattice.cell, dimensions);
    let made = Made {
        set: state.sets.len(),
        size: lattice.cell,
        stiffness: modulus * cell.volume / (spacing * spacing),
        depths,
        sound: cell.law.wave_speed(solid.density_kg_m3),
        is_updated: solid.updated_form.is_some(),
        cells: (scene.water.is_some() && solid.updated_form.is_none())
            .then(|| Cells::new(lattice.cell, lattice.cells, dimensions)),
    };
    state.sets.push(set);
    Ok((stage, made))
}

/// The shape of a solid and its lattice.
pub(super) fn filled(solid: &Solid, dimensions: usize) -> Result<(shapes::Body, Lattice), Fault> {
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
    Ok((shape, lattice))
}

/// The stage of an elastic solid, and the particles that too few neighbours hold.
fn staged<const L: usize, const T: usize>(
    body: Body,
    set: &Set,
    solid: &Solid,
    lattice: &Lattice,
) -> (Box<dyn Stage>, Vec<usize>) {
    let (stage, loose) = Elastic::<L, T>::new(body, set);
    let stage = match solid.plasticity {
        Some(law) => stage.flowing(law),
        None => stage,
    };
    let stage = match solid.fracture {
        Some(criterion) => {
            let middles = lattice.middles(if T == 5 { 2 } else { 3 });
            let stage = stage.breaking(criterion, set, &middles, axes(lattice));
            match solid.fracture_length_m {
                Some(length) => stage.breaking_over(length, &middles),
                None => stage,
            }
        }
        None => stage,
    };
    (Box::new(stage), loose)
}

/// The stage of an elastic solid in the updated form.
fn updated(
    solid: &Solid,
    form: UpdatedForm,
    lattice: &Lattice,
    set: usize,
    dimensions: usize,
) -> Box<dyn Stage> {
    let (bulk, shear) = solid.elastic.moduli();
    let spacing = spacing(lattice.cell, dimensions);
    let law = Hooke {
        density: solid.density_kg_m3,
        bulk,
        shear,
        artificial: form.artificial_stress,
        spacing,
    };
    let h = SMOOTHING * spacing;
    if dimensions == 2 {
        Box::new(Updated::<2, _>::new(set, law, CubicSpline::<2>::new(h)))
    } else {
        Box::new(Updated::<3, _>::new(set, law, CubicSpline::<3>::new(h)))
    }
}

/// Axes of the lattice, as columns: the deformation of a body at rest.
fn axes(lattice: &Lattice) -> Matrix {
    let [x, y, z] =
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| lattice.frame.turn(e));
    [0, 1, 2].map(|k| [x[k], y[k], z[k]])
}

/// The size of a cell \[m\].
fn spacing(size: [f64; 3], dimensions: usize) -> f64 {
    size[..dimensions]
        .iter()
        .product::<f64>()
        .powf(1.0 / dimensions as f64)
}

/// Whether solids can touch anything but themselves as they are.
pub(super) fn touches(scene: &Scene) -> bool {
    let plain = scene.walls.iter().any(|wall| wall.repulsion.is_none());
    let breaks = scene.solids.iter().any(|solid| solid.fracture.is_some());
    !scene.solids.is_empty() && (plain || breaks || scene.solids.len() > 1)
}

/// The stage of contacts.
pub(super) fn contact(scene: &Scene, solids: &[Made]) -> Box<dyn Stage> {
    let party = |made: &Made| Party {
        set: made.set,
        spacing: spacing(made.size, scene.dimensions),
        stiffness: made.stiffness,
        depths: made.depths.clone(),
    };
    let damping = scene.contact.map_or(0.0, |contact| contact.damping);
    let walls = super::plain_walls(&scene.walls, scene.dimensions);
    Box::new(Contact::new(
        solids.iter().map(party).collect(),
        walls,
        damping,
    ))
}

/// The stage of a solid's artificial viscosity.
fn shocks(of: &ShockViscosity, made: &Made, state: &State) -> Box<dyn Stage> {
    let set = &state.sets[made.set];
    let h = SMOOTHING * spacing(made.size, state.dimensions);
    let artificial = Artificial::new(&of.terms(), set.matter.density, made.sound, h);
    let tension = of.in_tension.then_some(BothWays(artificial));
    let (plane, space) = (CubicSpline::<2>::new(h), CubicSpline::<3>::new(h));
    match (state.dimensions, tension) {
        (2, None) => Box::new(Shocks::new(made.set, set, artificial, artificial, plane)),
        (2, Some(both)) => Box::new(Shocks::new(made.set, set, artificial, both, plane)),
        (_, None) => Box::new(Shocks::new(made.set, set, artificial, artificial, space)),
        (_, Some(both)) => Box::new(Shocks::new(made.set, set, artificial, both, space)),
    }
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
        let found = bound::next_to(shape, lattice, on, within.as_ref(), dimensions);
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
            super::vector(clamp.velocity_m_s.as_deref()),
        ));
    }
    for (k, load) in solid.loads.iter().enumerate() {
        let pieces = next_to(&load.on, load.within.as_ref(), &format!("/loads/{k}"))?;
        let (along, pressure) = (super::vector(load.traction_pa.as_deref()), load.pressure_pa);
        let traction = |normal: [f64; 3]| match pressure {
            Some(p) => normal.map(|n| -p * n),
            None => along,
        };
        let rise = load.rise_s.unwrap_or(0.0);
        loads.extend(bound::loads(&pieces, lattice, traction, rise));
    }
    Ok((anchors, loads))
}
