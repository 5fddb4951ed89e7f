//! `make preview`: a look at what the stages of a study would begin with.

use super::study::Workshop;

#[test]
fn a_look_takes_the_stages_that_have_points_and_runs_nothing() {
    let workshop = Workshop::new();
    let made = workshop.ask(&["preview", "STUDY=gmaw-quick"]);
    let said =
        String::from_utf8_lossy(&made.stdout).into_owned() + &String::from_utf8_lossy(&made.stderr);
    assert!(made.status.success(), "{said}");
    assert!(
        said.contains("to look at: build/gmaw-quick/preview.html"),
        "{said}"
    );
    let log = std::fs::read_to_string(workshop.root.join("log")).unwrap();
    assert_eq!(
        log.lines().collect::<Vec<_>>(),
        ["arcfvm", "poolsph", "report"]
    );
    for made in [
        "preview/gmaw-300a-arc.mcap",
        "preview/pool.mcap",
        "preview.html",
    ] {
        let path = workshop.root.join("build/gmaw-quick").join(made);
        assert!(path.is_file(), "{made}");
    }
    // The scene and the patch of the rules, but no output of a run.
    let pool = workshop.root.join("build/gmaw-quick/preview/pool.mcap");
    let looked = std::fs::read_to_string(pool).unwrap();
    for file in ["gmaw-300a/pool.json", "gmaw-quick/pool.patch.json"] {
        let text = std::fs::read_to_string(workshop.root.join("pipelines").join(file)).unwrap();
        let line = text.lines().find(|line| line.contains("time")).unwrap();
        assert!(looked.contains(line), "{file}");
    }
    assert!(!workshop.root.join("build/gmaw-300a").exists());
    assert!(!workshop.root.join("build/gmaw-quick/pool.mcap").exists());
}

#[test]
fn what_is_no_study_is_said() {
    let workshop = Workshop::new();
    for study in ["STUDY=gmaw-fast", "STUDY=", "STUDY=../x"] {
        let made = workshop.ask(&["preview", study]);
        let said = String::from_utf8_lossy(&made.stderr);
        assert!(
            !made.status.success() && said.contains("make preview:"),
            "{said}"
        );
    }
}
