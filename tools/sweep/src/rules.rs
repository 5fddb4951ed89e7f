//! Patches and rules of make: what a study's `rules.mk` would say of each point.

use std::path::PathBuf;

use run::Failure;

use crate::files::keep;
use crate::points::{Points, Run};

/// Where programs are, from the repository root.
pub(crate) const PROGRAMS: &str = "target/release";

impl Points {
    /// The makefile of the points.
    pub(crate) fn makefile(&self) -> PathBuf {
        self.out.join("rules.mk")
    }
}

/// Writes the patch of every run and the makefile; what is there already as it should be is not touched.
pub(crate) fn write(points: &Points) -> Result<(), Failure> {
    for run in &points.runs {
        if let Some((path, value)) = &run.patch {
            keep(path, &format!("{value:#}\n"))?;
        }
    }
    keep(&points.makefile(), &makefile(points))
}

/// The rules: each run through `pipelines/rerun`.
fn makefile(points: &Points) -> String {
    let mut text = format!(
        "# The points of {}, written by `sweep`: what is changed here does not last.\n\n\
         THREADS ?= 1\n\
         .PHONY: always sweep-points\n\n\
         # What a run says goes to a file; of one that fails the end is told, and the others go on (`make -k`).\n\
         SWEEP_LOGGED = > $(@:.mcap=.log) 2>&1 || {{ tail -n 5 $(@:.mcap=.log) >&2; \\\n  \
         mv $(@:.mcap=.log) $(@:.mcap=.failed); false; }}\n\n",
        points.file.display()
    );
    let outs = points.runs.iter().map(|r| r.out.display().to_string());
    let outs = outs.collect::<Vec<_>>().join(" \\\n  ");
    text += &format!("sweep-points: {outs}\n\n");
    for run in &points.runs {
        text += &rule(points, run);
    }
    text + &format!(".PRECIOUS: {outs}\n")
}

fn rule(points: &Points, run: &Run) -> String {
    let stage = &points.sweep.stages[run.stage];
    let program = format!("{PROGRAMS}/{}", stage.tool.program());
    let mut needs = vec![run.scene.clone()];
    let mut words = format!("{program} run {}", run.scene);
    let own = run.patch.iter().map(|(path, _)| path.display().to_string());
    for patch in run.patches.iter().cloned().chain(own) {
        words += &format!(" --patch {patch}");
        needs.push(patch);
    }
    for (name, path) in &run.inputs {
        words += &format!(" --input {name}={}", path.display());
        needs.push(path.display().to_string());
    }
    needs.push(program);
    format!(
        "{out}: {needs} always\n\t@echo \"{at}: {name}\"\n\
         \t@mkdir -p $(@D) && pipelines/rerun $@ $(filter-out always,$^) -- {words} \\\n\
         \t  --out $@ --threads $(THREADS) --progress plain $(SWEEP_LOGGED)\n\n",
        out = run.out.display(),
        needs = needs.join(" "),
        at = run.at,
        name = stage.name,
    )
}

/// Forgets how the last sweep ended, not what it made.
pub(crate) fn forget(points: &Points) {
    let ends = points.runs.iter().flat_map(|run| [run.log(), run.failed()]);
    for path in ends {
        // What is not there need not go.
        let _ = std::fs::remove_file(path);
    }
}

/// The words of make that make a file of the sweep and nothing else: what comes from elsewhere is there.
pub(crate) fn make_alone(points: &Points, threads: &str, target: &str) -> [String; 6] {
    let makefile = points.makefile().display().to_string();
    let threads = format!("THREADS={threads}");
    let words = [
        "make",
        "--no-print-directory",
        "-f",
        &makefile,
        &threads,
        target,
    ];
    words.map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_what_a_rule_of_a_study_would_say() {
        let text = makefile(&crate::points::tests::welds());
        let words = "\
build/welds/sweep/current-100-speed-0.02/pool.mcap: pipelines/pool.json \
build/welds/sweep/current-100-speed-0.02/pool.patch.json build/welds/sweep/current-100/arc.mcap \
build/welds/sweep/all/bed.mcap target/release/poolsph always\n";
        assert!(text.contains(words), "{text}");
        assert_eq!(text.matches("arcfvm run").count(), 2);
    }
}
