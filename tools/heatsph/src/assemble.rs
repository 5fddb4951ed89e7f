//! From a scene to a system of equations and its first temperatures.

use run::Fault;
use run::property::{Arguments, Curve, OutOfRange};

use crate::body::Body;
use crate::boundary::{self, Surface};
use crate::cloud::Cloud;
use crate::material::{Materials, PLACE};
use crate::operator::Links;
use crate::scene::Scene;
use crate::system::{System, extent};

/// What a source may depend on.
const SOURCE: [&str; 6] = ["x", "y", "z", "r", "T", "t"];

/// The system of a scene and the temperatures of its points at the start \[K\].
///
/// # Errors
/// Faults of the scene, all that can be found at once.
pub fn system(scene: &Scene) -> Result<(System, Vec<f64>), Vec<Fault>> {
    let faults = scene.faults();
    if !faults.is_empty() {
        return Err(faults);
    }
    let body = Body::new(&scene.body, scene.dimensions);
    let cloud = Cloud::fill(&body, &scene.points, scene.dimensions)
        .map_err(|error| vec![Fault::at("/points", error.to_string())])?;
    let surface = boundary::compile(scene, &cloud)?;
    let at_points = initial(scene, &cloud, &surface, |i, curve| {
        curve.value(&Arguments::at(cloud.position[i], 0.0))
    })?;
    let range = range(scene, &surface, &at_points);
    let materials = Materials::new(scene, range)?;
    let temperature = initial(scene, &cloud, &surface, |i, curve| {
        materials.start((cloud.position[i], cloud.spacing[i]), &body, curve)
    })?;
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
    let system = System::new((cloud, links), (materials, surface), source, &body)
        .map_err(|error| vec![Fault::at("/materials", error.to_string())])?;
    Ok((system, temperature))
}

/// Temperatures at the start, those of held points as prescribed, of others as `value` has them.
fn initial(
    scene: &Scene,
    cloud: &Cloud,
    surface: &Surface,
    value: impl Fn(usize, &Curve) -> Result<f64, OutOfRange>,
) -> Result<Vec<f64>, Vec<Fault>> {
    let at = "/initial_temperature_k";
    let curve = scene
        .initial_temperature_k
        .compile(at, &PLACE)
        .map_err(|f| vec![f])?;
    let mut temperature: Vec<f64> = (0..cloud.position.len())
        .map(|i| value(i, &curve))
        .collect::<Result<_, _>>()
        .map_err(|error| vec![Fault::at(at, error.to_string())])?;
    for held in &surface.held {
        let i = held.point as usize;
        temperature[i] = surface
            .prescribed(*held, cloud.position[i], 0.0)
            .map_err(|error| {
                vec![Fault::at(
                    &format!("/boundaries/{}", held.entry),
                    error.to_string(),
                )]
            })?;
    }
    Ok(temperature)
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
