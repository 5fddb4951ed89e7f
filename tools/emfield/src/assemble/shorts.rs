//! Electrodes that touch what is held at another potential: a short circuit, whose field has no bounds.

use run::{Failure, Fault};
use shapes::Body;
use shapes::frame::Vector;

use super::walls::Walls;
use crate::cloud::{Class, Cloud};
use crate::electric::equations::Held;
use crate::scene::{Electrostatics, Scene};

/// Gap over spacing below which electrodes count as touching: far less than points can resolve.
const TOUCH: f64 = 0.03;
/// Potentials whose difference is this part of theirs are the same.
const SAME: f64 = 1e-9;

/// Refuses electrodes that touch walls or each other at different potentials.
///
/// # Errors
/// The short circuits, each with its place; what a potential of a wall cannot tell.
pub fn shorts(
    scene: &Scene,
    electrostatics: &Electrostatics,
    cloud: &Cloud,
) -> Result<(), Failure> {
    let dimensions = scene.geometry.dimensions();
    let electrodes: Vec<(usize, f64, Body)> = scene
        .bodies
        .iter()
        .enumerate()
        .filter_map(|(k, b)| Some((k, b.potential_v?, Body::new(&b.shape, dimensions))))
        .collect();
    if electrodes.is_empty() {
        return Ok(());
    }
    let walls = Walls::new(scene, electrostatics)?;
    let mut faults: Vec<Option<Fault>> = vec![None; scene.bodies.len()];
    for (i, x) in cloud.position.iter().enumerate() {
        let own = scene.geometry.coordinates(*x);
        let touching = electrodes
            .iter()
            .filter(|(.., body)| body.distance(own) < TOUCH * cloud.spacing[i]);
        let (given, name) = match cloud.class[i] {
            // Nothing is held there.
            Class::Outer { .. } if walls.open => continue,
            Class::Outer { face, .. } => match walls.held(*x)? {
                Held::Potential(v) => {
                    let name = scene.domain.walls(scene.geometry)[face as usize];
                    (v, format!("the wall {name}"))
                }
                Held::Insulated => continue,
            },
            Class::Interface { inner, .. } => match electrode(scene, inner) {
                Some((v, name)) => (v, format!("the electrode {name}")),
                None => continue,
            },
            Class::Inside(_) => continue,
        };
        for (k, v, _) in touching {
            if (v - given).abs() > SAME * v.abs().max(given.abs()) {
                faults[*k].get_or_insert_with(|| short(*k, (*v, given), &name, *x));
            }
        }
    }
    let faults: Vec<Fault> = faults.into_iter().flatten().collect();
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults.into())
    }
}

/// Potential and name of a medium that is an electrode.
fn electrode(scene: &Scene, medium: u8) -> Option<(f64, &str)> {
    let body = &scene.bodies[(medium as usize).checked_sub(1)?];
    Some((body.potential_v?, &body.name))
}

fn short(k: usize, (own, other): (f64, f64), name: &str, [x, y, z]: Vector) -> Fault {
    let what = format!(
        "{own} V touches {name} at {other} V at ({x:.3e}, {y:.3e}, {z:.3e}) m, a short circuit: give both one potential, or leave a gap of more than {TOUCH} spacings"
    );
    Fault::at(&format!("/bodies/{k}/potential_v"), what)
}
