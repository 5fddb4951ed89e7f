//! From a scene to a system of equations and its first temperatures.

mod doubts;
mod places;
pub mod preview;

use run::Fault;
use run::property::{Arguments, OutOfRange};

use crate::boundary::{self, Surface};
use crate::cloud::{Cloud, room};
use crate::material::cells::Ground;
use crate::material::{self, PLACE};
use crate::operator::Links;
use crate::scene::Scene;
use crate::source::Source;
use crate::system::{System, extent};
use crate::torches::Torches;
use shapes::Body;

/// What a source may depend on.
const SOURCE: [&str; 6] = ["x", "y", "z", "r", "T", "t"];

/// The system of a scene and the temperatures of its points at the start \[K\].
///
/// # Errors
/// Faults of the scene, all that can be found at once.
pub fn system(scene: &Scene) -> Result<(System, Vec<f64>), Vec<Fault>> {
    let (body, cloud) = filled(scene)?;
    places::monitors(scene, &body)?;
    let surface = boundary::setup::surface(scene, &cloud)?;
    let at = "/initial_temperature_k";
    let fault = |at: &str, error: OutOfRange| vec![Fault::at(at, error.to_string())];
    let curve = scene
        .initial_temperature_k
        .compile_temperature(at, &PLACE)
        .map_err(|f| vec![f])?;
    let values = cloud
        .position
        .iter()
        .map(|x| curve.kelvin(&Arguments::at(*x, 0.0)));
    let mut temperature: Vec<f64> = values.collect::<Result<_, _>>().map_err(|e| fault(at, e))?;
    hold(&surface, &cloud, &mut temperature)?;
    let materials = material::setup::materials(scene, range(scene, &surface, &temperature))?;
    places::mixtures(scene, &materials, &cloud)?;
    let source = match &scene.source_w_m3 {
        Some(property) => Some(
            property
                .compile("/source_w_m3", &SOURCE)
                .map_err(|f| vec![f])?,
        ),
        None => None,
    };
    let links = Links::new(&cloud, scene.operator)
        .map_err(|error| vec![Fault::at("/operator", error.to_string())])?;
    let spread = |curve| Source::new(curve, &cloud, &links.volume, &body);
    let source = source.map(spread).transpose();
    let source = source.map_err(|error| fault("/source_w_m3", error))?;
    let ground = Ground {
        cloud: &cloud,
        links: &links,
        body: &body,
    };
    let doubts = doubts::all(scene, &surface, &materials, ground);
    let mut cells = materials
        .cells(ground, &curve)
        .map_err(|e| fault("/materials", e))?;
    hold(&surface, &cloud, &mut cells.temperature)?;
    let storage = match scene.steady {
        Some(_) => cells.storage.still(&cells.temperature),
        None => cells.storage,
    };
    let torches = (!scene.torches.is_empty())
        .then(|| Torches::new(scene.torches.clone(), &links.volume).over(&body, &cloud));
    let system = System::new(cloud, links, materials, surface, storage, source)
        .map_err(|error| fault("/materials", error))?
        .under(torches)
        .doubted(doubts);
    Ok((system, cells.temperature))
}

/// The body of a scene and the points that fill it.
///
/// # Errors
/// Faults of the scene; more points than there is memory for.
pub fn filled(scene: &Scene) -> Result<(Body, Cloud), Vec<Fault>> {
    let faults = scene.faults();
    if !faults.is_empty() {
        return Err(faults);
    }
    let body = Body::new(&scene.body, scene.dimensions);
    let spacing = scene.points.spacing_m;
    let points = room::least_points(&body, spacing, scene.dimensions);
    let wanted = room::bytes(points, scene.dimensions);
    let what = format!("at a spacing of {spacing} m there are {points:.1e} points and more");
    let change = "take a larger spacing or a smaller body";
    let crowded = run::crowded("/points/spacing_m", &what, wanted, change);
    if let Some(fault) = crowded.filter(|_| points.is_finite()) {
        return Err(vec![fault.or_at("/body")]);
    }
    let cloud = Cloud::fill(&body, &scene.points, scene.dimensions)
        .map_err(|error| vec![Fault::at("/points", error.to_string())])?;
    Ok((body, cloud))
}

/// Gives held points their temperatures at the start.
fn hold(surface: &Surface, cloud: &Cloud, temperature: &mut [f64]) -> Result<(), Vec<Fault>> {
    for held in &surface.held {
        let i = held.point as usize;
        let value = surface.prescribed(*held, cloud.position[i], 0.0);
        temperature[i] = value.map_err(|error| {
            let at = format!("/boundaries/{}", held.entry);
            vec![Fault::at(&at, error.to_string())]
        })?;
    }
    Ok(())
}

/// Temperatures between which tables are made at first: those of the start and of constant surroundings.
fn range(scene: &Scene, surface: &Surface, temperature: &[f64]) -> (f64, f64) {
    let (low, high) = surface.extent(extent(temperature));
    if high > low {
        (low, high)
    } else {
        // One temperature everywhere: the tables widen as it changes.
        let width = 1e-3 * low.abs().max(if scene.time.is_some() { 1e-3 } else { 1.0 });
        (low, low + width)
    }
}
