//! Areas of a plane, a tilted plane and a sphere, for aligned, turned and jittered lattices.

use shapes::frame::dot;

use super::*;
use crate::state::{PHASE, Particle, phase};

const METAL: Matter = Matter {
    density: 7850.0,
    spacing: 1.0,
    smoothing_length: 1.0,
};

fn patches(state: &State) -> impl Iterator<Item = Patch> {
    Patches::of(&state.metal).iter()
}

fn noise(i: usize) -> f64 {
    ((i as f64 * 12.9898).sin() * 43_758.545_3).fract().abs() - 0.5
}

/// Rotation by `turn` about the axis (1, 2, 3), (1, 0, 0), ... (Rodrigues).
fn turned(x: [f64; 3], axis: [f64; 3], turn: f64) -> [f64; 3] {
    let length = squared(axis).sqrt();
    let k = axis.map(|c| c / length);
    let (sin, cos) = turn.sin_cos();
    let along = dot(k, x) * (1.0 - cos);
    let across = cross(k, x);
    std::array::from_fn(|i| x[i] * cos + across[i] * sin + k[i] * along)
}

/// The axis about which a lattice is turned, by how much, and how far its points are shaken.
#[derive(Clone, Copy)]
struct Lattice([f64; 3], f64, f64);

/// Particles of a lattice turned and shaken, of which `inside` is kept.
fn cloud(half: i32, lattice: Lattice, inside: impl Fn([f64; 3]) -> bool) -> State {
    let Lattice(axis, turn, jitter) = lattice;
    let mut state = State::new(METAL);
    patch::declare(&mut state.metal);
    let mut count = 0;
    for i in -half..half {
        for j in -half..half {
            for k in -half..half {
                count += 3;
                let at = [i, j, k].map(|n| f64::from(n) + 0.5);
                let mut position = turned(at, axis, turn);
                for (c, x) in position.iter_mut().enumerate() {
                    *x += jitter * noise(count + c);
                }
                if inside(position) {
                    state.push(Particle {
                        position,
                        velocity: [0.0; 3],
                        phase: phase::SOLID,
                        droplet: false,
                        wall: false,
                        temperature: 0.0,
                        enthalpy: 0.0,
                    });
                }
            }
        }
    }
    Surface::new(METAL).advance(&mut state, 0.0).unwrap();
    state
}

/// Edge of the window through which planes are seen.
const EDGE: f64 = 11.0;

/// A slab with a wide plane on top.
fn slab(lattice: Lattice, normal: [f64; 3], level: f64) -> State {
    let (u, v) = tangents(normal);
    cloud(22, lattice, |x| {
        dot(x, normal) < level
            && dot(x, normal) > level - 6.0
            && dot(x, u).abs() < EDGE + 4.0
            && dot(x, v).abs() < EDGE + 4.0
    })
}

/// Measured over true area of a plane, seen through a smooth window.
fn plane(state: &State, normal: [f64; 3], level: f64) -> f64 {
    let (u, v) = tangents(normal);
    let window = |s: f64| {
        let x = (s / EDGE).clamp(-1.0, 1.0);
        0.5 * (1.0 + (std::f64::consts::PI * x).cos())
    };
    let mut sum = 0.0;
    for (x, patch) in state.metal.column(&POSITION).iter().zip(patches(state)) {
        if dot(*x, normal) > level - 3.0 {
            sum += patch.area * window(dot(*x, u)) * window(dot(*x, v));
        }
    }
    sum / (EDGE * EDGE)
}

#[test]
fn planes_have_their_area() {
    let flat = [0.0, 0.0, 1.0];
    let tilted = [0.5, 0.0, 0.75_f64.sqrt()];
    for (normal, name) in [(flat, "flat"), (tilted, "tilted by 30 degrees")] {
        for (turn, jitter) in [(0.0, 0.0), (0.0, 0.3), (0.7, 0.0), (1.9, 0.2)] {
            let state = slab(Lattice([1.0, 2.0, 3.0], turn, jitter), normal, 0.0);
            let found = plane(&state, normal, 0.0);
            assert!(
                (found - 1.0).abs() < 0.01,
                "{name}, turned {turn}, jitter {jitter}: {found}"
            );
        }
    }
}

/// What a flow kept at one density makes of its surface: layers drawn together until the number
/// density of the outermost is that of the inside.
#[test]
fn planes_keep_their_area_when_their_layers_draw_together() {
    let flat = [0.0, 0.0, 1.0];
    for (turn, jitter) in [(0.0, 0.0), (0.0, 0.3), (0.7, 0.0), (1.9, 0.2)] {
        let mut state = slab(Lattice([1.0, 2.0, 3.0], turn, jitter), flat, 0.0);
        for x in state.metal.column_mut(&POSITION) {
            x[2] -= 0.9 * (x[2] / 1.2).exp();
        }
        Surface::new(METAL).advance(&mut state, 0.0).unwrap();
        let found = plane(&state, flat, 0.0);
        assert!(
            (found - 1.0).abs() < 0.01,
            "turned {turn}, jitter {jitter}: {found}"
        );
    }
}

/// Area, and area projected upwards, over those of a sphere of as many particles.
fn sphere(radius: f64, lattice: Lattice) -> [f64; 2] {
    let state = cloud(20, lattice, |x| squared(x).sqrt() < radius);
    let real = (state.len() as f64 * 0.75 / std::f64::consts::PI).cbrt();
    let disc = std::f64::consts::PI * real * real;
    let area: f64 = state.metal.column(&AREA).iter().sum();
    let up = |p: Patch| p.seen;
    [
        area / (4.0 * disc),
        patches(&state).map(up).sum::<f64>() / disc,
    ]
}

#[test]
fn spheres_have_their_area() {
    // 18 spacings: the radius of 9 mm that a bead has.
    for (radius, bound) in [(18.0, 0.01), (9.0, 0.015)] {
        for (turn, jitter) in [(0.0, 0.0), (0.7, 0.0), (1.9, 0.2)] {
            let [whole, up] = sphere(radius, Lattice([1.0, 2.0, 3.0], turn, jitter));
            let what = format!("radius {radius}, turned {turn}, jitter {jitter}: {whole} {up}");
            assert!((whole - 1.0).abs() < bound, "{what}");
            assert!((up - 1.0).abs() < 2.0 * bound, "{what}");
        }
    }
}

#[test]
fn normals_of_a_sphere_point_outwards() {
    let state = cloud(12, Lattice([3.0, 1.0, 2.0], 0.4, 0.1), |x| {
        squared(x).sqrt() < 10.0
    });
    for (x, patch) in state.metal.column(&POSITION).iter().zip(patches(&state)) {
        if patch.area > 0.5 {
            let cosine = dot(*x, patch.normal) / squared(*x).sqrt();
            assert!(cosine > 0.98, "{cosine}");
        }
    }
}

#[test]
fn the_flowing_part_is_measured_as_the_whole_is() {
    let mut state = cloud(8, Lattice([1.0, 2.0, 3.0], 0.3, 0.1), |x| {
        x[2] < 3.0 && x[2] > -5.0
    });
    let whole = state.metal.column(&AREA).to_vec();
    for a in 0..state.len() {
        if state.metal.column(&POSITION)[a][2] > 0.0
            && state.metal.column(&POSITION)[a][0].abs() < 4.0
        {
            state.metal.column_mut(&PHASE)[a] = phase::LIQUID;
        }
    }
    state.flowing = true;
    state.gather();
    let mut stage = Surface::new(METAL);
    stage.advance(&mut state, 0.0).unwrap();
    let liquid = |a: &usize| {
        state.metal.column(&PHASE)[*a] == phase::LIQUID
            && state.metal.column(&POSITION)[*a][0].abs() < 1.0
            && state.metal.column(&POSITION)[*a][1].abs() < 4.0
    };
    let inner: Vec<usize> = (0..state.len()).filter(liquid).collect();
    assert!(inner.len() > 40);
    for a in inner {
        let off = (state.metal.column(&AREA)[a] - whole[a]).abs();
        assert!(off < 1e-3, "{off}");
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let state = cloud(6, Lattice([1.0, 2.0, 3.0], 0.7, 0.3), |x| {
        squared(x).sqrt() < 5.0
    });
    let unit = 5e-4;
    let metal = Matter {
        spacing: unit,
        smoothing_length: unit,
        ..METAL
    };
    let mut small = state.clone();
    small.metal.matter = metal;
    for x in small.metal.column_mut(&POSITION).as_flattened_mut() {
        *x *= unit;
    }
    Surface::new(metal).advance(&mut small, 0.0).unwrap();
    for (large, small) in patches(&state).zip(patches(&small)) {
        assert!((small.depth / unit - large.depth).abs() < 1e-6);
        assert!((small.area / (unit * unit) - large.area).abs() < 1e-6);
    }
}

/// Area seen from above and area times the upward normal of a hollow, through the window (1 - (r/a)^2)^2, over
/// those of the sphere that it is.
fn hollow(radius: f64, lattice: Lattice) -> [f64; 2] {
    let state = cloud(16, lattice, |x| {
        let within = x[2] < -0.5 * radius && x[2] > -radius - 6.0 && x[0].hypot(x[1]) < 14.0;
        within && squared(x).sqrt() > radius
    });
    let a = 0.75_f64.sqrt() * radius;
    let window = |x: [f64; 3]| (1.0 - (x[0].hypot(x[1]) / a).powi(2)).max(0.0).powi(2);
    let exact = std::f64::consts::PI * a * a / 3.0;
    let (mut seen, mut up) = (0.0, 0.0);
    let floor = -radius - 3.0;
    for (x, patch) in state.metal.column(&POSITION).iter().zip(patches(&state)) {
        if x[2] > floor {
            seen += patch.seen * window(*x);
            up += patch.area * patch.normal[2] * window(patch.foot(*x));
        }
    }
    [seen / exact, up / exact]
}

#[test]
fn hollows_have_their_area() {
    for (radius, bound) in [(6.0, 0.03), (4.0, 0.05)] {
        for (turn, jitter) in [(0.0, 0.0), (0.7, 0.0), (1.9, 0.2)] {
            let [seen, up] = hollow(radius, Lattice([1.0, 2.0, 3.0], turn, jitter));
            let what = format!("radius {radius}, turned {turn}, jitter {jitter}: {seen} {up}");
            assert!((seen - 1.0).abs() < bound, "{what}");
            assert!((up - 1.0).abs() < bound, "{what}");
        }
    }
}

#[test]
fn what_falls_on_cut_edges_is_taken_whole() {
    // The upper side of a plate slopes down to its lower edge, or the plate hangs over; columns of the lattice tell the plan.
    for slope in [0.5, 1.0, 2.0] {
        for under in [1.0, -1.0] {
            let inside = |x: [f64; 3]| {
                let cut = x[0] + under * x[2] / slope < if under > 0.0 { 3.0 } else { 8.0 };
                x[0] > -9.0 && x[1].abs() < 5.0 && x[2] < 0.0 && x[2] > -5.0 && cut
            };
            let state = cloud(12, Lattice([0.5, 0.5, 0.5], 0.0, 0.0), inside);
            let places = state.metal.column(&POSITION);
            let plan: std::collections::BTreeSet<[i64; 2]> = places
                .iter()
                .map(|x| [x[0], x[1]].map(|x| (10.0 * x).round() as i64))
                .collect();
            let seen: f64 = patches(&state).map(|p| p.seen).sum();
            let lost = 1.0 - seen / plan.len() as f64;
            assert!(lost.abs() < 5e-3, "slope {slope}, {under}: {lost}");
        }
    }
}

/// Half of a shaken slab beside a mirror at x = 0, whose first layer stands `off` from it; and the whole of it.
fn beside_mirror(off: f64) -> [State; 2] {
    let mut places = Vec::new();
    let mut count = 0;
    for i in 0..7 {
        for j in -6..6 {
            for k in -5..0 {
                count += 3;
                let at = [f64::from(i) + off, f64::from(j) + 0.5, f64::from(k) + 0.5];
                let shaken: [f64; 3] = std::array::from_fn(|c| at[c] + 0.1 * noise(count + c));
                places.push([shaken[0].abs(), shaken[1], shaken[2]]);
            }
        }
    }
    let fill = |places: &[[f64; 3]]| {
        let mut state = State::new(METAL);
        patch::declare(&mut state.metal);
        for position in places {
            state.push(Particle {
                position: *position,
                velocity: [0.0; 3],
                phase: phase::LIQUID,
                droplet: false,
                wall: false,
                temperature: 0.0,
                enthalpy: 0.0,
            });
        }
        state
    };
    let mut half = fill(&places);
    let faces: crate::faces::Parameters = serde_json::from_str(
        r#"{"min_m": [0, -50, -50], "max_m": [50, 50, 50], "mirror": ["x-"]}"#,
    )
    .unwrap();
    half.faces = faces.faces(METAL.support(), false).unwrap();
    let images = places.iter().map(|[x, y, z]| [-x, *y, *z]);
    let all: Vec<[f64; 3]> = places.iter().copied().chain(images).collect();
    [half, fill(&all)]
}

#[test]
fn half_beside_a_mirror_is_measured_as_the_whole_is() {
    for off in [0.5, 0.3, 0.15, 0.05, 0.9] {
        let [mut half, mut whole] = beside_mirror(off);
        Surface::new(METAL).advance(&mut whole, 0.0).unwrap();
        for flows in [false, true] {
            half.flowing = flows;
            if flows {
                half.gather();
            }
            Surface::new(METAL).advance(&mut half, 0.0).unwrap();
            for (a, (own, other)) in patches(&half).zip(patches(&whole)).enumerate() {
                let what = format!("{off}, flows {flows}, particle {a}: {own:?} {other:?}");
                assert!((own.area - other.area).abs() < 1e-4, "{what}");
                assert!((own.seen - other.seen).abs() < 1e-4, "{what}");
                let turned = dot(own.normal, other.normal) < 0.9999;
                assert!(own.area <= 0.0 || !turned, "{what}");
            }
        }
    }
}

#[test]
fn a_lid_is_the_surface_of_what_lies_beneath_it() {
    for flows in [false, true] {
        let [mut lidded, _] = beside_mirror(0.5);
        let [mut bare, _] = beside_mirror(0.5);
        let faces: crate::faces::Parameters = serde_json::from_str(
            r#"{"min_m": [0, -50, -50], "max_m": [50, 50, 0], "mirror": ["x-"], "lid": ["z+"]}"#,
        )
        .unwrap();
        lidded.faces = faces.faces(METAL.support(), false).unwrap();
        for state in [&mut lidded, &mut bare] {
            state.flowing = flows;
            if flows {
                state.gather();
            }
            Surface::new(METAL).advance(state, 0.0).unwrap();
        }
        let total: f64 = patches(&lidded).map(|own| own.area).sum();
        assert!(total > 80.0, "{total}");
        for (a, (own, other)) in patches(&lidded).zip(patches(&bare)).enumerate() {
            let what = format!("flows {flows}, particle {a}: {own:?} {other:?}");
            assert!((own.area - other.area).abs() < 1e-4, "{what}");
            assert!((own.seen - other.seen).abs() < 1e-4, "{what}");
            assert!((own.depth - other.depth).abs() < 1e-4, "{what}");
        }
    }
}

#[test]
fn what_falls_on_a_pool_within_a_plate_is_taken_whole() {
    let mut state = State::new(METAL);
    patch::declare(&mut state.metal);
    let inside = |x: f64, z: f64| x.abs() < 3.0 && z > -2.0;
    for i in -9..9 {
        for j in -9..9 {
            for k in -6..0 {
                let position = [i, j, k].map(|n| f64::from(n) + 0.5);
                state.push(Particle {
                    position,
                    velocity: [0.0; 3],
                    phase: phase::SOLID,
                    droplet: false,
                    wall: false,
                    temperature: 0.0,
                    enthalpy: 0.0,
                });
            }
        }
    }
    let mut stage = Surface::new(METAL);
    stage.advance(&mut state, 0.0).unwrap();
    let seen = |state: &State| patches(state).map(|p| p.seen).sum::<f64>();
    assert!((seen(&state) / 324.0 - 1.0).abs() < 1e-12);
    // A pool of two layers melts and stirs.
    for a in 0..state.len() {
        let [x, y, z] = state.metal.column(&POSITION)[a];
        if inside(x, z) && inside(y, z) {
            state.metal.column_mut(&PHASE)[a] = phase::LIQUID;
            let shaken = [x, y, z].map(|c| c + 0.3 * noise(a + (7.0 * c) as usize));
            state.metal.column_mut(&POSITION)[a] = shaken;
        }
    }
    state.flowing = true;
    state.gather();
    stage.advance(&mut state, 0.0).unwrap();
    let part = seen(&state) / 324.0;
    assert!((part - 1.0).abs() < 2e-3, "{part}");
}
