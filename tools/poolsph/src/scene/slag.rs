//! What is wrong with the second liquid of a scene.

use run::Fault;

use super::{Material, Scene, StartState};
use crate::heat::Substances;
use crate::motion::{self, Method, OnColdMetal};

impl Scene {
    /// What has a temperature; none where nothing has.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn substances(&self) -> Result<Option<Substances>, Fault> {
        let Some(heat) = &self.heat else {
            return Ok(None);
        };
        let caloric = heat.caloric().map_err(|fault| fault.within("/heat"))?;
        let (metal, made) = (self.metal(), Substances::of(caloric, self.metal()));
        let Some(slag) = &self.slag else {
            return Ok(Some(made));
        };
        let mass = slag.density_kg_m3 * metal.volume();
        Ok(Some(match slag.caloric()? {
            Some(own) => made.beside(own, mass),
            None => made,
        }))
    }
}

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
    faults.extend(warm(scene, slag));
    faults.extend(slag.slag().err());
    faults.extend(beside(scene));
    faults
}

/// Heat that one of both liquids lacks.
fn warm(scene: &Scene, slag: &motion::slag::Parameters) -> Option<Fault> {
    match (&scene.heat, &slag.heat) {
        (Some(_), None) => {
            let what = "has no heat beside that of the metal: name its conductivity and specific heat here";
            Some(Fault::at("/slag/heat", what).or_at("/slag"))
        }
        (None, Some(_)) => {
            let what = "means nothing without the key 'heat' of the metal";
            Some(Fault::at("/slag/heat", what))
        }
        _ => None,
    }
}

/// What knows of one liquid only.
fn beside(scene: &Scene) -> Vec<Fault> {
    let tense = (scene.slag.as_ref()).is_some_and(|slag| slag.interface_tension_n_m > 0.0);
    let angles = (scene.faces.as_ref()).is_some_and(|faces| !faces.contact_angles.is_empty());
    let idle = [
        ("arc", scene.arc.is_some(), "slag is no part of its circuit"),
        (
            "marangoni",
            scene.marangoni.is_some(),
            "slag has no slope of its tension",
        ),
        (
            "buoyancy",
            scene.buoyancy.is_some(),
            "it knows the expansion of the metal only",
        ),
        (
            "losses/evaporation",
            scene
                .losses
                .is_some_and(|losses| losses.evaporation.is_some()),
            "it is that of the metal",
        ),
        (
            "flow/on_cold_metal",
            scene
                .flow
                .as_ref()
                .is_some_and(|flow| flow.on_cold_metal == OnColdMetal::Sticks),
            "slag does not freeze to metal",
        ),
        ("grains", scene.grains.is_some(), "slag meets no grains"),
        ("start", scene.start.is_some(), "no slag is read from it"),
        (
            "lorentz",
            scene.lorentz.is_some(),
            "slag carries no current",
        ),
        (
            "gas_shear",
            scene.gas_shear.is_some(),
            "it knows the viscosity of the metal only",
        ),
        (
            "faces/contact_angles",
            tense && angles,
            "the interface meets faces at right angles",
        ),
    ];
    let there = idle.into_iter().filter(|(_, there, _)| *there);
    let fault = |(key, _, why): (&str, bool, &str)| {
        let what = format!("cannot stand beside the key 'slag': {why}");
        Fault::at(&format!("/{key}"), what).or_at("/slag")
    };
    there.map(fault).collect()
}

/// What is told of slag whose free surface has a tension beside that of the metal.
pub(super) fn unbalanced(scene: &Scene) -> Option<String> {
    (scene.slag.is_some() && scene.tension.is_some()).then(|| {
        "where the surfaces of slag and metal meet, their tensions and that of the interface are not balanced: how far slag spreads on \
         metal is not told"
            .to_owned()
    })
}
