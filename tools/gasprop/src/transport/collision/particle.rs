//! What a species is to its collision partners, with estimates where the data are silent.

use crate::constants::ELECTRON_VOLT;
use crate::mixture::{Element, Kind, Species};
use crate::transport::Uncertain;

/// Polarisabilities of the neutral atoms, for estimates of what they form [A3]; the values of the data file
/// (Schwerdtfeger and Nagle 2019; Wright et al. 2007).
const ATOMS: [(Element, f64); 4] = [
    (Element::Ar, 1.642),
    (Element::C, 1.76),
    (Element::O, 0.8),
    (Element::Fe, 9.19),
];
/// By how much the loss of each electron shrinks the polarisability of an atom or molecule: 0.49 (C, O) to 0.63 (CO)
/// where the data know both.
const CATION_SHRINKS: f64 = 0.55;
/// By how much an extra electron swells it: about 4 for O and C.
const ANION_SWELLS: f64 = 4.0;

/// A species as its collision partners see it.
#[derive(Debug, Clone)]
pub(crate) struct Particle {
    pub(crate) name: String,
    pub(crate) kind: Kind,
    /// In elementary charges.
    pub(crate) charge: i32,
    /// kg.
    pub(crate) mass: f64,
    /// Of the ground state, J above the atoms.
    pub(crate) formation: f64,
    /// A3.
    pub(crate) polarisability: f64,
    /// Electrons that take part in dispersion.
    pub(crate) effective_electrons: f64,
    /// 2S + 1 of the ground state.
    pub(crate) multiplicity: f64,
    pub(crate) has_iron: bool,
}

impl Particle {
    pub(crate) fn new(species: &Species, uncertain: &Uncertain) -> Self {
        let has_iron = species
            .elements
            .iter()
            .any(|(e, n)| *e == Element::Fe && *n > 0);
        let electrons = if species.name == "Fe" {
            uncertain.iron_effective_electrons
        } else {
            species
                .effective_electrons
                .unwrap_or_else(|| effective_electrons(species))
        };
        Self {
            name: species.name.clone(),
            kind: species.kind,
            charge: species.charge,
            mass: species.mass,
            formation: species.formation,
            polarisability: species
                .polarisability
                .map_or_else(|| polarisability(species), |a| a * 1e30),
            effective_electrons: electrons,
            multiplicity: f64::from(species.ground_multiplicity.max(1)),
            has_iron,
        }
    }

    pub(crate) fn is_electron(&self) -> bool {
        self.kind == Kind::Electron
    }

    /// Energy to turn this into `ion` [eV].
    pub(crate) fn ionisation(&self, ion: &Self) -> f64 {
        (ion.formation - self.formation) / ELECTRON_VOLT
    }
}

/// Estimate of a polarisability that the data lack [A3]: atoms add up; each electron lost or won changes it by a
/// factor. Only species that stay rare need it (C3, O3, FeO, O++, ions of molecules, negative ions).
fn polarisability(species: &Species) -> f64 {
    let atom = |element: Element| {
        ATOMS
            .iter()
            .find(|(e, _)| *e == element)
            .map_or(0.0, |(_, a)| *a)
    };
    let neutral: f64 = species
        .elements
        .iter()
        .map(|(e, n)| atom(*e) * f64::from(*n))
        .sum();
    if species.charge < 0 {
        neutral * ANION_SWELLS
    } else {
        neutral * CATION_SHRINKS.powi(species.charge)
    }
}

/// Effective electrons of a molecule, Cambi et al. (1991), J. Chem. Phys. 95, 1852: of `N = N_b + N_n` outer electrons,
/// bonding and not, `N_eff = N (1 - N_b N_n / N^2)`. Two outer electrons a bond; the count of bonds is that of the
/// usual valence pictures (CO triple; O2, C2 double; CO2 and C3 two double; O3 one and a half twice).
fn effective_electrons(species: &Species) -> f64 {
    let outer: u32 = species
        .elements
        .iter()
        .map(|(element, n)| {
            n * match element {
                Element::Ar | Element::Fe => 8,
                Element::C => 4,
                Element::O => 6,
            }
        })
        .sum();
    let bonding = match species.name.as_str() {
        "CO" => 6.0,
        "O2" | "C2" | "FeO" => 4.0,
        "CO2" | "C3" => 8.0,
        "O3" => 6.0,
        _ => 0.0,
    };
    let outer = f64::from(outer);
    outer - bonding * (outer - bonding) / outer
}
