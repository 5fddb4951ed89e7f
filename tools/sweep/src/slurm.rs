//! Points made by Slurm: an array of jobs for each stage, each job after the jobs that make its inputs.
//!
//! Partition, account and time limit are told to `sbatch` as it reads them itself: `SBATCH_PARTITION`, `SBATCH_ACCOUNT`,
//! `SBATCH_TIMELIMIT` and others.

use std::path::PathBuf;
use std::process::Command;

use run::Failure;

use crate::files::keep;
use crate::here::cannot;
use crate::points::Points;
use crate::rules::{PROGRAMS, make_alone};

/// An array of jobs: runs of one stage.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Array {
    /// Number of the stage.
    stage: usize,
    /// Numbers of its runs; the place in here is the number of the task.
    runs: Vec<usize>,
    /// For each input of a run in their order: the array whose task makes it, and how it is awaited.
    after: Vec<(usize, Await)>,
}

/// Which tasks of an array are awaited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Await {
    /// That of the same number.
    Same,
    /// One for all.
    One(usize),
}

/// The arrays in the order in which they are submitted. Runs of a stage are one array where all await the same tasks, or each
/// the task of its own number; otherwise one for each set of awaited tasks.
fn arrays(points: &Points) -> Vec<Array> {
    let mut all: Vec<Array> = Vec::new();
    for stage in 0..points.sweep.stages.len() {
        let runs = 0..points.runs.len();
        let own: Vec<usize> = runs.filter(|r| points.runs[*r].stage == stage).collect();
        if let Some(after) = awaited(points, &all, &own) {
            all.push(Array {
                stage,
                runs: own,
                after,
            });
            continue;
        }
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for run in own {
            let alike = |g: &&mut Vec<usize>| points.runs[g[0]].after == points.runs[run].after;
            match groups.iter_mut().find(alike) {
                Some(group) => group.push(run),
                None => groups.push(vec![run]),
            }
        }
        for runs in groups {
            let after = awaited(points, &all, &runs).unwrap_or_default();
            all.push(Array { stage, runs, after });
        }
    }
    all
}

/// What an array of these runs awaits; `None` if they are no one array.
fn awaited(points: &Points, arrays: &[Array], runs: &[usize]) -> Option<Vec<(usize, Await)>> {
    let place = |run: usize| {
        let found = arrays.iter().enumerate();
        let mut found =
            found.filter_map(|(a, array)| Some((a, array.runs.iter().position(|r| *r == run)?)));
        found.next()
    };
    let first = &points.runs[*runs.first()?].after;
    let mut all = Vec::new();
    for input in 0..first.len() {
        let makers = runs.iter().map(|r| place(points.runs[*r].after[input]));
        let makers: Vec<(usize, usize)> = makers.collect::<Option<_>>()?;
        let (array, task) = makers[0];
        if makers.iter().all(|maker| *maker == (array, task)) {
            all.push((array, Await::One(task)));
        } else if makers
            .iter()
            .enumerate()
            .all(|(i, maker)| *maker == (array, i))
        {
            all.push((array, Await::Same));
        } else {
            return None;
        }
    }
    Some(all)
}

/// Submits all jobs; with `wait`, ends when the last one has, which tells how the sweep ended.
///
/// # Errors
/// When `sbatch` is not there, or refuses a job.
pub(crate) fn submit(points: &Points, threads: usize, wait: bool) -> Result<(), Failure> {
    let folder = points.out.join("slurm");
    let elsewhere: Vec<String> = points
        .made_elsewhere()
        .iter()
        .map(|p| p.display().to_string())
        .collect();
    let mut ids: Vec<String> = Vec::new();
    let mut inputs = None;
    if !elsewhere.is_empty() {
        let words = format!(
            "exec make --no-print-directory THREADS={threads} {}\n",
            elsewhere.join(" ")
        );
        let script = script(points, "inputs", &words)?;
        let id = sbatch(&job(points, "inputs", threads, &[]), &script, false)?;
        tell(&format!("job {id}: {}", elsewhere.join(" ")));
        inputs = Some(id);
    }
    for (number, array) in arrays(points).iter().enumerate() {
        let name = format!("{}-{number}", points.sweep.stages[array.stage].name);
        let outs = array
            .runs
            .iter()
            .map(|r| points.runs[*r].out.display().to_string());
        let outs: Vec<String> = outs.collect();
        let list = folder.join(format!("{name}.files"));
        keep(&list, &format!("{}\n", outs.join("\n")))?;
        let make = make_alone(points, "${SLURM_CPUS_PER_TASK:-1}", "\"$out\"").join(" ");
        let words = format!(
            "out=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\nexec {make}\n",
            list.display()
        );
        let script = script(points, &name, &words)?;
        let mut after: Vec<String> = inputs.iter().map(|id| format!("afterok:{id}")).collect();
        after.extend(array.after.iter().map(|(other, which)| match which {
            Await::Same => format!("aftercorr:{}", ids[*other]),
            Await::One(task) => format!("afterok:{}_{task}", ids[*other]),
        }));
        let last = array.runs.len().saturating_sub(1);
        let mut options = job(points, &name, threads, &after);
        options.push(format!("--array=0-{last}"));
        let id = sbatch(&options, &script, false)?;
        tell(&format!(
            "jobs {id}_0 to {id}_{last}: {}",
            points.sweep.stages[array.stage].name
        ));
        ids.push(id);
    }
    let words = format!("exec {PROGRAMS}/sweep page {}\n", points.file.display());
    let script = script(points, "page", &words)?;
    let mut options = job(points, "page", 1, &[]);
    options.push(format!("--dependency=afterany:{}", ids.join(":")));
    let id = sbatch(&options, &script, wait)?;
    if !wait {
        tell(&format!("job {id}: the page, when all have ended"));
    }
    Ok(())
}

/// Options of a job. What can never begin, as what it awaits has failed, is taken off the queue.
fn job(points: &Points, name: &str, threads: usize, after: &[String]) -> Vec<String> {
    let log = points.out.join("slurm").join(format!("{name}-%j.log"));
    let mut all = vec![
        format!("--job-name={}-{name}", points.sweep.study),
        format!("--cpus-per-task={threads}"),
        format!("--output={}", log.display()),
    ];
    if !after.is_empty() {
        all.push(format!("--dependency={}", after.join(",")));
        all.push("--kill-on-invalid-dep=yes".to_owned());
    }
    all
}

fn script(points: &Points, name: &str, words: &str) -> Result<PathBuf, Failure> {
    let path = points.out.join("slurm").join(format!("{name}.sh"));
    // The words of the make that submits are not those of the makes in jobs.
    keep(
        &path,
        &format!("#!/bin/sh\nunset MAKEFLAGS MFLAGS MAKELEVEL\n{words}"),
    )?;
    Ok(path)
}

/// Submits a script; the number of its job. With `wait` it ends when the job has.
fn sbatch(options: &[String], script: &std::path::Path, wait: bool) -> Result<String, Failure> {
    let mut command = Command::new("sbatch");
    command.arg("--parsable").args(options);
    if wait {
        command.arg("--wait");
    }
    command.arg(script);
    let output = command
        .output()
        .map_err(|source| cannot(&command, source))?;
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    // Jobs of clusters are NUMBER;CLUSTER.
    let id = said.trim().split(';').next().unwrap_or_default().to_owned();
    // A job that was awaited and failed ends with its own code, and its number was told.
    if id.is_empty() || !(wait || output.status.success()) {
        let why = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(Failure::Other(format!(
            "sbatch refused {}: {why}",
            script.display()
        )));
    }
    Ok(id)
}

#[allow(clippy::print_stderr, reason = "a program talks to its user")]
fn tell(words: &str) {
    eprintln!("slurm: {words}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_task_awaits_what_makes_its_inputs() {
        let welds = crate::points::tests::welds();
        let found = arrays(&welds);
        assert_eq!(found.len(), 4, "{found:?}");
        assert_eq!(found[0].runs, [0, 1]);
        assert_eq!(found[2].runs, [3, 4], "pools of the first arc");
        assert_eq!(found[2].after, [(0, Await::One(0)), (1, Await::One(0))]);
        assert_eq!(found[3].after, [(0, Await::One(1)), (1, Await::One(0))]);
    }

    #[test]
    fn a_chain_is_an_array_for_each_stage() {
        let mut welds = crate::points::tests::welds();
        // One pool for each arc.
        welds.runs.remove(6);
        welds.runs.remove(4);
        let found = arrays(&welds);
        assert_eq!(found.len(), 3);
        assert_eq!(found[2].after, [(0, Await::Same), (1, Await::One(0))]);
    }
}
