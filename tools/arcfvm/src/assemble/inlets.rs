//! Density of the gas that enters at the edges of the domain.

use crate::case::{Case, HeatEdge, Inlets, VapourEdge};
use crate::material::GAS;

/// An edge face that gas may enter through.
struct Entrance {
    cell: usize,
    place: [f64; 2],
    heat: Option<HeatEdge>,
    iron: Option<VapourEdge>,
}

impl Entrance {
    /// Density of the gas that enters, where its temperature and its iron are known \[kg/m3\].
    fn density(&self, case: &Case) -> Option<f64> {
        let t = match (self.heat, self.iron) {
            (Some(HeatEdge::Temperature(t)), _) => t,
            // Vapour at temperatures that are not solved.
            (None, Some(_)) => case.start[self.cell],
            _ => return None,
        };
        let y = match self.iron {
            None => 0.0,
            Some(VapourEdge::Fraction(y)) => y,
            Some(VapourEdge::Sealed) => return None,
        };
        let ([r, z], law) = (self.place, case.materials[GAS].density.as_ref());
        law.map(|l| l.within(r, z, t, y))
    }
}

/// Gas that enters at edges where its state is given.
pub(super) fn inlets(case: &Case) -> Inlets {
    let grid = &case.grid;
    let heat = case.heat.as_ref().map(|h| &h.edges);
    let iron = case.vapour.as_ref().map(|v| &v.edges);
    let outer = |j: usize| Entrance {
        cell: grid.cell(grid.nr - 1, j),
        place: [grid.rf[grid.nr], grid.zc[j]],
        heat: heat.map(|e| e.outer[j]),
        iron: iron.map(|e| e.outer[j]),
    };
    let bottom = |i: usize| Entrance {
        cell: grid.cell(i, 0),
        place: [grid.rc[i], grid.zf[0]],
        heat: heat.map(|e| e.bottom[i]),
        iron: iron.map(|e| e.bottom[i]),
    };
    let top = |i: usize| Entrance {
        cell: grid.cell(i, grid.nz - 1),
        place: [grid.rc[i], grid.zf[grid.nz]],
        heat: heat.map(|e| e.top[i]),
        iron: iron.map(|e| e.top[i]),
    };
    Inlets {
        outer: (0..grid.nz).map(|j| outer(j).density(case)).collect(),
        bottom: (0..grid.nr).map(|i| bottom(i).density(case)).collect(),
        top: (0..grid.nr).map(|i| top(i).density(case)).collect(),
    }
}
