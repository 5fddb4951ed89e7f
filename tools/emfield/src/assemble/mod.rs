//! What a scene contains, and the parts of it in the order in which they need each other.

pub(crate) mod far;
pub(crate) mod liquid;
mod preview;

use run::{Failure, Session};

use crate::cloud::Cloud;
use crate::cloud::setup::layout;
use crate::frames::{self, Doubt, Found, Samples};
use crate::magnetic::parameters::Parameters;
use crate::magnetic::problem::Problem;
use crate::scene::{Geometry, Scene};
use crate::solve::setup::numerics;
use crate::surface::setup::enclosing;
use crate::{electric, magnetic, march, stencils};

pub(crate) use preview::preview;

/// Finds the fields of a scene and writes them.
///
/// # Errors
/// Where equations cannot be made or solved, the user interrupts, or the disk refuses.
pub(crate) fn solve(scene: &Scene, cloud: &Cloud, session: &mut Session) -> Result<(), Failure> {
    match scene.geometry {
        Geometry::Space => fields::<3, 3>(scene, cloud, session),
        Geometry::Plane | Geometry::Axisymmetric => fields::<2, 1>(scene, cloud, session),
    }
}

fn fields<const D: usize, const K: usize>(
    scene: &Scene,
    cloud: &Cloud,
    session: &mut Session,
) -> Result<(), Failure> {
    // Until a march has begun nothing is worth a checkpoint.
    let expendable = session.expendable();
    let layout = layout(scene);
    for what in layout.grains() {
        session.warn(what);
    }
    for what in layout.bends() {
        session.note(what);
    }
    let samples = session.timed("probes", || Samples::new::<D>(scene, cloud))?;
    let march = scene.eddy_currents.as_ref().and_then(|currents| {
        let transient = currents.transient.as_ref()?;
        Some((currents, transient))
    });
    if let Some((currents, transient)) = march {
        let still = electric::<D>(scene, cloud, session)?;
        session.stopped()?;
        drop(expendable);
        let mut doubts = Vec::new();
        let parameters = magnetic::setup::parameters(scene, currents, cloud, numerics(scene))?;
        let problem = problem::<D>(scene, &parameters, cloud, session)?;
        let output = &scene.output;
        march::currents::march::<D, K>(
            &problem,
            transient,
            output,
            session,
            |time, fields, session| {
                let mut all = still.clone();
                all.join(fields);
                doubts.append(&mut all.doubts);
                frames::write(scene, cloud, &samples, time, &all, session)
            },
        )?;
        tell(doubts, session);
        return Ok(());
    }
    let mut found = steady::<D, K>(scene, cloud, session)?;
    session.stopped()?;
    far::tell::<D, K>(scene, cloud, &found, session)?;
    session.stopped()?;
    tell(std::mem::take(&mut found.doubts), session);
    frames::write(scene, cloud, &samples, 0.0, &found, session)
}

/// The fields of charges and electrodes, if there are some.
fn electric<const D: usize>(
    scene: &Scene,
    cloud: &Cloud,
    session: &mut Session,
) -> Result<Found, Failure> {
    let electrostatics = scene.electrostatics.as_ref();
    electrostatics.map_or(Ok(Found::default()), |electrostatics| {
        electric::setup::electrostatics::<D>(
            scene,
            electrostatics,
            cloud,
            numerics(scene),
            enclosing(scene, cloud)?,
            session,
        )
    })
}

/// What the eddy currents of a scene are computed with.
fn problem<'a, const D: usize>(
    scene: &Scene,
    parameters: &'a Parameters,
    cloud: &'a Cloud,
    session: &mut Session,
) -> Result<Problem<'a, D>, Failure> {
    let region = stencils::setup::region(scene, cloud, &|_| false);
    Problem::new(parameters, cloud, region, enclosing(scene, cloud)?, session)
}

/// All fields of a scene that has no march.
fn steady<const D: usize, const K: usize>(
    scene: &Scene,
    cloud: &Cloud,
    session: &mut Session,
) -> Result<Found, Failure> {
    let mut found = electric::<D>(scene, cloud, session)?;
    session.stopped()?;
    if let Some(currents) = &scene.eddy_currents {
        let parameters = magnetic::setup::parameters(scene, currents, cloud, numerics(scene))?;
        let problem = problem::<D>(scene, &parameters, cloud, session)?;
        found.join(match currents.standing {
            Some(_) => problem.standing::<K>(session)?,
            None => problem.harmonic::<K>(session)?,
        });
    }
    Ok(found)
}

/// Difference of the ways of a force over its size from which it is a warning that matters; less is a note.
const MATTERS: f64 = 0.2;

/// Says which forces are in doubt: of each the largest of all instants.
fn tell(doubts: Vec<Doubt>, session: &mut Session) {
    let mut worst: Vec<Doubt> = Vec::new();
    for doubt in doubts {
        match worst.iter_mut().find(|w| w.of == doubt.of) {
            Some(w) if w.share < doubt.share => *w = doubt,
            Some(_) => {}
            None => worst.push(doubt),
        }
    }
    for doubt in worst {
        if doubt.share > MATTERS {
            session.warn(doubt.what);
        } else {
            session.note(doubt.what);
        }
    }
}
