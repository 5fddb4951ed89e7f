//! One file per exact solution.

mod arc_elenbaas;
mod arc_mms;
mod arc_pinch;
mod arc_poiseuille;
mod arc_potential;
mod pool_drop_oscillation;
mod pool_drop_pressure;
mod pool_hydrostatic;
mod pool_rosenthal;
mod pool_stefan;
mod pool_surface_heat;

use crate::case::Case;

/// Every case, in the order in which `make verify` runs them.
#[must_use]
pub fn all() -> Vec<Box<dyn Case>> {
    vec![
        Box::new(arc_elenbaas::ArcElenbaas),
        Box::new(arc_mms::ArcMms),
        Box::new(arc_pinch::ArcPinch),
        Box::new(arc_poiseuille::ArcPoiseuille),
        Box::new(arc_potential::ArcPotential),
        Box::new(pool_drop_oscillation::PoolDropOscillation),
        Box::new(pool_drop_pressure::PoolDropPressure),
        Box::new(pool_hydrostatic::PoolHydrostatic),
        Box::new(pool_rosenthal::PoolRosenthal),
        Box::new(pool_stefan::PoolStefan),
        Box::new(pool_surface_heat::PoolSurfaceHeat),
    ]
}
