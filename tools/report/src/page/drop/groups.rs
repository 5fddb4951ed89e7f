//! Films of drops that meet and part.

use artefact::{Frame, Reader};
use run::Failure;

use crate::draw::canvas::Canvas;
use crate::html::{FRAME_WIDTH, chosen, escape, figure, frames};
use crate::moments;
use crate::page::{encoding, moving};
use crate::picture::drops::{Dot, Window, picture};

/// Channel with a point for each drop.
const GROUPS: &str = "/groups";
/// Most pictures of a film.
const MOST: usize = 60;
/// Rim around what is ever seen, over its width.
const RIM: f64 = 0.06;
/// Radius of a dot over the root of the area that a surface point has.
const DOT: f64 = 0.75;

/// A frame of all drops.
struct Scene {
    time: f64,
    dots: Vec<Dot>,
    radius: f64,
}

/// The films; nothing for runs without groups.
pub(super) fn film(name: &str, reader: &Reader) -> Result<Option<String>, Failure> {
    if !reader.has(GROUPS) {
        return Ok(None);
    }
    let count = reader.count(GROUPS);
    let every = count.div_ceil(MOST).max(1);
    let shown = moments::every(count, every).into_iter();
    let scenes: Vec<Scene> = shown
        .map(|k| Scene::read(reader, k))
        .collect::<Result<_, _>>()?;
    let widest = scenes.iter().map(|s| s.radius).fold(0.0, f64::max);
    let window = window(&scenes);
    let pictures: Vec<Canvas> = scenes
        .iter()
        .map(|scene| {
            let title = format!("{name}: {:.3} ms", 1e3 * scene.time);
            // Parcels without any drop have no points that tell a radius.
            let radius = if scene.radius > 0.0 {
                scene.radius
            } else {
                widest
            };
            picture(window, &scene.dots, radius, &title)
        })
        .collect();
    let words = format!(
        "{name}: drops from the side, a colour for each, numbered anew in each frame; parcels grey"
    );
    let mut body = figure(
        &moving(&pictures, &words)?,
        &escape(&format!("{words}; {} pictures.", pictures.len())),
    );
    let stills: Vec<(String, Canvas)> = chosen(pictures.len())
        .into_iter()
        .map(|k| {
            let time = format!("{:.3} ms", 1e3 * scenes[k].time);
            (time, pictures[k].smaller(FRAME_WIDTH))
        })
        .collect();
    body += &frames(&stills, &words).map_err(|e| encoding(&e))?;
    Ok(Some(body))
}

impl Scene {
    fn read(reader: &Reader, index: usize) -> Result<Self, Failure> {
        let groups = reader.frame(GROUPS, index)?;
        let mut scene = Self {
            time: reader.time(GROUPS, index)?,
            dots: Vec::new(),
            radius: 0.0,
        };
        let shaped = groups.u8("shaped")?;
        let parcels = groups.position_vectors()?.into_iter().zip(shaped);
        let parcels = parcels.filter(|(_, shaped)| **shaped == 0);
        scene.dots.extend(parcels.map(|(x, _)| Dot {
            at: x.map(|c| 1e3 * c),
            drop: None,
        }));
        if !shaped.contains(&1) {
            return Ok(scene);
        }
        // Points of the surface come first in both.
        let surface = at(reader, "/surface", scene.time)?;
        let points = at(reader, "/points", scene.time)?;
        let drops = points.u32("group")?.iter();
        let skin = surface.position_vectors()?.into_iter().zip(drops);
        scene.dots.extend(skin.map(|(x, drop)| Dot {
            at: x.map(|c| 1e3 * c),
            drop: Some(*drop),
        }));
        let areas = surface.f64("area")?;
        let mean = areas.iter().sum::<f64>() / areas.len() as f64;
        scene.radius = 1e3 * DOT * mean.sqrt();
        Ok(scene)
    }
}

/// The last frame of a channel that is no later than a time.
fn at(reader: &Reader, channel: &str, time: f64) -> Result<Frame, Failure> {
    let times = reader.times(channel)?;
    let after = times.partition_point(|t| *t <= time);
    Ok(reader.frame(channel, after.saturating_sub(1))?)
}

/// What holds all dots of all frames.
fn window(scenes: &[Scene]) -> Window {
    let dots = || scenes.iter().flat_map(|s| &s.dots);
    let wide = scenes.iter().map(|s| s.radius).fold(0.0, f64::max);
    let range = |k: usize| {
        let low = dots().map(|d| d.at[k]).fold(f64::INFINITY, f64::min);
        let high = dots().map(|d| d.at[k]).fold(f64::NEG_INFINITY, f64::max);
        let rim = wide + RIM * (high - low);
        [low - rim, high + rim]
    };
    Window {
        x: range(0),
        z: range(2),
    }
}
