//! What is written of iron vapour and of electrons.

use artefact::{Record, Table};

use crate::heat::balance::Balance;
use crate::material::GAS;
use crate::residual::part;
use crate::solver::Arc;

/// Name and unit of the column of every cell that is there with vapour.
pub(crate) const COLUMN: (&str, &str) = ("iron_mass_fraction", "1");

/// Adds the mass fraction of iron, where there is vapour, and the electrons, where the gas tells them.
pub(crate) fn plasma(arc: &Arc, mut table: Table) -> Table {
    let grid = &arc.case.grid;
    if let Some(vapour) = &arc.vapour {
        let iron = &vapour.iron;
        let values = grid.by_height(|i, j| iron[grid.cell(i, j)]);
        table = table.column(COLUMN.0, COLUMN.1, values);
    }
    if let Some(law) = &arc.case.materials[GAS].electron_density {
        let values = grid.by_height(|i, j| {
            let k = grid.cell(i, j);
            if arc.case.material[k] != GAS {
                return 0.0;
            }
            let (t, y) = (arc.temperature()[k], arc.properties.iron_at(k));
            law.within(grid.rc[i], grid.zc[j], t, y)
        });
        table = table.column("electron_density_1_m3", "1/m3", values);
    }
    table
}

/// A value of each contact, gathered for the columns of the surface.
type Gather<'a> = &'a dyn Fn(&dyn Fn(usize) -> f64) -> Vec<f64>;

/// Adds what evaporates off the base metal, summed as `over` does, and the mass fraction of iron there, as
/// `mean` does, where there is vapour.
pub(crate) fn surface(arc: &Arc, table: Table, over: Gather<'_>, mean: Gather<'_>) -> Table {
    let Some(vapour) = &arc.vapour else {
        return table;
    };
    let passed = &vapour.passed;
    table
        .column(
            "evaporation_kg_m2_s",
            "kg/(m2 s)",
            over(&|n| passed[n].off()),
        )
        .column("iron_mass_fraction", "1", mean(&|n| passed[n].surface))
}

/// Adds the balance of the iron and the heat that it brings into the gas, where there is vapour.
pub(crate) fn record(arc: &Arc, balance: Option<&Balance>, mut record: Record) -> Record {
    let Some(iron) = arc.iron_balance() else {
        return record;
    };
    if let Some(balance) = balance {
        record = record.with("heat_vapour_w", "W", balance.vapour);
    }
    let wall = arc.case.vapour.as_ref().and_then(|v| v.wall);
    if wall.is_some() {
        record = record.with("iron_wall_kg_s", "kg/s", iron.wall);
    }
    if arc.case.vapour.as_ref().is_some_and(|v| v.vents) {
        record = record.with("iron_vented_kg_s", "kg/s", iron.vented);
    }
    record
        .with("iron_surfaces_kg_s", "kg/s", iron.surfaces)
        .with("iron_given_kg_s", "kg/s", iron.given)
        .with("iron_edges_kg_s", "kg/s", iron.edges)
        .with("iron_closure", "1", part(iron.closure(), iron.size))
}
