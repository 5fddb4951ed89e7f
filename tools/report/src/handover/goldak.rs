//! `report goldak`: the double ellipsoid that a weld's pool is, as a torch for `heatsph`, `poolsph` or other programs.
//!
//! Its half axes are those of the pool (Goldak, Chakravarti and Bibby 1984): half of the width, the depth, and the lengths
//! before and behind the source, each the mean over the frames of the last third. Its power is the heat that the metal has taken:
//! what is stored and what has left through open faces, over the same time.

use std::path::Path;
use std::process::ExitCode;

use artefact::Reader;
use run::Failure;
use serde_json::{Value, json};

use crate::files::print;
use crate::mirror::Mirror;
use crate::weld::{PARTICLES, Weld};

/// Part of the frames from which on the pool is taken for grown.
const GROWN: f64 = 2.0 / 3.0;

/// Prints the torch as JSON: an entry of the key `torches`.
pub(crate) fn run(pool: &Path) -> Result<ExitCode, Failure> {
    let reader = Reader::open_sound(pool, "particle-frames", 1)?;
    let told = |what: &str| Failure::Usage(format!("{}: {what}", pool.display()));
    let count = reader.count(PARTICLES);
    let first = (GROWN * count as f64).floor() as usize;
    let (mut pools, mut ways) = (Vec::new(), Vec::new());
    for index in first..count {
        let weld = Weld::read(&reader, index)?;
        let Some(source) = weld.source else { continue };
        ways.push((weld.time, [source.x_m, source.y_m]));
        pools.extend(Pool::of(&weld, [source.x_m, source.y_m]));
    }
    let (Some(from), Some(to)) = (ways.first(), ways.last()) else {
        return Err(told("has no source whose pool could be measured"));
    };
    if pools.is_empty() || to.0 <= from.0 {
        return Err(told(
            "nothing is molten in its last frames: there is no pool to fit",
        ));
    }
    // The path is that of the whole weld.
    let start = match Weld::read(&reader, 0)?.source {
        Some(source) => (0.0, [source.x_m, source.y_m]),
        None => *from,
    };
    let mean = |of: fn(&Pool) -> f64| pools.iter().map(of).sum::<f64>() / pools.len() as f64;
    let power = power(&reader, from.0, to.0)?.ok_or_else(|| told("tells no balance of heat"))?;
    let power = power * Mirror::times(&reader)?;
    let way = [to.1[0] - start.1[0], to.1[1] - start.1[1]];
    let speed = way[0].hypot(way[1]) / (to.0 - start.0);
    let place = |at: [f64; 2]| json!([at[0], at[1], 0.0]);
    let torch = json!({
        "power_w": power,
        "path": {"points_m": [place(start.1), place(to.1)], "speed_m_s": speed},
        "shape": {"double_ellipsoid": {
            "half_width_m": mean(|pool| pool.across),
            "depth_m": mean(|pool| pool.depth),
            "front_m": mean(|pool| pool.ahead),
            "rear_m": mean(|pool| pool.behind),
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
    fn of(weld: &Weld, source: [f64; 2]) -> Option<Self> {
        let top = weld.plate.max_m.map_or(0.0, |corner| corner[2]);
        let half = 0.5 * weld.plate.spacing_m;
        let liquid = (0..weld.position.len()).filter(|i| weld.liquid[*i] && weld.belongs(*i));
        let mut pool: Option<Self> = None;
        for [x, y, z] in liquid.map(|i| weld.position[i]).filter(|x| x[2] < top) {
            let own = Self {
                across: (x - source[0]).abs() + half,
                depth: top - z + half,
                ahead: y - source[1] + half,
                behind: source[1] - y + half,
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
