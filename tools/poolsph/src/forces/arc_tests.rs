//! Pressure, shear and Lorentz force of an arc on a plane, a plane inclined by 30 degrees and a sphere: what is put in
//! is what the arc's table holds.

use std::f64::consts::PI;

use particles::Matter;
use run::property::Property;
use shapes::frame::dot;

use super::arc_pressure::{ArcPressure, Pressure};
use super::gas_shear::{Gas, GasShear, Parameters};
use super::lorentz::{Force, Lorentz};
use crate::motion::Law;
use crate::near::Role;
use crate::patch;
use crate::source::Place;
use crate::source::arc::{self, Radial};
use crate::source::arcs::{Burning, OneArc};
use crate::stage::Stage;
use crate::state::{Particle, State, phase};
use crate::surface::Surface;

const METAL: Matter = Matter {
    density: 1.0,
    spacing: 1.0,
    smoothing_length: 1.0,
};
/// Where the cone of the table ends \[m\].
const END: f64 = 12.0;
/// Radius of the sphere \[m\].
const BALL: f64 = 18.0;
/// How far from the axis the pull of the current is looked at \[m\].
const SUMMED: f64 = 15.0;
const FLAT: [f64; 3] = [0.0, 0.0, 1.0];
/// Normal of the inclined plane; 0.8660254 is cos 30 degrees.
const TILTED: [f64; 3] = [0.5, 0.0, 0.866_025_403_784_438_6];

/// The part of a lattice that is inside, all liquid, with the axis of the arc at x = `axis`.
fn liquid(half: [i32; 3], axis: f64, inside: impl Fn([f64; 3]) -> bool) -> State {
    let mut state = State::new(METAL);
    patch::declare(&mut state.metal);
    for i in -half[0]..half[0] {
        for j in -half[1]..half[1] {
            for k in -half[2]..half[2] {
                let position = [i, j, k].map(|n| f64::from(n) + 0.5);
                if inside(position) {
                    state.push(Particle {
                        position,
                        velocity: [0.0; 3],
                        phase: phase::LIQUID,
                        droplet: false,
                        wall: false,
                        temperature: 0.0,
                        enthalpy: 0.0,
                    });
                }
            }
        }
    }
    state.flowing = true;
    state.source = Some(Place {
        position: [axis, 0.0, 0.0],
        way: [0.0; 3],
        phase: 0.0,
        droplets: 0,
    });
    state.gather();
    Surface::new(METAL).advance(&mut state, 0.0).unwrap();
    state
}

/// A slab 6 m thick whose upper face goes through the origin.
fn slab(normal: [f64; 3]) -> State {
    liquid([24, 22, 20], 0.0, |x| (-6.0..0.0).contains(&dot(x, normal)))
}

fn ball(axis: f64) -> State {
    liquid([20; 3], axis, |x| dot(x, x).sqrt() < BALL)
}

/// A table that falls linearly from `peak` to nothing at `END`.
fn cone(peak: f64) -> Radial {
    Radial::new(vec![0.0, END], vec![peak, 0.0])
}

/// The integral of such a table over the plan, with the weight `w(r)`.
fn integral(peak: f64, w: impl Fn(f64) -> f64) -> f64 {
    let n = 1200;
    let ring = |k: i32| {
        let r = (f64::from(k) + 0.5) * END / f64::from(n);
        2.0 * PI * r * peak * (1.0 - r / END) * w(r) * END / f64::from(n)
    };
    (0..n).map(ring).sum()
}

/// Sum over the liquid of the force \[N\] times what `part` makes of its place, the force per volume.
fn sum(state: &State, part: impl Fn([f64; 3], [f64; 3]) -> f64) -> f64 {
    let near = &state.near;
    assert!(near.role.iter().all(|role| *role == Role::Liquid));
    let pairs = near.position.iter().zip(&near.force);
    pairs.map(|(x, f)| METAL.volume() * part(*x, *f)).sum()
}

/// One arc on the axis.
fn alone() -> Vec<Burning> {
    vec![Burning::default()]
}

/// Force of a pressure of the peak 500 Pa \[N\].
fn pressed(state: &mut State) -> [f64; 3] {
    pressed_by(state, &alone())
}

fn pressed_by(state: &mut State, arcs: &[Burning]) -> [f64; 3] {
    let own = |burning: &Burning| (Pressure::Table(cone(500.0)), burning.clone());
    let mut stage = ArcPressure::new(arcs.iter().map(own).collect(), METAL, false);
    stage.advance(state, 1e-4).unwrap();
    [0, 1, 2].map(|axis| sum(state, |_, f| f[axis]))
}

fn close(found: f64, exact: f64, part: f64, what: &str) {
    assert!(
        (found - exact).abs() <= part * exact.abs(),
        "{what}: {found}, exact is {exact}"
    );
}

#[test]
fn planes_are_pressed_as_the_table_says() {
    let exact = integral(500.0, |_| 1.0);
    for (normal, name) in [(FLAT, "flat"), (TILTED, "inclined by 30 degrees")] {
        let [across, along, down] = pressed(&mut slab(normal));
        close(down, -exact, 0.01, name);
        // The pressure acts along the normal.
        let sideways = -exact * normal[0] / normal[2];
        assert!(
            (across - sideways).abs() < 0.01 * exact,
            "{name}: {across} {sideways}"
        );
        assert!(along.abs() < 0.005 * exact, "{name}: {along}");
    }
}

#[test]
fn a_sphere_is_pressed_from_above_alone() {
    let exact = integral(500.0, |_| 1.0);
    let [across, along, down] = pressed(&mut ball(0.0));
    close(down, -exact, 0.01, "sphere");
    assert!(across.abs() + along.abs() < 0.005 * exact);
    // Beside the axis the pressure pushes outwards, on the upper half, which it can reach, and not on the lower one.
    let [across, _, down] = pressed(&mut ball(4.0));
    close(down, -exact, 0.01, "sphere beside the axis");
    close(across, -beside(4.0), 0.01, "sideways");
}

/// Integral of p n_x over the upper half of the sphere, the axis of the table at x = `axis`.
fn beside(axis: f64) -> f64 {
    let (n, m) = (400, 400);
    let mut sum = 0.0;
    for i in 0..n {
        let r = (f64::from(i) + 0.5) * BALL / f64::from(n);
        for k in 0..m {
            let turn = 2.0 * PI * (f64::from(k) + 0.5) / f64::from(m);
            let (x, y) = (r * turn.cos(), r * turn.sin());
            let off = (x - axis).hypot(y);
            let pressure = 500.0 * (1.0 - off / END).max(0.0);
            // dA over its plan, times n_x.
            let steep = x / (BALL * BALL - r * r).sqrt();
            sum += pressure * steep * r * (BALL / f64::from(n)) * (2.0 * PI / f64::from(m));
        }
    }
    sum
}

/// Force along the outward direction of a shear of 333.3 Pa on the axis \[N\].
fn sheared(state: &mut State) -> f64 {
    sheared_by(state, &alone())
}

fn sheared_by(state: &mut State, arcs: &[Burning]) -> f64 {
    let gas = Gas {
        speed: cone(50.0),
        height: 3e-5,
        temperature: Radial::new(vec![0.0, 1e3], vec![1e4; 2]),
    };
    let parameters = Parameters {
        gas_viscosity_pa_s: Property::Constant(2e-4),
    };
    // Liquid too stiff to yield.
    let own = |burning: &Burning| (gas.clone(), burning.clone());
    let arcs = arcs.iter().map(own).collect();
    let mut stage = GasShear::new(&parameters, arcs, Law::Uniform(1e9), METAL).unwrap();
    stage.advance(state, 1e-4).unwrap();
    sum(state, |x, f| {
        let r = x[0].hypot(x[1]).max(1e-12);
        (f[0] * x[0] + f[1] * x[1]) / r
    })
}

#[test]
fn surfaces_are_sheared_as_the_table_says() {
    let peak = 2e-4 * 50.0 / 3e-5;
    // Along the surface only the part 1 - (n . e_r)^2 of the shear is outwards.
    let [sine, _, cosine] = TILTED;
    let tilted = (1.0 - 0.5 * sine * sine) / cosine;
    // Undersides are out of reach.
    let flat = sheared(&mut slab(FLAT));
    close(flat, integral(peak, |_| 1.0), 0.01, "flat");
    let found = sheared(&mut slab(TILTED));
    let exact = integral(peak, |_| tilted);
    close(found, exact, 0.01, "inclined by 30 degrees");
    // Of the shear 1 - r^2/R^2 is outwards, and the area is that of the plan over the root of the same.
    let dome = integral(peak, |r| (1.0 - (r / BALL).powi(2)).sqrt());
    close(sheared(&mut ball(0.0)), dome, 0.01, "sphere");
}

/// 1 on the axis, falling to nothing before the rims of the slabs.
fn window(x: [f64; 3]) -> f64 {
    (1.0 - x[0].hypot(x[1]) / SUMMED).max(0.0)
}

/// Downward and outward Lorentz force \[N\] of a table that grows with radius and depth.
fn pulled(state: &mut State) -> [f64; 2] {
    pulled_by(state, &alone())
}

fn pulled_by(state: &mut State, arcs: &[Burning]) -> [f64; 2] {
    let axes = [vec![1e-6, 40.0], vec![0.0, 40.0]];
    // Radial -2 r, axial -3 depth, both exact between the rows.
    let (radial, axial) = (vec![0.0, 0.0, -80.0, -80.0], vec![0.0, -120.0, 0.0, -120.0]);
    let table = arc::Lorentz::new(axes, radial, axial);
    let own = |burning: &Burning| (Force::Table(table.clone()), burning.clone());
    let arcs = arcs.iter().map(own).collect();
    let mut stage = Lorentz::new(arcs, METAL);
    stage.advance(state, 1e-4).unwrap();
    let within = |x: [f64; 3], part: f64| part * window(x);
    let outward = |x: [f64; 3], f: [f64; 3]| (f[0] * x[0] + f[1] * x[1]) / x[0].hypot(x[1]);
    [
        sum(state, |x, f| within(x, f[2])),
        sum(state, |x, f| within(x, outward(x, f))),
    ]
}

/// Sums of -3 depth and -2 r over the fine cells of a body, seen through the window; `depth` is that below the
/// surface, `None` outside.
fn summed(depth: impl Fn([f64; 3]) -> Option<f64>) -> [f64; 2] {
    let (fine, reach) = (0.25, 20.0);
    let n = (2.0 * reach / fine) as i32;
    let at = |i: i32| (f64::from(i) + 0.5) * fine - reach;
    let mut sums = [0.0; 2];
    for i in 0..n {
        for j in 0..n {
            for k in 0..n {
                let x = [at(i), at(j), at(k)];
                if let Some(depth) = depth(x) {
                    let volume = window(x) * fine * fine * fine;
                    sums[0] -= 3.0 * depth.max(0.0) * volume;
                    sums[1] -= 2.0 * x[0].hypot(x[1]) * volume;
                }
            }
        }
    }
    sums
}

#[test]
fn the_current_pulls_as_the_table_says() {
    for (normal, name) in [(FLAT, "flat"), (TILTED, "inclined by 30 degrees")] {
        let [down, outward] = summed(|x| {
            let level = dot(x, normal);
            (-6.0..0.0).contains(&level).then(|| -level / normal[2])
        });
        let found = pulled(&mut slab(normal));
        close(found[0], down, 0.01, name);
        close(found[1], outward, 0.01, name);
    }
    let [down, outward] = summed(|x| {
        let top = BALL * BALL - x[0] * x[0] - x[1] * x[1];
        (dot(x, x) < BALL * BALL).then(|| top.max(0.0).sqrt() - x[2])
    });
    let found = pulled(&mut ball(0.0));
    close(found[0], down, 0.01, "sphere");
    close(found[1], outward, 0.01, "sphere");
}

/// Arcs of these levels on the axis.
fn levels(of: &[f64]) -> Vec<Burning> {
    let one = |level: &f64| {
        let arc =
            serde_json::json!({"waveform": {"period_s": 1, "times_s": [0], "levels": [level]}});
        serde_json::from_value::<OneArc>(arc).unwrap().burning()
    };
    of.iter().map(one).collect()
}

#[test]
fn arcs_push_by_the_sum_of_their_levels() {
    let arcs = levels(&[0.5, 0.0, 0.25]);
    let (one, several) = (
        pressed(&mut slab(TILTED)),
        pressed_by(&mut slab(TILTED), &arcs),
    );
    close(several[2], 0.75 * one[2], 1e-9, "pressure");
    close(several[0], 0.75 * one[0], 1e-9, "pressure sideways");
    let (one, several) = (sheared(&mut slab(FLAT)), sheared_by(&mut slab(FLAT), &arcs));
    close(several, 0.75 * one, 1e-9, "shear");
    let (one, several) = (pulled(&mut slab(FLAT)), pulled_by(&mut slab(FLAT), &arcs));
    close(several[0], 0.75 * one[0], 1e-9, "Lorentz force down");
    close(several[1], 0.75 * one[1], 1e-9, "Lorentz force outwards");
}

#[test]
fn an_arc_beside_the_axis_of_the_source_pushes_as_a_source_that_stands_there() {
    let arc = serde_json::json!({"offset_m": [4, 0, 0]});
    let beside = vec![serde_json::from_value::<OneArc>(arc).unwrap().burning()];
    let (found, exact) = (pressed_by(&mut ball(0.0), &beside), pressed(&mut ball(4.0)));
    for (found, exact) in found.iter().zip(exact) {
        assert!(
            (found - exact).abs() < 1e-9 * exact.abs().max(1.0),
            "{found} {exact}"
        );
    }
}
