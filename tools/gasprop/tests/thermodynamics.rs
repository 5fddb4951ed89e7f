//! Density, enthalpy, specific heat and derivatives of compositions: exact limits, differences, independent numbers.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod gas;

use gas::{GASES, with_iron};
use gasprop::constants::{ATMOSPHERE, GAS_CONSTANT};
use gasprop::mixture::{Library, Lowering, Mixture, Thermodynamics};
use proptest::prelude::*;

/// Temperatures where published fits change range, K; heat capacities bend there.
const JOINTS: [f64; 3] = [1000.0, 6000.0, 20_000.0];

fn at(mixture: &Mixture, t: f64, p: f64, x: f64) -> Thermodynamics {
    mixture
        .thermodynamics(&mixture.equilibrium(t, p, x).unwrap())
        .unwrap()
}

/// Derivative of fourth order from four values at -2, -1, 1, 2 steps.
fn slope(values: [f64; 4], step: f64) -> f64 {
    let [a, b, c, d] = values;
    (a - 8.0 * b + 8.0 * c - d) / (12.0 * step)
}

/// The values of `f` at -2, -1, 1, 2 steps from `middle`.
fn around(middle: f64, step: f64, f: impl Fn(f64) -> f64) -> [f64; 4] {
    [-2.0, -1.0, 1.0, 2.0].map(|k| f(middle + k * step))
}

#[test]
fn cold_argon_is_a_perfect_gas() {
    let mixture = with_iron(&[("Ar", 1.0)]);
    let molar = 39.948e-3;
    for t in [300.0, 1000.0, 3000.0] {
        let gas = at(&mixture, t, ATMOSPHERE, 0.0);
        let close = |got: f64, expected: f64| {
            assert!((got / expected - 1.0).abs() < 1e-7, "{got} {expected}")
        };
        close(gas.specific_heat, 2.5 * GAS_CONSTANT / molar);
        close(gas.specific_heat_frozen, 2.5 * GAS_CONSTANT / molar);
        close(gas.enthalpy, 2.5 * GAS_CONSTANT * t / molar);
        close(gas.density, ATMOSPHERE * molar / (GAS_CONSTANT * t));
        assert!((gas.specific_heat - 520.3).abs() < 0.05);
    }
}

/// Heat capacities of cold molecules, J/(mol K), by Chase (1998), JANAF: CO2 and O2 at 300 and 1000 K, CO at 1000 K.
#[test]
fn cold_molecules_have_tabulated_heat_capacities() {
    for (name, molar, t, expected) in [
        ("CO2", 44.009e-3, 300.0, 37.221),
        ("CO2", 44.009e-3, 1000.0, 54.308),
        ("O2", 31.998e-3, 300.0, 29.385),
        ("O2", 31.998e-3, 1000.0, 34.870),
        ("CO", 28.010e-3, 1000.0, 33.183),
    ] {
        let got = at(&with_iron(&[(name, 1.0)]), t, ATMOSPHERE, 0.0).specific_heat_frozen * molar;
        assert!(
            (got / expected - 1.0).abs() < 1.5e-3,
            "{name} at {t} K: {got}"
        );
    }
}

/// Of a hot thin gas nothing is left but ions and electrons: h is 5/2 kT per particle and what it took to make the ions.
#[test]
fn hot_argon_is_a_plasma_of_electrons_and_ions() {
    let mixture = with_iron(&[("Ar", 1.0)]).with_lowering(Lowering::None);
    let state = mixture
        .equilibrium(30_000.0, 0.1 * ATMOSPHERE, 0.0)
        .unwrap();
    let gas = mixture.thermodynamics(&state).unwrap();
    let mut made = 0.0;
    for (species, n) in mixture.species.iter().zip(&state.number) {
        made += n * (species.formation + species.internal(30_000.0).energy);
    }
    let flight = 2.5 * state.pressure;
    assert!((gas.enthalpy * gas.density / (made + flight) - 1.0).abs() < 1e-12);
    assert!(made > 2.0 * flight && gas.specific_heat_frozen > 2.5 * 2.9 * GAS_CONSTANT / 39.948e-3);
}

#[test]
fn specific_heat_is_the_slope_of_enthalpy() {
    for lowering in [Lowering::None, Lowering::DebyeHueckel] {
        for gas in GASES {
            let mixture = with_iron(gas).with_lowering(lowering);
            for t in [
                305.0, 640.0, 1700.0, 3100.0, 4600.0, 6700.0, 9200.0, 13_500.0, 16_100.0, 23_700.0,
                29_900.0,
            ] {
                for x in [0.0, 0.02, 0.5, 1.0] {
                    let step = 2e-4 * t;
                    let h = around(t, step, |t| at(&mixture, t, ATMOSPHERE, x).enthalpy);
                    let (got, expected) =
                        (at(&mixture, t, ATMOSPHERE, x).specific_heat, slope(h, step));
                    assert!(
                        (got / expected - 1.0).abs() < 1e-6,
                        "{gas:?} {t} K x {x}: {got} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn derivatives_of_numbers_are_those_of_differences() {
    for lowering in [Lowering::None, Lowering::DebyeHueckel] {
        let mixture = with_iron(&[("Ar", 0.82), ("CO2", 0.18)]).with_lowering(lowering);
        for (t, x) in [
            (400.0, 0.1),
            (2100.0, 0.02),
            (3700.0, 0.4),
            (7300.0, 0.01),
            (12_600.0, 0.7),
            (27_000.0, 0.3),
        ] {
            let gas = at(&mixture, t, ATMOSPHERE, x);
            for (s, species) in mixture.species.iter().enumerate() {
                let log =
                    |t: f64, x: f64| mixture.equilibrium(t, ATMOSPHERE, x).unwrap().number[s].ln();
                let n = log(t, x).exp();
                if n <= 0.0 {
                    continue;
                }
                let by_t = slope(around(t, 1e-4 * t, |t| log(t, x)), 1e-4 * t);
                let by_x = slope(around(x, 1e-3 * x, |x| log(t, x)), 1e-3 * x);
                let (got_t, got_x) = (gas.log_number_by_temperature[s], gas.number_by_iron[s] / n);
                let name = &species.name;
                assert!(
                    (got_t - by_t).abs() < 1e-6 * by_t.abs().max(1.0 / t),
                    "{name} {t} K: {got_t} {by_t}"
                );
                assert!(
                    (got_x - by_x).abs() < 1e-6 * by_x.abs().max(1.0 / x),
                    "{name} {t} K: {got_x} {by_x}"
                );
                assert!(
                    (gas.number_by_temperature[s] - n * got_t).abs() <= 1e-10 * n * got_t.abs()
                );
            }
        }
    }
}

/// At x = 0 and x = 1 the slopes are those of the first trace of what is absent.
#[test]
fn slopes_at_the_ends_are_limits() {
    let mixture = with_iron(&[("CO", 1.0)]);
    let trace = 1e-7;
    for t in [9000.0, 15_000.0] {
        for (end, inside) in [(0.0, trace), (1.0, 1.0 - trace)] {
            let gas = at(&mixture, t, ATMOSPHERE, end);
            let [here, there] =
                [end, inside].map(|x| mixture.equilibrium(t, ATMOSPHERE, x).unwrap());
            let all: f64 = here.number.iter().sum();
            for (s, species) in mixture.species.iter().enumerate() {
                let got = gas.number_by_iron[s];
                let expected = (there.number[s] - here.number[s]) / (inside - end);
                let limit = 2e-3 * expected.abs() + 1e-7 * all;
                assert!(
                    (got - expected).abs() < limit,
                    "{} {t} K, x {end}: {got:e} {expected:e}",
                    species.name
                );
            }
        }
    }
}

/// dh/dp at constant T is v - T dv/dT of any gas in equilibrium, v = 1/rho: it binds enthalpies to compositions.
#[test]
fn enthalpy_and_volume_come_from_one_free_energy() {
    for lowering in [Lowering::None, Lowering::DebyeHueckel] {
        for gas in GASES {
            let mixture = with_iron(gas).with_lowering(lowering);
            for (t, x) in [
                (2400.0, 0.0),
                (3300.0, 0.3),
                (6100.0, 0.05),
                (9800.0, 0.0),
                (14_000.0, 1.0),
                (22_000.0, 0.4),
            ] {
                let middle = at(&mixture, t, ATMOSPHERE, x);
                let step = 1e-3 * ATMOSPHERE;
                let by_p = slope(
                    around(ATMOSPHERE, step, |p| at(&mixture, t, p, x).enthalpy),
                    step,
                );
                let masses = mixture.species.iter().map(|species| species.mass);
                let rho_t: f64 = masses
                    .zip(&middle.number_by_temperature)
                    .map(|(m, n)| m * n)
                    .sum();
                let expected = (1.0 + t * rho_t / middle.density) / middle.density;
                let scale = 1e-6 / middle.density;
                assert!(
                    (by_p - expected).abs() < scale,
                    "{gas:?} {t} K x {x}: {by_p} {expected}"
                );
            }
        }
    }
}

/// Argon at 1.0133 times the labelled pressure (as the density column says), from a published table: rho to 0.4 %, cp to
/// 2 % with the shells that fields of ions leave. With the levels of the lists it is 2.2 % above 20,900 K, where the second
/// ionisation sets in and 50 K of temperature make 2 % of cp. Without lowering cp misses it by up to 6 %.
#[test]
fn argon_agrees_with_a_published_table() {
    let library = Library::embedded().unwrap();
    let rows = library.data()["reference_argon_1atm"]["data"]
        .as_array()
        .unwrap();
    let value = |row: &serde_json::Value, column: usize| row[column].as_f64().unwrap();
    let pressure = value(&rows[0], 1) * GAS_CONSTANT / 39.948e-3 * value(&rows[0], 0);
    assert!((pressure / ATMOSPHERE - 1.0133).abs() < 1e-3);
    let worst = |mixture: Mixture| -> f64 {
        let error = |row| {
            (at(&mixture, value(row, 0), pressure, 0.0).specific_heat / value(row, 2) - 1.0).abs()
        };
        rows.iter().map(error).fold(0.0, f64::max)
    };
    let mixture = with_iron(&[("Ar", 1.0)]);
    for row in rows {
        let t = value(row, 0);
        let gas = at(&mixture, t, pressure, 0.0);
        let (cp, rho) = (
            gas.specific_heat / value(row, 2) - 1.0,
            gas.density / value(row, 1) - 1.0,
        );
        let limit = if t < 20_900.0 { 0.02 } else { 0.022 };
        assert!(cp.abs() < limit, "{t} K: cp {cp}");
        assert!(rho.abs() < 4e-3, "{t} K: rho {rho}");
    }
    let cut = mixture.clone().with_shells_among_charges(pressure).unwrap();
    assert!(worst(cut) < 0.02);
    assert!(worst(mixture.clone()) > 0.02);
    assert!(rows.len() > 50 && worst(mixture.with_lowering(Lowering::None)) > 0.05);
}

/// Rows of minplascalc 1.1.1 (Quinn Reynolds, run for this table), an ideal gas in equilibrium, argon and argon with iron
/// at 1 atm, up to where its partition functions hold: x, T [K], rho [kg/m3], cp [J/(kg K)], n_e [1/m3].
const IDEAL_ROWS: [(f64, f64, f64, f64, f64); 20] = [
    (0.0, 1000.0, 0.4868, 520.3, 1.339e-14),
    (0.0, 2000.0, 0.2434, 520.3, 1.204e+06),
    (0.0, 3000.0, 0.1623, 520.3, 5.706e+12),
    (0.0, 5000.0, 0.09737, 520.5, 1.319e18),
    (0.0, 6000.0, 0.08114, 523.1, 2.934e19),
    (0.0, 7000.0, 0.06953, 542.6, 2.707e20),
    (0.0, 8000.0, 0.06076, 626.9, 1.438e21),
    (0.0, 9000.0, 0.05374, 878.9, 5.269e21),
    (0.0, 10_000.0, 0.0477, 1464.0, 1.478e22),
    (0.0, 11_000.0, 0.04202, 2593.0, 3.373e22),
    (0.0, 12_000.0, 0.03628, 4453.0, 6.467e22),
    (0.0, 13_000.0, 0.03044, 6961.0, 1.057e23),
    (0.0, 14_000.0, 0.02494, 9213.0, 1.482e23),
    (0.1, 3000.0, 0.1687, 513.7, 4.011e18),
    (0.1, 4000.0, 0.1265, 528.6, 1.984e20),
    (0.1, 5000.0, 0.1011, 591.3, 2.043e21),
    (0.1, 6000.0, 0.08372, 770.6, 9.316e21),
    (0.1, 7000.0, 0.07058, 1048.0, 2.512e22),
    (0.1, 8000.0, 0.06017, 1186.0, 4.501e22),
    (0.1, 9000.0, 0.05222, 1049.0, 5.828e22),
];

#[test]
fn ideal_argon_with_iron_agrees_with_a_program_of_others() {
    let mixture = with_iron(&[("Ar", 1.0)]).with_lowering(Lowering::None);
    for (x, t, density, specific_heat, electrons) in IDEAL_ROWS {
        let state = mixture.equilibrium(t, ATMOSPHERE, x).unwrap();
        let gas = mixture.thermodynamics(&state).unwrap();
        let pairs = [
            (gas.density, density),
            (gas.specific_heat, specific_heat),
            (state.number[0], electrons),
        ];
        for (got, expected) in pairs {
            assert!(
                (got / expected - 1.0).abs() < 1e-3,
                "x {x}, {t} K: {got:e} {expected:e}"
            );
        }
    }
}

/// Rows of an independent solver (numpy, the same energy levels, ionisation lowered by the electrons' own Debye length,
/// pressure ideal), argon with iron at 1 atm: x, T [K], rho [kg/m3], h [J/kg], n_e [1/m3], rounded to four figures.
const ROWS: [(f64, f64, f64, f64, f64); 16] = [
    (0.0, 5000.0, 0.09737, 2.602e6, 1.319e18),
    (0.0, 10_000.0, 0.04769, 6.111e6, 1.5e22),
    (0.0, 15_000.0, 0.02034, 3.543e7, 1.827e23),
    (0.0, 20_000.0, 0.01223, 5.922e7, 1.825e23),
    (0.01, 5000.0, 0.09771, 2.607e6, 6.422e20),
    (0.01, 10_000.0, 0.04762, 6.155e6, 1.88e22),
    (0.1, 7000.0, 0.07053, 4.187e6, 2.584e22),
    (0.1, 12_000.0, 0.03579, 1.213e7, 9.267e22),
    (0.2, 9000.0, 0.0514, 7.686e6, 9.767e22),
    (0.3, 5000.0, 0.1087, 2.549e6, 3.621e21),
    (0.3, 10_000.0, 0.04378, 1.055e7, 1.444e23),
    (0.3, 18_000.0, 0.01467, 4.997e7, 2.101e23),
    (1.0, 5000.0, 0.1355, 2.403e6, 6.666e21),
    (1.0, 9000.0, 0.05181, 1.271e7, 2.567e23),
    (1.0, 15_000.0, 0.02227, 2.893e7, 2.491e23),
    (1.0, 20_000.0, 0.01283, 5.534e7, 2.286e23),
];

/// Screening by electrons alone lies between none and that by electrons and ions, and so must the electrons. Enthalpy
/// and density, without the energy and pressure of screening there, agree to 1 and 2 %.
#[test]
fn argon_with_iron_agrees_with_an_independent_solver() {
    let both = [Lowering::None, Lowering::DebyeHueckel]
        .map(|l| with_iron(&[("Ar", 1.0)]).with_lowering(l));
    for (x, t, density, enthalpy, electrons) in ROWS {
        let states = both
            .each_ref()
            .map(|m| m.equilibrium(t, ATMOSPHERE, x).unwrap());
        let gases = both.each_ref().map(|m| at(m, t, ATMOSPHERE, x));
        let ends = states.each_ref().map(|state| state.number[0]);
        let (low, high) = (
            ends[0].min(ends[1]) * (1.0 - 1e-3),
            ends[0].max(ends[1]) * (1.0 + 1e-3),
        );
        assert!(
            low < electrons && electrons < high,
            "x {x}, {t} K: n_e {electrons:e} not in {ends:?}"
        );
        assert!(high / low < 1.08, "x {x}, {t} K: n_e {ends:?}");
        let (h, rho) = (
            gases[1].enthalpy / enthalpy - 1.0,
            gases[0].density / density - 1.0,
        );
        assert!(
            h.abs() < 0.01 && rho.abs() < 0.02,
            "x {x}, {t} K: h {h}, rho {rho}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn enthalpy_rises_with_temperature(
        gas in 0..GASES.len(),
        log_t in 300f64.ln()..30_000f64.ln(),
        log_p in 1e4f64.ln()..1e6f64.ln(),
        x in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0, (-40.0..0.0).prop_map(f64::exp)],
        log_step in -8.0..2.0f64,
    ) {
        let mixture = with_iron(GASES[gas]);
        let (t, p) = (log_t.exp(), log_p.exp());
        let (low, high) = (at(&mixture, t, p, x), at(&mixture, t + log_step.exp(), p, x));
        prop_assert!(high.enthalpy > low.enthalpy);
        prop_assert!(low.specific_heat >= low.specific_heat_frozen * (1.0 - 1e-9));
        prop_assert!(low.specific_heat_frozen > 0.0 && low.density > 0.0 && high.density < low.density);
        let near_joint = JOINTS.iter().any(|joint| (joint / t - 1.0).abs() < 2e-3);
        if !near_joint {
            let step = 1e-4 * t;
            let h = around(t, step, |t| at(&mixture, t, p, x).enthalpy);
            prop_assert!((low.specific_heat / slope(h, step) - 1.0).abs() < 1e-6);
        }
    }
}
