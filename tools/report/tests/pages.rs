//! Pages and verdicts from artefacts with known content.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

#[path = "pages/beside.rs"]
mod beside;
#[path = "pages/browser.rs"]
mod browser;
#[path = "pages/handover.rs"]
mod handover;
#[path = "pages/placed.rs"]
mod placed;
mod sample;
#[allow(unreachable_pub, reason = "it is public where it lives")]
#[path = "../../../tests/src/skipped.rs"]
mod skipped;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own that stays after the test, so that pages can be looked at.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn report(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_report"))
        .args(arguments)
        .output()
        .unwrap()
}

fn page(folder: &Path, inputs: &[(&str, &str)]) -> String {
    let out = folder.join("report.html");
    let mut words = vec!["page".to_owned(), "--study".to_owned(), "sample".to_owned()];
    words.extend(["--out".to_owned(), out.display().to_string()]);
    for (name, file) in inputs {
        words.extend([format!("--{name}"), folder.join(file).display().to_string()]);
    }
    let output = report(&words.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    std::fs::read_to_string(out).unwrap()
}

#[test]
fn a_whole_study_has_every_section_and_its_measures_are_those_of_the_sample() {
    let folder = folder("whole");
    sample::weld(&folder.join("pool.mcap"), 8.0, 5, true);
    sample::means(&folder.join("mean.mcap"));
    sample::arc(&folder.join("arc.mcap"));
    sample::targets(&folder.join("targets.json"), sample::DEEP);
    let inputs = [
        ("pool", "pool.mcap"),
        ("mean", "mean.mcap"),
        ("arc", "arc.mcap"),
        ("targets", "targets.json"),
    ];
    let html = page(&folder, &inputs);
    for heading in [
        "The bead",
        "Against experiment and simulation",
        "The flow in the pool",
        "The arc",
        "Mass and energy",
        "How it was computed",
    ] {
        assert!(html.contains(&format!(">{heading}</h2>")), "{heading}");
    }
    // The lowest fused particles have their centres 2.75 mm deep, their lower faces 3 mm.
    assert!(html.contains("<b>3.0 mm</b>"), "penetration");
    assert!(
        html.contains("All 3 measures that are judged agree"),
        "verdict"
    );
    assert!(html.matches("data:image/png;base64,").count() >= 8);
    assert!(html.contains("no key &apos;gas_shear&apos;") || html.contains("no key 'gas_shear'"));
    // Nothing is fetched: every source is embedded, every link is inside the page.
    assert!(!html.contains("http:") && !html.contains("https:") && !html.contains("<script "));
    assert_eq!(
        html.matches("<script>").count(),
        1,
        "the slider of the weld's frames"
    );
    assert_eq!(html.matches("<figcaption>2.000 s</figcaption>").count(), 1);
    assert_eq!(
        html.matches("src=\"").count(),
        html.matches("src=\"data:").count()
    );
}

#[test]
fn heat_maps_are_drawn_with_their_course_and_means_are_called_by_their_names() {
    let folder = folder("heat-maps");
    sample::means(&folder.join("mean.mcap"));
    sample::heat_maps(&folder.join("heat.mcap"), 10);
    let at = |file: &str| folder.join(file).display().to_string();
    let (out, flow, heat) = (at("report.html"), at("mean.mcap"), at("heat.mcap"));
    let (flow, heat) = (format!("--mean=slag={flow}"), format!("--mean=heat={heat}"));
    let words = ["page", "--study", "sample", "--out", &out, &flow, &heat];
    let output = report(&words);
    assert!(output.status.success(), "{output:?}");
    let html = std::fs::read_to_string(out).unwrap();
    for heading in ["The flow in the pool: slag", "The heat that metal gets"] {
        assert!(html.contains(&format!(">{heading}</h2>")), "{heading}");
    }
    assert!(!html.contains("The flow in the pool: heat"));
    // Powder alone brings heat: slag, which brings none, has neither a map nor a line.
    let told = &html[html.find(">The heat that metal gets</h2>").unwrap()..];
    assert!(told.contains("0.50 to 1.00 s") && told.contains("4.50 to 5.00 s"));
    assert!(
        told.contains("at the place 'middle'") || told.contains("at the place &#39;middle&#39;")
    );
    assert!(told.contains("powder") && !told.contains(">slag<"));
    assert_eq!(told.matches("<figcaption>0.50 s</figcaption>").count(), 1);
}

#[test]
fn what_is_absent_has_no_section() {
    let folder = folder("bare");
    sample::weld(&folder.join("pool.mcap"), 8.0, 2, false);
    let html = page(&folder, &[("pool", "pool.mcap")]);
    assert!(html.contains(">The bead</h2>"));
    for heading in ["The arc", "The flow in the pool", "Against experiment"] {
        assert!(!html.contains(&format!(">{heading}")), "{heading}");
    }
    assert!(!html.contains("close to melting") && !html.contains("temperature of liquid"));
}

#[test]
fn passes_stand_beside_each_other() {
    let folder = folder("passes");
    for (pass, end) in [("first", 8.0), ("second", 6.0)] {
        let at = |what: &str| folder.join(format!("{pass}-{what}.mcap"));
        sample::weld(&at("pool"), end, 2, true);
        sample::profile(&at("mean"), 1e-4 * end);
        sample::arc(&at("arc"));
    }
    let out = folder.join("report.html").display().to_string();
    let mut words = ["passes", "--study", "two", "--out", &out]
        .map(str::to_owned)
        .to_vec();
    for (kind, pass) in [
        ("arc", "first"),
        ("arc", "second"),
        ("pool", "first"),
        ("pool", "second"),
        ("mean", "first"),
        ("mean", "second"),
    ] {
        let file = folder.join(format!("{pass}-{kind}.mcap"));
        words.extend([format!("--{kind}"), format!("{pass}={}", file.display())]);
    }
    let output = report(&words.iter().map(String::as_str).collect::<Vec<_>>());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let html = std::fs::read_to_string(&out).unwrap();
    for heading in [
        "The surface of the pool",
        "What the arc does to it",
        "What comes of it",
        "The arcs beside each other",
        "How it was computed",
    ] {
        assert!(html.contains(&format!(">{heading}</h2>")), "{heading}");
    }
    // Two pools of 0.8 and 0.6 mm, and both beads 3 mm deep.
    let row = |words: &str| {
        let rows = html.split("<tr").find(|row| row.contains(words));
        rows.unwrap_or_else(|| panic!("no row of {words}"))
            .to_owned()
    };
    assert!(
        row("penetration below").matches("3.000").count() == 2,
        "{}",
        row("penetration below")
    );
    assert!(html.contains("0.8000") && html.contains("0.6000"), "depths");
    assert!(html.contains("pool: second"));
    let output = report(&["passes", "--study", "two", "--out", &out]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_young_weld_is_measured_but_not_judged() {
    let folder = folder("young");
    sample::weld(&folder.join("pool.mcap"), 1.0, 2, true);
    sample::targets(&folder.join("targets.json"), sample::DEEP);
    let html = page(
        &folder,
        &[("pool", "pool.mcap"), ("targets", "targets.json")],
    );
    assert!(html.contains("not judged: no part of this weld has frozen yet"));
    assert!(html.contains("Nothing of this weld has frozen"));
    let pool = folder.join("pool.mcap").display().to_string();
    let targets = folder.join("targets.json").display().to_string();
    let output = report(&["validate", "--pool", &pool, "--targets", &targets]);
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn validation_ends_with_one_where_a_tolerance_is_missed() {
    let folder = folder("validate");
    let pool = folder.join("pool.mcap");
    sample::weld(&pool, 8.0, 2, true);
    let targets = folder.join("targets.json");
    for (depth, code, words) in [
        (sample::DEEP, 0, "agrees within the tolerance"),
        (sample::DEEP + 1e-3, 1, "misses the tolerance: too small"),
    ] {
        sample::targets(&targets, depth);
        let (p, t) = (pool.display().to_string(), targets.display().to_string());
        let output = report(&["validate", "--pool", &p, "--targets", &t]);
        assert_eq!(output.status.code(), Some(code));
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(text.lines().count() == 5 && text.contains(words), "{text}");
    }
}

#[test]
fn verdicts_that_lost_their_bands_and_targets_that_judge_nothing_are_told() {
    let folder = folder("bands");
    let at = |name: &str| folder.join(name).display().to_string();
    sample::weld(&folder.join("pool.mcap"), 8.0, 2, true);
    sample::targets(&folder.join("targets.json"), sample::DEEP);
    let pool = artefact::Reader::open(folder.join("pool.mcap")).unwrap();
    let own = pool.header().scene_sha256();
    let validate = |targets: &str, hash: &str| {
        let certificate = serde_json::json!({"kind": "certificate", "version": "1.0", "study": "s", "least": null,
            "figures": {"penetration": {"stage": "pool", "unit": "m", "value": 2.9e-3, "extrapolated": 2.9e-3,
                "half_width": 1e-5, "scatter": null, "knobs": {}, "not_judged": []}},
            "points": [{"name": "base", "knob": null, "size": null, "patch": null, "figures": {}, "run_time_s": 1.0,
                "peak_memory_bytes": null, "points": null, "missing": null, "scenes": {"pool": hash}}]});
        std::fs::write(folder.join("certificate.json"), certificate.to_string()).unwrap();
        let (pool, targets, certificate) = (at("pool.mcap"), at(targets), at("certificate.json"));
        let words = [
            "validate",
            "--pool",
            &pool,
            "--targets",
            &targets,
            "--certificate",
            &certificate,
        ];
        let output = report(&words);
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    assert_eq!(validate("targets.json", &own), (Some(0), String::new()));
    let (code, said) = validate("targets.json", &"0".repeat(64));
    assert_eq!(code, Some(3), "{said}");
    assert!(
        said.contains("other scenes: penetration") && said.contains("STUDY=s"),
        "{said}"
    );
    let none = "{\"kind\": \"targets\", \"version\": \"1.0\", \"targets\": []}";
    std::fs::write(folder.join("none.json"), none).unwrap();
    let (code, said) = validate("none.json", &own);
    assert_eq!(code, Some(3), "{said}");
    assert!(said.contains("nothing is judged"), "{said}");
}

#[test]
fn targets_that_cannot_be_meant_are_refused_with_their_places() {
    let folder = folder("targets");
    let arc = folder.join("arc.mcap");
    sample::arc(&arc);
    let targets = folder.join("targets.json");
    let row = |measure: &str, unit: &str, tolerance: f64| {
        format!(
            "{{\"measure\": \"{measure}\", \"title\": \"t\", \"value\": 1, \"unit\": \"{unit}\", \
             \"source\": \"s\", \"kind\": \"experiment\", \"tolerance\": {tolerance}}}"
        )
    };
    let rows = [
        row("penetration", "mm", 1.0),
        row("dilution", "1", -0.5),
        row("penetraton", "m", 1.0),
        row("beauty", "1", 1.0),
        row("arc/power_w", "kW", 1.0),
        row("arc/powr_w", "W", 1.0),
        row("other/power_w", "kW", 1.0),
    ];
    let head = "{\"kind\": \"targets\", \"version\": \"1.0\", \"targets\": [\n";
    std::fs::write(&targets, format!("{head}{}\n]}}", rows.join(",\n"))).unwrap();
    let (file, arc) = (targets.display().to_string(), arc.display().to_string());
    let out = folder.join("x.html").display().to_string();
    for words in [
        vec!["validate", "--arc", &arc, "--targets", &file],
        vec![
            "page",
            "--study",
            "s",
            "--out",
            &out,
            "--arc",
            &arc,
            "--targets",
            &file,
        ],
    ] {
        let output = report(&words);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        let faults: Vec<&str> = said.lines().collect();
        let wanted = [
            "/targets/0/unit: is \"mm\", 'penetration' is in \"m\"",
            "/targets/1/tolerance: -0.5 1 is out of range: at least 0",
            "/targets/2/measure: 'penetraton' is not a known measure; did you mean 'penetration'?",
            "/targets/3/measure: 'beauty' is not a known measure; known are: penetration, ",
            "/targets/4/unit: is \"kW\", 'arc/power_w' is in \"W\"",
            "/targets/5/measure: 'arc/powr_w' is not a known measure; did you mean 'arc/power_w'?",
        ];
        assert_eq!(faults.len(), wanted.len(), "{said}");
        for (index, (fault, wanted)) in faults.iter().zip(wanted).enumerate() {
            let place = format!("targets.json:{}:", index + 2);
            assert!(
                fault.contains(&place) && fault.contains(wanted),
                "{fault}\n{wanted}"
            );
        }
    }
}

#[test]
fn a_file_of_another_kind_is_refused_by_name() {
    let folder = folder("kind");
    sample::arc(&folder.join("arc.mcap"));
    let file = folder.join("arc.mcap").display().to_string();
    let out = folder.join("x.html").display().to_string();
    let output = report(&["page", "--study", "s", "--out", &out, "--pool", &file]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("arc-source") && said.contains("particle-frames"),
        "{said}"
    );
}

fn heat(folder: &Path, runs: &[(&str, &str)]) -> (Output, PathBuf) {
    let out = folder.join("report.html");
    let mut words = vec!["heat".to_owned(), "--study".to_owned(), "sample".to_owned()];
    words.extend(["--out".to_owned(), out.display().to_string()]);
    for (name, file) in runs {
        let file = folder.join(file).display().to_string();
        words.extend(["--frames".to_owned(), format!("{name}={file}")]);
    }
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    (report(&words), out)
}

#[test]
fn a_study_of_heat_shows_fields_curves_and_balances_of_every_run() {
    let folder = folder("heat");
    sample::disc(&folder.join("cold.mcap"), 1000.0);
    sample::disc(&folder.join("hot.mcap"), 1100.0);
    let (output, out) = heat(&folder, &[("cold", "cold.mcap"), ("hot", "hot.mcap")]);
    assert!(output.status.success(), "{output:?}");
    let html = std::fs::read_to_string(out).unwrap();
    for heading in [
        "The temperature at the end",
        "Temperatures over time",
        "Heat through the surface",
        "The balance of heat",
        "How it was computed",
    ] {
        assert!(html.contains(&format!(">{heading}</h2>")), "{heading}");
    }
    // After 4 s the centre is at the start less 80 K, the rim at the start less 48 K.
    for cell in ["920.0", "952.0", "1020.0", "1052.0", "32.0"] {
        assert!(html.contains(&format!(">{cell}</td>")), "{cell}");
    }
    assert_eq!(html.matches("data:image/png;base64,").count(), 2);
    // Under each picture, and in it for those who cannot see it.
    assert_eq!(html.matches("half a section through the axis").count(), 4);
    assert!(html.contains("Isotherms every 5 K. Dashed: where one material meets another."));
    // Monitors of all and of each run, three plots of the surface, two balances and the imbalance, two
    // histories of residuals.
    assert_eq!(html.matches("<svg").count(), 11);
    assert!(html.contains("cold: centre") && html.contains("hot: side"));
    // 2.8e-7 J of 140 J.
    assert!(html.contains("relative imbalance [10\u{207b}\u{2079}]"));
    assert!(html.contains("heatsph 0.1.0: cold") && html.contains("no key 'gas_shear'"));
    assert!(!html.contains("http:") && !html.contains("https:") && !html.contains("<script"));
}

#[test]
fn a_steady_plane_body_has_its_field_and_nothing_over_time() {
    let folder = folder("steady");
    sample::plate(&folder.join("plate.mcap"));
    let (output, out) = heat(&folder, &[("plate", "plate.mcap")]);
    assert!(output.status.success(), "{output:?}");
    let html = std::fs::read_to_string(out).unwrap();
    assert!(html.contains("The temperature in the steady state in the plane of the body"));
    assert!(html.contains(">302.00</td>") && !html.contains("Dashed"));
    for heading in ["Temperatures over time", "Heat through", "The balance"] {
        assert!(!html.contains(heading), "{heading}");
    }
    assert!(!html.contains("<svg"));
}

#[test]
fn a_page_of_heat_refuses_another_kind_and_files_without_a_name() {
    let folder = folder("heat-kind");
    sample::arc(&folder.join("arc.mcap"));
    let (output, _) = heat(&folder, &[("arc", "arc.mcap")]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("arc-source") && said.contains("point-fields"),
        "{said}"
    );
    let output = report(&[
        "heat", "--study", "s", "--out", "x.html", "--frames", "a.mcap",
    ]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("NAME=FILE"));
}

#[test]
fn the_index_plots_errors_and_links_studies() {
    let folder = folder("index");
    let put = |path: &str, value: serde_json::Value| {
        let path = folder.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, value.to_string()).unwrap();
    };
    let level = |n: f64, e: f64| {
        serde_json::json!({"points": n * n, "spacing_m": 0.01 / n, "steps": 10.0 * n, "run_time_s": 1e-5 * n.powi(3), "threads": 2,
            "errors": {"temperature_linf": e / (n * n), "velocity_l2": 10.0 * e / (n * n), "flux": null}})
    };
    put(
        "verify/plate.json",
        serde_json::json!({"case": "plate", "tool": "poolsph", "reference": "somebody (1959)",
        "levels": [level(20.0, 1.0), level(40.0, 1.0), level(80.0, 1.0)], "order": {"temperature_linf": 2.0, "velocity_l2": 2.0, "flux": null},
        "targets": {"temperature_linf": {"at_points": 6400, "max": 1e-3, "found": 1.6e-4, "holds": true}}, "holds": true,
        "series": [{"method": "sor", "levels": [level(20.0, 2.0), level(40.0, 2.1)], "order": {"temperature_linf": 1.9}}]}),
    );
    put(
        "stability/stiff.json",
        serde_json::json!({"case": "stiff", "tool": "poolsph", "holds": false, "runs": [
        {"name": "large-step", "parameters": {"time": {"step_s": 1.0}}, "outcome": "failed", "expected": ["refused"],
         "limits": [{"name": "step_viscosity", "value": 1e-3, "unit": "s"}], "conservation": [], "message": "boom", "holds": false}]}),
    );
    put(
        "bench/speed.json",
        serde_json::json!({"threads": 2, "figures": [{"name": "pair sweep", "ns": 3.25}]}),
    );
    put("studies/gmaw/report.html", serde_json::json!("x"));
    put("verify/broken.json", serde_json::json!({"case": 1}));
    let at = |name: &str| folder.join(name).display().to_string();
    let output = report(&[
        "index",
        "--out",
        &at("report/index.html"),
        "--verify",
        &at("verify"),
        "--stability",
        &at("stability"),
        "--bench",
        &at("bench"),
        "--studies",
        &at("studies"),
    ]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let html = std::fs::read_to_string(folder.join("report/index.html")).unwrap();
    assert!(html.contains("../studies/gmaw/report.html"));
    assert!(html.contains("1 of 1 cases meet all of their targets"));
    assert!(html.contains("0 of 1 runs with stiff or extreme parameters"));
    assert!(html.contains("broken.json is not a record that can be shown"));
    assert!(html.contains("pair sweep") && html.contains("3.250"));
    // Two methods: a pair of plots for each of the two quantities that have numbers.
    assert_eq!(html.matches("<svg").count(), 4);
}

#[test]
fn what_was_not_run_is_not_judged_and_failing_machines_have_a_table() {
    let folder = folder("open");
    let put = |path: &str, value: serde_json::Value| {
        let path = folder.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, value.to_string()).unwrap();
    };
    put(
        "verify/short.json",
        serde_json::json!({"case": "short", "tool": "poolsph", "reference": "somebody (1959)", "holds": false,
        "levels": [{"points": 400, "run_time_s": 0.1, "errors": {"temperature_linf": 2e-3}}], "order": {},
        "targets": {"temperature_linf": {"at_level": 3, "max": 1e-3, "found": null, "holds": null}}}),
    );
    put(
        "faults/faults.json",
        serde_json::json!({"kind": "faults", "version": "1.0", "seed": 7, "holds": true, "rows": [{"fault": "killed at a random moment",
        "who": "avg", "times": 30, "expected": "the same bytes", "found": "the same bytes", "holds": true}]}),
    );
    let at = |name: &str| folder.join(name).display().to_string();
    let [out, verify, faults] = ["index.html", "verify", "faults"].map(at);
    let output = report(&[
        "index", "--out", &out, "--verify", &verify, "--faults", &faults,
    ]);
    assert!(output.status.success(), "{output:?}");
    let html = std::fs::read_to_string(out).unwrap();
    assert!(html.contains("0 of 1 cases meet all of their targets. 1 are not judged"));
    assert!(html.contains("not judged: level 3 was not run") && !html.contains("targets missed"));
    assert!(html.contains("30 kills at random moments (seed 7)"));
}

#[test]
fn a_live_page_shows_what_a_stage_has_written_and_renews_itself_while_it_runs() {
    let folder = folder("live");
    sample::weld(&folder.join("whole"), 8.0, 5, true);
    let bytes = std::fs::read(folder.join("whole")).unwrap();
    // The end is not written yet.
    let part = folder.join("pool.mcap.part");
    std::fs::write(&part, &bytes[..bytes.len() * 9 / 10]).unwrap();
    let out = folder.join("live.html");
    let words = [
        "live",
        folder.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ];
    let once = [&words[..], &["--once"]].concat();
    assert!(report(&once).status.success());
    let html = std::fs::read_to_string(&out).unwrap();
    assert!(html.contains("Running: pool") && html.contains("simulated") && html.contains("<img"));
    assert!(!html.contains("http-equiv"));
    let mut child = Command::new(env!("CARGO_BIN_EXE_report"))
        .args(words)
        .args(["--every-s", "1"])
        .spawn()
        .unwrap();
    let renews = || {
        let html = std::fs::read_to_string(&out).unwrap_or_default();
        html.contains("http-equiv=\"refresh\" content=\"1\"")
    };
    let mut waited = 0;
    while !renews() && waited < 200 {
        std::thread::sleep(std::time::Duration::from_millis(100));
        waited += 1;
    }
    assert!(renews());
    // Once nothing runs any more it ends, and is not loaded anew.
    std::fs::remove_file(&part).unwrap();
    assert!(child.wait().unwrap().success());
    let html = std::fs::read_to_string(&out).unwrap();
    assert!(html.contains("No stage is running") && !html.contains("http-equiv"));
}

#[test]
fn the_page_of_all_evidence_is_no_page_of_a_study() {
    let folder = folder("evidence");
    let study = folder.join("weld");
    std::fs::create_dir_all(&study).unwrap();
    let page = study.join("report.html");
    std::fs::write(&page, "<html>the weld</html>").unwrap();
    let words = |out: &Path| {
        report(&[
            "index",
            "--studies",
            folder.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
        ])
    };
    let refused = words(&page);
    assert_eq!(refused.status.code(), Some(2));
    assert_eq!(
        std::fs::read_to_string(&page).unwrap(),
        "<html>the weld</html>"
    );
    // A pipe is no record, and nothing waits for it.
    let pipe = study.join("arc.run.json");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    assert!(words(&folder.join("all.html")).status.success());
}
