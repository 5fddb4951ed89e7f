//! What the record says of the machine: memory, load, time of day.

use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

/// Ticks of a second in what the system tells of processes: 100 on all Linux systems.
const TICKS: f64 = 100.0;

/// The machine that a run was on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Machine {
    /// Model of the processor; `None` where the system does not say.
    processor: Option<String>,
    /// Threads that it runs at once.
    cores: usize,
    /// `linux x86_64`.
    system: String,
}

impl Machine {
    pub(crate) fn here() -> Self {
        Self {
            processor: std::fs::read_to_string("/proc/cpuinfo")
                .ok()
                .and_then(|text| processor(&text)),
            cores: cores(),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        }
    }
}

/// Threads that the machine runs at once.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// The first model that `/proc/cpuinfo` names.
fn processor(text: &str) -> Option<String> {
    let named = |line: &str| {
        let (key, name) = line.split_once(':')?;
        (key.trim() == "model name").then(|| name.trim().to_owned())
    };
    text.lines().find_map(named)
}

/// Greatest resident memory of this process so far \[byte\]; `None` where the system does not say.
pub(crate) fn peak_memory_bytes() -> Option<u64> {
    status("VmHWM:")
}

/// Resident memory of this process now \[byte\]; `None` where the system does not say.
pub(crate) fn memory_bytes() -> Option<u64> {
    status("VmRSS:")
}

/// A size that the system tells of this process \[byte\].
fn status(name: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

/// Time that processors have spent on this process \[s\]; `None` where the system does not say.
pub(crate) fn work_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program, in brackets, may hold anything.
    let mut fields = text.rsplit_once(')')?.1.split_whitespace().skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / TICKS)
}

/// Load averages over 1, 5 and 15 minutes; `None` where the system does not say.
pub(crate) fn load_average() -> Option<[f64; 3]> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    let mut numbers = text.split_whitespace().map(str::parse);
    let mut next = || numbers.next()?.ok();
    Some([next()?, next()?, next()?])
}

/// The time of day as `2026-01-31T12:00:00Z`.
pub(crate) fn now() -> String {
    let seconds = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |d| d.as_secs());
    utc(seconds)
}

/// Seconds since 1970 as a date: the days are counted in 400-year cycles that begin in March.
fn utc(seconds: u64) -> String {
    let (day, second) = (seconds / 86_400, seconds % 86_400);
    let shifted = day + 719_468;
    let (cycle, of_cycle) = (shifted / 146_097, shifted % 146_097);
    let year = (of_cycle - of_cycle / 1_460 + of_cycle / 36_524 - of_cycle / 146_096) / 365;
    let of_year = of_cycle - (365 * year + year / 4 - year / 100);
    let march = (5 * of_year + 2) / 153;
    let date = of_year - (153 * march + 2) / 5 + 1;
    let month = if march < 10 { march + 3 } else { march - 9 };
    let year = year + 400 * cycle + u64::from(month <= 2);
    let (h, m, s) = (second / 3600, second / 60 % 60, second % 60);
    format!("{year:04}-{month:02}-{date:02}T{h:02}:{m:02}:{s:02}Z")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_is_named_once() {
        let text = "processor\t: 0\nmodel name\t: A  1 GHz\nprocessor\t: 1\nmodel name\t: B\n";
        assert_eq!(processor(text).as_deref(), Some("A  1 GHz"));
        assert_eq!(processor("flags: a b\n"), None);
        assert!(Machine::here().cores >= 1);
    }

    #[test]
    fn dates_follow_the_calendar() {
        assert_eq!(utc(0), "1970-01-01T00:00:00Z");
        assert_eq!(utc(951_782_399), "2000-02-28T23:59:59Z");
        assert_eq!(utc(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(utc(951_868_800), "2000-03-01T00:00:00Z");
        assert_eq!(utc(1_767_225_600), "2026-01-01T00:00:00Z");
    }

    #[test]
    fn the_process_has_a_peak_of_memory() {
        let before = peak_memory_bytes();
        let block = std::hint::black_box(vec![1u8; 64 << 20]);
        let after = peak_memory_bytes();
        if let (Some(before), Some(after)) = (before, after) {
            assert!(after >= before + (32 << 20), "{before} {after}");
        }
        assert_eq!(block.len(), 64 << 20);
    }
}
