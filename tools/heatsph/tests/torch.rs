//! Torches on a half space against their exact solutions: a Gaussian on the surface (Eagar and Tsai 1983), and an ellipsoid, which
//! spreads as a Gaussian along each axis.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::f64::consts::PI;
use std::process::Command;

use artefact::Reader;
use serde_json::{Value, json};

const POWER: f64 = 1200.0;
const CONDUCTIVITY: f64 = 40.0;
/// rho c \[J/(m3 K)\].
const CAPACITY: f64 = 7800.0 * 500.0;
const SPEED: f64 = 0.01;
const END: f64 = 1.0;
const START: [f64; 3] = [-3e-3, -4e-3, 0.0];
const AHEAD: [f64; 3] = [0.6, 0.8, 0.0];

/// What a torch is like, and how its heat spreads.
struct Like {
    shape: Value,
    /// Along, across and into the body \[m2\].
    variance: [f64; 3],
    waveform: Option<Value>,
}

impl Like {
    /// Part of its power at a time \[s\].
    fn level(&self, time: f64) -> f64 {
        let Some(written) = &self.waveform else {
            return 1.0;
        };
        let of = |key: &str| written[key].as_f64().unwrap();
        let (period, peak) = (of("period_s"), written["times_s"][1].as_f64().unwrap());
        let [high, low] = [0, 2].map(|k| written["levels"][k].as_f64().unwrap());
        if time.rem_euclid(period) < peak {
            high
        } else {
            low
        }
    }
}

/// Rise of temperature at `x` \[K\] where the torch has the variances along, across and into the body \[m2\]: instantaneous sources
/// spread by 2 alpha s, mirrored at the surface, summed over the time s since then. With s = w^2 the integrand is smooth.
fn exact(x: [f64; 3], like: &Like) -> f64 {
    let variance = like.variance;
    const PIECES: usize = 4000;
    let diffusivity = CONDUCTIVITY / CAPACITY;
    let end = END.sqrt();
    let step = end / PIECES as f64;
    let across = [-AHEAD[1], AHEAD[0], 0.0];
    let at = |w: f64| {
        let s = w * w;
        let place: [f64; 3] =
            std::array::from_fn(|k| x[k] - START[k] - SPEED * (END - s) * AHEAD[k]);
        let along = |axis: [f64; 3]| (0..3).map(|k| place[k] * axis[k]).sum::<f64>();
        let own = [along(AHEAD), along(across), place[2]];
        let bell: f64 = (0..3)
            .map(|k| {
                let spread = variance[k] + 2.0 * diffusivity * s;
                (-own[k] * own[k] / (2.0 * spread)).exp() / (2.0 * PI * spread).sqrt()
            })
            .product();
        2.0 * like.level(END - s) * POWER / CAPACITY * bell * 2.0 * w
    };
    let sum: f64 = (0..PIECES).map(|k| at((k as f64 + 0.5) * step)).sum();
    sum * step
}

/// Greatest error of a run over the greatest rise.
fn error(spacing: f64, more: &Value, like: &Like) -> f64 {
    error_to(spacing, more, like, &|x| exact(x, like))
}

/// The same against any exact rise of temperature.
fn error_to(spacing: f64, more: &Value, like: &Like, exact: &dyn Fn([f64; 3]) -> f64) -> f64 {
    let mut points = json!({"spacing_m": spacing});
    let keys = points.as_object_mut().unwrap();
    keys.extend(more.as_object().unwrap().clone());
    let mut torch = json!({"power_w": POWER / 0.8, "efficiency": 0.8, "shape": like.shape,
        "path": {"points_m": [START, [3e-3, 4e-3, 0]], "speed_m_s": SPEED}});
    if let Some(waveform) = &like.waveform {
        torch["waveform"] = waveform.clone();
    }
    let scene = json!({
        "kind": "heatsph.scene", "version": 1, "dimensions": 3,
        "body": {"box": {"min_m": [-0.02, -0.02, -0.014], "max_m": [0.02, 0.02, 0]}},
        "points": points,
        "materials": [{"name": "steel", "density_kg_m3": 7800, "specific_heat_j_kg_k": 500, "conductivity_w_m_k": CONDUCTIVITY}],
        "initial_temperature_k": 300,
        "torches": [torch],
        "time": {"end_s": END, "implicit": {"tolerance": 1e-3}}
    });
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["scene.json", "out.mcap"].map(|name| folder.path().join(name));
    std::fs::write(&path, scene.to_string()).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_heatsph"))
        .arg("run")
        .arg(&path)
        .arg("--out")
        .arg(&out)
        .args(["--progress", "none", "--threads", "1"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let record: Value =
        serde_json::from_str(&std::fs::read_to_string(out.with_extension("run.json")).unwrap())
            .unwrap();
    let row = |name: &str| {
        let rows = record["closing"].as_array().unwrap();
        rows.iter().find(|row| row["name"] == name).unwrap()["value"]
            .as_f64()
            .unwrap()
    };
    // The power is exact, whatever the points.
    let times = (0..1000).map(|k| like.level((f64::from(k) + 0.5) * 1e-3 * END));
    let mean = times.sum::<f64>() / 1000.0;
    assert!((row("heat_stored") / (mean * POWER * END) - 1.0).abs() < 1e-3);
    let reader = Reader::open_kind(&out, "point-fields", 1).unwrap();
    let frame = reader
        .frame("/points", reader.count("/points") - 1)
        .unwrap();
    let places = frame.position_vectors().unwrap();
    let temperatures = frame.f64("temperature").unwrap();
    let mut greatest = [0.0_f64; 2];
    for (x, t) in places.iter().zip(temperatures) {
        let rise = exact(*x);
        greatest[0] = greatest[0].max((t - 300.0 - rise).abs());
        greatest[1] = greatest[1].max(rise);
    }
    greatest[0] / greatest[1]
}

#[test]
fn a_gaussian_on_a_half_space_warms_it_as_eagar_and_tsai_say() {
    let radius = 4e-3_f64;
    let across = radius * radius / 6.0;
    let like = Like {
        shape: json!({"gaussian": {"radius_m": radius}}),
        variance: [across, across, 0.0],
        waveform: None,
    };
    let errors = [2e-3, 1e-3].map(|spacing| error(spacing, &json!({}), &like));
    // Second order, or nearly: spacings of 1.2 and 0.6 standard deviations.
    assert!(
        errors[0] < 0.2 && errors[1] < 0.35 * errors[0],
        "{errors:?}"
    );
    let shaken = error(2e-3, &json!({"jitter": 0.2}), &like);
    assert!(shaken < 1.5 * errors[0], "{shaken}");
}

/// An ellipsoid with its waveform.
fn ellipsoid(waveform: Option<Value>) -> Like {
    let half = [4e-3_f64, 3e-3, 2.5e-3];
    Like {
        shape: json!({"double_ellipsoid": {"front_m": half[0], "rear_m": half[0],
            "half_width_m": half[1], "depth_m": half[2]}}),
        variance: half.map(|c| c * c / 6.0),
        waveform,
    }
}

#[test]
fn an_ellipsoid_in_a_half_space_warms_it_as_three_bells_do() {
    let like = ellipsoid(None);
    let errors = [2e-3, 1e-3].map(|spacing| error(spacing, &json!({}), &like));
    // Second order, or nearly: spacings of 1.2 and 0.6 standard deviations.
    assert!(
        errors[0] < 0.2 && errors[1] < 0.35 * errors[0],
        "{errors:?}"
    );
}

#[test]
fn pulses_warm_a_half_space_as_the_sum_of_their_instants_does() {
    // The last of five pulses is 0.12 s old at the end.
    let waveform = json!({"period_s": 0.2, "times_s": [0, 0.08, 0.08], "levels": [2, 2, 0]});
    let like = ellipsoid(Some(waveform));
    let errors = [2e-3, 1e-3].map(|spacing| error(spacing, &json!({}), &like));
    // The last pulse has spread by a standard deviation of 2.2 mm: two spacings, and one.
    assert!(
        errors[0] < 0.3 && errors[1] < 0.35 * errors[0],
        "{errors:?}"
    );
}

#[test]
fn two_unequal_halves_warm_a_half_space_as_torch_says() {
    let shape = json!({"double_ellipsoid": {"front_m": 2.5e-3, "rear_m": 6e-3, "half_width_m": 3e-3, "depth_m": 2.5e-3}});
    let goldak: torch::Shape = serde_json::from_value(shape.clone()).unwrap();
    let like = Like {
        shape,
        variance: [0.0; 3],
        waveform: None,
    };
    let plate = torch::Plate {
        conductivity_w_m_k: CONDUCTIVITY,
        capacity_j_m3_k: CAPACITY,
        ends_m: [[None; 2]; 2],
        thickness_m: None,
    };
    let exact = |x: [f64; 3]| {
        let away = [x[0] - START[0], x[1] - START[1]];
        let ahead = away[0] * AHEAD[0] + away[1] * AHEAD[1];
        let across = away[1] * AHEAD[0] - away[0] * AHEAD[1];
        POWER * plate.rise_per_watt(&goldak, SPEED, [ahead, across, -x[2]], END)
    };
    let errors = [2e-3, 1e-3].map(|spacing| error_to(spacing, &json!({}), &like, &exact));
    assert!(
        errors[0] < 0.2 && errors[1] < 0.35 * errors[0],
        "{errors:?}"
    );
}
