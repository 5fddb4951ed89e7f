//! What is written of granular flux, slag and cavity.

use artefact::{Record, Table};

use crate::bed::granular::Granular;
use crate::material::GAS;
use crate::solver::Arc;

/// Sizes and heats of the bed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bed {
    /// Volume of slag \[m3\].
    pub slag_volume: f64,
    /// Volume of the cavity, as far as it lies within the bed \[m3\].
    pub cavity_volume: f64,
    /// Area of the wall between slag and gas \[m2\].
    pub wall: f64,
    /// Greatest radius of the gas \[m\].
    pub cavity_radius: f64,
    /// Thickness of the slag at that radius, outwards, to its melting point \[m\].
    pub slag_thickness: f64,
    /// Heat conducted from the gas into the bed \[W\].
    pub convection: f64,
    /// Heat conducted from the bed into metal \[W\].
    pub into_metal: f64,
    /// Section of slag that the heat of the bed would melt on its way \[m2\] (see `by_heat`).
    pub by_heat: f64,
}

/// Whether each cell of the bed is slag now: 1 where it is, 0 elsewhere.
#[must_use]
pub fn slag(arc: &Arc) -> Option<Vec<f64>> {
    let granular = arc.case.bed.as_ref()?;
    let (t, material) = (arc.temperature(), &arc.case.material);
    let molten = |k: usize| material[k] == granular.material && t[k] > granular.melting;
    let cells = 0..arc.case.grid.len();
    Some(cells.map(|k| f64::from(u8::from(molten(k)))).collect())
}

/// Name and unit of the column of every cell.
pub(crate) const COLUMN: (&str, &str) = ("slag", "1");

/// Adds the column of every cell, where there is a bed.
pub(crate) fn plasma(arc: &Arc, table: Table) -> Table {
    let (grid, Some(slag)) = (&arc.case.grid, slag(arc)) else {
        return table;
    };
    let values = grid.by_height(|i, j| slag[grid.cell(i, j)]);
    table.column(COLUMN.0, COLUMN.1, values)
}

/// Adds up the bed.
#[must_use]
pub fn measure(arc: &Arc) -> Option<Bed> {
    let (granular, slag) = (arc.case.bed.as_ref()?, slag(arc)?);
    let (grid, material) = (&arc.case.grid, &arc.case.material);
    let mut bed = Bed::default();
    for k in &granular.cells {
        let volume = grid.volume(k % grid.nr, k / grid.nr);
        bed.slag_volume += slag[*k] * volume;
        if material[*k] == GAS {
            bed.cavity_volume += volume;
        }
    }
    walls(arc, granular.material, &mut bed);
    side(arc, granular, &mut bed);
    bed.by_heat = by_heat(arc, granular, &bed).unwrap_or_default();
    Some(bed)
}

/// Section across the way of the weld that the heat which the bed keeps would melt, were all of it spent on melting
/// flux as it comes in, and no more \[m2\]:
///
/// ```text
/// A = (Q_radiation + Q_gas - Q_metal) / (rho v (h(molten) - h(coming in)))
/// ```
///
/// the most slag that the balance allows, as flux that is warmed and not melted, and slag hotter than its melting point, take
/// a part. Not what the field has: by eq. 5.22 of Komen (2019) a section in the plane of the arc keeps its heat only while the bed
/// moves on by its distance from the axis, in which little of it melts.
fn by_heat(arc: &Arc, granular: &Granular, bed: &Bed) -> Option<f64> {
    let heating = arc.heating.as_ref()?;
    let mut plates = arc.case.heat.as_ref()?.plates.iter();
    let plate = plates.find(|plate| plate.material == granular.material)?;
    let material = &arc.case.materials[granular.material];
    let (enthalpy, density) = material.enthalpy.as_ref().zip(material.density.as_ref())?;
    let grid = &arc.case.grid;
    let row = granular.cells.last()? / grid.nr;
    let molten = granular.melting + material.melting?.half_range;
    let rise = enthalpy.at(molten) - enthalpy.at(plate.beyond[row]);
    let heat = heating.sources.granular + bed.convection - bed.into_metal;
    let mass = density.at(grid.rf[grid.nr], grid.zc[row], granular.melting) * plate.speed;
    (mass * rise > 0.0).then(|| heat.max(0.0) / (mass * rise))
}

/// Faces between the bed and what is beside it.
fn walls(arc: &Arc, own: usize, bed: &mut Bed) {
    let (Some(heating), grid) = (&arc.heating, &arc.case.grid) else {
        return;
    };
    let (t, material) = (&heating.energy.temperature, &arc.case.material);
    let mut meet = |a: usize, b: usize, area: f64, conductance: f64| {
        let other = if material[a] == own { b } else { a };
        let inner = if other == a { b } else { a };
        if material[inner] != own || material[other] == own {
            return;
        }
        let inward = conductance * (t[other] - t[inner]);
        if material[other] == GAS {
            bed.wall += area;
            bed.convection += inward;
        } else {
            bed.into_metal -= inward;
        }
    };
    for j in 0..grid.nz {
        for i in 0..grid.nr {
            let k = grid.cell(i, j);
            if i + 1 < grid.nr {
                let conductance = heating.energy.radial[grid.radial_face(i + 1, j)];
                meet(k, k + 1, grid.area(i + 1, j), conductance);
            }
            if j + 1 < grid.nz {
                let conductance = heating.energy.axial[grid.axial_face(i, j + 1)];
                meet(k, k + grid.nr, grid.ring[i], conductance);
            }
        }
    }
}

/// Where the cavity is widest: its radius, and the slag from there out.
fn side(arc: &Arc, granular: &Granular, bed: &mut Bed) {
    let (grid, t) = (&arc.case.grid, arc.temperature());
    let material = &arc.case.material;
    let outermost = |j: usize| {
        (0..grid.nr)
            .rev()
            .find(|i| material[grid.cell(*i, j)] == GAS)
    };
    let fronts: Vec<(usize, usize)> = (0..grid.nz)
        .filter_map(|j| Some((outermost(j)?, j)))
        .collect();
    let Some(front) = fronts.iter().map(|(i, _)| *i).max() else {
        return;
    };
    // Of several rows as wide the middle one: the plate and the roof cool those beside them.
    let widest: Vec<usize> = fronts
        .iter()
        .filter(|(i, _)| *i == front)
        .map(|(_, j)| *j)
        .collect();
    let j = widest[widest.len() / 2];
    bed.cavity_radius = grid.rf[front + 1];
    for i in front + 1..grid.nr {
        let k = grid.cell(i, j);
        if t[k] > granular.melting {
            continue;
        }
        // The melting point lies between this centre and the one before, or on the wall itself.
        let inner = if i > front + 1 {
            (grid.rc[i - 1], t[k - 1])
        } else {
            (grid.rf[i], t[k])
        };
        let part = (inner.1 - granular.melting) / (inner.1 - t[k]).max(f64::MIN_POSITIVE);
        let at = inner.0 + part.clamp(0.0, 1.0) * (grid.rc[i] - inner.0);
        bed.slag_thickness = at - bed.cavity_radius;
        return;
    }
}

/// The lines of the balance.
#[must_use]
pub fn record(arc: &Arc, record: Record) -> Record {
    let Some((granular, bed, heating, heat)) = arc
        .case
        .bed
        .as_ref()
        .zip(measure(arc))
        .and_then(|(g, b)| Some((g, b, arc.heating.as_ref()?, arc.case.heat.as_ref()?)))
    else {
        return record;
    };
    let name = &arc.case.materials[granular.material].name;
    let plates = heat.plates.iter().zip(&heating.sources.plates);
    let own = plates.filter(|(p, _)| p.material == granular.material);
    let motion: f64 = own.map(|(_, heat)| heat).sum();
    let mean = if bed.wall > 0.0 {
        bed.slag_volume / bed.wall
    } else {
        0.0
    };
    // As wide as cavity and slag are.
    let spread = bed.by_heat / (2.0 * (bed.cavity_radius + bed.slag_thickness));
    record
        .with(
            &format!("{name}_radiation_w"),
            "W",
            heating.sources.granular,
        )
        .with(&format!("{name}_convection_w"), "W", bed.convection)
        .with(&format!("{name}_motion_w"), "W", -motion)
        .with(&format!("{name}_into_metal_w"), "W", -bed.into_metal)
        .with("slag_volume_m3", "m3", bed.slag_volume)
        .with("slag_thickness_m", "m", bed.slag_thickness)
        .with("slag_thickness_mean_m", "m", mean)
        .with("slag_by_heat_area_m2", "m2", bed.by_heat)
        .with("slag_by_heat_thickness_m", "m", spread)
        .with("cavity_volume_m3", "m3", bed.cavity_volume)
        .with("cavity_radius_m", "m", bed.cavity_radius)
}
