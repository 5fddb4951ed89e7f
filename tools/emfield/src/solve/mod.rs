//! How equations are made and solved, and what is said of a solve.
//!
//! `setup`: how those of a scene are; `broken`: solves that fail, with the place.

pub(crate) mod broken;
pub(crate) mod setup;

use std::sync::atomic::AtomicBool;

use krylov::{Ending, Method, Options, Rule, Solved};
use run::{Failure, Session};

use crate::cloud::Cloud;
use crate::stencils::sides::Form;

/// How equations are made and solved.
#[derive(Debug, Clone, Copy)]
pub struct Numerics {
    /// How stencils are made.
    pub form: Form,
    /// How systems are solved.
    pub options: Options,
    /// Residual over the right side at which a solve ends.
    pub tolerance: f64,
    /// Most products of a solve.
    pub products: usize,
}

impl Numerics {
    /// The stencils of low order that precondition those of high order, whose own factors are unstable; none where the order
    /// is low, or `unknowns` equations are solved directly.
    #[must_use]
    pub fn low_order(&self, unknowns: usize) -> Option<Form> {
        let direct = match self.options.method {
            Method::Chosen => unknowns <= self.options.direct,
            Method::Direct => true,
            _ => false,
        };
        (self.form.order > 2 && !direct).then_some(Form {
            order: 2,
            ..Form::default()
        })
    }

    /// When solves stop; at once where `stop` is set.
    pub fn rule<'a>(&self, stop: impl Into<Option<&'a AtomicBool>>) -> Rule<'a> {
        Rule {
            reduction: self.tolerance,
            products: self.products,
            stop: stop.into(),
            ..Rule::default()
        }
    }
}

/// Keeps what had to be done for stencils beyond the usual, row by row as they were solved for.
pub(crate) fn supports(name: &str, report: &wls::Report, session: &mut Session) {
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
pub(crate) fn report(
    name: &str,
    unit: &str,
    solved: &Solved,
    cloud: &Cloud,
    size: impl Fn(usize) -> f64,
    session: &mut Session,
) -> Result<(), Failure> {
    for (k, value) in solved.history.iter().enumerate() {
        session.history(&format!("residual_{name}"), "1", k as f64, *value);
    }
    session.closing(&format!("products_{name}"), "1", solved.products as f64);
    let residual = solved.worst();
    session.closing(&format!("residual_{name}"), "1", residual);
    match &solved.ending {
        Ending::Converged => Ok(()),
        Ending::Stopped => session.stopped(),
        Ending::BrokenDown(why) => Err(broken::broken_down(name, unit, solved, *why, cloud, size)),
        other => {
            session.warn(format!(
                "not converged: {name}: {other}; residual {residual:.2e}"
            ));
            Ok(())
        }
    }
}
