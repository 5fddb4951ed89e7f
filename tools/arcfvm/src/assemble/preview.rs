//! What would be there before a run: cells by body, and what current, heat and flow meet at the edges of the domain.

use run::Failure;
use run::preview::{Coordinates, Marked, Preview, Spot};

use super::layout::Layout;
use super::{Faults, current, flow, heat};
use crate::case::{FlowEdge, HeatEdge, PotentialEdge};
use crate::grid::Grid;
use crate::scene::Scene;

/// Cells, edges and the axis of a scene; gas tables are not read.
///
/// # Errors
/// Faults of bodies, grid and edges.
pub fn preview(scene: &Scene) -> Result<Preview, Failure> {
    let mut faults = Faults::default();
    let layout = Layout::new(scene, &mut faults);
    let mut faults = faults.none()?;
    let Some(layout) = layout else {
        return Err(Failure::Other("the scene has no grid".to_owned()));
    };
    let grid = &layout.grid;
    let mut preview = Preview::new(Coordinates::Axisymmetric);
    preview.material("gas");
    for (name, _) in Layout::bodies(scene) {
        preview.material(name);
    }
    let conditions = conditions(scene, &layout, &mut faults);
    faults.none()?;
    for j in 0..grid.nz {
        for i in 0..grid.nr {
            let k = grid.cell(i, j);
            let condition = match &conditions[k] {
                Some(name) => preview.condition(name),
                None => 0,
            };
            preview.spot(Spot {
                place: [grid.rc[i], 0.0, grid.zc[j]],
                size: [grid.dr[i], 0.0, grid.dz[j]],
                material: layout.material[k] as u32,
                condition,
            });
        }
    }
    let ends = [grid.zf[0], grid.zf[grid.nz]].map(|z| [0.0, 0.0, z]);
    preview.mark(Marked::Axis, "axis of the arc", vec![ends.to_vec()]);
    Ok(preview)
}

/// What each cell at the outer, lower and upper edge meets there; a corner is told by its lower or upper edge.
fn conditions(scene: &Scene, layout: &Layout, faults: &mut Faults) -> Vec<Option<String>> {
    let grid = &layout.grid;
    let current = scene.current.as_ref();
    let current = current.map(|_| current::edges(scene, grid, faults));
    let heat = scene.heat.as_ref();
    let heat = heat.map(|_| heat::edges(scene, grid, faults));
    let flow = scene.flow.as_ref();
    let flow = flow.map(|_| flow::edges(scene, layout, faults).0);
    let mut all = vec![None; grid.len()];
    for (k, side, n) in at_edges(grid) {
        let parts = [
            current
                .as_ref()
                .map(|e| potential([&e.outer, &e.bottom, &e.top][side][n])),
            heat.as_ref()
                .map(|e| warmth([&e.outer, &e.bottom, &e.top][side][n])),
            flow.as_ref()
                .map(|e| motion([&e.outer, &e.bottom, &e.top][side][n])),
        ];
        let told: Vec<&str> = parts.into_iter().flatten().collect();
        all[k] = (!told.is_empty()).then(|| told.join(", "));
    }
    all
}

/// Cells at the outer (0), lower (1) and upper (2) edge with the number of their face there.
fn at_edges(grid: &Grid) -> Vec<(usize, usize, usize)> {
    let outer = (0..grid.nz).map(|j| (grid.cell(grid.nr - 1, j), 0, j));
    let ends = (0..grid.nr).flat_map(|i| {
        let (bottom, top) = (grid.cell(i, 0), grid.cell(i, grid.nz - 1));
        [(bottom, 1, i), (top, 2, i)]
    });
    outer.chain(ends).collect()
}

fn potential(edge: PotentialEdge) -> &'static str {
    match edge {
        PotentialEdge::Insulated => "no current",
        PotentialEdge::Voltage(_) => "held potential",
        PotentialEdge::Current(_) => "given current",
        PotentialEdge::Driven => "total current",
    }
}

fn warmth(edge: HeatEdge) -> &'static str {
    match edge {
        HeatEdge::Insulated => "no conduction",
        HeatEdge::Temperature(_) => "held temperature",
        HeatEdge::Flux(_) => "heat flux",
    }
}

fn motion(edge: FlowEdge) -> &'static str {
    match edge {
        FlowEdge::Velocity(u) if u.iter().all(|u| u.abs() <= 0.0) => "wall",
        FlowEdge::Velocity(_) => "inflow",
        FlowEdge::Open(_) => "open",
        FlowEdge::Slip => "slip",
    }
}
