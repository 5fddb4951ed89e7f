//! Fields of a scene that stand still: a stage of a march without a rate.

use run::{Failure, Session};

use super::march::{View, stage};
use super::setting::Setting;
use crate::cloud::Cloud;
use crate::march::scheme::State;
use crate::output::Found;
use crate::scene::{EddyCurrents, Scene};

/// Solves the fields of steady currents in a scene in `D` coordinates with `K` unknowns a point: 3 in space, else 1.
///
/// # Errors
/// Where a stencil cannot be made or the solve breaks down.
pub fn standing<const D: usize, const K: usize>(
    scene: &Scene,
    currents: &EddyCurrents,
    cloud: &Cloud,
    session: &mut Session,
) -> Result<Found, Failure> {
    let setting: Setting<'_, D> = Setting::new(scene, currents, cloud, session)?;
    setting.warn(session);
    let drive = session.timed("source", || setting.drive::<K>());
    let flux = setting.source.flux(&cloud.position);
    let charges = setting.charges(session)?;
    let mut stage = stage(&setting, &drive, (charges.as_ref(), 0.0), session)?;
    let source: Vec<f64> = drive.source.as_flattened().iter().map(|a| a.re).collect();
    let unknowns = source.len() + charges.as_ref().map_or(0, |c| c.stencils.len());
    let none = vec![0.0; unknowns];
    let mut unknown = none.clone();
    let stop = session.interrupt();
    let rule = super::rule(scene, &*stop);
    let solved = session.timed("solve", || {
        stage.solve(&none, (1.0, &[]), &mut unknown, rule)
    });
    let size = |i: usize| unknown[K * i..K * (i + 1)].iter().map(|a| a * a).sum();
    super::report(
        ("vector_potential", "V s/m"),
        &solved,
        (cloud, size),
        session,
    )?;
    setting.told(stage.settled(), session);
    let view = View {
        setting: &setting,
        drive: &drive,
        flux: &flux,
        charges: charges.as_ref(),
    };
    let mut total = unknown.clone();
    for (total, source) in total.iter_mut().zip(&source) {
        *total += source;
    }
    let state = State {
        following: vec![0.0; unknowns - source.len()],
        unknown,
        total,
        change: none,
    };
    let (found, _) = session.timed("fields", || view.fields(&state, (1.0, f64::INFINITY)));
    Ok(found)
}
