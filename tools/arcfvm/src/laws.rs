//! Formulas of properties at the solution: none may be below 0 or no number there.
//!
//! Numbers and tables of a scene are judged before a run. What a formula gives is known where the temperatures are.

use crate::error::Error;
use crate::material::{GAS, Law, Material};
use crate::solver::Arc;

/// Part of the greatest value by which a formula may miss 0: rounding of the temperatures.
const ROUNDING: f64 = 1e-6;

impl Arc {
    /// Every formula in every cell of its material.
    ///
    /// # Errors
    /// [`Error::Unlawful`] at the worst cell.
    pub(crate) fn lawful(&self) -> Result<(), Error> {
        for (index, material) in self.case.materials.iter().enumerate() {
            for (name, law) in formulas(material) {
                self.is_positive(index, name, law)?;
            }
        }
        Ok(())
    }

    fn is_positive(&self, material: usize, name: &str, law: &Law) -> Result<(), Error> {
        let (grid, t) = (&self.case.grid, self.temperature());
        let value = |k: usize| {
            let (r, z) = (grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
            law.within(r, z, t[k], self.properties.iron_at(k))
        };
        let cells = (0..grid.len()).filter(|k| self.case.material[*k] == material);
        let cells: Vec<(usize, f64)> = cells.map(|k| (k, value(k))).collect();
        let finite = cells.iter().filter(|(_, value)| value.is_finite());
        let most = finite.fold(0.0, |most: f64, (_, value)| most.max(value.abs()));
        let wrong = |value: f64| !value.is_finite() || value < -ROUNDING * most;
        // No number is worse than any below 0.
        let rank = |value: f64| {
            if value.is_finite() {
                value
            } else {
                f64::NEG_INFINITY
            }
        };
        let found = cells.iter().filter(|(_, value)| wrong(*value));
        let worst = found.min_by(|a, b| rank(a.1).total_cmp(&rank(b.1)));
        worst.map_or(Ok(()), |(k, value)| {
            let property = match material {
                GAS => format!("/gas/given/{name}"),
                _ => format!("/bodies/{}/material/{name}", self.case.of(*k).name),
            };
            Err(Error::Unlawful {
                place: self.case.place(*k),
                temperature: t[*k],
                property,
                value: *value,
            })
        })
    }
}

/// The properties of a material that are formulas, by name.
fn formulas(of: &Material) -> impl Iterator<Item = (&'static str, &Law)> {
    let all = [
        ("density_kg_m3", &of.density),
        ("viscosity_pa_s", &of.viscosity),
        ("thermal_conductivity_w_m_k", &of.thermal_conductivity),
        ("electric_conductivity_s_m", &of.electric_conductivity),
        ("net_emission_w_m3", &of.net_emission),
        ("iron_diffusion_m2_s", &of.iron_diffusion),
    ];
    let laws = all.into_iter();
    let laws = laws.filter_map(|(name, law)| Some((name, law.as_ref()?)));
    laws.filter(|(_, law)| matches!(law, Law::Formula(_)))
}
