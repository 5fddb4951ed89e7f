use super::*;
use shapes::frame::length;

fn cloud(body: &str, points: &str, dimensions: usize) -> Cloud {
    let body = Body::new(&serde_json::from_str(body).unwrap(), dimensions);
    Cloud::fill(&body, &serde_json::from_str(points).unwrap(), dimensions).unwrap()
}

/// Volume by Gauss' theorem, sum of shares, sum of area times normal.
fn sums(cloud: &Cloud) -> (f64, f64, f64) {
    let gauss: f64 = cloud
        .patches
        .iter()
        .map(|p| p.area * dot(p.normal, p.place) / cloud.dimensions as f64)
        .sum();
    let open = cloud
        .patches
        .iter()
        .fold([0.0; 3], |s, p| along(s, p.area, p.normal));
    (gauss, cloud.share.iter().sum(), length(open))
}

#[test]
fn a_lattice_has_points_on_its_faces() {
    let c = cloud(
        r#"{"box": {"min_m": [0, 0], "max_m": [1, 0.5]}}"#,
        r#"{"spacing_m": 0.025}"#,
        2,
    );
    assert_eq!(c.position.len(), 41 * 21);
    assert!(c.lattice);
    let (gauss, share, open) = sums(&c);
    assert!((gauss - 0.5).abs() < 1e-12 && (share - 0.5).abs() < 1e-12 && open < 1e-12);
    assert!(c.patches.iter().all(|p| c.depth(p).abs() < 1e-12));
}

#[test]
fn a_graded_lattice_fills_its_box() {
    let c = cloud(
        r#"{"box": {"min_m": [0, 0, 0], "max_m": [1, 1, 1]}}"#,
        r#"{"spacing_m": 0.1, "grading": {"x": 1.2, "z": 0.9}, "jitter": 0.3}"#,
        3,
    );
    let (gauss, share, open) = sums(&c);
    assert!((gauss - 1.0).abs() < 1e-12 && (share - 1.0).abs() < 1e-12 && open < 1e-12);
    assert!(!c.lattice);
}

#[test]
fn rings_and_shells_fill_round_bodies() {
    use std::f64::consts::PI;
    let disc = cloud(
        r#"{"disc": {"centre_m": [1, 1], "radius_m": 1}}"#,
        r#"{"spacing_m": 0.1}"#,
        2,
    );
    let (gauss, share, open) = sums(&disc);
    assert!((gauss - PI).abs() < 1e-9 && (share - PI).abs() < 1e-12 && open < 1e-12);
    let bar = cloud(
        r#"{"cylinder": {"centre_m": [1, 1, 0], "radius_m": 1, "length_m": 0.5}}"#,
        r#"{"spacing_m": 0.1}"#,
        3,
    );
    let (gauss, share, open) = sums(&bar);
    assert!((gauss - 0.5 * PI).abs() < 1e-9 && (share - 0.5 * PI).abs() < 1e-12 && open < 1e-12);
    let ball = cloud(
        r#"{"sphere": {"centre_m": [0, 0, 0], "radius_m": 1}}"#,
        r#"{"spacing_m": 0.1}"#,
        3,
    );
    let (gauss, share, open) = sums(&ball);
    let volume = 4.0 / 3.0 * PI;
    assert!((gauss - volume).abs() < 1e-9 && (share - volume).abs() < 1e-9 && open < 1e-12);
}

#[test]
fn a_cut_lattice_owns_the_whole_surface() {
    use std::f64::consts::PI;
    for jitter in ["0", "0.3"] {
        let c = cloud(
            r#"{"difference": [{"box": {"min_m": [0, 0], "max_m": [2, 2]}}, {"disc": {"centre_m": [1, 1], "radius_m": 0.5}}]}"#,
            &format!(r#"{{"spacing_m": 0.05, "arrangement": "cut", "jitter": {jitter}}}"#),
            2,
        );
        let (gauss, _, open) = sums(&c);
        let area = 4.0 - 0.25 * PI;
        assert!(
            (gauss - area).abs() < 2e-3 * area && open < 1e-12,
            "{gauss} {open}"
        );
        assert!(c.patches.iter().all(|p| c.depth(p) > 0.2 * 0.05));
    }
}

#[test]
fn compositions_have_no_arrangement_of_their_own() {
    let text = r#"{"union": [{"disc": {"centre_m": [0, 0], "radius_m": 1}}]}"#;
    let body = Body::new(&serde_json::from_str(text).unwrap(), 2);
    let points = serde_json::from_str(r#"{"spacing_m": 0.1}"#).unwrap();
    assert_eq!(Cloud::fill(&body, &points, 2), Err(CloudError::NotSingle));
}

#[test]
fn points_are_counted_before_they_are_made() {
    for (body, dimensions) in [
        (r#"{"box": {"min_m": [0, 0], "max_m": [1, 2]}}"#, 2),
        (r#"{"disc": {"centre_m": [0, 0], "radius_m": 1}}"#, 2),
        (r#"{"box": {"min_m": [0, 0, 0], "max_m": [1, 1, 1]}}"#, 3),
        (r#"{"sphere": {"centre_m": [0, 0, 0], "radius_m": 0.5}}"#, 3),
    ] {
        let body = Body::new(&serde_json::from_str(body).unwrap(), dimensions);
        let points = serde_json::from_str(r#"{"spacing_m": 0.1}"#).unwrap();
        let made = Cloud::fill(&body, &points, dimensions)
            .unwrap()
            .position
            .len() as f64;
        let least = room::least_points(&body, 0.1, dimensions);
        assert!(least <= made && least > 0.25 * made, "{least} of {made}");
    }
}
