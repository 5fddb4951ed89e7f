//! What is written of the current: its fields, the force in the base metal, and voltages.

use artefact::{Record, Table};

use crate::current::magnetic::AtCentre;
use crate::grid::Grid;
use crate::heat::supply::Supply;
use crate::solver::Arc;

/// Names and units of the columns of every cell.
pub(crate) const COLUMNS: [(&str, &str); 6] = [
    ("potential_v", "V"),
    ("current_radial_a_m2", "A/m2"),
    ("current_axial_a_m2", "A/m2"),
    ("magnetic_field_t", "T"),
    ("lorentz_radial_n_m3", "N/m3"),
    ("lorentz_axial_n_m3", "N/m3"),
];
/// The values of all but the first of them.
const AT_CENTRE: [fn(&AtCentre) -> f64; 5] = [
    |c| c.current_radial,
    |c| c.current_axial,
    |c| c.field,
    |c| c.force_radial,
    |c| c.force_axial,
];

/// Adds the columns of every cell.
pub(crate) fn plasma(arc: &Arc, mut table: Table) -> Table {
    let (grid, Some(electric)) = (&arc.case.grid, &arc.electric) else {
        return table;
    };
    let [(name, unit), rest @ ..] = &COLUMNS;
    let value = |i, j| electric.potential.value[grid.cell(i, j)];
    table = table.column(name, unit, grid.by_height(value));
    for ((name, unit), part) in rest.iter().zip(AT_CENTRE) {
        let value = |i, j| part(&electric.magnetic.at_centre(grid, &electric.potential, i, j));
        table = table.column(name, unit, grid.by_height(value));
    }
    table
}

/// Lorentz force in the base metal against radius and depth below the surface of each column.
pub(crate) fn lorentz(arc: &Arc) -> Option<Table> {
    let electric = arc.electric.as_ref()?;
    let (potential, magnetic) = (&electric.potential, &electric.magnetic);
    let grid = &arc.case.grid;
    let base = arc.case.base.as_ref()?;
    let above = base.top();
    let surface = grid.zf[above];
    let depth: Vec<f64> = (0..above).rev().map(|j| surface - grid.zc[j]).collect();
    let mut table = Table::grid(&[("radius_m", "m", &grid.rc), ("depth_m", "m", &depth)]);
    for ((name, unit), part) in COLUMNS[4..].iter().zip(&AT_CENTRE[3..]) {
        let mut values = Vec::with_capacity(grid.nr * above);
        for i in 0..grid.nr {
            let metal = |j: usize| arc.case.material[grid.cell(i, j)] == base.material;
            let at = |j: usize| match metal(j) {
                true => part(&magnetic.at_centre(grid, potential, i, j)),
                false => 0.0,
            };
            match base.above[i] {
                Some(top) if top != above => {
                    let column: Vec<f64> = (0..top).map(at).collect();
                    let sunk = |d: &f64| below(grid, &column, grid.zf[top] - d);
                    values.extend(depth.iter().map(sunk));
                }
                _ => values.extend((0..above).rev().map(at)),
            }
        }
        table = table.column(name, unit, values);
    }
    Some(table)
}

/// What a column holds at height `z` \[m\], by its values from the bottom of the domain to its surface: linear between the
/// middles of cells, held above the last of them, zero below the domain.
fn below(grid: &Grid, column: &[f64], z: f64) -> f64 {
    let after = grid.zc.partition_point(|centre| *centre <= z);
    let Some(last) = column.len().checked_sub(1).filter(|_| z >= grid.zf[0]) else {
        return 0.0;
    };
    if after == 0 {
        return column[0];
    }
    if after > last {
        return column[last];
    }
    let part = (z - grid.zc[after - 1]) / (grid.zc[after] - grid.zc[after - 1]);
    column[after - 1] + part * (column[after] - column[after - 1])
}

/// Voltage over the wire on the axis \[V\].
fn wire_drop(arc: &Arc) -> Option<f64> {
    let (wire, electric) = (arc.case.wire?, arc.electric.as_ref()?);
    let tip = electric.potential.value[arc.case.grid.cell(0, wire.tip)];
    Some((electric.potential.drive - tip).abs())
}

/// Adds power, current and voltages.
pub(crate) fn record(arc: &Arc, supply: Option<&Supply>, record: Record) -> Record {
    let Some((electric, setup)) = arc.electric.as_ref().zip(arc.case.potential.as_ref()) else {
        return record;
    };
    let power = electric.potential.power(&arc.case.grid, setup);
    let mut record = record.with("power_column_w", "W", power);
    let (Some(current), Some(voltage)) = (setup.driven, arc.voltage(supply)) else {
        return record;
    };
    record = record
        .with("current_a", "A", current)
        .with("voltage_column_v", "V", voltage.column)
        .with("voltage_cathode_v", "V", voltage.cathode)
        .with("voltage_contact_v", "V", voltage.contact)
        .with("voltage_v", "V", voltage.all())
        .with("power_w", "W", voltage.all() * current.abs());
    if let Some(drop) = wire_drop(arc) {
        record = record.with("voltage_wire_v", "V", drop);
    }
    record
}
