#![allow(clippy::unwrap_used, reason = "a test may fail")]

use super::{Radiation, continuum, escape, voigt};
use crate::constants::{BOLTZMANN, ELECTRON_VOLT};
use crate::mixture::{Library, Mixture, Species};

/// Each species alone, with no electrons: lines are all there is.
fn alone(name: &str) -> (Library, Radiation, Vec<Species>) {
    let library = Library::embedded().unwrap();
    let species = vec![library.get(name).unwrap().clone()];
    let radiation = Radiation::new(library.data(), &species).unwrap();
    (library, radiation, species)
}

const EMITTERS: [&str; 8] = ["Ar", "Ar+", "Fe", "Fe+", "C", "C+", "O", "O+"];

/// The lumps of the data hold all lines, summed by others than the list of lines: five digits.
#[test]
fn a_thin_gas_gives_off_what_all_lumps_hold() {
    for name in EMITTERS {
        let (library, radiation, species) = alone(name);
        let lumps = &library.data()["radiation"]["lumps"][name];
        for t in [3e3, 8e3, 1.5e4, 3e4] {
            let number = 1e23;
            let per_state = number * (-species[0].internal(t).ln_partition).exp();
            let mut sum = 0.0;
            for class in lumps.as_object().unwrap().values() {
                for lump in class.as_array().unwrap() {
                    let (energy, power) = (lump[0].as_f64().unwrap(), lump[1].as_f64().unwrap());
                    sum += power * (-energy * ELECTRON_VOLT / (BOLTZMANN * t)).exp();
                }
            }
            let found = radiation.net_emission(&species, t, &[number], None).total();
            let error = found / (sum * per_state) - 1.0;
            // Five digits; and energies that are means over 0.1 eV: exp(-E/kT) is convex.
            let spread = 0.05 * ELECTRON_VOLT / (BOLTZMANN * t);
            assert!(
                error.abs() < 1e-3 + 0.5 * spread * spread,
                "{name} at {t} K: {error}"
            );
        }
    }
}

#[test]
fn the_listed_lines_are_the_part_of_all_that_the_data_say() {
    for (name, part) in [
        ("Ar", 1.0),
        ("Fe", 0.9018),
        ("Fe+", 0.9631),
        ("C", 0.9997),
        ("O", 0.9999),
    ] {
        let (_, radiation, species) = alone(name);
        let emission = radiation.net_emission(&species, 1e4, &[1e23], None);
        let found = emission.lines / emission.total();
        assert!((found - part).abs() < 2e-3, "{name}: {found}");
    }
}

#[test]
fn a_longer_way_out_lets_less_through_and_a_short_one_all() {
    for name in EMITTERS {
        let (_, radiation, species) = alone(name);
        for t in [4e3, 1e4, 2.5e4] {
            let of = |length| radiation.net_emission(&species, t, &[1e23], length).total();
            let thin = of(None);
            assert!((of(Some(1e-14)) / thin - 1.0).abs() < 1e-3, "{name} {t}");
            let mut last = thin * (1.0 + 1e-9);
            for k in -12..2 {
                let now = of(Some(10.0_f64.powi(k)));
                assert!(
                    now <= last && now > 0.0,
                    "{name} {t} K, 1e{k} m: {now} after {last}"
                );
                last = now;
            }
        }
    }
}

/// What leaves a line of any depth is less than Planck's light over the width that it blackens:
/// `y exp(-y) <= 1 - exp(-y)` at each frequency, summed here by a rule of its own.
#[test]
fn a_line_never_outshines_the_black_body_over_its_width() {
    for a in [1e-3, 0.1, 10.0] {
        for k in -2..6 {
            let s = 10.0_f64.powi(k);
            let step = 0.01;
            let mut blackened = 0.0;
            let mut x = 0.5 * step;
            while x < 2e3 {
                let depth = s * voigt::profile(a, x);
                blackened -= 2.0 * step * (-depth).exp_m1();
                x += step;
            }
            // Far wings are thin where they are cut off, or this bound is too low by no more than they hold.
            blackened += 2.0 * s * a / (std::f64::consts::PI * x);
            let leaves = s * escape::factor(s, a);
            assert!(
                leaves <= blackened * 1.001,
                "{s} {a}: {leaves} above {blackened}"
            );
            if k >= 4 {
                assert!(
                    leaves > 0.05 * blackened,
                    "{s} {a}: {leaves} below {blackened}"
                );
            }
        }
    }
}

/// The hottest a sphere can shine: over all lines and the continuum, `4 pi eps R` stays below `4 pi` times Planck's
/// light integrated over all frequencies.
#[test]
fn a_great_sphere_stays_below_the_black_body() {
    let (_, radiation, species) = alone("Fe");
    for t in [5e3, 1e4] {
        for length in [1e-3, 1e-2, 0.1] {
            let lost = radiation
                .net_emission(&species, t, &[1e24], Some(length))
                .total()
                * length;
            let black = 4.0 * crate::constants::STEFAN_BOLTZMANN * t.powi(4);
            assert!(lost < black, "{t} K, {length} m: {lost} W/m2 of {black}");
        }
    }
    assert!(
        continuum::loss(1e4, 1e50, Some(1.0)) < 4.0 * crate::constants::STEFAN_BOLTZMANN * 1e16
    );
}

/// What escapes of argon's light above 200 nm in an optically thin gas, over a sample of a published coefficient: the
/// ratios that the data tell of another program's sums. The published coefficient is itself uncertain; nothing is fitted
/// to it.
#[test]
fn thin_argon_above_200_nm_is_to_published_light_as_the_data_say() {
    let library = Library::embedded().unwrap();
    let gas = Mixture::new(&library, &[("Ar".to_owned(), 1.0)], false).unwrap();
    let radiation = Radiation::new(library.data(), &gas.species).unwrap();
    let published = library.data()["radiation"]["argon_tps"]["data"]
        .as_array()
        .unwrap();
    for (t, told) in [(8095.5, 1.08), (10_070.3, 1.42), (15_336.0, 1.13)] {
        let row = published
            .iter()
            .find(|row| (row[0].as_f64().unwrap() - t).abs() < 20.0)
            .unwrap();
        let t = row[0].as_f64().unwrap();
        let state = gas.equilibrium(t, 101_325.0, 0.0).unwrap();
        let mut far_ultraviolet = 0.0;
        for emitter in &radiation.emitters {
            let own = &gas.species[emitter.place];
            let per_state = state.number[emitter.place] * (-own.internal(t).ln_partition).exp();
            for line in emitter
                .spectrum
                .lines
                .iter()
                .filter(|line| line.wavelength < 200e-9)
            {
                far_ultraviolet += per_state * line.power() * (-line.upper / (BOLTZMANN * t)).exp();
            }
        }
        let all = radiation
            .net_emission(&gas.species, t, &state.number, None)
            .total();
        let light = 4.0 * std::f64::consts::PI * row[1].as_f64().unwrap();
        let ratio = (all - far_ultraviolet) / light;
        assert!(
            (ratio / told - 1.0).abs() < 0.03,
            "{t} K: {ratio}, told {told}"
        );
        // The far ultraviolet is most of a thin gas's light, and hardly any leaves a millimetre.
        let absorbed = radiation
            .net_emission(&gas.species, t, &state.number, Some(1e-3))
            .total();
        assert!(far_ultraviolet > 2.0 * (all - far_ultraviolet), "{t} K");
        assert!(absorbed < 2.0 * (all - far_ultraviolet), "{t} K");
    }
}
