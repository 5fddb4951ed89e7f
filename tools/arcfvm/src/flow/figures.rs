//! What is written of the flow.

use artefact::{Record, Table};

use crate::solver::Arc;

/// Names and units of the columns of every cell.
pub(crate) const COLUMNS: [(&str, &str); 3] = [
    ("radial_velocity_m_s", "m/s"),
    ("axial_velocity_m_s", "m/s"),
    ("pressure_pa", "Pa"),
];

/// Adds the columns of every cell.
pub(crate) fn plasma(arc: &Arc, table: Table) -> Table {
    let (grid, Some(flowing)) = (&arc.case.grid, &arc.flowing) else {
        return table;
    };
    let flow = &flowing.flow;
    let radial = |i, j| {
        let face = grid.radial_face(i, j);
        0.5 * (flow.radial[face] + flow.radial[face + 1])
    };
    let axial = |i, j| {
        let face = grid.axial_face(i, j);
        0.5 * (flow.axial[face] + flow.axial[face + grid.nr])
    };
    let pressure = |i, j| flow.pressure[grid.cell(i, j)];
    let values = [
        grid.by_height(radial),
        grid.by_height(axial),
        grid.by_height(pressure),
    ];
    let columns = COLUMNS.iter().zip(values);
    columns.fold(table, |table, ((name, unit), values)| {
        table.column(name, unit, values)
    })
}

/// Adds how fast the gas flows along the axis at most.
pub(crate) fn record(arc: &Arc, record: Record) -> Record {
    let Some(flowing) = &arc.flowing else {
        return record;
    };
    let speeds = flowing.flow.axial.iter();
    let fastest = speeds.fold(0.0_f64, |m, u| m.max(u.abs()));
    record.with("fastest_m_s", "m/s", fastest)
}
