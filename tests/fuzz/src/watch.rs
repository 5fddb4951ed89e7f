//! A program under watch: its time, its memory, how it ended and what it said.

use std::fs::File;
use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Most that is read of what a program said \[byte\].
const SAID: u64 = 1 << 20;
/// A program may do nothing for this many times as long as it may work; what it waits for a processor on a busy machine is
/// not counted.
const PATIENCE: u32 = 6;
/// Ticks of the processor's clock in a second, on Linux.
const TICKS: f64 = 100.0;

/// What a program may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounds {
    /// Time of its processors.
    pub(crate) time: Duration,
    /// Resident memory \[byte\].
    pub(crate) memory: u64,
    /// After this time on the clock it is asked to stop, as by Ctrl-C.
    pub(crate) stop: Option<Duration>,
}

/// How a program ended.
#[derive(Debug, Clone)]
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) signal: Option<i32>,
    pub(crate) out: Vec<u8>,
    pub(crate) err: String,
    /// Time on the clock.
    pub(crate) took: Duration,
    /// Why it was killed: it took more than it may.
    pub(crate) over: Option<&'static str>,
}

/// Runs a program in `folder`, where what it says and its temporary files go.
pub(crate) fn run(
    program: &Path,
    arguments: &[String],
    folder: &Path,
    bounds: Bounds,
) -> Result<Ended, String> {
    let [out, err] = ["out", "err"].map(|name| folder.join(name));
    let create = |path: &Path| File::create(path).map_err(|e| format!("{}: {e}", path.display()));
    // What is asked for and not used is no resident memory: half as much again is refused by the system.
    let limit = bounds.memory / 1024 * 3 / 2;
    let began = Instant::now();
    let child = Command::new("sh")
        .arg("-c")
        .arg(format!("ulimit -c 0; ulimit -v {limit}; exec \"$@\""))
        .arg("sh")
        .arg(program)
        .args(arguments)
        .env("TMPDIR", folder)
        .env("RAYON_NUM_THREADS", "2")
        .env("RUST_BACKTRACE", "0")
        .stdin(Stdio::null())
        .stdout(create(&out)?)
        .stderr(create(&err)?)
        .spawn();
    let mut child = child.map_err(|e| format!("{}: {e}", program.display()))?;
    let (status, over) = await_end(&mut child, bounds, began)?;
    Ok(Ended {
        code: status.code(),
        signal: status.signal(),
        out: said(&out),
        err: String::from_utf8_lossy(&said(&err)).into_owned(),
        took: began.elapsed(),
        over,
    })
}

fn await_end(
    child: &mut Child,
    bounds: Bounds,
    began: Instant,
) -> Result<(std::process::ExitStatus, Option<&'static str>), String> {
    let (mut over, mut pause, mut stop) = (None, Duration::from_micros(500), bounds.stop);
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok((status, over)),
            Ok(None) => {}
            Err(e) => return Err(e.to_string()),
        }
        let clock = began.elapsed();
        if peak(child.id()) > bounds.memory {
            over = Some("memory");
        } else if worked(child.id()) > bounds.time
            || clock.saturating_sub(delayed(child.id())) > bounds.time * PATIENCE
        {
            over = Some("time");
        } else if stop.is_some_and(|at| clock > at) {
            stop = None;
            // Gone by itself meanwhile: all the better.
            let kill = Command::new("kill")
                .args(["-INT", &child.id().to_string()])
                .status();
            kill.map_err(|e| format!("kill: {e}"))?;
        }
        if over.is_some() {
            child.kill().map_err(|e| e.to_string())?;
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(10));
    }
}

/// Greatest resident memory so far \[byte\].
fn peak(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|l| l.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
    kib.unwrap_or(0) * 1024
}

/// Time that all its threads have worked.
fn worked(process: u32) -> Duration {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let after = stat.rsplit(')').next().unwrap_or_default();
    let ticks = after.split_whitespace().skip(11).take(2);
    let ticks: f64 = ticks.filter_map(|t| t.parse::<f64>().ok()).sum();
    Duration::from_secs_f64(ticks / TICKS)
}

/// The longest that a thread of it has been ready and waited for a processor.
fn delayed(process: u32) -> Duration {
    let tasks = std::fs::read_dir(format!("/proc/{process}/task"));
    let tasks = tasks.into_iter().flatten().flatten();
    let delays = tasks.filter_map(|task| {
        // Time at work, time in wait, turns.
        let told = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        told.split_whitespace().nth(1)?.parse().ok()
    });
    Duration::from_nanos(delays.max().unwrap_or(0))
}

fn said(path: &Path) -> Vec<u8> {
    let mut bytes = Vec::new();
    if let Ok(file) = File::open(path) {
        // What cannot be read was not said.
        let _ = file.take(SAID).read_to_end(&mut bytes);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(text: &str, time_s: f64, stop_s: Option<f64>) -> Ended {
        let folder = tempfile::tempdir().unwrap();
        let bounds = Bounds {
            time: Duration::from_secs_f64(time_s),
            memory: 1 << 30,
            stop: stop_s.map(Duration::from_secs_f64),
        };
        let words = ["-c".to_owned(), text.to_owned()];
        run(Path::new("/bin/sh"), &words, folder.path(), bounds).unwrap()
    }

    #[test]
    fn what_works_too_long_is_killed_and_what_is_told_to_stop_stops() {
        let ended = shell("while :; do :; done", 0.3, None);
        assert_eq!((ended.over, ended.signal), (Some("time"), Some(9)));
        let ended = shell("trap 'exit 130' INT; while :; do :; done", 5.0, Some(0.1));
        assert_eq!((ended.over, ended.code), (None, Some(130)));
        let ended = shell("echo a; echo b >&2; exit 3", 5.0, None);
        assert_eq!(
            (ended.code, ended.out.as_slice(), ended.err.as_str()),
            (Some(3), b"a\n".as_slice(), "b\n")
        );
    }
}
