//! Heat through the edges of the domain.

use crate::case::{Case, HeatCase, HeatEdge};
use crate::edges::Side;
use crate::equation::faces::{Beyond, FaceOf};
use crate::equation::transport::dirichlet;
use crate::heat::electrons::{Carried, Nothing};
use crate::heat::energy::Energy;
use crate::properties::Properties;

/// Heat through the edges \[W\]; what enters is positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeHeat {
    /// By conduction and given fluxes.
    pub conduction: f64,
    /// Where mass crosses.
    pub flow: f64,
    /// Sum of the amounts exchanged, for scale.
    pub size: f64,
}

impl Energy {
    fn through_edge(
        &self,
        case: &Case,
        heat: &HeatCase,
        properties: &Properties,
        carried: &impl Carried,
        (edge, face): (Side, FaceOf),
    ) -> EdgeHeat {
        let here = (self.temperature[face.own], properties.enthalpy[face.own]);
        let (a, t) = self.edge(case, heat, carried, (edge, face), here);
        // Electrons pass a given temperature with that, else with the cell's own.
        let electrons = match *heat.edges.at(edge) {
            HeatEdge::Temperature(_) => carried.out(&face),
            HeatEdge::Insulated | HeatEdge::Flux(_) => 0.0,
        };
        let exchange = (a + electrons) * (t - here.0) - self.mixed(&face, dirichlet);
        let flux = match *heat.edges.at(edge) {
            HeatEdge::Flux(flux) => flux * face.area,
            _ => 0.0,
        };
        let mut through = EdgeHeat {
            size: exchange.abs() + flux.abs(),
            conduction: flux,
            flow: 0.0,
        };
        if face.mass_out == 0.0 {
            through.conduction += exchange;
        } else {
            through.flow = exchange - face.mass_out * here.1;
        }
        through
    }

    /// Heat through all edges.
    #[must_use]
    pub fn edges(&self, case: &Case, heat: &HeatCase, properties: &Properties) -> EdgeHeat {
        let grid = &case.grid;
        let mut all = EdgeHeat::default();
        for j in 0..grid.nz {
            let whole = j == 0 || j + 1 == grid.nz;
            for i in (0..grid.nr).filter(|i| whole || *i == 0 || *i + 1 == grid.nr) {
                for face in self.faces(case, i, j) {
                    if let Beyond::Edge(edge) = face.beyond {
                        let part = match &self.electrons {
                            Some(drift) => {
                                self.through_edge(case, heat, properties, drift, (edge, face))
                            }
                            None => {
                                self.through_edge(case, heat, properties, &Nothing, (edge, face))
                            }
                        };
                        all.size += part.size;
                        all.conduction += part.conduction;
                        all.flow += part.flow;
                    }
                }
            }
        }
        all
    }
}
