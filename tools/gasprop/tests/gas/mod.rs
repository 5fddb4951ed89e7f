//! Mixtures for the tests of composition and thermodynamics.

use gasprop::mixture::{Library, Mixture};

/// The cold gases of the tests: the scenes' argon, carbon monoxide, carbon dioxide and shielding gases, and one whose
/// oxygen and carbon both have several carriers when cold.
pub(crate) const GASES: [&[(&str, f64)]; 6] = [
    &[("Ar", 1.0)],
    &[("CO", 1.0)],
    &[("CO2", 1.0)],
    &[("Ar", 0.82), ("CO2", 0.18)],
    &[("Ar", 0.7), ("CO2", 0.2), ("O2", 0.1)],
    &[("CO", 0.1), ("CO2", 0.2), ("O2", 0.7)],
];

/// The mixture of a cold gas, with iron.
pub(crate) fn with_iron(gas: &[(&str, f64)]) -> Mixture {
    Mixture::new(&Library::embedded().unwrap(), &owned(gas), true).unwrap()
}

/// Components with owned names.
pub(crate) fn owned(gas: &[(&str, f64)]) -> Vec<(String, f64)> {
    gas.iter()
        .map(|(name, fraction)| ((*name).to_owned(), *fraction))
        .collect()
}
