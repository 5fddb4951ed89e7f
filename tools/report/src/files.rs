//! The files that each page is made from, as the command line names them, and what is written: a page, or data to stdout.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use run::Failure;

/// Files of a study page.
#[derive(Debug, clap::Args)]
pub(crate) struct PageFiles {
    /// Name of the study.
    #[arg(long)]
    pub(crate) study: String,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Arc source; of several, what the page calls each.
    #[arg(long, value_name = "[NAME=]FILE", value_parser = perhaps_named("arc"))]
    pub(crate) arc: Vec<(String, PathBuf)>,
    /// Particle frames of the pool.
    #[arg(long)]
    pub(crate) pool: Option<PathBuf>,
    /// Mean fields; of several, what the page calls each.
    #[arg(long, value_name = "[NAME=]FILE", value_parser = perhaps_named("mean"))]
    pub(crate) mean: Vec<(String, PathBuf)>,
    /// Published values.
    #[arg(long)]
    pub(crate) targets: Option<PathBuf>,
    /// Numerical bands of the study's figures, as `make certify` writes them.
    #[arg(long)]
    pub(crate) certificate: Option<PathBuf>,
}

/// Files of a page about passes.
#[derive(Debug, clap::Args)]
pub(crate) struct PassesFiles {
    /// Name of the study.
    #[arg(long)]
    pub(crate) study: String,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Arc source of a pass, and what the page calls the pass; once for each.
    #[arg(long, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) arc: Vec<(String, PathBuf)>,
    /// Particle frames of the pool of a pass.
    #[arg(long, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) pool: Vec<(String, PathBuf)>,
    /// Mean fields of the pool of a pass.
    #[arg(long, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) mean: Vec<(String, PathBuf)>,
}

/// Files of a page about heat.
#[derive(Debug, clap::Args)]
pub(crate) struct HeatFiles {
    /// Name of the study.
    #[arg(long)]
    pub(crate) study: String,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Points of a run, and what the page calls it; once for each run.
    #[arg(long, required = true, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) frames: Vec<(String, PathBuf)>,
    /// Numerical bands of the study's figures, as `make certify` writes them.
    #[arg(long)]
    pub(crate) certificate: Option<PathBuf>,
}

/// Files of a page about jets.
#[derive(Debug, clap::Args)]
pub(crate) struct JetFiles {
    /// Name of the study.
    #[arg(long)]
    pub(crate) study: String,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Frames of a run, and what the page calls it; once for each run.
    #[arg(long, required = true, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) frames: Vec<(String, PathBuf)>,
    /// Numerical bands of the study's figures, as `make certify` writes them.
    #[arg(long)]
    pub(crate) certificate: Option<PathBuf>,
}

/// Files of a page about electric and magnetic fields.
#[derive(Debug, clap::Args)]
pub(crate) struct FieldFiles {
    /// Name of the study.
    #[arg(long)]
    pub(crate) study: String,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Points of a run, and what the page calls it; once for each run.
    #[arg(long, required = true, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) fields: Vec<(String, PathBuf)>,
    /// The exact solution of the run of that name along its lines.
    #[arg(long, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) exact: Vec<(String, PathBuf)>,
}

/// Files of a page about drops.
#[derive(Debug, clap::Args)]
pub(crate) struct DropFiles {
    /// Name of the study.
    #[arg(long)]
    pub(crate) study: String,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// A drop, and what the page calls it; once for each run.
    #[arg(long = "drop", required = true, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) drops: Vec<(String, PathBuf)>,
    /// Numerical bands of the study's figures, as `make certify` writes them.
    #[arg(long)]
    pub(crate) certificate: Option<PathBuf>,
}

/// Files of a page about gases.
#[derive(Debug, clap::Args)]
pub(crate) struct GasFiles {
    /// Name of the study.
    #[arg(long)]
    pub(crate) study: String,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// A gas table, and what the page calls it; once for each gas.
    #[arg(long, required = true, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) table: Vec<(String, PathBuf)>,
    /// Published properties of the gas, or of the NAME/VARIANT, of that name.
    #[arg(long, value_name = "NAME=FILE", value_parser = named)]
    pub(crate) reference: Vec<(String, PathBuf)>,
    /// The gas of that name with another value of an uncertain input, and what the page calls it.
    #[arg(long, value_name = "NAME/VARIANT=FILE", value_parser = named)]
    pub(crate) variant: Vec<(String, PathBuf)>,
}

/// Files of the page of a sweep.
#[derive(Debug, clap::Args)]
pub(crate) struct SweepFiles {
    /// What `sweep` tells of its points.
    #[arg(long)]
    pub(crate) points: PathBuf,
    /// The page to write; its table stands beside it, with the ending csv.
    #[arg(long)]
    pub(crate) out: PathBuf,
}

/// Folders of two runs.
#[derive(Debug, clap::Args)]
pub(crate) struct PairFiles {
    /// Folder of the one run.
    #[arg(long)]
    pub(crate) a: PathBuf,
    /// Folder of the other.
    #[arg(long)]
    pub(crate) b: PathBuf,
    /// The page to write; its table stands beside it, with the ending csv.
    #[arg(long)]
    pub(crate) out: PathBuf,
}

/// Files of a page about what would be there before a run.
#[derive(Debug, clap::Args)]
pub(crate) struct PreviewFiles {
    /// Name of the study, for the title.
    #[arg(long)]
    pub(crate) study: Option<String>,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Points of a scene, and what the page calls them.
    #[arg(required = true, value_name = "[NAME=]FILE.mcap", value_parser = look)]
    pub(crate) looks: Vec<(String, PathBuf)>,
}

/// A file that may have a name; without one it is called as it is.
fn look(word: &str) -> Result<(String, PathBuf), String> {
    named(word).or_else(|wrong| {
        let path = PathBuf::from(word);
        let stem = path
            .file_stem()
            .map(|stem| stem.to_string_lossy().into_owned());
        stem.map(|stem| (stem, path)).ok_or(wrong)
    })
}

/// What a live page is about.
#[derive(Debug, clap::Args)]
pub(crate) struct LiveFiles {
    /// Folder in which the study runs: build/STUDY.
    pub(crate) folder: PathBuf,
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Time between two renewals [s].
    #[arg(long, default_value_t = 10.0, value_parser = pause)]
    pub(crate) every_s: f64,
    /// Writes it once.
    #[arg(long)]
    pub(crate) once: bool,
}

/// A pause from a second to an hour.
fn pause(word: &str) -> Result<f64, String> {
    let seconds: f64 = word
        .parse()
        .map_err(|_| "wanted is a time in s".to_owned())?;
    match (1.0..=3600.0).contains(&seconds) {
        true => Ok(seconds),
        false => Err(format!("{seconds} s is out of range: from 1 s to 3600 s")),
    }
}

/// What is handed over to CalculiX.
#[derive(Debug, clap::Args)]
pub(crate) struct CalculixFiles {
    /// Particle frames of a weld, or points of a body that conducts heat.
    pub(crate) frames: PathBuf,
    /// The mesh: a file with nodes under *NODE, as CalculiX and Abaqus read it.
    #[arg(long)]
    pub(crate) mesh: PathBuf,
    /// What is written: OUT-start.inp and OUT-steps.inp.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Length unit of the mesh [m]: 0.001 for mm.
    #[arg(long, default_value_t = 1.0, value_parser = length)]
    pub(crate) unit_m: f64,
    /// Temperatures in degrees Celsius, not in K.
    #[arg(long)]
    pub(crate) celsius: bool,
    /// Only every N-th frame, from the first on.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) every: u32,
}

/// A length above zero.
fn length(word: &str) -> Result<f64, String> {
    let metres: f64 = word
        .parse()
        .map_err(|_| "wanted is a length in m".to_owned())?;
    match metres.is_finite() && metres > 0.0 {
        true => Ok(metres),
        false => Err(format!("{metres} m is out of range: above 0 m")),
    }
}

/// Folders of the index.
#[derive(Debug, clap::Args)]
pub(crate) struct Folders {
    /// The page to write.
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Records of exact cases.
    #[arg(long)]
    pub(crate) verify: Option<PathBuf>,
    /// Records of extreme cases.
    #[arg(long)]
    pub(crate) stability: Option<PathBuf>,
    /// Records of speed.
    #[arg(long)]
    pub(crate) bench: Option<PathBuf>,
    /// Records of studies with their numerical bands.
    #[arg(long)]
    pub(crate) certify: Option<PathBuf>,
    /// The table of what machines do to runs.
    #[arg(long)]
    pub(crate) faults: Option<PathBuf>,
    /// Where each study has a folder with its report.
    #[arg(long)]
    pub(crate) studies: Option<PathBuf>,
}

impl Folders {
    /// Folders of records that are asked for.
    fn records(&self) -> impl Iterator<Item = &PathBuf> {
        let folders = [
            &self.verify,
            &self.stability,
            &self.bench,
            &self.certify,
            &self.faults,
        ];
        folders.into_iter().flatten()
    }

    /// Folders that are not there.
    pub(crate) fn missing(&self) -> impl Iterator<Item = &PathBuf> {
        let folders = self.records().chain(&self.studies);
        folders.filter(|folder| !folder.is_dir())
    }

    /// Every record that is read, with what it is.
    pub(crate) fn read(&self) -> Vec<(String, PathBuf)> {
        let files = self.records().flat_map(|folder| {
            let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
            entries.map(|entry| entry.path())
        });
        let studies = self.studies.iter().flat_map(|folder| {
            let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
            entries.map(|entry| entry.path().join("report.html"))
        });
        let pages = studies.map(|path| ("the page of a study".to_owned(), path));
        let records = files.map(|path| ("a record".to_owned(), path));
        records.chain(pages).collect()
    }
}

/// A file with the name that is given to it.
fn named(word: &str) -> Result<(String, PathBuf), String> {
    match word.split_once('=') {
        Some((name, file)) if !name.is_empty() && !file.is_empty() => {
            Ok((name.to_owned(), PathBuf::from(file)))
        }
        _ => Err("wanted is NAME=FILE".to_owned()),
    }
}

/// A file that may have a name; without one it is called as its kind is.
pub(crate) fn perhaps_named(
    name: &'static str,
) -> impl Fn(&str) -> Result<(String, PathBuf), String> + Clone {
    move |word| {
        if word.is_empty() {
            return Err("wanted is FILE or NAME=FILE".to_owned());
        }
        Ok(named(word).unwrap_or_else(|_| (name.to_owned(), PathBuf::from(word))))
    }
}

/// Writes a page, with the folder that it lies in.
pub(crate) fn save(path: &Path, html: &str) -> Result<(), Failure> {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(|source| Failure::Io {
            path: folder.to_owned(),
            action: "create",
            source,
        })?;
    }
    Ok(artefact::write_atomically(path, html.as_bytes())?)
}

/// Writes data to stdout.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    let written = out
        .write_all(artefact::shown(text).as_bytes())
        .and_then(|()| out.flush());
    written.map_err(|source| Failure::Io {
        path: "stdout".into(),
        action: "write",
        source,
    })
}

/// Says on stderr what of a file is to be known; the exit code of what ended with warnings.
///
/// # Errors
/// When nothing can be written there.
pub(crate) fn warn(path: &Path, what: &str) -> Result<ExitCode, Failure> {
    say(&format!("warning: {}: {what}\n", path.display()))?;
    Ok(ExitCode::from(3))
}

/// Tells on standard error what is to be known of what was printed from a file.
pub(crate) fn note(path: &Path, what: &str) -> Result<(), Failure> {
    say(&format!("{}: {what}\n", path.display()))
}

fn say(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stderr().lock();
    let written = out.write_all(artefact::shown(text).as_bytes());
    written.map_err(|source| Failure::Io {
        path: "stderr".into(),
        action: "write",
        source,
    })
}
