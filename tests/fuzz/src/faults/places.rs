//! Places that cannot be written, or must not be: each is told in words and nothing that was there is lost.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use super::Row;
use super::stages::{Job, text};

/// A user without rights here.
const NOBODY: &str = "65534";

/// All faults of places for a job.
pub(super) fn rows(job: &Job) -> Result<Vec<Row>, String> {
    Ok(vec![
        full_disk(job)?,
        two_writers(job)?,
        over_inputs(job)?,
        wrong_owner(job)?,
    ])
}

fn row(job: &Job, fault: &str, expected: &str, tried: (usize, Result<String, String>)) -> Row {
    let (times, found) = tried;
    let holds = Some(found.is_ok());
    Row {
        fault: fault.to_owned(),
        who: job.name.to_owned(),
        times,
        expected: expected.to_owned(),
        found: found.unwrap_or_else(|wrong| wrong),
        holds,
    }
}

/// What a program said, if it ended with `code` and said all words.
fn must(output: &Output, code: i32, words: &[&str]) -> Result<(), String> {
    let said = String::from_utf8_lossy(&output.stderr);
    let absent = words.iter().find(|word| !said.contains(**word));
    match (output.status.code(), absent) {
        (Some(found), None) if found == code => Ok(()),
        (found, _) => Err(format!("ended with {found:?}: {}", said.trim())),
    }
}

/// A file may be only so long: as on a disk that fills, the write is refused, here with a signal as well.
fn full_disk(job: &Job) -> Result<Row, String> {
    let told = |e: std::io::Error| format!("{}: {e}", job.name);
    job.clear("full.mcap")?;
    let run = job.command("full.mcap");
    let mut command = Command::new("sh");
    // Two blocks of 512 bytes hold the head of an artefact and no more.
    command.args(["-c", "ulimit -f 2; exec \"$0\" \"$@\""]);
    command.arg(run.get_program()).args(run.get_args());
    let output = command.output().map_err(told)?;
    let found = must(&output, 1, &["File too large", "make room"]).and_then(|()| {
        if job.path("full.mcap").exists() {
            return Err("a file that is not whole bears the name".to_owned());
        }
        Ok("told in words, nothing half done bears the name".to_owned())
    });
    Ok(row(
        job,
        "disk full, or files limited",
        "exit 1 in words",
        (1, found),
    ))
}

/// Two runs that write one file: one does, the other is refused by name.
fn two_writers(job: &Job) -> Result<Row, String> {
    let told = |e: std::io::Error| format!("{}: {e}", job.name);
    job.clear("both.mcap")?;
    let start = || job.command("both.mcap").stderr(Stdio::piped()).spawn();
    let (first, second) = (start().map_err(told)?, start().map_err(told)?);
    let ends = [first, second].map(|child| child.wait_with_output());
    let [a, b] = ends;
    let (a, b) = (a.map_err(told)?, b.map_err(told)?);
    let done = |output: &Output| matches!(output.status.code(), Some(0 | 3));
    let (winner, other) = if done(&a) { (a, b) } else { (b, a) };
    let same =
        std::fs::read(job.path("both.mcap")).ok() == std::fs::read(job.path("straight.mcap")).ok();
    let found = if done(&winner) && done(&other) {
        // The second came when the first had ended.
        Ok("one after the other".to_owned())
    } else {
        must(&other, 2, &["is written by another run"])
            .map(|()| "the second is refused by name".to_owned())
    };
    let found = found.and_then(|word| {
        if same {
            Ok(word)
        } else {
            Err("other bytes".to_owned())
        }
    });
    Ok(row(
        job,
        "two writers on one output",
        "one done, one refused",
        (2, found),
    ))
}

/// An output that is the scene, a patch, an input, by its name or another.
fn over_inputs(job: &Job) -> Result<Row, String> {
    let told = |e: std::io::Error| format!("{}: {e}", job.name);
    let mut found = Ok("refused, nothing is touched".to_owned());
    let mut times = 0;
    for read in &job.reads {
        let linked = job.path("linked.mcap");
        for link in [false, true] {
            let _ = std::fs::remove_file(&linked);
            if link {
                std::fs::hard_link(read, &linked).map_err(told)?;
            } else {
                std::os::unix::fs::symlink(read, &linked).map_err(told)?;
            }
            let before = std::fs::read(read).map_err(told)?;
            let output = job.command("linked.mcap").output().map_err(told)?;
            times += 1;
            let now = std::fs::read(read).map_err(told)?;
            let told = must(&output, 2, &["--out"]);
            let kept = if before == now {
                Ok(())
            } else {
                Err("what is read was written".to_owned())
            };
            if let Err(wrong) = told.and(kept) {
                found = Err(format!("{}: {wrong}", text(read)));
            }
        }
        let _ = std::fs::remove_file(&linked);
    }
    Ok(row(
        job,
        "an output that is read",
        "exit 2, nothing touched",
        (times, found),
    ))
}

/// A folder that belongs to another user.
fn wrong_owner(job: &Job) -> Result<Row, String> {
    let told = |e: std::io::Error| format!("{}: {e}", job.name);
    let folder = job.path("locked");
    std::fs::create_dir_all(&folder).map_err(told)?;
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o555)).map_err(told)?;
    let run = job.command("locked/out.mcap");
    let output = if writable(&folder) {
        // To the superuser no folder is locked: somebody else tries.
        let mut command = Command::new("setpriv");
        command.args(["--reuid", NOBODY, "--regid", NOBODY, "--clear-groups"]);
        command.arg(run.get_program()).args(run.get_args()).output()
    } else {
        Command::new(run.get_program())
            .args(run.get_args())
            .output()
    };
    let Ok(output) = output else {
        let mut row = row(
            job,
            "a folder of another user",
            "exit 1 or 2 in words",
            (0, Ok("no setpriv here".to_owned())),
        );
        row.holds = None;
        return Ok(row);
    };
    let words = ["Permission denied"];
    let found = must(&output, 1, &words).or_else(|_| must(&output, 2, &words));
    let found = found.map(|()| "told in words".to_owned());
    Ok(row(
        job,
        "a folder of another user",
        "exit 1 or 2 in words",
        (1, found),
    ))
}

/// Whether this user can write into a folder.
fn writable(folder: &Path) -> bool {
    let probe = folder.join("probe");
    let made = std::fs::write(&probe, "").is_ok();
    if made {
        let _ = std::fs::remove_file(probe);
    }
    made
}
