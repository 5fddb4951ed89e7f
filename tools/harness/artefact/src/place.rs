//! Where a file is to be written: what stands there, what its name may be, and that it is nothing that is read.

use std::fs;
use std::os::unix::fs::{FileTypeExt, MetadataExt};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Links that are followed from one to the next.
const LINKS: usize = 40;
/// Longest name of a file where the disk does not tell \[byte\].
const NAME_BYTES: u64 = 255;

/// Refuses to put a file where something stands that is no file, as a rename would replace a device or a
/// pipe, and fail at a folder only when all work is done.
///
/// # Errors
/// [`Error::NoPlace`] with what stands there.
pub fn must_be_replaceable(path: &Path) -> Result<()> {
    let Ok(found) = fs::metadata(path) else {
        return Ok(());
    };
    let kind = found.file_type();
    let what = if kind.is_file() {
        return Ok(());
    } else if kind.is_dir() {
        "a folder"
    } else if kind.is_fifo() {
        "a pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    };
    Err(Error::NoPlace {
        path: path.to_owned(),
        what,
    })
}

/// The name at the end of all links: what is written to a link is written to where it points, on whatever disk.
#[must_use]
pub fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        let Ok(target) = fs::read_link(&path) else {
            break;
        };
        path = folder_of(&path).join(target);
    }
    path
}

/// Refuses a name that is no text, or that leaves no room for `suffix`, the longest that is added to it.
///
/// # Errors
/// [`Error::Name`] with the lengths.
pub fn must_be_nameable(path: &Path, suffix: &str) -> Result<()> {
    let wrong = |what: String| {
        Err(Error::Name {
            path: path.to_owned(),
            what,
        })
    };
    let Some(name) = path.file_name().filter(|_| path.to_str().is_some()) else {
        return wrong("is no name of a file in UTF-8".to_owned());
    };
    // The folder may be yet to be made.
    let there = folder_of(path).ancestors().find(|f| f.is_dir());
    let disk = rustix::fs::statvfs(there.unwrap_or(Path::new("."))).ok();
    let most = disk.map_or(NAME_BYTES, |disk| disk.f_namemax);
    let length = (name.len() + suffix.len()) as u64;
    if length <= most {
        return Ok(());
    }
    wrong(format!(
        "the name is {} bytes long and {} are added beside it ('{suffix}'): at most {most} in all",
        name.len(),
        suffix.len()
    ))
}

/// Refuses to write over a file that is read, under whatever name: `reads` are files with what each is.
///
/// # Errors
/// [`Error::Read`] with both.
pub fn must_not_be_read<'a>(
    written: &Path,
    reads: impl IntoIterator<Item = (String, &'a Path)>,
) -> Result<()> {
    let Some(own) = number(written) else {
        return Ok(());
    };
    match reads
        .into_iter()
        .find(|(_, path)| number(path) == Some(own))
    {
        None => Ok(()),
        Some((what, read)) => Err(Error::Read {
            path: written.to_owned(),
            what,
            read: read.to_owned(),
        }),
    }
}

/// Disk and number of a file that is there.
fn number(path: &Path) -> Option<(u64, u64)> {
    let found = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    Some((found.dev(), found.ino()))
}

/// The folder that a file stands in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_are_followed_to_a_name_that_may_be_free() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        symlink("b", at("a")).expect("a link");
        symlink(at("c"), at("b")).expect("a link");
        assert_eq!(followed(&at("a")), at("c"));
        assert_eq!(followed(&at("d")), at("d"));
        symlink("ring", at("ring")).expect("a link");
        let _ = followed(&at("ring"));
    }

    #[test]
    fn a_file_is_known_under_every_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("a"), "").expect("a file");
        fs::write(at("other"), "").expect("a file");
        fs::hard_link(at("a"), at("hard")).expect("a link");
        symlink("a", at("soft")).expect("a link");
        for name in ["a", "hard", "soft"] {
            let reads = [("the scene".to_owned(), at("a"))];
            let reads = reads
                .iter()
                .map(|(what, path)| (what.clone(), path.as_path()));
            let refused = must_not_be_read(&at(name), reads).expect_err(name);
            assert!(refused.to_string().contains("is the scene"), "{refused}");
        }
        let path = at("a");
        must_not_be_read(&at("other"), [(String::new(), path.as_path())]).expect("another file");
        must_not_be_read(&at("new"), [(String::new(), path.as_path())]).expect("no file yet");
    }

    #[test]
    fn names_leave_room_for_what_is_beside_them() {
        let name = |n: usize| PathBuf::from("n".repeat(n));
        must_be_nameable(&name(250), ".part").expect("it fits");
        let refused = must_be_nameable(&name(251), ".part").expect_err("too long");
        assert!(refused.to_string().contains("251 bytes long and 5"));
    }
}
