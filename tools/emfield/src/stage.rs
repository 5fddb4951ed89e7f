//! The program: plan, run, record.

use std::sync::Mutex;

use artefact::Version;
use run::{Failure, Inputs, Plan, Session, Tool};

use crate::assemble;
use crate::cloud::Cloud;
use crate::output::{self, Doubt, Found, Samples};
use crate::scene::{EddyCurrents, Geometry, Scene};
use crate::solve::unknown::Unknown;
use crate::surface::enclosing::Enclosing;

/// Electric and magnetic fields on points.
#[derive(Debug)]
pub struct EmField;

/// The points that the plan of a scene has made, for the run that follows it.
static READY: Mutex<Option<(Scene, Cloud)>> = Mutex::new(None);

/// The points of a scene: those of its plan, if there was one.
fn ready(scene: &Scene) -> Result<Cloud, Failure> {
    let kept = READY.lock().ok().and_then(|mut ready| ready.take());
    match kept {
        Some((planned, cloud)) if planned == *scene => Ok(cloud),
        _ => Ok(Cloud::new(scene)?),
    }
}

impl Tool for EmField {
    const NAME: &'static str = "emfield";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const ABOUT: &'static str =
        "Electrostatic and eddy-current fields of bodies, by weighted least squares on points.";
    const EXAMPLE: &'static str = "target/release/emfield run pipelines/verify/em-dielectric-sphere/scene.json --out build/em.mcap";
    const SCENE_KIND: &'static str = "emfield.scene";
    const ARTEFACT_KIND: &'static str = "point-fields";
    const ARTEFACT_VERSION: Version = Version::new(1, 0);

    type Scene = Scene;

    fn plan(scene: &Scene, _: &Inputs) -> Result<Plan, Failure> {
        let faults = scene.eddy_currents.iter();
        let faults: Vec<_> = faults
            .flat_map(|e| assemble::drive::faults(scene, e))
            .collect();
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let cloud = Cloud::new(scene)?;
        if let Some(currents) = &scene.eddy_currents {
            assemble::windings(scene, currents, &cloud)?;
            assemble::magnets(scene, currents)?;
        }
        if let Some(electrostatics) = &scene.electrostatics {
            assemble::shorts(scene, electrostatics, &cloud)?;
            assemble::room(scene, electrostatics, &cloud)?;
        }
        let enclosing = assemble::enclosing(scene, &cloud)?;
        let plan = shown(scene, &cloud, &enclosing);
        if let Ok(mut ready) = READY.lock() {
            *ready = Some((scene.clone(), cloud));
        }
        Ok(plan)
    }

    fn run(scene: &Scene, _: &Inputs, session: &mut Session) -> Result<(), Failure> {
        let cloud = session.timed("points", || ready(scene))?;
        match scene.geometry {
            Geometry::Space => solve::<3, 3>(scene, &cloud, session),
            Geometry::Plane | Geometry::Axisymmetric => solve::<2, 1>(scene, &cloud, session),
        }
    }
}

fn solve<const D: usize, const K: usize>(
    scene: &Scene,
    cloud: &Cloud,
    session: &mut Session,
) -> Result<(), Failure> {
    // Until a march has begun nothing is worth a checkpoint.
    let expendable = session.expendable();
    for what in Cloud::grains(scene) {
        session.warn(what);
    }
    let samples = session.timed("probes", || Samples::new::<D>(scene, cloud))?;
    let mut found = Found::default();
    if let Some(electrostatics) = &scene.electrostatics {
        found.join(assemble::electrostatics::<D>(
            scene,
            electrostatics,
            cloud,
            session,
        )?);
    }
    session.stopped()?;
    if let Some(currents) = &scene.eddy_currents {
        if let Some(transient) = &currents.transient {
            drop(expendable);
            let at = (currents, transient);
            let mut doubts = Vec::new();
            assemble::march::<D, K>(scene, at, cloud, session, |time, fields, session| {
                let mut all = found.clone();
                all.join(fields);
                doubts.append(&mut all.doubts);
                output::write(scene, cloud, &samples, (time, &all), session)
            })?;
            tell(doubts, session);
            return Ok(());
        }
        let made = match currents.standing {
            Some(_) => assemble::standing::<D, K>(scene, currents, cloud, session)?,
            None => assemble::eddy_currents::<D, K>(scene, currents, cloud, session)?,
        };
        found.join(made);
    }
    session.stopped()?;
    tell(std::mem::take(&mut found.doubts), session);
    output::write(scene, cloud, &samples, (0.0, &found), session)
}

/// Difference of the ways of a force over its size from which it is a warning that matters; less is a note.
const MATTERS: f64 = 0.2;

/// Says which forces are in doubt: of each the largest of all instants.
fn tell(doubts: Vec<Doubt>, session: &mut Session) {
    let mut worst: Vec<Doubt> = Vec::new();
    for doubt in doubts {
        match worst.iter_mut().find(|w| w.of == doubt.of) {
            Some(w) if w.share < doubt.share => *w = doubt,
            Some(_) => {}
            None => worst.push(doubt),
        }
    }
    for doubt in worst {
        if doubt.share > MATTERS {
            session.warn(doubt.what);
        } else {
            session.note(doubt.what);
        }
    }
}

fn shown(scene: &Scene, cloud: &Cloud, enclosing: &[Enclosing]) -> Plan {
    let counts = cloud.counts;
    let mut plan = Plan::new()
        .stage("points")
        .count("points", cloud.len() as u64)
        .count("on interfaces", counts.interface as u64)
        .count("on walls", counts.outer as u64)
        .count("in layers", counts.layers as u64)
        .count("on lattices", counts.lattice as u64)
        .memory("points", cloud.bytes());
    if !enclosing.is_empty() {
        let places: usize = enclosing.iter().map(|e| e.places.len()).sum();
        plan = plan.count("on enclosing surfaces", places as u64);
    }
    if scene.electrostatics.is_some() {
        plan = plan
            .stage("electrostatics")
            .column("potential", "V")
            .column("electric_field", "V/m");
    } else {
        plan = plan.left_out("electrostatics", "no key 'electrostatics'");
    }
    plan = match &scene.eddy_currents {
        None => plan.left_out("eddy currents", "no key 'eddy_currents'"),
        Some(currents) => shown_currents(scene, currents, plan),
    };
    if scene.bodies.is_empty() {
        plan = plan.left_out("interfaces", "no bodies");
    }
    plan
}

fn shown_currents(scene: &Scene, currents: &EddyCurrents, plan: Plan) -> Plan {
    let plan = match assemble::drive::unknown(scene, currents) {
        Unknown::Axial => plan.stage("eddy currents").column("magnetic_field", "A/m"),
        Unknown::Potential | Unknown::Around => plan
            .stage("eddy currents")
            .column("vector_potential", "Wb/m"),
    };
    let plan = plan.column("magnetic_flux_density", "T");
    let media = 0..=scene.bodies.len();
    let carries = media.clone().any(|m| scene.carries(m));
    let conducts = media
        .clone()
        .any(|m| scene.medium(m).conductivity_s_m > 0.0);
    let plan = if carries {
        plan.stage("coils of points")
    } else {
        plan
    };
    let plan = if media.clone().any(|m| scene.saturates(m)) {
        plan.stage("saturation")
    } else {
        plan.left_out("saturation", "no permeability depends on the field")
    };
    if conducts || carries {
        let plan = plan
            .column("current_density", "A/m2")
            .column("force_density", "N/m3")
            .column("joule_heat", "W/m3");
        if !conducts {
            plan.left_out("eddy currents in conductors", "nothing conducts")
        } else if currents.charged(scene.geometry) {
            plan.stage("charges on conductors")
                .column("electric_potential", "V")
        } else {
            let why = match scene.geometry {
                Geometry::Space => "\"potential\" is \"none\"",
                _ => "currents leave no conductor in a plane or about an axis",
            };
            plan.left_out("electric potential V", why)
        }
    } else {
        plan.left_out("currents", "nothing conducts")
    }
}
