//! Compositions: conservation, limits, laws of mass action, independent rows, and all corners of the range.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

mod gas;

use gas::{GASES, owned, with_iron};
use gasprop::constants::{
    ATMOSPHERE, BOLTZMANN, ELECTRON_MASS, ELEMENTARY_CHARGE, PERMITTIVITY, PLANCK,
};
use gasprop::mixture::{
    Element, EquilibriumError, Kind, Library, Lowering, Mixture, MixtureError, State,
};
use proptest::prelude::*;
use std::f64::consts::PI;

/// Sum of `weight` times number density.
fn sum(mixture: &Mixture, state: &State, weight: impl Fn(usize) -> f64) -> f64 {
    (0..mixture.species.len())
        .map(|s| weight(s) * state.number[s])
        .sum()
}

/// Number density of a species.
fn number(mixture: &Mixture, state: &State, name: &str) -> f64 {
    state.number[mixture.index(name).unwrap()]
}

/// Asserts that numbers are sound, and that elements, charge and pressure are as they must be.
fn assert_conserved(mixture: &Mixture, state: &State) {
    let at = format!(
        "{} K, {} Pa, x {}",
        state.temperature, state.pressure, state.iron
    );
    assert!(
        state.number.iter().all(|n| n.is_finite() && *n >= 0.0),
        "{at}"
    );
    let nuclei = |e: Element| sum(mixture, state, |s| f64::from(mixture.species[s].count(e)));
    let held: f64 = mixture.elements.iter().map(|e| nuclei(*e)).sum();
    let moles = |e: usize| {
        let iron = if mixture.elements[e] == Element::Fe {
            state.iron
        } else {
            0.0
        };
        mixture.base[e] * (1.0 - state.iron) + iron
    };
    let all: f64 = (0..mixture.elements.len()).map(moles).sum();
    for (e, element) in mixture.elements.iter().enumerate() {
        let expected = moles(e) / all * held;
        let error = (nuclei(*element) - expected).abs();
        assert!(
            error <= 1e-10 * expected,
            "{at}: {element:?} {error:e} of {expected:e}"
        );
    }
    let charge = sum(mixture, state, |s| f64::from(mixture.species[s].charge));
    let charges = sum(mixture, state, |s| {
        f64::from(mixture.species[s].charge).abs()
    });
    assert!(
        charge.abs() <= 1e-10 * charges,
        "{at}: charge {charge:e} of {charges:e}"
    );
    assert!(charges > 0.0, "{at}: no electron at all");
    let thermal = BOLTZMANN * state.temperature;
    let squares = sum(mixture, state, |s| {
        f64::from(mixture.species[s].charge).powi(2)
    });
    let inverse = (ELEMENTARY_CHARGE.powi(2) * squares / (PERMITTIVITY * thermal)).sqrt();
    let pressure = sum(mixture, state, |_| thermal) - thermal * inverse.powi(3) / (24.0 * PI);
    assert!(
        (pressure / state.pressure - 1.0).abs() <= 1e-12,
        "{at}: pressure {pressure}"
    );
}

#[test]
fn every_corner_is_conserved() {
    for gas in GASES {
        let mixture = with_iron(gas);
        for t in [
            298.15, 300.0, 800.0, 2500.0, 6000.0, 10_000.0, 15_000.0, 31_000.0,
        ] {
            for p in [0.1, 1.0, 10.0] {
                for x in [
                    0.0,
                    1e-300,
                    1e-50,
                    1.85e-17,
                    1e-12,
                    0.01,
                    1.0 / 3.0,
                    0.5,
                    2.0 / 3.0,
                    1.0 - 1e-12,
                    1.0,
                ] {
                    let state = mixture.equilibrium(t, p * ATMOSPHERE, x).unwrap();
                    assert_conserved(&mixture, &state);
                }
            }
        }
    }
}

#[test]
fn absent_components_leave_nothing() {
    let mixture = with_iron(&[("Ar", 1.0)]);
    for (x, absent) in [(0.0, Element::Fe), (1.0, Element::Ar)] {
        let state = mixture.equilibrium(9000.0, ATMOSPHERE, x).unwrap();
        for (species, n) in mixture.species.iter().zip(&state.number) {
            assert_eq!(species.count(absent) > 0, *n <= 0.0, "{}", species.name);
        }
    }
    let alone = Mixture::new(&Library::embedded().unwrap(), &owned(&[("Ar", 1.0)]), false).unwrap();
    assert!(
        alone
            .species
            .iter()
            .all(|species| species.count(Element::Fe) == 0)
    );
    let pure = alone.equilibrium(9000.0, ATMOSPHERE, 0.0).unwrap();
    let with = mixture.equilibrium(9000.0, ATMOSPHERE, 0.0).unwrap();
    for (species, n) in alone.species.iter().zip(&pure.number) {
        assert_eq!(
            n.to_bits(),
            number(&mixture, &with, &species.name).to_bits(),
            "{}",
            species.name
        );
    }
}

/// Ideal argon from 300 to 30,000 K by Saha's equation in closed form: with one ion n_e^2 = S (N - 2 n_e), where S holds the
/// partition functions and N = p/kT. Above, Ar++ takes part, so the law is checked on the numbers found.
#[test]
fn argon_obeys_saha() {
    let mixture = with_iron(&[("Ar", 1.0)]).with_lowering(Lowering::None);
    let [atom, ion] =
        ["Ar", "Ar+"].map(|name| mixture.species[mixture.index(name).unwrap()].clone());
    for t in [300.0, 1000.0, 5000.0, 8000.0, 10_000.0, 12_000.0, 20_000.0] {
        let state = mixture.equilibrium(t, ATMOSPHERE, 0.0).unwrap();
        let flight = (2.0 * PI * ELECTRON_MASS * BOLTZMANN * t).powf(1.5) / PLANCK.powi(3);
        let ratio = (ion.mass / atom.mass).powf(1.5);
        let log = ion.internal(t).ln_partition
            - atom.internal(t).ln_partition
            - ion.formation / (BOLTZMANN * t);
        let saha = 2.0 * flight * ratio * log.exp();
        let (e, i, a) = (
            number(&mixture, &state, "e-"),
            number(&mixture, &state, "Ar+"),
            number(&mixture, &state, "Ar"),
        );
        assert!(
            (e * i / a / saha - 1.0).abs() < 1e-11,
            "{t} K: {} {saha}",
            e * i / a
        );
        if t < 11_000.0 {
            let all = ATMOSPHERE / (BOLTZMANN * t);
            let closed = all / (1.0 + (1.0 + all / saha).sqrt());
            assert!((e / closed - 1.0).abs() < 2e-5, "{t} K: {e} {closed}");
        }
    }
}

/// Cold gases are what they were mixed of; hot ones electrons and ions alone.
#[test]
fn limits_are_the_cold_molecules_and_the_bare_plasma() {
    let mixture = with_iron(&[("Ar", 0.82), ("CO2", 0.18)]);
    let cold = mixture.equilibrium(300.0, ATMOSPHERE, 0.0).unwrap();
    let all = ATMOSPHERE / (BOLTZMANN * 300.0);
    assert!((number(&mixture, &cold, "Ar") / all - 0.82).abs() < 1e-12);
    assert!((number(&mixture, &cold, "CO2") / all - 0.18).abs() < 1e-12);
    for gas in GASES {
        let mixture = with_iron(gas);
        let hot = mixture
            .equilibrium(30_000.0, 0.1 * ATMOSPHERE, 0.3)
            .unwrap();
        let total: f64 = hot.number.iter().sum();
        let of = |kind: Kind| {
            sum(&mixture, &hot, |s| {
                f64::from(u8::from(mixture.species[s].kind == kind))
            }) / total
        };
        assert!(of(Kind::Electron) > 0.6, "electrons {}", of(Kind::Electron));
        assert!(
            of(Kind::Molecule) < 1e-8,
            "molecules {}",
            of(Kind::Molecule)
        );
        let neutral = sum(&mixture, &hot, |s| {
            f64::from(u8::from(mixture.species[s].charge == 0))
        }) / total;
        assert!(neutral < 1e-3, "neutral {neutral}");
    }
}

/// With Debye and Hueckel's law the ratio of Saha holds with the lowered energy e^2/(4 pi eps0 Debye length), and the
/// pressure is short of the ideal one by kT/(24 pi Debye length^3).
#[test]
fn lowering_is_that_of_debye_and_hueckel() {
    let ideal = with_iron(&[("Ar", 1.0)]).with_lowering(Lowering::None);
    let mixture = ideal.clone().with_lowering(Lowering::DebyeHueckel);
    for (t, p) in [
        (300.0, 1.0),
        (8000.0, 1.0),
        (12_000.0, 10.0),
        (20_000.0, 10.0),
        (30_000.0, 0.1),
    ] {
        let pressure = p * ATMOSPHERE;
        let [bare, lowered] = [&ideal, &mixture].map(|m| m.equilibrium(t, pressure, 0.1).unwrap());
        let thermal = BOLTZMANN * t;
        let charges = sum(&mixture, &lowered, |s| {
            f64::from(mixture.species[s].charge).powi(2)
        });
        let inverse = (ELEMENTARY_CHARGE.powi(2) * charges / (PERMITTIVITY * thermal)).sqrt();
        let energy = ELEMENTARY_CHARGE.powi(2) * inverse / (4.0 * PI * PERMITTIVITY);
        for (atom, ion, stage) in [("Ar", "Ar+", 1.0), ("Ar+", "Ar++", 2.0), ("Fe", "Fe+", 1.0)] {
            let ratio = |state: &State| {
                let n = |name| number(&mixture, state, name);
                (n(ion) / n(atom) * n("e-")).ln()
            };
            if number(&mixture, &lowered, ion) > 0.0 {
                let gain = ratio(&lowered) - ratio(&bare);
                assert!(
                    (gain - stage * energy / thermal).abs() < 1e-10,
                    "{t} K, {ion}: {gain}"
                );
            }
        }
        let kinetic = sum(&mixture, &lowered, |_| thermal);
        let short = thermal * inverse.powi(3) / (24.0 * PI);
        assert!(((kinetic - short) / pressure - 1.0).abs() < 1e-12, "{t} K");
    }
}

#[test]
fn results_depend_on_nothing_but_their_arguments() {
    let mixture = with_iron(&[("CO", 1.0)]);
    let first = mixture.equilibrium(4321.0, ATMOSPHERE, 0.07).unwrap();
    mixture.equilibrium(300.0, ATMOSPHERE, 0.9).unwrap();
    assert_eq!(
        first,
        mixture.equilibrium(4321.0, ATMOSPHERE, 0.07).unwrap()
    );
}

#[test]
fn what_cannot_be_is_named() {
    let library = Library::embedded().unwrap();
    let new = |gas: &[(&str, f64)]| Mixture::new(&library, &owned(gas), true).unwrap_err();
    assert_eq!(new(&[("He", 1.0)]), MixtureError::Unknown("He".to_owned()));
    assert_eq!(new(&[("FeO", 1.0)]), MixtureError::Iron("FeO".to_owned()));
    assert_eq!(new(&[]), MixtureError::Empty);
    assert!(matches!(
        new(&[("e-", 1.0)]),
        MixtureError::Charged { charge: -1, .. }
    ));
    assert!(matches!(new(&[("Ar", 0.8)]), MixtureError::Sum { .. }));
    assert!(matches!(
        new(&[("Ar", f64::NAN)]),
        MixtureError::Fraction { .. }
    ));
    let mixture = Mixture::new(&library, &owned(&[("Ar", 1.0)]), false).unwrap();
    let fails = |t, p, x| mixture.equilibrium(t, p, x).unwrap_err();
    assert_eq!(
        fails(200.0, 1e5, 0.0),
        EquilibriumError::Temperature { temperature: 200.0 }
    );
    assert_eq!(
        fails(1000.0, -1.0, 0.0),
        EquilibriumError::Pressure { pressure: -1.0 }
    );
    assert_eq!(
        fails(1000.0, 1e5, 0.1),
        EquilibriumError::Iron { iron: 0.1 }
    );
    assert!(fails(40_000.0, 1e5, 0.0).to_string().contains("40000 K"));
}

/// Where Debye and Hueckel's law has no thin plasma left to act on, the equation that fails is named, with where.
#[test]
fn what_does_not_converge_is_named() {
    let mixture = with_iron(&[("CO", 1.0)]);
    let error = mixture.equilibrium(9000.0, 1e10, 0.3).unwrap_err();
    let EquilibriumError::NotConverged {
        residual,
        value,
        tolerance,
        ..
    } = &error
    else {
        panic!("{error}");
    };
    assert!(residual == "screening length" && value > tolerance);
    assert!(
        error
            .to_string()
            .contains("9000 K, 10000000000.0 Pa, iron mole fraction 0.3"),
        "{error}"
    );
    assert!(
        mixture
            .clone()
            .with_lowering(Lowering::None)
            .equilibrium(9000.0, 1e10, 0.3)
            .is_ok()
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn random_states_are_conserved(
        gas in 0..GASES.len(),
        log_t in 300f64.ln()..30_000f64.ln(),
        log_p in 1e4f64.ln()..1e6f64.ln(),
        x in prop_oneof![Just(0.0), Just(1.0), 0.0..1.0, (-40.0..0.0).prop_map(f64::exp)],
    ) {
        let mixture = with_iron(GASES[gas]);
        let state = mixture.equilibrium(log_t.exp(), log_p.exp(), x).unwrap();
        assert_conserved(&mixture, &state);
    }
}
