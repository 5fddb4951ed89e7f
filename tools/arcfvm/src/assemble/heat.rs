//! The heat of the scene.

use super::edges::{paint, values};
use super::layout::Layout;
use super::{Faults, cell_source};
use crate::case::{Edges, HeatCase, HeatEdge, MovingPlate};
use crate::grid::Grid;
use crate::scene::{self, Body, Heat, Moving, Scene};

/// The heat, where the scene has any.
pub(super) fn heat(
    scene: &Scene,
    layout: &Layout,
    bodies: &[(&String, &Body)],
    start: &[f64],
    faults: &mut Faults,
) -> Option<HeatCase> {
    let heat = scene.heat.as_ref()?;
    let edges = edges(scene, &layout.grid, faults);
    let (source, at) = (heat.source_w_m3.as_ref(), "/heat/source_w_m3");
    Some(HeatCase {
        plates: plates(bodies, &edges, &layout.grid, start),
        edges,
        source: cell_source(&layout.grid, source, at, faults),
        electrons: carriers(scene, heat, faults),
        conduction: heat.conduction,
    })
}

/// Edges of the heat.
pub(super) fn edges(scene: &Scene, grid: &Grid, faults: &mut Faults) -> Edges<HeatEdge> {
    let mut edges = Edges::uniform(grid, HeatEdge::Insulated);
    let Some(heat) = &scene.heat else {
        return edges;
    };
    paint(
        &heat.edges,
        grid,
        "/heat/edges",
        &mut edges,
        |at, c, faces| match (&c.temperature_k, &c.flux_w_m2) {
            (Some(t), None) => {
                let at = format!("{at}/temperature_k");
                let found = values(t, c.over_m, faces, &at, faults);
                if found.iter().flatten().any(|t| *t <= 0.0) {
                    faults.add(&at, "is not above 0 K everywhere");
                }
                found
                    .into_iter()
                    .map(|t| t.map(HeatEdge::Temperature))
                    .collect()
            }
            (None, Some(q)) => {
                let found = values(q, c.over_m, faces, &format!("{at}/flux_w_m2"), faults);
                found.into_iter().map(|q| q.map(HeatEdge::Flux)).collect()
            }
            _ => {
                faults.add(at, "wants exactly one of temperature_k, flux_w_m2");
                Vec::new()
            }
        },
    );
    edges
}

/// What electrons carry, which wants a current.
fn carriers(scene: &Scene, heat: &Heat, faults: &mut Faults) -> Option<scene::Electrons> {
    if heat.electrons.is_some() && scene.current.is_none() {
        faults.add("/heat/electrons", "wants a current that electrons carry");
    }
    heat.electrons
}

/// Moving bodies; beyond the edge of the domain they are as warm as the edge is, or as the domain is there at the start.
fn plates(
    bodies: &[(&String, &Body)],
    edges: &Edges<HeatEdge>,
    grid: &Grid,
    start: &[f64],
) -> Vec<MovingPlate> {
    let outer = edges.outer.iter().enumerate();
    let beyond = outer.map(|(j, edge)| match edge {
        HeatEdge::Temperature(t) => *t,
        HeatEdge::Insulated | HeatEdge::Flux(_) => start[grid.cell(grid.nr - 1, j)],
    });
    let beyond: Vec<f64> = beyond.collect();
    let moving = bodies.iter().enumerate();
    let moving = moving.filter_map(|(n, (_, body))| Some((n, body.moving.as_ref()?)));
    let plate = |(n, moving): (usize, &Moving)| MovingPlate {
        speed: moving.speed_m_s,
        ahead: moving.ahead_m,
        swept: moving.swept.widths(),
        material: n + 1,
        beyond: beyond.clone(),
    };
    moving.map(plate).collect()
}
