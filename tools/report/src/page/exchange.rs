//! What the arc gives to the metal, told twice: by the balance of the arc, and by that of the pool.
//!
//! The arc is computed over a surface at rest whose temperature its scene gives. The pool has its own surface and its
//! own temperatures, and computes again what depends on them. Item by item the two stand beside each other: watts
//! of the arc, and joules of the pool over the time in which there was an arc.

use artefact::{Reader, Record};
use run::Failure;

use crate::html::{Rows, escape};
use crate::mirror::Mirror;
use crate::records::figure as digits;

/// An item: words, name in the balance of the arc, names in that of the pool with their sign as heat of the metal, and
/// why the two differ.
struct Item {
    words: &'static str,
    arc: &'static str,
    pool: &'static [(&'static str, f64)],
    why: &'static str,
}

const ITEMS: [Item; 7] = [
    Item {
        words: "conduction and convection of the gas",
        arc: "base_convection_w",
        pool: &[("energy_in_arc_convection_j", 1.0)],
        why: "the gas meets the temperature of its surface: that of the arc's scene, or that of the pool",
    },
    Item {
        words: "radiation of the arc",
        arc: "base_radiation_w",
        pool: &[("energy_in_arc_radiation_j", 1.0)],
        why: "the same curve over the radius: the difference is what falls beside the metal",
    },
    Item {
        words: "electrons",
        arc: "base_electron_w",
        pool: &[("energy_in_arc_electron_j", 1.0)],
        why: "hot metal emits more of them: by the temperature of the surface",
    },
    Item {
        words: "ions",
        arc: "base_ion_w",
        pool: &[("energy_in_arc_ion_j", 1.0)],
        why: "they carry the current that electrons do not: by the temperature of the surface",
    },
    Item {
        words: "drops",
        arc: "base_drops_w",
        pool: &[("energy_in_droplets_j", 1.0)],
        why: "the arc tells what melts off its wire, the pool takes the feed and the temperature of its scene, \
              and counts from the temperature at which it started",
    },
    Item {
        words: "radiation of the metal",
        arc: "base_emission_w",
        pool: &[("energy_out_radiation_j", -1.0)],
        why: "by the temperature of the surface, to the fourth power",
    },
    Item {
        words: "evaporation",
        arc: "base_vapour_w",
        pool: &[
            ("energy_in_arc_vapour_j", 1.0),
            ("energy_out_vapour_j", -1.0),
        ],
        why: "by the temperature of the surface, steeply: a surface of the arc's scene that is hotter than the pool boils \
              where the pool does not",
    },
];

/// The table; nothing where arc or pool tell no balance, or the pool was heated by no arc of a file.
pub(super) fn section(arc: &Reader, pool: &Reader) -> Result<String, Failure> {
    if !arc.has("/balance") || !pool.has("/balance") {
        return Ok(String::new());
    }
    let records = pool.records("/balance")?;
    let Some((seconds, last)) = records.last() else {
        return Ok(String::new());
    };
    // Half a weld takes half of the arc's heat.
    let seconds = seconds / Mirror::times(pool)?;
    Ok(table(&arc.record("/balance")?, last, seconds))
}

fn table(arc: &Record, pool: &Record, seconds: f64) -> String {
    let heated = pool
        .values
        .iter()
        .any(|e| e.name.starts_with("energy_in_arc_") && e.name != "energy_in_arc_j");
    if !heated || seconds <= 0.0 {
        return String::new();
    }
    let mut rows = Rows::new(&[
        "Heat to the metal",
        "#in the arc [W]",
        "#in the pool, mean over its time [W]",
        "Why they differ",
    ]);
    let mut totals = [0.0; 2];
    for item in &ITEMS {
        let given = arc.get(item.arc).ok();
        let taken = taken(pool, item.pool).map(|joule| joule / seconds);
        if given.is_none() && taken.is_none() {
            continue;
        }
        for (total, part) in totals.iter_mut().zip([given, taken]) {
            *total += part.unwrap_or(0.0);
        }
        let [given, taken] = [given, taken].map(|w| w.map_or("not counted".to_owned(), digits));
        rows.row([escape(item.words), given, taken, escape(item.why)]);
    }
    let [given, taken] = totals.map(digits);
    rows.row([escape("sum"), given, taken, String::new()]);
    format!(
        "<h3>{}</h3>\n{}",
        escape("The heat of the arc, beside what the pool took"),
        rows.render()
    )
}

/// Heat of the metal by some entries of the pool's balance \[J\]; nothing where it has none of them.
fn taken(pool: &Record, names: &[(&str, f64)]) -> Option<f64> {
    let each = names
        .iter()
        .filter_map(|(name, sign)| Some(sign * pool.get(name).ok()?));
    each.reduce(|a, b| a + b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pool() -> Record {
        Record::new().with("energy_in_arc_ion_j", "J", 8000.0).with(
            "energy_out_vapour_j",
            "J",
            572.0,
        )
    }

    #[test]
    fn each_item_stands_beside_its_own_and_sums_are_told() {
        let arc = Record::new()
            .with("base_ion_w", "W", 4321.0)
            .with("base_vapour_w", "W", -3094.0)
            .with("base_drops_w", "W", 1991.0);
        let html = table(&arc, &pool(), 2.0);
        for told in [
            "4321",
            "4000",
            "-3094",
            "-286",
            "not counted",
            "3218",
            "3714",
        ] {
            let found = html.replace('\u{2009}', "").replace('\u{2212}', "-");
            assert!(found.contains(told), "{told} in {found}");
        }
        assert!(!html.contains(">electrons<"));
    }

    #[test]
    fn a_pool_that_no_arc_of_a_file_heats_has_no_such_table() {
        let formula = Record::new().with("energy_in_arc_j", "J", 1.0);
        assert!(table(&Record::new(), &formula, 1.0).is_empty());
        let none = Record::new().with("energy_in_held_j", "J", 1.0);
        assert!(table(&Record::new(), &none, 1.0).is_empty());
        assert!(table(&Record::new(), &pool(), 0.0).is_empty());
    }
}
