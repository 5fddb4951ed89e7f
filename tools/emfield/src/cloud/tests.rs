use std::f64::consts::TAU;
use std::time::Instant;

use super::layout::{Solid, Wall};
use super::*;
use crate::scene::Scene;
use shapes::Body;
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

#[test]
fn a_cloud_needs_no_scene() {
    let text = r#"{"spacing_m": 0.2, "layers": {"first_m": 0.05}, "wall_layers": {}}"#;
    let points: Points = serde_json::from_str(text).unwrap();
    let disc = r#"{"disc": {"centre_m": [0.5, 0], "radius_m": 1}}"#;
    let body = Body::new(&serde_json::from_str(disc).unwrap(), 2);
    let solids = vec![Solid::new("drop".to_owned(), body, points.spacing_m)];
    let (centre, radius) = ([0.0; 3], 4.0);
    let layout = Layout::new(
        Geometry::Plane,
        Wall::Ball { centre, radius },
        solids,
        &points,
    );
    let filling = Filling {
        points: &points,
        shares: vec![false, true],
        support: 2.5,
    };
    let given = scene(&format!(
        r#"{{"geometry": "plane", "domain": {{"sphere": {{"centre_m": [0, 0], "radius_m": 4}}}}, "points": {text},
        "bodies": [{{"name": "drop", "shape": {disc}, "conductivity_s_m": 1e7}}],
        "eddy_currents": {{"harmonic": {{"frequency_hz": 1e5}}, "applied_flux_density_t": [0, 0, 1]}}}}"#
    ));
    let cloud = Cloud::new(layout, &filling).unwrap();
    assert!(cloud.len() > 500 && !cloud.cells.is_empty());
    assert_eq!(cloud, setup::cloud(&given).unwrap());
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
                    ..
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
    let cloud = setup::cloud(&scene).unwrap();
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
    let volume: f64 = cloud.cells.iter().map(|c| c.volume).sum();
    let exact = 4.0 / 3.0 * std::f64::consts::PI;
    println!("volume {:e}", volume / exact - 1.0);
    assert!((volume / exact - 1.0).abs() < 1e-3);
    for k in 0..3 {
        let second: f64 = cloud
            .cells
            .iter()
            .zip(&cloud.position)
            .map(|(c, x)| c.volume * x[k] * x[k] + 2.0 * c.first[k] * x[k] + c.second[k][k])
            .sum();
        println!("second {:e}", second / (exact / 5.0) - 1.0);
        assert!((second / (exact / 5.0) - 1.0).abs() < 2e-3);
    }
}

#[test]
fn spacing_grows_outward_to_walls_that_are_met_exactly() {
    let scene = ball(r#"{"spacing_m": 0.2}"#, "");
    let cloud = setup::cloud(&scene).unwrap();
    let counts = cloud.counts;
    assert_eq!(
        counts.interface + counts.outer + counts.layers + counts.lattice,
        cloud.len()
    );
    assert_eq!(cloud.surface.len(), counts.interface);
    let mut far = 0.0_f64;
    for i in 0..cloud.len() {
        let x = cloud.position[i];
        let wall = x.iter().any(|c| (c.abs() - 10.0).abs() < f64::EPSILON);
        assert_eq!(wall, matches!(cloud.class[i], Class::Outer { .. }));
        if matches!(cloud.class[i], Class::Inside(1)) {
            assert!(length(x) < 1.0);
        }
        far = far.max(cloud.spacing[i]);
    }
    // An eighth of the domain is the most.
    assert!(far > 0.9 && far <= 2.5, "{far}");
    assert!(cloud.bytes() < 200 * cloud.len() as u64 + 100 * cloud.surface.len() as u64);
}

#[test]
fn doubling_lattices_need_more_points_than_smooth_ones() {
    let smooth = setup::cloud(&ball(r#"{"spacing_m": 0.2}"#, "")).unwrap();
    let doubling = setup::cloud(&ball(r#"{"spacing_m": 0.2, "steps": "doubling"}"#, "")).unwrap();
    assert!(doubling.len() > smooth.len());
    assert!(nearness(&doubling).1 <= 2.0 + 1e-9);
}

#[test]
fn shifted_points_leave_surfaces_and_walls_alone() {
    let plain = setup::cloud(&ball(r#"{"spacing_m": 0.2}"#, "")).unwrap();
    let points = r#"{"spacing_m": 0.2, "jitter": 0.2, "seed": 7}"#;
    let shaken = setup::cloud(&ball(points, "")).unwrap();
    assert_eq!(shaken, setup::cloud(&ball(points, "")).unwrap());
    let mut moved = 0;
    for i in 0..plain.len() {
        let way = length(difference(plain.position[i], shaken.position[i]));
        match plain.class[i] {
            Class::Inside(_) => moved += usize::from(way > 0.0),
            _ => assert!(way == 0.0),
        }
        assert_eq!(plain.class[i], shaken.class[i]);
        assert!(way <= 0.2 * 3.0_f64.sqrt() * plain.spacing[i]);
    }
    assert!(moved > plain.counts.lattice / 2);
}

#[test]
fn closest_packing_fills_a_ball() {
    let points = r#"{"spacing_m": 0.1, "arrangement": "hexagonal"}"#;
    let cloud = setup::cloud(&ball(points, "")).unwrap();
    let (least, grading) = nearness(&cloud);
    assert!(least > 0.6 && grading <= 2.0, "{least} {grading}");
    let volume: f64 = cloud.cells.iter().map(|c| c.volume).sum();
    assert!((volume / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3);
}

#[test]
fn a_disc_that_is_the_domain() {
    let scene = scene(
        r#"{"geometry": "plane", "domain": {"sphere": {"centre_m": [0.2, 0], "radius_m": 0.1}},
        "surroundings": {"conductivity_s_m": 7.7e6}, "eddy_currents": {"harmonic": {"frequency_hz": 60},
        "applied_flux_density_t": [0, 0, 1e-6]}, "points": {"spacing_m": 5e-3, "wall_layers": {"first_m": 2e-3}}}"#,
    );
    let cloud = setup::cloud(&scene).unwrap();
    let volume: f64 = cloud.cells.iter().map(|c| c.volume).sum();
    assert!((volume / (0.01 * std::f64::consts::PI) - 1.0).abs() < 1e-3);
    for i in 0..cloud.len() {
        let [x, y, z] = cloud.position[i];
        let away = (x - 0.2).hypot(y);
        assert!(z == 0.0 && away < 0.1 + 1e-15);
        let wall = matches!(cloud.class[i], Class::Outer { .. });
        assert_eq!(wall, (away - 0.1).abs() < 1e-12);
    }
    assert!(nearness(&cloud).0 > 0.55);
}

#[test]
fn a_ball_and_a_ring_about_an_axis() {
    let scene = scene(
        r#"{"geometry": "axisymmetric", "domain": {"box": {"min_m": [0, -10], "max_m": [10, 10]}}, "bodies": [
        {"name": "ball", "shape": {"disc": {"centre_m": [0, 0], "radius_m": 1}}, "conductivity_s_m": 1e7},
        {"name": "ring", "shape": {"box": {"min_m": [2, -1], "max_m": [3, 0]}}, "conductivity_s_m": 1e7}],
        "eddy_currents": {"harmonic": {"frequency_hz": 1e5}, "applied_flux_density_t": [0, 1]},
        "points": {"spacing_m": 0.08, "layers": {"first_m": 0.04}}}"#,
    );
    let cloud = setup::cloud(&scene).unwrap();
    let pi = std::f64::consts::PI;
    for (medium, exact) in [(1, 4.0 / 3.0 * pi), (2, 5.0 * pi)] {
        let own = |i: &usize| match cloud.class[*i] {
            Class::Inside(m) => m == medium,
            Class::Interface { inner, .. } => inner == medium,
            Class::Outer { .. } => false,
        };
        let volume: f64 = (0..cloud.len())
            .filter(own)
            .map(|i| cloud.cells[i].volume)
            .sum();
        assert!(
            (volume / exact - 1.0).abs() < 2e-3,
            "{medium}: {volume} of {exact}"
        );
    }
    let area: f64 = cloud
        .surface
        .iter()
        .filter(|s| s.inner == 1)
        .map(|s| s.area)
        .sum();
    assert!((area / (4.0 * pi) - 1.0).abs() < 1e-3);
    for x in &cloud.position {
        assert!(x[0] >= 0.0 && x[1] == 0.0);
    }
    // Corners of the ring are filled outside.
    let corner = [3.3, 0.0, 0.3];
    let near = cloud
        .position
        .iter()
        .map(|x| length(difference(*x, corner)));
    assert!(near.fold(f64::INFINITY, f64::min) < 0.1);
}

#[test]
fn bodies_that_touch_share_one_surface() {
    let scene = scene(
        r#"{"geometry": "plane", "domain": {"box": {"min_m": [-2, -2], "max_m": [2, 2]}}, "bodies": [
        {"name": "a", "shape": {"box": {"min_m": [-1, -1], "max_m": [0, 1]}}},
        {"name": "b", "shape": {"box": {"min_m": [0, -1], "max_m": [1, 1]}}}],
        "electrostatics": {"applied_field_v_m": [1, 0]}, "points": {"spacing_m": 0.1}}"#,
    );
    let cloud = setup::cloud(&scene).unwrap();
    let shared: f64 = cloud
        .surface
        .iter()
        .filter(|s| s.inner > 0 && s.outer > 0)
        .map(|s| s.area)
        .sum();
    assert!((shared - 2.0).abs() < 0.11, "{shared}");
    assert!(nearness(&cloud).0 > 0.5);
}

#[test]
fn a_conductor_may_cross_the_wall() {
    let scene = scene(
        r#"{"geometry": "space", "domain": {"box": {"min_m": [-2, -2, -2], "max_m": [2, 2, 2]}}, "bodies": [
        {"name": "bar", "shape": {"cylinder": {"centre_m": [0, 0, 0], "radius_m": 0.5, "length_m": 6}}}],
        "electrostatics": {"applied_field_v_m": [1, 0, 0]}, "points": {"spacing_m": 0.15}}"#,
    );
    let cloud = setup::cloud(&scene).unwrap();
    let inside = |c: &Class| matches!(c, Class::Outer { medium: 1, .. });
    assert!(cloud.class.iter().any(inside));
    assert!(cloud.position.iter().all(|x| x[2].abs() <= 2.0));
}

/// Two bodies of spacings 0.25 and `second` in a cube of edge 20.
fn pair(first: &str, other: &str, second: f64) -> Cloud {
    let scene = scene(&format!(
        r#"{{"geometry": "space", "domain": {{"box": {{"min_m": [-10, -10, -10], "max_m": [10, 10, 10]}}}},
        "bodies": [{{"name": "a", "shape": {first}, "relative_permittivity": 3}},
        {{"name": "b", "shape": {other}, "relative_permittivity": 80, "spacing_m": {second}}}],
        "points": {{"spacing_m": 0.25}}, "electrostatics": {{"applied_field_v_m": [0, 0, 1]}}}}"#
    ));
    setup::cloud(&scene).unwrap()
}

/// Areas of the surface between two media, and the finest spacing there.
fn between(cloud: &Cloud, inner: u16, outer: u16) -> (f64, f64) {
    let all = cloud.surface.iter();
    let own = all.filter(|s| (s.inner, s.outer) == (inner, outer));
    own.fold((0.0, f64::INFINITY), |(area, finest), s| {
        (area + s.area, finest.min(cloud.spacing[s.point as usize]))
    })
}

#[test]
fn bodies_that_touch_share_the_points_of_their_face() {
    let left = r#"{"box": {"min_m": [-1, -1, -1], "max_m": [0, 1, 1]}}"#;
    let right = r#"{"box": {"min_m": [0, -1, -1], "max_m": [1, 1, 1]}}"#;
    let cloud = pair(left, right, 0.25);
    for (media, exact) in [((1, 2), 4.0), ((1, 0), 12.0), ((2, 0), 12.0)] {
        let (area, finest) = between(&cloud, media.0, media.1);
        assert!((area - exact).abs() < 1e-9, "{media:?}: {area}");
        // Surfaces that go on where another ends are no gap.
        assert!(finest > 0.249, "{media:?}: {finest}");
    }
    assert_eq!(between(&cloud, 2, 1).0.to_bits(), 0.0_f64.to_bits());
    let (least, _) = nearness(&cloud);
    assert!(least > 0.55, "{least}");
    // The finer body places them.
    let cloud = pair(left, right, 0.125);
    let (area, finest) = between(&cloud, 2, 1);
    assert!((area - 4.0).abs() < 1e-9 && finest < 0.126);
    assert_eq!(between(&cloud, 1, 2).0.to_bits(), 0.0_f64.to_bits());
}

#[test]
fn surfaces_that_cross_keep_their_points_apart() {
    let ball = |z: f64| format!(r#"{{"sphere": {{"centre_m": [0, 0, {z}], "radius_m": 1.25}}}}"#);
    for way in [0.4, 1.25, 2.0, 2.4] {
        let cloud = pair(&ball(-0.4 * way), &ball(0.6 * way), 0.25);
        let (least, _) = nearness(&cloud);
        assert!(least > 0.45, "{way}: {least}");
        // Caps cut each other at half their distance.
        let exact = TAU * 1.25 * (1.25 + 0.5 * way);
        let (area, finest) = between(&cloud, 2, 0);
        assert!((area / exact - 1.0).abs() < 0.06, "{way}: {area} {exact}");
        assert!(finest > 0.1, "{way}: {finest}");
    }
    // Across a gap points of two surfaces stay near.
    let cloud = pair(&ball(-1.2565), &ball(1.2565), 0.25);
    let (area, finest) = between(&cloud, 2, 0);
    assert!((area / (2.0 * TAU * 1.25 * 1.25) - 1.0).abs() < 1e-3);
    assert!(finest < 0.04, "{finest}");
}
