use std::time::Instant;

use super::*;
use shapes::frame::{difference, dot, length};

fn scene(text: &str) -> Scene {
    serde_json::from_str(text).unwrap()
}

/// A ball of radius 1 in a cube of edge 20.
fn ball(points: &str, more: &str) -> Scene {
    scene(&format!(
        r#"{{"geometry": "space", "domain": {{"box": {{"min_m": [-10, -10, -10], "max_m": [10, 10, 10]}}}},
        "bodies": [{{"name": "ball", "shape": {{"sphere": {{"centre_m": [0, 0, 0], "radius_m": 1}}}},
        "conductivity_s_m": 1e7}}], "points": {points}, "eddy_currents": {{"harmonic": {{"frequency_hz": 1e5}},
        "applied_flux_density_t": [0, 0, 1]}} {more}}}"#
    ))
}

/// Least distance to another point over the smaller spacing of the two, in the metric of the point; and the greatest
/// ratio of the spacings of points within a spacing of each other.
fn nearness(cloud: &Cloud) -> (f64, f64) {
    let mut order: Vec<usize> = (0..cloud.len()).collect();
    let key = |i: &usize| cloud.position[*i][0];
    order.sort_by(|a, b| key(a).total_cmp(&key(b)));
    let (mut least, mut grading) = (f64::INFINITY, 1.0_f64);
    for (n, i) in order.iter().enumerate() {
        for j in &order[n + 1..] {
            let d = difference(cloud.position[*j], cloud.position[*i]);
            let spacings = [cloud.spacing[*i], cloud.spacing[*j]];
            let small = spacings[0].min(spacings[1]);
            if d[0] > 1.5 * spacings[0].max(spacings[1]) {
                break;
            }
            if dot(d, d) > 1.44 * small * small {
                continue;
            }
            let scaled = |k: usize| match cloud.metric[k] {
                Metric::Round => length(d) / small,
                Metric::Layered {
                    normal,
                    across,
                    along,
                } => {
                    let up = dot(d, normal);
                    let flat = (dot(d, d) - up * up).max(0.0);
                    ((up / across).powi(2) + flat / (along * along)).sqrt()
                }
            };
            least = least.min(scaled(*i).max(scaled(*j)));
            if length(d) < small {
                grading = grading.max(spacings[0].max(spacings[1]) / small);
            }
        }
    }
    (least, grading)
}

#[test]
fn a_ball_in_a_cube() {
    let scene = ball(r#"{"spacing_m": 0.1, "layers": {"first_m": 0.02}}"#, "");
    let start = Instant::now();
    let cloud = Cloud::new(&scene).unwrap();
    println!(
        "{} points {:?} in {:?}",
        cloud.len(),
        cloud.counts,
        start.elapsed()
    );
    let mut area = 0.0;
    for s in &cloud.surface {
        let x = cloud.position[s.point as usize];
        assert!((length(x) - 1.0).abs() < 1e-14);
        assert!(length(difference(x, s.normal)) < 1e-14);
        assert_eq!((s.inner, s.outer), (1, 0));
        area += s.area;
    }
    assert!((area / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-12);
    let (least, grading) = nearness(&cloud);
    println!("nearest {least}, grading {grading}");
    assert!(least > 0.6 && grading <= 2.0);
    let volume: f64 = cloud.volume.iter().sum();
    let exact = 4.0 / 3.0 * std::f64::consts::PI;
    println!("volume {:e}", volume / exact - 1.0);
    assert!((volume / exact - 1.0).abs() < 1e-3);
    for k in 0..3 {
        let second: f64 = cloud
            .volume
            .iter()
            .zip(&cloud.centroid)
            .map(|(v, c)| v * c[k] * c[k])
            .sum();
        println!("second {:e}", second / (exact / 5.0) - 1.0);
        assert!((second / (exact / 5.0) - 1.0).abs() < 5e-3);
    }
}
