//! A whole stage in one file: heat along an insulated rod, explicit in time.
//!
//! `cargo run --release -p run --example rod -- run tools/harness/run/examples/rod.json --out rod.mcap`

use std::process::ExitCode;

use artefact::{Checkpoint, Record, Table};
use run::property::{Arguments, Curve, Property};
use run::{Failure, Fault, Input, Inputs, Plan, Session, Tool};
use schemars::JsonSchema;
use serde::Deserialize;

/// Above this no solid rod exists \[K\].
const HOTTEST: f64 = 1e5;

/// Heat along an insulated rod.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Scene {
    /// Length of the rod.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    length_m: f64,
    /// Distance between points.
    #[schemars(extend("exclusiveMinimum" = 0.0), range(max = 1.0))]
    spacing_m: f64,
    /// Thermal diffusivity in m2/s, over T.
    diffusivity_m2_s: Property,
    /// Temperature at the start in K, over x.
    start_k: Property,
    /// Time.
    time: Time,
    /// Heat released in K/s, over x, T, t; absent: none.
    source: Option<Source>,
    /// Ends of the rod.
    #[serde(default)]
    ends: Ends,
}

/// Time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Time {
    /// Step.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    step_s: f64,
    /// Number of steps.
    #[schemars(range(min = 1))]
    steps: u64,
    /// Steps between two tables.
    #[schemars(range(min = 1))]
    table_steps: u64,
    /// Warn if the rod still changes faster than this at the end.
    #[schemars(range(min = 0.0))]
    steady_k_s: Option<f64>,
}

/// Heat released within the rod.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Source {
    /// Rate of heating in K/s.
    rate_k_s: Property,
}

/// Ends of the rod.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Ends {
    /// No heat passes.
    #[default]
    Insulated,
    /// The ends keep their first temperature.
    Held,
}

/// The properties, ready for evaluation.
struct Curves {
    diffusivity: Curve,
    start: Curve,
    source: Option<Curve>,
}

fn curves(scene: &Scene) -> Result<Curves, Vec<Fault>> {
    let diffusivity = scene
        .diffusivity_m2_s
        .compile_positive("/diffusivity_m2_s", &["T"], "m2/s");
    let start = scene.start_k.compile("/start_k", &["x"]);
    let source = scene
        .source
        .as_ref()
        .map(|s| s.rate_k_s.compile("/source/rate_k_s", &["x", "T", "t"]))
        .transpose();
    match (diffusivity, start, source) {
        (Ok(diffusivity), Ok(start), Ok(source)) => Ok(Curves {
            diffusivity,
            start,
            source,
        }),
        (a, b, c) => Err([a.err(), b.err(), c.err()].into_iter().flatten().collect()),
    }
}

fn places(scene: &Scene) -> Vec<f64> {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "both are positive"
    )]
    let points = (scene.length_m / scene.spacing_m).round() as u32 + 1;
    (0..points)
        .map(|i| f64::from(i) * scene.spacing_m)
        .collect()
}

/// Temperature at each point and the step.
struct Rod {
    step: u64,
    temperature: Vec<f64>,
}

impl Rod {
    fn new(curves: &Curves, x: &[f64]) -> Result<Self, Failure> {
        let start = |x: &f64| curves.start.value(&Arguments::at([*x, 0.0, 0.0], 0.0));
        let temperature = x.iter().map(start).collect::<Result<_, _>>();
        Ok(Self {
            step: 0,
            temperature: temperature.map_err(|e| Failure::Other(e.to_string()))?,
        })
    }

    fn restore(checkpoint: &mut Checkpoint) -> artefact::Result<Self> {
        Ok(Self {
            step: checkpoint.json("step")?,
            temperature: checkpoint.f64("temperature")?,
        })
    }

    fn save(&self, checkpoint: &mut Checkpoint) -> artefact::Result<()> {
        checkpoint.put_f64("temperature", &self.temperature);
        checkpoint.put_json("step", &self.step)
    }

    /// One explicit step; gives the greatest rate of change \[K/s\].
    fn advance(&mut self, scene: &Scene, curves: &Curves, x: &[f64]) -> Result<f64, Failure> {
        let (dt, h) = (scene.time.step_s, scene.spacing_m);
        #[allow(clippy::cast_precision_loss, reason = "below 2^53 steps")]
        let time = self.step as f64 * dt;
        let (old, n) = (self.temperature.clone(), x.len());
        let mut fastest = 0.0_f64;
        for i in 0..n {
            let (left, right) = (old[i.saturating_sub(1)], old[(i + 1).min(n - 1)]);
            if matches!(scene.ends, Ends::Held) && (i == 0 || i + 1 == n) {
                continue;
            }
            let at = Arguments {
                x: x[i],
                temperature: old[i],
                time,
                ..Arguments::default()
            };
            let out_of_range =
                |e: run::property::OutOfRange| self.diverged(time, i, x[i], &e.to_string());
            let a = curves.diffusivity.value(&at).map_err(out_of_range)?;
            let mut rate = a * (left - 2.0 * old[i] + right) / (h * h);
            if let Some(source) = &curves.source {
                rate += source.value(&at).map_err(out_of_range)?;
            }
            fastest = fastest.max(rate.abs());
            let new = old[i] + dt * rate;
            if !(0.0..=HOTTEST).contains(&new) {
                return Err(self.diverged(
                    time,
                    i,
                    x[i],
                    &format!("{new:e} K is not within 0 K to {HOTTEST:e} K"),
                ));
            }
            self.temperature[i] = new;
        }
        self.step += 1;
        Ok(fastest)
    }

    fn diverged(&self, time_s: f64, i: usize, x: f64, what: &str) -> Failure {
        let (place, quantity) = (
            format!("point {i} at x = {x:.4e} m"),
            "temperature".to_owned(),
        );
        Failure::Diverged {
            step: self.step,
            time_s,
            place,
            quantity,
            what: what.to_owned(),
        }
    }
}

/// A rod at its start.
struct Ready {
    scene: Scene,
    curves: Curves,
    /// Places of its points \[m\].
    x: Vec<f64>,
    rod: Rod,
}

/// The stage.
struct Tester;

impl Tool for Tester {
    const NAME: &'static str = "rod";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const ABOUT: &'static str = "Heat along an insulated rod.";
    const EXAMPLE: &'static str = "cargo run --release -p run --example rod -- run tools/harness/run/examples/rod.json --out rod.mcap";
    const SCENE_KIND: &'static str = "rod.scene";
    const ARTEFACT_KIND: &'static str = "rod-temperature";
    const INPUTS: &'static [Input] = &[Input {
        name: "note",
        what: "any file",
        required: false,
    }];
    const CHECKPOINT_S: f64 = 0.05;
    type Scene = Scene;
    type Ready = Ready;

    fn prepare(scene: Scene, _: Inputs) -> Result<Ready, Failure> {
        let (curves, x) = (curves(&scene)?, places(&scene));
        let rod = Rod::new(&curves, &x)?;
        Ok(Ready {
            scene,
            curves,
            x,
            rod,
        })
    }

    fn plan(ready: &Ready) -> Result<Plan, Failure> {
        let Ready {
            scene,
            curves,
            x,
            rod,
        } = ready;
        let mut greatest = 0.0_f64;
        for t in &rod.temperature {
            let a = curves.diffusivity.at_temperature(*t);
            greatest = greatest.max(a.map_err(|e| Fault::at("/diffusivity_m2_s", e.to_string()))?);
        }
        let limit = scene.spacing_m * scene.spacing_m / (2.0 * greatest);
        let step = scene.time.step_s;
        if step > limit {
            let what =
                format!("{step} s is out of range: at most {limit:.4e} s, the limit of conduction");
            return Err(Fault::at("/time/step_s", what).into());
        }
        let plan = Plan::new()
            .stage("conduction")
            .count("points", x.len() as u64)
            .column("temperature_k", "K")
            .memory("temperature", 16 * x.len() as u64)
            .limit("step_conduction", limit, "s");
        Ok(if curves.source.is_some() {
            plan
        } else {
            plan.left_out("source", "no key 'source'")
        })
    }

    fn run(ready: Ready, session: &mut Session) -> Result<(), Failure> {
        let Ready {
            scene,
            curves,
            x,
            mut rod,
        } = ready;
        let time = &scene.time;
        if let Some(mut checkpoint) = session.restored() {
            rod = Rod::restore(&mut checkpoint)?;
        }
        let mut fastest = f64::INFINITY;
        while rod.step < time.steps {
            fastest = session.timed("conduction", || rod.advance(&scene, &curves, &x))?;
            #[allow(clippy::cast_precision_loss, reason = "below 2^53 steps")]
            let now = rod.step as f64 * time.step_s;
            if rod.step.is_multiple_of(time.table_steps) {
                let table = Table::new(x.len())
                    .column("x_m", "m", x.iter().copied())
                    .column("temperature_k", "K", rod.temperature.iter().copied());
                session.table("/temperature", now, &table)?;
                session.history("rate", "K/s", now, fastest);
            }
            session.progress(rod.step, time.steps, || {
                vec![("time", now, "s"), ("rate", fastest, "K/s")]
            });
            session.keep(|checkpoint| rod.save(checkpoint))?;
        }
        if let Some(wanted) = time.steady_k_s.filter(|wanted| fastest > *wanted) {
            session.warn(format!(
                "not steady: changes by {fastest:.3e} K/s, wanted is {wanted:.3e} K/s"
            ));
        }
        let heat: f64 = rod.temperature.iter().sum();
        session.closing("heat", "K", heat);
        session.record("/balance", 0.0, &Record::new().with("heat", "K", heat))
    }
}

fn main() -> ExitCode {
    run::main::<Tester>()
}
