//! One writer at a time: a lock of the operating system beside an output, released at death.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use crate::atomic::beside;
use crate::error::{Error, Result, io_error};
use crate::place::folder_of;

/// How often a lock file is opened anew that others removed meanwhile.
const TRIES: usize = 1000;

/// The right to write an output, held until it is dropped or the process ends in any way.
///
/// The lock is on the file `NAME.lock`: what it guards is renamed. The file holds the number of the process, and goes
/// with the lock; that of a killed process stays, unlocked.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    file: File,
    /// Folders that were made for it, the innermost first.
    made: Vec<PathBuf>,
}

impl Lock {
    /// Takes the right to write `out`, and makes its folder.
    ///
    /// # Errors
    /// [`Error::Taken`] when another process holds it; when the folder or the file cannot be made.
    pub fn of(out: &Path) -> Result<Self> {
        let made = make_folder(folder_of(out))?;
        let path = beside(out, ".lock");
        for _ in 0..TRIES {
            let mut options = OpenOptions::new();
            let options = options.read(true).write(true).create(true).truncate(false);
            let mut file = options.open(&path).map_err(io_error(&path, "create"))?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Err(taken(out, &mut file)),
                Err(TryLockError::Error(e)) => return Err(io_error(&path, "lock")(e)),
            }
            // Who held it may have removed it after it was opened here: a lock on no name guards nothing.
            if is(&file, &path) {
                let number = format!("{}\n", std::process::id());
                file.set_len(0)
                    .and_then(|()| file.write_all(number.as_bytes()))
                    .map_err(io_error(&path, "write"))?;
                return Ok(Self { path, file, made });
            }
        }
        Err(Error::Taken {
            path: out.to_owned(),
            by: String::new(),
        })
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if is(&self.file, &self.path) {
            // A lock file that stays is in nobody's way.
            let _ = fs::remove_file(&self.path);
        }
        for folder in &self.made {
            // Only a folder that is still empty goes.
            let _ = fs::remove_dir(folder);
        }
    }
}

fn is(file: &File, path: &Path) -> bool {
    match (file.metadata(), fs::metadata(path)) {
        (Ok(a), Ok(b)) => (a.dev(), a.ino()) == (b.dev(), b.ino()),
        _ => false,
    }
}

fn taken(out: &Path, file: &mut File) -> Error {
    let mut number = String::new();
    let told = file.take(32).read_to_string(&mut number).is_ok();
    let number: Option<u32> = number.trim().parse().ok().filter(|_| told);
    Error::Taken {
        path: out.to_owned(),
        by: number.map_or(String::new(), |n| format!(" (process {n})")),
    }
}

/// Makes a folder; gives those that were not there, the innermost first.
fn make_folder(folder: &Path) -> Result<Vec<PathBuf>> {
    let missing = folder
        .ancestors()
        .take_while(|f| !f.as_os_str().is_empty() && !f.exists());
    let missing = missing.map(Path::to_owned).collect();
    fs::create_dir_all(folder).map_err(io_error(folder, "create the folder"))?;
    Ok(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_lock_is_refused_until_the_first_goes() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("new/folder/a.mcap");
        let first = Lock::of(&out).expect("the first");
        let refused = Lock::of(&out).expect_err("the second").to_string();
        let number = std::process::id().to_string();
        assert!(refused.contains("is written by another run") && refused.contains(&number));
        drop(first);
        assert!(!folder.path().join("new").exists(), "nothing was written");
        let again = Lock::of(&out).expect("it is free");
        fs::write(&out, "a result").expect("a file");
        drop(again);
        let left: Vec<_> = fs::read_dir(out.parent().expect("a folder"))
            .expect("it stays")
            .collect();
        assert_eq!(left.len(), 1, "the result alone: {left:?}");
    }

    #[test]
    fn the_file_of_a_process_that_was_killed_is_no_lock() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("a.mcap");
        fs::write(beside(&out, ".lock"), "1\n").expect("a file");
        Lock::of(&out).expect("nobody holds it");
    }
}
