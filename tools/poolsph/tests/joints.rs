//! Bodies that are composed, turned, or read from a file: as many particles as their volume asks for, where they belong.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::process::Command;

/// Points of metal that `check --points` shows for one body of spacing 0.5 mm.
fn particles(folder: &Path, shape: &str) -> Result<usize, String> {
    let scene = format!(
        r#"{{"kind": "poolsph.scene", "version": 2, "spacing_m": 0.0005, "density_kg_m3": 7850,
            "time": {{"step_s": 1e-4, "end_s": 1e-3}},
            "bodies": [{{"shape": {shape}, "state": "solid", "temperature_k": 300}}],
            "heat": {{"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 600}},
            "output": {{"particles_interval_s": 1e-3}}}}"#
    );
    let path = folder.join("scene.json");
    std::fs::write(&path, scene).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_poolsph"))
        .arg("check")
        .arg(&path)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        return Err(said);
    }
    let row = said.lines().find(|row| row.contains("particles")).unwrap();
    let number = row
        .split_whitespace()
        .find_map(|word| word.replace(',', "").parse().ok());
    Ok(number.unwrap_or_else(|| panic!("{said}")))
}

const PLATE: &str = r#"{"box": {"min_m": [-0.01, 0, -0.006], "max_m": [0.01, 0.02, 0]}}"#;

#[test]
fn grooves_fillets_and_turned_plates_have_their_volumes() {
    let folder = tempfile::tempdir().unwrap();
    let count = |shape: &str| particles(folder.path(), shape).unwrap();
    let d3 = 0.5e-3_f64.powi(3);
    let near = |found: usize, volume: f64, part: f64| {
        let ratio = found as f64 * d3 / volume;
        assert!((ratio - 1.0).abs() < part, "{ratio} of {volume}");
    };
    assert_eq!(count(PLATE), 40 * 40 * 12);
    // A V of 90 degrees, 4 mm deep: two half spaces that meet at its root.
    let groove = format!(
        r#"{{"difference": [{PLATE}, {{"intersection": [
            {{"half_space": {{"point_m": [0, 0, -0.004], "normal": [1, 0, -1]}}}},
            {{"half_space": {{"point_m": [0, 0, -0.004], "normal": [-1, 0, -1]}}}}]}}]}}"#
    );
    near(count(&groove), (20.0 * 6.0 - 16.0) * 20.0 * 1e-9, 0.02);
    let tee = r#"{"union": [{"box": {"min_m": [-0.01, 0, -0.006], "max_m": [0.01, 0.02, 0]}},
        {"box": {"min_m": [-0.003, 0, 0], "max_m": [0.003, 0.02, 0.01]}}]}"#;
    assert_eq!(count(tee), 40 * 40 * 12 + 12 * 40 * 20);
    let turned = format!(r#"{{"turned": {{"shape": {PLATE}, "axis": "y", "angle_deg": 30}}}}"#);
    near(count(&turned), 20.0 * 20.0 * 6.0 * 1e-9, 0.02);
}

/// A prism over a polygon of x and z \[mm\], which goes round once, from y = 0 to `long`, as a text of STL.
fn prism(outline: &[[f64; 2]], long: f64) -> String {
    let n = outline.len();
    let at = |k: usize, y: f64| [outline[k % n][0], y, outline[k % n][1]];
    let mut facets = Vec::new();
    for k in 0..n {
        facets.push([at(k, 0.0), at(k + 1, 0.0), at(k + 1, long)]);
        facets.push([at(k, 0.0), at(k + 1, long), at(k, long)]);
    }
    for k in 1..n - 1 {
        facets.push([at(0, 0.0), at(k + 1, 0.0), at(k, 0.0)]);
        facets.push([at(0, long), at(k, long), at(k + 1, long)]);
    }
    let told = |facet: &[[f64; 3]; 3]| {
        let corners: String = facet
            .iter()
            .map(|[x, y, z]| format!("vertex {x} {y} {z}\n"))
            .collect();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let all: String = facets.iter().map(told).collect();
    format!("solid part\n{all}endsolid part\n")
}

#[test]
fn a_plate_with_a_groove_is_read_from_a_file() {
    let folder = tempfile::tempdir().unwrap();
    // Fans from the first corner: the root of the groove sees all others.
    let outline = [
        [0.0, -4.0],
        [4.0, 0.0],
        [10.0, 0.0],
        [10.0, -6.0],
        [-10.0, -6.0],
        [-10.0, 0.0],
        [-4.0, 0.0],
    ];
    let whole = prism(&outline, 20.0);
    std::fs::write(folder.path().join("part.stl"), &whole).unwrap();
    let from = |unit: &str| format!(r#"{{"stl": {{"file": "part.stl", "unit": "{unit}"}}}}"#);
    let found = particles(folder.path(), &from("mm")).unwrap();
    let ratio = found as f64 * 0.125 / ((20.0 * 6.0 - 16.0) * 20.0);
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    // One of two of another: a union of a file and a box that covers its groove.
    let filled = format!(
        r#"{{"union": [{}, {{"box": {{"min_m": [-0.004, 0, -0.005], "max_m": [0.004, 0.02, 0]}}}}]}}"#,
        from("mm")
    );
    assert_eq!(particles(folder.path(), &filled).unwrap(), 40 * 40 * 12);
    let told = particles(folder.path(), &from("m")).unwrap_err();
    assert!(told.contains("/bodies/0/shape"), "{told}");
    let torn = whole.replacen("facet normal", "facet  normal", 1);
    let cut = torn.find("endfacet").unwrap() + "endfacet\n".len();
    std::fs::write(
        folder.path().join("part.stl"),
        format!("solid part\n{}", &torn[cut..]),
    )
    .unwrap();
    let told = particles(folder.path(), &from("mm")).unwrap_err();
    assert!(
        told.contains("/bodies/0/shape/stl/file: part.stl is not closed: 3 of "),
        "{told}"
    );
}
