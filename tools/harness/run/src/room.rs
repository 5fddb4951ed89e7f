//! How much memory a process may take, and what is said of a scene that wants more.
//!
//! One rule for all tools: the plan of a scene is compared with the least of what the machine has, what a control group leaves
//! to the process, and what its address space is limited to.

use std::path::Path;

use crate::fault::Fault;
use crate::plan::bytes;

/// Memory that the process may take, and whose limit it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Room {
    /// Memory \[byte\].
    pub bytes: u64,
    /// Whose limit: "this machine has".
    pub whose: &'static str,
}

const MACHINE: &str = "this machine has";
const GROUP: &str = "the control group of the process allows";
const SPACE: &str = "the address space of the process is limited to";

/// The memory that this process may take; `None` where the system does not say.
#[must_use]
pub fn memory_room() -> Option<Room> {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let machine = machine(&read("/proc/meminfo"));
    let space = space(&read("/proc/self/limits"));
    let groups = groups(&read("/proc/self/cgroup"));
    let limits = groups.iter().filter_map(|path| limit(Path::new(path)));
    let all = [(machine, MACHINE), (space, SPACE), (limits.min(), GROUP)];
    let known = |(bytes, whose): (Option<u64>, _)| bytes.map(|bytes| Room { bytes, whose });
    let known = all.into_iter().filter_map(known);
    known.min_by_key(|room| room.bytes)
}

/// What is wrong with a scene for which more memory is wanted than there is: `what` takes so many bytes, and `change` says
/// what to change. Nothing where there is room.
///
/// ```
/// let fault = run::crowded("/points/spacing_m", "spacing 1e-9 m gives 1e24 points", 1e26, "take a larger spacing");
/// assert!(fault.is_some());
/// assert!(run::crowded("/points/spacing_m", "one point", 100.0, "").is_none());
/// ```
#[must_use]
pub fn crowded(path: &str, what: &str, wanted: f64, change: &str) -> Option<Fault> {
    let room = memory_room()?;
    #[allow(clippy::cast_precision_loss, reason = "no limit is known to the byte")]
    let fits = wanted <= room.bytes as f64;
    (!fits).then(|| {
        let what = format!(
            "{what}: that takes at least {} of memory, {} {}; {change}",
            size(wanted),
            room.whose,
            bytes(room.bytes)
        );
        Fault::at(path, what)
    })
}

/// A size of any magnitude.
fn size(wanted: f64) -> String {
    if wanted < 1e15 {
        // Below the largest whole number that is exact.
        bytes(wanted.max(0.0) as u64)
    } else {
        format!("{wanted:.1e} B")
    }
}

/// Memory of the machine, from `/proc/meminfo` \[byte\].
fn machine(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|l| l.strip_prefix("MemTotal:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

/// Limit of the address space, from `/proc/self/limits` \[byte\]; none where it is unlimited.
fn space(text: &str) -> Option<u64> {
    let line = text
        .lines()
        .find_map(|l| l.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Files that may limit the memory of the control groups of the process, from `/proc/self/cgroup`: of its own group and of all
/// above it, of either version.
fn groups(text: &str) -> Vec<String> {
    let mut files = Vec::new();
    for line in text.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (Some(kinds), Some(path)) = (parts.next(), parts.next()) else {
            continue;
        };
        let (root, name) = if kinds.is_empty() {
            ("/sys/fs/cgroup", "memory.max")
        } else if kinds.split(',').any(|kind| kind == "memory") {
            ("/sys/fs/cgroup/memory", "memory.limit_in_bytes")
        } else {
            continue;
        };
        let above = Path::new(path.trim_start_matches('/')).ancestors();
        files.extend(above.map(|group| {
            let file = Path::new(root).join(group).join(name);
            file.to_string_lossy().into_owned()
        }));
    }
    files
}

/// The number in a file that limits a group; none where there is none.
fn limit(file: &Path) -> Option<u64> {
    std::fs::read_to_string(file).ok()?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_read_as_the_system_writes_them() {
        assert_eq!(
            machine("MemTotal:       24 kB\nMemFree: 1 kB\n"),
            Some(24 * 1024)
        );
        let limits = "Limit  Soft Limit  Hard Limit  Units\nMax address space         4294967296           unlimited            bytes\n";
        assert_eq!(space(limits), Some(4_294_967_296));
        assert_eq!(
            space("Max address space  unlimited  unlimited  bytes"),
            None
        );
        assert_eq!(
            groups("0::/a/b\n"),
            [
                "/sys/fs/cgroup/a/b/memory.max",
                "/sys/fs/cgroup/a/memory.max",
                "/sys/fs/cgroup/memory.max"
            ]
        );
        assert_eq!(
            groups("5:cpu:/x\n4:hugetlb,memory:/\n"),
            ["/sys/fs/cgroup/memory/memory.limit_in_bytes"]
        );
    }

    #[test]
    fn what_does_not_fit_is_told_with_both_numbers() {
        let Some(room) = memory_room() else { return };
        assert!(room.bytes > 1 << 20, "{room:?}");
        let fault = crowded("/points", "spacing 1 m gives 9 points", 1e30, "take 2 m").unwrap();
        let said = fault.to_string();
        assert!(
            said.contains("at least 1.0e30 B")
                && said.contains(room.whose)
                && said.ends_with("take 2 m"),
            "{said}"
        );
        assert_eq!(crowded("/points", "few", 1.0, ""), None);
    }
}
