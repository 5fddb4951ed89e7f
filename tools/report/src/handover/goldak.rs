//! `report goldak`: the double ellipsoid that a weld's pool is, as a torch for `heatsph`, `poolsph` or other programs.
//!
//! Its half axes are those of the pool (Goldak, Chakravarti and Bibby 1984): half of the width, the depth, and the lengths
//! before and behind the source, each the mean over the frames of the last third of the time in which heat is brought. Its power is
//! the heat that the metal has taken: what is stored and what has left through open faces, over the same time.

use std::path::Path;
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;
use serde_json::{Value, json};

use crate::files::print;
use crate::mirror::Mirror;
use crate::weld::{PARTICLES, Source, Weld};

/// Part of the frames from which on the pool is taken for grown.
const GROWN: f64 = 2.0 / 3.0;

/// Least part of a spacing that is a half axis of a pool.
const RESOLVED: f64 = 0.1;

/// Prints the torch as JSON: an entry of the key `torches`.
pub(crate) fn run(pool: &Path) -> Result<ExitCode, Failure> {
    let reader = Reader::open_sound(pool, "particle-frames", 1)?;
    let told = |what: &str| Failure::Usage(format!("{}: {what}", pool.display()));
    let until = burns_until(&reader)?;
    let times = reader.times(PARTICLES)?;
    let count = times.partition_point(|t| *t <= until);
    let first = (GROWN * count as f64).floor() as usize;
    let (mut pools, mut ways) = (Vec::new(), Vec::new());
    let (mut top, mut spacing, mut sources) = (0.0, 0.0, 0);
    for index in first..count {
        let weld = Weld::read(&reader, index)?;
        let Some(source) = weld.source else { continue };
        (top, spacing, sources) = (weld.way.top(), weld.plate.spacing_m, sources + 1);
        if let Some(pool) = Pool::of(&weld, source) {
            ways.push((weld.time, source.place()));
            pools.push(pool);
        }
    }
    if sources == 0 {
        return Err(told("has no source whose pool could be measured"));
    }
    let (Some(from), Some(to)) = (ways.first(), ways.last().filter(|to| to.0 > ways[0].0)) else {
        return Err(told(
            "nothing is molten in the last frames of its arc: there is no pool to fit",
        ));
    };
    let mean = Pool::mean(&pools);
    mean.must_be_one(RESOLVED * spacing)
        .map_err(|what| told(&what))?;
    // The path is that of the whole weld.
    let start = match Source::at(&reader, times[0])? {
        Some(source) => (0.0, source.place()),
        None => *from,
    };
    let power = power(&reader, from.0, to.0)?.ok_or_else(|| told("tells no balance of heat"))?;
    let power = power * Mirror::times(&reader)?;
    let way = [to.1[0] - start.1[0], to.1[1] - start.1[1]];
    let speed = way[0].hypot(way[1]) / (to.0 - start.0);
    let place = |at: [f64; 2]| json!([at[0], at[1], top]);
    let torch = json!({
        "power_w": power,
        "path": {"points_m": [place(start.1), place(to.1)], "speed_m_s": speed},
        "shape": {"double_ellipsoid": {
            "half_width_m": mean.across,
            "depth_m": mean.depth,
            "front_m": mean.ahead,
            "rear_m": mean.behind,
        }},
    });
    let text = format!("{:#}\n", without_path(torch, speed));
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// A source that stands has no speed.
fn without_path(mut torch: Value, speed: f64) -> Value {
    if speed <= 0.0
        && let Some(path) = torch.get_mut("path").and_then(Value::as_object_mut)
    {
        path.remove("speed_m_s");
        if let Some(points) = path.get_mut("points_m").and_then(Value::as_array_mut) {
            points.truncate(1);
        }
    }
    torch
}

/// How far the liquid around a source reaches \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pool {
    across: f64,
    depth: f64,
    ahead: f64,
    behind: f64,
}

impl Pool {
    /// The liquid of the bead below the surface of the plate; nothing where there is none.
    fn of(weld: &Weld, source: Source) -> Option<Self> {
        let half = 0.5 * weld.plate.spacing_m;
        let (across, along) = (
            weld.way.across(source.place()),
            weld.way.along(source.place()),
        );
        let liquid = (0..weld.position.len()).filter(|i| weld.liquid[*i] && weld.belongs(*i));
        let mut pool: Option<Self> = None;
        for [x, y, z] in liquid.map(|i| weld.position[i]).filter(|x| x[2] < 0.0) {
            let own = Self {
                across: (x - across).abs() + half,
                depth: half - z,
                ahead: y - along + half,
                behind: along - y + half,
            };
            let so_far = pool.unwrap_or(own);
            pool = Some(Self {
                across: so_far.across.max(own.across),
                depth: so_far.depth.max(own.depth),
                ahead: so_far.ahead.max(own.ahead),
                behind: so_far.behind.max(own.behind),
            });
        }
        pool
    }

    /// The mean of pools.
    fn mean(pools: &[Self]) -> Self {
        let mean = |of: fn(&Self) -> f64| pools.iter().map(of).sum::<f64>() / pools.len() as f64;
        Self {
            across: mean(|pool| pool.across),
            depth: mean(|pool| pool.depth),
            ahead: mean(|pool| pool.ahead),
            behind: mean(|pool| pool.behind),
        }
    }

    /// Whether its half axes are those of a body around the source, each at least `least` \[m\].
    fn must_be_one(&self, least: f64) -> Result<(), String> {
        for (name, axis, where_) in [
            ("front_m", self.ahead, "behind"),
            ("rear_m", self.behind, "ahead of"),
        ] {
            if axis < least {
                return Err(format!(
                    "the pool lies {where_} its source: {name} would be {axis:.3e} m, and no double ellipsoid around the source has \
                     that. Let the source of the scene go where the heat is given"
                ));
            }
        }
        Ok(())
    }
}

/// Until when heat is brought \[s\]: the last record over whose time it came in at half of its mean rate or more.
fn burns_until(reader: &Reader) -> Result<f64, Failure> {
    if !reader.has("/balance") {
        return Ok(f64::INFINITY);
    }
    let records = reader.records("/balance")?;
    let brought = |record: &artefact::Record| {
        let own = |name: &str| name.starts_with("energy_in_") && name.ends_with("_j");
        let values = record.values.iter().filter(|entry| own(&entry.name));
        values.map(|entry| entry.value).sum::<f64>()
    };
    let course: Vec<[f64; 2]> = records.iter().map(|(t, r)| [*t, brought(r)]).collect();
    Ok(last_brought(&course))
}

/// The same of the heat that has come in by each time \[s, J\].
fn last_brought(course: &[[f64; 2]]) -> f64 {
    let Some([start, before]) = course.first() else {
        return f64::INFINITY;
    };
    let burns = |pair: &&[[f64; 2]]| {
        let [[a, from], [b, to]] = [pair[0], pair[1]];
        let mean = (to - before) / (b - start);
        mean > 0.0 && to - from >= 0.5 * mean * (b - a)
    };
    let last = course.windows(2).rev().find(burns);
    match (last, course.last()) {
        // Frames may come between two records.
        (Some(pair), Some(end)) if pair[1][0] >= end[0] => f64::INFINITY,
        (Some(pair), _) => pair[1][0],
        _ => f64::INFINITY,
    }
}

/// Heat that the metal takes, on average between two times \[W\]; nothing without a balance.
fn power(reader: &Reader, from: f64, to: f64) -> Result<Option<f64>, Failure> {
    if !reader.has("/balance") {
        return Ok(None);
    }
    let records = reader.records("/balance")?;
    let heat = |record: &artefact::Record| {
        let open = record.get("energy_out_open_faces_j").unwrap_or(0.0);
        record
            .get("energy_stored_j")
            .ok()
            .map(|stored| stored + open)
    };
    let taken: Vec<[f64; 2]> = records
        .iter()
        .filter(|(time, _)| *time >= from && *time <= to)
        .filter_map(|(time, record)| Some([*time, heat(record)?]))
        .collect();
    Ok(match (taken.first(), taken.last()) {
        (Some([a, before]), Some([b, after])) if b > a => Some((after - before) / (b - a)),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_after_the_arc_is_not_its_time() {
        let burning =
            |until: f64| (0..20).map(move |k| [f64::from(k), f64::from(k).min(until) * 2.5e3]);
        let of = |until: f64| last_brought(&burning(until).collect::<Vec<_>>());
        assert!(of(30.0).is_infinite());
        assert_eq!(of(13.0).to_bits(), 13.0_f64.to_bits());
        // In the last of these times it burnt for a tenth.
        assert_eq!(of(13.1).to_bits(), 13.0_f64.to_bits());
        assert!(last_brought(&[]).is_infinite());
    }

    #[test]
    fn a_pool_that_does_not_surround_its_source_is_no_ellipsoid() {
        let pool = |ahead, behind| Pool {
            across: 2e-3,
            depth: 1e-3,
            ahead,
            behind,
        };
        assert!(pool(1e-3, 4e-3).must_be_one(1e-4).is_ok());
        let told = pool(-2.1e-3, 6e-3).must_be_one(1e-4).unwrap_err();
        assert!(
            told.contains("front_m") && told.contains("behind its source"),
            "{told}"
        );
        assert!(pool(7.6e-11, 6e-3).must_be_one(1e-4).is_err());
        assert!(
            pool(4e-3, -1e-3)
                .must_be_one(1e-4)
                .unwrap_err()
                .contains("rear_m")
        );
    }
}
