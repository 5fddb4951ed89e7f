//! Every number that a run tells of itself.

use artefact::RECORD;
use run::Failure;

use super::Member;
use crate::figures;
use crate::html::{Rows, escape};
use crate::page::balance::bare;
use crate::records::figure as digits;

/// Of the bead of a weld, in place of a channel.
pub(in crate::page) const BEAD: &str = "bead";
/// Of the totals at the end, in place of a channel.
const TOTALS: &str = "totals";
/// Of the run itself, in place of a channel.
const RUN: &str = "run";

/// A number with its place.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::page) struct Number {
    pub(in crate::page) stage: String,
    pub(in crate::page) channel: String,
    pub(in crate::page) name: String,
    pub(in crate::page) unit: String,
    pub(in crate::page) value: f64,
}

impl Number {
    /// Whether it is the same quantity of another run, in the same unit.
    fn is(&self, other: &Self) -> bool {
        (&self.stage, &self.channel) == (&other.stage, &other.channel)
            && (&self.name, &self.unit) == (&other.name, &other.unit)
    }

    /// What it is, in words, without its unit.
    pub(in crate::page) fn words(&self) -> String {
        bare(&self.name, &self.unit).replace('_', " ")
    }

    /// Where it comes from: `arc balance`.
    pub(in crate::page) fn origin(&self) -> String {
        format!("{} {}", self.stage, self.channel.trim_start_matches('/'))
    }
}

/// All numbers of a run: the last record of each channel, the bead, the totals, what the run took.
///
/// # Errors
/// When a record cannot be read.
pub(in crate::page) fn of(member: &Member) -> Result<Vec<Number>, Failure> {
    let mut all = Vec::new();
    for stage in &member.stages {
        let mut take = |channel: &str, name: &str, unit: &str, value: f64| {
            all.push(Number {
                stage: stage.name.clone(),
                channel: channel.to_owned(),
                name: name.to_owned(),
                unit: unit.to_owned(),
                value,
            });
        };
        for measured in figures::of(&stage.reader, stage.stretch.as_ref())? {
            take(BEAD, measured.name, measured.unit, measured.value);
        }
        for channel in stage.reader.channels() {
            if channel.schema == RECORD && channel.messages > 0 {
                let last = stage
                    .reader
                    .record_at(&channel.name, channel.messages - 1)?;
                for entry in &last.values {
                    take(&channel.name, &entry.name, &entry.unit, entry.value);
                }
            }
        }
        if let Some(record) = &stage.record {
            for total in &record.closing {
                take(TOTALS, &total.name, &total.unit, total.value);
            }
            take(RUN, "steps", "1", record.steps as f64);
            take(RUN, "wall_time", "s", record.wall_s);
        }
    }
    Ok(all)
}

/// What any of the runs tells, each quantity once with its value of each run.
pub(in crate::page) fn beside(all: &[Vec<Number>]) -> Vec<(Number, Vec<Option<f64>>)> {
    let mut quantities: Vec<Number> = Vec::new();
    for number in all.iter().flatten() {
        if !quantities.iter().any(|known| known.is(number)) {
            quantities.push(number.clone());
        }
    }
    let row = |quantity: Number| {
        let own = |run: &Vec<Number>| run.iter().find(|n| n.is(&quantity)).map(|n| n.value);
        let values = all.iter().map(own).collect();
        (quantity, values)
    };
    quantities.into_iter().map(row).collect()
}

/// The table: a quantity to a row, a run to a column.
pub(in crate::page) fn table(names: &[&str], all: &[Vec<Number>]) -> String {
    let mut head = vec!["Of".to_owned(), "Quantity".to_owned()];
    head.extend(names.iter().map(|name| format!("#{name}")));
    head.push("Unit".to_owned());
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let mut table = Rows::new(&head);
    for (quantity, values) in beside(all) {
        let mut row = vec![escape(&quantity.origin()), escape(&quantity.words())];
        row.extend(values.iter().map(|v| shown(*v)));
        row.push(escape(unit(&quantity.unit)));
        table.row(row);
    }
    table.render()
}

/// A value, or a dash.
pub(in crate::page) fn shown(value: Option<f64>) -> String {
    value.map_or_else(|| "\u{2013}".to_owned(), digits)
}

/// A unit for people.
pub(in crate::page) fn unit(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_in_two_units_do_not_stand_beside_each_other() {
        let number = |unit: &str, value: f64| Number {
            stage: "block".to_owned(),
            channel: "/balance".to_owned(),
            name: "power".to_owned(),
            unit: unit.to_owned(),
            value,
        };
        let rows = beside(&[vec![number("W", 3.0)], vec![number("W/m", 4.0)]]);
        assert_eq!(rows.len(), 2);
        assert_eq!(
            (&rows[0].1, &rows[1].1),
            (&vec![Some(3.0), None], &vec![None, Some(4.0)])
        );
        let rows = beside(&[vec![number("W", 3.0)], vec![number("W", 4.0)]]);
        assert_eq!(rows[0].1, [Some(3.0), Some(4.0)]);
    }
}
