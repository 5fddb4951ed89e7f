//! The program: plan, run, record.

use std::time::Instant;

use artefact::Version;
use run::{Estimate, Failure, Fault, Inputs, Plan, Preview, Session, Tool};

use crate::assemble;
use crate::march::{State, choice};
use crate::operator::Operator;
use crate::scene::Scene;
use crate::scene::method::Beyond;
use crate::system::{Rates, System};
use crate::{frames, simulate, steady};

/// Heat conduction by smoothed particles.
#[derive(Debug)]
pub struct HeatSph;

/// A body put together, at its first temperature.
#[derive(Debug)]
pub struct Ready {
    scene: Scene,
    system: System,
    /// Of each point \[K\].
    temperature: Vec<f64>,
}

impl Tool for HeatSph {
    const NAME: &'static str = "heatsph";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const ABOUT: &'static str = "Heat conduction by smoothed particles, with a conductivity that varies with place and temperature.";
    const EXAMPLE: &'static str = "target/release/heatsph run pipelines/verify/heat-robin-square/scene.json --out build/heat.mcap";
    const SCENE_KIND: &'static str = "heatsph.scene";
    const ARTEFACT_KIND: &'static str = "point-fields";
    const ARTEFACT_VERSION: Version = Version::new(1, 0);

    type Scene = Scene;
    type Ready = Ready;

    fn prepare(scene: Scene, _: Inputs) -> Result<Ready, Failure> {
        let (system, temperature) = assemble::system(&scene)?;
        Ok(Ready {
            scene,
            system,
            temperature,
        })
    }

    fn plan(ready: &Ready) -> Result<Plan, Failure> {
        let Ready { scene, system, .. } = ready;
        let mut rates = Rates::default();
        let evaluated = system.rates(0.0, &ready.temperature, &mut rates);
        evaluated.map_err(|error| Failure::Other(error.to_string()))?;
        refuse(scene, system.explicit_limit(&rates))?;
        Ok(shown(scene, system, &rates))
    }

    fn estimate(ready: Ready) -> Result<Option<Estimate>, Failure> {
        let Ready {
            scene,
            system,
            temperature,
        } = ready;
        let Some(time) = &scene.time else {
            return Ok(None);
        };
        let (mut method, steps) = choice::method(&scene, &system);
        let mut rates = Rates::default();
        let mut state = State::new(&system, temperature);
        let failed = |error: String| Failure::Other(error);
        system
            .rates(0.0, &state.temperature, &mut rates)
            .map_err(|e| failed(e.to_string()))?;
        let longest = method.longest(&system, &rates);
        let step = match steps {
            choice::Steps::Controlled { .. } => return Ok(None),
            choice::Steps::Limited => longest,
            choice::Steps::Given(step, _) => step.min(longest),
        };
        let began = Instant::now();
        let taken = method.advance(&system, &mut state, &mut rates, step.min(time.end_s));
        taken.map_err(|e| failed(e.to_string()))?;
        let each = began.elapsed().as_secs_f64();
        Ok(Some(Estimate {
            seconds: each * (time.end_s / step).ceil(),
            basis: format!("{:.2} ms a step, as the first", 1e3 * each),
            memory: Vec::new(),
        }))
    }

    fn preview(scene: &Scene, _: &Inputs) -> Result<Preview, Failure> {
        Ok(assemble::preview::preview(scene)?)
    }

    fn run(ready: Ready, session: &mut Session) -> Result<(), Failure> {
        let Ready {
            scene,
            mut system,
            temperature,
        } = ready;
        for doubt in &system.doubts {
            session.warn(doubt.clone());
        }
        if let Some(balance) = system.links.balance {
            session.closing("balance_newton_steps", "1", balance.steps as f64);
            session.closing("balance_iterations", "1", balance.iterations as f64);
            session.closing("balance_linear_error", "1", balance.linear);
            session.closing("balance_quadratic_error", "1", balance.quadratic);
        }
        match scene.steady {
            Some(rule) => {
                let (state, rates) = steady::solve(rule, &mut system, temperature, session)?;
                frames::steady(&scene, &system, &state, &rates, session)
            }
            None => simulate::march(&scene, &mut system, temperature, session),
        }
    }
}

/// Refuses an explicit step beyond the limit where the scene wants it refused.
fn refuse(scene: &Scene, limit: f64) -> Result<(), Fault> {
    let explicit = scene.time.as_ref().and_then(|time| time.explicit);
    match explicit.map(|explicit| (explicit.step_s, explicit.beyond_limit)) {
        Some((Some(step), Beyond::Refuse)) if step > limit * (1.0 + 1e-9) => Err(Fault::at(
            "/time/explicit/step_s",
            format!("{step} s is beyond the explicit limit of {limit:.4e} s"),
        )
        .or_at("/points")
        .or_at("/materials")),
        _ => Ok(()),
    }
}

fn shown(scene: &Scene, system: &System, rates: &Rates) -> Plan {
    let links = system.links.weight.len() as u64;
    let mut plan = Plan::new()
        .stage("assemble")
        .count("points", system.len() as u64)
        .count("links", links / 2)
        .count("surface patches", system.cloud.patches.len() as u64)
        .column("temperature", "K")
        .column("conductivity", "W/(m K)")
        .column("volume", if scene.dimensions == 2 { "m2" } else { "m3" })
        .memory("links", system.links.bytes())
        .memory("conductance of links", system.conduction().bytes());
    if let Some(content) = system.storage.varies() {
        plan = plan.memory("heat of cells by temperature", content.bytes());
    }
    if let Some(source) = &system.source {
        plan = plan.memory("cells of the source", source.bytes());
    }
    if let Some(torches) = &system.torches {
        plan = plan.stage("torches").memory("torches", torches.bytes());
    }
    plan = match scene.steady {
        Some(_) => plan
            .stage("solve")
            .left_out("march in time", "the scene asks for the steady state"),
        None => plan
            .stage("march")
            .limit("step_explicit", system.explicit_limit(rates), "s"),
    };
    if let Operator::Pair(_) = scene.operator {
        plan = plan.left_out(
            "balance of weights",
            "the scene asks for the plain pair form",
        );
    }
    if system.source.is_none() {
        plan = plan.left_out("heat source", "no key 'source_w_m3'");
    }
    if system.conduction().is_fixed() {
        plan = plan.left_out("conductivity of temperature", "no material has one");
    }
    if scene.steady.is_none() && system.storage.varies().is_none() {
        plan = plan.left_out("heat capacity of temperature", "no material has one");
    }
    if scene.contacts.is_empty() && scene.materials.len() > 1 {
        plan = plan.left_out("contact resistance", "no key 'contacts'");
    }
    if scene.materials.len() == 1 {
        plan = plan.left_out("interfaces", "one material");
    }
    if system.surface.is_insulated() {
        plan = plan.note("the whole surface is insulated");
    }
    plan
}
