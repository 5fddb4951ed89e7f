//! The columns of a gas table: name, unit, what it is, and whose numbers it rests on.

/// A column of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Name; ends in the unit.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Which property it is.
    pub part: Part,
    /// What it is and how it is found.
    pub what: &'static str,
    /// Keys of the sources in the data of the species.
    pub sources: &'static [&'static str],
}

/// A property of the gas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Density.
    Density,
    /// Specific heat at constant pressure.
    SpecificHeat,
    /// Enthalpy.
    Enthalpy,
    /// Viscosity.
    Viscosity,
    /// Thermal conductivity.
    ThermalConductivity,
    /// Electric conductivity.
    ElectricConductivity,
    /// Loss by light.
    NetEmission,
    /// Number of electrons.
    Electrons,
    /// Diffusion of iron through the gas.
    IronDiffusion,
}

const STATE: &[&str] = &["NIST_ASD", "Smyth2019", "BB2014", "NASA9"];
const COLLISIONS: &[&str] = &[
    "Wright2005",
    "Wright2007",
    "Mason1967",
    "Laricchiuta2007",
    "Milloy1977",
    "Phelps1994",
];

const ALL: [Column; 9] = [
    Column {
        name: "density_kg_m3",
        unit: "kg/m3",
        part: Part::Density,
        what: "ideal gas in local thermodynamic equilibrium",
        sources: STATE,
    },
    Column {
        name: "specific_heat_j_kg_k",
        unit: "J/(kg K)",
        part: Part::SpecificHeat,
        what: "dh/dT at constant pressure and elements, with the heat of reactions",
        sources: STATE,
    },
    Column {
        name: "enthalpy_j_kg",
        unit: "J/kg",
        part: Part::Enthalpy,
        what: "zero for the cold gas as its components are named, at 300 K, and apart from it zero for iron atoms as a \
               gas at 300 K: one zero for each group of elements that is conserved, so that differences at equal \
               elements, and heats of mixing with iron, are those of nature",
        sources: STATE,
    },
    Column {
        name: "viscosity_pa_s",
        unit: "Pa s",
        part: Part::Viscosity,
        what: "Chapman and Enskog, heavy particles",
        sources: COLLISIONS,
    },
    Column {
        name: "thermal_conductivity_w_m_k",
        unit: "W/(m K)",
        part: Part::ThermalConductivity,
        what: "Chapman and Enskog: flight of heavy particles and electrons, internal energy, reactions",
        sources: COLLISIONS,
    },
    Column {
        name: "electric_conductivity_s_m",
        unit: "S/m",
        part: Part::ElectricConductivity,
        what: "Chapman and Enskog, electrons to the third order of Devoto (1967)",
        sources: COLLISIONS,
    },
    Column {
        name: "net_emission_w_m3",
        unit: "W/m3",
        part: Part::NetEmission,
        what: "4 pi eps: lines and continuum above 200 nm that escape the centre of a homogeneous sphere (Lowke 1974), \
               or all of them in an optically thin gas; no bands of molecules",
        sources: &["NIST_ASD", "Verner1999"],
    },
    Column {
        name: "electron_density_1_m3",
        unit: "1/m3",
        part: Part::Electrons,
        what: "number of free electrons",
        sources: STATE,
    },
    Column {
        name: "iron_diffusion_m2_s",
        unit: "m2/s",
        part: Part::IronDiffusion,
        what: "combined diffusion of iron in all its forms through the cold gas's elements (Murphy 1993)",
        sources: COLLISIONS,
    },
];

impl Column {
    /// The columns of a table with or without net emission and iron.
    #[must_use]
    pub fn of(radiation: bool, iron: bool) -> Vec<Self> {
        let wanted = |column: &&Self| match column.part {
            Part::NetEmission => radiation,
            Part::IronDiffusion => iron,
            _ => true,
        };
        ALL.iter().filter(wanted).copied().collect()
    }

    /// Whether a gas can have this value: a number, and none below 0 but enthalpy.
    #[must_use]
    pub fn can_be(&self, value: f64) -> bool {
        value.is_finite() && (value >= 0.0 || self.part == Part::Enthalpy)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use super::*;
    use crate::mixture::Library;

    #[test]
    fn what_is_left_out_has_no_column() {
        let names = |radiation, iron| -> Vec<&str> {
            Column::of(radiation, iron).iter().map(|c| c.name).collect()
        };
        assert_eq!(names(true, true).len(), 9);
        assert!(!names(false, true).contains(&"net_emission_w_m3"));
        assert!(!names(true, false).contains(&"iron_diffusion_m2_s"));
    }

    #[test]
    fn only_enthalpy_may_be_negative() {
        for column in ALL {
            assert!(column.can_be(1.0) && !column.can_be(f64::NAN));
            assert_eq!(
                column.can_be(-1.0),
                column.part == Part::Enthalpy,
                "{}",
                column.name
            );
        }
    }

    #[test]
    fn every_source_is_one_of_the_data() {
        let library = Library::embedded().unwrap();
        for column in ALL {
            for key in column.sources {
                assert!(
                    library.data()["sources"][key].is_string(),
                    "{key} of {}",
                    column.name
                );
            }
        }
    }
}
