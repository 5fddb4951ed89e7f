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
