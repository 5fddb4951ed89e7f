//! Conditions of the four sides, face by face.

use run::property::Property;

use crate::assemble::layout::{Layout, each};
use crate::assemble::{Faults, PLACE, value};
use crate::case::{Edges, FlowEdge, HeatEdge, PotentialEdge, VapourEdge};
use crate::grid::Grid;
use crate::material::{GAS, REFERENCE_K};
use crate::scene::{Scene, Sides};

/// A face of the edge: its middle, its area, and the cell inside.
struct EdgeFace {
    r: f64,
    z: f64,
    area: f64,
    cell: usize,
}

/// The faces of a side, with the position along it.
fn side(grid: &Grid, name: &str) -> Vec<(f64, EdgeFace)> {
    let (r_end, z_end) = (grid.rf[grid.nr], grid.zf[grid.nz]);
    let along_z = |at: usize, r: f64| {
        let face = |j| EdgeFace {
            r,
            z: grid.zc[j],
            area: grid.area(at, j),
            cell: grid.cell(if at == 0 { 0 } else { grid.nr - 1 }, j),
        };
        (0..grid.nz).map(|j| (grid.zc[j], face(j))).collect()
    };
    let along_r = |row: usize, z: f64| {
        let face = |i| EdgeFace {
            r: grid.rc[i],
            z,
            area: grid.ring[i],
            cell: grid.cell(i, row),
        };
        (0..grid.nr).map(|i| (grid.rc[i], face(i))).collect()
    };
    match name {
        "inner" => along_z(0, grid.rf[0]),
        "outer" => along_z(grid.nr, r_end),
        "bottom" => along_r(0, grid.zf[0]),
        _ => along_r(grid.nz - 1, z_end),
    }
}

/// Sets the faces that each condition covers; `one` turns a condition at a face into an edge.
fn paint<S, E>(
    sides: &Sides<S>,
    grid: &Grid,
    at: &str,
    edges: &mut Edges<E>,
    mut one: impl FnMut(&str, &S, &[(f64, EdgeFace)]) -> Vec<Option<E>>,
) {
    each(sides, at, |path, _, condition| {
        let name = path[at.len() + 1..].split('/').next().unwrap_or_default();
        let faces = side(grid, name);
        let found = one(path, condition, &faces);
        let list = match name {
            "inner" => &mut edges.inner,
            "outer" => &mut edges.outer,
            "bottom" => &mut edges.bottom,
            _ => &mut edges.top,
        };
        for (slot, edge) in list.iter_mut().zip(found) {
            if let Some(edge) = edge {
                *slot = edge;
            }
        }
    });
}

fn covers(over: Option<[f64; 2]>, along: f64) -> bool {
    over.is_none_or(|[from, to]| along > from && along < to)
}

/// The values of a property at the faces it covers.
fn values(
    property: &Property,
    over: Option<[f64; 2]>,
    faces: &[(f64, EdgeFace)],
    at: &str,
    faults: &mut Faults,
) -> Vec<Option<f64>> {
    let Some(curve) = faults.keep(property.compile(at, &PLACE)) else {
        return Vec::new();
    };
    let mut all = Vec::with_capacity(faces.len());
    for (along, face) in faces {
        if !covers(over, *along) {
            all.push(None);
            continue;
        }
        match value(&curve, face.r, face.z, REFERENCE_K) {
            Ok(v) => all.push(Some(v)),
            Err(what) => {
                faults.add(at, what);
                return Vec::new();
            }
        }
    }
    all
}

/// Edges of the potential.
pub(crate) fn current(scene: &Scene, grid: &Grid, faults: &mut Faults) -> Edges<PotentialEdge> {
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
pub(crate) fn driven(scene: &Scene) -> Option<f64> {
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

/// Edges of the flow, and whether nothing fixes the pressure.
pub(crate) fn flow(scene: &Scene, layout: &Layout, faults: &mut Faults) -> (Edges<FlowEdge>, bool) {
    let grid = &layout.grid;
    let mut edges = Edges::uniform(grid, FlowEdge::Velocity([0.0; 2]));
    if grid.rf[0] == 0.0 {
        edges.inner.fill(FlowEdge::Slip);
    }
    let Some(flow) = &scene.flow else {
        return (edges, true);
    };
    let mut open = false;
    paint(
        &flow.edges,
        grid,
        "/flow/edges",
        &mut edges,
        |at, c, faces| {
            let keys = [
                c.velocity_m_s.is_some(),
                c.flow_rate_m3_s.is_some(),
                c.pressure_pa.is_some(),
                c.slip.is_some(),
            ];
            if keys.iter().filter(|k| **k).count() != 1 || c.slip == Some(false) {
                let keys = "velocity_m_s, flow_rate_m3_s, pressure_pa, slip (true)";
                faults.add(at, format!("wants exactly one of {keys}"));
                return Vec::new();
            }
            if let Some(p) = &c.pressure_pa {
                if at.contains("/inner/") {
                    faults.add(at, "an inner edge cannot be open");
                }
                open = true;
                let found = values(p, c.over_m, faces, &format!("{at}/pressure_pa"), faults);
                return found.into_iter().map(|p| p.map(FlowEdge::Open)).collect();
            }
            if let Some([radial, axial]) = &c.velocity_m_s {
                let path = format!("{at}/velocity_m_s");
                let u = values(radial, c.over_m, faces, &format!("{path}/0"), faults);
                let w = values(axial, c.over_m, faces, &format!("{path}/1"), faults);
                let pairs = u.into_iter().zip(w);
                return pairs
                    .map(|(u, w)| Some(FlowEdge::Velocity([u?, w?])))
                    .collect();
            }
            let covered = |along: f64| covers(c.over_m, along);
            if let Some(rate) = c.flow_rate_m3_s {
                return inlet(at, rate, layout, faces, &covered, faults);
            }
            faces
                .iter()
                .map(|(along, _)| covered(*along).then_some(FlowEdge::Slip))
                .collect()
        },
    );
    (edges, !open)
}

/// Even inflow over the gas faces that are covered.
fn inlet(
    at: &str,
    rate: f64,
    layout: &Layout,
    faces: &[(f64, EdgeFace)],
    covered: &impl Fn(f64) -> bool,
    faults: &mut Faults,
) -> Vec<Option<FlowEdge>> {
    let gas = |along: f64, face: &EdgeFace| covered(along) && layout.material[face.cell] == GAS;
    let area: f64 = faces
        .iter()
        .filter(|(a, f)| gas(*a, f))
        .map(|(_, f)| f.area)
        .sum();
    if area <= 0.0 {
        faults.add(at, "covers no gas");
        return Vec::new();
    }
    let speed = rate / area;
    let velocity = if at.contains("/inner/") {
        [speed, 0.0]
    } else if at.contains("/outer/") {
        [-speed, 0.0]
    } else if at.contains("/bottom/") {
        [0.0, speed]
    } else {
        [0.0, -speed]
    };
    faces
        .iter()
        .map(|(a, f)| gas(*a, f).then_some(FlowEdge::Velocity(velocity)))
        .collect()
}

/// Edges of the heat.
pub(crate) fn heat(scene: &Scene, grid: &Grid, faults: &mut Faults) -> Edges<HeatEdge> {
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

/// Edges of the vapour.
pub(crate) fn vapour(scene: &Scene, grid: &Grid, faults: &mut Faults) -> Edges<VapourEdge> {
    let mut edges = Edges::uniform(grid, VapourEdge::Sealed);
    let Some(vapour) = &scene.vapour else {
        return edges;
    };
    paint(
        &vapour.edges,
        grid,
        "/vapour/edges",
        &mut edges,
        |at, c, faces| {
            let at = format!("{at}/iron_mass_fraction");
            let found = values(&c.iron_mass_fraction, c.over_m, faces, &at, faults);
            if found.iter().flatten().any(|y| !(0.0..=1.0).contains(y)) {
                faults.add(&at, "is not from 0 to 1 everywhere");
            }
            found
                .into_iter()
                .map(|y| y.map(VapourEdge::Fraction))
                .collect()
        },
    );
    edges
}
