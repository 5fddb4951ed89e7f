//! What is written: the artefact `arc-source`.

use artefact::{Record, Table};
use run::{Failure, Session};

use crate::heat::balance::Balance;
use crate::sample::Sample;
use crate::solver::Arc;
use crate::{bed, current, flow, heat, surface, vapour};

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
    if let Some(table) = current::figures::lorentz(arc) {
        session.table("/lorentz", 0.0, &table)?;
    }
    session.record("/balance", 0.0, &record(arc, balance))
}

/// Fields of every cell.
fn plasma(arc: &Arc) -> Table {
    let grid = &arc.case.grid;
    let mut table = Table::grid(&[("radius_m", "m", &grid.rc), ("height_m", "m", &grid.zc)]);
    table = heat::figures::plasma(arc, table);
    table = flow::figures::plasma(arc, table);
    table = current::figures::plasma(arc, table);
    table = vapour::figures::plasma(arc, table);
    table = bed::figures::plasma(arc, table);
    let material = |i, j| arc.case.material[grid.cell(i, j)] as f64;
    let roles = grid.by_height(|i, j| role(arc, material(i, j)));
    table.column("material", "1", roles)
}

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

/// Currents, voltages, powers and the heat balance.
fn record(arc: &Arc, balance: Option<&Balance>) -> Record {
    let supply = balance.map(|balance| arc.supply(balance));
    let mut record = current::figures::record(arc, supply.as_ref(), Record::new());
    if let Some(supply) = supply.as_ref().filter(|_| arc.electric.is_some()) {
        record = heat::figures::paid(supply, record);
    }
    if let Some(balance) = balance {
        record = heat::figures::record(arc, balance, record);
        record = bed::figures::record(arc, record);
        record = heat::figures::input(arc, balance, record);
    }
    if let Some(wire) = arc.case.wire {
        let volume = arc.feed * wire.section;
        record =
            record
                .with("wire_feed_m_s", "m/s", arc.feed)
                .with("wire_volume_m3_s", "m3/s", volume);
    }
    record = heat::figures::hottest(arc, record);
    record = flow::figures::record(arc, record);
    vapour::figures::record(arc, balance, record)
}
