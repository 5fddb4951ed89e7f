//! Conditions of the four sides, face by face.

use run::property::Property;

use crate::assemble::layout::each;
use crate::assemble::{Faults, PLACE, value};
use crate::case::Edges;
use crate::grid::Grid;
use crate::material::REFERENCE_K;
use crate::scene::Sides;

/// A face of the edge: its middle, its area, and the cell inside.
pub(super) struct EdgeFace {
    pub(super) r: f64,
    pub(super) z: f64,
    pub(super) area: f64,
    pub(super) cell: usize,
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
pub(super) fn paint<S, E>(
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

pub(super) fn covers(over: Option<[f64; 2]>, along: f64) -> bool {
    over.is_none_or(|[from, to]| along > from && along < to)
}

/// The values of a property at the faces it covers.
pub(super) fn values(
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
