use super::*;
use shapes::Body;
use shapes::frame::{difference, dot};

fn cloud(body: &str, points: &str, dimensions: usize) -> Cloud {
    let body = Body::new(&serde_json::from_str(body).unwrap(), dimensions);
    Cloud::fill(&body, &serde_json::from_str(points).unwrap(), dimensions).unwrap()
}

fn corrected(cloud: &Cloud) -> Links {
    Links::new(cloud, Operator::Corrected(Corrected::default())).unwrap()
}

/// Greatest error of the balance of a linear field, over the heat that passes a point.
fn linear_error(cloud: &Cloud, links: &Links) -> f64 {
    let g = [0.3, -0.8, if cloud.dimensions == 3 { 0.5 } else { 0.0 }];
    let mut sum = vec![0.0; links.len()];
    let mut gross = vec![0.0; links.len()];
    for i in 0..links.len() {
        for k in links.pattern.row(i) {
            let j = links.pattern.columns()[k] as usize;
            let heat = links.weight[k] * dot(g, difference(cloud.position[j], cloud.position[i]));
            sum[i] += heat;
            gross[i] += heat.abs();
        }
    }
    for patch in &cloud.patches {
        sum[patch.point as usize] += patch.area * dot(g, patch.normal);
    }
    sum.iter()
        .zip(&gross)
        .fold(0.0, |m: f64, (s, g)| m.max(s.abs() / g))
}

const SQUARE: &str = r#"{"box": {"min_m": [0, 0], "max_m": [1, 1]}}"#;
const CUBE: &str = r#"{"box": {"min_m": [0, 0, 0], "max_m": [1, 1, 1]}}"#;
const HOLED: &str = r#"{"difference": [{"box": {"min_m": [0, 0], "max_m": [2, 2]}}, {"disc": {"centre_m": [1.1, 1], "radius_m": 0.5}}]}"#;

#[test]
fn a_lattice_is_exact_as_it_is() {
    for (body, spacing, dimensions) in [(SQUARE, "0.05", 2), (CUBE, "0.1", 3)] {
        let cloud = cloud(body, &format!(r#"{{"spacing_m": {spacing}}}"#), dimensions);
        let links = corrected(&cloud);
        assert_eq!(links.balance.unwrap().steps, 0);
        assert!(linear_error(&cloud, &links) < 1e-12);
        for (volume, share) in links.volume.iter().zip(&cloud.share) {
            assert!((volume - share).abs() < 1e-12 * share.max(1e-3));
        }
    }
}

#[test]
fn every_cloud_is_exact_for_linear_fields() {
    let ball = r#"{"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}}"#;
    let bar = r#"{"cylinder": {"centre_m": [0, 0, 0], "radius_m": 1, "length_m": 0.5}}"#;
    let disc = r#"{"disc": {"centre_m": [0, 0], "radius_m": 1}}"#;
    for (body, points, dimensions, volume) in [
        (SQUARE, r#"{"spacing_m": 0.05, "jitter": 0.1}"#, 2, 1.0),
        (
            SQUARE,
            r#"{"spacing_m": 0.05, "jitter": 0.3, "seed": 7}"#,
            2,
            1.0,
        ),
        (
            SQUARE,
            r#"{"spacing_m": 0.05, "grading": {"x": 1.05}}"#,
            2,
            1.0,
        ),
        (
            HOLED,
            r#"{"spacing_m": 0.06, "arrangement": "cut"}"#,
            2,
            4.0 - 0.25 * std::f64::consts::PI,
        ),
        (
            HOLED,
            r#"{"spacing_m": 0.06, "arrangement": "cut", "jitter": 0.3}"#,
            2,
            4.0 - 0.25 * std::f64::consts::PI,
        ),
        (disc, r#"{"spacing_m": 0.1}"#, 2, std::f64::consts::PI),
        (
            bar,
            r#"{"spacing_m": 0.125}"#,
            3,
            0.5 * std::f64::consts::PI,
        ),
        (
            ball,
            r#"{"spacing_m": 0.2}"#,
            3,
            4.0 / 3.0 * std::f64::consts::PI,
        ),
        (CUBE, r#"{"spacing_m": 0.1, "jitter": 0.3}"#, 3, 1.0),
    ] {
        let cloud = cloud(body, points, dimensions);
        let links = corrected(&cloud);
        let report = links.balance.unwrap();
        let error = linear_error(&cloud, &links);
        assert!(error < 1e-10, "{body} {points}: {error:e}, {report:?}");
        assert!(links.weight.iter().all(|a| *a >= 0.0));
        assert!(links.volume.iter().all(|v| *v > 0.0));
        let total: f64 = links.volume.iter().sum();
        assert!(
            (total - volume).abs() < 3e-3 * volume,
            "{body} {points}: {total}"
        );
        eprintln!("{points} {} points: {report:?}", links.len());
    }
}

#[test]
fn few_layers_of_rings_are_balanced() {
    let cloud = cloud(
        r#"{"cylinder": {"centre_m": [0, 0, 0], "radius_m": 15, "length_m": 2.5}}"#,
        r#"{"spacing_m": 1}"#,
        3,
    );
    let links = corrected(&cloud);
    let error = linear_error(&cloud, &links);
    assert!(error < 1e-10, "{error:e}");
}

#[test]
fn links_are_symmetric_to_the_bit() {
    let cloud = cloud(SQUARE, r#"{"spacing_m": 0.1, "jitter": 0.3}"#, 2);
    for operator in [Operator::Pair(Pair::default()), Operator::default()] {
        let links = Links::new(&cloud, operator).unwrap();
        let weight = |i: usize, j: usize| {
            let k = links
                .pattern
                .row(i)
                .find(|k| links.pattern.columns()[*k] as usize == j);
            links.weight[k.unwrap()]
        };
        for i in 0..links.len() {
            for k in links.pattern.row(i) {
                let j = links.pattern.columns()[k] as usize;
                assert_eq!(links.weight[k].to_bits(), weight(j, i).to_bits());
            }
        }
    }
}

#[test]
fn a_lone_point_is_named() {
    let mut cloud = cloud(SQUARE, r#"{"spacing_m": 0.5}"#, 2);
    cloud.position[0] = [9.0, 9.0, 0.0];
    let error = Links::new(&cloud, Operator::Pair(Pair::default())).unwrap_err();
    assert_eq!(error, OperatorError::Alone([9.0, 9.0, 0.0]));
}

#[test]
fn the_pair_form_is_exact_on_a_lattice_and_off_on_shifted_points() {
    for (points, exact) in [
        (r#"{"spacing_m": 0.1}"#, true),
        (r#"{"spacing_m": 0.1, "jitter": 0.1, "seed": 3}"#, false),
    ] {
        let cloud = cloud(SQUARE, points, 2);
        let links = Links::new(&cloud, Operator::Pair(Pair::default())).unwrap();
        let error = linear_error(&cloud, &links);
        assert_eq!(error < 1e-12, exact, "{points}: {error:e}");
    }
}

#[test]
fn corners_of_a_lattice_pass_heat_along_their_sides() {
    for (body, spacing, dimensions) in [(SQUARE, "0.05", 2), (CUBE, "0.1", 3)] {
        let cloud = cloud(body, &format!(r#"{{"spacing_m": {spacing}}}"#), dimensions);
        let links = corrected(&cloud);
        assert!(links.weight.iter().all(|a| *a >= 0.0));
        assert!(linear_error(&cloud, &links) < 1e-12);
        // No mixed derivative across the edges enters where two faces meet.
        for i in 0..links.len() {
            let x = cloud.position[i];
            let ends = |k: usize| x[k] < 1e-9 || x[k] > 1.0 - 1e-9;
            if !(ends(0) && ends(1)) || (dimensions == 3 && ends(2)) {
                continue;
            }
            let mixed: f64 = links
                .pattern
                .row(i)
                .map(|k| {
                    let d = difference(cloud.position[links.pattern.columns()[k] as usize], x);
                    links.weight[k] * d[0] * d[1]
                })
                .sum();
            assert!(mixed.abs() < 1e-12, "{x:?}: {mixed:e}");
        }
    }
}
