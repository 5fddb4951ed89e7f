//! Curvatures of bodies with known ones.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::faces::Faces;
use crate::state::{Particle, State, phase};

type Cloud = Vec<[f64; 3]>;

/// The cloud of a spacing of 1, times `spacing`, as liquid; its curvatures.
fn measured(cloud: &[[f64; 3]], spacing: f64) -> Curvature {
    measured_beside(cloud, spacing, Faces::default())
}

fn measured_beside(cloud: &[[f64; 3]], spacing: f64, faces: Faces) -> Curvature {
    let metal = Matter {
        density: 7850.0,
        spacing,
        smoothing_length: spacing,
    };
    let mut state = State::new(metal);
    state.flowing = true;
    state.faces = faces;
    for x in cloud {
        state.push(Particle {
            position: x.map(|x| spacing * x),
            velocity: [0.0; 3],
            phase: phase::LIQUID,
            droplet: false,
            wall: false,
            temperature: 0.0,
            enthalpy: 0.0,
        });
    }
    state.gather();
    let mut curvature = Curvature::new(metal);
    curvature.measure(&state.near);
    // In the order of the cloud.
    let mut mean = vec![None; cloud.len()];
    for (id, found) in state.near.id.iter().zip(&curvature.mean) {
        mean[*id as usize] = *found;
    }
    curvature.mean = mean;
    curvature
}

/// Layers of a ball of the radius `n`, each as dense as the lattice, evenly along spirals.
fn ball(n: u32) -> Cloud {
    let mut cloud = Cloud::new();
    for layer in 0..n {
        let [inner, outer] = [0, 1].map(|k| f64::from(layer + k).powi(3));
        let points = (4.0 / 3.0 * PI * (outer - inner)).round() as u32;
        for k in 0..points {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(points);
            let turn = 2.399_963_229_728_653 * f64::from(k) + 1.3 * f64::from(layer);
            let across = (1.0 - z * z).sqrt();
            let direction = [across * turn.cos(), across * turn.sin(), z];
            cloud.push(direction.map(|x| x * (f64::from(layer) + 0.5)));
        }
    }
    cloud
}

/// The points of the lattice for which `within` holds.
fn lattice(half: i32, within: impl Fn([f64; 3]) -> bool) -> Cloud {
    let axis = || (-half..half).map(|i| f64::from(i) + 0.5);
    let points = axis().flat_map(|x| axis().flat_map(move |y| axis().map(move |z| [x, y, z])));
    points.filter(|x| within(*x)).collect()
}

fn shaken(mut cloud: Cloud, part: f64) -> Cloud {
    let mut seed = 11_u64;
    for x in cloud.iter_mut().flatten() {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        *x += 2.0 * part * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5);
    }
    cloud
}

fn radius(cloud: &[[f64; 3]]) -> f64 {
    (0.75 * cloud.len() as f64 / PI).cbrt()
}

/// Mean and root mean square of the deviations.
fn spread(found: &[f64]) -> [f64; 2] {
    let count = found.len() as f64;
    let mean = found.iter().sum::<f64>() / count;
    let square: f64 = found.iter().map(|x| (x - mean).powi(2)).sum();
    [mean, (square / count).sqrt()]
}

/// Curvatures of what is known at all.
fn known(cloud: &[[f64; 3]]) -> Vec<f64> {
    measured(cloud, 1.0).mean.into_iter().flatten().collect()
}

#[test]
fn a_ball_has_the_curvature_of_its_radius() {
    // Scatter stays the same part of 1/d.
    for (n, part, off, scatter) in [
        (5, 0.0, 0.005, 0.01),
        (9, 0.0, 0.003, 0.01),
        (18, 0.0, 0.003, 0.01),
        (5, 0.1, 0.01, 0.07),
        (9, 0.1, 0.01, 0.07),
        (18, 0.1, 0.01, 0.07),
    ] {
        let cloud = shaken(ball(n), part);
        let [mean, rough] = spread(&known(&cloud));
        let mean = mean * radius(&cloud) / 2.0;
        assert!(
            (mean - 1.0).abs() < off && rough < scatter,
            "{n} spacings, shaken by {part}: mean {mean}, scatter {rough}"
        );
    }
}

#[test]
fn a_ball_cut_from_the_lattice_has_its_curvature_in_the_mean() {
    // Its steps are as wide as the fit is: from place to place it scatters.
    for n in [5, 9, 18] {
        for part in [0.0, 0.1] {
            let r = f64::from(n);
            let cloud = shaken(lattice(n + 1, |x| squared(x) < r * r), part);
            let [mean, rough] = spread(&known(&cloud));
            let mean = mean * radius(&cloud) / 2.0;
            assert!(
                (mean - 1.0).abs() < 0.06 && rough < 0.13,
                "{n} spacings, shaken by {part}: mean {mean}, scatter {rough}"
            );
        }
    }
}

#[test]
fn an_ellipsoid_has_its_curvature_everywhere() {
    for (n, off) in [(5, 0.03), (9, 0.04), (18, 0.06)] {
        let r = f64::from(n);
        let [a, c] = [r / 1.1_f64.sqrt(), 1.1 * r];
        let stretched = |[x, y, z]: &[f64; 3]| [x * a / r, y * a / r, z * c / r];
        let cloud: Cloud = ball(n).iter().map(stretched).collect();
        let curvature = measured(&cloud, 1.0);
        let (mut square, mut count, mut along, mut asked) = (0.0, 0.0, 0.0, 0.0);
        for (x, found) in cloud.iter().zip(&curvature.mean) {
            let Some(found) = found else { continue };
            // The place on the ellipsoid in the direction of the particle.
            let size = ((x[0] * x[0] + x[1] * x[1]) / (a * a) + x[2] * x[2] / (c * c)).sqrt();
            let [x, y, z] = x.map(|x| x / size);
            let q = (x * x + y * y) / a.powi(4) + z * z / c.powi(4);
            let far = x * x + y * y + z * z;
            let exact = (2.0 * a * a + c * c - far) / (a.powi(4) * c * c * q.powf(1.5));
            let second = 1.5 * z * z / far - 0.5;
            along += second * (found - 2.0 / r);
            asked += second * (exact - 2.0 / r);
            square += (found / exact - 1.0).powi(2);
            count += 1.0;
        }
        let (rough, swing) = (f64::sqrt(square / count), along / asked);
        assert!(
            rough < off && (swing - 1.0).abs() < 0.05,
            "{n} spacings: {rough}, second mode {swing}"
        );
    }
}

#[test]
fn a_cylinder_has_half_of_it() {
    for n in [5, 9, 18] {
        let mut cloud = Cloud::new();
        for layer in 0..n {
            let r = f64::from(layer) + 0.5;
            let points = (TAU * r).round() as u32;
            for k in 0..28 {
                for j in 0..points {
                    let turn = TAU * (f64::from(j) + 0.5 * f64::from(k % 2)) / f64::from(points);
                    cloud.push([r * turn.cos(), r * turn.sin(), f64::from(k) - 13.5]);
                }
            }
        }
        let curvature = measured(&cloud, 1.0);
        let middle = cloud.iter().zip(&curvature.mean);
        let middle = middle.filter(|(x, _)| x[2].abs() < 3.0);
        let found: Vec<f64> = middle.filter_map(|(_, found)| *found).collect();
        let [mean, rough] = spread(&found);
        let mean = mean * f64::from(n);
        assert!(
            (mean - 1.0).abs() < 0.01 && rough < 0.01,
            "{n} spacings: mean {mean}, scatter {rough}"
        );
    }
}

#[test]
fn a_plane_has_none() {
    let cloud = lattice(11, |x| x[2].abs() < 3.0);
    for (part, most) in [(0.0, 1e-5), (0.1, 0.2)] {
        let curvature = measured(&shaken(cloud.clone(), part), 1.0);
        let mut seen = 0;
        for (x, found) in cloud.iter().zip(&curvature.mean) {
            if let (Some(found), true) = (found, x[0].abs().max(x[1].abs()) < 3.0) {
                assert!(found.abs() < most, "{found} at {x:?}");
                seen += 1;
            }
        }
        assert!(seen >= 72, "{seen}");
    }
}

#[test]
fn turning_and_size_change_nothing() {
    let cloud = shaken(lattice(6, |x| squared(x) < 25.0), 0.1);
    let one = measured(&cloud, 1.0);
    let (sin, cos) = (0.6, 0.8);
    let turned = |x: &[f64; 3]| {
        let [x, y, z] = [x[0], cos * x[1] - sin * x[2], sin * x[1] + cos * x[2]];
        [cos * x - sin * y, sin * x + cos * y, z]
    };
    let turned: Cloud = cloud.iter().map(turned).collect();
    let others = [(turned, 1.0), (cloud.clone(), 0.05), (cloud, 100.0)];
    for (cloud, spacing) in others {
        let other = measured(&cloud, spacing);
        for (a, b) in one.mean.iter().zip(&other.mean) {
            assert!(a.is_some() == b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                assert!((a - b * spacing).abs() < 1e-4, "{a} {b} at {spacing}");
            }
        }
    }
}

#[test]
fn what_is_too_small_for_a_shape_is_as_sharp_as_may_be() {
    let single = measured(&[[0.0; 3]], 0.5);
    assert_eq!((single.mean[0], single.bounded), (Some(4.0), 1));
    // A film of one layer, and one of two: no more than 2/d anywhere.
    for layers in [0.6, 1.2] {
        let cloud = shaken(lattice(8, |x| x[2].abs() < layers), 0.1);
        for found in known(&cloud) {
            assert!(found.abs() <= 2.0, "{found}");
        }
    }
}

#[test]
fn half_a_ball_beside_a_mirror_is_the_whole() {
    let whole = shaken(ball(6), 0.05);
    let upper: Cloud = whole.iter().copied().filter(|x| x[2] > 0.0).collect();
    let both: Cloud = upper
        .iter()
        .flat_map(|[x, y, z]| [[*x, *y, *z], [*x, *y, -z]])
        .collect();
    let text = r#"{"min_m": [-9, -9, 0], "max_m": [9, 9, 9], "mirror": ["z-"]}"#;
    let faces: crate::faces::Parameters = serde_json::from_str(text).unwrap();
    let beside = measured_beside(&upper, 1.0, faces.faces(2.0, false).unwrap());
    let whole = measured(&both, 1.0);
    for (a, b) in beside.mean.iter().zip(whole.mean.iter().step_by(2)) {
        match (a, b) {
            (Some(a), Some(b)) => assert!((a - b).abs() < 1e-4, "{a} {b}"),
            _ => assert!(a.is_none() && b.is_none()),
        }
    }
}

#[test]
fn a_cap_on_a_mirror_has_the_curvature_of_its_ball() {
    for degrees in [40.0_f64, 60.0, 75.0, 90.0, 120.0, 140.0] {
        let angle = degrees.to_radians();
        // Nine layers high.
        let r = 9.0 / (1.0 - angle.cos());
        let centre = -r * angle.cos();
        let within = |[x, y, z]: [f64; 3]| z > 0.0 && squared([x, y, z - centre]) < r * r;
        let cloud = shaken(lattice(27, within), 0.05);
        let text = format!(
            r#"{{"min_m": [-30, -30, 0], "max_m": [30, 30, 30], "mirror": ["z-"],
            "contact_angles": [{{"face": "z-", "angle_deg": {degrees}}}]}}"#
        );
        let faces: crate::faces::Parameters = serde_json::from_str(&text).unwrap();
        let found = measured_beside(&cloud, 1.0, faces.faces(2.0, false).unwrap()).mean;
        // Layers of the lattice end in steps: three of them and more tell.
        for (low, high, off) in [(0.0, 3.0, 0.1), (3.0, 30.0, 0.07)] {
            let between = cloud.iter().zip(&found);
            let between = between.filter(|(x, _)| (low..high).contains(&x[2]));
            let known: Vec<f64> = between.filter_map(|(_, found)| *found).collect();
            let [mean, rough] = spread(&known);
            let mean = 0.5 * r * mean;
            assert!(
                (mean - 1.0).abs() < off,
                "{degrees} degrees, {low} to {high} above the mirror: {mean}, scatter {rough}"
            );
        }
    }
}

/// Means of the curvature at the foot of a hemisphere of the radius 8 on solid metal, within its lowest layer, of which the
/// liquid does not wet the part `dry`; and near its top.
fn on_solid(dry: f64) -> [f64; 2] {
    let metal = Matter {
        density: 7850.0,
        spacing: 1.0,
        smoothing_length: 1.0,
    };
    let mut state = State::new(metal);
    state.flowing = true;
    let cap = |x: [f64; 3]| squared(x) < 64.0 && x[2] > 0.0;
    let cloud = lattice(14, |x| cap(x) || (x[2] < 0.0 && x[2] > -4.0));
    for x in &cloud {
        state.push(Particle {
            position: *x,
            velocity: [0.0; 3],
            phase: if cap(*x) { phase::LIQUID } else { phase::SOLID },
            droplet: false,
            wall: false,
            temperature: 0.0,
            enthalpy: 0.0,
        });
    }
    state.gather();
    if dry > 0.0 {
        let of = |role: &Role| f64::from(u8::from(!role.flows())) * dry;
        state.near.dry = state.near.role.iter().map(of).collect();
    }
    let mut curvature = Curvature::new(metal);
    curvature.measure(&state.near);
    [[0.0, 1.0], [6.0, 9.0]].map(|[from, to]| {
        let places = state.near.position.iter().zip(&curvature.mean);
        let between = places.filter(|(x, _)| x[2] > from && x[2] < to);
        let known: Vec<f64> = between.filter_map(|(_, kappa)| *kappa).collect();
        known.iter().sum::<f64>() / known.len() as f64
    })
}

#[test]
fn metal_that_is_not_wetted_does_not_draw_the_edge_of_a_drop_outwards() {
    let [wet, half, dry] = [0.0, 0.5, 1.0].map(on_solid);
    // A wetted plate makes the foot hollow; where it is no metal to the surface, the foot bulges as the edge of a drop does.
    assert!(wet[0] < 0.0, "{wet:?}");
    assert!(
        half[0] > wet[0] && dry[0] > half[0],
        "{wet:?} {half:?} {dry:?}"
    );
    assert!(dry[0] > 0.25, "{dry:?}");
    for [_, top] in [wet, half, dry] {
        assert!((top / 0.25 - 1.0).abs() < 0.1, "{top}");
    }
}
