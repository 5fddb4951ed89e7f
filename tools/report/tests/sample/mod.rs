//! Artefacts with known content: a bead of half-ellipses, a vortex, a Gaussian arc, bodies that cool.

use std::collections::BTreeMap;
use std::path::Path;

use artefact::{Frame, Header, Precision, Record, Table, Version, Writer};
use serde_json::{Value, json};

/// Particle spacing of the weld \[m\].
pub(crate) const D: f64 = 0.5e-3;
/// Depth of the fused metal below the surface \[m\].
pub(crate) const DEEP: f64 = 2.9e-3;
/// Half of its width \[m\].
pub(crate) const HALF: f64 = 6.1e-3;
/// Height of the bead \[m\].
pub(crate) const HIGH: f64 = 3.2e-3;
/// Speed of the source \[m/s\].
const SPEED: f64 = 5e-3;
/// Where the weld starts \[m\].
const START: f64 = 5e-3;

pub(crate) fn header(kind: &str, tool: &str) -> Header {
    Header {
        kind: kind.to_owned(),
        version: Version::new(1, 0),
        tool: tool.to_owned(),
        tool_version: "0.1.0".to_owned(),
        scene: json!({}),
        inputs: BTreeMap::new(),
    }
}

/// A weld up to `end` seconds, in `count` frames; with temperature or without.
pub(crate) fn weld(path: &Path, end: f64, count: u32, temperature: bool) {
    let mut writer = Writer::create(path, &header("particle-frames", "poolsph")).unwrap();
    let plate = json!({"min_m": [-0.009, 0.0, -0.005], "max_m": [0.009, 0.05, 0.0], "spacing_m": D,
        "particle_volume_m3": D.powi(3), "melting_point_k": 1750.0, "direction": [0, 1, 0]});
    writer
        .json("/plate", 0.0, ("test.plate", "{}"), &plate)
        .unwrap();
    for n in 0..count {
        let time = end * f64::from(n) / f64::from(count - 1);
        let source = json!({"time_s": time, "x_m": 0.0, "y_m": START + SPEED * time, "z_m": 0.0,
            "phase": 0.0, "droplet": (time / 0.01) as i64});
        writer
            .json("/source", time, ("test.source", "{}"), &source)
            .unwrap();
        writer
            .frame("/particles", time, &frame(time, temperature))
            .unwrap();
        let put = 2600.0 * time;
        let record = Record::new()
            .with("mass_kg", "kg", 0.45 + 1.16e-3 * time)
            .with(
                "liquid_particles",
                "1",
                2500.0 * (1.0 - (-3.0 * time).exp()),
            )
            .with("energy_in_arc_j", "J", put)
            .with("energy_in_droplets_j", "J", 0.9 * put)
            .with("energy_out_radiation_j", "J", 0.1 * put)
            .with("energy_stored_j", "J", 1.8 * put)
            .with("closure", "1", 1e-4 * time);
        writer.record("/balance", time, &record).unwrap();
    }
    writer.finish().unwrap();
    record(
        path,
        "poolsph",
        json!([
        {"name": "motion", "wall_s": 41.0, "share": 0.68}, {"name": "conduction", "wall_s": 12.5, "share": 0.21},
        {"name": "surface", "wall_s": 6.6, "share": 0.11}]),
    );
}

fn frame(time: f64, temperature: bool) -> Frame {
    let source = START + SPEED * time;
    let (mut position, mut heat, mut molten, mut fused) = (vec![], vec![], vec![], vec![]);
    for (i, j, k) in lattice([-18, 18], [0, 100], [-10, 8]) {
        let p = [i, j, k].map(|n| (f64::from(n) + 0.5) * D);
        let along = if p[1] > source {
            (p[1] - source) / 5e-3
        } else {
            ((START - p[1]) / 4e-3).max(0.0)
        };
        let up = if k < 0 { DEEP } else { HIGH };
        let inside = (p[0] / HALF).powi(2) + (p[2] / up).powi(2) + along.powi(2) < 1.0;
        if k >= 0 && !inside {
            continue;
        }
        let r = ((p[0] / 6e-3).powi(2)
            + ((p[1] - source + 4e-3) / 10e-3).powi(2)
            + (p[2] / 4e-3).powi(2))
        .sqrt();
        let t = 300.0 + 2200.0 * (-0.42 * r * r).exp();
        position.push(p);
        heat.push(t);
        molten.push(u8::from(inside && t > 1750.0));
        fused.push(u8::from(inside));
    }
    // A drop that has fallen past the plate is no penetration.
    position.push([0.02, 0.03, -0.02]);
    heat.push(2000.0);
    molten.push(1);
    fused.push(1);
    let frame = Frame::new(Precision::F32)
        .positions(position)
        .flag("molten", molten)
        .flag("fused", fused);
    if temperature {
        frame.scalar("temperature", "K", heat)
    } else {
        frame
    }
}

fn lattice(x: [i32; 2], y: [i32; 2], z: [i32; 2]) -> impl Iterator<Item = (i32, i32, i32)> {
    (x[0]..x[1])
        .flat_map(move |i| (y[0]..y[1]).flat_map(move |j| (z[0]..z[1]).map(move |k| (i, j, k))))
}

/// Eight phases and the mean of a vortex in the centre plane and an inflow at the surface.
pub(crate) fn means(path: &Path) {
    let mut writer = Writer::create(path, &header("mean-fields", "avg")).unwrap();
    let along: Vec<f64> = (-40..=16).map(|i| f64::from(i) * D).collect();
    let up: Vec<f64> = (-12..=10).map(|i| f64::from(i) * D).collect();
    let across: Vec<f64> = (-20..=20).map(|i| f64::from(i) * D).collect();
    for n in 0..8 {
        let phase = f64::from(n) / 8.0;
        let strength = 0.2 + 0.3 * (-4.0 * phase).exp();
        writer
            .table(
                "/section_x0",
                phase * 0.01,
                &vortex(&along, &up, strength).attribute("phase", "1", phase),
            )
            .unwrap();
        writer
            .table(
                "/surface",
                phase * 0.01,
                &inflow(&across, &along, strength).attribute("phase", "1", phase),
            )
            .unwrap();
    }
    writer
        .table("/section_x0/time_mean", 0.0, &vortex(&along, &up, 0.3))
        .unwrap();
    writer
        .table("/surface/time_mean", 0.0, &inflow(&across, &along, 0.3))
        .unwrap();
    writer.finish().unwrap();
    record(
        path,
        "avg",
        json!([{"name": "read", "wall_s": 1.0, "share": 0.4}, {"name": "mean", "wall_s": 1.5, "share": 0.6}]),
    );
}

/// A crescent of flux that cools metal before an arc and heats it behind: `count` maps, and the course at one place.
#[allow(dead_code, reason = "not every test has maps")]
pub(crate) fn heat_maps(path: &Path, count: u32) {
    let mut writer = Writer::create(path, &header("mean-fields", "avg")).unwrap();
    let across: Vec<f64> = (0..24).map(|i| (f64::from(i) - 11.5) * 2.0 * D).collect();
    let along: Vec<f64> = (0..50).map(|i| (f64::from(i) + 0.5) * 2.0 * D).collect();
    let flux = |x: f64, y: f64, time: f64| {
        let ahead = y - START - SPEED * time;
        let near = (-(x * x + ahead * ahead) / 6e-5).exp();
        2e6 * near * (-ahead / 4e-3).tanh()
    };
    for n in 0..count {
        let span = [n, n + 1].map(|n| 0.5 * f64::from(n));
        let all = across
            .iter()
            .flat_map(|x| along.iter().map(|y| flux(*x, *y, span[1])));
        let table = Table::grid(&[("x_m", "m", &across), ("y_m", "m", &along)])
            .column("from_powder_w_m2", "W/m2", all)
            .column(
                "from_slag_w_m2",
                "W/m2",
                vec![0.0; across.len() * along.len()],
            )
            .attribute("from_s", "s", span[0])
            .attribute("to_s", "s", span[1]);
        writer.table("/heat_map", span[1], &table).unwrap();
        let record = Record::new()
            .with("from_s", "s", span[0])
            .with("to_s", "s", span[1])
            .with("from_powder_w_m2", "W/m2", flux(0.0, 0.02, span[1]))
            .with("from_slag_w_m2", "W/m2", 0.0);
        writer.record("/heat_map/middle", span[1], &record).unwrap();
        if n + 1 == count {
            writer.table("/heat_map/time_mean", 0.0, &table).unwrap();
        }
    }
    writer.finish().unwrap();
}

/// A level pool `depth` below the plate.
#[allow(dead_code, reason = "not every test has a pool")]
pub(crate) fn profile(path: &Path, depth: f64) {
    let mut writer = Writer::create(path, &header("mean-fields", "avg")).unwrap();
    let column = |value: f64| (0..10).map(move |_| value);
    let radius = |off: f64| (0..10).map(move |i| (f64::from(i) + off) * D);
    let table = Table::new(10)
        .column("radius_m", "m", radius(0.5))
        .column("outer_radius_m", "m", radius(1.0))
        .column("height_m", "m", column(-depth))
        .column("height_spread_angle_m", "m", column(1e-5))
        .column("height_spread_time_m", "m", column(2e-5))
        .column("metal_share", "1", column(1.0))
        .attribute("net_volume_m3", "m3", -1e-8)
        .attribute("depression_m3", "m3", 1e-8);
    writer.table("/profile", 0.0, &table).unwrap();
    writer.finish().unwrap();
}

/// Velocity in the two axes, temperature, liquid, metal.
type Point = ([f64; 2], f64, bool, bool);

fn table(axes: [(&str, &[f64]); 2], names: [&str; 2], point: impl Fn(f64, f64) -> Point) -> Table {
    let points: Vec<Point> = axes[0]
        .1
        .iter()
        .flat_map(|a| axes[1].1.iter().map(|b| point(*a, *b)).collect::<Vec<_>>())
        .collect();
    let count = |yes: bool| if yes { 50.0 } else { 0.0 };
    Table::grid(&[(axes[0].0, "m", axes[0].1), (axes[1].0, "m", axes[1].1)])
        .column(names[0], "m/s", points.iter().map(|p| p.0[0]))
        .column(names[1], "m/s", points.iter().map(|p| p.0[1]))
        .column("temperature_k", "K", points.iter().map(|p| p.1))
        .column("frames_metal", "1", points.iter().map(|p| count(p.3)))
        .column("frames_liquid", "1", points.iter().map(|p| count(p.2)))
        .attribute("frames", "1", 50.0)
        .attribute("drops", "1", 50.0)
}

fn vortex(along: &[f64], up: &[f64], strength: f64) -> Table {
    table(
        [("y_m", along), ("z_m", up)],
        ["velocity_y_m_s", "velocity_z_m_s"],
        |y, z| {
            let u = [strength * z / 3e-3, -strength * (y + 5e-3) / 8e-3];
            let r = ((y + 5e-3) / 10e-3).powi(2) + (z / 3.5e-3).powi(2);
            (u, 2300.0 - 500.0 * r, r < 1.0, r < 1.0 || z <= 0.0)
        },
    )
}

fn inflow(across: &[f64], along: &[f64], strength: f64) -> Table {
    table(
        [("x_m", across), ("y_m", along)],
        ["velocity_x_m_s", "velocity_y_m_s"],
        |x, y| {
            let r = (x / 6e-3).powi(2) + ((y + 5e-3) / 10e-3).powi(2);
            (
                [-strength * x / 6e-3, -strength * y / 10e-3],
                2300.0 - 500.0 * r,
                r < 1.0,
                true,
            )
        },
    )
}

/// An arc of 300 A whose fields are Gaussians.
pub(crate) fn arc(path: &Path) {
    arc_of(path, 300.0);
}

/// An arc of some current \[A\], with 30 V and 5 mV more for each ampere.
pub(crate) fn arc_of(path: &Path, current: f64) {
    let mut writer = Writer::create(path, &header("arc-source", "arcfvm")).unwrap();
    let radius: Vec<f64> = (0..60).map(|i| 1e-4 + 2e-4 * f64::from(i)).collect();
    writer.table("/plasma", 0.0, &plasma(&radius)).unwrap();
    writer.table("/surface", 0.0, &surface(&radius)).unwrap();
    writer.table("/lorentz", 0.0, &lorentz(&radius)).unwrap();
    let balance = Record::new()
        .with("current_a", "A", current)
        .with("voltage_v", "V", 30.0 + 5e-3 * current)
        .with("power_w", "W", 9450.0)
        .with("heat_base_metal_w", "W", 4100.0)
        .with("closure", "1", 3e-8);
    writer.record("/balance", 0.0, &balance).unwrap();
    writer.finish().unwrap();
    let stages = json!([{"name": "energy", "wall_s": 20.0, "share": 0.5}, {"name": "momentum", "wall_s": 20.0, "share": 0.5}]);
    record(path, "arcfvm", stages);
}

fn gauss(r: f64, w: f64) -> f64 {
    (-(r / w).powi(2)).exp()
}

fn grid(radius: &[f64], other: &[f64], f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let pairs = radius
        .iter()
        .flat_map(|r| other.iter().map(move |z| (*r, *z)));
    pairs.map(|(r, z)| f(r, z)).collect()
}

fn plasma(radius: &[f64]) -> Table {
    let height: Vec<f64> = (0..50).map(|k| -3e-3 + 2.4e-4 * f64::from(k)).collect();
    let gas = |z: f64, value: f64| if z < 0.0 { 0.0 } else { value };
    let width = |z: f64| 2e-3 + 0.3 * (5e-3 - z).max(0.0);
    let temperature = grid(radius, &height, |r, z| {
        300.0 + gas(z, 19_000.0 * gauss(r, width(z)))
    });
    let radial = grid(radius, &height, |r, z| gas(z, 3e4 * r * gauss(z, 1.5e-3)));
    let axial = grid(radius, &height, |r, z| {
        gas(z, -200.0 * gauss(r, 1.5e-3) * (z / 5e-3).min(1.0))
    });
    let material = grid(radius, &height, |r, z| {
        match (z < 0.0, z > 5e-3 && r < 0.6e-3) {
            (true, _) => 2.0,
            (_, true) => 1.0,
            _ => 0.0,
        }
    });
    Table::grid(&[("radius_m", "m", radius), ("height_m", "m", &height)])
        .column("temperature_k", "K", temperature)
        .column("radial_velocity_m_s", "m/s", radial)
        .column("axial_velocity_m_s", "m/s", axial)
        .column("material", "1", material)
}

fn surface(radius: &[f64]) -> Table {
    let curve = |peak: f64, w: f64| {
        radius
            .iter()
            .map(move |r| peak * gauss(*r, w))
            .collect::<Vec<f64>>()
    };
    Table::new(radius.len())
        .column("radius_m", "m", radius.iter().copied())
        .column("heat_flux_total_w_m2", "W/m2", curve(1.2e8, 3e-3))
        .column("heat_flux_electron_w_m2", "W/m2", curve(0.5e8, 2e-3))
        .column("heat_flux_convection_w_m2", "W/m2", curve(0.6e8, 3e-3))
        .column("heat_flux_emission_w_m2", "W/m2", curve(-1e6, 4e-3))
        .column("arc_pressure_pa", "Pa", curve(450.0, 2e-3))
        .column("gas_temperature_k", "K", curve(12_000.0, 4e-3))
        .column("current_density_a_m2", "A/m2", curve(1.5e7, 2.5e-3))
        .attribute("gas_temperature_height_m", "m", 9e-5)
}

fn lorentz(radius: &[f64]) -> Table {
    let depth: Vec<f64> = (0..20).map(|k| 1e-4 + 3e-4 * f64::from(k)).collect();
    let force = |peak: f64| {
        grid(radius, &depth, |r, d| {
            peak * gauss(r, 4e-3) * gauss(d, 2e-3) * r / 2e-3
        })
    };
    Table::grid(&[("radius_m", "m", radius), ("depth_m", "m", &depth)])
        .column("lorentz_radial_n_m3", "N/m3", force(-1e5))
        .column("lorentz_axial_n_m3", "N/m3", force(-0.5e5))
}

/// A disc of two layers that cools from a temperature, in frames of a march.
pub(crate) fn disc(path: &Path, start: f64) {
    let scene = json!({"title": format!("A disc at {start} K"), "dimensions": 3,
        "body": {"cylinder": {"centre_m": [0, 0, 0.002], "radius_m": 0.01, "length_m": 0.004}},
        "materials": [{"region": {"box": {"min_m": [-1, -1, 0.002], "max_m": [1, 1, 1]}}}, {}]});
    let place = |i: i32, k: i32, m: i32| {
        [
            f64::from(i) * 1e-3,
            f64::from(k) * 1e-3,
            f64::from(m) * 1e-3,
        ]
    };
    let all =
        (-10..=10).flat_map(|i| (-10..=10).flat_map(move |k| (0..=4).map(move |m| (i, k, m))));
    let position: Vec<[f64; 3]> = all
        .filter(|(i, k, _)| i * i + k * k <= 100)
        .map(|(i, k, m)| place(i, k, m))
        .collect();
    let mut writer = Writer::create(path, &points_header(scene)).unwrap();
    for n in 0..=4 {
        let time = f64::from(n);
        let t = |p: &[f64; 3]| start - time * (20.0 - 8.0 * (p[0].hypot(p[1]) / 0.01).powi(2));
        let frame = Frame::new(Precision::F64)
            .positions(position.iter().copied())
            .scalar("temperature", "K", position.iter().map(t))
            .scalar("volume", "m3", position.iter().map(|_| 1e-9))
            .flag("material", position.iter().map(|p| u8::from(p[2] < 0.002)));
        writer.frame("/points", time, &frame).unwrap();
        let monitors =
            Record::new()
                .with("centre", "K", t(&[0.0; 3]))
                .with("rim", "K", t(&[0.01, 0.0, 0.0]));
        writer.record("/monitors", time, &monitors).unwrap();
        let mut boundaries = Record::new();
        for (name, rate) in [("top", -30.0), ("side", -5.0)] {
            boundaries = boundaries
                .with(&format!("{name}.area"), "m2", 3e-4)
                .with(&format!("{name}.heat_rate"), "W", rate)
                .with(&format!("{name}.heat"), "J", rate * time)
                .with(&format!("{name}.temperature"), "K", start - 15.0 * time);
        }
        writer.record("/boundaries", time, &boundaries).unwrap();
        let balance = Record::new()
            .with("stored", "J", -35.0 * time)
            .with("boundaries", "J", -35.0 * time)
            .with("imbalance", "J", 7e-8 * time);
        writer.record("/balance", time, &balance).unwrap();
    }
    writer.finish().unwrap();
    record(
        path,
        "heatsph",
        json!([{"name": "march", "wall_s": 1.5, "share": 1.0}]),
    );
}

/// A plane plate in its steady state: one frame, nothing over time.
pub(crate) fn plate(path: &Path) {
    let scene = json!({"dimensions": 2, "body": {"box": {"min_m": [0, 0], "max_m": [2, 1]}},
        "materials": [{}], "steady": {}});
    let position: Vec<[f64; 3]> = (0..=20)
        .flat_map(|i| (0..=10).map(move |k| [0.1 * f64::from(i), 0.1 * f64::from(k), 0.0]))
        .collect();
    let mut writer = Writer::create(path, &points_header(scene)).unwrap();
    let frame = Frame::new(Precision::F64)
        .positions(position.iter().copied())
        .scalar(
            "temperature",
            "K",
            position.iter().map(|p| 300.0 + 2.0 * p[0]),
        )
        .scalar("volume", "m2", position.iter().map(|_| 0.01));
    writer.frame("/points", 0.0, &frame).unwrap();
    writer.finish().unwrap();
}

fn points_header(scene: Value) -> Header {
    Header {
        scene,
        ..header("point-fields", "heatsph")
    }
}

fn record(artefact: &Path, tool: &str, stages: Value) {
    let record = json!({"kind": "run-record", "version": "1.0", "tool": tool, "tool_version": "0.1.0", "outcome": "done",
        "start": "2026-01-01T00:00:00Z", "wall_s": 60.1, "steps": 10_000, "threads": 2, "stages": stages,
        "memory": [{"name": "columns", "bytes": 12_345_678}], "peak_memory_bytes": 98_000_000,
        "left_out": [{"name": "gas_shear", "why": "no key 'gas_shear'"}],
        "limits": [{"name": "step_viscosity", "value": 1.2e-3, "unit": "s"}],
        "closing": [{"name": "energy_balance", "unit": "1", "value": 2e-4}],
        "history": [{"name": "residual_energy", "unit": "1", "at": [1, 10, 100], "values": [1.0, 1e-3, 1e-6]}],
        "scene": {"title": format!("Sample of {tool}")}});
    std::fs::write(artefact.with_extension("run.json"), record.to_string()).unwrap();
}

/// Published values of the sample weld.
pub(crate) fn targets(path: &Path, depth: f64) {
    let text = json!({"kind": "targets", "version": "1.0", "targets": [
        {"measure": "penetration", "title": "penetration", "value": depth, "unit": "m", "source": "a paper",
         "kind": "experiment", "tolerance": 0.5e-3},
        {"measure": "fused_half_width", "title": "half width", "value": HALF, "unit": "m", "source": "a paper",
         "kind": "experiment", "tolerance": 0.5e-3},
        {"measure": "reinforcement", "title": "height", "value": 5e-3, "unit": "m", "source": "a paper",
         "kind": "experiment", "tolerance": 0.5e-3, "bound": "at-most"},
        {"measure": "penetration", "title": "penetration", "value": 2.2e-3, "unit": "m", "source": "a thesis", "kind": "simulation"}]});
    std::fs::write(path, text.to_string()).unwrap();
}
