//! What a reader of a run with grains must be told when it has ended.

use super::motion::Motion;

/// Share of the grains that may leave with their heat.
const FEW: f64 = 0.01;

impl Motion {
    /// Contacts that a bed has lost, light that was missed, and grains that left with their heat.
    pub(super) fn told(&self) -> Vec<String> {
        let lost = self.laid.as_ref().map(|laid| laid.lost);
        let lost = lost.filter(|lost| *lost > 0).map(|lost| {
            format!("{lost} contacts of the bed are with metal or walls that are not there: their grains begin to slip")
        });
        let missed = self.heat.as_ref().is_some_and(|heat| heat.lighting.missed).then(|| {
            "power_w of a light changes faster in time than could be followed: heat may be missed"
                .to_owned()
        });
        let [left, mass] = self.lost;
        let all = left + self.moving.grains.len() as f64;
        let gone = (self.heat.is_some() && left > FEW * all).then(|| {
            format!("{left} of {all} grains, {mass:.3e} kg, have left the bounds of the grains, and their heat with them")
        });
        lost.into_iter().chain(missed).chain(gone).collect()
    }
}
