//! Tests that need what a machine may lack.

use std::io::Write;
use std::path::Path;

/// What tests may need, as `FUSIONLINE_NEEDS` names it.
const NAMES: [&str; 8] = [
    "python",
    "hyperqueue",
    "slurm",
    "dpkg",
    "bash",
    "user",
    "calculix",
    "browser",
];

/// Leaves the rest of a test out for want of `what`. `make test` lists what was left out at its end, from `build/skipped`.
/// Where `FUSIONLINE_NEEDS` names it, as in `FUSIONLINE_NEEDS=python,slurm`, its absence is a failure.
#[allow(
    clippy::print_stderr,
    clippy::missing_panics_doc,
    reason = "a test fails by a panic, and says what it skips"
)]
pub fn skip(what: &str, why: &str) {
    let needs = std::env::var("FUSIONLINE_NEEDS").unwrap_or_default();
    if let Err(fault) = may_skip(what, &needs) {
        panic!("{why}: {fault}");
    }
    let test = std::thread::current();
    let line = format!("{} ({what}): {why}\n", test.name().unwrap_or("a test"));
    eprint!("skipped: {line}");
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let Some(root) = here.ancestors().find(|p| p.join("pipelines").is_dir()) else {
        return;
    };
    let _ = std::fs::create_dir_all(root.join("build"));
    let list = root.join("build/skipped");
    let list = std::fs::OpenOptions::new()
        .create(true)
        .append(true)
        .open(list);
    // What cannot be listed has been said.
    let _ = list.and_then(|mut list| list.write_all(line.as_bytes()));
}

/// Whether a test may go without; `needs` is a list with commas.
fn may_skip(what: &str, needs: &str) -> Result<(), String> {
    let names = needs.split(',').map(str::trim).filter(|n| !n.is_empty());
    for need in names.chain([what]) {
        if !NAMES.contains(&need) {
            let known = NAMES.join(", ");
            return Err(format!("'{need}' of FUSIONLINE_NEEDS is none of {known}"));
        }
    }
    if needs.split(',').any(|need| need.trim() == what) {
        return Err(format!("FUSIONLINE_NEEDS asks for {what}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::may_skip;

    #[test]
    fn what_is_needed_is_not_skipped() {
        assert!(may_skip("slurm", "").is_ok() && may_skip("slurm", "python, dpkg").is_ok());
        assert!(may_skip("slurm", "python, slurm").is_err());
        assert!(may_skip("slurm", "pyton").is_err_and(|told| told.contains("'pyton'")));
    }
}
