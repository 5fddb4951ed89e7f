//! What the supply gives, and all that leaves.
//!
//! Between two metals a voltage is measured between the energies of their electrons. An electron that leaves the cathode
//! climbs its work function, falls through the layer and the column, and falls into the anode by that one's work function:
//!
//! ```text
//! V = V_column + V_cathode + (phi_anode - phi_cathode)
//! ```
//!
//! The last is the contact voltage. With it, V I pays all that leaves, but for what the closure of a cathode gives away: ions
//! that heat a thermionic cathode by the whole of their ionisation voltage (Komen 2019, eq. 5.21) take an electron out of the
//! metal for nothing, `(|j| - j_e) phi_cathode` in all. A cathode of given fall pays for it. What is not paid is an item of
//! its own here:
//!
//! ```text
//! V I + given + unpaid = radiation + evaporation + motion of metal + drops + edges + gas that flows out
//! ```
//!
//! Gas that flows out carries the enthalpy of its table: warmth, dissociation and ionisation.

use crate::heat::balance::{Balance, ElectrodeHeat};

/// What enters and what leaves \[W\].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Supply {
    /// Column, metals included: its voltage times the current.
    pub column: f64,
    /// Layer in front of the cathode.
    pub cathode: f64,
    /// Contact voltage times the current.
    pub contact: f64,
    /// Given sources.
    pub given: f64,
    /// What no voltage pays, by name.
    pub unpaid: Vec<(String, f64)>,
    /// What leaves, by name.
    pub leaves: Vec<(&'static str, f64)>,
}

impl Supply {
    /// Of a balance whose column takes `column` \[W\]; the electrodes of the balance are called `names`.
    #[must_use]
    pub fn new<'a>(column: f64, balance: &Balance, names: impl Iterator<Item = &'a str>) -> Self {
        let all = &balance.electrodes;
        let sum = |part: fn(&ElectrodeHeat) -> f64| all.iter().map(part).sum::<f64>();
        let (gained, climbed) = (sum(|e| e.gained), sum(|e| e.climbed));
        let mut unpaid = Vec::new();
        // With one electrode alone there is no circuit from metal to metal, and no contact voltage.
        let whole = gained > 0.0 && climbed > 0.0;
        for (name, one) in names.zip(all) {
            if one.ungiven > 0.0 {
                unpaid.push((format!("ions_{name}"), one.ungiven));
            }
            let alone = one.gained - one.climbed;
            if !whole && alone.abs() > 0.0 {
                unpaid.push((format!("work_function_{name}"), alone));
            }
        }
        let evaporation = -(sum(|e| e.vapour) + balance.vapour);
        let taken_up = sum(|e| e.radiation) + balance.granular;
        let mut leaves = vec![
            ("radiation", -(balance.radiation + taken_up)),
            ("surface_radiation", -sum(|e| e.emission)),
            ("evaporation", evaporation),
            ("motion", -balance.plate),
            ("drops", -balance.drops),
            ("edges", -balance.edges),
            ("flow", -balance.flow),
        ];
        leaves.extend(balance.electrons.map(|electrons| ("electrons", -electrons)));
        Self {
            column,
            cathode: sum(|e| e.layer),
            contact: if whole { gained - climbed } else { 0.0 },
            given: balance.given,
            unpaid,
            leaves,
        }
    }

    /// Voltage times current.
    #[must_use]
    pub fn electric(&self) -> f64 {
        self.column + self.cathode + self.contact
    }

    /// All that no voltage pays.
    #[must_use]
    pub fn owed(&self) -> f64 {
        self.unpaid.iter().map(|item| item.1).sum()
    }

    /// All that leaves.
    #[must_use]
    pub fn left(&self) -> f64 {
        self.leaves.iter().map(|item| item.1).sum()
    }

    /// What enters, unpaid items among it, more than leaves: zero where every equation holds.
    #[must_use]
    pub fn closure(&self) -> f64 {
        self.electric() + self.given + self.owed() - self.left()
    }
}
