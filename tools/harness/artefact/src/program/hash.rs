//! `artefact verify-hash`: does a file come from this scene and these inputs?

use std::path::{Path, PathBuf};

use artefact::{WRITTEN, canonical, json_error, sha256, sha256_file};
use serde_json::{Map, Value};

use super::open::open;
use super::trouble::{Trouble, Verdict, file_error};
use super::{Source, Streams};

/// Arguments of `verify-hash`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:
  target/release/artefact verify-hash build/gmaw-quick/pool.mcap --scene pipelines/gmaw-300a/pool.json \\
    --patch pipelines/gmaw-quick/pool.patch.json --input arc=build/gmaw-300a/arc.mcap
The hash of a scene is the SHA-256 of its canonical JSON (patches applied, keys sorted, no white
space): spaces and the order of keys change nothing. The hash of an input is that of its bytes.
Without --scene and --input it prints the hashes in the file, whose scene is compared with its own.")]
pub(crate) struct Arguments {
    #[command(flatten)]
    source: Source,
    /// The scene that the file should come from.
    #[arg(long, value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Merge patches (RFC 7386) on the scene, in order.
    #[arg(long, value_name = "PATCH", requires = "scene")]
    patch: Vec<PathBuf>,
    /// An input that the file should come from.
    #[arg(long, value_name = "NAME=FILE", value_parser = name_and_file)]
    input: Vec<(String, PathBuf)>,
}

fn name_and_file(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((name, file)) if !name.is_empty() && !file.is_empty() => {
            Ok((name.to_owned(), file.into()))
        }
        _ => Err("wanted is NAME=FILE, for example arc=build/gmaw-300a/arc.mcap".to_owned()),
    }
}

pub(crate) fn run(arguments: &Arguments, streams: &mut Streams<'_>) -> Result<Verdict, Trouble> {
    let reader = open(&arguments.source.file, streams)?;
    let header = reader.header();
    let mut good = true;
    let mut compare = |what: &str, recorded: &str, found: Option<(String, &Path)>| {
        let line = match found {
            None => format!("{what:<16} {recorded}  not compared"),
            Some((hash, path)) if hash == recorded => {
                format!("{what:<16} {recorded}  is {}", path.display())
            }
            Some((hash, path)) => {
                good = false;
                format!(
                    "{what:<16} {recorded}  differs: {} has {hash}",
                    path.display()
                )
            }
        };
        writeln!(streams.out, "{line}")
    };
    let scene = match &arguments.scene {
        Some(path) => Some((scene_hash(path, &arguments.patch)?, path.as_path())),
        None => None,
    };
    // A scene that names files is known by what was written; the files that it names are compared beside it.
    let own = header.scene_sha256();
    let recorded = header.scene.get(WRITTEN).and_then(Value::as_str);
    compare("scene", recorded.unwrap_or(&own), scene)?;
    for (name, file, recorded) in named(&header.scene) {
        let beside = arguments.scene.iter().chain(&arguments.patch);
        let path = beside
            .map(|scene| scene.parent().unwrap_or(Path::new("")).join(&file))
            .chain([PathBuf::from(&file)])
            .find(|path| path.is_file());
        let found = match (&arguments.scene, &path) {
            (Some(_), Some(path)) => Some((sha256_file(path)?, path.as_path())),
            _ => None,
        };
        compare(&name, &recorded, found)?;
    }
    for (name, recorded) in &header.inputs {
        let given = arguments.input.iter().find(|(n, _)| n == name);
        let found = match given {
            Some((_, path)) => Some((sha256_file(path)?, path.as_path())),
            None => None,
        };
        compare(&format!("input {name}"), recorded, found)?;
    }
    for (name, path) in &arguments.input {
        if !header.inputs.contains_key(name) {
            good = false;
            let what = format!("input {name}");
            writeln!(
                streams.out,
                "{what:<16} {}: the file was made without an input of this name",
                path.display()
            )?;
        }
    }
    Ok(Verdict::from_good(good))
}

/// The files that a recorded scene was read from: what each is, its name beside the scene, its hash.
fn named(scene: &Value) -> Vec<(String, String, String)> {
    let mut found = Vec::new();
    match scene {
        Value::Object(map) => {
            let word = |key: &str| map.get(key)?.as_str().map(str::to_owned);
            let file = word("from").or_else(|| word("file"));
            if let (Some(file), Some(hash)) = (file, word("sha256")) {
                let name = Path::new(&file).file_name().unwrap_or_default();
                found.push((name.to_string_lossy().into_owned(), file, hash));
            }
            found.extend(map.values().flat_map(named));
        }
        Value::Array(list) => found.extend(list.iter().flat_map(named)),
        _ => {}
    }
    found
}

fn scene_hash(path: &Path, patches: &[PathBuf]) -> Result<String, Trouble> {
    let mut scene = read(path)?;
    for patch in patches {
        merge(&mut scene, &read(patch)?);
    }
    Ok(sha256(canonical(&scene).as_bytes()))
}

fn read(path: &Path) -> Result<Value, Trouble> {
    let text = std::fs::read_to_string(path).map_err(file_error(path, "read"))?;
    serde_json::from_str(&text).map_err(|e| json_error(path, &e).into())
}

/// JSON Merge Patch (RFC 7386): objects merge, `null` removes, all else replaces.
fn merge(target: &mut Value, patch: &Value) {
    let Value::Object(patch) = patch else {
        *target = patch.clone();
        return;
    };
    if !target.is_object() {
        *target = Value::Object(Map::new());
    }
    let Value::Object(target) = target else {
        return;
    };
    for (key, value) in patch {
        if value.is_null() {
            target.remove(key);
        } else {
            merge(target.entry(key.clone()).or_insert(Value::Null), value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn merge_does_the_examples_of_the_rfc() {
        let cases = [
            (json!({"a": "b"}), json!({"a": "c"}), json!({"a": "c"})),
            (
                json!({"a": "b", "b": "c"}),
                json!({"a": null}),
                json!({"b": "c"}),
            ),
            (json!({"a": ["b"]}), json!({"a": "c"}), json!({"a": "c"})),
            (
                json!({"a": {"b": "c"}}),
                json!({"a": {"b": "d", "c": null}}),
                json!({"a": {"b": "d"}}),
            ),
            (json!(["a", "b"]), json!(["c", "d"]), json!(["c", "d"])),
            (
                json!({"e": null}),
                json!({"a": 1}),
                json!({"e": null, "a": 1}),
            ),
            (
                json!({}),
                json!({"a": {"bb": {"ccc": null}}}),
                json!({"a": {"bb": {}}}),
            ),
        ];
        for (mut target, patch, expected) in cases {
            merge(&mut target, &patch);
            assert_eq!(target, expected);
        }
    }
}
