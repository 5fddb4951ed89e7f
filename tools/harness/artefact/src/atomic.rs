//! Files that appear whole or not at all: written beside, synced, renamed.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::error::{Result, io_error};
use crate::place::{folder_of, must_be_replaceable};

/// `path` with `suffix` appended to its name.
#[must_use]
pub fn beside(path: &Path, suffix: &str) -> PathBuf {
    let mut name: OsString = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// Free bytes of the disk that `path` is to be written to; `None` where the system does not tell.
#[must_use]
pub fn free_bytes(path: &Path) -> Option<u64> {
    let disk = rustix::fs::statvfs(folder_of(path)).ok()?;
    Some(disk.f_bavail.saturating_mul(disk.f_frsize))
}

/// Writes `bytes` to `path` so that a reader sees the old file or the new one, never a part.
///
/// # Errors
/// When the system refuses, or what stands there is no file; it is then untouched.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<()> {
    must_be_replaceable(path)?;
    let part = beside(path, ".part");
    let written = write_synced(&part, bytes);
    if written.is_err() {
        // The failure is what matters; a leftover that cannot be removed changes nothing.
        let _ = fs::remove_file(&part);
        return written;
    }
    rename_synced(&part, path)
}

fn write_synced(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut file = File::create(path).map_err(io_error(path, "create"))?;
    file.write_all(bytes).map_err(io_error(path, "write"))?;
    file.sync_all().map_err(io_error(path, "sync"))
}

/// Renames and makes the new name durable.
pub(crate) fn rename_synced(from: &Path, to: &Path) -> Result<()> {
    fs::rename(from, to).map_err(io_error(to, "rename to"))?;
    let folder = folder_of(to);
    let folder_file = File::open(folder).map_err(io_error(folder, "open"))?;
    folder_file.sync_all().map_err(io_error(folder, "sync"))
}
