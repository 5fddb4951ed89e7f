//! `report goldak`: the double ellipsoid that warms metal as a weld does, as a torch for `heatsph`, `poolsph` or other programs.
//!
//! The pool is measured by half of its width, its depth, and its lengths before and behind the source, each the mean over the frames of
//! the last third of the time in which heat is brought. The power of the source is the heat that the metal has taken: what is stored and
//! what has left through open faces, over the same time. Its half axes are fitted, so that conduction alone warms the
//! metal around this pool as the weld does (`fit`), or they are those of the pool itself, as Goldak, Chakravarti and Bibby (1984) advise.

use std::path::Path;
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;
use serde::Deserialize;
use serde_json::{Value, json};
use torch::Torch;

use super::fit::{FRAMES, Going, Metal, NEAR, Sample, missed, samples};
use super::pool::Pool;
use crate::files::{note, print, warn};
use crate::mirror::Mirror;
use crate::weld::{PARTICLES, Source, Weld};

/// Part of the frames from which on the pool is taken for grown.
const GROWN: f64 = 2.0 / 3.0;

/// Least part of a spacing that is a half axis of a pool.
const RESOLVED: f64 = 0.1;

/// Least number of particles that four half axes are fitted to.
const LEAST: usize = 12;

/// Prints the torch as JSON: an entry of the key `torches`. Half axes are fitted, or with `melt` those of the pool.
pub(crate) fn run(file: &Path, melt: bool) -> Result<ExitCode, Failure> {
    let reader = Reader::open_sound(file, "particle-frames", 1)?;
    let told = |what: &str| Failure::Usage(format!("{}: {what}", file.display()));
    let first = Weld::read(&reader, 0)?;
    let course = Course::read(&reader, &told)?;
    let pool = Pool::mean(&course.pools);
    pool.must_be_one(RESOLVED * first.plate.spacing_m)
        .map_err(|what| told(&what))?;
    let power_w = power(&reader, course.from.0, course.to.0)?;
    let power_w =
        power_w.ok_or_else(|| told("tells no balance of heat"))? * Mirror::times(&reader)?;
    let speed_m_s = course.speed();
    if melt {
        print(&course.torch(pool, power_w, first.way.top()))?;
        return Ok(ExitCode::SUCCESS);
    }
    let metal = Metal::of(&reader, &first, course.start.1)?;
    let near = course.samples(&reader, &metal)?;
    if near.len() < LEAST {
        return Err(told(&format!(
            "{} particles of solid metal near the pool are too few for a fit: frames show none from {NEAR} of the way to the melting point \
             on. With --melt the half axes are those of the pool itself",
            near.len()
        )));
    }
    let going = Going {
        metal,
        power_w,
        speed_m_s,
    };
    let (axes, left) = going.fit(pool, &near);
    print(&course.torch(axes, power_w, first.way.top()))?;
    let [width, depth, ahead, behind] = pool.reaches().map(|reach| 1e3 * reach);
    note(
        file,
        &format!(
            "fitted by conduction in {} to {} particles, which it misses by {:.1} % of their rise to the melting point in the mean square; the pool \
             is {depth:.2} mm deep and {:.2} mm wide and reaches {ahead:.2} mm ahead of its source and {behind:.2} mm behind",
            metal.words(),
            near.len(),
            100.0 * left,
            2.0 * width
        ),
    )?;
    match missed(&metal, left) {
        Some(what) => warn(file, &what),
        None => Ok(ExitCode::SUCCESS),
    }
}

/// A moment \[s\] and the place of the source then \[m\].
type Moment = (f64, [f64; 2]);

/// The way of the source, and its pools in the last frames of its arc.
struct Course {
    start: Moment,
    from: Moment,
    to: Moment,
    pools: Vec<Pool>,
    /// Frames of the pools.
    frames: Vec<usize>,
}

impl Course {
    fn read(reader: &Reader, told: &dyn Fn(&str) -> Failure) -> Result<Self, Failure> {
        let until = burns_until(reader)?;
        let times = reader.times(PARTICLES)?;
        let count = times.partition_point(|t| *t <= until);
        let first = (GROWN * count as f64).floor() as usize;
        let torch = torch(reader);
        let (mut pools, mut frames, mut ways, mut sources) = (vec![], vec![], vec![], 0);
        for index in first..count {
            let weld = Weld::read(reader, index)?;
            let source = weld.source.map(Source::place);
            let Some(place) = source.or_else(|| torch.as_ref().map(|t| under(t, weld.time))) else {
                continue;
            };
            sources += 1;
            if let Some(pool) = Pool::of(&weld, place) {
                ways.push((weld.time, place));
                pools.push(pool);
                frames.push(index);
            }
        }
        if sources == 0 {
            return Err(told(
                "has no source that goes straight, and so no pool that could be measured",
            ));
        }
        let (Some(from), Some(to)) = (ways.first(), ways.last().filter(|to| to.0 > ways[0].0))
        else {
            return Err(told(
                "nothing is molten in the last frames of its arc: there is no pool to fit",
            ));
        };
        // The path is that of the whole weld.
        let start = match (Source::at(reader, times[0])?, &torch) {
            (Some(source), _) => (0.0, source.place()),
            (None, Some(torch)) => (torch.path.burns()[0], under(torch, torch.path.burns()[0])),
            (None, None) => *from,
        };
        Ok(Self {
            start,
            from: *from,
            to: *to,
            pools,
            frames,
        })
    }

    /// Metal near the pool in a few of these frames, the first and the last among them.
    fn samples(&self, reader: &Reader, metal: &Metal) -> Result<Vec<Sample>, Failure> {
        let last = self.frames.len() - 1;
        let mut all = Vec::new();
        for k in 0..FRAMES {
            let weld = Weld::read(reader, self.frames[k * last / (FRAMES - 1)])?;
            let seconds = weld.time - self.start.0;
            all.extend(samples(&weld, metal, self.start.1, seconds));
        }
        Ok(all)
    }

    /// Of the source along its path \[m/s\].
    fn speed(&self) -> f64 {
        let way = [0, 1].map(|k| self.to.1[k] - self.start.1[k]);
        way[0].hypot(way[1]) / (self.to.0 - self.start.0)
    }

    /// The torch of these half axes on this way, on a plate whose surface is at the height `top`.
    fn torch(&self, axes: Pool, power_w: f64, top: f64) -> String {
        let place = |at: [f64; 2]| json!([at[0], at[1], top]);
        let speed = self.speed();
        let torch = json!({
            "power_w": power_w,
            "path": {"points_m": [place(self.start.1), place(self.to.1)], "speed_m_s": speed},
            "shape": {"double_ellipsoid": {
                "half_width_m": axes.across,
                "depth_m": axes.depth,
                "front_m": axes.ahead,
                "rear_m": axes.behind,
            }},
        });
        format!("{:#}\n", without_path(torch, speed))
    }
}

/// The torch of the scene, where it has a single one that goes straight.
fn torch(reader: &Reader) -> Option<Torch> {
    let torches = reader.header().scene.get("torches")?.as_array()?;
    let [torch] = torches.as_slice() else {
        return None;
    };
    let torch = Torch::deserialize(torch).ok()?;
    let straight = torch.path.points_m.len() <= 2 && torch.path.weave.is_none();
    straight.then_some(torch)
}

/// Where a torch stands \[m\].
fn under(torch: &Torch, time: f64) -> [f64; 2] {
    let [x, y, _] = torch.stand(time).place;
    [x, y]
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
}
