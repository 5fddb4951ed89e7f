//! Points made on this machine, by make.

use std::process::Command;

use run::Failure;

use crate::points::Points;

/// Makes every point that can be made, as many at once as make was told (`-j`).
///
/// # Errors
/// When make cannot be started.
pub(crate) fn run(points: &Points, threads: usize) -> Result<(), Failure> {
    let mut make = Command::new("make");
    make.args([
        "--no-print-directory",
        "--keep-going",
        "-f",
        "Makefile",
        "-f",
    ]);
    make.arg(points.makefile());
    make.arg(format!("THREADS={threads}")).arg("sweep-points");
    // What failed is looked up in what it left; make's own code tells no point.
    status(&mut make)?;
    Ok(())
}

/// Whether the make that called us only tells its story (`-n`).
pub(crate) fn only_tells() -> bool {
    told_only(&std::env::var("MAKEFLAGS").unwrap_or_default())
}

/// Whether the words of a make that called us ask for the story alone.
fn told_only(makeflags: &str) -> bool {
    let short = makeflags.split(' ').next().unwrap_or_default();
    !short.starts_with('-') && !short.contains('=') && short.contains('n')
}

/// Runs a program to its end; `true` where it ended well.
///
/// # Errors
/// When it cannot be started.
pub(crate) fn status(command: &mut Command) -> Result<bool, Failure> {
    let ended = command.status().map_err(|source| cannot(command, source))?;
    Ok(ended.success())
}

/// A program that cannot be started.
pub(crate) fn cannot(command: &Command, source: std::io::Error) -> Failure {
    Failure::Io {
        path: command.get_program().into(),
        action: "run",
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_make_that_only_tells_is_known_by_its_flags() {
        for flags in ["n", "kn -j2 --jobserver-auth=3,4", "n -- STUDY=x"] {
            assert!(told_only(flags), "{flags}");
        }
        for flags in [
            "",
            " --no-print-directory",
            "k",
            "--no-print-directory",
            "STUDY=never",
        ] {
            assert!(!told_only(flags), "{flags}");
        }
    }
}
