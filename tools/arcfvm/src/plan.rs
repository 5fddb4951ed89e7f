//! What `arcfvm check` tells before anything runs.

use artefact::Table;
use run::Plan;

use crate::case::Case;
use crate::material::GAS;
use crate::scene::Scene;

/// Columns of 8 bytes per cell: state, equation, solver and its hierarchy, measured by count.
const COLUMNS_CURRENT: usize = 30;
const COLUMNS_FLOW: usize = 60;
const COLUMNS_HEAT: usize = 32;
const COLUMNS_VAPOUR: usize = 36;

/// Columns of the artefact's `/plasma` where heat, flow and current are solved.
const HEAT: [(&str, &str); 1] = [("temperature_k", "K")];
const FLOW: [(&str, &str); 3] = [
    ("radial_velocity_m_s", "m/s"),
    ("axial_velocity_m_s", "m/s"),
    ("pressure_pa", "Pa"),
];
const CURRENT: [(&str, &str); 6] = [
    ("potential_v", "V"),
    ("current_radial_a_m2", "A/m2"),
    ("current_axial_a_m2", "A/m2"),
    ("magnetic_field_t", "T"),
    ("lorentz_radial_n_m3", "N/m3"),
    ("lorentz_axial_n_m3", "N/m3"),
];

const VAPOUR: [(&str, &str); 1] = [("iron_mass_fraction", "1")];

/// The plan of an assembled scene.
#[must_use]
pub(crate) fn plan(scene: &Scene, case: &Case) -> Plan {
    let n = case.grid.len();
    let gas = case.material.iter().filter(|m| **m == GAS).count();
    let bytes = |columns: usize| (8 * columns * n) as u64;
    let mut plan = Plan::new()
        .count("cells", n as u64)
        .count("radial_cells", case.grid.nr as u64)
        .count("axial_cells", case.grid.nz as u64)
        .count("gas_cells", gas as u64);
    let parts = [
        ("current", scene.current.is_some(), COLUMNS_CURRENT),
        ("flow", scene.flow.is_some(), COLUMNS_FLOW),
        ("heat", scene.heat.is_some(), COLUMNS_HEAT),
        ("vapour", scene.vapour.is_some(), COLUMNS_VAPOUR),
    ];
    for (name, active, columns) in parts {
        plan = if active {
            plan.stage(name).memory(name, bytes(columns))
        } else {
            plan.left_out(name, &format!("no key '{name}'"))
        };
    }
    for (active, columns) in [
        (scene.heat.is_some(), &HEAT[..]),
        (scene.flow.is_some(), &FLOW[..]),
        (scene.current.is_some(), &CURRENT[..]),
        (scene.vapour.is_some(), &VAPOUR[..]),
    ] {
        for (name, unit) in columns.iter().filter(|_| active) {
            plan = plan.column(name, unit);
        }
    }
    if case.heat.as_ref().is_some_and(|h| h.granular.is_some()) {
        plan = plan.column("slag", "1");
    }
    output(scene, case, plan)
}

/// Columns that `/surface` has at most.
const SURFACE: usize = 24;

/// The tables of the artefact, all of them JSON at the most.
fn output(scene: &Scene, case: &Case, mut plan: Plan) -> Plan {
    let grid = &case.grid;
    let bytes = |rows: usize, columns: usize| {
        let none = vec![0.0; rows];
        let table = (0..columns).fold(Table::new(rows), |table, _| {
            table.column("", "", none.iter().copied())
        });
        table.most_bytes() as u64
    };
    let solved = [
        (scene.heat.is_some(), HEAT.len()),
        (scene.flow.is_some(), FLOW.len()),
        (scene.current.is_some(), CURRENT.len()),
        // The density of electrons beside what is solved for.
        (scene.vapour.is_some(), VAPOUR.len() + 1),
    ];
    let solved: usize = solved.iter().filter(|part| part.0).map(|part| part.1).sum();
    // The cells' places, slag and material.
    plan = plan.output("/plasma", 1, bytes(grid.len(), solved + 4));
    if let Some(base) = &case.base {
        plan = plan.output("/surface", 1, bytes(grid.nr, SURFACE));
        if scene.current.is_some() {
            plan = plan.output("/lorentz", 1, bytes(grid.nr * base.top(), 4));
        }
    }
    plan
}
