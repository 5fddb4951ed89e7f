//! `make new`: an own study begins as a copy of another that works.

use std::process::Output;

use super::study::Workshop;

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
}

#[test]
fn a_copy_works_and_is_a_study_of_its_own() {
    let workshop = Workshop::new();
    let all = ["gasprop", "arcfvm", "poolsph", "avg", "report"];
    assert_eq!(workshop.programs_of("gmaw-quick"), all);
    let made = workshop.ask(&["new", "STUDY=my-weld", "FROM=gmaw-quick"]);
    assert!(made.status.success(), "{}", told(&made));
    assert!(told(&made).contains("make my-weld"), "{}", told(&made));
    // The arc is that of gmaw-300a, and made already.
    assert_eq!(workshop.programs_of("my-weld"), &all[2..]);
    assert!(workshop.root.join("build/my-weld/report.html").exists());
    workshop.add("my-weld/pool.patch.json", "another current");
    assert!(workshop.programs_of("gmaw-quick").is_empty());
    assert_eq!(workshop.programs_of("my-weld"), &all[2..]);
    let rules = std::fs::read_to_string(workshop.root.join("pipelines/my-weld/rules.mk")).unwrap();
    assert!(!rules.contains("gmaw-quick"), "{rules}");
    assert!(rules.contains("--study my-weld"), "{rules}");
}

#[test]
fn every_study_can_be_copied_and_no_rule_is_said_twice() {
    let workshop = Workshop::new();
    let mut names = Vec::new();
    for entry in std::fs::read_dir(workshop.root.join("pipelines")).unwrap() {
        let folder = entry.unwrap().path();
        if folder.join("rules.mk").exists() {
            names.push(folder.file_name().unwrap().to_str().unwrap().to_owned());
        }
    }
    assert!(names.len() > 15, "{names:?}");
    for name in &names {
        let study = format!("STUDY=own-{name}");
        let made = workshop.ask(&["new", &study, &format!("FROM={name}")]);
        assert!(made.status.success(), "{name}: {}", told(&made));
    }
    for name in &names {
        let plan = workshop.ask(&["-n", &format!("own-{name}")]);
        let said = told(&plan);
        assert!(plan.status.success(), "{name}: {said}");
        assert!(!said.contains("overriding"), "{name}: {said}");
        let page = format!("build/own-{name}/");
        assert!(said.contains(&page), "{name}: nothing is made in {page}");
        // Alike the plans of both, but for the name.
        let alike = |said: &str| said.replace(&format!("own-{name}"), name);
        let first = told(&workshop.ask(&["-n", name]));
        assert_eq!(alike(&said), first, "{name}");
    }
}

#[test]
fn what_is_there_is_kept_and_what_is_wrong_is_said() {
    let workshop = Workshop::new();
    for (words, said) in [
        (["STUDY=gmaw-300a", "FROM=gmaw-quick"], "is there already"),
        (["STUDY=my-weld", "FROM=gmaw-fast"], "gmaw-quick"),
        (["STUDY=my-weld", "FROM=gmaw-quick/"], "no such study"),
        (["STUDY=My weld", "FROM=gmaw-quick"], "small letters"),
        (["STUDY=../weld", "FROM=gmaw-quick"], "small letters"),
        (["STUDY=verify", "FROM=gmaw-quick"], "already"),
        (["STUDY=lint", "FROM=gmaw-quick"], "already"),
        (["STUDY=", "FROM="], "say both"),
    ] {
        let [study, from] = words;
        let made = workshop.ask(&["new", study, from]);
        assert!(!made.status.success(), "{words:?}");
        assert!(told(&made).contains(said), "{words:?}: {}", told(&made));
    }
    let left = std::fs::read_dir(workshop.root.join("pipelines")).unwrap();
    let left: Vec<_> = left.map(|e| e.unwrap().file_name()).collect();
    let hidden = |name: &&std::ffi::OsString| name.to_string_lossy().starts_with('.');
    assert!(!left.iter().any(|name| hidden(&name)), "{left:?}");
}
