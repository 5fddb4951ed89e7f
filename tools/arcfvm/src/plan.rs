//! What `arcfvm check` tells before anything runs.

use artefact::Table;
use run::Plan;

use crate::case::{Case, HeatEdge};
use crate::material::{GAS, REFERENCE_K};
use crate::{bed, current, flow, heat, vapour};

/// An effect that a scene may ask for.
struct Effect {
    /// Its key in the scene.
    key: &'static str,
    /// Whether it is solved.
    solved: bool,
    /// Columns of 8 bytes per cell: state, equation, solver and its hierarchy, measured by count.
    memory: usize,
    /// Columns of the artefact's `/plasma`.
    columns: &'static [(&'static str, &'static str)],
}

/// Current, flow, heat and vapour.
fn effects(case: &Case) -> [Effect; 4] {
    [
        Effect {
            key: "current",
            solved: case.potential.is_some(),
            memory: 30,
            columns: &current::figures::COLUMNS,
        },
        Effect {
            key: "flow",
            solved: case.flow.is_some(),
            memory: 60,
            columns: &flow::figures::COLUMNS,
        },
        Effect {
            key: "heat",
            solved: case.heat.is_some(),
            memory: 32,
            columns: &heat::figures::COLUMNS,
        },
        Effect {
            key: "vapour",
            solved: case.vapour.is_some(),
            memory: 36,
            columns: &[vapour::figures::COLUMN],
        },
    ]
}

/// The plan of an assembled scene.
#[must_use]
pub(crate) fn plan(case: &Case) -> Plan {
    let n = case.grid.len();
    let gas = case.material.iter().filter(|m| **m == GAS).count();
    let mut plan = Plan::new()
        .count("cells", n as u64)
        .count("radial_cells", case.grid.nr as u64)
        .count("axial_cells", case.grid.nz as u64)
        .count("gas_cells", gas as u64);
    let all = effects(case);
    for effect in &all {
        let key = effect.key;
        plan = if effect.solved {
            let bytes = (8 * effect.memory * n) as u64;
            plan.stage(key).memory(key, bytes)
        } else {
            plan.left_out(key, &format!("no key '{key}'"))
        };
    }
    let [current, flow, heat, vapour] = &all;
    let written = [heat, flow, current, vapour];
    let written = written.into_iter().filter(|effect| effect.solved);
    let mut columns: Vec<_> = written.flat_map(|effect| effect.columns).collect();
    // The density of electrons with vapour, and the cells' places, slag and material.
    let plasma = columns.len() + usize::from(vapour.solved) + 4;
    columns.extend(case.bed.as_ref().map(|_| &bed::figures::COLUMN));
    for (name, unit) in columns {
        plan = plan.column(name, unit);
    }
    output(case, plasma, plan)
}

/// What is to be told of a body that moves in from beyond an edge without a temperature, and not from a room.
pub(crate) fn entering(case: &Case) -> Option<String> {
    let (heat, grid) = (case.heat.as_ref()?, &case.grid);
    let outer = heat.edges.outer.iter().enumerate();
    let open = outer.filter(|(_, edge)| !matches!(edge, HeatEdge::Temperature(_)));
    let mut rows = open.map(|(j, _)| j);
    rows.find_map(|j| {
        let material = case.material[grid.cell(grid.nr - 1, j)];
        let plate = heat.plates.iter().find(|plate| plate.material == material)?;
        let t = plate.beyond[j];
        ((t - REFERENCE_K).abs() > 0.0).then(|| {
            format!(
                "the body \"{}\" comes from beyond the outer edge as warm as it is there at the start, {t:.0} K",
                case.materials[material].name
            )
        })
    })
}

/// Columns that `/surface` has at most.
const SURFACE: usize = 24;

/// The tables of the artefact, all of them JSON at the most; `/plasma` has so many columns.
fn output(case: &Case, plasma: usize, mut plan: Plan) -> Plan {
    let grid = &case.grid;
    let bytes = |rows: usize, columns: usize| {
        let none = vec![0.0; rows];
        let table = (0..columns).fold(Table::new(rows), |table, _| {
            table.column("", "", none.iter().copied())
        });
        table.most_bytes() as u64
    };
    plan = plan.output("/plasma", 1, bytes(grid.len(), plasma));
    if let Some(base) = &case.base {
        plan = plan.output("/surface", 1, bytes(grid.nr, SURFACE));
        if case.potential.is_some() {
            plan = plan.output("/lorentz", 1, bytes(grid.nr * base.top(), 4));
        }
    }
    plan
}
