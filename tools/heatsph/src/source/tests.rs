use run::property::{Formula, Property};

use super::*;
use crate::operator::{Links, Operator};

fn curve(text: &str) -> Curve {
    let formula = Property::Formula(Formula {
        expr: text.to_owned(),
    });
    formula
        .compile("/source", &["x", "y", "z", "r", "T", "t"])
        .unwrap()
}

/// Heat of a source in a body, and the volume of its points.
fn heat(body: &str, points: &str, dimensions: usize, text: &str) -> (Vec<f64>, Vec<f64>) {
    let body = Body::new(&serde_json::from_str(body).unwrap(), dimensions);
    let cloud = Cloud::fill(&body, &serde_json::from_str(points).unwrap(), dimensions).unwrap();
    let volume = Links::new(&cloud, Operator::default()).unwrap().volume;
    let source = Source::new(curve(text), &cloud, &volume, &body).unwrap();
    let cold = vec![0.0; volume.len()];
    let mut heat = Vec::new();
    let cold = Warmth {
        temperature: &cold,
        cells: &[],
        time: 0.0,
    };
    let resolved = source.heat(&cloud, &volume, cold, &mut heat).unwrap();
    assert!(resolved, "{text}");
    (heat, volume)
}

const SQUARE: &str = r#"{"box": {"min_m": [0, 0], "max_m": [1, 1]}}"#;
const CUBE: &str = r#"{"box": {"min_m": [0, 0, 0], "max_m": [1, 1, 1]}}"#;
const DISC: &str = r#"{"disc": {"centre_m": [0.5, 0.5], "radius_m": 0.6}}"#;

#[test]
fn a_narrow_source_brings_its_whole_power_wherever_it_lies() {
    for (body, points, dimensions) in [
        (SQUARE, r#"{"spacing_m": 0.1}"#, 2),
        (SQUARE, r#"{"spacing_m": 0.1, "jitter": 0.3}"#, 2),
        (SQUARE, r#"{"spacing_m": 0.1, "grading": {"x": 1.1}}"#, 2),
        (DISC, r#"{"spacing_m": 0.1}"#, 2),
        (DISC, r#"{"spacing_m": 0.1, "arrangement": "cut"}"#, 2),
        (CUBE, r#"{"spacing_m": 0.2}"#, 3),
        (CUBE, r#"{"spacing_m": 0.2, "jitter": 0.2}"#, 3),
    ] {
        for place in [[0.5, 0.5, 0.5], [0.45, 0.55, 0.41], [0.437, 0.612, 0.333]] {
            for width in [0.1, 0.03, 1e-2, 1e-3] {
                let [x, y, z] = place;
                let far = format!("(x - {x})^2 + (y - {y})^2");
                let far = if dimensions == 3 {
                    format!("{far} + (z - {z})^2")
                } else {
                    far
                };
                let (heat, _) = self::heat(
                    body,
                    points,
                    dimensions,
                    &format!("7*exp(-({far})/{width}^2)"),
                );
                let root = width * std::f64::consts::PI.sqrt();
                let exact = 7.0 * root.powi(dimensions as i32);
                let sum: f64 = heat.iter().sum();
                assert!(
                    (sum / exact - 1.0).abs() < 0.01,
                    "{body} {points} {place:?} {width}: {sum} of {exact}"
                );
            }
        }
    }
}

#[test]
fn a_disc_and_a_pair_of_opposite_sources_keep_their_power() {
    let (disc, _) = heat(
        SQUARE,
        r#"{"spacing_m": 0.1}"#,
        2,
        "if(0.02 - hypot(x - 0.33, y - 0.41), 5, 0)",
    );
    let exact = 5.0 * std::f64::consts::PI * 4e-4;
    let sum: f64 = disc.iter().sum();
    assert!((sum / exact - 1.0).abs() < 0.01, "{sum} of {exact}");
    let bell = |x: f64| format!("exp(-((x - {x})^2 + (y - 0.27)^2)/1e-4)");
    let both = format!("{} - {}", bell(0.21), bell(0.77));
    let (pair, _) = heat(SQUARE, r#"{"spacing_m": 0.1, "jitter": 0.3}"#, 2, &both);
    let exact = std::f64::consts::PI * 1e-4;
    let above: f64 = pair.iter().filter(|q| **q > 0.0).sum();
    let below: f64 = pair.iter().filter(|q| **q < 0.0).sum();
    assert!((above / exact - 1.0).abs() < 0.01 && (below / exact + 1.0).abs() < 0.01);
}

#[test]
fn a_source_that_is_the_same_everywhere_heats_evenly() {
    let points = r#"{"spacing_m": 0.1, "jitter": 0.3}"#;
    for text in ["3", "3 + 0*x", "3 + T + t"] {
        let (heat, volume) = self::heat(SQUARE, points, 2, text);
        // The same rise of temperature at every point.
        let each: Vec<f64> = heat.iter().zip(&volume).map(|(q, v)| q / v).collect();
        let (low, high) = crate::system::extent(&each);
        assert!(
            high - low < 1e-12 * high && (high / 3.0 - 1.0).abs() < 0.01,
            "{text}: {low} {high}"
        );
    }
}

#[test]
fn a_smooth_source_is_of_second_order_at_the_points() {
    for points in [r#"{"spacing_m": 0.1}"#, r#"{"spacing_m": 0.05}"#] {
        let body = Body::new(&serde_json::from_str(SQUARE).unwrap(), 2);
        let cloud = Cloud::fill(&body, &serde_json::from_str(points).unwrap(), 2).unwrap();
        let (heat, volume) = self::heat(SQUARE, points, 2, "1 + sin(3*x)*cos(2*y)");
        let inner = |i: &usize| {
            cloud.position[*i][..2]
                .iter()
                .all(|x| *x > 0.01 && *x < 0.99)
        };
        for i in (0..heat.len()).filter(inner) {
            let [x, y, _] = cloud.position[i];
            let exact = 1.0 + (3.0 * x).sin() * (2.0 * y).cos();
            let h = cloud.spacing[i];
            assert!(
                (heat[i] / volume[i] - exact).abs() < h * h,
                "{points} {x} {y}"
            );
        }
    }
}
