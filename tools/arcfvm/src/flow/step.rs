//! The flow within an iteration.

use crate::error::Error;
use crate::flow::pressure::{FlowProperties, FlowResidual};
use crate::limits::check;
use crate::residual::{Unbalanced, part};
use crate::solver::{Arc, Flowing};

/// Speed that no gas here reaches \[m/s\].
const ABSURD_M_S: f64 = 1e5;
/// Iterations in which absurd speeds are slowed as a whole: from rest the flow creeps at first, and viscosity alone
/// bounds its speeds.
const FIRST: usize = 100;
/// To so much \[m/s\].
const FIRST_M_S: f64 = 1e4;

impl Arc {
    /// Velocities and pressure; returns the residuals of force and mass with their worst cells.
    ///
    /// # Errors
    /// When the flow diverges.
    pub(crate) fn solve_flow(&mut self) -> Result<[(f64, Unbalanced); 2], Error> {
        let Self {
            case,
            properties,
            electric,
            flowing,
            iteration,
            advance,
            ..
        } = self;
        let Some((setup, flowing)) = case.flow.as_ref().zip(flowing.as_mut()) else {
            return Ok([(0.0, Unbalanced::default()); 2]);
        };
        let Flowing { flow, solver } = flowing;
        let magnetic = electric.as_ref().map(|e| &e.magnetic);
        let lorentz = magnetic.map(|m| [m.force_radial.as_slice(), m.force_axial.as_slice()]);
        let reads = FlowProperties {
            density: &properties.density,
            viscosity: &properties.viscosity,
            lorentz,
        };
        let found = solver
            .pass(case, setup, flow, reads, advance.flow)
            .map_err(|(name, e)| Error::solver(name, *iteration, case, &e))?;
        if *iteration <= FIRST && !flow.within(ABSURD_M_S) {
            flow.slow(setup, FIRST_M_S);
        }
        check(case, "velocity", "m/s", *iteration, &flow.axial, ABSURD_M_S)?;
        let FlowResidual {
            force,
            inertia,
            mass,
        } = found;
        let forces = inertia + flow.forces(case, setup, lorentz, &properties.density);
        let throughput = flow.throughput(case, &properties.density);
        Ok([
            (part(force.amount, forces), force),
            (part(mass.amount, throughput), mass),
        ])
    }
}
