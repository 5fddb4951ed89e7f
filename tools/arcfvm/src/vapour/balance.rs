//! The balance of the iron: what enters the gas, and what leaves it.

use crate::case::{Case, VapourCase, VapourEdge};
use crate::edges::Side;
use crate::equation::faces::{Beyond, FaceOf};
use crate::equation::transport::dirichlet;
use crate::flow::field::Flow;
use crate::material::GAS;
use crate::vapour::field::Vapour;

/// Iron that crosses the borders of the gas \[kg/s\]; what enters is positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct IronBalance {
    /// Off metal, less what condenses.
    pub surfaces: f64,
    /// Through the edges of the domain.
    pub edges: f64,
    /// Given.
    pub given: f64,
    /// Given off by the wall of the cavity: what it takes up is negative.
    pub wall: f64,
    /// Off boiling metal past the gas; no part of its balance.
    pub vented: f64,
    /// Sum of the amounts exchanged, for scale.
    pub size: f64,
}

impl IronBalance {
    /// What enters more than leaves.
    #[must_use]
    pub fn closure(&self) -> f64 {
        self.surfaces + self.edges + self.given + self.wall
    }
}

impl Vapour {
    /// Iron that enters and leaves the gas.
    #[must_use]
    pub fn balance(&self, case: &Case, setup: &VapourCase, flow: Option<&Flow>) -> IronBalance {
        let mut all = IronBalance::default();
        for (contact, passed) in case.contacts().iter().zip(&self.passed) {
            let rate = contact.area * passed.flux;
            all.surfaces += rate;
            all.vented += contact.area * passed.vented;
            all.size += rate.abs();
        }
        for given in setup.source.iter().flatten() {
            all.given += given;
            all.size += given.abs();
        }
        self.walls(case, setup, |_, rate| {
            all.wall += rate;
            all.size += rate.abs();
        });
        let grid = &case.grid;
        for j in 0..grid.nz {
            let whole = j == 0 || j + 1 == grid.nz;
            for i in (0..grid.nr).filter(|i| whole || *i == 0 || *i + 1 == grid.nr) {
                for face in self.faces(case, flow, i, j) {
                    if let (Beyond::Edge(edge), GAS) = (face.beyond, case.material[face.own]) {
                        let rate = self.through(setup, edge, &face);
                        all.edges += rate;
                        all.size += rate.abs();
                    }
                }
            }
        }
        all
    }

    /// Iron that enters through an edge face \[kg/s\].
    fn through(&self, setup: &VapourCase, edge: Side, face: &FaceOf) -> f64 {
        let own = self.iron[face.own];
        let exchanged = match *setup.edges.at(edge) {
            VapourEdge::Fraction(y) => dirichlet(face.mass_out, face.conductance) * (y - own),
            VapourEdge::Sealed => 0.0,
        };
        exchanged - face.mass_out * own
    }
}
