//! From a scene and its points to equations, and from their solution to columns.

mod about;
mod acting;
mod agree;
mod alternating;
mod bars;
mod between;
mod broken;
mod charge;
mod currents;
pub mod drive;
mod enclosed;
mod enclosing;
mod flow;
mod forces;
mod given;
mod growth;
mod heated;
mod levitated;
mod liquid;
mod magnetic;
mod magnets;
mod march;
mod matter;
mod meridian;
mod open;
mod potential;
mod preview;
mod region;
mod rest;
mod saturated;
mod sessile;
mod setting;
mod shorts;
mod skin;
mod standing;
mod steps;
mod unfit;
mod walls;
mod winding;

use std::sync::atomic::AtomicBool;

use krylov::{Ending, Grids, Keep, Method, Options, Rule, Solved};
use run::{Failure, Session};

use crate::cloud::Cloud;
use crate::scene::Scene;
use crate::scene::method::Way;
use crate::stencils::sides::Form;

pub use currents::eddy_currents;
pub use enclosing::enclosing;
pub use flow::flow;
pub use liquid::{estimate as estimate_flow, plan as plan_flow};
pub use magnets::magnets;
pub use march::march;
pub use open::room;
pub use potential::electrostatics;
pub use preview::preview;
pub(crate) use region::region;
pub use rest::rest;
pub use shorts::shorts;
pub use standing::standing;
pub(crate) use steps::Steps;
pub use winding::windings;

/// What incomplete factors by size have.
const LARGE: Keep = Keep::Threshold {
    drop: 1e-2,
    fill: 2.0,
};

/// How the systems of a scene are solved.
fn options(scene: &Scene) -> Options {
    Options {
        method: match scene.solver.way {
            Way::Auto => Method::Chosen,
            Way::Direct => Method::Direct,
            Way::Iterative => Method::Multigrid(Grids::default()),
            Way::Ilu0 => Method::Incomplete(Keep::PATTERN),
            Way::Ilut => Method::Incomplete(LARGE),
        },
        ..Options::default()
    }
}

/// When the solves of a scene stop; at once where `stop` is set.
fn rule<'a>(scene: &Scene, stop: impl Into<Option<&'a AtomicBool>>) -> Rule<'a> {
    Rule {
        reduction: scene.solver.tolerance,
        products: 2 * scene.solver.iterations,
        stop: stop.into(),
        ..Rule::default()
    }
}

/// How the stencils of a scene are made.
pub(crate) fn form(scene: &Scene) -> Form {
    Form {
        order: scene.method.order as u8,
        support: scene.method.support,
        positive: scene.method.positive,
        ..Form::default()
    }
}

/// The stencils of low order that precondition those of high order, whose own factors are unstable; none where the order
/// is low, or `unknowns` equations are solved directly.
fn low_order(scene: &Scene, unknowns: usize) -> Option<Form> {
    let direct = match scene.solver.way {
        Way::Auto => unknowns <= Options::default().direct,
        Way::Direct => true,
        Way::Iterative | Way::Ilu0 | Way::Ilut => false,
    };
    (scene.method.order > 2 && !direct).then_some(Form {
        order: 2,
        ..Form::default()
    })
}

/// Keeps what had to be done for stencils beyond the usual, row by row as they were solved for.
fn supports(name: &str, report: &wls::Report, session: &mut Session) {
    for (what, count) in [
        ("supports_enlarged", report.enlarged),
        ("supports_by_room", report.by_room),
        ("supports_by_singular_values", report.by_svd),
        ("orders_lowered", report.lowered),
        ("positive_made", report.positive_made),
        ("positive_failed", report.positive_failed),
    ] {
        if count > 0 {
            session.closing(&format!("{what}_{name}"), "1", count as f64);
        }
    }
    let worst = report.worst_condition;
    session.closing(&format!("worst_condition_{name}"), "1", worst);
}

/// Keeps what a solve says of itself; `size` of the solution at a point tells where it broke down.
///
/// # Errors
/// Where it broke down, or was stopped.
fn report(
    (name, unit): (&str, &str),
    solved: &Solved,
    (cloud, size): (&Cloud, impl Fn(usize) -> f64),
    session: &mut Session,
) -> Result<(), Failure> {
    for (k, value) in solved.history.iter().enumerate() {
        session.history(&format!("residual_{name}"), "1", k as f64, *value);
    }
    session.closing(&format!("products_{name}"), "1", solved.products as f64);
    let residual = solved.residuals.iter().copied().fold(0.0, f64::max);
    session.closing(&format!("residual_{name}"), "1", residual);
    match &solved.ending {
        Ending::Converged => Ok(()),
        Ending::Stopped => session.stopped(),
        Ending::BrokenDown(why) => Err(broken::broken_down(
            (name, unit),
            (solved, *why),
            cloud,
            size,
        )),
        other => {
            session.warn(format!(
                "not converged: {name}: {other}; residual {residual:.2e}"
            ));
            Ok(())
        }
    }
}
