//! What a scene of gas properties says.

use std::collections::BTreeMap;

use run::Fault;
use schemars::JsonSchema;
use serde::Deserialize;

/// A scene of gas properties: a cold gas, its pressure, and where it is evaluated.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What gas this is, for people.
    #[serde(default)]
    pub title: Option<String>,
    /// The cold gas: names of neutral species with their mole fractions, which sum to 1: `{"Ar": 0.8, "CO2": 0.2}`.
    #[schemars(length(min = 1))]
    pub gas: BTreeMap<String, f64>,
    /// Pressure \[Pa\].
    #[schemars(range(min = 1e3, max = 1e7), extend("x-unit" = "Pa"))]
    pub pressure_pa: f64,
    /// Temperatures of the table.
    pub temperatures: Temperatures,
    /// Moles of iron per mole of iron and cold gas, rising, between 0 and 1; absent: no iron, and no species of it.
    #[serde(default)]
    #[schemars(length(min = 1, max = 100))]
    pub iron_mole_fraction: Option<Vec<f64>>,
    /// Net emission; absent: no such column.
    #[serde(default)]
    pub radiation: Option<Radiation>,
    /// Other values for inputs that are uncertain; absent: those of the data.
    #[serde(default)]
    pub uncertain: Option<Uncertain>,
    /// Limits of the table's errors; absent: a quarter.
    #[serde(default)]
    pub accuracy: Option<Accuracy>,
}

/// Temperatures of the table.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Temperatures {
    /// Placed where linear interpolation errs most: intervals are halved until there are so many.
    Chosen(Range),
    /// At equal distances.
    Even(Range),
    /// As listed \[K\], rising.
    ListK(#[schemars(length(min = 2, max = 10000), extend("x-unit" = "K"))] Vec<f64>),
}

/// Temperatures from one to another.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// First \[K\].
    #[schemars(range(min = 300.0, max = 30000.0), extend("x-unit" = "K"))]
    pub from_k: f64,
    /// Last \[K\].
    #[schemars(range(min = 300.0, max = 30000.0), extend("x-unit" = "K"))]
    pub to_k: f64,
    /// How many, with both.
    #[schemars(range(min = 2, max = 10000))]
    pub count: u32,
}

/// Net emission of light.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Radiation {
    /// Radius of the homogeneous sphere from whose centre light escapes \[m\]: about that of the arc's core, 1e-3 to
    /// 5e-3; absent: the optically thin limit, where all light escapes.
    #[serde(default)]
    #[schemars(range(min = 1e-9, max = 10.0), extend("x-unit" = "m"))]
    pub absorption_length_m: Option<f64>,
}

/// Inputs that no measurement settles.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Uncertain {
    /// Cross-section of the momentum transfer from electrons to iron atoms, the same at all energies \[m2\].
    #[serde(default)]
    #[schemars(range(min = 1e-21, max = 1e-17), extend("x-unit" = "m2"))]
    pub electron_iron_cross_section_m2: Option<f64>,
    /// The same cross-section for rare neutral species that have no data of their own \[m2\].
    #[serde(default)]
    #[schemars(range(min = 1e-21, max = 1e-17), extend("x-unit" = "m2"))]
    pub electron_other_cross_section_m2: Option<f64>,
    /// Effective number of electrons of the iron atom in the force of dispersion.
    #[serde(default)]
    #[schemars(range(min = 1.0, max = 26.0))]
    pub iron_effective_electrons: Option<f64>,
    /// Factor on the cross-section of charge exchange between iron atoms and ions.
    #[serde(default)]
    #[schemars(range(min = 0.1, max = 10.0))]
    pub iron_charge_exchange_factor: Option<f64>,
    /// Principal quantum number of the last shell of neutral atoms: levels that lists lack are filled up to it, for ions
    /// accordingly farther, and no level lies above. Absent: the last shell that the fields of ions allow where charges
    /// are densest, the sixth of argon at 1 atm (Inglis and Teller 1939).
    #[serde(default)]
    #[schemars(range(min = 5, max = 30))]
    pub filled_to_shell: Option<u32>,
    /// Excited levels of atoms and ions; absent: filled shells.
    #[serde(default)]
    pub levels: Option<Levels>,
}

/// Which excited levels atoms and ions have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Levels {
    /// Those that lists of spectra hold, and no others.
    Listed,
}

/// What the table must meet.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// Greatest error of linear interpolation along the temperatures, relative to the value or, where that is small, to
    /// a thousandth of the column's greatest; beyond it the run ends with a warning.
    #[schemars(range(min = 1e-6, max = 1.0))]
    pub temperature: f64,
    /// The same along the iron fractions; absent: a quarter.
    #[serde(default)]
    #[schemars(range(min = 1e-6, max = 1.0))]
    pub iron: Option<f64>,
}

/// Temperatures at which the data hold \[K\].
const RANGE: [f64; 2] = [300.0, 30_000.0];

impl Scene {
    /// What the types cannot express.
    #[must_use]
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.temperature_faults(&mut faults);
        if let Some(iron) = &self.iron_mole_fraction {
            rising("/iron_mole_fraction", iron, [0.0, 1.0], &mut faults);
        }
        for (name, fraction) in &self.gas {
            if !(*fraction > 0.0 && *fraction <= 1.0) {
                let what = format!("{fraction} is out of range: above 0, at most 1");
                faults.push(Fault::at(&format!("/gas/{name}"), what));
            }
        }
        let sum: f64 = self.gas.values().sum();
        if (sum - 1.0).abs() > 1e-9 {
            faults.push(Fault::at(
                "/gas",
                format!("the mole fractions sum to {sum}, not to 1"),
            ));
        }
        if self.iron_mole_fraction.is_none()
            && self.uncertain.is_some_and(|given| given.is_of_iron())
        {
            let what = "these inputs belong to iron, and the scene has no key 'iron_mole_fraction'";
            faults.push(Fault::at("/uncertain", what));
        }
        if self
            .uncertain
            .is_some_and(|given| given.levels.is_some() && given.filled_to_shell.is_some())
        {
            let what =
                "levels as listed have no shells to fill: leave out 'filled_to_shell' or 'levels'";
            faults.push(Fault::at("/uncertain/filled_to_shell", what));
        }
        faults
    }

    fn temperature_faults(&self, faults: &mut Vec<Fault>) {
        match &self.temperatures {
            Temperatures::ListK(list) => rising("/temperatures/list-k", list, RANGE, faults),
            Temperatures::Chosen(range) | Temperatures::Even(range)
                if range.from_k >= range.to_k =>
            {
                let what = format!(
                    "from_k = {} K is not below to_k = {} K",
                    range.from_k, range.to_k
                );
                faults.push(Fault::at("/temperatures", what));
            }
            _ => {}
        }
    }

    /// Iron fractions of the table: 0 alone where the scene has none.
    #[must_use]
    pub fn iron(&self) -> &[f64] {
        self.iron_mole_fraction.as_deref().unwrap_or(&[0.0])
    }

    /// How many temperatures the table has.
    #[must_use]
    pub fn count(&self) -> usize {
        match &self.temperatures {
            Temperatures::Chosen(range) | Temperatures::Even(range) => range.count as usize,
            Temperatures::ListK(list) => list.len(),
        }
    }
}

impl Uncertain {
    fn is_of_iron(&self) -> bool {
        [
            self.electron_iron_cross_section_m2,
            self.iron_charge_exchange_factor,
            self.iron_effective_electrons,
        ]
        .iter()
        .any(Option::is_some)
    }
}

/// Faults of a list that must rise between two values.
fn rising(path: &str, list: &[f64], [least, most]: [f64; 2], faults: &mut Vec<Fault>) {
    for (k, value) in list.iter().enumerate() {
        if !(least..=most).contains(value) {
            let what = format!("{value} is out of range: {least} to {most}");
            faults.push(Fault::at(&format!("{path}/{k}"), what));
        }
        if k > 0 && list[k - 1] >= *value {
            let what = format!("{value} does not exceed {}, the one before", list[k - 1]);
            faults.push(Fault::at(&format!("{path}/{k}"), what));
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use super::*;
    use serde_json::json;

    fn faults(change: serde_json::Value) -> Vec<String> {
        let mut scene = json!({
            "gas": {"Ar": 1.0},
            "pressure_pa": 101_325.0,
            "temperatures": {"chosen": {"from_k": 300.0, "to_k": 30000.0, "count": 100}},
        });
        for (key, value) in change.as_object().unwrap() {
            scene[key] = value.clone();
        }
        let scene: Scene = serde_json::from_value(scene).unwrap();
        scene.faults().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_sound_scene_has_no_fault() {
        assert!(faults(json!({})).is_empty());
        assert!(
            faults(json!({"iron_mole_fraction": [0.0, 0.1, 1.0], "gas": {"Ar": 0.8, "CO2": 0.2}}))
                .is_empty()
        );
    }

    #[test]
    fn every_fault_is_told_with_its_place() {
        let all = faults(json!({
            "gas": {"Ar": 0.5, "CO2": -0.1},
            "temperatures": {"list-k": [300.0, 200.0, 1e5]},
            "iron_mole_fraction": [0.0, 0.0, 2.0],
        }));
        let text = all.join("\n");
        for part in [
            "/gas/CO2",
            "sum to 0.4",
            "/temperatures/list-k/1",
            "/temperatures/list-k/2",
            "100000",
            "/iron_mole_fraction/1",
            "/iron_mole_fraction/2",
        ] {
            assert!(text.contains(part), "{part} is not in:\n{text}");
        }
    }

    #[test]
    fn listed_levels_are_not_filled() {
        let all = faults(json!({"uncertain": {"levels": "listed", "filled_to_shell": 7}}));
        assert_eq!(all.len(), 1);
        assert!(all[0].contains("/uncertain/filled_to_shell"));
        assert!(faults(json!({"uncertain": {"levels": "listed"}})).is_empty());
    }

    #[test]
    fn inputs_of_iron_need_iron() {
        let all = faults(json!({"uncertain": {"electron_iron_cross_section_m2": 2e-19}}));
        assert_eq!(all.len(), 1);
        assert!(all[0].contains("/uncertain"));
    }
}
