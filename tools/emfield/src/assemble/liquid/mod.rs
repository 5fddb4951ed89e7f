//! From a scene to a liquid at its start, the plan of its motion and its steps.

pub(crate) mod alternating;
pub(crate) mod between;
pub(crate) mod groups;
pub(crate) mod matter;
pub(crate) mod rest;

use run::property::Arguments;
use run::{Estimate, Failure, Fault, Plan};
use shapes::Body;
use steps::Legs;

use self::alternating::alternating;
use self::matter::{PASSED, RIPPLE, few, lacks, matter, way};
use crate::geometry::Geometry;
use crate::liquid::air::Place;
use crate::liquid::borne::Borne;
use crate::liquid::effort::Effort;
use crate::liquid::electric::Electric;
use crate::liquid::fill::{Filled, fill};
use crate::liquid::magnetic::{Magnetic, outline};
use crate::liquid::room::Room;
use crate::liquid::step::{Liquid, Matter, Step, Way};
use crate::liquid::surface::patches;
use crate::liquid::vector::length;
use crate::march::liquid::acting::electric;
use crate::scene::{Liquid as Part, LiquidHeat, LiquidMarch, Scene};

/// Bytes that a step holds for each point, about: weights, rows and factors.
const BYTES: u64 = 6_000;

/// The points of the liquid of a scene.
///
/// # Errors
/// Where the spacing suits the shape ill.
pub(crate) fn filled(scene: &Scene, liquid: &Part) -> Result<Filled<3>, Failure> {
    let body = Body::new(&liquid.shape, 3);
    let spacing = scene.points.spacing_m;
    let [low, high] = body.bounds();
    let room: f64 = (0..3).map(|k| (high[k] - low[k]) / spacing).product();
    few(room, spacing)?;
    let fault = |what: String| Failure::from(vec![Fault::at("/points/spacing_m", what)]);
    let filled = fill::<3>(&body, spacing);
    let surface = filled.normal.len();
    let made = patches(&filled.position[..surface], &filled.normal, spacing);
    made.map_err(|e| fault(e.to_string()))?;
    if filled.position.len() == surface {
        return Err(fault(format!(
            "{spacing} m: no point fits inside the liquid"
        )));
    }
    Ok(filled)
}

/// The liquid at its start.
pub(crate) fn start(part: &Part, filled: Filled<3>) -> Result<Liquid<3>, Failure> {
    let n = filled.position.len();
    let mut velocity = vec![[0.0; 3]; n];
    for (k, v) in part.velocity_m_s.iter().flatten().enumerate() {
        let curve = v.compile(&format!("/liquid/velocity_m_s/{k}"), &["x", "y", "z", "r"])?;
        for (x, v) in filled.position.iter().zip(&mut velocity) {
            let value = curve.value(&Arguments::at(*x, 0.0));
            v[k] = value.map_err(|e| Failure::Other(format!("velocity at {x:?} m: {e}")))?;
        }
    }
    // Currents stir a drop whose shape all but stays.
    let follows = part.magnetic.is_some();
    Ok(Liquid {
        follow: if follows {
            velocity.clone()
        } else {
            Vec::new()
        },
        stress: vec![0.0; filled.normal.len()],
        pull: [Vec::new(), Vec::new()],
        drag: Vec::new(),
        charge: Vec::new(),
        force: [Vec::new(), Vec::new()],
        position: filled.position,
        velocity,
        pressure: vec![part.gas_pressure_pa; n],
        rate: vec![[0.0; 3]; n],
        normal: filled.normal,
        room: Room::default(),
        borne: part.groups.is_none().then(Borne::default),
    })
}

/// The longest step \[s\].
fn longest(scene: &Scene, part: &Part, march: &LiquidMarch, liquid: &Liquid<3>) -> f64 {
    if let Some(step) = march.step_s {
        return step;
    }
    let spacing = scene.points.spacing_m;
    let matter: Matter<3> = matter(part);
    let mut step = march.end_s;
    if matter.tension > 0.0 {
        let volume = liquid.position.len() as f64 * spacing.powi(3);
        let radius = (0.75 * volume / std::f64::consts::PI).cbrt();
        let ripple = (matter.density * radius.powi(3) / matter.tension).sqrt();
        step = step.min(RIPPLE * ripple * spacing / radius);
    }
    let gravity = length(&matter.gravity);
    if gravity > 0.0 {
        step = step.min(PASSED * (spacing / gravity).sqrt());
    }
    let fastest = fastest(liquid);
    if fastest > 0.0 {
        step = step.min(PASSED * spacing / fastest);
    }
    step
}

pub(crate) fn fastest(liquid: &Liquid<3>) -> f64 {
    liquid.velocity.iter().map(length).fold(0.0, f64::max)
}

pub(crate) fn steps(scene: &Scene, part: &Part, march: &LiquidMarch, liquid: &Liquid<3>) -> Legs {
    let longest = longest(scene, part, march, liquid);
    Legs::new(longest, scene.output.instants(march.end_s))
}

/// What a run would do.
///
/// # Errors
/// Those of `filled`, and of formulas.
pub(crate) fn plan(scene: &Scene, part: &Part) -> Result<Plan, Failure> {
    let faults = scene.faults();
    if !faults.is_empty() {
        return Err(faults.into());
    }
    let Some(march) = &part.march else {
        return Ok(Plan::new()
            .stage("equilibrium")
            .left_out("points", "no key 'march' of 'liquid'"));
    };
    if let Some(faces) = &part.faces {
        return match scene.geometry {
            Geometry::Space => between::plan::<3>(scene, part, faces, march),
            _ => between::plan::<2>(scene, part, faces, march),
        };
    }
    let liquid = start(part, filled(scene, part)?)?;
    let steps = steps(scene, part, march, &liquid);
    let points = liquid.position.len() as u64;
    let mut plan = Plan::new()
        .stage("liquid")
        .count("points", points)
        .count("on the surface", liquid.surface() as u64)
        .count("steps", steps.count())
        .column("velocity", "m/s")
        .column("pressure", "Pa")
        .limit("step", steps.longest(), "s")
        .memory("equations", BYTES * points)
        .left_out("eddy currents", "no key 'eddy_currents'");
    plan = match electric(part) {
        Some(field) => {
            let place = Place::of(&liquid.position, &liquid.normal, scene.points.spacing_m);
            let count = field.count(place);
            plan.stage("electric field")
                .count("points of the field", count)
                .column("traction", "Pa")
                .memory("equations of the field", BYTES * count)
        }
        None => plan.left_out("electric field", "no key 'electric' of 'liquid'"),
    };
    plan = match &part.magnetic {
        Some(given) => {
            let count = alternating(scene, given, &liquid)?.count();
            plan.stage("magnetic field")
                .count("points of the field", count)
                .column("traction", "Pa")
                .memory("equations of the field", BYTES * count)
        }
        None => plan.left_out("magnetic field", "no key 'magnetic' of 'liquid'"),
    };
    plan = warmed(plan, part.heat.as_ref());
    if part.groups.is_some() {
        let drops = groups::groups(scene, part, &liquid)?.drops.len();
        plan = plan.stage("groups").count("drops", drops as u64);
    }
    Ok(lacks(plan, part))
}

/// Adds what heat does to a plan.
fn warmed(plan: Plan, heat: Option<&LiquidHeat>) -> Plan {
    let Some(heat) = heat else {
        return plan.left_out("heat", "no key 'heat' of 'liquid'");
    };
    let mut plan = plan.stage("heat").column("temperature", "K");
    for (absent, name) in [
        (heat.radiation.is_none(), "radiation"),
        (heat.melting.is_none(), "melting"),
    ] {
        if absent {
            plan = plan.left_out(name, &format!("no key '{name}' of 'heat'"));
        }
    }
    plan
}

/// Time of a run, from a step at its start.
///
/// # Errors
/// Those of a step.
pub(crate) fn estimate(scene: &Scene, part: &Part) -> Result<Option<Estimate>, Failure> {
    let Some(march) = &part.march else {
        return Ok(None);
    };
    if let Some(faces) = &part.faces {
        return match scene.geometry {
            Geometry::Space => between::estimate::<3>(scene, part, faces, march),
            _ => between::estimate::<2>(scene, part, faces, march),
        }
        .map(Some);
    }
    let mut liquid = start(part, filled(scene, part)?)?;
    let steps = steps(scene, part, march, &liquid);
    let (way, mut effort) = (way(scene, part), Effort::default());
    let mut field = electric(part);
    if let Some(field) = &mut field {
        // What is kept from step to step is made once.
        liquid.pull[0] = pull(field, &liquid, &way, &mut effort)?;
        liquid.pull[1] = vec![0.0; liquid.surface()];
    }
    let mut magnetic = match &part.magnetic {
        Some(given) => Some(alternating(scene, given, &liquid)?),
        None => None,
    };
    if let Some(field) = &mut magnetic {
        lift(field, &mut liquid, &way, &mut effort)?;
    }
    let began = std::time::Instant::now();
    let step = Step {
        way: &way,
        dt: steps.step(0).1,
    };
    liquid.advance(&matter(part), step, &mut effort)?;
    if let Some(field) = &mut field {
        pull(field, &liquid, &way, &mut effort)?;
    }
    if let Some(field) = &mut magnetic {
        lift(field, &mut liquid, &way, &mut effort)?;
    }
    let each = began.elapsed().as_secs_f64();
    Ok(Some(Estimate {
        seconds: each * steps.count() as f64,
        basis: format!("{:.3} s a step, as at the start", each),
        memory: Vec::new(),
    }))
}

/// What an alternating field does where the liquid is.
fn lift(
    field: &mut Magnetic,
    liquid: &mut Liquid<3>,
    way: &Way,
    effort: &mut Effort,
) -> Result<(), Failure> {
    let place = Place::of(&liquid.position, &liquid.normal, way.spacing);
    let centre = liquid.middle();
    let about = outline(place.skin, centre)?;
    let stood = field.stand(&about, centre);
    let sides = field.fit(&stood)?;
    let act = field.act(&stood, &sides, place, way.of_fields(), effort)?;
    let mut force = act.pull;
    let phi = liquid.stirred(&mut force, &act.phi, way, effort)?;
    let traction = phi.iter().zip(&act.pressure).take(liquid.surface());
    let traction = traction.map(|(phi, p)| -phi - p).collect();
    liquid.pull = [traction, vec![0.0; liquid.surface()]];
    liquid.force = [force.clone(), vec![[0.0; 3]; force.len()]];
    Ok(())
}

/// The traction of the field where the liquid is \[Pa\].
fn pull(
    field: &mut Electric,
    liquid: &Liquid<3>,
    way: &Way,
    effort: &mut Effort,
) -> Result<Vec<f64>, Failure> {
    let stood = field.stand(Place::of(&liquid.position, &liquid.normal, way.spacing))?;
    let fitted = field.fit(&stood)?;
    field.traction(&stood, &fitted, way.of_fields(), effort)
}
