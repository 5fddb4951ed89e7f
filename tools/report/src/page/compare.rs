//! The comparison with published values.

use crate::html::{Rows, escape, paragraph, verdict};
use crate::targets::{Row, Targets, Verdict, compare};
use crate::weld::Stretch;

/// The section.
pub(super) fn section(targets: &Targets, stretch: Option<&Stretch>) -> String {
    let rows = compare(targets, stretch);
    let mut table = Rows::new(&[
        "Measure",
        "Source",
        "Kind",
        "#Published",
        "#This study",
        "#Along the weld",
        "#Difference",
        "Tolerance",
        "Verdict",
    ]);
    for row in &rows {
        table.row(cells(row));
    }
    paragraph(&summary(&rows)) + &table.render()
}

fn cells(row: &Row) -> [String; 9] {
    let unit = row.unit();
    let range = row.range.map_or_else(
        || "\u{2013}".to_owned(),
        |[low, high]| {
            format!(
                "{}\u{2009}\u{2013}\u{2009}{}",
                row.shown(low),
                row.shown(high)
            )
        },
    );
    let found = row.measured.map_or_else(
        || "\u{2013}".to_owned(),
        |m| format!("{} {unit}", row.shown(m)),
    );
    let (words, holds) = row.words();
    [
        escape(&row.target.title),
        escape(&row.target.source),
        row.target.kind.word().to_owned(),
        format!("{} {unit}", row.shown(row.target.value)),
        found,
        range,
        row.difference(),
        row.tolerance(),
        verdict(&words, holds),
    ]
}

fn summary(rows: &[Row]) -> String {
    let count = |verdict: Verdict| rows.iter().filter(|r| r.verdict == verdict).count();
    let (held, missed, early) = (
        count(Verdict::Holds),
        count(Verdict::Missed),
        count(Verdict::NotYet),
    );
    if early > 0 {
        return "The published bead is finished and cold; this weld is still liquid all along. Its values \
                so far stand beside the published ones, and nothing is judged."
            .to_owned();
    }
    match (held, missed) {
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
    }
}
