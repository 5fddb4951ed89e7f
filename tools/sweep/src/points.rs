//! The points of a sweep, and what each is made of.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use run::Fault;
use serde_json::Value;

use crate::plan::{Stage, Sweep};
use crate::template::{self, named_by};
use crate::values::{self, Named};

/// A point: one value of each parameter.
#[derive(Debug, Clone)]
pub(crate) struct Point {
    /// `current-300`, or `current-300-speed-0.01`.
    pub(crate) name: String,
    /// Its values in the order of the parameters.
    pub(crate) values: Vec<Named>,
    /// Number of its run of each stage.
    pub(crate) runs: Vec<usize>,
}

/// A stage at the values that it hangs on. Points that share them share the run.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    /// Number of its stage.
    pub(crate) stage: usize,
    /// As a point, by the values that it hangs on; `all` where it hangs on none.
    pub(crate) at: String,
    /// Its artefact.
    pub(crate) out: PathBuf,
    /// The patch of its template, and what it says.
    pub(crate) patch: Option<(PathBuf, Value)>,
    /// Scene and patches that are there.
    pub(crate) scene: String,
    pub(crate) patches: Vec<String>,
    /// Inputs by name.
    pub(crate) inputs: Vec<(String, PathBuf)>,
    /// Numbers of the runs that make its inputs.
    pub(crate) after: Vec<usize>,
}

impl Run {
    /// What it says while it runs.
    pub(crate) fn log(&self) -> PathBuf {
        self.out.with_extension("log")
    }

    /// What it said, where it failed.
    pub(crate) fn failed(&self) -> PathBuf {
        self.out.with_extension("failed")
    }
}

/// A sweep with all its points.
#[derive(Debug, Clone)]
pub(crate) struct Points {
    /// What was said.
    pub(crate) sweep: Sweep,
    /// The file that said it, from the repository root.
    pub(crate) file: PathBuf,
    /// `build/STUDY/NAME`, NAME as the file is called: its folder, and its page with an ending.
    pub(crate) out: PathBuf,
    pub(crate) points: Vec<Point>,
    /// In the order of their stages.
    pub(crate) runs: Vec<Run>,
}

impl Points {
    /// The points of a sweep, which was found to be sound.
    pub(crate) fn of(sweep: Sweep, file: &Path) -> Self {
        let name = file.file_stem().unwrap_or_default();
        let out = Path::new("build").join(&sweep.study).join(name);
        let all: Vec<Vec<Named>> = sweep
            .parameters
            .iter()
            .map(|p| values::of(p).unwrap_or_default())
            .collect();
        let place = |name: &str| sweep.parameters.iter().position(|p| p.name == name);
        let counts: Vec<usize> = all.iter().map(Vec::len).collect();
        let with = sweep.parameters.iter().map(|p| place(p.with.as_deref()?));
        let mut found = Self {
            points: Vec::new(),
            runs: Vec::new(),
            file: file.to_owned(),
            out,
            sweep: sweep.clone(),
        };
        let chosen = values::points(&counts, &with.collect::<Vec<_>>());
        for stage in 0..sweep.stages.len() {
            let reached = reached(&sweep, stage);
            for (number, choice) in chosen.iter().enumerate() {
                if stage == 0 {
                    found.points.push(found.point(choice, &all));
                }
                let run = found.run(stage, &reached, number);
                let known = found.runs.iter().position(|r| r.out == run.out);
                let index = known.unwrap_or(found.runs.len());
                if known.is_none() {
                    found.runs.push(run);
                }
                found.points[number].runs.push(index);
            }
        }
        found
    }

    /// Points of different values that would share a run, as the names of their folders meet.
    pub(crate) fn confused(&self) -> Option<Fault> {
        let reached: Vec<Vec<usize>> = (0..self.sweep.stages.len())
            .map(|stage| reached(&self.sweep, stage))
            .collect();
        let mut first: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
        for (point, run, some) in self.points.iter().flat_map(|p| {
            p.runs
                .iter()
                .zip(&reached)
                .map(move |(run, some)| (p, run, some))
        }) {
            let names: Vec<&str> = some
                .iter()
                .map(|i| point.values[*i].name.as_str())
                .collect();
            let known = first.entry(*run).or_insert_with(|| names.clone());
            if *known != names {
                let what = format!(
                    "the values {} and {} would share the folder '{}', and one would get the results of the other: \
                     give one of them another name, {{\"name\": \"...\", \"value\": ...}}",
                    known.join(", "),
                    names.join(", "),
                    self.runs[*run].at
                );
                return Some(Fault::at("/parameters", what));
            }
        }
        None
    }

    fn point(&self, choice: &[usize], all: &[Vec<Named>]) -> Point {
        let values: Vec<Named> = choice.iter().zip(all).map(|(i, v)| v[*i].clone()).collect();
        let every: Vec<usize> = (0..values.len()).collect();
        Point {
            name: self.name(&values, &every),
            values,
            runs: Vec::new(),
        }
    }

    /// `current-300-speed-0.01` of some of the parameters.
    fn name(&self, values: &[Named], some: &[usize]) -> String {
        let part = |i: &usize| format!("{}-{}", self.sweep.parameters[*i].name, values[*i].name);
        match some {
            [] => "all".to_owned(),
            some => some.iter().map(part).collect::<Vec<_>>().join("-"),
        }
    }

    /// The run of a stage at a point, whose runs of earlier stages are known.
    fn run(&self, stage: usize, reached: &[usize], point: usize) -> Run {
        let Stage {
            name,
            scene,
            patches,
            template,
            inputs,
            ..
        } = &self.sweep.stages[stage];
        let point = &self.points[point];
        let at = self.name(&point.values, reached);
        let folder = self.out.join(&at);
        let value = |call: &str| {
            let place = self.sweep.parameters.iter().position(|p| p.name == call);
            let named = place.and_then(|i| point.values.get(i));
            named.map_or((String::new(), Value::Null), |n| {
                (n.name.clone(), n.value.clone())
            })
        };
        let text = |words: &String| template::text(words, |call| value(call).0);
        let earlier = |of: &str| {
            let stage = self.sweep.stages.iter().position(|s| s.name == of)?;
            point.runs.get(stage).copied()
        };
        let made = inputs.iter().filter_map(|i| earlier(i.stage.as_deref()?));
        let file = |input: &crate::plan::Input| match input.stage.as_deref().and_then(earlier) {
            Some(run) => self.runs[run].out.clone(),
            None => PathBuf::from(text(&input.file.clone().unwrap_or_default())),
        };
        let patch = |t: &Value| {
            (
                folder.join(format!("{name}.patch.json")),
                template::filled(t, &value),
            )
        };
        Run {
            stage,
            out: folder.join(format!("{name}.mcap")),
            patch: template.as_ref().map(patch),
            scene: text(scene),
            patches: patches.iter().map(text).collect(),
            inputs: inputs.iter().map(|i| (i.name.clone(), file(i))).collect(),
            after: made.collect(),
            at,
        }
    }

    /// Files that the sweep reads and make makes elsewhere, each once.
    pub(crate) fn made_elsewhere(&self) -> Vec<&Path> {
        let mut all: Vec<&Path> = Vec::new();
        for (_, path) in self.runs.iter().flat_map(|run| &run.inputs) {
            let own = self.runs.iter().any(|run| run.out == *path);
            if !own && path.starts_with("build") && !all.contains(&path.as_path()) {
                all.push(path);
            }
        }
        all
    }
}

/// Parameters that a stage hangs on: what it names, and what the stages name that it reads from.
fn reached(sweep: &Sweep, stage: usize) -> Vec<usize> {
    let named = named_by(&sweep.stages[stage]);
    let inputs = sweep.stages[stage].inputs.iter();
    let before = inputs.filter_map(|i| {
        let of = i.stage.as_ref()?;
        sweep.stages.iter().position(|s| s.name == *of)
    });
    let before: Vec<usize> = before.flat_map(|s| reached(sweep, s)).collect();
    let all = sweep.parameters.iter().enumerate();
    all.filter(|(i, p)| named.contains(&p.name.as_str()) || before.contains(i))
        .map(|(i, _)| i)
        .collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use serde_json::json;

    /// An arc at two currents, and pools at two speeds under each.
    pub(crate) fn welds() -> Points {
        let sweep = json!({
            "study": "welds",
            "parameters": [{"name": "current", "values": [100, 200]}, {"name": "speed", "values": [0.01, 0.02]}],
            "stages": [
                {"name": "arc", "tool": "arcfvm", "scene": "pipelines/arc.json", "template": {"current_a": "${current}"},
                 "inputs": [{"name": "gas", "file": "build/gases/argon.mcap"}]},
                {"name": "bed", "tool": "poolsph", "scene": "pipelines/bed.json"},
                {"name": "pool", "tool": "poolsph", "scene": "pipelines/pool.json", "template": {"speed_m_s": "${speed}"},
                 "inputs": [{"name": "arc", "stage": "arc"}, {"name": "bed", "stage": "bed"}]}
            ]
        });
        Points::of(
            serde_json::from_value(sweep).unwrap(),
            Path::new("pipelines/welds/sweep.json"),
        )
    }

    #[test]
    fn points_whose_folders_would_meet_are_found() {
        let of = |a: &[&str], b: &[&str]| {
            let sweep = json!({
                "study": "welds",
                "parameters": [{"name": "a", "values": a}, {"name": "b", "values": b}],
                "stages": [{"name": "arc", "tool": "arcfvm", "scene": "pipelines/arc.json", "template": {"title": "${a} ${b}"}}]
            });
            Points::of(
                serde_json::from_value(sweep).unwrap(),
                Path::new("sweep.json"),
            )
            .confused()
        };
        assert!(of(&["x", "y"], &["1", "2"]).is_none());
        let told = of(&["x-b-1", "x"], &["2", "1-b-2"]).unwrap().to_string();
        assert!(
            told.contains("a-x-b-1-b-2") && told.contains("another name"),
            "{told}"
        );
        assert!(welds().confused().is_none());
    }

    #[test]
    fn points_share_what_does_not_hang_on_what_they_differ_by() {
        let welds = welds();
        let outs: Vec<&str> = welds.runs.iter().map(|r| r.out.to_str().unwrap()).collect();
        assert_eq!(
            outs,
            [
                "build/welds/sweep/current-100/arc.mcap",
                "build/welds/sweep/current-200/arc.mcap",
                "build/welds/sweep/all/bed.mcap",
                "build/welds/sweep/current-100-speed-0.01/pool.mcap",
                "build/welds/sweep/current-100-speed-0.02/pool.mcap",
                "build/welds/sweep/current-200-speed-0.01/pool.mcap",
                "build/welds/sweep/current-200-speed-0.02/pool.mcap",
            ]
        );
        assert_eq!(welds.points[2].runs, [1, 2, 5]);
        assert_eq!(welds.runs[5].after, [1, 2]);
        assert_eq!(
            welds.runs[5].patch.as_ref().unwrap().1,
            json!({"speed_m_s": 0.01})
        );
        assert_eq!(
            welds.made_elsewhere(),
            [Path::new("build/gases/argon.mcap")]
        );
    }
}
