//! What is changed: scenes of studies and cases, and an artefact of each kind, made here by the programs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::Campaign;
use crate::grow::Schema;

/// Which scenes are changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breadth {
    /// Those that are checked in a moment.
    Quick,
    /// All of the repository.
    All,
}

/// Scenes that are checked in a moment.
const QUICK: [&str; 14] = [
    "pipelines/verify/gas-argon/scene.json",
    "pipelines/verify/arc-potential/scene.json",
    "pipelines/verify/arc-electrons/scene.json",
    "pipelines/verify/arc-evaporation/scene.json",
    "tests/resume/weld.json",
    "tests/resume/drop.json",
    "pipelines/verify/heat-sin-xy/scene.json",
    "pipelines/verify/heat-exp-t/scene.json",
    "pipelines/verify/heat-patch/scene.json",
    "pipelines/verify/em-bar/scene.json",
    "pipelines/verify/em-planar-az/scene.json",
    "pipelines/verify/solid-turn/scene.json",
    "pipelines/verify/solid-plate/scene.json",
    "pipelines/gmaw-300a/avg.json",
];

/// A scene and the tool that reads it.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub(crate) tool: String,
    pub(crate) value: Value,
}

/// An artefact of a kind, with its name among the inputs of stages.
#[derive(Debug, Clone)]
pub(crate) struct Artefact {
    pub(crate) name: &'static str,
    pub(crate) path: PathBuf,
    pub(crate) bytes: Vec<u8>,
}

/// All that is changed.
#[derive(Debug)]
pub(crate) struct Seeds {
    pub(crate) scenes: Vec<Scene>,
    pub(crate) schemas: BTreeMap<String, Schema>,
    pub(crate) artefacts: Vec<Artefact>,
}

/// Artefacts: name, tool, scene, patch, inputs by name.
type Recipe = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    &'static [(&'static str, &'static str)],
);

const RECIPES: [Recipe; 7] = [
    (
        "gas",
        "gasprop",
        "pipelines/gases/argon.json",
        r#"{"temperatures": {"chosen": {"count": 40}}}"#,
        &[],
    ),
    (
        "source",
        "arcfvm",
        "pipelines/verify/arc-surface/scene.json",
        r#"{"iterate": {"most": 30}}"#,
        &[("gas", "gas")],
    ),
    (
        "frames",
        "poolsph",
        "tests/resume/weld.json",
        r#"{"time": {"end_s": 0.006}, "output": {"particles_interval_s": 0.003, "balance_interval_s": 0.002,
            "pool": {"from_s": 0.001, "interval_s": 0.001}}}"#,
        &[("arc", "source")],
    ),
    (
        "mean",
        "avg",
        "pipelines/gmaw-300a/avg.json",
        r#"{"time": null, "phases": null, "landed": null, "sections": [{"name": "x0",
            "cut": {"plane": {"normal": "x", "half_thickness_m": 1e-3}}, "first_m": [-0.004, 0.004],
            "second_m": [-0.002, 0.002]}]}"#,
        &[("frames", "frames")],
    ),
    (
        "heat",
        "heatsph",
        "pipelines/verify/heat-sin-xy/scene.json",
        "{}",
        &[],
    ),
    (
        "field",
        "emfield",
        "pipelines/verify/em-bar/scene.json",
        r#"{"points": {"spacing_m": 0.002}}"#,
        &[],
    ),
    (
        "jet",
        "jetsph",
        "pipelines/verify/solid-turn/scene.json",
        r#"{"time": {"end_s": 0.01}, "output": {"frames_interval_s": 0.005}}"#,
        &[],
    ),
];

/// Versions of scenes that there may be.
const VERSIONS: u32 = 9;

/// The schema of the newest scenes of a tool.
fn newest(root: &Path, tool: &str) -> PathBuf {
    let of = |version: u32| root.join(format!("schemas/{tool}.scene.v{version}.json"));
    let newest = (1..=VERSIONS).rev().map(of).find(|path| path.exists());
    newest.unwrap_or_else(|| of(1))
}

impl Seeds {
    pub(crate) fn make(campaign: &Campaign) -> Result<Self, String> {
        let folder = campaign.out.join("seeds");
        std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        for recipe in RECIPES {
            cook(campaign, &folder, recipe)?;
        }
        let names = RECIPES.iter().map(|recipe| recipe.0);
        let artefacts = names.map(|name| {
            let path = folder.join(name).with_extension("mcap");
            let bytes = std::fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            Ok(Artefact { name, path, bytes })
        });
        let artefacts = artefacts.collect::<Result<Vec<_>, String>>()?;
        let scenes = scenes(campaign)?;
        let mut schemas = BTreeMap::new();
        for scene in &scenes {
            if !schemas.contains_key(&scene.tool) {
                let path = newest(&campaign.root, &scene.tool);
                let text = std::fs::read_to_string(&path)
                    .map_err(|e| format!("{}: {e}", path.display()))?;
                schemas.insert(scene.tool.clone(), Schema::parse(&text)?);
            }
        }
        Ok(Self {
            scenes,
            schemas,
            artefacts,
        })
    }

    /// The artefact of a name.
    pub(crate) fn path(&self, name: &str) -> Option<&Path> {
        let found = self.artefacts.iter().find(|a| a.name == name);
        found.map(|a| a.path.as_path())
    }
}

fn cook(campaign: &Campaign, folder: &Path, recipe: Recipe) -> Result<(), String> {
    let (name, tool, scene, patch, inputs) = recipe;
    let patched = folder.join(name).with_extension("patch.json");
    std::fs::write(&patched, patch).map_err(|e| format!("{}: {e}", patched.display()))?;
    let mut command = Command::new(campaign.programs.join(tool));
    command
        .arg("run")
        .arg(campaign.root.join(scene))
        .arg("--patch")
        .arg(patched);
    for (input, made) in inputs {
        let made = folder.join(made).with_extension("mcap");
        command
            .arg("--input")
            .arg(format!("{input}={}", made.display()));
    }
    command
        .arg("--out")
        .arg(folder.join(name).with_extension("mcap"));
    command.args(["--threads", "2", "--progress", "none", "-q"]);
    let output = command.output().map_err(|e| format!("{tool}: {e}"))?;
    match output.status.code() {
        Some(0 | 3) => Ok(()),
        code => {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            Err(format!(
                "the seed '{name}' of {tool} ended with {code:?}: {said}"
            ))
        }
    }
}

fn scenes(campaign: &Campaign) -> Result<Vec<Scene>, String> {
    let mut paths = Vec::new();
    match campaign.breadth {
        Breadth::Quick => paths.extend(QUICK.map(|path| campaign.root.join(path))),
        Breadth::All => {
            for folder in ["pipelines", "tests/resume"] {
                json_files(&campaign.root.join(folder), &mut paths)?;
            }
        }
    }
    paths.sort();
    let mut scenes = Vec::new();
    for path in paths {
        let text =
            std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let text = elsewhere(&text, path.parent().unwrap_or(&campaign.root));
        let value: Value =
            serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        let kind = value["kind"].as_str().unwrap_or_default();
        if let Some(tool) = kind.strip_suffix(".scene") {
            let tool = tool.to_owned();
            scenes.push(Scene { tool, value });
        }
    }
    // As many trials for each tool, however many scenes it has.
    scenes.sort_by(|a, b| a.tool.cmp(&b.tool));
    Ok(scenes)
}

/// The text of a scene of `folder` for a place elsewhere: what it names stays where it is.
pub(crate) fn elsewhere(text: &str, folder: &Path) -> String {
    let beside = format!("\"file\": \"{}/../", folder.display());
    text.replace("\"file\": \"../", &beside)
}

fn json_files(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.is_dir() {
            json_files(&path, found)?;
        } else if path.extension().is_some_and(|e| e == "json") {
            found.push(path);
        }
    }
    Ok(())
}
