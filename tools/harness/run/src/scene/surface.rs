//! Surfaces of triangles from files: a shape names the file, and gets its corners and triangles before it is checked.

use std::io::Cursor;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::patch::Merged;
use super::{sheet, walk, wanted};
use crate::fault::Fault;

/// The key of a shape that a file gives.
const KEY: &str = "stl";
/// Units of a file's lengths \[m\].
const UNITS: [(&str, f64); 4] = [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0), ("inch", 0.0254)];
/// Most triangles of a surface.
const MOST: usize = 1_000_000;

/// Reads the files of all shapes of a scene that name one and have no triangles yet.
pub(super) fn fill(merged: &mut Merged, schema: &Value) -> Vec<Fault> {
    let mut places = Vec::new();
    walk::keys(merged.value(), &mut |path, key, value| {
        if key == KEY && value.get("file").is_some() && value.get("triangles").is_none() {
            places.push(path.to_owned());
        }
    });
    let mut faults = Vec::new();
    for at in places {
        let known = wanted::keys(&wanted::forms(schema, &at));
        if !known.iter().any(|(key, _)| *key == "triangles") {
            continue;
        }
        match read(merged, &at) {
            Ok(Some(values)) => {
                for (key, value) in values {
                    merged.add(&at, key, value);
                }
            }
            Ok(None) => {}
            Err(what) => faults.push(Fault::at(&format!("{at}/file"), what)),
        }
    }
    faults
}

/// What a shape gets of its file; nothing where the shape itself is wrong, which is told elsewhere.
fn read(merged: &Merged, at: &str) -> Result<Option<[(&'static str, Value); 3]>, String> {
    let said = |key: &str| merged.value().pointer(at)?.get(key)?.as_str();
    let unit = UNITS.iter().find(|(name, _)| said("unit") == Some(name));
    let (Some(file), Some((_, unit))) = (said("file"), unit) else {
        return Ok(None);
    };
    let path = merged.beside(&format!("{at}/file"), file);
    let bytes = std::fs::read(&path).map_err(|e| {
        let hint = if path.exists() {
            String::new()
        } else {
            sheet::hint(&path)
        };
        format!("{} cannot be read: {e}{hint}", path.display())
    })?;
    let mesh = stl_io::read_stl(&mut Cursor::new(&bytes))
        .map_err(|e| format!("{} is no STL file: {e}", path.display()))?;
    if mesh.faces.len() > MOST {
        return Err(format!(
            "{} has {} triangles, at most {MOST}",
            path.display(),
            mesh.faces.len()
        ));
    }
    let vertices: Vec<[f64; 3]> = mesh
        .vertices
        .iter()
        .map(|v| v.0.map(|x| f64::from(x) * unit))
        .collect();
    if vertices.iter().flatten().any(|x| !x.is_finite()) {
        return Err(format!("{} has corners without a place", path.display()));
    }
    // Triangles without area, which some programs write, belong to no surface.
    let triangles: Vec<[usize; 3]> = mesh
        .faces
        .iter()
        .map(|face| face.vertices)
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    let hash = format!("{:x}", Sha256::digest(&bytes));
    Ok(Some([
        ("sha256", json!(hash)),
        ("vertices_m", json!(vertices)),
        ("triangles", json!(triangles)),
    ]))
}
