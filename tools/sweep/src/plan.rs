//! What is said in `sweep.json`.

use run::scene::Expected;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Kind and version.
pub(crate) const KIND: Expected = Expected {
    kind: "sweep",
    version: 1,
    migrations: &[],
};

/// A study over swept values.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Sweep {
    /// The study: a folder of `pipelines`. Points are written under `build/STUDY`.
    pub(crate) study: String,
    /// What the page says below its heading.
    #[serde(default)]
    pub(crate) title: Option<String>,
    /// What is swept. Every value of one meets every value of the others, but for those that go with another.
    #[schemars(length(min = 1))]
    pub(crate) parameters: Vec<Parameter>,
    /// Stages in their order.
    #[schemars(length(min = 1))]
    pub(crate) stages: Vec<Stage>,
    /// Figures of the table, and of the curves over what is swept.
    #[serde(default)]
    pub(crate) figures: Vec<Figure>,
    /// Stages that the page shows whole for each point, and not by a picture alone; now of arcs.
    #[serde(default)]
    pub(crate) whole: Vec<String>,
}

/// What is swept: values as they stand, or a range, even or logarithmic.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Parameter {
    /// Its name: small letters, digits and underscores. Templates call it `${name}`.
    pub(crate) name: String,
    /// Unit of its values, for people.
    #[serde(default = "one")]
    pub(crate) unit: String,
    /// The values: numbers, words, or any value with a name, `{"name": "thin", "value": ...}`.
    #[serde(default)]
    pub(crate) values: Option<Vec<Value>>,
    /// Even steps.
    #[serde(default)]
    pub(crate) even: Option<Range>,
    /// Steps of equal ratio.
    #[serde(default)]
    pub(crate) log: Option<Range>,
    /// The parameter that this one goes with: its first value with the first of that one, and so on.
    #[serde(default)]
    pub(crate) with: Option<String>,
}

fn one() -> String {
    "1".to_owned()
}

/// A range with both its ends.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Range {
    /// First value.
    pub(crate) from: f64,
    /// Last value.
    pub(crate) to: f64,
    /// Number of values.
    #[schemars(range(min = 2, max = 10000))]
    pub(crate) count: usize,
}

/// A stage.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Stage {
    /// Its name in this sweep, and that of its artefact: small letters, digits and hyphens.
    pub(crate) name: String,
    /// The program.
    pub(crate) tool: Tool,
    /// Its scene, from the repository root.
    pub(crate) scene: String,
    /// Patches that all points share.
    #[serde(default)]
    pub(crate) patches: Vec<String>,
    /// The patch that changes with the point.
    #[serde(default)]
    pub(crate) template: Option<Value>,
    /// Inputs by name.
    #[serde(default)]
    pub(crate) inputs: Vec<Input>,
}

/// The programs that run scenes.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Tool {
    /// Gas tables.
    Gasprop,
    /// Arcs.
    Arcfvm,
    /// Weld pools.
    Poolsph,
    /// Heat conduction.
    Heatsph,
    /// Fields.
    Emfield,
    /// Jets.
    Jetsph,
    /// Averages.
    Avg,
}

impl Tool {
    /// The name of the program.
    pub(crate) fn program(self) -> &'static str {
        match self {
            Self::Gasprop => "gasprop",
            Self::Arcfvm => "arcfvm",
            Self::Poolsph => "poolsph",
            Self::Heatsph => "heatsph",
            Self::Emfield => "emfield",
            Self::Jetsph => "jetsph",
            Self::Avg => "avg",
        }
    }
}

/// An input of a stage: the artefact of an earlier stage, or a file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Input {
    /// What the stage calls it.
    pub(crate) name: String,
    /// The stage that makes it.
    #[serde(default)]
    pub(crate) stage: Option<String>,
    /// The file, from the repository root.
    #[serde(default)]
    pub(crate) file: Option<String>,
}

/// A figure of each point.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Figure {
    /// What it is called.
    pub(crate) name: String,
    /// The unit in which it is shown.
    pub(crate) unit: String,
    /// What the value in the artefact is multiplied by to stand in that unit; 1 where it has that unit.
    #[serde(default)]
    pub(crate) factor: Option<f64>,
    /// The stage whose artefact holds it.
    pub(crate) stage: String,
    /// Where it stands in what the stage wrote.
    pub(crate) from: figures::From,
}

#[cfg(test)]
mod tests {
    use super::*;
    use run::scene::{schema_of, schema_text};

    #[test]
    fn the_schema_that_is_published_is_what_the_program_prints() {
        let stored =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../schemas/sweep.v1.json");
        let printed = schema_text(&schema_of::<Sweep>(KIND));
        assert_eq!(
            std::fs::read_to_string(stored).unwrap(),
            printed,
            "make schemas"
        );
    }
}
