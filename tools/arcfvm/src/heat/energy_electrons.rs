//! Heat that electrons carry through the faces of the energy.

use crate::case::HeatEdge;
use crate::equation::faces::Beyond;
use crate::grid::FaceIndex;
use crate::heat::electrons::{Carried, Drift};
use crate::heat::energy::Energy;
use crate::heat::reads::Around;

impl Energy {
    /// Lets bodies take up what electrons that carry heat bring faster than the gas conducts; after [`Energy::conduct`].
    pub(crate) fn drift(&mut self, around: Around<'_>) {
        let Some(drift) = Drift::of(around) else {
            return;
        };
        let grid = &around.case.grid;
        for k in 0..grid.len() {
            for face in self.faces(around, k % grid.nr, k / grid.nr) {
                if drift.at_body(&face) {
                    let conductance = match face.at {
                        FaceIndex::Radial(at) => &mut self.radial[at],
                        FaceIndex::Axial(at) => &mut self.axial[at],
                    };
                    *conductance = conductance.max(drift.out(&face));
                }
            }
        }
    }

    /// Heat that electrons bring into the gas at bodies and edges, less what they take out \[W\].
    #[must_use]
    pub fn carried(&self, around: Around<'_>) -> Option<f64> {
        let drift = Drift::of(around)?;
        let grid = &around.case.grid;
        let mut all = 0.0;
        for k in (0..grid.len()).filter(|k| drift.in_gas(*k)) {
            for face in self.faces(around, k % grid.nr, k / grid.nr) {
                let passing = match face.beyond {
                    Beyond::Cell(n) if drift.in_gas(n) => continue,
                    Beyond::Cell(n) => self.temperature[n],
                    Beyond::Edge(edge) => match *around.heat.edges.at(edge) {
                        HeatEdge::Temperature(t) => t,
                        HeatEdge::Insulated | HeatEdge::Flux(_) => self.temperature[k],
                    },
                };
                all -= drift.out(&face) * passing;
            }
        }
        let beyond: f64 = self.electrons_beyond(around).map(|(_, w)| w).sum();
        Some(all - beyond)
    }
}
