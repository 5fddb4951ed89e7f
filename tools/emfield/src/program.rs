//! The program: plan, run, record.

use artefact::Version;
use run::{Estimate, Failure, Inputs, Plan, Preview, Session, Tool};

use crate::assemble;
use crate::cloud::{self, Cloud};
use crate::magnetic::unknown::Unknown;
use crate::scene::{EddyCurrents, Geometry, Scene};
use crate::surface::enclosing::Enclosing;
use crate::trial::{self, Planned};
use crate::{electric, magnetic, march, surface};

/// Electric and magnetic fields on points.
#[derive(Debug)]
pub struct EmField;

/// A scene with its points.
#[derive(Debug)]
pub struct Ready {
    scene: Scene,
    /// Points of bodies and of what is about them; none where there is a liquid.
    points: Option<Planned>,
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
    type Ready = Ready;

    fn prepare(scene: Scene, _: Inputs) -> Result<Ready, Failure> {
        let mut faults = scene.faults();
        // What drives currents has its form once nothing is wrong with the scene itself.
        if faults.is_empty() {
            let currents = scene.eddy_currents.iter();
            faults.extend(currents.flat_map(|e| magnetic::setup::faults(&scene, e)));
        }
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let points = match scene.liquid {
            Some(_) => None,
            None => Some(Planned::new(&scene)?),
        };
        Ok(Ready { scene, points })
    }

    fn plan(ready: &Ready) -> Result<Plan, Failure> {
        let scene = &ready.scene;
        match (&scene.liquid, &ready.points) {
            (Some(liquid), _) => assemble::liquid::plan(scene, liquid),
            (None, Some(planned)) => plan(scene, &planned.cloud),
            (None, None) => Ok(Plan::new()),
        }
    }

    fn outline(scene: &Scene) -> Plan {
        let plan = Plan::new();
        // A liquid has no domain to fill: its plan counts its points at once.
        if scene.liquid.is_some() || !scene.faults().is_empty() {
            return plan;
        }
        let [points, bytes] = cloud::setup::least(scene);
        plan.count("points, at least", points as u64)
            .memory("points and weights, at least", bytes as u64)
    }

    fn estimate(ready: Ready) -> Result<Option<Estimate>, Failure> {
        let scene = &ready.scene;
        match (&scene.liquid, &ready.points) {
            (Some(liquid), _) => assemble::liquid::estimate(scene, liquid),
            (None, Some(planned)) => trial::estimate(scene, planned).map(Some),
            (None, None) => Ok(None),
        }
    }

    fn preview(scene: &Scene, _: &Inputs) -> Result<Preview, Failure> {
        assemble::preview(scene)
    }

    fn run(ready: Ready, session: &mut Session) -> Result<(), Failure> {
        let scene = &ready.scene;
        if let Some(planned) = &ready.points {
            return assemble::solve(scene, &planned.cloud, session);
        }
        let Some(liquid) = &scene.liquid else {
            return Ok(());
        };
        match (&liquid.march, &liquid.equilibrium) {
            (Some(march), _) => march::liquid::flow(scene, liquid, march, session),
            (None, Some(rest)) => assemble::liquid::rest::rest(scene, liquid, rest, session),
            (None, None) => Ok(()),
        }
    }
}

/// What a run would do with the points of bodies and of what is about them.
fn plan(scene: &Scene, cloud: &Cloud) -> Result<Plan, Failure> {
    if let Some(currents) = &scene.eddy_currents {
        magnetic::driven::setup::windings(scene, currents, cloud)?;
        magnetic::medium::setup::magnets(scene, currents)?;
    }
    if let Some(electrostatics) = &scene.electrostatics {
        electric::setup::shorts(scene, electrostatics, cloud)?;
        electric::setup::room(electrostatics, cloud)?;
    }
    let enclosing = surface::setup::enclosing(scene, cloud)?;
    Ok(shown(scene, cloud, &enclosing))
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
    let plan = match magnetic::setup::unknown(scene, currents) {
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
    let plan = if scene.bodies.iter().any(|b| b.net_current_a.is_some()) {
        plan.stage("net currents of bars")
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
