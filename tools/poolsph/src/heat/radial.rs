//! Columns of the arc input.

use props::Table;

/// A column of the arc input over the distance from its axis, each value through `map`.
pub(super) fn column(
    surface: &artefact::Table,
    name: &str,
    map: impl Fn(f64) -> f64,
) -> Result<Table, String> {
    let radius = surface.values("radius_m");
    let columns = radius.and_then(|r| Ok((r, surface.values(name)?)));
    let (r, values) = columns.map_err(|fault| format!("arc input: {fault}"))?;
    let values = values.iter().copied().map(map).collect();
    Table::new(r.to_vec(), values).map_err(|fault| format!("arc input: {name}: {fault}"))
}
