//! What is wrong with the second liquid of a scene.

use run::Fault;

use super::{Material, Scene, StartState};
use crate::motion::Method;

/// Greatest ratio of densities between both liquids: beyond it the lighter one is as good as nothing.
const RATIO_MOST: f64 = 100.0;

/// Every fault of the slag.
pub(super) fn faults(scene: &Scene) -> Vec<Fault> {
    let bodies = scene.bodies.iter().enumerate();
    let mut ours = bodies.filter(|(_, body)| body.material == Material::Slag);
    let Some(slag) = &scene.slag else {
        let fault = |(i, _)| {
            let what = "is slag, of which the scene tells nothing: it needs the key 'slag'";
            Fault::at(&format!("/bodies/{i}/material"), what)
        };
        return ours.map(fault).collect();
    };
    let mut faults: Vec<Fault> = ours
        .clone()
        .filter(|(_, body)| body.state != StartState::Liquid)
        .map(|(i, _)| {
            let what = "slag is liquid: its state must be \"liquid\"";
            Fault::at(&format!("/bodies/{i}/state"), what)
        })
        .collect();
    if ours.next().is_none() {
        let what = "no body is slag: a body becomes it by \"material\": \"slag\"";
        faults.push(Fault::at("/slag", what));
    }
    let ratio = slag.density_kg_m3 / scene.density_kg_m3;
    if !(1.0 / RATIO_MOST..=RATIO_MOST).contains(&ratio) {
        let what = format!(
            "{} kg/m3 is {ratio:.3e} of the {} kg/m3 of the metal; 1/{RATIO_MOST} to {RATIO_MOST} can be told apart",
            slag.density_kg_m3, scene.density_kg_m3
        );
        faults.push(Fault::at("/slag/density_kg_m3", what).or_at("/density_kg_m3"));
    }
    match &scene.flow {
        None => faults.push(Fault::at("/slag", "means nothing without the key 'flow'")),
        Some(flow) if flow.method != Method::DivergenceFree => {
            let what =
                "knows one liquid: beside slag leave \"method\" out, or take \"divergence_free\"";
            faults.push(Fault::at("/flow/method", what).or_at("/slag"));
        }
        Some(_) => {}
    }
    let idle = [
        ("heat", scene.heat.is_some()),
        ("grains", scene.grains.is_some()),
        ("start", scene.start.is_some()),
    ];
    let there = idle.into_iter().filter(|(_, there)| *there);
    faults.extend(there.map(|(key, _)| {
        let what = "cannot stand beside the key 'slag': its particles have no temperature, and meet no grains";
        Fault::at(&format!("/{key}"), what).or_at("/slag")
    }));
    faults
}
