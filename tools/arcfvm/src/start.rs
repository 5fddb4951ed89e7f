//! A start from another solution, on whatever grid that stands.
//!
//! Every value is interpolated linearly between the four cell centres around its place. Of these,
//! temperatures and potentials take only those of the same kind of body, where there are any: the
//! surface of an electrode stays sharp.

use artefact::{Reader, Table};
use run::Failure;

use crate::frames::role;
use crate::solver::Arc;

/// The fields of another solution.
struct Other {
    table: Table,
    radius: Vec<f64>,
    height: Vec<f64>,
}

/// A cell centre of the other grid and its weight.
type Node = (usize, f64);

/// The interval of `at` around `x` and where in it, held beyond the ends.
fn between(at: &[f64], x: f64) -> (usize, f64) {
    let last = at.len().saturating_sub(2);
    let k = at.partition_point(|a| *a <= x).saturating_sub(1).min(last);
    let Some(next) = at.get(k + 1) else {
        return (0, 0.0);
    };
    (k, ((x - at[k]) / (next - at[k])).clamp(0.0, 1.0))
}

impl Other {
    fn read(path: &std::path::Path) -> Result<Self, Failure> {
        let table = Reader::open_kind(path, "arc-source", 1)?.table("/plasma")?;
        let radius = table.axis("radius_m")?.to_vec();
        let height = table.axis("height_m")?.to_vec();
        Ok(Self {
            table,
            radius,
            height,
        })
    }

    /// The four centres around a place; heights run fastest.
    fn around(&self, r: f64, z: f64) -> [Node; 4] {
        let (i, u) = between(&self.radius, r);
        let (j, v) = between(&self.height, z);
        let (n, m) = (self.height.len(), self.radius.len());
        let at = |i: usize, j: usize| i.min(m - 1) * n + j.min(n - 1);
        [
            (at(i, j), (1.0 - u) * (1.0 - v)),
            (at(i + 1, j), u * (1.0 - v)),
            (at(i, j + 1), (1.0 - u) * v),
            (at(i + 1, j + 1), u * v),
        ]
    }

    fn column(&self, name: &str) -> Option<&[f64]> {
        self.table.values(name).ok()
    }

    fn value(&self, column: &[f64], r: f64, z: f64) -> f64 {
        self.around(r, z).iter().map(|(k, w)| w * column[*k]).sum()
    }

    /// As [`Self::value`], from cells of the kind `own` alone where there are any.
    fn value_within(&self, column: &[f64], (r, z): (f64, f64), own: f64) -> f64 {
        let nodes = self.around(r, z);
        let Some(kinds) = self.column("material") else {
            return self.value(column, r, z);
        };
        let same = |node: &&Node| (kinds[node.0] - own).abs() < 0.5;
        let weight: f64 = nodes.iter().filter(same).map(|n| n.1).sum();
        if weight > 1e-9 {
            let sum: f64 = nodes.iter().filter(same).map(|(k, w)| w * column[*k]).sum();
            return sum / weight;
        }
        let nearest = nodes.iter().find(|n| same(n));
        nearest.map_or_else(|| self.value(column, r, z), |(k, _)| column[*k])
    }
}

/// Takes temperature, flow, potential, iron vapour and the speed of the wire from the artefact at `path`; what it
/// does not hold stays as it is.
///
/// # Errors
/// When the file is no `arc-source` or has no fields.
pub fn take(arc: &mut Arc, path: &std::path::Path) -> Result<(), Failure> {
    let other = Other::read(path)?;
    let record = Reader::open_kind(path, "arc-source", 1)?.record("/balance")?;
    let kinds: Vec<f64> = (0..arc.case.grid.len())
        .map(|k| role(arc, arc.case.material[k] as f64))
        .collect();
    let grid = &arc.case.grid;
    let centre = |k: usize| (grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
    if let Some(column) = other.column("temperature_k") {
        let start = &mut arc.case.start;
        for (k, t) in start.iter_mut().enumerate() {
            *t = other.value_within(column, centre(k), kinds[k]);
        }
        if let Some(heating) = &mut arc.heating {
            heating.energy.temperature.clone_from(start);
        }
    }
    if let (Some(vaporising), Some(column)) =
        (&mut arc.vaporising, other.column("iron_mass_fraction"))
    {
        for (k, y) in vaporising.vapour.iron.iter_mut().enumerate() {
            *y = other.value_within(column, centre(k), kinds[k]);
        }
    }
    if let (Some(electric), Some(column)) = (&mut arc.electric, other.column("potential_v")) {
        for (k, v) in electric.potential.value.iter_mut().enumerate() {
            *v = other.value_within(column, centre(k), kinds[k]);
        }
        if let Ok(drive) = record.get("voltage_column_v") {
            electric.potential.drive = drive;
        }
    }
    let flow = ["radial_velocity_m_s", "axial_velocity_m_s", "pressure_pa"];
    if let [Some(u), Some(w), Some(p)] = flow.map(|name| other.column(name)) {
        arc.take_flow(&|which, r, z| other.value([u, w, p][which], r, z));
    }
    if arc.feed > 0.0 {
        arc.feed = record.get("wire_feed_m_s").unwrap_or(arc.feed);
    }
    Ok(())
}

impl Arc {
    /// Takes velocities and pressure from a function of which (radial, axial, pressure) and place.
    fn take_flow(&mut self, value: &dyn Fn(usize, f64, f64) -> f64) {
        self.take_properties();
        if let Some(flowing) = &mut self.flowing {
            let density = &self.properties.density;
            flowing.flow.take(&self.case.grid, density, value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bilinear_field_is_met_and_held_beyond_the_ends() {
        let (radius, height) = (vec![0.5, 1.5, 2.5], vec![1.0, 3.0]);
        let field = |r: f64, z: f64| 2.0 + 3.0 * r - z + 0.5 * r * z;
        let values = radius
            .iter()
            .flat_map(|r| height.iter().map(move |z| field(*r, *z)));
        let values: Vec<f64> = values.collect();
        let axes = [
            ("radius_m", "m", radius.as_slice()),
            ("height_m", "m", &height),
        ];
        let kinds = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0];
        let table = Table::grid(&axes).column("material", "1", kinds);
        let other = Other {
            table,
            radius: radius.clone(),
            height: height.clone(),
        };
        for (r, z) in [(0.7, 1.1), (2.0, 2.9), (1.5, 1.0)] {
            assert!((other.value(&values, r, z) - field(r, z)).abs() < 1e-12);
        }
        assert!((other.value(&values, 9.0, 9.0) - field(2.5, 3.0)).abs() < 1e-12);
        // Only the lower cells at 1.5 and 2.5 are of kind 1.
        let found = other.value_within(&values, (2.0, 2.5), 1.0);
        assert!((found - field(2.0, 1.0)).abs() < 1e-12);
    }
}
