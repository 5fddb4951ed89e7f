//! The comparison with published values.

use crate::html::{Rows, escape, paragraph, verdict};
use crate::targets::{Row, Verdict};

/// The section.
pub(super) fn section(rows: &[Row]) -> String {
    let mut table = Rows::new(&[
        "Measure",
        "#Published",
        "From",
        "#This study",
        "#Difference",
        "Tolerance",
        "Verdict",
    ]);
    for row in rows {
        table.row(cells(row));
    }
    paragraph(&(summary(rows) + &hanging(rows))) + &table.render()
}

fn cells(row: &Row) -> [String; 7] {
    let unit = row.unit();
    let found = row.measured.map_or_else(
        || "\u{2013}".to_owned(),
        |m| format!("{} {unit}", row.shown(m)),
    );
    let band = row.band.map_or_else(String::new, |half| {
        format!(" \u{b1} {} {unit}", row.fine(half))
    });
    let range = row.range.map_or_else(String::new, |[low, high]| {
        let span = format!("{} to {} along the weld", row.shown(low), row.shown(high));
        format!("<br><small>{span}</small>")
    });
    let (words, holds) = row.words();
    let kind = row.target.kind.word();
    [
        escape(&row.target.title),
        format!("{} {unit}", row.shown(row.target.value)),
        format!("{kind}<br><small>{}</small>", escape(&row.target.source)),
        found + &band + &range,
        row.difference(),
        row.tolerance(),
        verdict(&words, holds),
    ]
}

/// How many verdicts hang on the numerical error.
fn hanging(rows: &[Row]) -> String {
    match rows.iter().filter(|row| row.is_open()).count() {
        0 => String::new(),
        1 => " Of one the numerical band reaches over the edge of its tolerance.".to_owned(),
        n => format!(" Of {n} the numerical band reaches over the edge of its tolerance."),
    }
}

fn summary(rows: &[Row]) -> String {
    let count = |verdict: Verdict| rows.iter().filter(|r| r.verdict == verdict).count();
    let (held, missed, early) = (
        count(Verdict::Holds),
        count(Verdict::Missed),
        count(Verdict::NotYet),
    );
    let unknown = |r: &&Row| r.verdict == Verdict::Unknown && r.target.tolerance.is_some();
    let unknown = rows.iter().filter(unknown).count();
    let mut text = match (held, missed) {
        (0, 0) if early > 0 => "The published bead is finished and cold; nothing of this weld has frozen beyond its run-in. Its \
                values so far stand beside the published ones, and nothing is judged."
            .to_owned(),
        (0, 0) => {
            "Nothing here is judged; the values stand beside each other for comparison.".to_owned()
        }
        (_, 0) => format!(
            "All {held} measures that are judged agree with the published ones within their tolerance."
        ),
        (0, _) => format!(
            "None of the {missed} measures that are judged agrees with the published one within its tolerance."
        ),
        _ => format!(
            "Of {} measures that are judged, {held} agree with the published ones within their tolerance \
             and {missed} do not.",
            held + missed
        ),
    };
    if early > 0 && held + missed > 0 {
        text += &format!(
            " {early} of the bead are not judged: nothing of this weld has frozen beyond its run-in."
        );
    }
    if unknown > 0 {
        text += &format!(" {unknown} with a tolerance could not be measured.");
    }
    text
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn row(verdict: Verdict) -> Row {
        let told = json!({"measure": "a", "title": "a", "value": 1.0, "unit": "1", "source": "a", "kind": "experiment",
            "tolerance": 0.1});
        Row {
            target: serde_json::from_value(told).unwrap(),
            measured: None,
            range: None,
            verdict,
            band: None,
        }
    }

    #[test]
    fn every_kind_of_verdict_is_counted() {
        let of = |all: &[Verdict]| summary(&all.iter().map(|v| row(*v)).collect::<Vec<_>>());
        use Verdict::{Holds, NotYet, Unknown};
        let told = of(&[Holds, Holds, NotYet, Unknown]);
        assert!(told.starts_with("All 2 measures"), "{told}");
        assert!(
            told.contains("1 of the bead are not judged")
                && told.contains("1 with a tolerance could not")
        );
        assert!(of(&[NotYet]).ends_with("nothing is judged."));
        assert!(!of(&[Holds]).contains("not be measured"));
    }
}
