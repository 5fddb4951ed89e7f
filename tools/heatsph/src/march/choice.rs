//! The march that a scene asks for.

use super::Method;
use super::explicit::Explicit;
use super::implicit::Implicit;
use super::stabilised::Stabilised;
use crate::scene::Scene;
use crate::scene::method::{Beyond, Controlled};
use crate::system::System;

/// Tolerance of the stages of the implicit method where steps are given.
const STAGE: f64 = 1e-10;

/// How steps are chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Steps {
    /// Part of the explicit limit.
    Limited,
    /// Given; what becomes of one beyond the limit.
    Given(f64, Beyond),
    /// By the error of a step.
    Controlled {
        /// Largest over the range of temperature.
        tolerance: f64,
        /// What is no error \[K\], if the scene says so.
        floor: Option<f64>,
    },
}

/// The method of a scene and how its steps are chosen; implicit with error control where the scene names none.
#[must_use]
pub fn method(scene: &Scene, system: &System) -> (Box<dyn Method>, Steps) {
    let time = scene.time.as_ref();
    if let Some(explicit) = time.and_then(|t| t.explicit) {
        let steps = explicit.step_s.map_or(Steps::Limited, |step| {
            Steps::Given(step, explicit.beyond_limit)
        });
        return (Box::new(Explicit::default()), steps);
    }
    let chosen = |controlled: Controlled| {
        let by_error = Steps::Controlled {
            tolerance: controlled.tolerance,
            floor: controlled.floor_k,
        };
        let given = |step| Steps::Given(step, Beyond::Substep);
        controlled.step_s.map_or(by_error, given)
    };
    if let Some(stabilised) = time.and_then(|t| t.stabilised) {
        return (Box::new(Stabilised::default()), chosen(stabilised));
    }
    let implicit = time.and_then(|t| t.implicit).unwrap_or_default();
    let steps = chosen(implicit);
    let (residual, guard) = match steps {
        Steps::Controlled { tolerance, .. } => ((1e-3 * tolerance).clamp(1e-12, 1e-8), false),
        _ => (STAGE, true),
    };
    (Box::new(Implicit::new(system, residual, guard)), steps)
}
