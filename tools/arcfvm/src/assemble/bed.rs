//! The bed of granular flux.

use props::Table;

use crate::assemble::Faults;
use crate::assemble::layout::Layout;
use crate::bed::granular::Granular;
use crate::heat::electrode::STEFAN_BOLTZMANN;
use crate::material::{GAS, Law, Melting};
use crate::scene::{self, Body, Scene};

/// Parts into which a melting range is cut where the conductivity of slag is tabulated.
const RANGE_NODES: u32 = 8;
/// Distance of its nodes above that \[K\].
const SLAG_STEP_K: f64 = 25.0;
/// Steps that suffice wherever slag boils.
const MOST_STEPS: f64 = 1000.0;

/// The granular body of the scene, if heat is solved and there is one.
pub(super) fn bed(
    scene: &Scene,
    layout: &Layout,
    bodies: &[(&String, &Body)],
    faults: &mut Faults,
) -> Option<Granular> {
    let heat = scene.heat.as_ref()?;
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
    if taken + heat.absorbed_radiation.unwrap_or(0.0) > 1.0 {
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
    if given.refractive_index.is_some() && given.absorption_length_m.is_none() {
        let what = "is for slag with absorption_length_m";
        faults.add(&format!("{at}/refractive_index"), what);
    }
    let points = [melting.point_k, given.boiling_k];
    let mut granular = Granular::new(n + 1, points, given.absorbed_radiation, cells);
    granular.length = given.absorption_length_m;
    granular.melts_within = given.refractive_index.map(|_| melting.half_range_k);
    Some(granular)
}

/// The conductivity of flux and, above its melting range, of slag: `slag_conductivity_ratio` times as great, and where slag is
/// clear what its own radiation adds to it (Rosseland 1924),
///
/// ```text
/// k_r = 16/3 n^2 sigma T^3 l
/// ```
///
/// with the refractive index n and the length of absorption l.
pub(crate) fn conductivity(law: Law, granular: &scene::Granular, melting: Option<Melting>) -> Law {
    let Some(melting) = melting else {
        return law;
    };
    let rise = granular.slag_conductivity_ratio - 1.0;
    let molten =
        move |t: f64| (0.5 * (1.0 + (t - melting.point) / melting.half_range)).clamp(0.0, 1.0);
    let clear = granular.refractive_index.zip(granular.absorption_length_m);
    let Some((index, length)) = clear else {
        return Law::formula(move |r, z, t, _| law.at(r, z, t) * (1.0 + rise * molten(t)));
    };
    let radiative = |t: f64| 16.0 / 3.0 * index.powi(2) * STEFAN_BOLTZMANN * t.powi(3) * length;
    let value =
        |t: &f64| law.at(0.0, 0.0, *t) * (1.0 + rise * molten(*t)) + molten(*t) * radiative(*t);
    // A table, whose integral over temperature is exact.
    let [low, high] = [-1.0, 1.0].map(|side| melting.point + side * melting.half_range);
    let mut nodes: Vec<f64> = (0..=RANGE_NODES)
        .map(|n| low + (high - low) * f64::from(n) / f64::from(RANGE_NODES))
        .collect();
    let above = (granular.boiling_k - high).max(0.0);
    let step = SLAG_STEP_K.max(above / MOST_STEPS);
    nodes.extend((1..=(above / step) as u32 + 1).map(|n| high + step * f64::from(n)));
    if let Law::Table(table) = &law {
        let others = table.nodes().iter().filter(|t| !(low..=high).contains(*t));
        nodes.extend(others);
    }
    nodes.sort_by(f64::total_cmp);
    nodes.dedup();
    let values: Vec<f64> = nodes.iter().map(value).collect();
    Table::new(nodes, values).map_or(law, Law::Table)
}

#[cfg(test)]
mod tests {
    use super::*;

    const MELTING: Melting = Melting {
        point: 2845.0,
        half_range: 25.0,
        latent_heat: 1e6,
    };

    fn granular(length: Option<f64>, index: Option<f64>) -> scene::Granular {
        scene::Granular {
            slag_conductivity_ratio: 3.0,
            boiling_k: 3123.0,
            absorbed_radiation: None,
            absorption_length_m: length,
            refractive_index: index,
            iron_mass_fraction: None,
        }
    }

    #[test]
    fn slag_conducts_as_many_times_as_well_as_it_is_told() {
        let law = conductivity(Law::Constant(0.5), &granular(None, None), Some(MELTING));
        for (t, want) in [(300.0, 0.5), (2820.0, 0.5), (2845.0, 1.0), (2870.0, 1.5)] {
            assert!((law.at(0.0, 0.0, t) - want).abs() < 1e-12, "{t}");
        }
    }

    #[test]
    fn clear_slag_conducts_by_its_radiation_too_and_flux_does_not() {
        let table = Table::new(vec![300.0, 2000.0, 2845.0], vec![0.1, 0.5, 0.5]).unwrap();
        let clear = granular(Some(0.004), Some(1.6));
        let law = conductivity(Law::Table(table), &clear, Some(MELTING));
        for (t, want) in [(300.0, 0.1), (1150.0, 0.3), (2820.0, 0.5)] {
            assert!((law.at(0.0, 0.0, t) - want).abs() < 1e-12, "{t}");
        }
        // 16/3 n^2 sigma T^3 l at 2900 K, by hand: 75.527 W/(m K).
        for (t, radiative) in [(2870.0, 73.208), (2900.0, 75.527)] {
            let found = law.at(0.0, 0.0, t);
            assert!((found - 1.5 - radiative).abs() < 0.01, "{t}: {found}");
        }
    }
}
