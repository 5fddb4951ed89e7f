//! The supply of an arc: its voltage, its power, and whether all that leaves is paid for.

use run::Session;

use crate::heat::balance::Balance;
use crate::heat::supply::Supply;
use crate::residual::part;
use crate::solver::Arc;

/// Part of the power by which all that leaves may differ from it, unpaid items counted.
const MOST: f64 = 0.02;
/// Part of the power from which on an unpaid item is told.
const TOLD: f64 = 1e-3;

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

    /// Power for scale \[W\]: that of the supply, or all that is given and exchanged.
    #[must_use]
    pub fn power(&self, balance: &Balance) -> f64 {
        let electric = self.supply(balance).electric();
        if electric > 0.0 {
            electric
        } else {
            balance.given.abs() + balance.edges.abs() + balance.flow.abs()
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
            session.warn(format!(
                "voltage times current is {scale:.1} W and unpaid items are {:.1} W, {:.1} W leave: {:.1} % are missing \
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
