//! Kills at random moments: what goes on, or begins again, ends with the bytes of a run that nothing disturbed.

use std::process::Stdio;
use std::time::{Duration, Instant};

use super::Row;
use super::stages::Job;
use crate::chance::Chance;

/// Kills of one run before it may end.
const IN_A_ROW: usize = 3;

/// A job that keeps checkpoints is killed this many times as often before it is said that none was taken up.
const PATIENCE: usize = 10;

/// Kills a job so many times, and until one of its checkpoints was taken up.
pub(super) fn row(job: &Job, times: usize, chance: &mut Chance) -> Result<Row, String> {
    let read = |name: &str| std::fs::read(job.path(name)).map_err(|e| format!("{name}: {e}"));
    let straight = read("straight.mcap")?;
    let began = Instant::now();
    job.clear("killed.mcap")?;
    finish(job, false)?;
    let long = began.elapsed();
    let (mut killed, mut resumed, mut wrong) = (0, 0, None);
    let is_due = |killed: usize, resumed: usize| {
        killed < times || (job.keeps() && resumed == 0 && killed < PATIENCE * times)
    };
    while is_due(killed, resumed) && wrong.is_none() {
        job.clear("killed.mcap")?;
        let mut goes_on = false;
        for _ in 0..=chance.below(IN_A_ROW) {
            if kill(job, goes_on, long.mul_f64(chance.share()))? {
                killed += 1;
            }
            goes_on = job.path("killed.mcap.checkpoint").exists();
            resumed += usize::from(goes_on);
            if job.path("killed.mcap").exists() {
                break;
            }
        }
        if !job.path("killed.mcap").exists() {
            finish(job, goes_on)?;
        }
        if read("killed.mcap")? != straight {
            wrong = Some(format!("kill {killed} led to other bytes"));
        }
    }
    let holds = wrong.is_none() && was_tried(job.keeps(), killed, resumed);
    Ok(Row {
        fault: "killed at a random moment".to_owned(),
        who: job.name.to_owned(),
        times: killed,
        expected: "the same bytes in the end".to_owned(),
        found: wrong
            .unwrap_or_else(|| format!("the same bytes, {resumed} times from a checkpoint")),
        holds: Some(holds),
    })
}

/// Whether kills say anything: some hit, and some were followed by a run from a checkpoint where the job keeps any.
fn was_tried(keeps: bool, killed: usize, resumed: usize) -> bool {
    killed > 0 && (resumed > 0 || !keeps)
}

/// Starts a job and kills it after some time; whether it was still there to be killed.
fn kill(job: &Job, goes_on: bool, after: Duration) -> Result<bool, String> {
    let told = |e: std::io::Error| format!("{}: {e}", job.name);
    let mut command = job.command("killed.mcap");
    if goes_on {
        command.arg("--resume");
    }
    let mut child = command.stderr(Stdio::null()).spawn().map_err(told)?;
    std::thread::sleep(after);
    let alive = child.try_wait().map_err(told)?.is_none();
    if alive {
        child.kill().map_err(told)?;
    }
    child.wait().map_err(told)?;
    Ok(alive)
}

/// Runs a job to its end.
fn finish(job: &Job, goes_on: bool) -> Result<(), String> {
    let mut command = job.command("killed.mcap");
    if goes_on {
        command.arg("--resume");
    }
    let output = command.output().map_err(|e| format!("{}: {e}", job.name))?;
    match output.status.code() {
        Some(0 | 3) => Ok(()),
        code => {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            Err(format!(
                "{} ended with {code:?} after a kill: {said}",
                job.name
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kills_without_a_run_from_a_checkpoint_prove_nothing() {
        assert!(!was_tried(true, 30, 0) && !was_tried(false, 0, 0));
        assert!(was_tried(true, 30, 1) && was_tried(false, 30, 0));
    }
}
