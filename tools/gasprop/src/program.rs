//! The program: plan, run, record.

use std::time::Instant;

use artefact::Version;
use rayon::prelude::*;
use run::{Estimate, Failure, Fault, Inputs, Plan, Session, Tool};

use crate::grid::{self, Sheet, Worst};
use crate::mixture::MixtureError;
use crate::properties::{Gas, GasError, Kept, PARTS, Point};
use crate::scene::{Scene, Temperatures};
use crate::table::{self, Errors, Rows};

/// Properties of plasmas.
#[derive(Debug)]
pub struct GasProp;

/// A gas and the states that are asked of it.
#[derive(Debug)]
pub struct Ready {
    scene: Scene,
    gas: Gas,
}

/// Temperatures that are evaluated between two looks at the clock, per thread.
const PER_THREAD: usize = 4;
/// Greatest error of linear interpolation that a table may have where the scene gives no limit: that of a rough property.
const LIMIT: f64 = 0.25;

impl Tool for GasProp {
    const NAME: &'static str = "gasprop";
    const VERSION: &'static str = env!("CARGO_PKG_VERSION");
    const ABOUT: &'static str = "Properties of plasmas of argon, carbon, oxygen and iron in local thermodynamic equilibrium.";
    const EXAMPLE: &'static str =
        "target/release/gasprop run pipelines/gases/argon.json --out build/gases/argon.mcap";
    const SCENE_KIND: &'static str = "gasprop.scene";
    const ARTEFACT_KIND: &'static str = "gas-table";
    const ARTEFACT_VERSION: Version = Version::new(1, 0);

    type Scene = Scene;
    type Ready = Ready;

    fn prepare(scene: Scene, _: Inputs) -> Result<Ready, Failure> {
        let faults = scene.faults();
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let gas = Gas::new(&scene).map_err(failure)?;
        Ok(Ready { scene, gas })
    }

    fn plan(ready: &Ready) -> Result<Plan, Failure> {
        Ok(shown(&ready.scene, &ready.gas))
    }

    fn estimate(ready: Ready) -> Result<Option<Estimate>, Failure> {
        let Ready { scene, gas } = ready;
        let iron = scene.iron();
        let probes = [1000.0, 8000.0, 20_000.0];
        let began = Instant::now();
        for t in probes {
            gas.at(t, iron[iron.len() - 1]).map_err(failure)?;
        }
        let each = began.elapsed().as_secs_f64() / probes.len() as f64;
        let threads = rayon::current_num_threads();
        Ok(Some(Estimate {
            seconds: each * states(&scene) as f64 / threads as f64,
            basis: format!("{:.2} ms a state, {threads} threads", 1e3 * each),
            memory: Vec::new(),
        }))
    }

    fn run(ready: Ready, session: &mut Session) -> Result<(), Failure> {
        let Ready { ref scene, gas } = ready;
        let mut work = Work {
            gas: &gas,
            session,
            done: 0,
            total: states(scene) as u64,
            kept: Kept::default(),
        };
        let (sheet, points) = temperatures(scene, &mut work)?;
        let between = work.rows(&sheet.temperatures, &grid::middles(scene.iron()))?;
        let kept = work.kept;
        let rows = Rows {
            iron: scene.iron(),
            temperatures: &sheet.temperatures,
            points: &points,
        };
        let (along_t, along_x) = (sheet.worst(), sheet.worst_of_iron(&numbers(&between)));
        let errors = Errors {
            temperature: &along_t,
            iron: if scene.iron().len() > 1 {
                &along_x
            } else {
                &[]
            },
        };
        session.table("/gas", 0.0, &rows.gas(&gas, &errors))?;
        session.table("/composition", 0.0, &rows.composition(&gas))?;
        session.table("/parts", 0.0, &rows.parts())?;
        let sources = table::sources(&gas, left_out(scene, &gas));
        session.json("/sources", 0.0, table::SOURCES, &sources)?;
        session.closing("element_error", "1", kept.element);
        session.closing("charge_error", "1", kept.charge);
        tell(scene, &gas, &errors, session);
        Ok(())
    }
}

/// A cold gas that cannot be is a fault of the scene.
fn failure(error: GasError) -> Failure {
    let text = error.to_string();
    match error {
        GasError::Mixture(MixtureError::Unknown(name) | MixtureError::Iron(name))
        | GasError::Mixture(MixtureError::Charged { name, .. }) => {
            Fault::at(&format!("/gas/{name}"), text).into()
        }
        GasError::Mixture(_) => Fault::at("/gas", text).into(),
        _ => Failure::Other(text),
    }
}

/// How many states a run evaluates: those of the table, and those between them that tell its error.
fn states(scene: &Scene) -> usize {
    let (temperatures, fractions) = (scene.count(), scene.iron().len());
    (2 * temperatures - 1) * fractions + temperatures * (fractions - 1)
}

/// Evaluation of many states, with progress.
struct Work<'a> {
    gas: &'a Gas,
    session: &'a mut Session,
    done: u64,
    total: u64,
    kept: Kept,
}

impl Work<'_> {
    /// Points at each of `temperatures` and each of `iron`. Each state depends on itself alone, so that threads change
    /// nothing.
    fn rows(&mut self, temperatures: &[f64], iron: &[f64]) -> Result<Vec<Vec<Point>>, Failure> {
        let gas = self.gas;
        let mut rows = Vec::with_capacity(temperatures.len());
        let at_once = PER_THREAD * rayon::current_num_threads();
        for some in temperatures.chunks(at_once) {
            let one = |t: &f64| -> Result<Vec<Point>, GasError> {
                iron.iter().map(|x| gas.at(*t, *x)).collect()
            };
            let found = self.session.timed("states", || {
                let found: Vec<_> = some.par_iter().map(one).collect();
                found.into_iter().collect::<Result<Vec<_>, _>>()
            });
            rows.extend(found.map_err(failure)?);
            for point in rows[rows.len() - some.len()..].iter().flatten() {
                self.kept = self.kept.worse(point.kept);
            }
            self.done += (some.len() * iron.len()) as u64;
            let hottest = some.iter().fold(0.0_f64, |most, t| most.max(*t));
            self.session.progress(self.done, self.total, || {
                vec![("temperature", hottest, "K")]
            });
            self.session.stopped()?;
        }
        Ok(rows)
    }
}

/// Values of the columns alone.
fn numbers(points: &[Vec<Point>]) -> Vec<grid::Rows> {
    let row = |at: &Vec<Point>| at.iter().map(|point| point.values.clone()).collect();
    points.iter().map(row).collect()
}

/// The temperatures of the table with their points, and their errors.
fn temperatures(scene: &Scene, work: &mut Work<'_>) -> Result<(Sheet, Vec<Vec<Point>>), Failure> {
    let start = match &scene.temperatures {
        Temperatures::Chosen(range) => grid::beginning(range.from_k, range.to_k, scene.count()),
        Temperatures::Even(range) => grid::even(range.from_k, range.to_k, scene.count()),
        Temperatures::ListK(list) => list.clone(),
    };
    let iron = scene.iron();
    let mut points = work.rows(&start, iron)?;
    let mut between = work.rows(&grid::middles(&start), iron)?;
    let mut sheet = Sheet {
        rows: numbers(&points),
        middles: numbers(&between),
        temperatures: start,
    };
    while sheet.temperatures.len() < scene.count() {
        let intervals = sheet.to_halve(scene.count());
        let fresh = sheet.halve(&intervals);
        let found = work.rows(&fresh, iron)?;
        sheet.fill(numbers(&found));
        let mut found = found.into_iter().rev();
        for k in intervals.iter().rev() {
            let after = found.next().unwrap_or_default();
            let before = found.next().unwrap_or_default();
            points.insert(k + 1, std::mem::replace(&mut between[*k], before));
            between.insert(k + 1, after);
        }
    }
    Ok((sheet, points))
}

/// What is not in the table, and why.
fn left_out(scene: &Scene, gas: &Gas) -> Vec<String> {
    let mut left_out = vec![
        "condensation: cold iron and carbon count as gas, whatever their vapour pressure".to_owned(),
        "thermal diffusion; magnetic field; departure of electrons from the temperature of the rest".to_owned(),
    ];
    if scene.radiation.is_some() {
        let molecules = gas.mixture().species.iter().any(|s| s.elements.len() > 1);
        if molecules {
            left_out.push("bands of molecules in the net emission: no data".to_owned());
        }
        left_out.push(
            "lines of ions beyond the first, light of capture below 200 nm: no data".to_owned(),
        );
    }
    left_out
}

fn shown(scene: &Scene, gas: &Gas) -> Plan {
    let species = &gas.mixture().species;
    let cells = (scene.count() * scene.iron().len()) as u64;
    let columns = gas.columns();
    let mut plan = Plan::new()
        .stage("states")
        .count("species", species.len() as u64)
        .count("temperatures", scene.count() as u64)
        .count("iron fractions", scene.iron().len() as u64)
        .count("states evaluated", states(scene) as u64)
        .memory(
            "table",
            8 * cells * (columns.len() + species.len() + PARTS.len()) as u64,
        );
    for column in columns {
        plan = plan.column(column.name, column.unit);
    }
    let names: Vec<&str> = species.iter().map(|s| s.name.as_str()).collect();
    plan = plan.note(format!("species: {}", names.join(" ")));
    if let Some(radiation) = gas.radiation() {
        let emitters = radiation
            .emitters(species)
            .map(|(name, lines)| format!("{name} {lines}"));
        plan = plan.note(format!(
            "lines: {}",
            emitters.collect::<Vec<_>>().join(", ")
        ));
    }
    let absent = [
        (
            scene.iron_mole_fraction.is_none(),
            "iron",
            "no key 'iron_mole_fraction'",
        ),
        (
            scene.radiation.is_none(),
            "net emission",
            "no key 'radiation'",
        ),
        (
            scene
                .radiation
                .is_some_and(|r| r.absorption_length_m.is_none()),
            "self-absorption",
            "no key 'absorption_length_m': the optically thin limit",
        ),
    ];
    for (_, what, why) in absent.iter().filter(|(absent, _, _)| *absent) {
        plan = plan.left_out(what, why);
    }
    for text in left_out(scene, gas) {
        plan = plan.note(format!("left out: {text}"));
    }
    plan
}

/// Says how well the table interpolates.
fn tell(scene: &Scene, gas: &Gas, errors: &Errors<'_>, session: &mut Session) {
    let columns = gas.columns();
    let limits = scene.accuracy;
    let sides = [
        (
            "temperature",
            errors.temperature,
            limits.map_or(LIMIT, |limit| limit.temperature),
            2.0,
        ),
        (
            "iron",
            errors.iron,
            limits.and_then(|limit| limit.iron).unwrap_or(LIMIT),
            2.0,
        ),
    ];
    for (along, worst, limit, power) in sides {
        let Some((column, worst)) = columns
            .iter()
            .zip(worst)
            .max_by(|a, b| a.1.error.total_cmp(&b.1.error))
        else {
            continue;
        };
        session.closing(&format!("interpolation_error_{along}"), "1", worst.error);
        let place = place(along, scene.iron(), worst);
        let text = format!(
            "linear interpolation along {along} errs by at most {:.2e} ({}, {place})",
            worst.error, column.name
        );
        if worst.error <= limit {
            session.note(text);
            continue;
        }
        // Along each axis the error falls with the square of the distance.
        let more = (worst.error / limit).powf(1.0 / power);
        let have = if along == "iron" {
            scene.iron().len()
        } else {
            scene.count()
        };
        session.warn(format!(
            "{text}, above the limit of {limit:e}: about {:.0} values instead of {have} would meet it",
            (have as f64 * more).ceil()
        ));
    }
}

fn place(along: &str, iron: &[f64], worst: &Worst) -> String {
    let at = &iron[worst.fraction];
    match (along, iron.get(worst.fraction + 1)) {
        ("iron", Some(next)) => format!(
            "{:.0} K, iron mole fraction {at} to {next}",
            worst.temperature
        ),
        _ => format!("{:.0} K, iron mole fraction {at}", worst.temperature),
    }
}
