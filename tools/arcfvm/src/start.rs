//! A start from another solution, on whatever grid that stands.
//!
//! Every value is interpolated linearly between the four cell centres around its place. Of these,
//! temperatures and potentials take only those of the same kind of body, where there are any: the
//! surface of an electrode stays sharp. Flux has boiled where it had in the file: the nearest cell there tells.
//!
//! The file has velocities in the middle of cells, each the mean of those at its faces. On the grid of
//! the file, with the same bodies, the velocities at the faces follow from them one after another,
//! from a wall or an inlet on: a solution is taken as it was, and holds.

use artefact::{Reader, Table};
use run::Failure;

use crate::case::Face;
use crate::flow::field::{Carried, Flow};
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

    /// Whether it has the grid and the bodies of `arc`.
    fn stands_on(&self, arc: &Arc) -> bool {
        let grid = &arc.case.grid;
        let near = |a: &[f64], b: &[f64]| {
            let slack = 1e-9 * (b[b.len() - 1] - b[0]);
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < slack)
        };
        let material = |i, j| arc.case.material[grid.cell(i, j)] as f64;
        let bodies = arc.case.grid.by_height(|i, j| role(arc, material(i, j)));
        let same = |kinds: &[f64]| kinds.iter().zip(&bodies).all(|(a, b)| (a - b).abs() < 0.5);
        near(&self.radius, &grid.rc)
            && near(&self.height, &grid.zc)
            && self.column("material").is_some_and(same)
    }

    fn column(&self, name: &str) -> Option<&[f64]> {
        self.table.values(name).ok()
    }

    fn value(&self, column: &[f64], r: f64, z: f64) -> f64 {
        self.around(r, z).iter().map(|(k, w)| w * column[*k]).sum()
    }

    /// As [`Self::value`], from cells of the kind `own` alone where there are any.
    fn value_within(&self, column: &[f64], place: [f64; 2], own: f64) -> f64 {
        let [r, z] = place;
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
/// does not hold stays as it is. Says so where the grid or the bodies are others than those of the file.
///
/// # Errors
/// When the file is no `arc-source` or has no fields.
pub fn take(arc: &mut Arc, path: &std::path::Path) -> Result<Option<String>, Failure> {
    let other = Other::read(path)?;
    let record = Reader::open_kind(path, "arc-source", 1)?.record("/balance")?;
    take_bed(arc, &other);
    let kinds: Vec<f64> = (0..arc.case.grid.len())
        .map(|k| role(arc, arc.case.material[k] as f64))
        .collect();
    let grid = &arc.case.grid;
    let centre = |k: usize| [grid.rc[k % grid.nr], grid.zc[k / grid.nr]];
    if let Some(column) = other.column("temperature_k") {
        let start = &mut arc.case.start;
        for (k, t) in start.iter_mut().enumerate() {
            *t = other.value_within(column, centre(k), kinds[k]);
        }
        if let Some(heating) = &mut arc.heating {
            heating.energy.temperature.clone_from(start);
        }
    }
    if let (Some(vapour), Some(column)) = (&mut arc.vapour, other.column("iron_mass_fraction")) {
        for (k, y) in vapour.iron.iter_mut().enumerate() {
            *y = other.value_within(column, centre(k), kinds[k]);
        }
    }
    if let (Some(electric), Some(column)) = (&mut arc.electric, other.column("potential_v")) {
        for (k, v) in electric.potential.value.iter_mut().enumerate() {
            *v = other.value_within(column, centre(k), kinds[k]);
        }
        let driven = arc.case.potential.as_ref().and_then(|p| p.driven);
        if let (Ok(drive), Some(current)) = (record.get("voltage_column_v"), driven) {
            electric.potential.drive = drive.copysign(current);
        }
    }
    let flow = ["radial_velocity_m_s", "axial_velocity_m_s", "pressure_pa"];
    let same = other.stands_on(arc);
    if let [Some(u), Some(w), Some(p)] = flow.map(|name| other.column(name)) {
        let centres = same.then_some([u, w]);
        arc.take_flow(&|which, r, z| other.value([u, w, p][which], r, z), centres);
    }
    // The first flow already wants the mass of the vapour.
    arc.settle_vapour();
    arc.blow();
    if arc.feed > 0.0 {
        arc.feed = record.get("wire_feed_m_s").unwrap_or(arc.feed);
    }
    Ok((!same).then(|| {
        let path = path.display();
        format!("the start in {path} has another grid or other bodies: it is interpolated")
    }))
}

/// Lets the bed of flux be gas where it is in the other solution, if that has one.
fn take_bed(arc: &mut Arc, other: &Other) {
    let (Some(granular), Some(kinds)) = (arc.case.bed.as_ref(), other.column("material")) else {
        return;
    };
    let own = role(arc, granular.material as f64);
    if !kinds.iter().any(|kind| (kind - own).abs() < 0.5) {
        return;
    }
    let grid = &arc.case.grid;
    let gas = |k: &usize| {
        let nodes = other.around(grid.rc[k % grid.nr], grid.zc[k / grid.nr]);
        let nearest = nodes.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        u8::from(nearest.is_some_and(|(node, _)| kinds[*node] < 0.5))
    };
    let boiled: Vec<u8> = granular.cells.iter().map(gas).collect();
    let changes = vec![0; boiled.len()];
    arc.restore_bed(&boiled, changes);
}

impl Arc {
    /// Takes velocities and pressure from a function of which (radial, axial, pressure) and place; with `centres`,
    /// the velocities in the middle of its own cells, heights fastest, those at the faces follow from them.
    fn take_flow(&mut self, value: &dyn Fn(usize, f64, f64) -> f64, centres: Option<[&[f64]; 2]>) {
        self.take_properties();
        if let Some((setup, flowing)) = self.case.flow.as_ref().zip(self.flowing.as_mut()) {
            let flow = &mut flowing.flow;
            let gas = Carried {
                grid: &self.case.grid,
                setup,
                density: &self.properties.density,
            };
            flow.take(gas, value);
            if let Some(centres) = centres {
                unmix_all(gas, flow, centres);
                flow.carry(gas);
            }
        }
    }
}

/// Velocities at faces from those in the middle of cells, row by row and column by column.
fn unmix_all(gas: Carried<'_>, flow: &mut Flow, [radial, axial]: [&[f64]; 2]) {
    let (grid, faces) = (gas.grid, &gas.setup.faces);
    for j in 0..grid.nz {
        let at = |i: usize| grid.radial_face(i, j);
        let centres: Vec<f64> = (0..grid.nr).map(|i| radial[i * grid.nz + j]).collect();
        let solved: Vec<bool> = (0..=grid.nr)
            .map(|i| faces.radial[at(i)] == Face::Solved)
            .collect();
        let mut line: Vec<f64> = (0..=grid.nr).map(|i| flow.radial[at(i)]).collect();
        unmix(&mut line, &solved, &centres);
        for (i, u) in line.into_iter().enumerate() {
            flow.radial[at(i)] = u;
        }
    }
    for i in 0..grid.nr {
        let at = |j: usize| grid.axial_face(i, j);
        let centres = &axial[i * grid.nz..(i + 1) * grid.nz];
        let solved: Vec<bool> = (0..=grid.nz)
            .map(|j| faces.axial[at(j)] == Face::Solved)
            .collect();
        let mut line: Vec<f64> = (0..=grid.nz).map(|j| flow.axial[at(j)]).collect();
        unmix(&mut line, &solved, centres);
        for (j, w) in line.into_iter().enumerate() {
            flow.axial[at(j)] = w;
        }
    }
}

/// Closure of a line between two known faces, as part of its greatest velocity, up to which they belong together.
const CLOSED: f64 = 1e-9;

/// Values at the faces of a line from the means of each two, `centre`, from a known face on. A stretch between two
/// known faces that the means do not lead from one to the other stays as it is: they belong to other walls or inlets.
fn unmix(face: &mut [f64], solved: &[bool], centre: &[f64]) {
    let mut from = 0;
    while from < face.len() {
        if !solved[from] {
            from += 1;
            continue;
        }
        let length = solved[from..].iter().take_while(|s| **s).count();
        let to = from + length;
        if from > 0 {
            let mut found = Vec::with_capacity(length);
            let mut last = face[from - 1];
            for c in &centre[from - 1..to - 1] {
                last = 2.0 * c - last;
                found.push(last);
            }
            let scale = found.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
            let closes = |end: f64| (2.0 * centre[to - 1] - last - end).abs() <= CLOSED * scale;
            if to == face.len() || closes(face[to]) {
                face[from..to].copy_from_slice(&found);
            }
        } else if to < face.len() {
            for k in (from..to).rev() {
                face[k] = 2.0 * centre[k] - face[k + 1];
            }
        }
        from = to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_follow_from_the_middle_of_cells_where_they_belong_together() {
        let exact = [0.0, 3.0, -1.0, 4.0, 0.0, 0.0, 2.0, 5.0];
        let centre: Vec<f64> = exact.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
        let solved = [false, true, true, true, false, false, true, true];
        let mut face = exact;
        let clear = |face: &mut [f64; 8]| {
            for (u, s) in face.iter_mut().zip(solved) {
                *u = if s { 0.5 } else { *u };
            }
        };
        clear(&mut face);
        unmix(&mut face, &solved, &centre);
        assert_eq!(face.to_vec(), exact);
        // Backwards from the only known face, which is the last.
        let mut back = [0.5, 0.5, 0.5, 4.0];
        unmix(&mut back, &[true, true, true, false], &centre);
        assert_eq!(back.to_vec(), exact[..4].to_vec());
        // Another inlet: the stretch before it stays, the one after it follows from it.
        clear(&mut face);
        face[4] = 1.0;
        unmix(&mut face, &solved, &centre);
        assert_eq!(face.to_vec(), [0.0, 0.5, 0.5, 0.5, 1.0, 0.0, 2.0, 5.0]);
    }

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
        let found = other.value_within(&values, [2.0, 2.5], 1.0);
        assert!((found - field(2.0, 1.0)).abs() < 1e-12);
    }
}
