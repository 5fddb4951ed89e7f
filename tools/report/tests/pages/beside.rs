//! Pages of runs beside each other: the points of a sweep, and two runs.

use std::path::Path;
use std::process::Output;

use serde_json::{Value, json};

use super::{folder, report, sample};

/// Three arcs and a fourth that failed.
fn sweep(folder: &Path, unit: &str) -> Value {
    let point = |current: f64| {
        let file = folder.join(format!("{current}.mcap"));
        let failed = current > 350.0;
        if !failed {
            sample::arc_of(&file, current);
        }
        let made = json!([{"stage": "arc", "file": file}]);
        json!({
            "name": format!("current-{current}"),
            "values": [{"name": current.to_string(), "number": current}],
            "made": if failed { json!([]) } else { made },
            "failed": if failed { json!({"stage": "arc", "what": "too much"}) } else { Value::Null },
        })
    };
    let points: Vec<Value> = [100.0, 200.0, 300.0, 400.0]
        .into_iter()
        .map(point)
        .collect();
    json!({
        "kind": "sweep-points", "version": "1.0", "study": "arcs", "title": "Arcs",
        "parameters": [{"name": "current", "unit": "A"}],
        "figures": [
            {"name": "voltage", "unit": unit, "stage": "arc", "from": {"record": {"channel": "/balance", "value": "voltage_v"}}},
            {"name": "power", "unit": "kW", "factor": 1e-3, "stage": "arc",
             "from": {"record": {"channel": "/balance", "value": "power_w"}}}
        ],
        "whole": ["arc"],
        "points": points,
    })
}

fn written(folder: &Path, sweep: &Value) -> Output {
    let points = folder.join("points.json");
    std::fs::write(&points, sweep.to_string()).unwrap();
    let out = folder.join("sweep.html");
    report(&[
        "sweep",
        "--points",
        points.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ])
}

#[test]
fn all_points_of_a_sweep_stand_on_one_page_and_in_one_table() {
    let folder = folder("sweep");
    let output = written(&folder, &sweep(&folder, "V"));
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let html = std::fs::read_to_string(folder.join("sweep.html")).unwrap();
    for heading in [
        "The points",
        "Over what is swept",
        "Pictures: arc",
        "Curves: arc",
        "arc: 200 A",
    ] {
        assert!(html.contains(&format!(">{heading}</h2>")), "{heading}");
    }
    assert!(html.contains("1 of 4 points failed") && html.contains("arc: too much"));
    assert!(html.contains("voltage [V]") && html.contains("power [kW]"));
    let table = std::fs::read_to_string(folder.join("sweep.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert!(
        lines[0].starts_with(
            "point,current [A],voltage [V],power [kW],ended,arc balance: current_a [A],"
        ),
        "{table}"
    );
    assert!(
        lines[2].starts_with("current-200,200,31,9.45,made,200,31,9450,"),
        "{table}"
    );
    assert!(
        lines[4].starts_with("current-400,400,,,failed,,"),
        "{table}"
    );
    assert_eq!(lines.len(), 5);
    // The plot of the voltage has its numbers beside it.
    assert!(html.contains("current%20[A],voltage%20[V]%0A100,30.5%0A200,31%0A300,31.5%0A"));
    assert!(!html.contains("http:") && !html.contains("https:") && !html.contains("<script"));
}

#[test]
fn a_figure_in_another_unit_or_of_another_name_is_refused() {
    let folder = folder("figures");
    let output = written(&folder, &sweep(&folder, "kV"));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        !output.status.success() && said.contains("'kV'") && said.contains("factor"),
        "{said}"
    );
    let mut other = sweep(&folder, "V");
    other["figures"][0]["from"]["record"]["value"] = json!("voltage");
    let output = written(&folder, &other);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        !output.status.success() && said.contains("did you mean 'voltage_v'?"),
        "{said}"
    );
}

#[test]
fn a_sweep_tells_whatever_figures_a_run_wrote() {
    let folder = folder("greatest");
    let mut greatest = sweep(&folder, "V");
    let from = json!({"greatest": {"channel": "/surface", "column": "arc_pressure_pa"}});
    greatest["figures"][0] =
        json!({"name": "pressure", "unit": "Pa", "stage": "arc", "from": from});
    let output = written(&folder, &greatest);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let table = std::fs::read_to_string(folder.join("sweep.csv")).unwrap();
    let second = table.lines().nth(2).unwrap();
    let told: f64 = second.split(',').nth(2).unwrap().parse().unwrap();
    let reader = artefact::Reader::open(folder.join("200.mcap")).unwrap();
    let column = reader.table_at("/surface", 0).unwrap();
    let values = column.values("arc_pressure_pa").unwrap();
    let most = values.iter().copied().fold(0.0, f64::max);
    assert!((told / most - 1.0).abs() < 1e-6, "{table}");
    for (key, value, words) in [
        ("unit", json!("kPa"), "say \"factor\""),
        (
            "from",
            json!({"greatest": {"channel": "/surface", "column": "pressure"}}),
            "'pressure'",
        ),
        ("from", json!({"closing": "pressure"}), "pressure"),
    ] {
        let mut other = greatest.clone();
        other["figures"][0][key] = value;
        let output = written(&folder, &other);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains(words), "{said}");
    }
}

/// Two welds, one of which is too short for anything of it to have frozen.
fn unlike_welds(folder: &Path) -> [std::path::PathBuf; 2] {
    [("old", 8.0), ("young", 1.0)].map(|(name, end)| {
        let at = folder.join(name);
        std::fs::create_dir(&at).unwrap();
        sample::weld(&at.join("pool.mcap"), end, 4, true);
        at
    })
}

#[test]
fn beads_that_have_frozen_and_others_are_told_beside_the_page_of_a_sweep() {
    let folder = folder("unlike");
    let runs = unlike_welds(&folder);
    let point = |run: &std::path::PathBuf| {
        let name = run.file_name().unwrap().to_str().unwrap();
        json!({"name": name, "values": [{"name": name, "number": null}], "failed": null,
            "made": [{"stage": "pool", "file": run.join("pool.mcap")}]})
    };
    let figures =
        json!([{"name": "depth", "unit": "m", "stage": "pool", "from": {"bead": "penetration"}}]);
    let mut points = json!({
        "kind": "sweep-points", "version": "1.0", "study": "welds", "title": null, "whole": [],
        "parameters": [{"name": "weld", "unit": "1"}], "figures": figures,
        "points": runs.iter().map(point).collect::<Vec<_>>(),
    });
    let told = |points: &Value| -> Vec<String> {
        assert!(written(&folder, points).status.success());
        let text = std::fs::read_to_string(folder.join("sweep.told.json")).unwrap();
        serde_json::from_value(serde_json::from_str::<Value>(&text).unwrap()["told"].clone())
            .unwrap()
    };
    let unlike = told(&points);
    assert!(
        unlike.len() == 1 && unlike[0].contains("weld young") && !unlike[0].contains("weld old"),
        "{unlike:?}"
    );
    points["points"].as_array_mut().unwrap().truncate(1);
    assert!(told(&points).is_empty());
}

#[test]
fn a_figure_that_one_point_lacks_is_told_and_the_page_is_made() {
    let folder = folder("lacking");
    let mut sweep = sweep(&folder, "V");
    std::fs::create_dir(folder.join("weld")).unwrap();
    let weld = folder.join("weld/pool.mcap");
    sample::weld(&weld, 1.0, 2, true);
    sweep["points"][1]["made"] = json!([{"stage": "arc", "file": weld}]);
    assert!(written(&folder, &sweep).status.success());
    let text = std::fs::read_to_string(folder.join("sweep.told.json")).unwrap();
    assert!(
        text.contains("'voltage' is of 'arc', which is made and has none at: 200 A"),
        "{text}"
    );
    assert!(!text.contains("400 A"), "a point that failed: {text}");
}

#[test]
fn two_runs_whose_beads_are_unlike_end_with_a_warning() {
    let folder = folder("unlike pair");
    let [old, young] = unlike_welds(&folder);
    let compared = |a: &Path, b: &Path| {
        let out = folder.join("pair.html");
        let [a, b, out] = [a, b, &out].map(|path| path.to_str().unwrap());
        report(&["compare", "--a", a, "--b", b, "--out", out])
    };
    let output = compared(&old, &young);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(
        said.contains("has frozen") && said.contains("young"),
        "{said}"
    );
    assert_eq!(compared(&old, &old).status.code(), Some(0));
}

#[test]
fn two_runs_are_compared_by_what_was_changed_numbers_pictures_and_curves() {
    let folder = folder("pair");
    for (run, current, end) in [("thin", 200.0, 8.0), ("thick", 300.0, 6.0)] {
        let at = folder.join(run);
        std::fs::create_dir(&at).unwrap();
        sample::arc_of(&at.join("arc.mcap"), current);
        sample::weld(&at.join("pool.mcap"), end, 4, true);
    }
    sample::means(&folder.join("thick/mean.mcap"));
    let path = |name: &str| folder.join(name).display().to_string();
    let (a, b, out) = (path("thin"), path("thick"), path("pair.html"));
    let output = report(&["compare", "--a", &a, "--b", &b, "--out", &out]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let html = std::fs::read_to_string(&out).unwrap();
    assert!(html.contains("Only B has &#39;mean&#39;") || html.contains("Only B has 'mean'"));
    let rows = html
        .split("<tr")
        .find(|row| row.contains(">voltage<"))
        .unwrap();
    assert!(
        rows.contains("31.00")
            && rows.contains("31.50")
            && rows.contains("0.5000")
            && rows.contains("+1.6 %"),
        "{rows}"
    );
    for heading in [
        "Pictures: pool",
        "Curves: pool",
        "Pictures: arc",
        "Curves: arc",
    ] {
        assert!(html.contains(&format!(">{heading}</h2>")), "{heading}");
    }
    assert!(html.contains("pool: along the weld"));
    let table = std::fs::read_to_string(folder.join("pair.csv")).unwrap();
    assert!(
        table.starts_with("of,quantity,unit,thin,thick,difference\n"),
        "{table}"
    );
    assert!(
        table.contains("arc balance,voltage_v,V,31,31.5,0.5\n"),
        "{table}"
    );
    let none = report(&[
        "compare",
        "--a",
        &a,
        "--b",
        folder.join("none").to_str().unwrap(),
        "--out",
        &out,
    ]);
    assert!(!none.status.success());
}
