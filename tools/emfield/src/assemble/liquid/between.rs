//! A liquid between faces as it starts, and the steps that it allows.

use run::property::Arguments;
use run::{Estimate, Failure, Fault, Plan};
use steps::Legs;

use crate::assemble::liquid::matter::{PASSED, RIPPLE, few, lacks, matter, way};
use crate::liquid::effort::Effort;
use crate::liquid::fill::Filled;
use crate::liquid::room::{Room, furnish};
use crate::liquid::step::{Liquid, Matter, Step};
use crate::liquid::vector::{length, spatial};
use crate::scene::{Faces, Liquid as Part, LiquidMarch, Scene};

/// Bytes that a step holds for each point, about.
const BYTES: u64 = 4_000;

/// Refuses a room that is narrower than a spacing: images of the same points would fill all supports.
fn wide<const D: usize>(room: &Room<D>, spacing: f64) -> Result<(), Failure> {
    let Some(k) = (0..D).find(|k| room.length(*k) < spacing) else {
        return Ok(());
    };
    let (name, length) = (["x", "y", "z"][k], room.length(k));
    let what = format!(
        "{spacing:.3e} m is more than the liquid is wide along {name}, {length:.3e} m: {:.1e} m would give four points",
        0.25 * length
    );
    Err(vec![Fault::at("/points/spacing_m", what).or_at("/liquid/shape")].into())
}

/// The room of a scene and its points.
pub(crate) fn filled<const D: usize>(
    scene: &Scene,
    part: &Part,
    faces: &Faces,
) -> Result<(Room<D>, Filled<D>), Failure> {
    let mut room = faces.room::<D>(&part.shape);
    let spacing = scene.points.spacing_m;
    few((0..D).map(|k| room.length(k) / spacing).product(), spacing)?;
    wide(&room, spacing)?;
    let filled = furnish(&mut room, spacing, scene.points.jitter, scene.points.seed);
    let faces = filled.normal.len() + room.held.len();
    if filled.position.len() <= faces {
        let what = format!("{spacing} m: no point fits inside the liquid");
        return Err(vec![Fault::at("/points/spacing_m", what)].into());
    }
    Ok((room, filled))
}

/// The liquid at its start.
pub(crate) fn start<const D: usize>(
    scene: &Scene,
    part: &Part,
    faces: &Faces,
) -> Result<Liquid<D>, Failure> {
    let (room, filled) = filled::<D>(scene, part, faces)?;
    let n = filled.position.len();
    let mut velocity = vec![[0.0; D]; n];
    for (k, v) in part.velocity_m_s.iter().flatten().enumerate().take(D) {
        let curve = v.compile(&format!("/liquid/velocity_m_s/{k}"), &["x", "y", "z", "r"])?;
        for (x, v) in filled.position.iter().zip(&mut velocity) {
            let value = curve.value(&Arguments::at(spatial(x), 0.0));
            v[k] = value.map_err(|e| Failure::Other(format!("velocity at {x:?} m: {e}")))?;
        }
    }
    let surface = filled.normal.len();
    for (u, normal) in velocity[surface..].iter_mut().zip(&room.held) {
        *u = room.slides(normal);
    }
    Ok(Liquid {
        follow: vec![[0.0; D]; n],
        stress: vec![0.0; surface + room.held.len()],
        pull: [Vec::new(), Vec::new()],
        drag: Vec::new(),
        charge: Vec::new(),
        force: [Vec::new(), Vec::new()],
        position: filled.position,
        velocity,
        pressure: vec![part.gas_pressure_pa; n],
        rate: vec![[0.0; D]; n],
        normal: filled.normal,
        room,
        borne: None,
    })
}

/// The greatest speed \[m/s\].
pub(crate) fn fastest<const D: usize>(liquid: &Liquid<D>) -> f64 {
    liquid.velocity.iter().map(length).fold(0.0, f64::max)
}

/// Steps, the longest of which waves, gravity and the liquid allow.
pub(crate) fn steps<const D: usize>(
    scene: &Scene,
    part: &Part,
    march: &LiquidMarch,
    liquid: &Liquid<D>,
) -> Legs {
    let spacing = scene.points.spacing_m;
    let matter: Matter<D> = matter(part);
    let mut step = march.end_s;
    let half = (0..D).map(|k| 0.5 * liquid.room.length(k));
    let radius = half.fold(0.0, f64::max);
    if matter.tension > 0.0 && liquid.surface() > 0 {
        let ripple = (matter.density * radius.powi(3) / matter.tension).sqrt();
        step = step.min(RIPPLE * ripple * spacing / radius);
    }
    let gravity = length(&matter.gravity);
    if gravity > 0.0 {
        step = step.min(PASSED * spacing / (2.0 * gravity * radius).sqrt());
    }
    let fastest = fastest(liquid);
    if fastest > 0.0 {
        step = step.min(PASSED * spacing / fastest);
    }
    let longest = march.step_s.unwrap_or(step);
    Legs::new(longest, scene.output.instants(march.end_s))
}

/// What a run would do.
///
/// # Errors
/// Where the spacing suits the box ill, and of formulas.
pub(crate) fn plan<const D: usize>(
    scene: &Scene,
    part: &Part,
    faces: &Faces,
    march: &LiquidMarch,
) -> Result<Plan, Failure> {
    let liquid = start::<D>(scene, part, faces)?;
    let steps = steps(scene, part, march, &liquid);
    let points = liquid.position.len() as u64;
    let mut plan = Plan::new()
        .stage("liquid")
        .count("points", points)
        .count("on walls", liquid.room.held.len() as u64)
        .count("steps", steps.count())
        .column("velocity", "m/s")
        .column("pressure", "Pa")
        .limit("step", steps.longest(), "s")
        .memory("equations", BYTES * points);
    plan = match liquid.surface() {
        0 => plan.left_out("free surface", "all faces are named"),
        surface => plan
            .stage("free surface")
            .count("on the surface", surface as u64),
    };
    Ok(lacks(plan, part))
}

/// Time of a run, from a step at its start.
///
/// # Errors
/// Those of a step.
pub(crate) fn estimate<const D: usize>(
    scene: &Scene,
    part: &Part,
    faces: &Faces,
    march: &LiquidMarch,
) -> Result<Estimate, Failure> {
    let mut liquid = start::<D>(scene, part, faces)?;
    let steps = steps(scene, part, march, &liquid);
    let (way, mut effort) = (way(scene, part), Effort::default());
    let began = std::time::Instant::now();
    let step = Step {
        way: &way,
        dt: steps.step(0).1,
    };
    liquid.advance(&matter(part), step, &mut effort)?;
    let each = began.elapsed().as_secs_f64();
    Ok(Estimate {
        seconds: each * steps.count() as f64,
        basis: format!("{each:.3} s a step, as at the start"),
        memory: Vec::new(),
    })
}
