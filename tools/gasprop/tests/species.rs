//! The species: energy levels and fits against the numbers that their sources give, and against each other.

#![allow(clippy::unwrap_used, reason = "a test may fail")]

use gasprop::constants::{BOLTZMANN, ELECTRON_VOLT};
use gasprop::mixture::{Element, Kind, Library};

/// Formation energy of a species in eV.
fn formation(library: &Library, name: &str) -> f64 {
    library.get(name).unwrap().formation / ELECTRON_VOLT
}

#[test]
fn the_electron_comes_first_and_masses_add_up() {
    let library = Library::embedded().unwrap();
    assert_eq!(library.species()[0].kind, Kind::Electron);
    let mass = |name: &str| library.get(name).unwrap().mass;
    let electron = mass("e-");
    for species in &library.species()[1..] {
        let nuclei: f64 = species
            .elements
            .iter()
            .map(|(e, n)| mass(e.as_str()) * f64::from(*n))
            .sum();
        let sum = nuclei - f64::from(species.charge) * electron;
        assert!(
            (species.mass / sum - 1.0).abs() < 2e-7,
            "{}: {} {sum}",
            species.name,
            species.mass
        );
    }
}

/// The levels give the partition functions that were computed from all levels before they were lumped.
#[test]
fn levels_give_the_partition_functions_of_their_sources() {
    let library = Library::embedded().unwrap();
    let mut checked = 0;
    for (name, written) in library.data()["species"].as_object().unwrap() {
        let Some(check) = written.get("Q_check").and_then(|q| q.as_object()) else {
            continue;
        };
        for (t, expected) in check {
            let got = library
                .get(name)
                .unwrap()
                .internal(t.parse().unwrap())
                .ln_partition
                .exp();
            let error = got / expected.as_f64().unwrap() - 1.0;
            assert!(error.abs() < 4e-5, "{name} at {t} K: {error:e}");
            checked += 1;
        }
    }
    assert_eq!(checked, 16 * 6);
}

/// Energy and heat capacity are the derivatives of ln Q, on the fits and beyond them.
#[test]
fn energy_and_heat_capacity_are_derivatives_of_the_partition_function() {
    let library = Library::embedded().unwrap();
    for species in library.species() {
        for t in [
            300.0, 700.0, 995.0, 2500.0, 5900.0, 6100.0, 19_000.0, 21_000.0, 30_000.0,
        ] {
            let step = 1e-4 * t;
            let [below, here, above] = [t - step, t, t + step].map(|t| species.internal(t));
            let energy =
                BOLTZMANN * t * t * (above.ln_partition - below.ln_partition) / (2.0 * step);
            let capacity = (above.energy - below.energy) / (2.0 * step);
            let thermal = BOLTZMANN * t;
            let name = &species.name;
            assert!(
                (energy - here.energy).abs() < 1e-7 * thermal.max(here.energy),
                "{name} at {t} K: {energy}"
            );
            let scale = BOLTZMANN.max(here.heat_capacity);
            assert!(
                (capacity - here.heat_capacity).abs() < 1e-6 * scale,
                "{name} at {t} K: {capacity}"
            );
        }
    }
}

/// Where ranges meet, ln Q and energy go on without steps, and heat capacities step by what the publication rounds.
#[test]
fn ranges_are_sewn_together() {
    let library = Library::embedded().unwrap();
    for species in library.species() {
        for t in [1000.0, 6000.0, 20_000.0] {
            let [below, above] =
                [1.0 - 1e-13, 1.0 + 1e-13].map(|factor| species.internal(t * factor));
            assert!(
                (above.ln_partition - below.ln_partition).abs() < 1e-11,
                "{} at {t} K",
                species.name
            );
            assert!(
                (above.energy - below.energy).abs() < 1e-11 * BOLTZMANN * t,
                "{} at {t} K",
                species.name
            );
            let step = (above.heat_capacity - below.heat_capacity).abs();
            assert!(step < 3e-6 * BOLTZMANN, "{} at {t} K: {step}", species.name);
        }
    }
}

/// Heat capacities stay positive and bounded from 298 to 31,000 K, far beyond what the fits cover.
#[test]
fn continuations_are_bounded() {
    let library = Library::embedded().unwrap();
    for species in library
        .species()
        .iter()
        .filter(|species| species.kind == Kind::Molecule)
    {
        let nuclei: u32 = species.elements.iter().map(|(_, n)| n).sum();
        for i in 0..=400 {
            let capacity = species.internal(298.15 + 76.8 * f64::from(i)).heat_capacity / BOLTZMANN;
            assert!(
                capacity > 0.5 && capacity < 6.0 * f64::from(nuclei - 1),
                "{}: {capacity}",
                species.name
            );
        }
    }
}

/// Above its last range FeO follows the partition functions of Barklem and Collet (2016) to 2 %.
#[test]
fn iron_oxide_goes_on_with_the_second_source() {
    let library = Library::embedded().unwrap();
    let written = &library.data()["species"]["FeO"];
    let oxide = library.get("FeO").unwrap();
    let table: Vec<(f64, f64)> = (9..14)
        .map(|i| {
            (
                written["Q_T_K"][i].as_f64().unwrap(),
                written["Q_BC2016"][i].as_f64().unwrap(),
            )
        })
        .collect();
    let (start, first) = table[0];
    assert!((start - 6000.0).abs() < 1e-9);
    for (t, q) in table {
        let gain = oxide.internal(t).ln_partition - oxide.internal(start).ln_partition;
        assert!((gain - (q / first).ln()).abs() < 0.025, "{t} K: {gain}");
    }
}

/// Fits and partition functions of two houses: McBride et al. (2002) and Barklem and Collet (2016).
///
/// C2 and FeO differ by what is known of their electronic states: C2's low triplet, FeO's many terms.
#[test]
fn two_sources_of_molecular_partition_functions_agree() {
    let library = Library::embedded().unwrap();
    let limits = [
        ("CO", 0.003),
        ("CO+", 0.01),
        ("O2", 0.035),
        ("O2+", 0.015),
        ("C2", 0.15),
        ("FeO", 0.26),
    ];
    for (name, limit) in limits {
        let written = &library.data()["species"][name];
        let temperatures = written["Q_T_K"].as_array().unwrap();
        for (t, q) in temperatures
            .iter()
            .zip(written["Q_BC2016"].as_array().unwrap())
        {
            let got = library
                .get(name)
                .unwrap()
                .internal(t.as_f64().unwrap())
                .ln_partition;
            let error = got - q.as_f64().unwrap().ln();
            assert!(error.abs() < limit, "{name} at {t} K: {error}");
        }
    }
}

/// Cycles of energy: dissociation energies (Barklem and Collet 2016, Huber and Herzberg) and ionisation energies of the
/// data file against the formation energies that come from the fits' enthalpies; and the levels' atoms against the
/// fits' atoms.
#[test]
fn energies_close_their_cycles() {
    let library = Library::embedded().unwrap();
    let e = |name: &str| formation(&library, name);
    let close = |what: &str, got: f64, expected: f64, limit: f64| {
        assert!(
            (got - expected).abs() < limit,
            "{what}: {got} eV, expected {expected}"
        );
    };
    close("D0 of CO", -e("CO"), 11.117, 0.015);
    close("D0 of CO+", e("C+") - e("CO+"), 8.3654, 0.015);
    close("D0 of O2", -e("O2"), 5.116_42, 0.002);
    close("D0 of O2+", e("O+") - e("O2+"), 6.6631, 0.006);
    close("ionisation of CO", e("CO+") - e("CO"), 14.0142, 0.002);
    close("ionisation of O2", e("O2+") - e("O2"), 12.0697, 0.006);
    close("ionisation of CO2", e("CO2+") - e("CO2"), 13.777, 0.02);
    close(
        "CO2 = CO + O (CODATA 1989: 5.453 eV)",
        e("CO") - e("CO2"),
        5.453,
        0.003,
    );
    close("affinity of O", -e("O-"), 1.4611, 0.001);
    close("affinity of C", -e("C-"), 1.2621, 0.001);
    close("first ionisation of C", e("C+"), 11.2603, 1e-4);
    close("affinity of O2", e("O2") - e("O2-"), 0.448, 0.01);
    // FeO by JANAF (1966), 4.24 +- 0.2 eV, against 4.1808; C2 by Gurvich (1991), 6.22 eV, the value of the thermochemical
    // network (6.245), against 6.371.
    close("D0 of FeO", -e("FeO"), 4.1808, 0.06);
    close("D0 of C2", -e("C2"), 6.245, 0.03);
}

/// The atoms' enthalpies at 298.15 K that enter formation energies are those of the levels, to 0.25 J/mol.
#[test]
fn atoms_of_levels_and_of_fits_are_the_same() {
    let library = Library::embedded().unwrap();
    for element in Element::ALL {
        let atom = library.get(element.as_str()).unwrap();
        let fit = &library.data()["thermo_nasa9"]["data"][element.as_str()];
        let thermal = atom.internal(298.15).energy + 2.5 * BOLTZMANN * 298.15;
        let molar = thermal * gasprop::constants::AVOGADRO;
        assert!(
            (molar - fit["H298_minus_H0_J_mol"].as_f64().unwrap()).abs() < 0.25,
            "{element:?}: {molar}"
        );
    }
}
