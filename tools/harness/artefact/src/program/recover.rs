//! `artefact recover`: what is whole of a file whose run was killed or that was damaged, as a proper
//! file.

use std::path::{Path, PathBuf};

use artefact::{Lock, followed, must_be_nameable, must_not_be_read};

use super::Streams;
use super::trouble::{Trouble, Verdict};

/// Arguments of `recover`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:
  target/release/artefact recover build/gmaw-300a/pool.mcap.part
writes build/gmaw-300a/pool.recovered.mcap with all messages of whole chunks and a metadata record
'fusionline.recovered' that says so; what is lost is printed with its channels and times. The file
itself stays: where a checkpoint stands beside it, the tool's --resume continues the run and loses
nothing. Exit code 1 when nothing could be saved.")]
pub(crate) struct Arguments {
    /// The partial file NAME.mcap.part, or a truncated or damaged NAME.mcap.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Where to write; by default NAME.recovered.mcap beside it.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Overwrites an existing file.
    #[arg(long)]
    force: bool,
}

/// What is added to the name while the file is written.
const PART: &str = ".part.recovered";

pub(crate) fn run(arguments: &Arguments, streams: &mut Streams<'_>) -> Result<Verdict, Trouble> {
    let from = &arguments.file;
    let named = arguments.out.clone().unwrap_or_else(|| beside(from));
    let to = followed(&named);
    must_be_nameable(&to, PART)?;
    for written in [to.clone(), artefact::beside(&to, PART)] {
        must_not_be_read(
            &written,
            [("the file to be saved".to_owned(), from.as_path())],
        )?;
    }
    let _owned = Lock::of(&to)?;
    if to.exists() && !arguments.force {
        return Err(Trouble::Usage(format!(
            "{} exists: name another file with --out, or add --force to write over it",
            to.display()
        )));
    }
    let saved = artefact::recover(from, &to)?;
    writeln!(
        streams.out,
        "{}: {} messages saved, {} bytes behind the last whole chunk lost",
        to.display(),
        saved.messages,
        saved.lost_bytes
    )?;
    for lost in &saved.lost {
        writeln!(streams.out, "  {lost}")?;
    }
    Ok(Verdict::Good)
}

/// `pool.mcap.part` and `pool.mcap` become `pool.recovered.mcap`.
fn beside(path: &Path) -> PathBuf {
    let whole = match path.extension() {
        Some(e) if e == "part" => path.with_extension(""),
        _ => path.to_owned(),
    };
    whole.with_extension("recovered.mcap")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_saved_file_stands_beside_the_partial_one() {
        for name in ["a/pool.mcap.part", "a/pool.mcap"] {
            assert_eq!(beside(Path::new(name)), Path::new("a/pool.recovered.mcap"));
        }
    }
}
