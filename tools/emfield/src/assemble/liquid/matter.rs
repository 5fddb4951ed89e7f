//! What a scene says of a liquid, wherever it moves.

use run::{Failure, Fault, Plan};

use crate::liquid::step::{Matter, Way};
use crate::scene::{Liquid as Part, Scene};

/// Part of the time of a ripple of the drop that a step takes, over h/R.
pub(crate) const RIPPLE: f64 = 0.3;
/// Part of the time in which a spacing is fallen or passed.
pub(crate) const PASSED: f64 = 0.25;
/// Most points of a liquid.
const MOST: f64 = 5e6;

/// Whether so `many` points can be taken.
///
/// # Errors
/// Where there would be too many.
pub(crate) fn few(many: f64, spacing: f64) -> Result<(), Failure> {
    if many <= MOST {
        return Ok(());
    }
    let what =
        format!("{spacing} m: some {many:.0} points would fill the liquid, at most {MOST:e} can");
    Err(vec![Fault::at("/points/spacing_m", what)].into())
}

/// What it is made of, and what bears on it.
pub(crate) fn matter<const D: usize>(liquid: &Part) -> Matter<D> {
    let gravity = liquid.gravity_m_s2.as_deref().unwrap_or(&[]);
    Matter {
        density: liquid.density_kg_m3,
        viscosity: liquid.viscosity_pa_s,
        tension: liquid.surface_tension_n_m.unwrap_or(0.0),
        gas: liquid.gas_pressure_pa,
        gravity: std::array::from_fn(|k| gravity.get(k).copied().unwrap_or(0.0)),
    }
}

/// How its equations are fitted and solved.
pub(crate) fn way(scene: &Scene, liquid: &Part) -> Way {
    Way {
        spacing: scene.points.spacing_m,
        order: liquid.order,
        tolerance: scene.solver.tolerance,
        products: scene.solver.iterations,
    }
}

/// Adds what a liquid does without to a plan.
pub(crate) fn lacks(mut plan: Plan, part: &Part) -> Plan {
    for (absent, name, key) in [
        (part.viscosity_pa_s.is_none(), "viscosity", "viscosity_pa_s"),
        (
            part.surface_tension_n_m.is_none(),
            "surface tension",
            "surface_tension_n_m",
        ),
        (part.gravity_m_s2.is_none(), "gravity", "gravity_m_s2"),
        (part.groups.is_none(), "drops that meet", "groups"),
    ] {
        if absent {
            plan = plan.left_out(name, &format!("no key '{key}' of 'liquid'"));
        }
    }
    plan
}
