//! The current of the scene.

use super::edges::{covers, paint, values};
use super::electrodes::Electrodes;
use super::layout::{Layout, each};
use super::{Faults, cell_source};
use crate::case::{Edges, PotentialCase, PotentialEdge};
use crate::current::sheath::Sheath;
use crate::grid::Grid;
use crate::material::Material;
use crate::scene::{Current, Scene, SheathAt, SheathKeeps};

/// The current, where the scene has one; its sheath follows from electrodes, and those from it.
pub(super) fn current(scene: &Scene, grid: &Grid, faults: &mut Faults) -> Option<PotentialCase> {
    let current = scene.current.as_ref()?;
    let (source, at) = (current.source_a_m3.as_ref(), "/current/source_a_m3");
    Some(PotentialCase {
        edges: edges(scene, grid, faults),
        driven: driven(scene),
        source: cell_source(grid, source, at, faults),
        sheath: None,
    })
}

/// Edges of the potential.
pub(super) fn edges(scene: &Scene, grid: &Grid, faults: &mut Faults) -> Edges<PotentialEdge> {
    let mut edges = Edges::uniform(grid, PotentialEdge::Insulated);
    let Some(current) = &scene.current else {
        return edges;
    };
    let mut fixed = false;
    paint(
        &current.edges,
        grid,
        "/current/edges",
        &mut edges,
        |at, c, faces| match (&c.voltage_v, &c.current_density_a_m2, c.total_current_a) {
            (Some(v), None, None) => {
                fixed = true;
                let found = values(v, c.over_m, faces, &format!("{at}/voltage_v"), faults);
                found
                    .into_iter()
                    .map(|v| v.map(PotentialEdge::Voltage))
                    .collect()
            }
            (None, Some(j), None) => {
                let at = format!("{at}/current_density_a_m2");
                let found = values(j, c.over_m, faces, &at, faults)
                    .into_iter()
                    .zip(faces);
                found
                    .map(|(j, (_, f))| j.map(|j| PotentialEdge::Current(j * f.area)))
                    .collect()
            }
            (None, None, Some(current)) => {
                if current.abs() <= 0.0 {
                    let what = "0 A drives nothing: wanted is another current, or no key 'current' for an arc without one";
                    faults.add(&format!("{at}/total_current_a"), what);
                }
                let driven =
                    |along: &f64| covers(c.over_m, *along).then_some(PotentialEdge::Driven);
                faces.iter().map(|(along, _)| driven(along)).collect()
            }
            _ => {
                let keys = "voltage_v, current_density_a_m2, total_current_a";
                faults.add(at, format!("wants exactly one of {keys}"));
                Vec::new()
            }
        },
    );
    if !fixed {
        faults.add(
            "/current/edges",
            "no voltage_v anywhere: the potential is not defined",
        );
    }
    check_driven(scene, &edges, faults);
    edges
}

/// The driven current of the scene \[A\].
fn driven(scene: &Scene) -> Option<f64> {
    let edges = &scene.current.as_ref()?.edges;
    let mut found = None;
    each(edges, "", |_, _, c| found = found.or(c.total_current_a));
    found
}

/// With a driven current everything else is at zero potential or insulated.
fn check_driven(scene: &Scene, edges: &Edges<PotentialEdge>, faults: &mut Faults) {
    let Some(current) = &scene.current else {
        return;
    };
    let mut places = Vec::new();
    each(&current.edges, "/current/edges", |at, _, c| {
        if c.total_current_a.is_some() {
            places.push(format!("{at}/total_current_a"));
        }
    });
    let Some(first) = places.first() else {
        return;
    };
    if places.len() > 1 {
        faults.add(&places[1], "a second driven face; only one can be driven");
    }
    let all = edges
        .inner
        .iter()
        .chain(&edges.outer)
        .chain(&edges.bottom)
        .chain(&edges.top);
    let foreign = |e: &PotentialEdge| match e {
        PotentialEdge::Voltage(v) => *v != 0.0,
        PotentialEdge::Current(i) => *i != 0.0,
        PotentialEdge::Insulated | PotentialEdge::Driven => false,
    };
    if all.clone().any(foreign) || current.source_a_m3.is_some() {
        faults.add(
            first,
            "wants 0 V or insulation everywhere else and no current source",
        );
    }
    if !all.clone().any(|e| *e == PotentialEdge::Driven) {
        faults.add(first, "covers no face");
    }
}

/// The gas close to electrodes, where it conducts as the gas beyond.
pub(super) fn sheath(
    current: &Current,
    layout: &Layout,
    electrodes: &Electrodes,
) -> Option<Sheath> {
    let has = |m: usize| match current.sheath_at {
        SheathAt::Electrodes => electrodes.of[m].is_some(),
        SheathAt::Cathode => electrodes.is_cathode(m),
    };
    let has = (0..electrodes.of.len()).map(has).collect();
    let sheath = Sheath::new(&layout.grid, &layout.material, has, current.sheath_m?);
    Some(match current.sheath_keeps {
        SheathKeeps::Conductivity => sheath,
        SheathKeeps::ElectronDensity => sheath.keeping_electrons(),
    })
}

/// Whether the gas tells the electrons that its sheath is to keep.
pub(super) fn electrons(current: &Current, gas: &Material, faults: &mut Faults) {
    let wants = current.sheath_keeps == SheathKeeps::ElectronDensity;
    if wants && gas.electron_density.is_none() {
        let what = "electron_density wants a gas table with the column electron_density_1_m3";
        faults.add("/current/sheath_keeps", what);
    }
}
