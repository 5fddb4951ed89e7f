//! The error of a study against its run time.
//!
//! A study is run over the knobs that its numbers hang on: spacings, steps, tolerances, packings, one knob at a time, the
//! others at their base. Each headline figure gets, per knob, an order, an extrapolation and a band ([`band`]); runs that differ
//! by chance alone give a scatter apart from it. The least run that meets a tolerance is named with its patch.
//!
//! - [`plan`] is what `pipelines/STUDY/certify.json` says, [`runs`] makes its points (cheap ones first, within a budget, taken up
//!   again where they were left), [`figures`] reads numbers from what they wrote, [`verdict`] puts the record together;
//! - [`proof`] is the same over cases whose answers are exact: how often the true value lies in the band.

pub mod band;
pub mod figures;
pub mod plan;
mod point;
pub mod proof;
pub mod runs;
pub mod verdict;

use std::path::Path;
use std::time::Duration;

use crate::lab::{Lab, LabError, read_json};

pub use plan::Plan;
pub use verdict::{Certificate, Tolerance};

/// Certifies a study: every point that the budget allows is run, the figures are read, the bands are drawn.
///
/// # Errors
/// When the plan cannot be read, or the base point fails.
pub fn certify(
    lab: &Lab,
    plan: &Plan,
    budget: Duration,
    tolerance: Option<&Tolerance>,
) -> Result<Certificate, LabError> {
    let points = runs::run(lab, plan, budget)?;
    Ok(verdict::conclude(plan, &points, tolerance))
}

/// Reads the plan of a study.
///
/// # Errors
/// When it cannot be read or does not fit.
pub fn plan_of(root: &Path, study: &str) -> Result<Plan, LabError> {
    let path = root.join("pipelines").join(study).join("certify.json");
    let value = read_json(&path)?;
    let plan: Plan = serde_json::from_value(value).map_err(|e| LabError::Content {
        path: path.clone(),
        what: e.to_string(),
    })?;
    plan.check()
        .map_err(|what| LabError::Content { path, what })?;
    Ok(plan)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rules with the words that they define in the place of their names.
    fn spelt_out(rules: String) -> String {
        let words: Vec<(String, String)> = rules
            .lines()
            .filter_map(|line| line.split_once(" := "))
            .map(|(name, word)| (format!("$({name})"), word.to_owned()))
            .collect();
        let replace = |text: String, (name, word): &(String, String)| text.replace(name, word);
        words.iter().fold(rules, replace)
    }

    #[test]
    fn every_plan_fits_its_study() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let mut seen = 0;
        for entry in std::fs::read_dir(root.join("pipelines")).unwrap() {
            let folder = entry.unwrap().path();
            if !folder.join("certify.json").is_file() {
                continue;
            }
            let study = folder.file_name().unwrap().to_str().unwrap();
            let plan = plan_of(root, study).unwrap();
            assert_eq!(plan.study, study);
            for stage in &plan.stages {
                for file in stage.patches.iter().chain([&stage.scene]) {
                    assert!(root.join(file).is_file(), "{study}: {file}");
                }
                // What is taken as made must be what a rule makes.
                for made in stage
                    .made
                    .iter()
                    .chain(stage.inputs.iter().filter_map(|i| i.file.as_ref()))
                {
                    let owner = Path::new(made).parent().and_then(Path::file_name).unwrap();
                    let rules = root.join("pipelines").join(owner).join("rules.mk");
                    let rules = spelt_out(std::fs::read_to_string(rules).unwrap());
                    let pattern = format!("{}/%.mcap", Path::new(made).parent().unwrap().display());
                    assert!(
                        rules.contains(made.as_str()) || rules.contains(&pattern),
                        "{study}: {made}"
                    );
                }
            }
            seen += 1;
        }
        assert!(seen >= 7, "{seen} plans");
    }
}
