//! From the scene to stages and particles: the only place that asks what the scene contains.

use std::ops::Range;
use std::sync::Arc;

use run::property::Curve;
use run::{Failure, Fault, Inputs};

use crate::domain::bodies::{self, Body, Filled};
use crate::frames::{Layout, PlateNote};
use crate::heat::{self, Caloric, Conduction};
use crate::march::March;
use crate::motion::Motion;
use crate::scene::{Scene, StartState};
use crate::stage::Stage;
use crate::state::{Column, State};

/// Physics that a scene does not have, and what says so.
pub type LeftOut = Vec<(&'static str, String)>;

/// A run ready to start.
pub struct Assembled {
    /// Stages in order.
    pub march: March,
    /// Particles at time 0.
    pub state: State,
    /// What the frames hold.
    pub layout: Layout,
    /// The base metal.
    pub plate: PlateNote,
    /// How the bodies came out, in the order of the scene.
    pub filled: Vec<Filled>,
    /// Physics that is absent.
    pub left_out: LeftOut,
}

/// Stages ahead of the gathering of the moving particles, and after it.
struct Parts {
    before: Vec<Box<dyn Stage>>,
    after: Vec<Box<dyn Stage>>,
    left_out: LeftOut,
}

impl Parts {
    fn leave_out(&mut self, key: &'static str) {
        self.left_out.push((key, format!("no key '{key}'")));
    }

    /// Takes a stage if its key is there, and notes it as left out if not.
    fn when<P>(
        &mut self,
        key: &'static str,
        part: Option<P>,
        make: impl FnOnce(P) -> Box<dyn Stage>,
    ) {
        match part {
            Some(part) => self.after.push(make(part)),
            None => self.leave_out(key),
        }
    }
}

/// Checks the scene and makes the run.
///
/// # Errors
/// Every fault of the scene at once; an input that cannot be read.
pub fn assemble(scene: &Scene, _inputs: &Inputs) -> Result<Assembled, Failure> {
    let mut faults = crate::scene::faults(scene);
    let bodies = checked_bodies(scene, &mut faults);
    if !faults.is_empty() {
        return Err(Failure::Scene(faults));
    }
    let heat = Heat::of(scene)?;
    // The particles come before the stages, which hold the temperature of some; the columns come
    // from stages that know nothing of particles.
    let columns = columns(&stages(scene, heat.as_ref(), Vec::new())?);
    let mut state = State::new(scene.metal(), columns);
    let caloric = heat.as_ref().map(|heat| heat.caloric.as_ref());
    let filled = bodies::fill(&mut state, &bodies, caloric)?;
    let parts = stages(scene, heat.as_ref(), held(&bodies, &filled))?;
    state.flowing = scene.flow_start.is_none();
    Ok(Assembled {
        march: March::new(parts.before, parts.after, scene.time.step_s),
        layout: Layout {
            width: scene.output.precision,
            walls: state.wall.contains(&true),
            surface: false,
        },
        plate: plate(scene, heat.as_ref()),
        state,
        filled,
        left_out: parts.left_out,
    })
}

/// Heat as the scene has it.
struct Heat<'a> {
    parameters: &'a heat::Parameters,
    caloric: Arc<Caloric>,
}

impl<'a> Heat<'a> {
    fn of(scene: &'a Scene) -> Result<Option<Self>, Fault> {
        let Some(parameters) = &scene.heat else {
            return Ok(None);
        };
        let caloric = parameters
            .caloric()
            .map_err(|fault| fault.within("/heat"))?;
        Ok(Some(Self {
            parameters,
            caloric,
        }))
    }
}

/// Particles with a temperature that they keep.
type Held = Vec<(Range<usize>, Curve)>;

fn held(bodies: &[Body], filled: &[Filled]) -> Held {
    let mut first = 0;
    let mut held = Vec::new();
    for (body, filled) in bodies.iter().zip(filled) {
        let range = first..first + filled.placed;
        first = range.end;
        held.extend(body.held.clone().map(|curve| (range, curve)));
    }
    held
}

/// The stages in the order of a step (Komen 2019, fig. 3.16).
fn stages(scene: &Scene, heat: Option<&Heat>, held: Held) -> Result<Parts, Fault> {
    let metal = scene.metal();
    let mut parts = Parts {
        before: Vec::new(),
        after: Vec::new(),
        left_out: Vec::new(),
    };
    match heat {
        None => parts.leave_out("heat"),
        Some(Heat {
            parameters,
            caloric,
        }) => {
            let mut conduction = Conduction::new(parameters, caloric.clone(), metal)
                .map_err(|fault| fault.within("/heat"))?;
            for (particles, curve) in held {
                conduction.hold(particles, curve);
            }
            parts.after.push(Box::new(conduction));
            let phase = heat::Phase::new(caloric.clone(), scene.flow_start);
            parts.after.push(Box::new(phase));
        }
    }
    parts.when("flow", scene.flow, |flow| {
        Box::new(Motion::new(flow, metal))
    });
    Ok(parts)
}

/// Optional columns of all stages.
fn columns(parts: &Parts) -> Vec<Column> {
    let stages = parts.before.iter().chain(&parts.after);
    stages
        .flat_map(|stage| stage.needs().iter().copied())
        .collect()
}

fn checked_bodies(scene: &Scene, faults: &mut Vec<Fault>) -> Vec<Body> {
    let mut bodies = Vec::with_capacity(scene.bodies.len());
    for (i, body) in scene.bodies.iter().enumerate() {
        match body.body(&format!("/bodies/{i}"), scene.heat.is_some()) {
            Ok(body) => bodies.push(body),
            Err(fault) => faults.push(fault),
        }
    }
    bodies
}

/// The first solid body is the base metal; without one, the first body of any kind stands for it.
fn plate(scene: &Scene, heat: Option<&Heat>) -> PlateNote {
    let solid = scene.bodies.iter().find(|b| b.state == StartState::Solid);
    let bounds = solid.or(scene.bodies.first()).map(|b| b.shape.bounds());
    let (min_m, max_m) = bounds.unwrap_or_default();
    PlateNote {
        min_m,
        max_m,
        spacing_m: scene.spacing_m,
        particle_volume_m3: scene.spacing_m.powi(3),
        melting_point_k: heat.and_then(|heat| heat.caloric.melting_point()),
        direction: [0.0, 1.0, 0.0],
    }
}
