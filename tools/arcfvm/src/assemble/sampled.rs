//! What formulas at edges and of sources bring in: they are taken in the middles of faces and cells, and integrated apart from that.

use std::f64::consts::PI;

use run::property::{Curve, Property};

use crate::assemble::edges::covers;
use crate::assemble::layout::each;
use crate::assemble::{PLACE, value};
use crate::grid::Grid;
use crate::material::REFERENCE_K;
use crate::scene::Scene;

/// Parts of a face over which a formula is integrated, and of a cell in either direction.
const PARTS: [usize; 2] = [64, 4];
/// Part of what a formula prescribes by which that of the grid may differ.
const MOST: f64 = 0.01;

/// A formula at a part of an edge.
struct Given {
    key: String,
    unit: &'static str,
    property: Property,
    over: Option<[f64; 2]>,
}

/// Sums over faces or cells: as the grid has it, as prescribed, and of the amounts prescribed, for scale.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    grid: f64,
    meant: f64,
    size: f64,
}

/// Formulas whose sum on the grid is not what they prescribe.
pub(crate) fn told(scene: &Scene, grid: &Grid) -> Vec<String> {
    let mut all = Vec::new();
    for given in edges(scene) {
        let side = given.key.split('/').nth(3).unwrap_or_default();
        let sums =
            formula(&given.property, &given.key).map(|curve| faces(&curve, grid, side, given.over));
        all.extend(sums.and_then(|sums| words(&given.key, given.unit, "faces", sums)));
    }
    let source = scene
        .heat
        .as_ref()
        .and_then(|heat| heat.source_w_m3.as_ref());
    let key = "/heat/source_w_m3";
    let sums = source
        .and_then(|p| formula(p, key))
        .map(|curve| cells(&curve, grid));
    all.extend(sums.and_then(|sums| words(key, "W", "cells", sums)));
    all
}

/// All formulas of fluxes at edges.
fn edges(scene: &Scene) -> Vec<Given> {
    let mut all = Vec::new();
    let mut put = |key: String, unit, property: Option<&Property>, over| {
        all.extend(property.cloned().map(|property| Given {
            key,
            unit,
            property,
            over,
        }));
    };
    if let Some(current) = &scene.current {
        each(&current.edges, "/current/edges", |at, _, edge| {
            let key = format!("{at}/current_density_a_m2");
            put(key, "A", edge.current_density_a_m2.as_ref(), edge.over_m);
        });
    }
    if let Some(heat) = &scene.heat {
        each(&heat.edges, "/heat/edges", |at, _, edge| {
            let key = format!("{at}/flux_w_m2");
            put(key, "W", edge.flux_w_m2.as_ref(), edge.over_m);
        });
    }
    if let Some(flow) = &scene.flow {
        each(&flow.edges, "/flow/edges", |at, along_r, edge| {
            let across = usize::from(along_r);
            let key = format!("{at}/velocity_m_s/{across}");
            let velocity = edge.velocity_m_s.as_ref().map(|parts| &parts[across]);
            put(key, "m3/s", velocity, edge.over_m);
        });
    }
    all
}

/// The curve of a property that varies with place.
fn formula(property: &Property, at: &str) -> Option<Curve> {
    let curve = property.compile(at, &PLACE).ok()?;
    curve.constant().is_none().then_some(curve)
}

fn faces(curve: &Curve, grid: &Grid, side: &str, over: Option<[f64; 2]>) -> Sums {
    let (r_end, z_end) = (grid.rf[grid.nr], grid.zf[grid.nz]);
    let (along_r, fixed) = match side {
        "inner" => (false, grid.rf[0]),
        "outer" => (false, r_end),
        "bottom" => (true, grid.zf[0]),
        _ => (true, z_end),
    };
    let (ends, middles) = match along_r {
        true => (&grid.rf, &grid.rc),
        false => (&grid.zf, &grid.zc),
    };
    let area = |from: f64, to: f64| match along_r {
        true => PI * (to * to - from * from),
        false => 2.0 * PI * fixed * (to - from),
    };
    let at = |along: f64| match along_r {
        true => value(curve, along, fixed, REFERENCE_K).unwrap_or(f64::NAN),
        false => value(curve, fixed, along, REFERENCE_K).unwrap_or(f64::NAN),
    };
    let mut sums = Sums::default();
    for (pair, middle) in ends.windows(2).zip(middles) {
        if !covers(over, *middle) {
            continue;
        }
        sums.grid += at(*middle) * area(pair[0], pair[1]);
        let part = (pair[1] - pair[0]) / PARTS[0] as f64;
        for n in 0..PARTS[0] {
            let from = pair[0] + n as f64 * part;
            let through = at(from + 0.5 * part) * area(from, from + part);
            sums.meant += through;
            sums.size += through.abs();
        }
    }
    sums
}

fn cells(curve: &Curve, grid: &Grid) -> Sums {
    let at = |r: f64, z: f64| value(curve, r, z, REFERENCE_K).unwrap_or(f64::NAN);
    let mut sums = Sums::default();
    for j in 0..grid.nz {
        for i in 0..grid.nr {
            sums.grid += at(grid.rc[i], grid.zc[j]) * grid.volume(i, j);
            let (dr, dz) = (grid.dr[i] / PARTS[1] as f64, grid.dz[j] / PARTS[1] as f64);
            for n in 0..PARTS[1] {
                let from = grid.rf[i] + n as f64 * dr;
                let ring = PI * dr * (2.0 * from + dr) * dz;
                for k in 0..PARTS[1] {
                    let source = ring * at(from + 0.5 * dr, grid.zf[j] + (k as f64 + 0.5) * dz);
                    sums.meant += source;
                    sums.size += source.abs();
                }
            }
        }
    }
    sums
}

/// What is to be told; nothing where the grid resolves the formula.
fn words(key: &str, unit: &str, places: &str, sums: Sums) -> Option<String> {
    let Sums { grid, meant, size } = sums;
    let is_off = (grid - meant).abs() > MOST * size;
    is_off.then(|| {
        format!(
            "{key} brings {grid:.4e} {unit} in the middles of {places} and {meant:.4e} {unit} by its integral, {:.0} % apart \
             where at most {:.0} % may be: smaller cells resolve the formula",
            100.0 * (grid - meant).abs() / size,
            100.0 * MOST
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assemble::assemble;
    use run::scene::{Expected, parse};
    use serde_json::{Value, json};

    fn told_of(more: &Value) -> Vec<String> {
        let mut scene = json!({
            "kind": "arcfvm.scene", "version": 1, "title": "A cylinder", "domain": {"r_m": [0, 5e-3], "z_m": [0, 2e-3]}, "grid": {"r": 5e-4, "z": 1e-3},
            "gas": {"given": {"thermal_conductivity_w_m_k": 1.5, "specific_heat_j_kg_k": 500, "density_kg_m3": 0.1,
                "electric_conductivity_s_m": 1000, "net_emission_w_m3": 0}},
            "start": {"temperature_k": 1000}, "iterate": {}
        });
        scene
            .as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        let expected = Expected {
            kind: "arcfvm.scene",
            version: 1,
            migrations: &[],
        };
        let scene = parse::<Scene>(&scene.to_string(), expected).unwrap().scene;
        let case = assemble(&scene, None).unwrap();
        told(&scene, &case.grid)
    }

    #[test]
    fn a_profile_that_the_grid_does_not_resolve_is_told() {
        // 4.4563e9 A/m2 over the area pi (0.1 mm)^2 are 140 A.
        let current = |formula: &str| {
            let edges = json!({"bottom": [{"voltage_v": 0}], "top": [{"current_density_a_m2": {"expr": formula}}]});
            told_of(&json!({"current": {"edges": edges}}))
        };
        let said = current("4.4563e9*exp(-(r/1e-4)^2)");
        assert_eq!(said.len(), 1);
        assert!(
            said[0].contains("and 1.400") && said[0].contains("A by its integral"),
            "{said:?}"
        );
        assert!(current("1.1141e7*exp(-(r/2e-3)^2)").is_empty());
        let heat = |key: &str, formula: &str| {
            let outer = json!([{"temperature_k": 1000}]);
            let flux = json!([{"flux_w_m2": {"expr": formula}}]);
            told_of(&match key {
                "edge" => json!({"heat": {"edges": {"outer": outer, "top": flux}}}),
                _ => json!({"heat": {"edges": {"outer": outer}, "source_w_m3": {"expr": formula}}}),
            })
        };
        for key in ["edge", "source"] {
            assert_eq!(heat(key, "1e8*exp(-(r/1e-4)^2)").len(), 1, "{key}");
            assert!(heat(key, "1e8*exp(-(r/2e-3)^2)").is_empty(), "{key}");
        }
    }
}
