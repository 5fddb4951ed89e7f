//! Any bytes as a scene: refused with a place, or read; never a panic.

#![no_main]

use libfuzzer_sys::fuzz_target;
use run::property::Property;
use run::scene::{Expected, parse};
use schemars::JsonSchema;
use serde::Deserialize;

/// A scene with all that scenes are made of.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(dead_code, reason = "what is read is not used")]
struct Scene {
    length_m: f64,
    count: Option<u32>,
    property: Option<Property>,
    form: Option<Form>,
    list: Option<Vec<Scene>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[allow(dead_code, reason = "what is read is not used")]
enum Form {
    Plain,
    Box { min_m: [f64; 3], max_m: [f64; 3] },
}

const EXPECTED: Expected = Expected {
    kind: "fuzz.scene",
    version: 1,
    migrations: &[],
};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    match parse::<Scene>(text, EXPECTED) {
        Ok(loaded) => {
            if let Some(property) = &loaded.scene.property {
                let _ = property.compile("/property", &["x", "T"]);
            }
        }
        Err(failure) => assert!(!failure.to_string().is_empty()),
    }
});
