//! A page about a study that is running: what its stage has written so far. It renews itself.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use run::Failure;

use super::beside::{Member, curves, pictures};
use super::tiles;
use crate::draw::axes::number;
use crate::files::{LiveFiles, save};
use crate::html::{Page, note, paragraph};

/// So many renewals without a stage that runs end the page.
const PATIENCE: u32 = 6;
/// A stage that has written nothing for so long may have ended \[s\].
const QUIET: u64 = 600;
/// Ending of what is not whole yet.
const PART: &str = ".mcap.part";

/// Writes the page again and again, until nothing runs any more.
pub(crate) fn write(files: &LiveFiles) -> Result<(), Failure> {
    let pause = Duration::from_secs_f64(files.every_s);
    let mut idle = 0;
    loop {
        let running = parts(&files.folder)?;
        idle = if running.is_empty() { idle + 1 } else { 0 };
        let ends = files.once || idle > PATIENCE;
        let mut page = page(files, &running);
        if !ends {
            page.renew(files.every_s);
        }
        save(&files.out, &page.render())?;
        if ends {
            return Ok(());
        }
        std::thread::sleep(pause);
    }
}

/// A stage that writes: its name, its file, and when it last wrote.
struct Running {
    stage: String,
    path: PathBuf,
    since: Duration,
}

/// What is being written in a folder, the latest first.
fn parts(folder: &Path) -> Result<Vec<Running>, Failure> {
    let listed = std::fs::read_dir(folder).map_err(|source| Failure::Io {
        path: folder.to_owned(),
        action: "list",
        source,
    })?;
    let mut found = Vec::new();
    for entry in listed.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let written = entry.metadata().and_then(|of| of.modified());
        if let (Some(stage), Ok(written)) = (name.strip_suffix(PART), written) {
            found.push(Running {
                stage: stage.to_owned(),
                path: entry.path(),
                since: SystemTime::now()
                    .duration_since(written)
                    .unwrap_or_default(),
            });
        }
    }
    found.sort_by_key(|running| running.since);
    Ok(found)
}

fn page(files: &LiveFiles, running: &[Running]) -> Page {
    let study = files
        .folder
        .file_name()
        .unwrap_or_default()
        .to_string_lossy();
    let lead = match running {
        [] => "No stage is running here.".to_owned(),
        all => {
            let names: Vec<&str> = all.iter().map(|one| one.stage.as_str()).collect();
            format!(
                "Running: {}. What stands here has been written so far.",
                names.join(", ")
            )
        }
    };
    let mut page = Page::new(&format!("{study}, live"), &paragraph(&lead));
    for one in running {
        let body = body(one).unwrap_or_else(|failure| {
            // A chunk may be half written at this moment.
            note(&format!("Nothing of it can be read yet: {failure}"))
        });
        page.section(&one.stage, body);
    }
    page
}

/// Figures, pictures and curves of a stage.
fn body(running: &Running) -> Result<String, Failure> {
    let member = Member::part(&running.stage, &running.path)?;
    let Some(stage) = member.stage(&running.stage) else {
        return Ok(String::new());
    };
    let reader = &stage.reader;
    let mut facts = Vec::new();
    let times = reader.channels().into_iter();
    let times = times.filter_map(|channel| reader.times(&channel.name).ok()?.last().copied());
    if let Some(time) = times.reduce(f64::max) {
        facts.push((format!("{} s", number(time)), "simulated".to_owned()));
    }
    let end = reader.header().scene.pointer("/time/end_s");
    if let Some(end) = end.and_then(serde_json::Value::as_f64) {
        facts.push((format!("{} s", number(end)), "wanted".to_owned()));
    }
    let since = running.since.as_secs();
    facts.push((format!("{since} s"), "since it last wrote".to_owned()));
    let mut body = tiles(&facts);
    if since > QUIET {
        body +=
            &note("It has written nothing for long: perhaps its program is not running any more.");
    }
    let member = [member];
    body += &pictures::section(&member, &running.stage)?;
    body += &curves::section(&member, &running.stage)?;
    Ok(body)
}
