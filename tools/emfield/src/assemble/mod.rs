//! From a scene and its points to equations, and from their solution to columns.

mod currents;
pub mod drive;
mod magnetic;
mod potential;
mod region;

use krylov::{Ending, Keep, Method, Options, Rule, Solved};
use run::{Failure, Session};

use crate::scene::Scene;
use crate::scene::method::Way;
use crate::solve::sides::Form;

pub use currents::eddy_currents;
pub use potential::electrostatics;
pub(crate) use region::region;

/// How the systems of a scene are solved.
fn options(scene: &Scene) -> Options {
    Options {
        method: match scene.solver.way {
            Way::Auto => Method::Chosen,
            Way::Direct => Method::Direct,
            Way::Iterative => Method::Incomplete(Keep::PATTERN),
        },
        ..Options::default()
    }
}

/// When the solves of a scene stop.
fn rule(scene: &Scene) -> Rule {
    Rule {
        reduction: scene.solver.tolerance,
        products: 2 * scene.solver.iterations,
        ..Rule::default()
    }
}

/// How the stencils of a scene are made.
fn form(scene: &Scene) -> Form {
    Form {
        order: scene.method.order as u8,
        support: scene.method.support,
        positive: scene.method.positive,
    }
}

/// Keeps what a solve says of itself.
///
/// # Errors
/// Where it broke down.
fn report(name: &str, solved: &Solved, session: &mut Session) -> Result<(), Failure> {
    for (k, value) in solved.history.iter().enumerate() {
        session.history(&format!("residual_{name}"), "1", k as f64, *value);
    }
    session.closing(&format!("products_{name}"), "1", solved.products as f64);
    let residual = solved.residuals.iter().copied().fold(0.0, f64::max);
    session.closing(&format!("residual_{name}"), "1", residual);
    match &solved.ending {
        Ending::Converged => Ok(()),
        Ending::BrokenDown(why) => Err(Failure::Other(format!("{name}: {why}"))),
        other => {
            session.warn(format!("{name}: {other}; residual {residual:.2e}"));
            Ok(())
        }
    }
}
