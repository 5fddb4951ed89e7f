//! Electric potential and current (Komen 2019, eqs 5.10 to 5.15).
//!
//! The charge balance of a cell is the sum of its face currents; a face current is the potential
//! difference over the two half-cell resistances in series, which is the harmonic mean of the
//! conductivities. Each half resistance heats its own cell with I^2 R: the sum over all cells is the
//! power of the source exactly, as the sum of current times voltage over any closed network is zero.

use relax::{Coefficients, FivePoint};

use crate::case::{Case, PotentialCase, PotentialEdge};
use crate::equation::{Solver, Unsolved};
use crate::grid::Grid;
use crate::residual::Unbalanced;

/// Potential and currents.
#[derive(Debug, Clone)]
pub struct Potential {
    /// Potential \[V\], `[nr nz]`.
    pub value: Vec<f64>,
    /// Current through radial faces, outward \[A\].
    pub radial: Vec<f64>,
    /// Current through axial faces, upward \[A\].
    pub axial: Vec<f64>,
    /// Joule heat of each cell \[W\], `[nr nz]`.
    pub joule: Vec<f64>,
    /// Potential of the driven faces \[V\].
    pub drive: f64,
    /// What the last solve found out of balance before it \[A\].
    pub unbalanced: Unbalanced,
    equation: FivePoint,
    scratch: Vec<f64>,
    pub(crate) solver: Solver,
}

/// Half-cell resistances of the conductivity field.
struct Network<'a> {
    grid: &'a Grid,
    sigma: &'a [f64],
}

impl Network<'_> {
    /// Resistance from the centre of cell `(i, j)` to its radial face `face` \[ohm\].
    fn radial(&self, i: usize, j: usize, face: usize) -> f64 {
        let distance = (self.grid.rf[face] - self.grid.rc[i]).abs();
        distance / (self.sigma[self.grid.cell(i, j)] * self.grid.area(face, j))
    }

    /// Resistance from the centre of cell `(i, j)` to either axial face \[ohm\].
    fn axial(&self, i: usize, j: usize) -> f64 {
        0.5 * self.grid.dz[j] / (self.sigma[self.grid.cell(i, j)] * self.grid.ring[i])
    }

    /// Conductance across radial face `face`, between two cells \[S\].
    fn across_radial(&self, face: usize, j: usize) -> f64 {
        1.0 / (self.radial(face - 1, j, face) + self.radial(face, j, face))
    }

    /// Conductance across axial face `face`, between two cells \[S\].
    fn across_axial(&self, i: usize, face: usize) -> f64 {
        1.0 / (self.axial(i, face - 1) + self.axial(i, face))
    }
}

/// What an edge adds to the balance of its cell: conductance to a fixed potential, and a source.
fn edge_terms(edge: PotentialEdge, drive: f64, resistance: f64) -> (f64, f64) {
    match edge {
        PotentialEdge::Insulated => (0.0, 0.0),
        PotentialEdge::Driven => (1.0 / resistance, drive / resistance),
        PotentialEdge::Voltage(v) => (1.0 / resistance, v / resistance),
        PotentialEdge::Current(i) => (0.0, i),
    }
}

impl Potential {
    /// A potential of zero.
    #[must_use]
    pub fn new(grid: &Grid, solver: Solver) -> Self {
        Self {
            value: vec![0.0; grid.len()],
            radial: vec![0.0; grid.radial_faces()],
            axial: vec![0.0; grid.axial_faces()],
            joule: vec![0.0; grid.len()],
            drive: 1.0,
            unbalanced: Unbalanced::default(),
            equation: FivePoint::new(grid.nr, grid.nz),
            scratch: vec![0.0; grid.len()],
            solver,
        }
    }

    /// Solves for the conductivity `sigma` \[S/m\] and works out currents and Joule heat.
    ///
    /// # Errors
    /// When the equation is not usable or the values leave the numbers.
    pub fn solve(
        &mut self,
        case: &Case,
        setup: &PotentialCase,
        sigma: &[f64],
    ) -> Result<(), Unsolved> {
        let network = Network {
            grid: &case.grid,
            sigma,
        };
        let drive = self.drive;
        self.equation
            .fill(|i, j| cell_equation(&network, setup, drive, i, j));
        self.equation.residual(&self.value, &mut self.scratch);
        self.unbalanced = Unbalanced::of(&self.scratch, case.grid.nr);
        self.solver.solve(&self.equation, &mut self.value)?;
        self.currents(&network, setup);
        if let Some(current) = setup.driven {
            self.drive_to(&case.grid, setup, current);
        }
        Ok(())
    }

    fn currents(&mut self, network: &Network, setup: &PotentialCase) {
        let grid = network.grid;
        self.joule.fill(0.0);
        for j in 0..grid.nz {
            for i in 0..=grid.nr {
                self.radial_current(network, setup, i, j);
            }
        }
        for j in 0..=grid.nz {
            for i in 0..grid.nr {
                self.axial_current(network, setup, i, j);
            }
        }
    }

    fn radial_current(&mut self, network: &Network, setup: &PotentialCase, i: usize, j: usize) {
        let grid = network.grid;
        let face = grid.radial_face(i, j);
        if i == 0 {
            let k = grid.cell(0, j);
            let edge = setup.edges.inner[j];
            self.radial[face] = self.edge_current(edge, k, || network.radial(0, j, 0));
        } else if i == grid.nr {
            let k = grid.cell(i - 1, j);
            let edge = setup.edges.outer[j];
            self.radial[face] = -self.edge_current(edge, k, || network.radial(i - 1, j, i));
        } else {
            let (west, east) = (grid.cell(i - 1, j), grid.cell(i, j));
            let halves = (network.radial(i - 1, j, i), network.radial(i, j, i));
            self.radial[face] = self.inner_current(west, east, halves);
        }
    }

    fn axial_current(&mut self, network: &Network, setup: &PotentialCase, i: usize, j: usize) {
        let grid = network.grid;
        let face = grid.axial_face(i, j);
        if j == 0 {
            let edge = setup.edges.bottom[i];
            self.axial[face] = self.edge_current(edge, grid.cell(i, 0), || network.axial(i, 0));
        } else if j == grid.nz {
            let edge = setup.edges.top[i];
            let k = grid.cell(i, j - 1);
            self.axial[face] = -self.edge_current(edge, k, || network.axial(i, j - 1));
        } else {
            let (south, north) = (grid.cell(i, j - 1), grid.cell(i, j));
            let halves = (network.axial(i, j - 1), network.axial(i, j));
            self.axial[face] = self.inner_current(south, north, halves);
        }
    }

    fn inner_current(&mut self, from: usize, to: usize, halves: (f64, f64)) -> f64 {
        let current = (self.value[from] - self.value[to]) / (halves.0 + halves.1);
        self.joule[from] += current * current * halves.0;
        self.joule[to] += current * current * halves.1;
        current
    }

    /// Current into the domain through an edge face of cell `k`.
    fn edge_current(&mut self, edge: PotentialEdge, k: usize, resistance: impl Fn() -> f64) -> f64 {
        match edge {
            PotentialEdge::Insulated => 0.0,
            PotentialEdge::Current(current) => current,
            PotentialEdge::Voltage(_) | PotentialEdge::Driven => {
                let v = if let PotentialEdge::Voltage(v) = edge {
                    v
                } else {
                    self.drive
                };
                let resistance = resistance();
                let current = (v - self.value[k]) / resistance;
                self.joule[k] += current * current * resistance;
                current
            }
        }
    }

    /// Scales the potential so that `wanted` \[A\] enters through the driven faces: exact, as the
    /// equation is linear and all else is at zero potential or insulated.
    fn drive_to(&mut self, grid: &Grid, setup: &PotentialCase, wanted: f64) {
        let driven = |edge: &PotentialEdge| *edge == PotentialEdge::Driven;
        let rows = |edges: &[PotentialEdge], face: usize, sign: f64| {
            let at = |j: usize| sign * self.radial[grid.radial_face(face, j)];
            (0..grid.nz)
                .filter(|j| driven(&edges[*j]))
                .map(at)
                .sum::<f64>()
        };
        let columns = |edges: &[PotentialEdge], face: usize, sign: f64| {
            let at = |i: usize| sign * self.axial[grid.axial_face(i, face)];
            (0..grid.nr)
                .filter(|i| driven(&edges[*i]))
                .map(at)
                .sum::<f64>()
        };
        let edges = &setup.edges;
        let found = rows(&edges.inner, 0, 1.0)
            + rows(&edges.outer, grid.nr, -1.0)
            + columns(&edges.bottom, 0, 1.0)
            + columns(&edges.top, grid.nz, -1.0);
        let factor = wanted / found;
        self.drive *= factor;
        for column in [&mut self.value, &mut self.radial, &mut self.axial] {
            column.iter_mut().for_each(|v| *v *= factor);
        }
        self.joule.iter_mut().for_each(|v| *v *= factor * factor);
    }
}

fn cell_equation(
    network: &Network,
    setup: &PotentialCase,
    drive: f64,
    i: usize,
    j: usize,
) -> Coefficients {
    let grid = network.grid;
    let mut c = Coefficients::default();
    let mut edge = |(conductance, source): (f64, f64)| {
        c.centre += conductance;
        c.source += source;
    };
    if i == 0 {
        edge(edge_terms(
            setup.edges.inner[j],
            drive,
            network.radial(0, j, 0),
        ));
    }
    if i + 1 == grid.nr {
        edge(edge_terms(
            setup.edges.outer[j],
            drive,
            network.radial(i, j, grid.nr),
        ));
    }
    if j == 0 {
        edge(edge_terms(
            setup.edges.bottom[i],
            drive,
            network.axial(i, 0),
        ));
    }
    if j + 1 == grid.nz {
        edge(edge_terms(setup.edges.top[i], drive, network.axial(i, j)));
    }
    if i > 0 {
        c.west = network.across_radial(i, j);
    }
    if i + 1 < grid.nr {
        c.east = network.across_radial(i + 1, j);
    }
    if j > 0 {
        c.south = network.across_axial(i, j);
    }
    if j + 1 < grid.nz {
        c.north = network.across_axial(i, j + 1);
    }
    if let Some(source) = &setup.source {
        c.source += source[grid.cell(i, j)];
    }
    c.centre += c.east + c.west + c.north + c.south;
    c
}
