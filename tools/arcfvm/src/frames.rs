//! What is written: the artefact `arc-source`.

use artefact::{Record, Table};
use run::{Failure, Session};

use crate::bed::figures as bed;
use crate::case::PotentialCase;
use crate::current::magnetic::AtCentre;
use crate::grid::Grid;
use crate::heat::balance::Balance;
use crate::heat::supply::Supply;
use crate::material::GAS;
use crate::sample::Sample;
use crate::solver::{Arc, Electric};
use crate::surface;
use crate::vapour::figures as iron;

/// Writes every channel that the solved fields fill.
///
/// # Errors
/// When the artefact cannot be written.
pub fn write(
    arc: &Arc,
    balance: Option<&Balance>,
    sample: &Sample,
    session: &mut Session,
) -> Result<(), Failure> {
    session.table("/plasma", 0.0, &plasma(arc))?;
    if let Some(table) = surface::table(arc, sample) {
        session.table("/surface", 0.0, &table)?;
    }
    if let Some(table) = lorentz(arc) {
        session.table("/lorentz", 0.0, &table)?;
    }
    session.record("/balance", 0.0, &record(arc, balance))
}

/// Fields of every cell.
fn plasma(arc: &Arc) -> Table {
    let grid = &arc.case.grid;
    let mut table = Table::grid(&[("radius_m", "m", &grid.rc), ("height_m", "m", &grid.zc)]);
    let cell = |i: usize, j: usize| grid.cell(i, j);
    if arc.heating.is_some() {
        let t = arc.temperature();
        table = table.column("temperature_k", "K", grid.by_height(|i, j| t[cell(i, j)]));
    }
    if let Some(flowing) = &arc.flowing {
        let flow = &flowing.flow;
        let radial = |i, j| {
            let face = grid.radial_face(i, j);
            0.5 * (flow.radial[face] + flow.radial[face + 1])
        };
        let axial = |i, j| {
            let face = grid.axial_face(i, j);
            0.5 * (flow.axial[face] + flow.axial[face + grid.nr])
        };
        let pressure = |i, j| flow.pressure[cell(i, j)];
        table = table
            .column("radial_velocity_m_s", "m/s", grid.by_height(radial))
            .column("axial_velocity_m_s", "m/s", grid.by_height(axial))
            .column("pressure_pa", "Pa", grid.by_height(pressure));
    }
    if let Some(electric) = &arc.electric {
        let value = |i, j| electric.potential.value[cell(i, j)];
        table = table.column("potential_v", "V", grid.by_height(value));
        for (name, unit, part) in PARTS {
            let value = |i, j| part(&electric.magnetic.at_centre(grid, &electric.potential, i, j));
            table = table.column(name, unit, grid.by_height(value));
        }
    }
    table = iron::plasma(arc, table);
    if let Some(slag) = bed::slag(arc) {
        table = table.column("slag", "1", grid.by_height(|i, j| slag[cell(i, j)]));
    }
    let material = |i, j| arc.case.material[cell(i, j)] as f64;
    table.column(
        "material",
        "1",
        grid.by_height(|i, j| role(arc, material(i, j))),
    )
}

type Part = (&'static str, &'static str, fn(&AtCentre) -> f64);
const PARTS: [Part; 5] = [
    ("current_radial_a_m2", "A/m2", |c| c.current_radial),
    ("current_axial_a_m2", "A/m2", |c| c.current_axial),
    ("magnetic_field_t", "T", |c| c.field),
    ("lorentz_radial_n_m3", "N/m3", |c| c.force_radial),
    ("lorentz_axial_n_m3", "N/m3", |c| c.force_axial),
];

/// 0 gas, 1 wire, 2 base metal, 3 and above any other body in the order of names.
pub(crate) fn role(arc: &Arc, material: f64) -> f64 {
    let index = material as usize;
    let wire = arc.case.wire.map(|w| w.material);
    let base = surface::base(arc);
    if index == 0 {
        0.0
    } else if Some(index) == wire {
        1.0
    } else if Some(index) == base {
        2.0
    } else {
        2.0 + material
    }
}

/// Lorentz force in the base metal against radius and depth below the surface of each column.
fn lorentz(arc: &Arc) -> Option<Table> {
    let Electric {
        potential,
        magnetic,
        ..
    } = arc.electric.as_ref()?;
    let grid = &arc.case.grid;
    let base = arc.case.base.as_ref()?;
    let above = base.top();
    let surface = grid.zf[above];
    let depth: Vec<f64> = (0..above).rev().map(|j| surface - grid.zc[j]).collect();
    let mut table = Table::grid(&[("radius_m", "m", &grid.rc), ("depth_m", "m", &depth)]);
    for (name, unit, part) in &PARTS[3..] {
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

/// Currents, voltages, powers and the heat balance.
fn record(arc: &Arc, balance: Option<&Balance>) -> Record {
    let mut record = Record::new();
    if let (Some(electric), Some(setup)) = (&arc.electric, &arc.case.potential) {
        let supply = balance.map(|balance| arc.supply(balance));
        record = electrical(arc, electric, setup, supply.as_ref(), record);
        record = match &supply {
            Some(supply) => paid(supply, record),
            None => record,
        };
    }
    if let Some(balance) = balance {
        record = bed::record(arc, heat(arc, balance, record));
    }
    if let Some(balance) = balance {
        record = input(arc, balance, record);
    }
    if let Some(wire) = arc.case.wire {
        record = record.with("wire_feed_m_s", "m/s", arc.feed).with(
            "wire_volume_m3_s",
            "m3/s",
            arc.feed * wire.section,
        );
    }
    iron::record(arc, balance, extremes(arc, record))
}

/// Where the gas is hottest, and how fast it flows along the axis at most.
fn extremes(arc: &Arc, mut record: Record) -> Record {
    let (grid, t) = (&arc.case.grid, arc.temperature());
    let gas = (0..grid.len()).filter(|k| arc.case.material[*k] == GAS);
    let hottest = gas.max_by(|a, b| t[*a].total_cmp(&t[*b]));
    if let Some(k) = hottest.filter(|_| arc.heating.is_some()) {
        let (i, j) = (k % grid.nr, k / grid.nr);
        record = record
            .with("hottest_k", "K", t[k])
            .with("hottest_radius_m", "m", grid.rc[i])
            .with("hottest_height_m", "m", grid.zc[j]);
    }
    if let Some(flowing) = &arc.flowing {
        let fastest = flowing
            .flow
            .axial
            .iter()
            .fold(0.0_f64, |m, u| m.max(u.abs()));
        record = record.with("fastest_m_s", "m/s", fastest);
    }
    record
}

/// What the base metal takes up in all, drops included, and the part of the power that it is (Komen
/// 2019, tables 5.6 and 5.7).
fn input(arc: &Arc, balance: &Balance, record: Record) -> Record {
    let own = arc.case.wire.zip(surface::base(arc)).and_then(|(_, base)| {
        let electrode = arc.case.surfaces.as_ref()?.electrode_of[base]?;
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

fn electrical(
    arc: &Arc,
    electric: &Electric,
    setup: &PotentialCase,
    supply: Option<&Supply>,
    record: Record,
) -> Record {
    let grid = &arc.case.grid;
    let power = electric.potential.power(grid, setup);
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
    if let Some(drop) = surface::wire_drop(arc) {
        record = record.with("voltage_wire_v", "V", drop);
    }
    record
}

/// Items that no voltage pays, and all that leaves.
fn paid(supply: &Supply, mut record: Record) -> Record {
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

fn heat(arc: &Arc, balance: &Balance, record: Record) -> Record {
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
        crate::residual::part(balance.closure(), scale),
    )
}
