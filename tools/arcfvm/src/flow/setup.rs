//! What is set up of the flow.

use crate::edges::Edges;
use crate::grid::Grid;
use crate::material::GAS;

/// What the flow meets at an edge face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FlowEdge {
    /// Fixed velocity, radial and axial \[m/s\]: a wall (zero) or an inlet.
    Velocity([f64; 2]),
    /// Fixed pressure \[Pa\]; gas drawn in comes from rest.
    Open(f64),
    /// No flow through, no stress along: the axis or a plane of symmetry.
    Slip,
}

/// Whether a face velocity is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Face {
    /// Known, at a wall or inlet \[m/s\].
    Fixed(f64),
    /// Between two gas cells, or an open edge.
    Solved,
}

/// What the faces of the grid are.
#[derive(Debug, Clone, PartialEq)]
pub struct Faces {
    /// Radial faces.
    pub radial: Vec<Face>,
    /// Axial faces.
    pub axial: Vec<Face>,
}

impl Faces {
    /// Between cells of `material`, and at the `edges` of the domain.
    #[must_use]
    pub fn new(grid: &Grid, material: &[usize], edges: &Edges<FlowEdge>) -> Self {
        let gas = |i: usize, j: usize| material[grid.cell(i, j)] == GAS;
        let at_edge = |edge: FlowEdge, axis: usize| match edge {
            FlowEdge::Velocity(v) => Face::Fixed(v[axis]),
            FlowEdge::Open(_) => Face::Solved,
            FlowEdge::Slip => Face::Fixed(0.0),
        };
        let mut radial = vec![Face::Fixed(0.0); grid.radial_faces()];
        for j in 0..grid.nz {
            for i in 1..grid.nr {
                if gas(i - 1, j) && gas(i, j) {
                    radial[grid.radial_face(i, j)] = Face::Solved;
                }
            }
            if gas(grid.nr - 1, j) {
                radial[grid.radial_face(grid.nr, j)] = at_edge(edges.outer[j], 0);
            }
            if gas(0, j) && grid.rf[0] > 0.0 {
                radial[grid.radial_face(0, j)] = at_edge(edges.inner[j], 0);
            }
        }
        let mut axial = vec![Face::Fixed(0.0); grid.axial_faces()];
        for i in 0..grid.nr {
            for j in 1..grid.nz {
                if gas(i, j - 1) && gas(i, j) {
                    axial[grid.axial_face(i, j)] = Face::Solved;
                }
            }
            if gas(i, 0) {
                axial[grid.axial_face(i, 0)] = at_edge(edges.bottom[i], 1);
            }
            if gas(i, grid.nz - 1) {
                axial[grid.axial_face(i, grid.nz)] = at_edge(edges.top[i], 1);
            }
        }
        Self { radial, axial }
    }
}

/// Density of the gas that enters at the outer, lower and upper edge, where its state is given \[kg/m3\].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inlets {
    /// Largest radius, `[nz]`.
    pub outer: Vec<Option<f64>>,
    /// Lowest height, `[nr]`.
    pub bottom: Vec<Option<f64>>,
    /// Greatest height, `[nr]`.
    pub top: Vec<Option<f64>>,
}

/// Gravity acting on the excess of density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// Downward acceleration \[m/s2\].
    pub acceleration: f64,
    /// Density of the gas at rest around \[kg/m3\], whose weight the pressure leaves out.
    pub reference_density: f64,
}

/// The flow, where it is solved.
#[derive(Debug, Clone)]
pub struct FlowCase {
    /// Edges.
    pub edges: Edges<FlowEdge>,
    /// What the faces are; they follow from the materials of the cells and from the edges.
    pub faces: Faces,
    /// Gas that enters.
    pub inlets: Inlets,
    /// Gravity.
    pub gravity: Option<Gravity>,
    /// Given forces on radial and axial faces \[N/m3\]; manufactured solutions only.
    pub force: Option<[Vec<f64>; 2]>,
    /// Whether no edge fixes the pressure, so that it is known up to a constant.
    pub closed: bool,
}
