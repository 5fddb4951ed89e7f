//! Two makes beside each other: what both need is made once, and nothing that one has finished is lost by the other.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::script;

/// Makes `out` from `scene` in half a second, and ends with `code`.
fn begin(folder: &Path, code: u8) -> Child {
    let stage =
        format!("sleep 0.5; cp scene out.new; mv out.new out; echo run >> log; exit {code}");
    let mut command = Command::new(script());
    command
        .current_dir(folder)
        .stderr(Stdio::piped())
        .stdout(Stdio::null());
    command.args(["out", "scene", "--", "sh", "-c", &stage]);
    command.spawn().unwrap()
}

#[test]
fn the_second_waits_for_the_first_and_finds_all_made() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("scene"), "300 A").unwrap();
    let both = [begin(folder, 0), begin(folder, 0)];
    let said = both.map(|child| {
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    });
    assert!(
        said.concat()
            .contains("another make is making out: waiting for it"),
        "{said:?}"
    );
    assert_eq!(crate::runs(folder), 1);
}

#[test]
fn a_make_that_is_killed_leaves_no_lock() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("scene"), "300 A").unwrap();
    let mut child = begin(folder, 0);
    while !folder.join("out.begun").exists() {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let output = begin(folder, 0).wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(crate::runs(folder) >= 1);
}

/// Rules of which one fails after another make has finished its target meanwhile.
const RULES: &str = "
.DELETE_ON_ERROR:
RERUN = @pipelines/rerun $@ $(filter-out always,$^) --
.PHONY: always
out.mcap: scene always
\t$(RERUN) sh -c 'sleep 0.4; $(STAGE)'
";

#[test]
fn what_one_make_has_finished_is_not_deleted_where_another_fails() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("scene"), "300 A").unwrap();
    std::fs::create_dir(folder.join("pipelines")).unwrap();
    std::fs::copy(script(), folder.join("pipelines/rerun")).unwrap();
    std::fs::write(
        folder.join("Makefile"),
        format!("{RULES}.PRECIOUS: out.mcap\n"),
    )
    .unwrap();
    let make = |stage: &str| {
        let mut command = Command::new("make");
        command
            .current_dir(folder)
            .arg(format!("STAGE={stage}"))
            .arg("out.mcap");
        command.env_remove("MAKEFLAGS").env_remove("MAKELEVEL");
        command
            .stderr(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    let mut good = make("cp scene out.mcap");
    while !folder.join("out.mcap.begun").exists() {
        std::thread::sleep(Duration::from_millis(2));
    }
    let mut bad = make("exit 1");
    assert!(good.wait().unwrap().success());
    assert!(!bad.wait().unwrap().success());
    let kept = std::fs::read_to_string(folder.join("out.mcap"));
    assert_eq!(kept.unwrap(), "300 A");
}

#[test]
fn every_rule_of_the_studies_spares_what_it_makes() {
    let pipelines = script().with_file_name("");
    let mut rules = 0;
    for entry in std::fs::read_dir(pipelines).unwrap() {
        let path = entry.unwrap().path().join("rules.mk");
        let Ok(text) = std::fs::read_to_string(&path) else {
            continue;
        };
        // Lines that go on are one.
        let text = text.replace("\\\n", " ");
        let precious = text
            .lines()
            .filter_map(|line| line.strip_prefix(".PRECIOUS:"));
        let precious: Vec<&str> = precious.collect();
        let lines: Vec<&str> = text.lines().collect();
        for pair in lines
            .windows(2)
            .filter(|pair| pair[1].starts_with("\t$(RERUN)"))
        {
            rules += 1;
            let (target, from) = pair[0].split_once(": ").unwrap();
            let at = format!("{}: {target}", path.display());
            assert!(
                precious.iter().any(|names| names.contains(target)),
                "{at} is not .PRECIOUS"
            );
            assert!(
                from.split_whitespace().any(|name| name == "always"),
                "{at} is not asked always"
            );
        }
    }
    assert!(rules > 30, "{rules} rules");
}
