//! The flow of the scene.

use run::property::Property;

use super::edges::{EdgeFace, covers, paint, values};
use super::layout::Layout;
use super::{Faults, PLACE, value};
use crate::case::{Case, Edges, Faces, FlowCase, FlowEdge, Gravity, HeatEdge, Inlets, VapourEdge};
use crate::grid::Grid;
use crate::material::{GAS, Material, REFERENCE_K};
use crate::scene::Scene;

/// The flow, where the scene has one; the gas that enters is told once heat and vapour are.
pub(super) fn flow(
    scene: &Scene,
    layout: &Layout,
    materials: &[Material],
    faults: &mut Faults,
) -> Option<FlowCase> {
    let given = scene.flow.as_ref()?;
    let grid = &layout.grid;
    let (edges, closed) = edges(scene, layout, faults);
    let (radial, axial) = (&given.force_radial_n_m3, &given.force_axial_n_m3);
    let force = (radial.is_some() || axial.is_some()).then(|| {
        let (radial, axial) = (radial.as_ref(), axial.as_ref());
        [
            face_force(grid, radial, "/flow/force_radial_n_m3", true, faults),
            face_force(grid, axial, "/flow/force_axial_n_m3", false, faults),
        ]
    });
    let density = materials[GAS].density.as_ref();
    let gravity = given.gravity_m_s2.map(|acceleration| Gravity {
        acceleration,
        reference_density: density.map_or(0.0, |d| d.at(grid.rc[0], grid.zc[0], REFERENCE_K)),
    });
    Some(FlowCase {
        faces: Faces::new(grid, &layout.material, &edges),
        inlets: Inlets::default(),
        edges,
        gravity,
        force,
        closed,
    })
}

/// Edges of the flow, and whether nothing fixes the pressure.
pub(super) fn edges(
    scene: &Scene,
    layout: &Layout,
    faults: &mut Faults,
) -> (Edges<FlowEdge>, bool) {
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

/// A given force on every radial or axial face.
fn face_force(
    grid: &Grid,
    property: Option<&Property>,
    at: &str,
    radial: bool,
    faults: &mut Faults,
) -> Vec<f64> {
    let faces = if radial {
        grid.radial_faces()
    } else {
        grid.axial_faces()
    };
    let mut all = vec![0.0; faces];
    let Some(curve) = property.and_then(|p| faults.keep(p.compile(at, &PLACE))) else {
        return all;
    };
    let wide = if radial { grid.nr + 1 } else { grid.nr };
    for (k, out) in all.iter_mut().enumerate() {
        let (i, j) = (k % wide, k / wide);
        let (r, z) = if radial {
            (grid.rf[i], grid.zc[j])
        } else {
            (grid.rc[i], grid.zf[j])
        };
        match value(&curve, r, z, REFERENCE_K) {
            Ok(v) => *out = v,
            Err(what) => {
                faults.add(at, what);
                break;
            }
        }
    }
    all
}

/// An edge face that gas may enter through.
struct Entrance {
    cell: usize,
    place: [f64; 2],
    heat: Option<HeatEdge>,
    iron: Option<VapourEdge>,
}

impl Entrance {
    /// Density of the gas that enters, where its temperature and its iron are known \[kg/m3\].
    fn density(&self, case: &Case) -> Option<f64> {
        let t = match (self.heat, self.iron) {
            (Some(HeatEdge::Temperature(t)), _) => t,
            // Vapour at temperatures that are not solved.
            (None, Some(_)) => case.start[self.cell],
            _ => return None,
        };
        let y = match self.iron {
            None => 0.0,
            Some(VapourEdge::Fraction(y)) => y,
            Some(VapourEdge::Sealed) => return None,
        };
        let ([r, z], law) = (self.place, case.materials[GAS].density.as_ref());
        law.map(|l| l.within(r, z, t, y))
    }
}

/// Gas that enters at edges where its state is given.
pub(super) fn inlets(case: &Case) -> Inlets {
    let grid = &case.grid;
    let heat = case.heat.as_ref().map(|h| &h.edges);
    let iron = case.vapour.as_ref().map(|v| &v.edges);
    let outer = |j: usize| Entrance {
        cell: grid.cell(grid.nr - 1, j),
        place: [grid.rf[grid.nr], grid.zc[j]],
        heat: heat.map(|e| e.outer[j]),
        iron: iron.map(|e| e.outer[j]),
    };
    let bottom = |i: usize| Entrance {
        cell: grid.cell(i, 0),
        place: [grid.rc[i], grid.zf[0]],
        heat: heat.map(|e| e.bottom[i]),
        iron: iron.map(|e| e.bottom[i]),
    };
    let top = |i: usize| Entrance {
        cell: grid.cell(i, grid.nz - 1),
        place: [grid.rc[i], grid.zf[grid.nz]],
        heat: heat.map(|e| e.top[i]),
        iron: iron.map(|e| e.top[i]),
    };
    Inlets {
        outer: (0..grid.nz).map(|j| outer(j).density(case)).collect(),
        bottom: (0..grid.nr).map(|i| bottom(i).density(case)).collect(),
        top: (0..grid.nr).map(|i| top(i).density(case)).collect(),
    }
}
