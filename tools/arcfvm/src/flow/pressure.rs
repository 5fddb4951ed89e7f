//! Flow and pressure by SIMPLE (Komen 2019, eqs 3.64 to 3.84).
//!
//! The pressure correction makes the discrete continuity hold; its source is the mass that a cell
//! lacks, `(r rho u)_w - (r rho u)_e) dz + ((rho u)_s - (rho u)_n) r dr` (eq. 3.84; eq. 3.77 prints
//! one r too many in both). Face mass fluxes are kept and corrected, so the other fields are carried
//! by fluxes that balance to the solver's tolerance.

use relax::{Coefficients, FivePoint};

use crate::case::{Case, Face, FlowCase};
use crate::equation::{Solver, Unsolved};
use crate::flow::field::{Carried, Flow};
use crate::flow::momentum_axial::AxialMomentum;
use crate::flow::momentum_radial::RadialMomentum;
use crate::grid::Grid;
use crate::material::GAS;
use crate::residual::Unbalanced;

/// How velocity corrections follow the pressure correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coupling {
    /// `du = A / AP` (eqs 3.74, 3.76).
    Simple,
    /// `du = A / (AP - sum of neighbours)` (Van Doormaal and Raithby 1984); pressure unrelaxed.
    Simplec,
}

/// Relaxation of the flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    /// Of the velocities, in (0, 1).
    pub velocity: f64,
    /// Of the pressure, in (0, 1].
    pub pressure: f64,
    /// Coupling of velocity and pressure.
    pub coupling: Coupling,
}

/// Equations and solvers of the flow.
#[derive(Debug, Clone)]
pub struct FlowSolver {
    radial: FivePoint,
    axial: FivePoint,
    correction: FivePoint,
    radial_slope: Vec<f64>,
    axial_slope: Vec<f64>,
    change: Vec<f64>,
    scratch: [Vec<f64>; 2],
    momentum_solver: [Solver; 2],
    pub(crate) pressure_solver: Solver,
}

/// Residuals of one pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowResidual {
    /// Unbalanced forces, radial and axial \[N\].
    pub force: Unbalanced,
    /// Sum of the forces that the velocities of both equations amount to \[N\], for scale.
    pub inertia: f64,
    /// Unbalanced mass fluxes before correction \[kg/s\].
    pub mass: Unbalanced,
}

/// Properties that the flow reads.
#[derive(Debug, Clone, Copy)]
pub struct FlowProperties<'a> {
    /// Density of each cell \[kg/m3\].
    pub density: &'a [f64],
    /// Viscosity of each cell \[Pa s\].
    pub viscosity: &'a [f64],
    /// Lorentz force at radial and axial faces \[N/m3\].
    pub lorentz: Option<[&'a [f64]; 2]>,
}

impl FlowSolver {
    /// Memory for the grid.
    #[must_use]
    pub fn new(grid: &Grid, momentum: Solver, pressure: Solver) -> Self {
        Self {
            radial: FivePoint::new(grid.nr + 1, grid.nz),
            axial: FivePoint::new(grid.nr, grid.nz + 1),
            correction: FivePoint::new(grid.nr, grid.nz),
            radial_slope: vec![0.0; grid.radial_faces()],
            axial_slope: vec![0.0; grid.axial_faces()],
            change: vec![0.0; grid.len()],
            scratch: [
                vec![0.0; grid.radial_faces()],
                vec![0.0; grid.axial_faces()],
            ],
            momentum_solver: [momentum.clone(), momentum],
            pressure_solver: pressure,
        }
    }

    /// One SIMPLE pass: momentum, pressure correction, corrected velocities and mass fluxes.
    ///
    /// # Errors
    /// When an equation is not usable or values leave the numbers; the text names the equation.
    pub fn pass(
        &mut self,
        case: &Case,
        setup: &FlowCase,
        flow: &mut Flow,
        properties: FlowProperties,
        relaxation: Relaxation,
    ) -> Result<FlowResidual, (&'static str, Unsolved)> {
        let FlowProperties {
            density,
            viscosity,
            lorentz,
        } = properties;
        let radial = RadialMomentum {
            case,
            setup,
            flow,
            viscosity,
            lorentz: lorentz.map(|f| f[0]),
        };
        self.radial.fill(|i, j| radial.equation(i, j));
        let axial = AxialMomentum {
            case,
            setup,
            flow,
            viscosity,
            density,
            lorentz: lorentz.map(|f| f[1]),
        };
        self.axial.fill(|i, j| axial.equation(i, j));
        let force = unbalanced(&self.radial, &flow.radial, &mut self.scratch[0]).and(unbalanced(
            &self.axial,
            &flow.axial,
            &mut self.scratch[1],
        ));
        let inertia = amount(&self.radial, &flow.radial) + amount(&self.axial, &flow.axial);
        self.radial.under_relax(&flow.radial, relaxation.velocity);
        self.axial.under_relax(&flow.axial, relaxation.velocity);
        let named = |name| move |e| (name, e);
        self.momentum_solver[0]
            .solve(&self.radial, &mut flow.radial)
            .map_err(named("radial momentum"))?;
        self.momentum_solver[1]
            .solve(&self.axial, &mut flow.axial)
            .map_err(named("axial momentum"))?;
        let gas = Carried {
            grid: &case.grid,
            setup,
            density,
        };
        flow.carry(gas);
        self.slopes(gas, relaxation.coupling);
        let mass = self
            .correct(case, gas, flow, relaxation.pressure)
            .map_err(named("pressure correction"))?;
        Ok(FlowResidual {
            force,
            inertia,
            mass,
        })
    }

    /// `du` of eqs 3.74 and 3.76 for every face.
    fn slopes(&mut self, gas: Carried<'_>, coupling: Coupling) {
        let (grid, faces) = (gas.grid, &gas.setup.faces);
        let simplec = coupling == Coupling::Simplec;
        let slope = |a: &FivePoint, k: usize, area: f64| {
            let sides = a.east[k] + a.west[k] + a.north[k] + a.south[k];
            area / (a.centre[k] - if simplec { sides } else { 0.0 })
        };
        for j in 0..grid.nz {
            for i in 0..=grid.nr {
                let k = grid.radial_face(i, j);
                let free = faces.radial[k] == Face::Solved;
                self.radial_slope[k] = if free {
                    slope(&self.radial, k, grid.area(i, j))
                } else {
                    0.0
                };
            }
        }
        for j in 0..=grid.nz {
            for i in 0..grid.nr {
                let k = grid.axial_face(i, j);
                let free = faces.axial[k] == Face::Solved;
                self.axial_slope[k] = if free {
                    slope(&self.axial, k, grid.ring[i])
                } else {
                    0.0
                };
            }
        }
    }

    /// Solves eq. 3.78 and applies it; returns the mass that was lacking.
    fn correct(
        &mut self,
        case: &Case,
        gas: Carried<'_>,
        flow: &mut Flow,
        relaxation: f64,
    ) -> Result<Unbalanced, Unsolved> {
        let (grid, closed) = (gas.grid, gas.setup.closed);
        let east = |i: usize, j: usize| {
            let slope = self.radial_slope[grid.radial_face(i, j)];
            slope * grid.area(i, j) * flow.radial_density(gas, i, j)
        };
        let north = |i: usize, j: usize| {
            let slope = self.axial_slope[grid.axial_face(i, j)];
            slope * grid.ring[i] * flow.axial_density(gas, i, j)
        };
        self.correction.fill(|i, j| {
            if !case.is_gas(i, j) {
                return Coefficients::fixed(0.0);
            }
            let [west, east, south, north] =
                [east(i, j), east(i + 1, j), north(i, j), north(i, j + 1)];
            let centre = west + east + south + north;
            let source = -flow.imbalance(grid, i, j);
            let inner = |a: f64, inside: bool| if inside { a } else { 0.0 };
            Coefficients {
                // A gas cell walled in on all sides keeps its pressure.
                centre: if centre > 0.0 { centre } else { 1.0 },
                east: inner(east, i + 1 < grid.nr),
                west: inner(west, i > 0),
                north: inner(north, j + 1 < grid.nz),
                south: inner(south, j > 0),
                source: if centre > 0.0 { source } else { 0.0 },
            }
        });
        if closed {
            balance(case, &mut self.correction);
        }
        let mass = Unbalanced::of(&self.correction.source, grid.nr);
        self.change.fill(0.0);
        self.pressure_solver
            .solve(&self.correction, &mut self.change)?;
        self.apply(gas, flow, relaxation);
        if closed {
            centre_pressure(case, &mut flow.pressure);
        }
        Ok(mass)
    }

    fn apply(&self, gas: Carried<'_>, flow: &mut Flow, relaxation: f64) {
        let grid = gas.grid;
        let at = |inside: bool, k: usize| if inside { self.change[k] } else { 0.0 };
        for j in 0..grid.nz {
            for i in 1..=grid.nr {
                let face = grid.radial_face(i, j);
                let west = at(true, grid.cell(i - 1, j));
                let east = at(i < grid.nr, grid.cell(i.min(grid.nr - 1), j));
                let step = self.radial_slope[face] * (west - east);
                let rho = flow.radial_density(gas, i, j);
                flow.radial[face] += step;
                flow.mass_radial[face] += rho * grid.area(i, j) * step;
            }
        }
        for j in 0..=grid.nz {
            for i in 0..grid.nr {
                let face = grid.axial_face(i, j);
                let south = at(j > 0, grid.cell(i, j.saturating_sub(1)));
                let north = at(j < grid.nz, grid.cell(i, j.min(grid.nz - 1)));
                let step = self.axial_slope[face] * (south - north);
                let rho = flow.axial_density(gas, i, j);
                flow.axial[face] += step;
                flow.mass_axial[face] += rho * grid.ring[i] * step;
            }
        }
        for (p, change) in flow.pressure.iter_mut().zip(&self.change) {
            *p += relaxation * change;
        }
    }
}

/// Spreads what a closed domain's edges let in too much, so that the correction has a solution.
fn balance(case: &Case, correction: &mut FivePoint) {
    let grid = &case.grid;
    let (mut excess, mut volume) = (0.0, 0.0);
    for j in 0..grid.nz {
        for i in (0..grid.nr).filter(|i| case.is_gas(*i, j)) {
            excess += correction.source[grid.cell(i, j)];
            volume += grid.volume(i, j);
        }
    }
    for j in 0..grid.nz {
        for i in (0..grid.nr).filter(|i| case.is_gas(*i, j)) {
            correction.source[grid.cell(i, j)] -= excess * grid.volume(i, j) / volume;
        }
    }
}

/// Gives the pressure of a closed domain a volume mean of zero.
fn centre_pressure(case: &Case, pressure: &mut [f64]) {
    let grid = &case.grid;
    let (mut sum, mut volume) = (0.0, 0.0);
    for j in 0..grid.nz {
        for i in (0..grid.nr).filter(|i| case.is_gas(*i, j)) {
            sum += pressure[grid.cell(i, j)] * grid.volume(i, j);
            volume += grid.volume(i, j);
        }
    }
    for (k, p) in pressure.iter_mut().enumerate() {
        if case.material[k] == GAS {
            *p -= sum / volume;
        }
    }
}

/// What an equation lacks before it is solved.
fn unbalanced(equation: &FivePoint, x: &[f64], scratch: &mut [f64]) -> Unbalanced {
    equation.residual(x, scratch);
    Unbalanced::of(scratch, equation.columns)
}

/// Sum of the central parts of an equation, for scale.
fn amount(equation: &FivePoint, x: &[f64]) -> f64 {
    let parts = equation.centre.iter().zip(x);
    parts.map(|(c, x)| (c * x).abs()).sum()
}
