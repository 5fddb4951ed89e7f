//! What a schema cannot say of a scene.

use run::Fault;

use shapes::check::{Misfit, check};
use shapes::frame::{difference, length};

use super::{Scene, StartState, Wire, slag};
use crate::domain::shape::Shape;
use crate::grains;
use crate::motion::{Method, OnColdMetal};

/// Most steps of a run: more is a slip of the pen.
const STEPS_MAX: f64 = 1e9;

/// Every fault of the scene as a whole; bodies are checked on their own.
#[must_use]
pub fn faults(scene: &Scene) -> Vec<Fault> {
    let mut faults = Vec::new();
    let time = scene.time;
    let steps = time.end_s / time.step_s;
    if steps < 0.5 {
        let what = format!(
            "{} s is shorter than a step of {} s",
            time.end_s, time.step_s
        );
        faults.push(Fault::at("/time/end_s", what));
    } else if steps > STEPS_MAX {
        let what = format!(
            "{} s is too short: {steps:.1e} steps to {} s, at most {STEPS_MAX:.0e}",
            time.step_s, time.end_s
        );
        faults.push(Fault::at("/time/step_s", what));
    }
    faults.extend(adaptive(scene));
    faults.extend(super::arcs::faults(scene));
    if let Some(grains) = &scene.grains {
        let found = grains::fill::faults(grains);
        faults.extend(found.into_iter().map(|fault| fault.within("/grains")));
    }
    if scene.bodies.is_empty() {
        faults.extend(without_metal(scene));
        return faults;
    }
    faults.extend(unsaid(scene));
    let misshapen = shapes(scene);
    if !misshapen.is_empty() {
        faults.extend(misshapen);
        return faults;
    }
    let metal = scene.metal();
    let ratio = metal.smoothing_length / metal.spacing;
    if !(0.8..=3.0).contains(&ratio) {
        let what = format!(
            "{} m is {ratio:.2} particle diameters; from 0.8 to 3 keep enough neighbours",
            metal.smoothing_length
        );
        faults.push(Fault::at("/smoothing_length_m", what));
    } else if scene.tension.is_some() && !scene.even() && (ratio - 1.0).abs() > 1e-6 {
        let what = format!(
            "{} m is {ratio:.2} particle diameters; the cohesion of this method is calibrated for 1 only",
            metal.smoothing_length
        );
        faults.push(Fault::at("/smoothing_length_m", what));
    }
    faults.extend(dependences(scene).into_iter().chain(sticking(scene)));
    faults.extend(hollows(scene));
    faults.extend(twice(scene));
    faults.extend(beside(scene));
    faults.extend(begun(scene).into_iter().chain(slag::faults(scene)));
    let sizes = super::size::faults(scene);
    if sizes.is_empty() {
        faults.extend(super::lattice::faults(scene));
        faults.extend(scene.wires().filter_map(|wire| crowded(scene, &wire)));
        faults.extend(entangled(scene));
    }
    faults.extend(sizes);
    faults
}

/// What adaptive steps ask for.
fn adaptive(scene: &Scene) -> Vec<Fault> {
    let Some(adaptive) = scene.time.adaptive else {
        return Vec::new();
    };
    let mut faults = Vec::new();
    let (least, most) = (scene.time.step_s, adaptive.greatest_s);
    if most < least {
        let what = format!("{most} s is shorter than the shortest step, {least} s");
        faults.push(Fault::at("/time/adaptive/greatest_s", what).or_at("/time/step_s"));
    }
    faults
}

/// What cannot be told of the metal of an earlier run.
fn begun(scene: &Scene) -> Vec<Fault> {
    if scene.start.is_none() {
        return Vec::new();
    }
    let bodies = scene.bodies.iter().enumerate();
    let held = bodies.filter(|(_, body)| body.held_temperature_k.is_some());
    let mut faults: Vec<Fault> = held
        .map(|(i, _)| {
            let at = format!("/bodies/{i}/held_temperature_k");
            let what = "which particles of the input 'start' keep it is not known";
            Fault::at(&at, what).or_at("/start")
        })
        .collect();
    if !scene.has_metal() {
        let what = "the scene has no bodies, whose metal it would begin with";
        faults.push(Fault::at("/start", what));
    }
    faults
}

/// What a scene of metal must say.
fn unsaid(scene: &Scene) -> Vec<Fault> {
    let keys = [
        ("spacing_m", scene.spacing_m),
        ("density_kg_m3", scene.density_kg_m3),
    ];
    let missing = keys.into_iter().filter(|(_, value)| *value <= 0.0);
    let fault = |key: &str| Fault::at("", format!("needs the key '{key}', as it has bodies"));
    missing.map(|(key, _)| fault(key)).collect()
}

/// What is wrong with shapes.
fn shapes(scene: &Scene) -> Vec<Fault> {
    let mut misfits = Vec::new();
    for (i, body) in scene.bodies.iter().enumerate() {
        if let Some(shape) = body.shape.plain() {
            check(&shape, &format!("/bodies/{i}/shape"), 3, &mut misfits);
        }
    }
    let fault = |misfit: Misfit| Fault::at(&misfit.path, misfit.what);
    misfits.into_iter().map(fault).collect()
}

/// What means nothing in a scene without metal.
fn without_metal(scene: &Scene) -> Vec<Fault> {
    if scene.grains.is_none() {
        let what = "has neither the key 'bodies' nor the key 'grains': nothing is there";
        return vec![Fault::at("", what)];
    }
    let keys = [
        ("flow", scene.flow.is_some()),
        ("heat", scene.heat.is_some()),
        ("source", scene.source.is_some()),
        ("faces", scene.faces.is_some()),
        ("bounds", scene.bounds.is_some()),
        ("droplets", scene.droplets.is_some()),
    ];
    let metal = scene
        .grains
        .as_ref()
        .is_some_and(|grains| grains.metal.is_some());
    let keys = keys.into_iter().chain([("grains/metal", metal)]);
    let there = keys.filter(|(_, there)| *there);
    let fault = |key: &str| Fault::at(&format!("/{key}"), "means nothing without the key 'bodies'");
    there.map(|(key, _)| fault(key)).collect()
}

/// Droplets of two wires that are born into each other: the first of each comes at time 0.
fn entangled(scene: &Scene) -> Option<Fault> {
    let wires: Vec<Wire> = scene.wires().collect();
    let centre = |wire: &Wire| {
        let [x, y, z] = wire.offset_m;
        [x, y, z + wire.droplets.height_m]
    };
    let pairs = (1..wires.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let mut near = pairs.filter_map(|(a, b)| {
        let (one, other) = (&wires[a], &wires[b]);
        let apart = length(difference(centre(one), centre(other)));
        let least = one.droplets.radius_m + other.droplets.radius_m;
        (apart < least * (1.0 - 1e-9)).then(|| {
            let what = format!(
                "its droplets are born {apart:.3e} m from those of {}, within each other: radii of {} m and {} m need {least:.3e} m",
                one.at, one.droplets.radius_m, other.droplets.radius_m
            );
            Fault::at(&other.at, what)
        })
    });
    near.next()
}

/// Droplets that are born into each other.
fn crowded(scene: &Scene, wire: &Wire) -> Option<Fault> {
    let droplets = wire.droplets;
    if let Err(fault) = scene.halving(wire) {
        return Some(fault);
    }
    let period = scene.droplet_period(wire)?;
    let (step, speed) = (scene.step(), droplets.speed_m_s);
    let fallen = speed * period.max(step);
    let high = 2.0 * droplets.radius_m;
    let key = match droplets.period_s {
        Some(_) => "period_s",
        None => "feed_m3_s",
    };
    let what = if period < step {
        format!("a droplet every {period:.3e} s, more often than steps of {step} s")
    } else if fallen < high {
        format!(
            "a droplet every {period:.3e} s, in which the one before it falls {fallen:.3e} m at {speed} m/s: less than the \
             {high} m that it is high"
        )
    } else {
        return None;
    };
    Some(Fault::at(&format!("{}/{key}", wire.at), what))
}

/// Probes of one name.
fn twice(scene: &Scene) -> Option<Fault> {
    let probes = &scene.output.probes;
    let same = |i: &usize| {
        probes[..*i]
            .iter()
            .any(|other| other.name == probes[*i].name)
    };
    let number = (0..probes.len()).find(same)?;
    let what = format!("'{}' is the name of an earlier probe", probes[number].name);
    Some(Fault::at(&format!("/output/probes/{number}/name"), what))
}

/// What the faces of the flow cannot do yet.
fn beside(scene: &Scene) -> Vec<Fault> {
    let Some(faces) = &scene.faces else {
        return Vec::new();
    };
    let mut faults = Vec::new();
    let homogenised = scene
        .flow
        .as_ref()
        .filter(|flow| flow.method == Method::Homogenising);
    if homogenised.is_some() {
        let what = "homogenising knows no images beyond faces: leave \"method\" out, or take \"projection\"";
        faults.push(Fault::at("/flow/method", what));
    }
    let solid = scene
        .bodies
        .iter()
        .position(|body| body.state != StartState::Liquid);
    if let (Some(i), true) = (solid, scene.heat.is_some()) {
        let held = faces
            .wall
            .iter()
            .position(|wall| wall.temperature_k.is_some());
        let at = match held {
            Some(wall) => Some(format!("/faces/wall/{wall}/temperature_k")),
            None => (!faces.periodic.is_empty()).then(|| "/faces/periodic".to_owned()),
        };
        let what = format!("carries heat of liquid only, and body {i} is none");
        faults.extend(at.map(|at| Fault::at(&at, what)));
    }
    let idle = [
        ("tension", scene.tension.is_some()),
        ("arc_pressure", scene.arc_pressure.is_some()),
        ("droplets", scene.wires().next().is_some()),
    ];
    let there = idle.into_iter().filter_map(|(key, is)| is.then_some(key));
    let lids = faces.under_lids(there).into_iter();
    faults.extend(lids.map(|fault| fault.within("/faces")));
    faults
}

/// Containers that no lattice of the spacing fits.
fn hollows(scene: &Scene) -> Vec<Fault> {
    let d = scene.metal().spacing;
    let bodies = scene.bodies.iter().enumerate();
    let odd = bodies.filter_map(|(i, body)| match &body.shape {
        Shape::Container(container) => container.misfit(d).map(|misfit| (i, misfit)),
        _ => None,
    });
    odd.map(|(i, (axis, [less, more]))| {
        let name = ["x", "y", "z"][axis];
        let what = format!(
            "its hollow in {name} is no number of layers of about {d} m: {less:.6} m or {more:.6} m would be"
        );
        Fault::at(&format!("/bodies/{i}/shape/container"), what)
    })
    .collect()
}

/// Metal that is to freeze on contact, and does not melt.
fn sticking(scene: &Scene) -> Option<Fault> {
    let flow = scene.flow.as_ref()?;
    let melts = scene
        .heat
        .as_ref()
        .is_some_and(|heat| heat.melting.is_some());
    let what = "nothing freezes without the key 'melting' in 'heat'";
    (flow.on_cold_metal == OnColdMetal::Sticks && !melts)
        .then(|| Fault::at("/flow/on_cold_metal", what))
}

/// Keys that mean nothing without another.
fn dependences(scene: &Scene) -> Vec<Fault> {
    let flow = ("flow", scene.flow.is_some());
    let heat = ("heat", scene.heat.is_some());
    let source = ("source", scene.source.is_some());
    let needs = [
        ("flow_start", scene.flow_start.is_some(), vec![flow, heat]),
        ("arc", scene.arc.is_some(), vec![heat]),
        ("arcs", !scene.arcs.is_empty(), vec![source]),
        ("torches", !scene.torches.is_empty(), vec![heat]),
        ("output/probes", !scene.output.probes.is_empty(), vec![heat]),
        (
            "output/heat_received",
            scene.output.heat_received,
            vec![heat],
        ),
        ("losses", scene.losses.is_some(), vec![heat]),
        ("tension", scene.tension.is_some(), vec![flow]),
        ("marangoni", scene.marangoni.is_some(), vec![flow, heat]),
        ("surface_stress", scene.surface_stress.is_some(), vec![flow]),
        ("buoyancy", scene.buoyancy.is_some(), vec![flow, heat]),
        ("gas_shear", scene.gas_shear.is_some(), vec![flow, source]),
        ("lorentz", scene.lorentz.is_some(), vec![flow, source]),
        (
            "arc_pressure",
            scene.arc_pressure.is_some(),
            vec![flow, source],
        ),
        ("faces", scene.faces.is_some(), vec![flow]),
        ("bounds", scene.bounds.is_some(), vec![flow]),
        ("droplets", scene.droplets.is_some(), vec![flow, source]),
    ];
    let missing = |(key, there, needs): (&'static str, bool, Vec<(&'static str, bool)>)| {
        let absent = needs
            .into_iter()
            .filter(move |(_, is_there)| there && !is_there);
        absent.map(move |(other, _)| {
            Fault::at(
                &format!("/{key}"),
                format!("means nothing without the key '{other}'"),
            )
        })
    };
    let mut faults: Vec<Fault> = needs.into_iter().flat_map(missing).collect();
    let weightless = scene
        .flow
        .as_ref()
        .is_some_and(|flow| flow.gravity_m_s2.is_none());
    if scene.buoyancy.is_some() && weightless {
        let what = "means nothing without the key 'gravity_m_s2' in 'flow'";
        faults.push(Fault::at("/buoyancy", what));
    }
    if let Some(faces) = &scene.faces {
        let angles = faces.meaningless_angles(scene.tension.is_some(), scene.even());
        faults.extend(angles.map(|fault| fault.within("/faces")));
    }
    faults
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn told(droplets: serde_json::Value) -> Option<String> {
        let scene = json!({
            "spacing_m": 5e-4,
            "time": {"step_s": 1e-4, "end_s": 2.0},
            "density_kg_m3": 7850,
            "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.01, 0.02, 0.005]}}, "state": "liquid"}],
            "flow": {"method": "projection", "viscosity_pa_s": 0.004},
            "source": {"start_m": [0, 0, 0], "velocity_m_s": [0, 0.005, 0]},
            "droplets": droplets,
            "output": {"particles_interval_s": 0.1}
        });
        let scene: Scene = serde_json::from_value(scene).unwrap();
        faults(&scene).first().map(ToString::to_string)
    }

    #[test]
    fn liquid_sticks_only_to_metal_that_melts() {
        let told = |heat: serde_json::Value| {
            let scene = json!({
                "spacing_m": 5e-4, "time": {"step_s": 1e-4, "end_s": 2.0}, "density_kg_m3": 7850,
                "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.01, 0.02, 0.005]}}, "state": "liquid"}],
                "flow": {"viscosity_pa_s": 0.004, "on_cold_metal": "sticks"},
                "heat": heat,
                "output": {"particles_interval_s": 0.1}
            });
            let scene: Scene = serde_json::from_value(scene).unwrap();
            sticking(&scene).map(|fault| fault.to_string())
        };
        let mut heat = json!({"thermal_conductivity_w_m_k": 30, "specific_heat_j_kg_k": 700});
        let fault = told(heat.clone()).unwrap();
        assert!(
            fault.contains("/flow/on_cold_metal") && fault.contains("'melting'"),
            "{fault}"
        );
        heat["melting"] = json!({"point_k": 1750, "latent_heat_j_kg": 250e3});
        assert_eq!(told(heat), None);
    }

    #[test]
    fn droplets_are_not_born_into_each_other() {
        let drop = |key: &str, value: f64| {
            told(json!({key: value, "radius_m": 7.5e-4, "height_m": 0.015, "speed_m_s": 1.5}))
        };
        assert!(drop("period_s", 0.01).is_none());
        assert!(drop("period_s", 1.01e-3).is_none());
        let one = drop("period_s", 9e-4).unwrap();
        assert!(
            one.contains("/droplets/period_s") && one.contains("1.350e-3 m"),
            "{one}"
        );
        let one = drop("feed_m3_s", 1e-4).unwrap();
        assert!(
            one.contains("/droplets/feed_m3_s") && one.contains("more often"),
            "{one}"
        );
    }

    #[test]
    fn droplets_of_two_wires_are_not_born_into_each_other() {
        let at = |offset: f64| {
            let droplets =
                json!({"period_s": 0.02, "radius_m": 7.5e-4, "height_m": 0.015, "speed_m_s": 1.5});
            let scene = json!({
                "spacing_m": 5e-4, "time": {"step_s": 1e-4, "end_s": 2.0}, "density_kg_m3": 7850,
                "bodies": [{"shape": {"box": {"min_m": [0, 0, 0], "max_m": [0.01, 0.02, 0.005]}}, "state": "liquid"}],
                "flow": {"method": "projection", "viscosity_pa_s": 0.004},
                "source": {"start_m": [0, 0, 0], "velocity_m_s": [0, 0.005, 0]},
                "droplets": droplets,
                "arcs": [{"offset_m": [0, offset, 0], "droplets": droplets}],
                "output": {"particles_interval_s": 0.1}
            });
            let scene: Scene = serde_json::from_value(scene).unwrap();
            entangled(&scene).map(|fault| fault.to_string())
        };
        assert_eq!(at(1.5e-3), None);
        let told = at(1e-3).unwrap();
        assert!(
            told.contains("/arcs/0/droplets") && told.contains("1.500e-3 m"),
            "{told}"
        );
    }
}
