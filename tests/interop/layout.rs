//! The layout that we ship for Foxglove and Lichtblick shows what is in the file of a weld.

use std::process::Command;

use artefact::Reader;
use serde_json::Value;

use crate::{program, root};

/// A plate that an arc melts, in a few steps.
const WELD: &str = r#"{
    "kind": "poolsph.scene", "version": 2, "title": "Spot", "spacing_m": 5e-4,
    "time": {"step_s": 1e-4, "end_s": 0.004}, "density_kg_m3": 7850,
    "bodies": [{"shape": {"box": {"min_m": [-2e-3, -2e-3, -1e-3], "max_m": [2e-3, 2e-3, 0]}}, "state": "solid",
        "temperature_k": 1700}],
    "flow": {"method": "projection", "viscosity_pa_s": 0.004, "gravity_m_s2": [0, 0, -9.8]},
    "source": {"start_m": [0, 0, 0], "velocity_m_s": [0, 0.005, 0]},
    "arc": {"flux_w_m2": {"expr": "4e8*exp(-(r/1e-3)^2)"}},
    "heat": {"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700,
        "melting": {"point_k": 1750, "latent_heat_j_kg": 250e3}},
    "output": {"particles_interval_s": 0.002,
        "pool": {"from_s": 0, "interval_s": 0.001, "beside_m": 1e-3, "behind_m": 1e-3, "ahead_m": 1e-3}}
}"#;

#[test]
fn the_layout_shows_topics_fields_and_values_of_a_weld() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (
        folder.path().join("weld.json"),
        folder.path().join("weld.mcap"),
    );
    std::fs::write(&scene, WELD).unwrap();
    let mut run = Command::new(program("poolsph"));
    run.arg("run").arg(&scene).arg("--out").arg(&out).arg("-q");
    // A little of its heat falls beside the plate, which is told.
    assert_eq!(run.status().unwrap().code(), Some(3));
    let reader = Reader::open(&out).unwrap();
    let text = std::fs::read_to_string(root().join("pipelines/foxglove.json")).unwrap();
    let layout: Value = serde_json::from_str(&text).unwrap();
    let panels = layout["configById"].as_object().unwrap();

    let clouds = panels["3D!weld"]["topics"].as_object().unwrap();
    let shown = clouds.values().filter(|topic| topic["visible"] == true);
    assert_eq!(shown.count(), 1, "one cloud hides another");
    for (topic, settings) in clouds {
        let channels = reader.channels();
        let channel = channels.iter().find(|c| c.name == *topic);
        assert_eq!(channel.unwrap().schema, artefact::POINT_CLOUD, "{topic}");
        let frames = reader.frames(topic).unwrap();
        let last = frames.last().unwrap().unwrap();
        let colour = last.f64(settings["colorField"].as_str().unwrap()).unwrap();
        let [low, high] = ["minValue", "maxValue"].map(|end| settings[end].as_f64().unwrap());
        assert!(colour.iter().all(|t| (low..=high).contains(t)), "{topic}");
        assert_eq!(settings["colorMode"], "colormap");
    }

    let path = panels["Plot!pool"]["paths"][0]["value"].as_str().unwrap();
    let (topic, rest) = path.split_once(".values[:]{name==\"").unwrap();
    let (name, rest) = rest.split_once("\"}").unwrap();
    assert_eq!(rest, ".value");
    let liquid = reader.record_at(topic, reader.count(topic) - 1).unwrap();
    assert!(liquid.get(name).unwrap() > 0.0, "nothing has melted");

    // Every panel of the arrangement is described.
    for side in ["first", "second"] {
        assert!(panels.contains_key(layout["layout"][side].as_str().unwrap()));
    }
}
