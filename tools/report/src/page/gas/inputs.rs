//! What inputs that no measurement settles make of a gas.

use super::{Table, percent, words};
use crate::gas::deviation::{changes, ratio};
use crate::html::{Rows, escape, figure, paragraph, side_by_side};
use crate::plot::{Line, Plot};

/// The section: each variant beside the gas that it varies.
pub(super) fn section(variants: &[(&Table, Table)]) -> String {
    if variants.is_empty() {
        return String::new();
    }
    let mut out = paragraph(
        "The same gas with another value of an input. Changes are the greatest over the table, where the column is at \
         least a thousandth of its greatest value; columns that do not change are not listed.",
    );
    let mut rows = Rows::new(&[
        "Gas",
        "Variant",
        "Column",
        "#Greatest change",
        "#At [K]",
        "#x(Fe)",
    ]);
    for (base, variant) in variants {
        let Some(mut all) = changes(&base.gas, &variant.gas) else {
            let told = "not comparable: no temperature and iron fraction is in both".to_owned();
            rows.row([escape(&base.name), escape(&variant.name), told]);
            continue;
        };
        all.sort_by(|a, b| b.worst.abs().total_cmp(&a.worst.abs()));
        for change in &all {
            rows.row([
                escape(&base.name),
                escape(&variant.name),
                escape(&words(&change.column)),
                percent(change.worst),
                format!("{:.0}", change.temperature),
                change.iron.to_string(),
            ]);
        }
        if all.is_empty() {
            rows.row([escape(&base.name), escape(&variant.name), "none".to_owned()]);
        }
    }
    out += &rows.render();
    out + &side_by_side(
        &variants
            .iter()
            .filter_map(|(base, variant)| plot(base, variant))
            .collect::<Vec<_>>(),
    )
}

/// The column that changes most, over that of the gas it varies.
fn plot(base: &Table, variant: &Table) -> Option<String> {
    let all = changes(&base.gas, &variant.gas)?;
    let most = all
        .iter()
        .max_by(|a, b| a.worst.abs().total_cmp(&b.worst.abs()))?;
    let title = format!("{}, variant / {}", words(&most.column), base.name);
    let mut plot = Plot::new("temperature [K]", &title).through(1.0);
    for x in base.gas.drawn() {
        plot.add(Line::new(
            &base.gas.called(x),
            ratio(&base.gas, &variant.gas, &most.column, x),
        ));
    }
    let caption = format!(
        "{} of {} with {}.",
        words(&most.column),
        base.name,
        variant.name
    );
    Some(figure(&plot.html(), &caption))
}
