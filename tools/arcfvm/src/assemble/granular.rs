//! The bed of granular flux.

use crate::assemble::Faults;
use crate::assemble::layout::Layout;
use crate::heat::granular::Granular;
use crate::material::{GAS, Law, Melting};
use crate::scene::{self, Body, Scene};

/// The granular body of the scene, if heat is solved and there is one.
pub(crate) fn granular(
    scene: &Scene,
    layout: &Layout,
    bodies: &[(&String, &Body)],
    faults: &mut Faults,
) -> Option<Granular> {
    let mut all = bodies.iter().enumerate();
    let (n, (name, body)) = all.find(|(_, (_, b))| b.granular.is_some())?;
    if let Some((_, (second, _))) = all.find(|(_, (_, b))| b.granular.is_some()) {
        let what = "a second granular body; only one can boil into the cavity";
        faults.add(&format!("/bodies/{second}/granular"), what);
    }
    let at = format!("/bodies/{name}/granular");
    let given = body.granular.as_ref()?;
    if body.anode.is_some() || body.cathode.is_some() || body.electrode.is_some() {
        faults.add(&at, "a granular body is no electrode");
    }
    let Some(melting) = &body.material.melting else {
        faults.add(&at, "a granular body wants material/melting");
        return None;
    };
    if given.boiling_k <= melting.point_k {
        let what = format!(
            "{} K is not above the melting point, {} K",
            given.boiling_k, melting.point_k
        );
        faults.add(&format!("{at}/boiling_k"), what);
    }
    let taken = given.absorbed_radiation.unwrap_or(0.0);
    let base = scene.heat.as_ref().and_then(|h| h.absorbed_radiation);
    if taken + base.unwrap_or(0.0) > 1.0 {
        let what = format!("{taken} and the base metal's part are more than all radiation");
        faults.add(&format!("{at}/absorbed_radiation"), what);
    }
    if given.iron_mass_fraction.is_some() && scene.vapour.is_none() {
        faults.add(
            &format!("{at}/iron_mass_fraction"),
            "is for a scene with vapour",
        );
    }
    let cells = (0..layout.grid.len()).filter(|k| layout.material[*k] == n + 1);
    let cells: Vec<usize> = cells.collect();
    if layout.material.iter().all(|m| *m != GAS) {
        faults.add(&at, "there is no gas that the cavity could begin with");
    }
    if given.absorption_length_m.is_some() && given.absorbed_radiation.is_none() {
        let what = "is for flux with absorbed_radiation";
        faults.add(&format!("{at}/absorption_length_m"), what);
    }
    let points = [melting.point_k, given.boiling_k];
    let mut granular = Granular::new(n + 1, points, given.absorbed_radiation, cells);
    granular.length = given.absorption_length_m;
    Some(granular)
}

/// The conductivity of flux and, above its melting range, of slag.
pub(crate) fn conductivity(law: Law, granular: &scene::Granular, melting: Option<Melting>) -> Law {
    let Some(melting) = melting else {
        return law;
    };
    let rise = granular.slag_conductivity_ratio - 1.0;
    Law::formula(move |r, z, t, _| {
        let molten = 0.5 * (1.0 + (t - melting.point) / melting.half_range);
        law.at(r, z, t) * (1.0 + rise * molten.clamp(0.0, 1.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slag_conducts_as_many_times_as_well_as_it_is_told() {
        let granular = scene::Granular {
            slag_conductivity_ratio: 3.0,
            boiling_k: 3123.0,
            absorbed_radiation: None,
            absorption_length_m: None,
            iron_mass_fraction: None,
        };
        let melting = Melting {
            point: 2845.0,
            half_range: 25.0,
            latent_heat: 1e6,
        };
        let law = conductivity(Law::Constant(0.5), &granular, Some(melting));
        for (t, want) in [(300.0, 0.5), (2820.0, 0.5), (2845.0, 1.0), (2870.0, 1.5)] {
            assert!((law.at(0.0, 0.0, t) - want).abs() < 1e-12, "{t}");
        }
    }
}
