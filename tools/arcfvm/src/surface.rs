//! The source that the pool reads: heat, current, gas and pressure against radius on the base metal.

use artefact::Table;

use crate::case::Base;
use crate::heat::Surfaces;
use crate::heat::sources::ContactHeat;
use crate::material::GAS;
use crate::sample::Sample;
use crate::solver::Arc;
use crate::vapour::figures as iron;

/// Material of the base metal: the lowest electrode, where there is one.
#[must_use]
pub fn base(arc: &Arc) -> Option<usize> {
    arc.case.base.as_ref().map(|base| base.material)
}

/// A column of the base metal's surface.
struct Column {
    /// Column of the grid.
    i: usize,
    /// Row above the metal.
    row: usize,
    /// Contacts of its metal with gas, on top and, where the surface is steep, at its sides.
    contacts: Vec<usize>,
}

/// The columns of the base metal that the gas touches.
fn columns(arc: &Arc, surfaces: &Surfaces) -> Vec<Column> {
    let grid = &arc.case.grid;
    let Some(base) = &arc.case.base else {
        return Vec::new();
    };
    let mut all: Vec<Vec<usize>> = vec![Vec::new(); grid.nr];
    for (n, contact) in surfaces.contacts.iter().enumerate() {
        if arc.case.material[contact.metal] == base.material {
            all[contact.metal % grid.nr].push(n);
        }
    }
    let touched = all.into_iter().enumerate();
    let touched = touched.filter(|(i, contacts)| {
        let row = base.above[*i].unwrap_or(0);
        let tops = contacts
            .iter()
            .any(|n| surfaces.contacts[*n].gas == grid.cell(*i, row));
        tops && row > 0
    });
    touched
        .filter_map(|(i, contacts)| base.above[i].map(|row| Column { i, row, contacts }))
        .collect()
}

/// The table of the surface, where there is a base metal, heat, current and flow.
#[must_use]
pub fn table(arc: &Arc, sample: &Sample) -> Option<Table> {
    let (surfaces, heating) = (arc.case.surfaces.as_ref()?, arc.heating.as_ref()?);
    let (found, absorbed) = (&heating.sources.contacts, heating.sources.absorbed());
    let rows = columns(arc, surfaces);
    rows.first().zip(arc.flowing.as_ref())?;
    let ring = &arc.case.grid.ring;
    // Per area of the plane: what steep parts take up belongs to their column.
    let over = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let column = |c: &Column| match c.contacts.as_slice() {
            [only] => value(*only),
            all => {
                let each = all.iter().map(|n| value(*n) * surfaces.contacts[*n].area);
                each.sum::<f64>() / ring[c.i]
            }
        };
        rows.iter().map(column).collect()
    };
    let mean = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let area = |n: &usize| surfaces.contacts[*n].area;
        let column = |c: &Column| match c.contacts.as_slice() {
            [only] => value(*only),
            all => {
                let sum: f64 = all.iter().map(|n| value(*n) * area(n)).sum();
                sum / all.iter().map(area).sum::<f64>()
            }
        };
        rows.iter().map(column).collect()
    };
    let per = |value: &dyn Fn(&ContactHeat) -> f64| over(&|n| value(&found[n]));
    let gas = |n: usize| heating.energy.convection(&surfaces.contacts[n]) - found[n].held;
    let convection = over(&gas);
    let rest = over(&|n| absorbed[n] + found[n].parts.sum());
    let total = convection.iter().zip(rest).map(|(q, rest)| q + rest);
    let table = gas_columns(arc, sample, &rows)
        .column(
            "heat_flux_convection_w_m2",
            "W/m2",
            convection.iter().copied(),
        )
        .column("heat_flux_radiation_w_m2", "W/m2", over(&|n| absorbed[n]))
        .column(
            "heat_flux_electron_w_m2",
            "W/m2",
            per(&|f| f.parts.electron),
        )
        .column("heat_flux_ion_w_m2", "W/m2", per(&|f| f.parts.ion))
        .column(
            "heat_flux_emission_w_m2",
            "W/m2",
            per(&|f| f.parts.emission),
        )
        .column("heat_flux_vapour_w_m2", "W/m2", per(&|f| f.parts.vapour))
        .column("heat_flux_total_w_m2", "W/m2", total)
        .column("current_density_a_m2", "A/m2", per(&|f| f.current))
        .column(
            "ion_current_density_a_m2",
            "A/m2",
            per(&|f| f.current - f.emitted),
        )
        .column("electron_current_density_a_m2", "A/m2", per(&|f| f.emitted))
        .column("ionisation_voltage_v", "V", mean(&|n| found[n].ionisation));
    Some(iron::surface(arc, table, &over, &mean))
}

/// Radius, gas, pressure and temperature of the metal.
fn gas_columns(arc: &Arc, sample: &Sample, rows: &[Column]) -> Table {
    let grid = &arc.case.grid;
    let of = |value: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        rows.iter().map(|c| value(c.i, c.row)).collect()
    };
    let temperature = |c: &Column| gas_temperature(arc, c, sample.temperature_height_m);
    let velocity = |i: usize, row: usize| gas_velocity(arc, i, row, sample.velocity_height_m);
    let flow = arc.flowing.as_ref().map(|f| &f.flow);
    let pressure = |i: usize, row: usize| flow.map_or(0.0, |f| f.pressure[grid.cell(i, row)]);
    let mut table = Table::new(rows.len())
        .column("radius_m", "m", of(&|i, _| grid.rc[i]))
        .column("gas_temperature_k", "K", rows.iter().map(temperature))
        .column("gas_radial_velocity_m_s", "m/s", of(&velocity))
        .column("arc_pressure_pa", "Pa", of(&pressure))
        .column(
            "surface_temperature_k",
            "K",
            rows.iter().map(|c| surface_temperature(arc, c)),
        );
    if arc.case.base.as_ref().is_some_and(Base::is_deformed) {
        table = table.column("surface_height_m", "m", of(&|_, row| grid.zf[row]));
    }
    table
        .attribute("gas_temperature_height_m", "m", sample.temperature_height_m)
        .attribute("gas_velocity_height_m", "m", sample.velocity_height_m)
}

/// Temperature of the level surface of a column \[K\].
fn surface_temperature(arc: &Arc, column: &Column) -> f64 {
    let grid = &arc.case.grid;
    let metal = arc.temperature()[grid.cell(column.i, column.row - 1)];
    let (contacts, Some(heating)) = (arc.case.contacts(), &arc.heating) else {
        return metal;
    };
    let contacts = column.contacts.iter().map(|n| (*n, &contacts[*n]));
    let mut level = contacts.filter(|(_, contact)| contact.normal[1] > 0.0);
    level.next().map_or(metal, |(n, contact)| {
        heating.energy.skin(n, contact).temperature
    })
}

/// Linear between the known values `(height, value)`, held beyond the ends.
fn between(known: &[(f64, f64)], height: f64) -> f64 {
    let above = known.partition_point(|(z, _)| *z <= height);
    if above == 0 {
        return known[0].1;
    }
    if above == known.len() {
        return known[above - 1].1;
    }
    let ((z0, v0), (z1, v1)) = (known[above - 1], known[above]);
    v0 + (v1 - v0) * (height - z0) / (z1 - z0)
}

/// A place beside a surface that bends, and the direction along the surface there, outwards.
struct Beside {
    /// Radius and height \[m\].
    place: [f64; 2],
    /// Parts along radius and height.
    along: [f64; 2],
}

/// The place at `height` \[m\] from the curve that the cells of the metal follow, along its normal; nothing where
/// the metal is level.
fn beside(arc: &Arc, i: usize, height: f64) -> Option<Beside> {
    let grid = &arc.case.grid;
    let curve = arc.case.base.as_ref()?.curve.as_ref()?;
    let (r, width) = (grid.rc[i], grid.rf[i + 1] - grid.rf[i]);
    let slope = (curve.height(grid.rf[i + 1]) - curve.height(grid.rf[i])) / width;
    let length = slope.hypot(1.0);
    let along = [1.0 / length, slope / length];
    Some(Beside {
        place: [
            (r - height * along[1]).abs(),
            curve.height(r) + height * along[0],
        ],
        along,
    })
}

/// A value of cells `(i, j)` at a place, linear between the four middles around it.
fn bilinear(arc: &Arc, [r, z]: [f64; 2], value: impl Fn(usize, usize) -> f64) -> f64 {
    let grid = &arc.case.grid;
    let part = |at: &[f64], x: f64| {
        let k = at.partition_point(|a| *a <= x).clamp(1, at.len() - 1) - 1;
        (k, ((x - at[k]) / (at[k + 1] - at[k])).clamp(0.0, 1.0))
    };
    let ((i, u), (j, v)) = (part(&grid.rc, r), part(&grid.zc, z));
    let row = |j: usize| value(i, j) + u * (value(i + 1, j) - value(i, j));
    row(j) + v * (row(j + 1) - row(j))
}

/// Temperature of the gas at `height` over column `i`, from that of the metal upward \[K\]; over a surface that
/// bends, at that distance from it.
fn gas_temperature(arc: &Arc, column: &Column, height: f64) -> f64 {
    let (i, row) = (column.i, column.row);
    let (grid, t) = (&arc.case.grid, arc.temperature());
    if let Some(beside) = beside(arc, i, height) {
        return bilinear(arc, beside.place, |i, j| t[grid.cell(i, j)]);
    }
    let surface = grid.zf[row];
    let mut known = vec![(0.0, surface_temperature(arc, column))];
    let gas = (row..grid.nz).take_while(|j| arc.case.material[grid.cell(i, *j)] == GAS);
    known.extend(gas.map(|j| (grid.zc[j] - surface, t[grid.cell(i, j)])));
    between(&known, height)
}

/// Radial velocity of the gas at `height` over column `i`, zero on the surface \[m/s\]; over a surface that bends,
/// the velocity along it at that distance from it.
fn gas_velocity(arc: &Arc, i: usize, row: usize, height: f64) -> f64 {
    let grid = &arc.case.grid;
    let Some(flowing) = &arc.flowing else {
        return 0.0;
    };
    let radial = |i: usize, j: usize| {
        let face = grid.radial_face(i, j);
        0.5 * (flowing.flow.radial[face] + flowing.flow.radial[face + 1])
    };
    if let Some(beside) = beside(arc, i, height) {
        let axial = |i: usize, j: usize| {
            let face = grid.axial_face(i, j);
            0.5 * (flowing.flow.axial[face] + flowing.flow.axial[face + grid.nr])
        };
        let [r, z] = beside.along;
        return bilinear(arc, beside.place, |i, j| r * radial(i, j) + z * axial(i, j));
    }
    let at = |j: usize| radial(i, j);
    let surface = grid.zf[row];
    let mut known = vec![(0.0, 0.0)];
    let gas = (row..grid.nz).take_while(|j| arc.case.material[grid.cell(i, *j)] == GAS);
    known.extend(gas.map(|j| (grid.zc[j] - surface, at(j))));
    between(&known, height)
}

/// Part of a height by which rounding may take it beyond a cell.
const ROUNDING: f64 = 1e-9;
/// Part of the surface over which a sample may not reach its height.
const FEW: f64 = 0.1;

/// What is to be told of heights at which there is no gas to sample: over the axis, or over much of the surface.
pub(crate) fn unreached(arc: &Arc, sample: &Sample) -> Option<String> {
    let (surfaces, ring) = (arc.case.surfaces.as_ref()?, &arc.case.grid.ring);
    let rows = columns(arc, surfaces);
    arc.flowing.as_ref().zip(rows.first())?;
    let whole: f64 = rows.iter().map(|c| ring[c.i]).sum();
    let tell = |(key, height): (&str, f64)| {
        let missed = rows.iter().filter(|c| !reaches(arc, c, height));
        let missed: Vec<&Column> = missed.collect();
        let part = missed.iter().map(|c| ring[c.i]).sum::<f64>() / whole;
        let first = missed.first()?;
        let is_axis = first.i == rows[0].i;
        (is_axis || part > FEW).then(|| {
            format!(
                "sample/{key} of {height:.2e} m is beyond the gas over {:.0} % of the surface, first at r = {:.3} mm: the \
                 table holds the nearest value there; take a smaller height",
                100.0 * part,
                1e3 * arc.case.grid.rc[first.i]
            )
        })
    };
    let heights = [
        ("velocity_height_m", sample.velocity_height_m),
        ("temperature_height_m", sample.temperature_height_m),
    ];
    let told: Vec<String> = heights.into_iter().filter_map(tell).collect();
    (!told.is_empty()).then(|| told.join("; "))
}

/// Whether gas lies at `height` \[m\] over a column.
fn reaches(arc: &Arc, column: &Column, height: f64) -> bool {
    let (case, grid) = (&arc.case, &arc.case.grid);
    if let Some(Beside { place: [r, z], .. }) = beside(arc, column.i, height) {
        let material = case.material[grid.cell(grid.column_of(r), grid.row_of(z))];
        let is_of_base = Some(material) == base(arc);
        return r < grid.rf[grid.nr] && z < grid.zf[grid.nz] && (material == GAS || is_of_base);
    }
    let rows = column.row..grid.nz;
    let gas = rows.take_while(|j| case.material[grid.cell(column.i, *j)] == GAS);
    let last = gas.last().map_or(0.0, |j| grid.zc[j] - grid.zf[column.row]);
    height <= last * (1.0 + ROUNDING)
}

#[cfg(test)]
mod tests {
    use super::between;

    #[test]
    fn samples_lie_on_the_line_between_their_neighbours() {
        let known = [(0.0, 1.0), (1.0, 3.0), (3.0, -1.0)];
        assert!((between(&known, 0.5) - 2.0).abs() < 1e-15);
        assert!((between(&known, 2.0) - 1.0).abs() < 1e-15);
        assert!((between(&known, 9.0) + 1.0).abs() < 1e-15);
    }
}
