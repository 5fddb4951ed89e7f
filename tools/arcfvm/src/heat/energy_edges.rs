//! Heat through the edges of the domain.

use crate::case::HeatEdge;
use crate::edges::Side;
use crate::equation::faces::{Beyond, FaceOf};
use crate::equation::transport::dirichlet;
use crate::heat::electrons::{Carried, Drift, Nothing};
use crate::heat::energy::Energy;
use crate::heat::reads::Around;

/// Part of the heat that an edge of 0 K would get that is none.
const ROUNDING: f64 = 1e-9;

/// Heat through the edges \[W\]; what enters is positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeHeat {
    /// By conduction and given fluxes.
    pub conduction: f64,
    /// Where mass crosses.
    pub flow: f64,
    /// Sum of the amounts exchanged, for scale.
    pub size: f64,
    /// What cells would give to edges of 0 K.
    pub held: f64,
}

impl EdgeHeat {
    /// What is exchanged, or else the least that tells anything beside the rounding of temperatures \[W\].
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.size.max(ROUNDING * self.held)
    }
}

impl Energy {
    fn through_edge(
        &self,
        around: Around<'_>,
        carried: &impl Carried,
        edge: Side,
        face: &FaceOf,
    ) -> EdgeHeat {
        let here = self.state(around, face.own);
        let (a, t) = self.edge(around, carried, edge, face, here);
        // Electrons pass a given temperature with that, else with the cell's own.
        let condition = *around.heat.edges.at(edge);
        let electrons = match condition {
            HeatEdge::Temperature(_) => carried.out(face),
            HeatEdge::Insulated | HeatEdge::Flux(_) => 0.0,
        };
        let exchange = (a + electrons) * (t - here.temperature) - self.mixed(face, dirichlet);
        let flux = match condition {
            HeatEdge::Flux(flux) => flux * face.area,
            _ => 0.0,
        };
        let mut through = EdgeHeat {
            size: exchange.abs() + flux.abs(),
            conduction: flux,
            flow: 0.0,
            held: (a + electrons).abs() * here.temperature,
        };
        if face.mass_out == 0.0 {
            through.conduction += exchange;
        } else {
            through.flow = exchange - face.mass_out * here.enthalpy;
        }
        through
    }

    /// Heat through all edges.
    #[must_use]
    pub fn edges(&self, around: Around<'_>) -> EdgeHeat {
        let (grid, drift) = (&around.case.grid, Drift::of(around));
        let mut all = EdgeHeat::default();
        for j in 0..grid.nz {
            let whole = j == 0 || j + 1 == grid.nz;
            for i in (0..grid.nr).filter(|i| whole || *i == 0 || *i + 1 == grid.nr) {
                for face in &self.faces(around, i, j) {
                    if let Beyond::Edge(edge) = face.beyond {
                        let part = match &drift {
                            Some(drift) => self.through_edge(around, drift, edge, face),
                            None => self.through_edge(around, &Nothing, edge, face),
                        };
                        all.size += part.size;
                        all.held += part.held;
                        all.conduction += part.conduction;
                        all.flow += part.flow;
                    }
                }
            }
        }
        all
    }
}
