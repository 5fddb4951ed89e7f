//! What is written of the heat: temperatures, its balance, and what no voltage pays.

use artefact::{Record, Table};

use crate::heat::balance::Balance;
use crate::heat::supply::Supply;
use crate::material::GAS;
use crate::residual::part;
use crate::solver::Arc;

/// Names and units of the columns of every cell.
pub(crate) const COLUMNS: [(&str, &str); 1] = [("temperature_k", "K")];

/// Adds the columns of every cell.
pub(crate) fn plasma(arc: &Arc, table: Table) -> Table {
    if arc.heating.is_none() {
        return table;
    }
    let (grid, t, [(name, unit)]) = (&arc.case.grid, arc.temperature(), COLUMNS);
    table.column(name, unit, grid.by_height(|i, j| t[grid.cell(i, j)]))
}

/// Items that no voltage pays, and all that leaves.
pub(crate) fn paid(supply: &Supply, mut record: Record) -> Record {
    for (name, watts) in &supply.unpaid {
        record = record.with(&format!("unpaid_{name}_w"), "W", *watts);
    }
    for (name, watts) in &supply.leaves {
        record = record.with(&format!("leaves_{name}_w"), "W", *watts);
    }
    record
        .with("unpaid_w", "W", supply.owed())
        .with("leaves_w", "W", supply.left())
}

/// Adds the balance, part by part.
pub(crate) fn record(arc: &Arc, balance: &Balance, record: Record) -> Record {
    let scale = arc.power(balance);
    let mut record = record
        .with("heat_joule_w", "W", balance.joule)
        .with("heat_given_w", "W", balance.given)
        .with("heat_radiation_w", "W", balance.radiation)
        .with("heat_plate_motion_w", "W", balance.plate)
        .with("heat_edges_w", "W", balance.edges)
        .with("heat_flow_w", "W", balance.flow)
        .with("heat_drops_w", "W", balance.drops);
    if let Some(electrons) = balance.electrons {
        record = record.with("heat_electrons_w", "W", electrons);
    }
    let names = arc.case.surfaces.as_ref();
    let names = names.iter().flat_map(|s| &s.electrodes).map(|e| &e.name);
    for (name, one) in names.zip(&balance.electrodes) {
        let parts = [
            ("convection", one.convection),
            ("radiation", one.radiation),
            ("electron", one.electron),
            ("ion", one.ion),
            ("emission", one.emission),
            ("vapour", one.vapour),
            ("joule", one.joule),
            ("total", one.sum()),
        ];
        for (part, value) in parts {
            record = record.with(&format!("{name}_{part}_w"), "W", value);
        }
        if one.into_gas > 0.0 {
            record = record.with(&format!("{name}_into_gas_w"), "W", one.into_gas);
        }
    }
    record.with("closure_w", "W", balance.closure()).with(
        "closure",
        "1",
        part(balance.closure(), scale),
    )
}

/// What the base metal takes up in all, drops included, and the part of the power that it is (Komen
/// 2019, tables 5.6 and 5.7).
pub(crate) fn input(arc: &Arc, balance: &Balance, record: Record) -> Record {
    let own = arc.case.wire.zip(arc.case.base.as_ref());
    let own = own.and_then(|(_, base)| {
        let electrode = arc.case.surfaces.as_ref()?.electrode_of[base.material]?;
        Some(balance.electrodes[electrode].sum())
    });
    let Some(own) = own else {
        return record;
    };
    // Drops carry heat out of the wire: it is negative there.
    let all = own - balance.drops;
    record
        .with("base_drops_w", "W", -balance.drops)
        .with("base_input_w", "W", all)
        .with("efficiency", "1", all / arc.power(balance))
}

/// Adds where the gas is hottest.
pub(crate) fn hottest(arc: &Arc, record: Record) -> Record {
    let (grid, t) = (&arc.case.grid, arc.temperature());
    let gas = (0..grid.len()).filter(|k| arc.case.material[*k] == GAS);
    let hottest = gas.max_by(|a, b| t[*a].total_cmp(&t[*b]));
    let Some(k) = hottest.filter(|_| arc.heating.is_some()) else {
        return record;
    };
    let (i, j) = (k % grid.nr, k / grid.nr);
    record
        .with("hottest_k", "K", t[k])
        .with("hottest_radius_m", "m", grid.rc[i])
        .with("hottest_height_m", "m", grid.zc[j])
}
