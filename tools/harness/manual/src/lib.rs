//! What a shell and `man` know of a program: completions and pages, written from its command line.
//!
//! The folders below a prefix are those in which bash, zsh, fish and man look by themselves.

use std::io;
use std::path::{Path, PathBuf};

use clap::Command;
use clap_complete::{Shell, generate_to};

/// Where each shell looks for completions below a prefix.
const COMPLETIONS: [(Shell, &str); 3] = [
    (Shell::Bash, "share/bash-completion/completions"),
    (Shell::Zsh, "share/zsh/site-functions"),
    (Shell::Fish, "share/fish/vendor_completions.d"),
];
/// Where `man` looks below a prefix.
const PAGES: &str = "share/man/man1";

/// The hidden subcommand that writes them: `make install` calls it.
#[derive(Debug, clap::Args)]
pub struct Wanted {
    /// The prefix below which shells and man look.
    #[arg(long, value_name = "FOLDER")]
    pub into: PathBuf,
}

/// Writes the completions and pages of the program `command` below the folder `prefix`.
///
/// # Errors
/// When a folder or file cannot be written.
pub fn write(command: &Command, prefix: &Path) -> io::Result<()> {
    let command = command.clone().term_width(80);
    let name = command.get_name().to_owned();
    for (shell, folder) in COMPLETIONS {
        let folder = prefix.join(folder);
        std::fs::create_dir_all(&folder)?;
        let mut command = command.clone();
        let path = generate_to(shell, &mut command, &name, &folder)?;
        if shell == Shell::Bash {
            // bash looks for a file of the program's name.
            std::fs::rename(path, folder.join(&name))?;
        }
    }
    let folder = prefix.join(PAGES);
    std::fs::create_dir_all(&folder)?;
    clap_mangen::generate_to(command, folder)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use clap::{Arg, Command};

    #[test]
    fn each_shell_and_man_find_their_files_with_what_is_hidden_left_out() {
        let prefix = tempfile::tempdir().unwrap();
        let run = Command::new("run").arg(Arg::new("out").long("out"));
        let hidden = Command::new("manual").hide(true);
        let command = Command::new("pool").subcommand(run).subcommand(hidden);
        super::write(&command, prefix.path()).unwrap();
        let read = |path: &str| std::fs::read_to_string(prefix.path().join(path)).unwrap();
        for path in [
            "share/bash-completion/completions/pool",
            "share/zsh/site-functions/_pool",
            "share/fish/vendor_completions.d/pool.fish",
        ] {
            assert!(read(path).contains("out"), "{path}");
        }
        assert!(read("share/man/man1/pool-run.1").contains("out"));
        assert!(!read("share/man/man1/pool.1").contains("manual"));
    }
}
