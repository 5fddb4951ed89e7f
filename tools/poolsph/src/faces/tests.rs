use particles::{Matter, POSITION};
use shapes::frame::{difference, dot, squared};

use super::*;
use crate::heat::{self, Conduction, Substances};
use crate::motion::around::Around;
use crate::motion::integration::{CARRIED, PRESSURE};
use crate::motion::noise::Noise;
use crate::motion::viscosity::Viscosity;
use crate::motion::{self, Law, Motion};
use crate::stage::Stage;
use crate::state::{ENTHALPY, Particle, State, TEMPERATURE, VELOCITY, phase};

const METAL: Matter = Matter {
    density: 1000.0,
    spacing: 1.0,
    smoothing_length: 1.0,
};

fn faces(text: &str) -> Faces {
    let parameters: Parameters = serde_json::from_str(text).unwrap();
    parameters.faces(METAL.support(), true).unwrap()
}

#[test]
fn half_a_weld_has_one_mirror_across() {
    let mirror = |faces: &str| {
        let text = format!(r#"{{"min_m": [0.5, 0, 0], "max_m": [9, 9, 9], "mirror": {faces}}}"#);
        let parameters: Parameters = serde_json::from_str(&text).unwrap();
        parameters.mirror_x_m()
    };
    assert_eq!(mirror(r#"["x-"]"#), Some(0.5));
    assert_eq!(mirror(r#"["z-", "x+"]"#), Some(9.0));
    assert_eq!(mirror(r#"["x-", "x+"]"#), None);
    assert_eq!(mirror(r#"["y-"]"#), None);
}

/// Liquid at the places of a box of cells, each moved a little, with velocities of its own.
fn body(faces: Faces, points: impl IntoIterator<Item = ([f64; 3], [f64; 3])>) -> State {
    let mut state = State::new(METAL);
    state.metal.declare(&PRESSURE);
    state.metal.declare(&CARRIED);
    state.faces = faces;
    state.flowing = true;
    for (position, velocity) in points {
        state.push(Particle {
            position,
            velocity,
            phase: phase::LIQUID,
            droplet: false,
            wall: false,
            temperature: 300.0,
            enthalpy: 0.0,
        });
    }
    state
}

/// A disordered box of cells from the origin on.
fn disordered(cells: [i32; 3]) -> Vec<([f64; 3], [f64; 3])> {
    let wave = |seed: f64, step: f64| (seed * step).sin();
    let count = cells.iter().product::<i32>();
    let point = |n: i32| {
        let index = [
            n % cells[0],
            n / cells[0] % cells[1],
            n / cells[0] / cells[1],
        ];
        let seed = f64::from(n) + 0.7;
        let moved = [12.9, 78.2, 37.7].map(|step| wave(seed, step));
        let speed = [3.1, 5.3, 7.7].map(|step| wave(seed, step));
        let place = std::array::from_fn(|k| f64::from(index[k]) + 0.5 + 0.2 * moved[k]);
        (place, speed)
    };
    (0..count).map(point).collect()
}

/// Sums of W, grad W and |grad W|^2 by index in the state.
fn sums(state: &mut State, count: usize) -> Vec<[f64; 5]> {
    state.gather();
    let mut sums = vec![[0.0; 5]; count];
    for a in 0..state.near.len() {
        let id = state.near.id[a] as usize;
        if id < count {
            let [x, y, z] = state.near.gradient[a];
            sums[id] = [state.near.number[a], x, y, z, state.near.squares[a]];
        }
    }
    sums
}

fn alike(found: &[[f64; 5]], expected: &[[f64; 5]]) {
    for (a, (found, expected)) in found.iter().zip(expected).enumerate() {
        for (f, e) in found.iter().zip(expected) {
            assert!(
                (f - e).abs() < 1e-6 * expected[0],
                "{a}: {found:?} {expected:?}"
            );
        }
    }
}

#[test]
fn beside_periodic_faces_sums_are_those_of_the_repeated_body() {
    let points = disordered([6, 5, 5]);
    let own = points.len();
    let text = r#"{"min_m": [0, 0, 0], "max_m": [6, 5, 9], "periodic": ["x", "y"]}"#;
    let mut one = body(faces(text), points.clone());
    let mut shifts = vec![[0, 0]];
    shifts.extend(
        (0..9)
            .map(|n| [n % 3 - 1, n / 3 - 1])
            .filter(|s| *s != [0, 0]),
    );
    let tiles = shifts.iter().flat_map(|[i, j]| {
        let shift = [6.0 * f64::from(*i), 5.0 * f64::from(*j), 0.0];
        let moved =
            move |(x, u): &([f64; 3], [f64; 3])| (std::array::from_fn(|k| x[k] + shift[k]), *u);
        points.iter().map(moved)
    });
    let mut nine = body(Faces::default(), tiles);
    let (found, expected) = (sums(&mut one, own), sums(&mut nine, own));
    alike(&found, &expected);
    let pairs = |state: &State| -> usize {
        let near = &state.near;
        let own_rows = (0..near.len()).filter(|a| (near.id[*a] as usize) < own);
        own_rows.map(|a| near.lists.row(a).len()).sum()
    };
    assert_eq!(pairs(&one), pairs(&nine));
}

/// A body and itself turned over at x = 0.
fn with_its_image(points: &[([f64; 3], [f64; 3])]) -> Vec<([f64; 3], [f64; 3])> {
    let turned = |(x, u): &([f64; 3], [f64; 3])| ([-x[0], x[1], x[2]], [-u[0], u[1], u[2]]);
    points
        .iter()
        .copied()
        .chain(points.iter().map(turned))
        .collect()
}

const HALF: &str = r#"{"min_m": [0, 0, 0], "max_m": [9, 9, 9], "mirror": ["x-"]}"#;

#[test]
fn beside_a_mirror_sums_are_those_of_the_whole_body() {
    let points = disordered([5, 5, 5]);
    let mut half = body(faces(HALF), points.clone());
    let mut whole = body(Faces::default(), with_its_image(&points));
    let (found, expected) = (sums(&mut half, 125), sums(&mut whole, 125));
    alike(&found, &expected);
}

#[test]
fn half_a_body_beside_a_mirror_moves_as_the_whole() {
    // Without divergence the pressure is one of single precision. At one corner ten steps make 2e-4 of that.
    for (method, most) in [("divergence_free", 3e-4), ("projection", 1e-5)] {
        let points = disordered([5, 5, 5]);
        let mut half = body(faces(HALF), points.clone());
        let mut whole = body(Faces::default(), with_its_image(&points));
        let text = format!(
            r#"{{"method": "{method}", "viscosity_pa_s": 10.0, "gravity_m_s2": [0, 0, -1], "density_tolerance": 1e-8,
                "sweeps_max": 1000}}"#
        );
        for state in [&mut half, &mut whole] {
            let parameters: motion::Parameters = serde_json::from_str(&text).unwrap();
            let mut motion = Motion::new(parameters, Law::Uniform(10.0), METAL);
            for _ in 0..10 {
                state.gather();
                motion.advance(state, 0.02).unwrap();
            }
        }
        let [half, whole] = [&half, &whole].map(|state| state.metal.column(&POSITION));
        for a in 0..points.len() {
            let apart = squared(difference(half[a], whole[a])).sqrt();
            assert!(apart < most, "{method}, {a}: {apart}");
            let turned = whole[a + points.len()];
            let off = (turned[0] + whole[a][0]).abs();
            assert!(off < most, "{method}, {a}: {off}");
            assert!(half[a][0] >= 0.0);
        }
    }
}

#[test]
fn a_lid_is_a_mirror_of_the_flow_and_none_of_the_surface() {
    let with = |rest: &str| {
        let text = format!(r#"{{"min_m": [0, 0, 0], "max_m": [9, 9, 5], {rest}}}"#);
        body(faces(&text), disordered([5, 5, 5]))
    };
    let mut lidded = with(r#""mirror": ["x-"], "lid": ["z+"]"#);
    let mut mirrored = with(r#""mirror": ["x-", "z+"]"#);
    let (found, expected) = (sums(&mut lidded, 125), sums(&mut mirrored, 125));
    assert_eq!(found, expected);
    let open = lidded.faces.without_lids().unwrap();
    assert!(open.is_mirror(0, 0) && open.planes(2) == [None; 2]);
    assert!(mirrored.faces.without_lids().is_none());
}

#[test]
fn what_a_lid_makes_idle_is_told() {
    let text = r#"{"min_m": [0, 0, 0], "max_m": [9, 9, 9], "lid": ["z+"]}"#;
    let parameters: Parameters = serde_json::from_str(text).unwrap();
    let told = parameters.under_lids(["tension"].into_iter());
    assert!(told[0].to_string().contains("'tension'"), "{told:?}");
    let none: Parameters = serde_json::from_str(&text.replace("lid", "mirror")).unwrap();
    assert!(none.under_lids(["tension"].into_iter()).is_empty());
}

#[test]
fn walls_hold_speed_and_temperature_in_their_planes() {
    let text = r#"{"min_m": [0, 0, 0], "max_m": [4, 4, 4],
        "wall": [{"face": "z+", "velocity_m_s": [2, 0, 0], "temperature_k": 400}, {"face": "z-", "temperature_k": 300}]}"#;
    let faces = faces(text);
    let mut images = Images::default();
    // Speed and temperature are linear between the walls, and so they are beyond.
    let profile = |z: f64| 0.25 * z;
    let mut places = vec![[1.0, 1.0, 3.2], [1.0, 1.0, 0.3], [1.0, 1.0, 2.0]];
    let mut speeds: Vec<[f64; 3]> = places
        .iter()
        .map(|x| [2.0 * profile(x[2]), 0.0, 0.0])
        .collect();
    let kelvin: Vec<f64> = places
        .iter()
        .map(|x| 300.0 + 100.0 * profile(x[2]))
        .collect();
    images.place(&faces, 1.9, &mut places);
    assert_eq!(images.len(), 2);
    images.complete(&mut speeds, |u, _, turn| turn.velocity(u));
    for k in 3..5 {
        let z = places[k][2];
        assert!((speeds[k][0] - 2.0 * profile(z)).abs() < 1e-12);
        let of = images.list()[k - 3].of as usize;
        let turn = images.turn(k).unwrap();
        let image = faces
            .temperature(turn, places[of], 0.0, kelvin[of])
            .unwrap();
        assert!((image - 300.0 - 100.0 * profile(z)).abs() < 1e-12);
    }
    assert!(images.turn(2).is_none());
}

#[test]
fn what_goes_through_a_face_comes_back() {
    let text = r#"{"min_m": [0, 0, 0], "max_m": [6, 6, 6], "periodic": ["x"], "mirror": ["y-"],
        "wall": [{"face": "z+"}]}"#;
    let faces = faces(text);
    for (x, u, place, speed) in [
        (
            [-0.5, 1.0, 1.0],
            [-1.0, 0.0, 0.0],
            [5.5, 1.0, 1.0],
            [-1.0, 0.0, 0.0],
        ),
        (
            [6.0, 1.0, 1.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 1.0],
            [1.0, 0.0, 0.0],
        ),
        (
            [1.0, -0.25, 1.0],
            [1.0, -2.0, 0.0],
            [1.0, 0.25, 1.0],
            [1.0, 2.0, 0.0],
        ),
        (
            [1.0, 1.0, 6.5],
            [0.0, 0.0, 3.0],
            [1.0, 1.0, 5.5],
            [0.0, 0.0, -3.0],
        ),
        (
            [1.0, 9.0, -4.0],
            [1.0, 1.0, -1.0],
            [1.0, 9.0, -4.0],
            [1.0, 1.0, -1.0],
        ),
    ] {
        let (mut at, mut going) = (x, u);
        faces.fold(&mut at, &mut going);
        assert_eq!((at, going), (place, speed));
    }
}

#[test]
fn faces_that_cannot_be_are_refused_by_name() {
    let told = |text: &str| {
        let parameters: Parameters = serde_json::from_str(text).unwrap();
        parameters.faces(2.0, false).unwrap_err().to_string()
    };
    let box_of = |rest: &str| format!(r#"{{"min_m": [0, 0, 0], "max_m": [6, 6, 1], {rest}}}"#);
    let twice = told(&box_of(r#""periodic": ["x"], "mirror": ["x+"]"#));
    assert!(
        twice.contains("/mirror/0") && twice.contains("'x+'"),
        "{twice}"
    );
    let thin = told(&box_of(r#""mirror": ["z-", "z+"]"#));
    assert!(
        thin.contains("/max_m/2") && thin.contains("at least 2 m"),
        "{thin}"
    );
    let across = told(&box_of(
        r#""wall": [{"face": "x-", "velocity_m_s": [1, 0, 0]}]"#,
    ));
    assert!(across.contains("/wall/0/velocity_m_s/0"), "{across}");
    let cold = told(&box_of(r#""wall": [{"face": "x-", "temperature_k": 300}]"#));
    assert!(cold.contains("/wall/0/temperature_k"), "{cold}");
    let angle = |faces: &str, angles: &str| {
        told(&box_of(&format!(
            r#"{faces}, "contact_angles": [{angles}]"#
        )))
    };
    let one = r#"{"face": "x-", "angle_deg": 60}"#;
    let nowhere = angle(r#""mirror": ["x+"]"#, one);
    assert!(
        nowhere.contains("/contact_angles/0/face") && nowhere.contains("neither"),
        "{nowhere}"
    );
    let through = angle(r#""periodic": ["x"]"#, one);
    assert!(through.contains("'x-' is periodic"), "{through}");
    let two = angle(r#""mirror": ["x-"]"#, &format!("{one}, {one}"));
    assert!(two.contains("/contact_angles/1/face"), "{two}");
}

#[test]
fn beyond_a_face_a_surface_goes_on_at_its_contact_angle() {
    // A plane that meets the floor at theta goes on as the same plane, whichever way it faces.
    let floor = [30.0_f64, 60.0, 90.0, 135.0].map(|angle| (angle, "z-", 0.5, 1.0));
    for (degrees, face, beside, up) in floor.into_iter().chain([(50.0, "z+", 8.5, -1.0)]) {
        let text = format!(
            r#"{{"min_m": [0, 0, 0], "max_m": [9, 9, 9], "mirror": ["{face}", "x-"],
            "contact_angles": [{{"face": "{face}", "angle_deg": {degrees}}}]}}"#
        );
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut images = Images::default();
        let mut places = vec![[5.0, 4.0, beside]];
        images.place(&faces(&text), 1.0, &mut places);
        assert_eq!(images.len(), 1);
        for turn in [0.0_f64, 1.0, 2.5] {
            let normal = [sin * turn.cos(), sin * turn.sin(), up * cos];
            let (place, turned) = images.turn(1).unwrap().surface(places[0], normal);
            let away = dot(difference(place, places[0]), normal);
            assert!(
                away.abs() < 1e-14 && (place[2] - beside + up).abs() < 1e-14,
                "{place:?}"
            );
            let off = squared(difference(turned, normal));
            assert!(off < 1e-28, "{degrees} degrees: {turned:?} for {normal:?}");
            let facing = images.turn(1).unwrap().facing(normal);
            assert!(squared(difference(facing, turned)) <= 0.0);
        }
    }
}

#[test]
fn a_right_contact_angle_is_none() {
    let text = r#"{"min_m": [0, 0, 0], "max_m": [6, 6, 6], "mirror": ["z-"], "contact_angles": [{"face": "z-", "angle_deg": 90}]}"#;
    let (mut images, mut places) = (Images::default(), vec![[3.0, 3.0, 0.5]]);
    images.place(&faces(text), 1.0, &mut places);
    assert!(images.tilted_faces().is_empty() && !images.turn(1).unwrap().tilts());
}

#[test]
fn contact_angles_want_tension_and_a_flow_without_divergence() {
    let text = r#"{"min_m": [0, 0, 0], "max_m": [6, 6, 6], "mirror": ["z-"], "contact_angles": [{"face": "z-", "angle_deg": 60}]}"#;
    let parameters: Parameters = serde_json::from_str(text).unwrap();
    assert!(parameters.meaningless_angles(true, true).is_none());
    let told = |tension, even| {
        parameters
            .meaningless_angles(tension, even)
            .unwrap()
            .to_string()
    };
    assert!(
        told(false, true).contains("'tension'") && told(true, false).contains("divergence_free")
    );
}

/// A lattice of 5 x 5 x 6 cells between two walls.
fn between(text: &str) -> State {
    let cell = |n: i32| [n % 5, n / 5 % 5, n / 25].map(|i| f64::from(i) + 0.5);
    let mut state = body(
        faces(text),
        (0..150).map(|n| (cell(n), [cell(n)[2], 0.0, 0.0])),
    );
    for (a, x) in state.metal.column(&POSITION).to_vec().iter().enumerate() {
        state.metal.column_mut(&VELOCITY)[a] = [2.0 * x[2] / 6.0, 0.0, 0.0];
    }
    state
}

const BETWEEN: &str = r#"{"min_m": [0, 0, 0], "max_m": [5, 5, 6], "periodic": ["x", "y"],
    "wall": [{"face": "z-", "temperature_k": 300},
             {"face": "z+", "velocity_m_s": [2, 0, 0], "temperature_k": 360}]}"#;

#[test]
fn a_linear_profile_between_walls_feels_no_viscosity() {
    let mut state = between(BETWEEN);
    state.gather();
    let near = &state.near;
    let (mut around, mut change) = (Around::default(), vec![[0.0; 3]; near.len()]);
    around.sum(near, &near.velocity);
    let mut viscosity = Viscosity::new(Law::Uniform(3.0), METAL);
    viscosity.apply(near, &around, 1.0, &mut change);
    let mut noise = Noise::new(9.8, METAL);
    noise.damp(near, &mut around, &viscosity, 1.0, &mut change);
    let mut between_faces = vec![[0.0; 3]; near.len()];
    viscosity.apply_between_faces(near, 1.0, &mut between_faces);
    for (a, change) in change.iter().chain(&between_faces).enumerate() {
        assert!(squared(*change).sqrt() < 1e-13, "{a}: {change:?}");
    }
}

#[test]
fn between_walls_heat_flows_as_fourier_says() {
    let text = r#"{"thermal_conductivity_w_m_k": 7.0, "specific_heat_j_kg_k": 1.0}"#;
    let parameters: heat::Parameters = serde_json::from_str(text).unwrap();
    let caloric = parameters.caloric().unwrap();
    let cells = between(BETWEEN);
    let mut state = State::new(METAL);
    state.metal.declare(&TEMPERATURE);
    state.metal.declare(&ENTHALPY);
    (state.faces, state.flowing) = (cells.faces, true);
    for &position in cells.metal.column(&POSITION) {
        let temperature = 300.0 + 10.0 * position[2];
        state.push(Particle {
            position,
            velocity: [0.0; 3],
            phase: phase::LIQUID,
            droplet: false,
            wall: false,
            temperature,
            enthalpy: caloric.enthalpy(temperature),
        });
    }
    let mut conduction = Conduction::new(&parameters, Substances::of(caloric, METAL), METAL)
        .unwrap()
        .beside_walls(true);
    for _ in 0..3 {
        state.gather();
        conduction.advance(&mut state, 1.0).unwrap();
    }
    for (x, kelvin) in state
        .metal
        .column(&POSITION)
        .iter()
        .zip(state.metal.column(&TEMPERATURE))
    {
        assert!(
            (kelvin - 300.0 - 10.0 * x[2]).abs() < 1e-9,
            "{x:?} {kelvin}"
        );
    }
    // What comes in above goes out below: k/d 10 K on each of the cells, as far as the layers reach.
    let told = |conduction: &Conduction, name: &str| {
        let figures = conduction.figures();
        figures
            .iter()
            .find(|figure| figure.name == name)
            .unwrap()
            .value
    };
    let given = told(&conduction, "energy_in_walls_j");
    let taken = told(&conduction, "energy_out_walls_j");
    assert!(
        (given / taken - 1.0).abs() < 1e-9 && taken > 0.0,
        "{given} {taken}"
    );
    // A colder floor takes k/(d/2) times the difference from the layer beside it, as far as the layers reach.
    let mut colder = faces(&BETWEEN.replace("300", "290"));
    std::mem::swap(&mut state.faces, &mut colder);
    state.gather();
    conduction.advance(&mut state, 1.0).unwrap();
    let out = told(&conduction, "energy_out_walls_j") - told(&conduction, "energy_in_walls_j");
    assert!((out / (25.0 * 7.0 * 10.0) - 2.0).abs() < 0.35, "{out}");
}

#[test]
fn a_source_upon_mirrors_is_here_in_part() {
    let text =
        r#"{"min_m": [0, 0, -1], "max_m": [1, 1, 0], "mirror": ["x-", "y-"], "lid": ["z+"]}"#;
    let parameters: Parameters = serde_json::from_str(text).unwrap();
    let faces = parameters.faces(0.1, true).unwrap();
    let part = |x: [f64; 3], along| (4.0 * faces.part_here(x, along, 0.05)).round() as i32;
    let down = [0.0, 0.0, -1.0];
    assert_eq!(part([0.0; 3], down), 1);
    assert_eq!(part([0.0, 0.5, 0.0], down), 2);
    assert_eq!(part([0.5, 0.5, 0.0], down), 4);
    // Leaning across the one plane, it lies in the other alone.
    assert_eq!(part([0.0; 3], [0.6, 0.0, -0.8]), 2);
}
