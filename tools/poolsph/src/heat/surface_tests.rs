//! Heat through the surface: what is put in is what is prescribed, and cooling follows its law.

use std::f64::consts::PI;
use std::sync::Arc as Shared;

use particles::Matter;
use run::property::{Formula, Property};
use shapes::frame::dot;

use super::caloric::tests::plain;
use super::*;
use crate::patch::{self, Patch, Patches};
use crate::stage::Stage;
use crate::state::{ENTHALPY, Particle, State, TEMPERATURE, phase};
use crate::surface::Surface;

pub(super) const METAL: Matter = Matter {
    density: 1.0,
    spacing: 1.0,
    smoothing_length: 1.0,
};

/// The part of a lattice that is inside, at 500 K, c = 1 J/(kg K).
pub(super) fn body(half: [i32; 3], inside: impl Fn([f64; 3]) -> bool) -> State {
    let mut state = State::new(METAL);
    state.metal.declare(&TEMPERATURE);
    state.metal.declare(&ENTHALPY);
    patch::declare(&mut state.metal);
    for i in -half[0]..half[0] {
        for j in -half[1]..half[1] {
            for k in -half[2]..half[2] {
                let position = [i, j, k].map(|n| f64::from(n) + 0.5);
                if inside(position) {
                    state.push(Particle {
                        position,
                        velocity: [0.0; 3],
                        phase: phase::SOLID,
                        droplet: false,
                        wall: false,
                        temperature: 500.0,
                        enthalpy: 500.0,
                    });
                }
            }
        }
    }
    Surface::new(METAL).advance(&mut state, 0.0).unwrap();
    state
}

/// A Gaussian of radius 5 (standard deviation) and peak 1 W/m2.
fn gaussian(onto: Onto) -> Arc {
    let expr = "exp(-r^2/50)".to_owned();
    let parameters = ArcParameters {
        flux_w_m2: Some(Property::Formula(Formula { expr })),
        parts: None,
        cathode: None,
        gas: None,
        on: onto,
    };
    let caloric = Shared::new(plain(1.0, 1.0, None));
    Arc::new(&parameters, caloric, METAL, None).unwrap()
}

/// Heat put in within a second \[J\], and the change of the energy.
fn put(mut state: State, onto: Onto) -> f64 {
    let before: f64 = state.metal.column(&ENTHALPY).iter().sum();
    let mut arc = gaussian(onto);
    arc.advance(&mut state, 1.0).unwrap();
    let change = state.metal.column(&ENTHALPY).iter().sum::<f64>() - before;
    let figures = arc.figures();
    let told = figures
        .iter()
        .find(|f| f.name == "energy_in_arc_j")
        .unwrap();
    assert!((told.value / change - 1.0).abs() < 1e-9);
    change
}

#[test]
fn a_plane_takes_what_is_prescribed() {
    let state = body([25, 25, 6], |x| x[2] < 0.0);
    let ratio = put(state, Onto::Projected) / (2.0 * PI * 25.0);
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn a_plane_inclined_by_30_degrees_takes_what_is_prescribed() {
    let normal = [0.5, 0.0, 0.75_f64.sqrt()];
    let tilted = || {
        body([28, 25, 20], |x| {
            dot(x, normal) < 0.0 && dot(x, normal) > -6.0
        })
    };
    let ratio = put(tilted(), Onto::Projected) / (2.0 * PI * 25.0);
    assert!((ratio - 1.0).abs() < 0.01, "projected {ratio}");
    let ratio = put(tilted(), Onto::Area) / (2.0 * PI * 25.0 / normal[2]);
    assert!((ratio - 1.0).abs() < 0.01, "area {ratio}");
}

#[test]
fn a_sphere_takes_what_is_prescribed() {
    let radius = 18.0_f64;
    let state = body([20; 3], |x| dot(x, x).sqrt() < radius);
    let ratio =
        put(state, Onto::Projected) / (2.0 * PI * 25.0 * (1.0 - (-radius * radius / 50.0).exp()));
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
    // On its whole area: q dA, dA = r dr / cos of the slope.
    let state = body([20; 3], |x| dot(x, x).sqrt() < radius);
    let n = 2000;
    let ring = |k: i32| {
        let r = (f64::from(k) + 0.5) * radius / f64::from(n);
        let flux = (-r * r / 50.0).exp();
        2.0 * PI * r * flux / (1.0 - (r / radius).powi(2)).sqrt() * radius / f64::from(n)
    };
    let ratio = put(state, Onto::Area) / (0..n).map(ring).sum::<f64>();
    assert!((ratio - 1.0).abs() < 0.01, "area {ratio}");
}

#[test]
fn parts_of_a_table_are_told_apart() {
    let r = [0.0, 5.0, 10.0, 15.0];
    let table = artefact::Table::new(4)
        .column("radius_m", "m", r)
        .column(
            "heat_flux_convection_w_m2",
            "W/m2",
            [2.0, 4.0 / 3.0, 2.0 / 3.0, 0.0],
        )
        .column(
            "heat_flux_electron_w_m2",
            "W/m2",
            [-0.5, -1.0 / 3.0, -1.0 / 6.0, 0.0],
        );
    let mut parameters = ArcParameters {
        flux_w_m2: None,
        parts: Some(vec![Part::Convection, Part::Electron]),
        cathode: None,
        gas: None,
        on: Onto::Projected,
    };
    let caloric = Shared::new(plain(1.0, 1.0, None));
    let mut state = body([20, 20, 4], |x| x[2] < 0.0);
    let make = |p: &ArcParameters| Arc::new(p, Shared::clone(&caloric), METAL, Some(&table));
    let mut arc = make(&parameters).unwrap();
    arc.advance(&mut state, 2.0).unwrap();
    let figures = arc.figures();
    let cone = PI * 15.0 * 15.0 / 3.0;
    for (name, heat) in [
        ("energy_in_arc_convection_j", 4.0),
        ("energy_in_arc_electron_j", -1.0),
    ] {
        let found = figures.iter().find(|f| f.name == name).unwrap().value;
        assert!((found / (heat * cone) - 1.0).abs() < 0.01, "{name} {found}");
    }
    parameters.parts = Some(vec![Part::Ion]);
    let fault = make(&parameters).err().unwrap().to_string();
    assert!(fault.contains("heat_flux_ion_w_m2"), "{fault}");
}

#[test]
fn a_ball_cools_by_newtons_law() {
    let radius = 12.0_f64;
    let mut state = body([14; 3], |x| dot(x, x).sqrt() < radius);
    let mass = state.len() as f64;
    let parameters = LossParameters {
        surroundings_k: 300.0,
        emissivity: None,
        transfer_w_m2_k: Some(0.01),
        evaporation: None,
        on: Where::All,
    };
    let caloric = Shared::new(plain(1e4, 1.0, None));
    let mut losses = Losses::new(parameters, Substances::of(Shared::clone(&caloric), METAL));
    for _ in 0..100 {
        losses.advance(&mut state, 1.0).unwrap();
        // Well stirred: the exact law is that of a body of one temperature.
        let mean = state.metal.column(&ENTHALPY).iter().sum::<f64>() / mass;
        state.metal.column_mut(&ENTHALPY).fill(mean);
        state.metal.column_mut(&TEMPERATURE).fill(mean);
    }
    let area = 4.0 * PI * (mass * 0.75 / PI).powf(2.0 / 3.0);
    let exact = 200.0 * (-0.01 * area / mass * 100.0).exp();
    let ratio = (state.metal.column(&TEMPERATURE)[0] - 300.0) / exact;
    assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
    let out = losses.figures()[0].value;
    assert!((out / (mass * (500.0 - state.metal.column(&TEMPERATURE)[0])) - 1.0).abs() < 1e-9);
}

#[test]
fn radiation_and_vapour_have_their_size() {
    let iron = Evaporation {
        boiling_point_k: 3134.0,
        latent_heat_j_kg: 6.09e6,
        molar_mass_kg_mol: 0.05585,
        gas: None,
    };
    // At the boiling point: L p sqrt(M / (2 pi R T)), 1 atm.
    let exact = 6.09e6 * 101_325.0 * (0.05585 / (2.0 * PI * 8.314_462_618 * 3134.0)).sqrt();
    assert!((iron.heat(3134.0).0 / exact - 1.0).abs() < 1e-12);
    let mut state = body([3; 3], |_| true);
    let parameters = LossParameters {
        surroundings_k: 300.0,
        emissivity: Some(0.5),
        transfer_w_m2_k: None,
        evaporation: None,
        on: Where::Top,
    };
    let mut losses = Losses::new(
        parameters,
        Substances::of(Shared::new(plain(1.0, 1.0, None)), METAL),
    );
    losses.advance(&mut state, 1e-3).unwrap();
    let up = |p: Patch| {
        if p.normal[2] > 0.5_f64.sqrt() {
            p.area
        } else {
            0.0
        }
    };
    let area: f64 = Patches::of(&state.metal).iter().map(up).sum();
    let exact = 0.5 * 5.670_374_419e-8 * (500.0_f64.powi(4) - 300.0_f64.powi(4)) * area * 1e-3;
    assert!((losses.figures()[0].value / exact - 1.0).abs() < 1e-12);
}

#[test]
fn a_step_too_long_for_the_losses_comes_to_the_balance_and_not_below() {
    let around = 500.0;
    let parameters = LossParameters {
        surroundings_k: around,
        emissivity: Some(1.0),
        transfer_w_m2_k: Some(10.0),
        evaporation: Some(Evaporation {
            boiling_point_k: 3134.0,
            latent_heat_j_kg: 6.09e6,
            molar_mass_kg_mol: 0.055_845,
            gas: None,
        }),
        on: Where::All,
    };
    let cooled = |steps: u32| {
        let mut state = body([3, 3, 3], |_| true);
        state.metal.column_mut(&TEMPERATURE).fill(3400.0);
        state.metal.column_mut(&ENTHALPY).fill(3400.0);
        let mut losses = Losses::new(
            parameters,
            Substances::of(Shared::new(plain(1.0, 1.0, None)), METAL),
        );
        for _ in 0..steps {
            losses.advance(&mut state, 1e-3 / f64::from(steps)).unwrap();
        }
        let exposed = &state.exposed;
        let mean = exposed
            .iter()
            .map(|a| state.metal.column(&TEMPERATURE)[*a as usize])
            .sum::<f64>();
        let least = state
            .metal
            .column(&TEMPERATURE)
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min);
        assert!(least >= around);
        mean / exposed.len() as f64
    };
    // Metal of 1 J/(m3 K): the whole step is thousands of times what it may be.
    let (coarse, fine) = (cooled(1), cooled(4000));
    assert!(
        fine < 3000.0 && (coarse / fine - 1.0).abs() < 0.05,
        "{coarse} {fine}"
    );
}

#[test]
fn a_formula_narrower_than_the_spacing_delivers_its_heat_wherever_its_axis_is() {
    for radius in [0.2, 0.4, 0.6, 1.0] {
        let expr = format!("exp(-(r/{radius})^2)");
        let parameters = ArcParameters {
            flux_w_m2: Some(Property::Formula(Formula { expr })),
            parts: None,
            cathode: None,
            gas: None,
            on: Onto::Projected,
        };
        for axis in [[0.0, 0.0], [0.5, 0.5], [0.3, 0.1], [0.5, 0.0]] {
            let caloric = Shared::new(plain(1.0, 1.0, None));
            let mut arc = Arc::new(&parameters, caloric, METAL, None).unwrap();
            let mut state = body([8, 8, 4], |x| x[2] < 0.0);
            state.source = Some(crate::source::Place {
                position: [axis[0], axis[1], 0.0],
                way: [0.0; 3],
                phase: 0.0,
                droplets: 0,
            });
            arc.advance(&mut state, 1.0).unwrap();
            let put = arc.figures().iter().find(|f| f.unit == "J").unwrap().value;
            let exact = std::f64::consts::PI * radius * radius;
            assert!(
                (put / exact - 1.0).abs() < 0.01,
                "{radius} at {axis:?}: {put} {exact}"
            );
            assert!(arc.warnings().is_empty());
        }
    }
}

#[test]
fn a_formula_too_narrow_for_parts_of_a_spacing_is_told() {
    let parameters = ArcParameters {
        flux_w_m2: Some(Property::Formula(Formula {
            expr: "exp(-(r/0.01)^2)".to_owned(),
        })),
        parts: None,
        cathode: None,
        gas: None,
        on: Onto::Projected,
    };
    let caloric = Shared::new(plain(1.0, 1.0, None));
    let mut arc = Arc::new(&parameters, caloric, METAL, None).unwrap();
    let mut state = body([8, 8, 4], |x| x[2] < 0.0);
    state.source = Some(crate::source::Place {
        position: [0.56, 0.44, 0.0],
        way: [0.0; 3],
        phase: 0.0,
        droplets: 0,
    });
    arc.advance(&mut state, 1.0).unwrap();
    assert!(
        arc.warnings()[0].contains("heat may be missed"),
        "{:?}",
        arc.warnings()
    );
}

#[test]
fn the_plan_of_a_body_is_that_of_its_columns() {
    let seen = |half: [i32; 3], inside: &dyn Fn([f64; 3]) -> bool| {
        let state = body(half, inside);
        let patches = Patches::of(&state.metal);
        let seen: f64 = (0..state.len()).map(|a| patches.at(a).seen).sum();
        let plan: std::collections::HashSet<[i64; 2]> = state
            .metal
            .column(&particles::POSITION)
            .iter()
            .map(|[x, y, _]| [x.floor() as i64, y.floor() as i64])
            .collect();
        seen / plan.len() as f64 - 1.0
    };
    for rows in 1..6 {
        let strip = |x: [f64; 3]| x[1] < f64::from(rows) - 4.0;
        let off = seen([6, 4, 3], &strip);
        assert!(off.abs() < 1e-12, "{rows} rows: {off}");
        let state = body([6, 4, 3], strip);
        let patches = Patches::of(&state.metal);
        for (a, place) in state.metal.column(&particles::POSITION).iter().enumerate() {
            // Each of the top layer has its own column, at edges and corners too.
            let own = if place[2] > 2.0 { 1.0 } else { 0.0 };
            let seen = patches.at(a).seen;
            assert!((seen - own).abs() < 0.05, "{rows} rows, {place:?}: {seen}");
        }
    }
    // A disc, a plate that stands askew, and one with a step.
    let disc = |[x, y, _]: [f64; 3]| x.hypot(y) < 9.3;
    let askew =
        |[x, y, _]: [f64; 3]| (0.6 * x + 0.8 * y).abs() < 6.0 && (0.8 * x - 0.6 * y).abs() < 9.0;
    let step = |[x, _, z]: [f64; 3]| x < 0.0 || z < 0.0;
    type Inside<'a> = &'a dyn Fn([f64; 3]) -> bool;
    let shapes: [(Inside<'_>, f64); 3] = [(&step, 1e-12), (&askew, 0.02), (&disc, 0.02)];
    for (shape, bound) in shapes {
        let off = seen([12, 12, 3], shape);
        assert!(off.abs() < bound, "{off}");
    }
}
