//! From the scene to stages and particles: the only place that asks what the scene contains.

mod arcs;
mod grains;
mod metal;
mod parts;
pub mod preview;

use std::ops::Range;
use std::sync::Arc;

use run::property::Curve;
use run::{Failure, Fault, Inputs};
use shapes::frame::unit;

use self::arcs::Arcs;
use self::grains::Beside;
pub use self::parts::LeftOut;
use self::parts::{Parts, Room};
use crate::domain::bodies::{Body, Filled};
use crate::domain::bounds::Bounds;
use crate::domain::droplet::{Droplets, Wire};
use crate::domain::fitting::{along_heat_faces, fitting};
use crate::faces::{self, Faces};
use crate::forces::arc_pressure::ArcPressure;
use crate::forces::buoyancy::Buoyancy;
use crate::forces::capillary::Capillary;
use crate::forces::gas_shear::GasShear;
use crate::forces::lorentz::Lorentz;
use crate::forces::marangoni::Marangoni;
use crate::forces::surface_stress::SurfaceStress;
use crate::forces::tension::Tension;
use crate::frames::PlateNote;
use crate::heat::{self, Caloric, Conduction, Substances};
use crate::march::March;
use crate::motion::{self, Law, Motion, OnColdMetal};
use crate::patch::AREA;
use crate::scene::{Scene, StartState};
use crate::source::Path;
use crate::stage::Stage;
use crate::state::State;
use crate::state::slag::SLAG;
use crate::surface::Surface;

/// A run ready to start.
pub struct Assembled {
    /// Stages in order.
    pub march: March,
    /// Particles at time 0.
    pub state: State,
    /// The base metal.
    pub plate: PlateNote,
    /// How the bodies came out, in the order of the scene.
    pub filled: Vec<Filled>,
    /// Grains of each of their bodies, in the order of the scene.
    pub grain_counts: Vec<usize>,
    /// What is doubtful about the grains at the start.
    pub grain_doubts: Vec<String>,
    /// Physics that is absent.
    pub left_out: LeftOut,
}

/// What the stages are made from.
struct Source<'a> {
    scene: &'a Scene,
    caloric: Option<Arc<Caloric>>,
    /// What has a temperature, where anything has.
    made: Option<Substances>,
    arcs: Arcs,
}

/// Particles with a temperature that they keep.
type Held = Vec<(Range<usize>, Curve)>;

/// Checks the scene and makes the run.
///
/// # Errors
/// Every fault of the scene at once; an input that cannot be read.
pub fn assemble(scene: &Scene, inputs: &Inputs) -> Result<Assembled, Failure> {
    let mut faults = crate::scene::faults(scene);
    let bodies = checked_bodies(scene, &mut faults);
    let faces = scene.flow_faces().unwrap_or_else(|fault| {
        faults.push(fault);
        Faces::default()
    });
    if !faults.is_empty() {
        return Err(Failure::Scene(faults));
    }
    let source = Source::read(scene, inputs)?;
    // The columns come from stages that know nothing of particles; then the particles, some of
    // which the stages keep at a temperature.
    let mut state = State::new(scene.metal());
    source.stages(&mut state, Vec::new(), None)?;
    if let Some(slag) = &scene.slag {
        state.metal.declare(&SLAG);
        state.slag = Some(slag.slag()?.0);
    }
    let filled = metal::fill(scene, inputs, &bodies, &mut state, source.made.as_ref())?;
    state.faces = faces;
    fitting(&state).map_err(|fault| fault.within("/faces"))?;
    if let Some(heat) = &scene.heat {
        let (mirrors, open) = heat.planes();
        let named = mirrors.into_iter().map(|plane| ("mirror", plane));
        let named: Vec<_> = named
            .chain(open.into_iter().map(|plane| ("open", plane)))
            .collect();
        along_heat_faces(&state, &named).map_err(|fault| fault.within("/heat/faces"))?;
    }
    let grains = match &scene.grains {
        Some(grains) => Some(source.grains(grains, inputs, &state)?),
        None => None,
    };
    let (stages, grain_counts, grain_doubts) = match grains {
        Some((mut stages, set, counts)) => {
            state.grains = Some(set);
            let doubts = std::mem::take(&mut stages.doubts);
            (Some(stages), counts, doubts)
        }
        None => (None, Vec::new(), Vec::new()),
    };
    let mut parts = source.stages(&mut state, held(&bodies, &filled), stages)?;
    if scene.grains.is_none() {
        parts.leave_out("grains");
    }
    state.flowing = scene.flow.is_some() && scene.flow_start.is_none();
    state.source = scene.source.map(|source| source.place(0.0));
    Ok(Assembled {
        march: March::new(parts.groups.into(), scene.step()).adaptive(scene.time.greatest_stride()),
        plate: source.plate(),
        state,
        filled,
        grain_counts,
        grain_doubts,
        left_out: parts.left_out,
    })
}

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

fn checked_bodies(scene: &Scene, faults: &mut Vec<Fault>) -> Vec<Body> {
    let lattice = scene.lattice();
    let mut bodies = Vec::with_capacity(scene.bodies.len());
    for (i, body) in scene.bodies.iter().enumerate() {
        match body.body(&format!("/bodies/{i}"), &lattice, scene.heat.is_some()) {
            Ok(body) => bodies.push(body),
            Err(fault) => faults.push(fault),
        }
    }
    bodies
}

impl<'a> Source<'a> {
    fn read(scene: &'a Scene, inputs: &Inputs) -> Result<Self, Failure> {
        let made = scene.substances()?;
        Ok(Self {
            scene,
            caloric: made.as_ref().map(|made| made.metal().clone()),
            made,
            arcs: Arcs::read(scene, inputs)?,
        })
    }

    /// The stages in the order of a step (Komen 2019, fig. 3.16), whose columns `state` is told.
    fn stages(
        &self,
        state: &mut State,
        held: Held,
        beside: Option<Beside>,
    ) -> Result<Parts, Failure> {
        let mut parts = Parts::new();
        let scene = self.scene;
        parts.when(Room::Domain, "source", scene.source, |source| {
            Ok(Box::new(Path(source)))
        })?;
        let wires: Vec<_> = scene.wires().collect();
        let fed = Some(wires).filter(|wires| !wires.is_empty());
        parts.when(Room::Domain, "droplets", fed, |wires| {
            let wire = |wire: &crate::scene::Wire| {
                let (metal, mirror) = (scene.metal(), scene.halving(wire)?);
                let made = Wire::new(wire.droplets, metal, mirror, self.caloric.as_ref());
                let made = made.map_err(|fault| fault.within(&wire.at))?;
                Ok(made.beside(wire.offset_m))
            };
            let wires: Result<_, Fault> = wires.iter().map(wire).collect();
            Ok(Box::new(Droplets::of(wires?)))
        })?;
        parts.when(Room::Domain, "bounds", scene.bounds, |bounds| {
            let stage = Bounds::new(bounds, scene.metal());
            Ok(Box::new(stage.map_err(|fault| fault.within("/bounds"))?))
        })?;
        self.heat(&mut parts, held)?;
        let mut cover = None;
        if let Some(beside) = beside {
            parts.take(Room::Grains, Box::new(beside.motion));
            if let Some(displaced) = beside.displaced {
                parts.take(Room::Grains, Box::new(displaced));
            }
            cover = beside.cover;
        }
        self.melting(&mut parts)?;
        self.forces(&mut parts)?;
        parts.when(Room::Flow, "flow", scene.flow.as_ref(), |flow| {
            let law = self.viscosity(flow)?;
            let motion = Motion::new(flow.clone(), law, scene.metal());
            Ok(Box::new(match &scene.slag {
                Some(slag) => {
                    let (slag, law) = slag.slag()?;
                    motion.beside(slag, law)
                }
                None => motion,
            }))
        })?;
        parts.stages().for_each(|stage| stage.declare(state));
        if scene.output.heat_received {
            let ways = scene.heat_ways();
            ways.iter().for_each(|way| state.metal.declare(way));
        }
        if state.metal.has(&AREA) {
            let surface = Surface::new(scene.metal()).of_cells(scene.lattice().cell());
            surface.declare(state);
            parts.take(Room::Surface, Box::new(surface));
            if let Some(cover) = cover {
                parts.take(Room::Surface, Box::new(cover));
            }
        }
        Ok(parts)
    }

    fn heat(&self, parts: &mut Parts, held: Held) -> Result<(), Failure> {
        let (Some(heat), Some(caloric), Some(made)) = (&self.scene.heat, &self.caloric, &self.made)
        else {
            parts.leave_out("heat");
            return Ok(());
        };
        let mut conduction = Conduction::new(heat, made.clone(), self.scene.metal())
            .map_err(|fault| fault.within("/heat"))?
            .of_cells(self.scene.lattice().cell())
            .beside_walls(
                self.scene
                    .faces
                    .as_ref()
                    .is_some_and(faces::Parameters::holds_heat),
            );
        for (particles, curve) in held {
            conduction.hold(particles, curve);
        }
        parts.take(Room::Heat, Box::new(conduction));
        parts.when(Room::Heat, "arc", self.scene.arc.as_ref(), |arc| {
            Ok(Box::new(self.arcs.heat(
                arc,
                self.scene,
                caloric.clone(),
            )?))
        })?;
        let torches = Some(&self.scene.torches).filter(|torches| !torches.is_empty());
        parts.when(Room::Heat, "torches", torches, |torches| {
            let stage = heat::Torches::new(torches, made.clone(), self.scene.metal());
            Ok(Box::new(stage?))
        })?;
        parts.when(Room::Heat, "losses", self.scene.losses, |losses| {
            Ok(Box::new(heat::Losses::new(losses, made.clone())))
        })
    }

    /// The change between solid and liquid.
    fn melting(&self, parts: &mut Parts) -> Result<(), Failure> {
        let (Some(heat), Some(caloric)) = (&self.scene.heat, &self.caloric) else {
            return Ok(());
        };
        parts.when(Room::Melting, "melting", heat.melting, |_| {
            let start = self.scene.flow_start;
            let bodies = &self.scene.bodies;
            // Metal on a wall is backed by it.
            let backed = bodies.iter().any(|b| b.state == StartState::Wall);
            let base = bodies
                .iter()
                .find(|b| b.state == StartState::Solid && !backed);
            let underside = base.map(|b| b.shape.bounds().0[2]);
            let stage = heat::Phase::new(caloric.clone(), start).above(underside);
            let flow = self.scene.flow.as_ref();
            let sticks = flow.is_some_and(|flow| flow.on_cold_metal == OnColdMetal::Sticks);
            Ok(Box::new(if sticks { stage.sticking() } else { stage }))
        })
    }

    fn forces(&self, parts: &mut Parts) -> Result<(), Failure> {
        let (scene, metal) = (self.scene, self.scene.metal());
        let flow = scene.flow.as_ref();
        let marangoni = scene.marangoni.as_ref();
        parts.when(Room::Forces, "marangoni", marangoni, |marangoni| {
            let stage = Marangoni::new(marangoni);
            Ok(Box::new(stage.map_err(|fault| fault.within("/marangoni"))?))
        })?;
        let given = scene.surface_stress.as_ref();
        parts.when(Room::Forces, "surface_stress", given, |given| {
            let stage = SurfaceStress::new(given, metal);
            Ok(Box::new(
                stage.map_err(|fault| fault.within("/surface_stress"))?,
            ))
        })?;
        let shear = scene.gas_shear.as_ref();
        parts.when(Room::Forces, "gas_shear", shear, |shear| {
            let viscosity = flow.map_or(Ok(Law::Uniform(0.0)), |flow| self.viscosity(flow))?;
            let stage = GasShear::new(shear, self.arcs.gases()?, viscosity, metal)
                .map_err(|fault| fault.within("/gas_shear"))?;
            Ok(Box::new(stage))
        })?;
        let pulled = scene.lorentz.as_ref();
        parts.when(Room::Forces, "lorentz", pulled, |pulled| {
            Ok(Box::new(Lorentz::new(self.arcs.lorentz(pulled)?, metal)))
        })?;
        let pressed = scene.arc_pressure.as_ref();
        parts.when(Room::Forces, "arc_pressure", pressed, |pressed| {
            let pressures = self.arcs.pressures(pressed)?;
            Ok(Box::new(ArcPressure::new(pressures, metal, scene.even())))
        })?;
        parts.when(Room::Forces, "buoyancy", scene.buoyancy, |buoyancy| {
            let gravity = flow.and_then(|flow| flow.gravity_m_s2).unwrap_or_default();
            Ok(Box::new(Buoyancy::new(buoyancy, gravity, metal)))
        })?;
        parts.when(Room::Forces, "tension", scene.tension, |tension| {
            if scene.even() {
                let stage = Capillary::new(tension);
                return Ok(Box::new(match &scene.slag {
                    Some(slag) => stage.beside(slag.slag()?.0),
                    None => stage,
                }));
            }
            Ok(Box::new(Tension::new(tension, metal)))
        })
    }

    fn viscosity(&self, flow: &motion::Parameters) -> Result<Law, Fault> {
        let law = Law::of(
            &flow.viscosity_pa_s,
            "/viscosity_pa_s",
            self.caloric.as_deref(),
        );
        law.map_err(|fault| fault.within("/flow"))
    }

    /// The first solid body is the base metal; without one, the first body stands for it.
    fn plate(&self) -> PlateNote {
        let bodies = &self.scene.bodies;
        let solid = bodies.iter().find(|b| b.state == StartState::Solid);
        let bounds = solid.or(bodies.first()).map(|b| b.shape.bounds());
        let (min_m, max_m) = bounds.unwrap_or_default();
        let source = self.scene.source;
        let moved = source.and_then(|source| unit(source.velocity_m_s));
        let mut torches = self.scene.torches.iter();
        let moved = moved.or_else(|| torches.find_map(|torch| torch.path.heading()));
        PlateNote {
            min_m,
            max_m,
            spacing_m: self.scene.metal().spacing,
            particle_volume_m3: self.scene.metal().volume(),
            melting_point_k: self.caloric.as_ref().and_then(|c| c.melting_point()),
            direction: moved.unwrap_or([0.0, 1.0, 0.0]),
            mirror_x_m: self.scene.faces.as_ref().and_then(|f| f.mirror_x_m()),
        }
    }
}
