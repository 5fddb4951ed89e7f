//! Averages as grid tables with units.
//!
//! Each section becomes a channel of its name with one table per phase, at the log time of the
//! phase in the droplet period (without phases there is none of these), and a channel
//! `NAME/time_mean` with the mean over all frames. Where a column has no frame behind it, its value is 0 and
//! the count that belongs to it (`frames_metal`, `frames_liquid`) is 0. Errors are told by the independent parts
//! of the frames ([`crate::parts`]); where `parts_metal` or `parts_liquid` is below 2 there is no error, and its
//! column is 0. Grids that move with the source
//! stand in the frame of reference `source`, others in `world`. The surface over the distance from the axis
//! ([`crate::profile`]) is the channel `/profile`, where the scene asks for it.

use artefact::Table;

use crate::assemble::Plan;
use crate::average::Averages;
use crate::ensemble::{Ensemble, Point};
use crate::grid::{Cut, Section};
use crate::heat_map::HEAT_MAP;
use crate::parts::student;
use crate::profile::{PROFILE, Profile};

const AXES: [&str; 3] = ["x_m", "y_m", "z_m"];

/// A table with its channel and log time \[s\].
pub type Placed = (String, f64, Table);

/// Every table of `averages` with its channel and its log time.
#[must_use]
pub fn tables(plan: &Plan, averages: &Averages) -> Vec<Placed> {
    let mut all = Vec::new();
    for (section, ensemble) in plan.sections.iter().zip(&averages.ensembles) {
        if plan.phases > 1 {
            all.extend(phases(plan, section, (ensemble, averages)));
        }
        let frames: u32 = ensemble.frames.iter().sum();
        let mut mean = placed(plan, section, &ensemble.time)
            .attribute("frames", "1", f64::from(frames))
            .attribute("drops", "1", averages.drops.1 as f64);
        if let Some(period) = plan.period {
            mean = mean.attribute("period_s", "s", period);
        }
        all.push((format!("/{}/time_mean", section.name), 0.0, mean));
    }
    if let (Some(rings), Some(profile)) = (&plan.rings, &averages.profile) {
        let table = at_source(plan, profile.table(rings, &plan.smoothing));
        all.push((format!("/{PROFILE}"), 0.0, table));
    }
    all
}

/// Channels of the averages with the number of their messages, and at most their bytes before they are compressed.
#[must_use]
pub fn volume(plan: &Plan) -> Vec<(String, u64, u64)> {
    let mut all = Vec::new();
    for section in &plan.sections {
        let points = vec![Point::default(); section.len()];
        let each = placed(plan, section, &points).most_bytes() as u64;
        let phases = plan.phases as u64;
        if phases > 1 {
            all.push((format!("/{}", section.name), phases, phases * each));
        }
        all.push((format!("/{}/time_mean", section.name), 1, each));
    }
    if let Some(maps) = &plan.heat_maps {
        let number = maps.most(plan.frames.len());
        all.push((format!("/{HEAT_MAP}"), number, number * maps.map_bytes()));
        all.push((format!("/{HEAT_MAP}/time_mean"), 1, maps.map_bytes()));
    }
    if let Some(rings) = &plan.rings {
        let empty = Profile::new(rings).table(rings, &plan.smoothing);
        all.push((format!("/{PROFILE}"), 1, empty.most_bytes() as u64));
    }
    all
}

fn phases(plan: &Plan, section: &Section, means: (&Ensemble, &Averages)) -> Vec<Placed> {
    let (ensemble, averages) = means;
    let at = |k: usize| k as f64 / plan.phases as f64;
    let points = ensemble.phases.iter().enumerate();
    points
        .map(|(k, points)| {
            let moment = at(k) * plan.period.unwrap_or(1.0);
            let table = placed(plan, section, points)
                .attribute("phase", "1", at(k))
                .attribute("phase_time_s", "s", moment)
                .attribute("frames", "1", f64::from(ensemble.frames[k]))
                .attribute("drops", "1", averages.drops.0[k] as f64);
            (format!("/{}", section.name), moment, table)
        })
        .collect()
}

/// A grid in its frame of reference, as precise as the frames.
fn placed(plan: &Plan, section: &Section, points: &[Point]) -> Table {
    let table = table(section, points, plan.temperature);
    at_source(plan, table.in_precision(plan.precision))
}

/// A table in the frame of reference of the averages, with the direction of a weld that does not run along +y.
#[must_use]
pub fn at_source(plan: &Plan, table: Table) -> Table {
    let table = match plan.turned {
        Some([x, y]) => table
            .attribute("along_x", "1", x)
            .attribute("along_y", "1", y),
        None => table,
    };
    if plan.track.is_empty() {
        table
    } else {
        table.in_frame("source")
    }
}

/// One grid with its columns, and where its plane stands. Without temperature in the frames there is none here.
#[must_use]
pub fn table(section: &Section, points: &[Point], temperature: bool) -> Table {
    let [a, b] = section.axes.map(|axis| AXES[axis]);
    let mut table = Table::grid(&[(a, "m", &section.first), (b, "m", &section.second)]);
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let values = points.iter().map(|p| p.velocity[k].mean);
        table = table.column(&format!("velocity_{axis}_m_s"), "m/s", values);
    }
    let half = points
        .iter()
        .map(|p| student(p.velocity[0].parts()) * speed_error(p));
    table = table
        .column("velocity_error_m_s", "m/s", points.iter().map(speed_error))
        .column("velocity_interval_m_s", "m/s", half);
    if temperature {
        let mean = points.iter().map(|p| p.temperature.mean);
        let error = points.iter().map(|p| p.temperature.standard_error());
        let half = points.iter().map(|p| p.temperature.half_interval());
        table = table
            .column("temperature_k", "K", mean)
            .column("temperature_error_k", "K", error)
            .column("temperature_interval_k", "K", half);
    }
    match section.cut {
        Cut::Surface { .. } => {
            table = table.column("height_m", "m", points.iter().map(|p| p.height.mean));
        }
        Cut::Plane { axis, at, .. } => table = table.attribute(AXES[axis], "m", at),
    }
    let number = |of: fn(&Point) -> u32| points.iter().map(move |p| f64::from(of(p)));
    table
        .column("liquid_share", "1", points.iter().map(|p| p.share.mean))
        .column("frames_metal", "1", number(|p| p.height.count))
        .column("frames_liquid", "1", number(|p| p.velocity[0].count))
        .column("parts_metal", "1", number(|p| p.temperature.parts()))
        .column("parts_liquid", "1", number(|p| p.velocity[0].parts()))
}

/// Standard error of the mean velocity: root of the sum over its components \[m/s\].
fn speed_error(point: &Point) -> f64 {
    let squares = point.velocity.iter().map(|m| m.standard_error().powi(2));
    squares.sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section() -> Section {
        let cut = Cut::Plane {
            axis: 0,
            at: 0.25,
            half_thickness: 1.0,
        };
        Section::new("x0", cut, [[0.0, 1.0], [0.0, 2.0]], 1.0)
    }

    #[test]
    fn without_temperature_there_is_no_temperature_grid() {
        let points = vec![Point::default(); 6];
        let cold = table(&section(), &points, false);
        assert!(!cold.has("temperature_k") && !cold.has("temperature_error_k"));
        assert!(cold.has("velocity_z_m_s"));
        let hot = table(&section(), &points, true);
        assert!(hot.has("temperature_k"));
        assert_eq!(hot.shape, [2, 3]);
        assert_eq!(hot.axis("y_m").unwrap(), [0.0, 1.0]);
        assert!((hot.scalar("x_m").unwrap() - 0.25).abs() < 1e-15);
    }

    #[test]
    fn only_the_surface_has_a_height() {
        let points = vec![Point::default(); 6];
        assert!(!table(&section(), &points, true).has("height_m"));
        let mut above = section();
        above.cut = Cut::Surface { layer: 1.0 };
        assert!(table(&above, &points, true).has("height_m"));
    }
}
