//! Heat that electrons carry through the faces of the energy.

use crate::case::{Case, HeatCase, HeatEdge};
use crate::current::potential::Potential;
use crate::equation::faces::Beyond;
use crate::heat::FaceIndex;
use crate::heat::electrons::Carried;
use crate::heat::energy::Energy;

impl Energy {
    /// Takes the electrons of the present current, where they carry heat; after [`Energy::conduct`].
    pub(crate) fn drift(&mut self, case: &Case, potential: &Potential) {
        let Some(mut drift) = self.electrons.take() else {
            return;
        };
        drift.follow(case, potential);
        let grid = &case.grid;
        for k in 0..grid.len() {
            for face in self.faces(case, k % grid.nr, k / grid.nr) {
                if drift.at_body(&face) {
                    let conductance = match face.at {
                        FaceIndex::Radial(at) => &mut self.radial[at],
                        FaceIndex::Axial(at) => &mut self.axial[at],
                    };
                    *conductance = conductance.max(drift.out(&face));
                }
            }
        }
        self.electrons = Some(drift);
    }

    /// Heat that electrons bring into the gas at bodies and edges, less what they take out \[W\].
    #[must_use]
    pub fn carried(&self, case: &Case, heat: &HeatCase) -> Option<f64> {
        let drift = self.electrons.as_ref()?;
        let grid = &case.grid;
        let mut all = 0.0;
        for k in (0..grid.len()).filter(|k| drift.in_gas(*k)) {
            for face in self.faces(case, k % grid.nr, k / grid.nr) {
                let passing = match face.beyond {
                    Beyond::Cell(n) if drift.in_gas(n) => continue,
                    Beyond::Cell(n) => self.temperature[n],
                    Beyond::Edge(edge) => match *heat.edges.at(edge) {
                        HeatEdge::Temperature(t) => t,
                        HeatEdge::Insulated | HeatEdge::Flux(_) => self.temperature[k],
                    },
                };
                all -= drift.out(&face) * passing;
            }
        }
        let beyond: f64 = self.electrons_beyond(case).map(|(_, w)| w).sum();
        Some(all - beyond)
    }
}
