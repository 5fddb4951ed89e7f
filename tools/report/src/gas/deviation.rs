//! What another input makes of a gas: two tables of the same gas compared.

use super::Gas;

/// A column that another input changes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Change {
    /// The column.
    pub(crate) column: String,
    /// Greatest relative change, with its sign.
    pub(crate) worst: f64,
    /// Where: temperature \[K\].
    pub(crate) temperature: f64,
    /// Where: iron mole fraction.
    pub(crate) iron: f64,
}

/// A part of a column's greatest value below which its changes do not count.
const SMALL: f64 = 1e-3;
/// A change that is less than this is none.
const NONE: f64 = 1e-9;

/// The greatest relative change of each column from `base` to `other` at the temperatures of both; columns that do not
/// change are left out.
///
/// `None` where nothing could be compared: no temperature, iron fraction or column is in both.
pub(crate) fn changes(base: &Gas, other: &Gas) -> Option<Vec<Change>> {
    let columns = base.table.columns.iter();
    let compared: Vec<Change> = columns
        .filter_map(|column| change(base, other, &column.name))
        .collect();
    let changed = |change: &Change| change.worst.abs() > NONE;
    (!compared.is_empty()).then(|| compared.into_iter().filter(changed).collect())
}

/// The greatest relative change of a column, 0 where it does not change; none where nothing of it is in both.
fn change(base: &Gas, other: &Gas, name: &str) -> Option<Change> {
    let values = base.table.values(name).ok()?;
    let least = SMALL * values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let mut found = Change {
        column: name.to_owned(),
        worst: 0.0,
        temperature: 0.0,
        iron: 0.0,
    };
    let mut compared = false;
    for (x, iron) in base.iron.iter().enumerate() {
        let same = |other: &f64| (other - iron).abs() < 1e-12;
        let Some(there) = other.iron.iter().position(same) else {
            continue;
        };
        for t in &base.temperatures {
            let Some(after) = shared(other, *t).and_then(|t| other.at(name, there, t)) else {
                continue;
            };
            let before = base.at(name, x, *t)?;
            compared = true;
            let part = (after - before) / before;
            if before.abs() >= least && part.abs() > found.worst.abs() {
                (found.worst, found.temperature, found.iron) = (part, *t, *iron);
            }
        }
    }
    compared.then_some(found)
}

/// `other` over `base` against temperature, at a place of iron, where `base` is not small.
pub(crate) fn ratio(base: &Gas, other: &Gas, name: &str, iron: usize) -> Vec<[f64; 2]> {
    let row = base.row(&base.table, name, iron).unwrap_or_default();
    let least = SMALL * row.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let pairs = base
        .temperatures
        .iter()
        .zip(row)
        .filter(|(_, before)| before.abs() >= least);
    let both = pairs.filter_map(|(t, before)| {
        let after = other.at(name, iron, shared(other, *t)?)?;
        Some([*t, after / before])
    });
    both.collect()
}

/// The temperature of `other` that is `t`: between its own, interpolation would pass for a change.
fn shared(other: &Gas, t: f64) -> Option<f64> {
    other
        .temperatures
        .iter()
        .copied()
        .find(|node| (node - t).abs() < 1e-9 * t.max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gas::tests::gas;

    #[test]
    fn the_greatest_change_is_found_and_no_change_is_none() {
        let base = gas("v", &[0.0, 0.1], |t, x| 100.0 + t + x);
        let other = gas("v", &[0.0, 0.1], |t, x| {
            let factor = if x > 0.05 && t > 4500.0 && t < 5500.0 {
                0.8
            } else {
                1.0
            };
            factor * (100.0 + t + x)
        });
        let all = changes(&base, &other).unwrap();
        assert_eq!(all.len(), 1);
        assert!((all[0].worst + 0.2).abs() < 1e-12);
        assert!((all[0].temperature - 5000.0).abs() < 1e-9 && (all[0].iron - 0.1).abs() < 1e-12);
        assert!(changes(&base, &base).unwrap().is_empty());
        let elsewhere = gas("v", &[0.5], |t, x| 100.0 + t + x);
        assert_eq!(changes(&base, &elsewhere), None);
        assert_eq!(changes(&base, &gas("w", &[0.0, 0.1], |t, _| t)), None);
        let line = ratio(&base, &other, "v", 1);
        assert!(
            line.iter()
                .any(|[t, r]| (t - 5000.0).abs() < 1e-9 && (r - 0.8).abs() < 1e-12)
        );
    }
}
