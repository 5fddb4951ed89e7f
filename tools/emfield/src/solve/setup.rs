//! From a scene to how its equations are made and solved.

use krylov::{Grids, Keep, Method, Options};

use super::Numerics;
use crate::scene::Scene;
use crate::scene::method::Way;
use crate::stencils::sides::Form;

/// What incomplete factors by size have.
const LARGE: Keep = Keep::Threshold {
    drop: 1e-2,
    fill: 2.0,
};

/// How the equations of a scene are made and solved.
pub(crate) fn numerics(scene: &Scene) -> Numerics {
    Numerics {
        form: Form {
            order: scene.method.order as u8,
            support: scene.method.support,
            positive: scene.method.positive,
            ..Form::default()
        },
        options: Options {
            method: match scene.solver.way {
                Way::Auto => Method::Chosen,
                Way::Direct => Method::Direct,
                Way::Iterative => Method::Multigrid(Grids::default()),
                Way::Ilu0 => Method::Incomplete(Keep::PATTERN),
                Way::Ilut => Method::Incomplete(LARGE),
            },
            ..Options::default()
        },
        tolerance: scene.solver.tolerance,
        products: 2 * scene.solver.iterations,
    }
}
