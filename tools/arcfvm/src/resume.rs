//! What a checkpoint holds: everything that the next iteration reads.

use artefact::Checkpoint;

use crate::case::Case;
use crate::equation::Solver;
use crate::solver::Arc;

/// Puts the state into a checkpoint.
///
/// # Errors
/// When a value cannot be stored.
pub fn keep(arc: &Arc, c: &mut Checkpoint) -> artefact::Result<()> {
    c.put_json("iteration", &arc.iteration)?;
    c.put_f64("feed", &[arc.feed]);
    if let Some([boiled, changes]) = arc.bed() {
        c.put_u8("bed_boiled", &boiled);
        c.put_u8("bed_changes", &changes);
        c.put_json("bed_part", &arc.boiled)?;
        c.put_f64("bed_unsettled", &[arc.unsettled]);
    }
    if let Some(electric) = &arc.electric {
        c.put_f64("potential", &electric.potential.value);
        c.put_f64("drive", &[electric.potential.drive]);
        groups(c, "potential", &electric.potential.solver)?;
    }
    if let Some(flowing) = &arc.flowing {
        let flow = &flowing.flow;
        c.put_f64("velocity_radial", &flow.radial);
        c.put_f64("velocity_axial", &flow.axial);
        c.put_f64("pressure", &flow.pressure);
        c.put_f64("mass_radial", &flow.mass_radial);
        c.put_f64("mass_axial", &flow.mass_axial);
        if !flow.mass_source.is_empty() {
            c.put_f64("mass_source", &flow.mass_source);
        }
        groups(c, "pressure", &flowing.solver.pressure_solver)?;
    }
    if let Some(vapour) = &arc.vapour {
        c.put_f64("iron", &vapour.iron);
    }
    if let Some(heating) = &arc.heating {
        c.put_f64("temperature", &heating.energy.temperature);
        c.put_f64("calm", &heating.energy.calm);
        c.put_f64("last_change", &heating.energy.last);
        c.put_u8("alternations", &heating.energy.alternations);
        c.put_f64("absorbed", heating.sources.absorbed());
        if length(&arc.case).is_some() {
            c.put_f64("lit", heating.sources.lit());
        }
        let surfaces = heating.energy.surface_temperatures();
        if !surfaces.is_empty() {
            c.put_f64("surfaces", &surfaces);
        }
        groups(c, "energy", &heating.energy.solver)?;
    }
    Ok(())
}

/// Takes the state out of a checkpoint.
///
/// # Errors
/// When a column is missing or damaged.
pub fn restore(arc: &mut Arc, c: &mut Checkpoint) -> artefact::Result<()> {
    let nr = arc.case.grid.nr;
    arc.iteration = c.json("iteration")?;
    arc.feed = one(c, "feed")?;
    if arc.bed().is_some() {
        let (boiled, changes) = (c.u8("bed_boiled")?, c.u8("bed_changes")?);
        arc.restore_bed(&boiled, changes);
        arc.boiled = c.json("bed_part")?;
        arc.unsettled = one(c, "bed_unsettled")?;
    }
    if let Some(electric) = &mut arc.electric {
        electric.potential.value = c.f64("potential")?;
        electric.potential.drive = one(c, "drive")?;
        regroup(c, "potential", nr, &mut electric.potential.solver)?;
    }
    if let Some(flowing) = &mut arc.flowing {
        let flow = &mut flowing.flow;
        flow.radial = c.f64("velocity_radial")?;
        flow.axial = c.f64("velocity_axial")?;
        flow.pressure = c.f64("pressure")?;
        flow.mass_radial = c.f64("mass_radial")?;
        flow.mass_axial = c.f64("mass_axial")?;
        if !flow.mass_source.is_empty() {
            flow.mass_source = c.f64("mass_source")?;
        }
        regroup(c, "pressure", nr, &mut flowing.solver.pressure_solver)?;
    }
    if let Some(vapour) = &mut arc.vapour {
        vapour.iron = c.f64("iron")?;
    }
    if let Some(heating) = &mut arc.heating {
        heating.energy.temperature = c.f64("temperature")?;
        heating.energy.calm = c.f64("calm")?;
        heating.energy.last = c.f64("last_change")?;
        heating.energy.alternations = c.u8("alternations")?;
        let lit = length(&arc.case).map_or_else(|| Ok(Vec::new()), |_| c.f64("lit"))?;
        heating.sources.restore(c.f64("absorbed")?, lit);
        if !heating.energy.skins.is_empty() {
            heating.energy.restore_surfaces(&c.f64("surfaces")?);
        }
        regroup(c, "energy", nr, &mut heating.energy.solver)?;
    }
    Ok(())
}

/// Length within which the wall of a cavity takes up light, where it has one.
fn length(case: &Case) -> Option<f64> {
    case.bed.as_ref()?.length
}

/// Puts what a solver remembers.
fn groups(c: &mut Checkpoint, name: &str, solver: &Solver) -> artefact::Result<()> {
    let (formed, fresh) = solver.memory();
    c.put_f64(&format!("{name}_groups"), &formed);
    c.put_json(&format!("{name}_fresh"), &fresh)
}

/// Takes what a solver remembers.
fn regroup(
    c: &mut Checkpoint,
    name: &str,
    columns: usize,
    solver: &mut Solver,
) -> artefact::Result<()> {
    let fresh = c.json(&format!("{name}_fresh"))?;
    solver.restore(columns, &c.f64(&format!("{name}_groups"))?, fresh);
    Ok(())
}

fn one(c: &mut Checkpoint, name: &str) -> artefact::Result<f64> {
    Ok(c.f64(name)?.first().copied().unwrap_or_default())
}
