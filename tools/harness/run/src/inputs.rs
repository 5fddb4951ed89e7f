//! The input files of a run, by name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use artefact::Reader;

use crate::failure::Failure;
use crate::scene::nearest;

/// An input file that a stage reads, given as `--input NAME=FILE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Input {
    /// Name on the command line and in the header of the artefact.
    pub name: &'static str,
    /// What it is, for `--help`: "gas table (gas-table 1.x)".
    pub what: &'static str,
    /// Whether a run without it is refused before anything else.
    pub required: bool,
}

/// The input files of a run, by name, with their hashes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Inputs {
    files: BTreeMap<String, PathBuf>,
    hashes: BTreeMap<String, String>,
}

impl Inputs {
    /// No inputs.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// Names and files; each file is read for its hash, and an artefact for all that `artefact validate` looks at.
    ///
    /// # Errors
    /// When a name stands twice, a file cannot be read, or an artefact is damaged or contradicts itself anywhere.
    pub fn of<'a>(files: impl IntoIterator<Item = (&'a str, &'a Path)>) -> Result<Self, Failure> {
        let mut all = Self::default();
        for (name, path) in files {
            if all.files.insert(name.to_owned(), path.to_owned()).is_some() {
                return Err(Failure::Usage(format!("--input {name}: given twice")));
            }
            if !path.is_file() {
                let what = if path.is_dir() {
                    "is a folder, wanted is a file"
                } else if path.exists() {
                    "is no regular file"
                } else {
                    "there is no such file"
                };
                let path = path.display();
                return Err(Failure::Usage(format!("--input {name}={path}: {what}")));
            }
            // What is no artefact, or another kind of one, is told by who reads it.
            let hash = match Reader::open(path) {
                Ok(artefact) => {
                    let hash = artefact.scrub_and_hash()?;
                    artefact.must_be_sound()?;
                    hash
                }
                Err(_) => artefact::sha256_file(path)?,
            };
            all.hashes.insert(name.to_owned(), hash);
        }
        Ok(all)
    }

    /// From `NAME=FILE` words, against what the tool declares.
    pub(crate) fn from_words(words: &[String], declared: &[Input]) -> Result<Self, Failure> {
        let names: Vec<&str> = declared.iter().map(|input| input.name).collect();
        let mut files = Vec::new();
        for word in words {
            let Some((name, path)) = word.split_once('=').filter(|(_, path)| !path.is_empty())
            else {
                return Err(Failure::Usage(format!(
                    "--input {word}: wanted is NAME=FILE"
                )));
            };
            if !names.contains(&name) {
                return Err(Failure::Usage(unknown(name, &names)));
            }
            files.push((name, Path::new(path)));
        }
        let missing = declared
            .iter()
            .find(|input| input.required && !files.iter().any(|(name, _)| *name == input.name));
        if let Some(input) = missing {
            return Err(Failure::Usage(format!(
                "--input {}=FILE is needed: {}",
                input.name, input.what
            )));
        }
        Self::of(files)
    }

    /// The file of an input that a scene makes necessary.
    ///
    /// # Errors
    /// [`Failure::Usage`] when it was not given.
    pub fn path(&self, name: &str) -> Result<&Path, Failure> {
        self.get(name)
            .ok_or_else(|| Failure::Usage(format!("--input {name}=FILE is needed by this scene")))
    }

    /// The file of an input, if it was given.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Path> {
        self.files.get(name).map(PathBuf::as_path)
    }

    /// SHA-256 of each file by name.
    #[must_use]
    pub fn hashes(&self) -> &BTreeMap<String, String> {
        &self.hashes
    }

    /// Names and files.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Path)> {
        self.files
            .iter()
            .map(|(name, path)| (name.as_str(), path.as_path()))
    }
}

fn unknown(name: &str, names: &[&str]) -> String {
    match nearest(name, names) {
        _ if names.is_empty() => format!("--input {name}: this tool has no inputs"),
        Some(meant) => format!("--input {name}: unknown; did you mean '{meant}'?"),
        None => format!("--input {name}: unknown; known are: {}", names.join(", ")),
    }
}
