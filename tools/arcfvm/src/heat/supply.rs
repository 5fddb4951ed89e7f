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

use run::Session;

use crate::heat::balance::{Balance, ElectrodeHeat};
use crate::residual::part;
use crate::solver::Arc;

/// Part of the power by which all that leaves may differ from it, unpaid items counted.
const MOST: f64 = 0.02;
/// Part of the power from which on an unpaid item is told.
const TOLD: f64 = 1e-3;

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

/// Voltages of an arc \[V\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Voltage {
    /// Column, metals included.
    pub column: f64,
    /// Layer in front of the cathode (Komen 2019, eq. 5.29).
    pub cathode: f64,
    /// Work function of the anode over that of the cathode.
    pub contact: f64,
}

impl Voltage {
    /// Between the ends of the metals.
    #[must_use]
    pub fn all(&self) -> f64 {
        self.column + self.cathode + self.contact
    }
}

impl Arc {
    /// What the supply gives and all that leaves.
    #[must_use]
    pub fn supply(&self, balance: &Balance) -> Supply {
        let current = self.case.potential.as_ref().zip(self.electric.as_ref());
        let column = current.map_or(0.0, |(setup, electric)| {
            electric.potential.power(&self.case.grid, setup)
        });
        let surfaces = self.case.surfaces.as_ref();
        let names = surfaces.iter().flat_map(|s| &s.electrodes);
        Supply::new(column, balance, names.map(|e| e.name.as_ref()))
    }

    /// Voltages, where a current is driven.
    #[must_use]
    pub fn voltage(&self, supply: Option<&Supply>) -> Option<Voltage> {
        let driven = self.case.potential.as_ref()?.driven?;
        // A current that leaves the driven face has a negative potential there.
        let column = self.electric.as_ref()?.potential.drive.abs();
        let over = |power: fn(&Supply) -> f64| supply.map_or(0.0, |s| power(s) / driven.abs());
        Some(Voltage {
            column,
            cathode: over(|s| s.cathode),
            contact: over(|s| s.contact),
        })
    }

    /// Power for scale \[W\]: that of the supply, or all that is given and exchanged, or passes from edge to edge.
    #[must_use]
    pub fn power(&self, balance: &Balance) -> f64 {
        let electric = self.supply(balance).electric();
        if electric > 0.0 {
            electric
        } else {
            let net = balance.given.abs() + balance.edges.abs() + balance.flow.abs();
            // What comes in through one edge and leaves through another.
            net.max(0.5 * balance.exchanged)
        }
    }

    /// Says what the supply pays, and what it does not.
    pub fn tell_supply(&self, balance: &Balance, session: &mut Session) {
        let supply = self.supply(balance);
        let scale = self.power(balance);
        let missing = part(supply.closure(), scale);
        session.closing("power_w", "W", scale);
        if supply.electric() > 0.0 {
            session.closing("unpaid_w", "W", supply.owed());
            session.closing("leaves_w", "W", supply.left());
        }
        session.closing("energy_balance", "1", missing);
        let items = supply.unpaid.iter();
        let items = items.filter(|(_, watts)| part(watts.abs(), scale) > TOLD);
        for (name, watts) in items {
            session.note(format!(
                "{} of {watts:.0} W, {:.1} % of voltage times current, is paid by no voltage: {}",
                name.replace('_', " "),
                100.0 * part(*watts, scale),
                why(name)
            ));
        }
        if missing.abs() > MOST {
            let enters = match supply.electric() > 0.0 {
                true => format!("voltage times current is {scale:.1} W"),
                false => format!("{scale:.1} W are given and exchanged"),
            };
            session.warn(format!(
                "{enters} and unpaid items are {:.1} W, {:.1} W leave: {:.1} % are missing \
                 where at most {:.0} % may be",
                supply.owed(),
                supply.left(),
                100.0 * missing,
                100.0 * MOST
            ));
        }
    }
}

/// Why an item is not paid.
fn why(name: &str) -> &'static str {
    if name.starts_with("ions") {
        "ions give a thermionic cathode their whole ionisation voltage and the electron that they take from the metal costs nothing"
    } else {
        "the circuit has one electrode with a work function and none that it is measured against"
    }
}
