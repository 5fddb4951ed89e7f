//! What a study says of itself in `certify.json`.

use serde::Deserialize;
use serde_json::Value;

/// The plan of a study.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// `certify`.
    pub kind: String,
    /// `1.0`.
    pub version: String,
    /// Name of the study.
    pub study: String,
    /// Stages in their order.
    pub stages: Vec<Stage>,
    /// Headline figures.
    pub figures: Vec<Figure>,
    /// What the figures hang on.
    pub knobs: Vec<Knob>,
}

impl Plan {
    /// Whether a change of a stage reaches another: that stage itself, or one that reads from it.
    #[must_use]
    pub fn reaches(&self, turned: &str, stage: &str) -> bool {
        let Some(stage) = self.stages.iter().find(|s| s.name == stage) else {
            return false;
        };
        let earlier = |input: &Input| {
            input
                .stage
                .as_ref()
                .is_some_and(|of| self.reaches(turned, of))
        };
        stage.name == turned || stage.inputs.iter().any(earlier)
    }
}

/// A stage of a study.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Its name in this plan, and that of its artefact.
    pub name: String,
    /// The program.
    pub tool: String,
    /// Its scene, from the repository root.
    pub scene: String,
    /// Patches of the study.
    #[serde(default)]
    pub patches: Vec<String>,
    /// Inputs by name.
    #[serde(default)]
    pub inputs: Vec<Input>,
    /// What the study makes of it, from the repository root: the base is not run a second time.
    #[serde(default)]
    pub made: Option<String>,
}

/// An input of a stage.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// What the stage calls it.
    pub name: String,
    /// The stage of this plan that makes it.
    #[serde(default)]
    pub stage: Option<String>,
    /// Or a file, from the repository root.
    #[serde(default)]
    pub file: Option<String>,
}

/// A headline figure.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The stage whose artefact holds it.
    pub stage: String,
    /// Where in what the stage wrote.
    pub from: figures::From,
}

/// What the figures hang on.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Knob {
    /// Its name.
    pub name: String,
    /// The stage that it turns.
    pub stage: String,
    /// Refined, with a size each; or varied, where runs differ by chance alone.
    pub series: Series,
}

/// A series of a knob.
#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Series {
    /// Sizes that tend to zero.
    Refined {
        /// The order that the method promises.
        order: f64,
        /// Unit of the sizes.
        unit: String,
        /// The size that the study has.
        base: f64,
        /// The others, each with its patch.
        points: Vec<Size>,
    },
    /// Packings, places of the start, seeds: patches alone.
    Varied {
        /// Patches, beside the study as it is.
        patches: Vec<Value>,
    },
}

/// One size of a knob.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Size {
    /// The size.
    pub size: f64,
    /// What makes it.
    pub patch: Value,
}

impl Plan {
    /// What does not fit in the plan.
    ///
    /// # Errors
    /// With the first fault.
    pub fn check(&self) -> Result<(), String> {
        if self.kind != "certify" || self.version != "1.0" {
            return Err(format!(
                "it must be of kind certify, version 1.0, not {} {}",
                self.kind, self.version
            ));
        }
        let known = |stage: &str| self.stages.iter().any(|s| s.name == stage);
        let strangers = (self.figures.iter().map(|f| (&f.name, &f.stage)))
            .chain(self.knobs.iter().map(|k| (&k.name, &k.stage)))
            .find(|(_, stage)| !known(stage));
        if let Some((name, stage)) = strangers {
            return Err(format!(
                "'{name}' names the stage '{stage}', which is not there"
            ));
        }
        for (index, stage) in self.stages.iter().enumerate() {
            for input in &stage.inputs {
                let earlier = |of: &str| self.stages[..index].iter().any(|s| s.name == of);
                let good = match (&input.stage, &input.file) {
                    (Some(of), None) => earlier(of),
                    (None, Some(_)) => true,
                    _ => false,
                };
                if !good {
                    return Err(format!(
                        "input '{}' of stage '{}' must name an earlier stage or a file",
                        input.name, stage.name
                    ));
                }
            }
        }
        for knob in &self.knobs {
            if let Series::Refined {
                order,
                base,
                points,
                ..
            } = &knob.series
            {
                let sizes = points.iter().map(|p| p.size).chain([*base, *order]);
                if sizes.into_iter().any(|h| !(h.is_finite() && h > 0.0)) {
                    return Err(format!(
                        "sizes and order of '{}' must be above 0",
                        knob.name
                    ));
                }
            }
        }
        Ok(())
    }
}
