//! How fast the wire is fed (Komen 2019, eq. 5.27).

use crate::case::FeedRule;
use crate::heat::balance::electrodes;
use crate::solver::Arc;

/// Voltage whose power melts the wire at the start \[V\]; the iteration finds the right speed.
const FEED_START_V: f64 = 6.0;

impl Arc {
    /// The speed at which the wire would be fed, if it is.
    pub(crate) fn next_feed(&self) -> Option<f64> {
        let wire = self.case.wire?;
        let rule = wire.feed?;
        let enthalpy = self.case.materials[wire.material].enthalpy.as_ref()?;
        let heating = self.heating.as_ref()?;
        let all = electrodes(&self.case, &heating.energy, &heating.sources);
        let surfaces = self.case.surfaces.as_ref();
        let own = surfaces.and_then(|s| s.electrode_of[wire.material]);
        let boiled = own.map_or(0.0, |n| -all[n].vapour);
        let surface = own.map_or(0.0, |n| all[n].sum()) + boiled;
        let joule = self.electric.as_ref().map_or(0.0, |e| {
            let cells = e.potential.joule.iter().zip(&self.case.material);
            cells
                .filter(|(_, m)| **m == wire.material)
                .map(|(j, _)| j)
                .sum()
        });
        let beside = wire.from_beside(&self.case, &heating.energy);
        let tip = wire.tip_enthalpy(&self.case, &self.properties.enthalpy);
        Some(wire.speed(rule, [surface + joule + beside, boiled], enthalpy, tip))
    }

    /// The speed before anything is known.
    pub(crate) fn first_feed(&self) -> f64 {
        let Some((wire, rule)) = self.case.wire.and_then(|w| Some((w, w.feed?))) else {
            return 0.0;
        };
        let current = self
            .case
            .potential
            .as_ref()
            .and_then(|p| p.driven)
            .unwrap_or(0.0);
        let Some(enthalpy) = &self.case.materials[wire.material].enthalpy else {
            return match rule {
                FeedRule::Speed(speed) => speed,
                FeedRule::Melting(_) | FeedRule::Boiling { .. } => 0.0,
            };
        };
        let tip = match rule {
            FeedRule::Boiling { at_most, .. } => at_most,
            FeedRule::Speed(_) | FeedRule::Melting(_) => 0.0,
        };
        let heat = FEED_START_V * current.abs();
        wire.speed(rule, [heat, 0.0], enthalpy, tip)
    }
}
