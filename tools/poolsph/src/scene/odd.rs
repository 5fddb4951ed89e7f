//! What a scene may say and hardly means, told before it runs.

use super::Scene;
use super::Wire;
use super::body::{BodyScene, StartState};
use crate::domain::droplet::shape;
use crate::domain::shape::Shape;
use crate::motion::Method;

/// Notes on what will not happen although the scene names it.
#[must_use]
pub fn notes(scene: &Scene) -> Vec<String> {
    let mut notes = Vec::new();
    notes.extend(shortened(scene));
    let beside = astray(scene).filter(|told| told != NEVER || scene.grains.is_some());
    notes.extend(beside);
    notes.extend(unwritten(scene));
    notes.extend(outside(scene));
    notes.extend(still(scene));
    notes.extend(unheated(scene));
    notes.extend(apart(scene));
    notes.extend(super::arcs::blurred(scene));
    notes
}

/// Steps that do not end where the run does.
fn shortened(scene: &Scene) -> Option<String> {
    let (asked, taken) = (scene.time.step_s, scene.step());
    (taken < asked).then(|| {
        let (steps, end) = (scene.steps(), scene.time.end_s);
        format!("{steps} steps of {taken:e} s are taken: those of {asked} s do not end at {end} s")
    })
}

/// What a run ends with warnings for, and is known before.
#[must_use]
pub fn doubts(scene: &Scene) -> Vec<String> {
    let mut doubts = thin(scene);
    doubts.extend(roomless(scene));
    doubts.extend(lumpy(scene));
    doubts.extend(super::slag::unbalanced(scene));
    let beside = astray(scene).filter(|told| told == NEVER);
    doubts.extend(beside.filter(|_| scene.grains.is_none()));
    doubts
}

/// Grains among metal whose way of flowing does not know the room that they take.
fn roomless(scene: &Scene) -> Option<String> {
    let flow = scene.flow.as_ref()?;
    let meet = scene.grains.is_some() && !scene.bodies.is_empty();
    (meet && flow.method != Method::Projection).then(|| {
        "grains take no room in this liquid, and what floats lies too deep: \"method\": \"projection\" of the flow knows it"
            .to_owned()
    })
}

/// Part of its volume by which a droplet may differ from a ball of its radius.
const LUMPY: f64 = 0.1;
/// How many times the volume of that ball it may be where what is fed is kept, and the inverse.
const SPARSE: f64 = 2.0;

/// Particles of a droplet, its volume and that of a ball of its radius \[m3\], on both sides of a mirror that halves it.
struct Held {
    particles: usize,
    volume: f64,
    ball: f64,
}

impl Held {
    fn of(scene: &Scene, wire: &Wire) -> Self {
        let (spacing, radius) = (scene.metal().spacing, wire.droplets.radius_m);
        let mirror = scene.halving(wire).ok().flatten();
        let sides = if mirror.is_some() { 2 } else { 1 };
        let particles = sides * shape(radius, spacing, mirror).len();
        Self {
            particles,
            volume: particles as f64 * spacing.powi(3),
            ball: 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
        }
    }
}

/// Droplets that hold another volume than balls of their radius: those that come as often as the scene says, and those that come more
/// or less often for it.
fn lumpy(scene: &Scene) -> Vec<String> {
    let told = |wire: &Wire| {
        let Held {
            particles,
            volume,
            ball,
        } = Held::of(scene, wire);
        let (at, ratio) = (&wire.at, volume / ball);
        if wire.droplets.period_s.is_some() {
            return ((ratio - 1.0).abs() > LUMPY).then(|| {
                format!(
                    "{at}: {particles} particles of a droplet are {volume:.3e} m3, a ball of its radius {ball:.3e} m3, and so are \
                     mass and heat: \"feed_m3_s\" in place of \"period_s\" keeps what is fed"
                )
            });
        }
        (ratio.max(1.0 / ratio) > SPARSE).then(|| {
            format!(
                "{at}: a droplet of {particles} particles is {ratio:.2} times a ball of its radius: what is fed is kept, but droplets \
                 come {:.2} times as often; a smaller \"spacing_m\" resolves them",
                1.0 / ratio
            )
        })
    };
    scene.wires().filter_map(|wire| told(&wire)).collect()
}

/// Fewest layers of particles that carry what lies on them: the kernel reaches over two spacings.
const TIGHT: f64 = 2.0;

/// Resting bodies that a liquid meets and that are too thin to hold it.
fn thin(scene: &Scene) -> Vec<String> {
    if scene.flow.is_none() {
        return Vec::new();
    }
    let rests = |body: &BodyScene| {
        // The walls of a container have their own least thickness.
        body.state != StartState::Liquid && !matches!(body.shape, Shape::Container(_))
    };
    let lattice = scene.lattice();
    let layers = |body: &BodyScene| {
        let sites = body.shape.sites(lattice.pitch);
        sites.into_iter().fold(f64::INFINITY, f64::min)
    };
    let bodies = scene.bodies.iter().enumerate();
    bodies
        .filter(|(_, body)| rests(body) && layers(body) < TIGHT)
        .map(|(i, _)| {
            format!(
                "body {i} is one particle thick: liquid leaks through it; {TIGHT} layers, {} m, hold",
                TIGHT * lattice.spacing()
            )
        })
        .collect()
}

/// Ways of heat that are asked for where there is none.
fn unheated(scene: &Scene) -> Option<String> {
    let none = scene.heat_ways().is_empty();
    (scene.output.heat_received && none).then(|| {
        "heat_received: no column is written, for nothing heats or cools the metal: neither arc, torches, losses nor grains with heat"
            .to_owned()
    })
}

/// A source that heats and feeds nothing.
const NEVER: &str = "the source is never above a body";

/// The source beside the bodies, seen from above.
fn astray(scene: &Scene) -> Option<String> {
    let source = scene.source?;
    let end = scene.time.end_s;
    let (min, max) = around(scene)?;
    // The times between which it is within the bodies along both axes.
    let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
    for axis in 0..2 {
        let (x, u) = (source.start_m[axis], source.velocity_m_s[axis]);
        if u == 0.0 {
            if x < min[axis] || x > max[axis] {
                leaves = f64::NEG_INFINITY;
            }
            continue;
        }
        let [a, b] = [min[axis], max[axis]].map(|edge| (edge - x) / u);
        enters = enters.max(a.min(b));
        leaves = leaves.min(a.max(b));
    }
    if leaves < enters || enters > end {
        Some(NEVER.to_owned())
    } else if leaves < end {
        Some(format!(
            "the source leaves the bodies at {leaves:.4} s, before the end at {end} s"
        ))
    } else if enters > 0.0 {
        Some(format!("the source is above no body before {enters:.4} s"))
    } else {
        None
    }
}

/// The box around all bodies \[m\].
fn around(scene: &Scene) -> Option<([f64; 3], [f64; 3])> {
    let boxes = scene.bodies.iter().map(|body| body.shape.bounds());
    boxes.reduce(|(a, b), (c, d)| {
        let low = std::array::from_fn(|k| a[k].min(c[k]));
        let high = std::array::from_fn(|k| b[k].max(d[k]));
        (low, high)
    })
}

/// Output that never comes.
fn unwritten(scene: &Scene) -> Vec<String> {
    let (end, output) = (scene.time.end_s, &scene.output);
    let mut notes = Vec::new();
    let mut rare = |key: &str, what: &str, interval: f64| {
        if interval > end {
            notes.push(format!(
                "{what} of the start and the end alone are written: {key} is {interval} s, the end at {end} s"
            ));
        }
    };
    rare(
        "particles_interval_s",
        "particles",
        output.particles_interval_s,
    );
    if let Some(interval) = output.balance_interval_s {
        rare("balance_interval_s", "balances", interval);
    }
    if let Some(pool) = output.pool.filter(|pool| pool.from_s > end) {
        notes.push(format!(
            "/pool stays empty: it begins at {} s, the end is at {end} s",
            pool.from_s
        ));
    }
    notes
}

/// Bodies that the bounds cut.
fn outside(scene: &Scene) -> Vec<String> {
    let Some(bounds) = scene.bounds else {
        return Vec::new();
    };
    let cut = |(low, high): ([f64; 3], [f64; 3])| {
        (0..3).any(|k| low[k] < bounds.min_m[k] || high[k] > bounds.max_m[k])
    };
    let bodies = scene.bodies.iter().enumerate();
    bodies
        .filter(|(_, body)| cut(body.shape.bounds()))
        .map(|(i, _)| format!("body {i} reaches out of 'bounds': liquid there is caught at once"))
        .collect()
}

/// A flow in which nothing can flow.
fn still(scene: &Scene) -> Option<String> {
    let liquid = scene
        .bodies
        .iter()
        .any(|body| body.state == StartState::Liquid);
    let melts = scene
        .heat
        .as_ref()
        .is_some_and(|heat| heat.melting.is_some());
    let fed = scene.wires().next().is_some();
    (scene.flow.is_some() && !liquid && !melts && !fed)
        .then(|| "nothing will move: no body is liquid, none can melt, no droplets come".to_owned())
}

/// Grains and metal of which one has no heat to give.
fn apart(scene: &Scene) -> Option<String> {
    let grains = scene.grains.as_ref().filter(|_| scene.has_metal())?;
    let key = match (grains.heat.is_some(), scene.heat.is_some()) {
        (true, false) => "heat",
        (false, true) => "grains/heat",
        _ => return None,
    };
    Some(format!(
        "grains and metal exchange no heat: there is no key '{key}'"
    ))
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::scene::Time;

    fn plain() -> Value {
        json!({
            "spacing_m": 1e-3,
            "time": {"step_s": 1e-4, "end_s": 2.0},
            "density_kg_m3": 7850,
            "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.01, 0.02, 0.005]}}, "state": "liquid"}],
            "flow": {"method": "projection", "viscosity_pa_s": 0.004},
            "output": {"particles_interval_s": 0.1}
        })
    }

    fn told(patch: &Value) -> Vec<String> {
        let mut scene = plain();
        for (key, value) in patch.as_object().unwrap() {
            scene[key] = value.clone();
        }
        let scene = serde_json::from_value(scene).unwrap();
        [doubts(&scene), notes(&scene)].concat()
    }

    fn source(start: [f64; 2], velocity: [f64; 2]) -> Vec<String> {
        let [[x, y], [u, v]] = [start, velocity];
        told(&json!({"source": {"start_m": [x, y, 0], "velocity_m_s": [u, v, 0]}}))
    }

    #[test]
    fn what_means_what_it_says_needs_no_note() {
        assert!(told(&json!({})).is_empty());
        assert!(source([0.005, 0.0], [0.0, 0.01]).is_empty());
    }

    #[test]
    fn steps_end_where_the_run_does() {
        let time = |step: f64, end: f64| json!({"time": {"step_s": step, "end_s": end}});
        assert!(told(&time(1e-4, 0.15)).is_empty());
        let told = told(&time(3e-4, 1e-3));
        assert!(told[0].contains("4 steps of 2.5e-4 s"), "{told:?}");
        for (step_s, end_s) in [(3e-4, 1e-3), (7e-5, 0.01), (1.1e-3, 2e-3), (1e-4, 10.0)] {
            let time = Time {
                step_s,
                end_s,
                adaptive: None,
            };
            let end = time.steps() as f64 * time.step();
            assert!((end / end_s - 1.0).abs() < 1e-9 && time.step() <= step_s);
        }
    }

    #[test]
    fn droplets_of_too_few_particles_are_told() {
        let weld = |spacing: f64, halved: bool| {
            let mirror = if halved { json!(["x-"]) } else { json!([]) };
            told(&json!({
                "spacing_m": spacing,
                "source": {"start_m": [0, 0, 0], "velocity_m_s": [0, 0.01, 0]},
                "faces": {"min_m": [0, 0, 0], "max_m": [0.01, 0.02, 0.05], "mirror": mirror},
                "droplets": {"feed_m3_s": 1.5e-7, "radius_m": 7.5e-4, "height_m": 0.02, "speed_m_s": 1.5, "temperature_k": 2000}
            }))
        };
        // Lattice points within the radius: 19 of 0.5 mm, 7 of 0.714 mm; beside the plane 2 x 10 and 2 x 1.
        for (spacing, halved) in [(5e-4, false), (5e-4, true), (7.14e-4, false)] {
            let said = weld(spacing, halved).concat();
            assert!(
                !said.contains("of a droplet") && !said.contains("a droplet of"),
                "{said}"
            );
        }
        let said = weld(7.14e-4, true).concat();
        assert!(
            said.contains("a droplet of 2 particles is 0.41 times a ball"),
            "{said}"
        );
        assert!(said.contains("come 2.42 times as often"), "{said}");
    }

    #[test]
    fn a_wall_of_one_layer_is_told() {
        let scene = |state: &str, high: f64| {
            let mut scene: Scene = serde_json::from_value(plain()).unwrap();
            let floor = json!({"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.01, 0.02, high]}}, "state": state});
            scene.bodies = vec![serde_json::from_value(floor).unwrap()];
            scene
        };
        for state in ["wall", "solid"] {
            assert!(thin(&scene(state, 1e-3))[0].contains("body 0"));
            assert!(thin(&scene(state, 2e-3)).is_empty());
        }
        assert!(thin(&scene("liquid", 1e-3)).is_empty());
        let mut still = scene("wall", 1e-3);
        still.flow = None;
        assert!(thin(&still).is_empty());
    }

    #[test]
    fn grains_without_room_are_told() {
        let doubt = |method: &str, grains: bool| {
            let mut scene = plain();
            scene["flow"]["method"] = json!(method);
            if grains {
                scene["grains"] = json!({"density_kg_m3": 3000, "contact": {"law": {"linear": {"stiffness_n_m": 75}}, "restitution": 0.3},
                    "bodies": [{"places_m": [[0, 0, 0.01]], "radius_m": 0.005}]});
            }
            roomless(&serde_json::from_value(scene).unwrap()).is_some()
        };
        assert!(doubt("divergence_free", true) && doubt("homogenising", true));
        assert!(!doubt("projection", true) && !doubt("divergence_free", false));
    }

    #[test]
    fn a_source_beside_the_metal_is_told() {
        for (start, velocity) in [
            ([0.5, 0.0], [0.0, 0.0]),
            ([0.5, 0.0], [0.1, 0.0]),
            ([-0.1, 0.0], [0.01, 0.01]),
        ] {
            assert_eq!(source(start, velocity), [NEVER], "{start:?}");
        }
        assert!(source([0.005, 0.0], [0.0, 0.04])[0].contains("at 0.5000 s"));
        assert!(source([0.005, -0.01], [0.0, 0.01])[0].contains("before 1.0000 s"));
    }

    #[test]
    fn output_that_never_comes_is_told() {
        let pool = json!({"from_s": 3.0, "interval_s": 0.1, "beside_m": 1.0, "behind_m": 1.0, "ahead_m": 1.0});
        let rare = told(&json!({"output":
            {"particles_interval_s": 5.0, "balance_interval_s": 4.0, "pool": pool}}));
        assert_eq!(rare.len(), 3, "{rare:?}");
        assert!(rare[0].contains("5 s") && rare[1].contains("4 s") && rare[2].contains("3 s"));
    }

    #[test]
    fn bodies_that_bounds_cut_are_told() {
        let bounds =
            |high: f64| told(&json!({"bounds": {"min_m": [0, 0, 0], "max_m": [1, 1, high]}}));
        assert!(bounds(0.005).is_empty());
        assert!(bounds(0.004)[0].contains("body 0"));
    }

    #[test]
    fn a_flow_without_liquid_is_told() {
        let solid = json!([{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.01, 0.02, 0.005]}}, "state": "solid"}]);
        assert!(told(&json!({"bodies": solid}))[0].contains("nothing will move"));
    }

    #[test]
    fn grains_and_metal_of_which_one_is_without_heat_are_told() {
        let heat = json!({"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700});
        let grains = |heat: Option<&Value>| {
            let mut grains = json!({"density_kg_m3": 3230, "bodies": [{"places_m": [[0, 0, 0.01]], "radius_m": 1e-3}],
                "contact": {"law": {"linear": {"stiffness_n_m": 75}}, "restitution": 0.75}});
            if let Some(heat) = heat {
                grains["heat"] = heat.clone();
            }
            grains
        };
        let one = told(&json!({"grains": grains(Some(&heat))}));
        assert!(one[0].contains("'heat'"), "{one:?}");
        let other = told(&json!({"grains": grains(None), "heat": heat}));
        assert!(other[0].contains("'grains/heat'"), "{other:?}");
        assert!(told(&json!({"grains": grains(Some(&heat)), "heat": heat})).is_empty());
        assert!(told(&json!({"grains": grains(None)})).is_empty());
    }
}
