//! What a reader of a run with grains must be told when it has ended.

use super::motion::Motion;

/// Part of the least radius by which grains may overlap at the end.
const SOFT: f64 = 0.1;
/// Share of the grains that may leave with their heat.
const FEW: f64 = 0.01;

impl Motion {
    /// Contacts that a bed has lost, light that was missed, grains that left with their heat, and contacts that are too soft.
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
        let (deep, least) = (self.doing.deepest, self.setting.radii[0]);
        let soft = (deep > SOFT * least).then(|| {
            format!(
                "grains overlap by up to {deep:.3e} m, {:.0} % of the least radius: a stiffer law of contact holds them apart",
                100.0 * deep / least
            )
        });
        let told = lost.into_iter().chain(missed).chain(gone);
        told.chain(soft).collect()
    }
}
