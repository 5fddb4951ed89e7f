//! `heat-shock-disc`: the layered disc of Rong and Kisu (2010), section 3, cooled from above.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::disc::{Disc, Fineness, Layer, temperatures};
use crate::heat::formula::At;
use crate::heat::frames::{Frames, greater};
use crate::heat::methods::{self, TRANSIENT, over};
use crate::heat::property::{Property, at, capacity, conductivity, fault, number, property};
use crate::lab::{Finished, Lab, LabError};

/// Temperatures at the start \[K\].
const STARTS: [f64; 3] = [1023.0, 1073.0, 1123.0];

/// The case.
pub(super) struct HeatShockDisc;

impl Case for HeatShockDisc {
    fn name(&self) -> &'static str {
        "heat-shock-disc"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Fine finite volumes in r and z, extrapolated, with the scene's h(r)"
    }

    fn methods(&self) -> &'static [&'static str] {
        TRANSIENT
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        // Level 3 is left to the first method.
        let most = if method == TRANSIENT[0] { 3 } else { 2 };
        asked.iter().copied().filter(|l| *l <= most).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let target =
            |start: &f64| Target::error(format!("temperature_linf_{start}k"), 3e-3).at_level(2);
        // The first start stands for all where points are shifted.
        let first = methods::also_jittered(STARTS[..1].iter().map(target).collect(), TRANSIENT);
        let others = STARTS[1..].iter().map(target);
        first.into_iter().chain(others).collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 1e-3 / f64::from(1 << (level.clamp(1, 4) - 1));
        let mut all = Vec::new();
        let mut errors = Errors::new();
        let mut points = 0;
        // Only the first method is asked for every start, and not where a run takes minutes.
        let every = method == TRANSIENT[0] && level <= 2;
        let count = if every { STARTS.len() } else { 1 };
        for start in STARTS.iter().take(count) {
            let patch = over(
                json!({"points": {"spacing_m": spacing}, "initial_temperature_k": start}),
                &methods::patch(method),
            );
            let label = format!("level{level}-{method}-{start}k");
            let run = lab.run(self.tool(), self.name(), &label, &patch)?;
            let frames = Frames::read(&run)?;
            let (whole, moment) = error(&run, &frames)?;
            errors.insert(format!("temperature_linf_{start}k"), whole);
            errors.insert(format!("of_the_moment_{start}k"), moment);
            points = frames.points();
            all.push(run);
        }
        Ok(Measurement::over(all, points, spacing, errors))
    }
}

/// Largest error over the largest drop of the whole run, and over that of the same moment.
fn error(run: &Finished, frames: &Frames) -> Result<(f64, f64), LabError> {
    let disc = disc(run)?;
    let places: Vec<[f64; 2]> = frames
        .position
        .iter()
        .map(|p| [p[0].hypot(p[1]).min(disc.radius), p[2]])
        .collect();
    let exact = temperatures(&disc, &frames.later(), &places, Fineness::FINE);
    let exact = exact.ok_or_else(|| fault(run, "the reference cannot be marched".to_owned()))?;
    let (mut worst, mut of_moment, mut drop) = (0.0, 0.0, 0.0_f64);
    for ((_, found), wanted) in frames.after_start().zip(&exact) {
        let falls = wanted.iter().map(|t| (disc.start - t).abs());
        let fall = falls.fold(0.0, f64::max);
        let misses = found.iter().zip(wanted).map(|(f, w)| (f - w).abs());
        let miss = misses.fold(0.0, greater);
        worst = greater(worst, miss);
        of_moment = greater(of_moment, miss / fall);
        drop = drop.max(fall);
    }
    Ok((worst / drop, of_moment))
}

/// The disc of a scene: a cylinder along z about the axis, layers from above, convection on `top`
/// and `side`.
fn disc(run: &Finished) -> Result<Disc, LabError> {
    let length = number(run, "/body/cylinder/length_m")?;
    let bottom = number(run, "/body/cylinder/centre_m/2")? - 0.5 * length;
    let top = bottom + length;
    let mut border = top;
    let mut layers = Vec::new();
    let materials = at(run, "/materials")?.as_array().map_or(0, Vec::len);
    for material in 0..materials {
        let region = format!("/materials/{material}/region/box/min_m/2");
        let low = match run.scene.pointer(&region) {
            Some(_) => number(run, &region)?.max(bottom),
            None => bottom,
        };
        if low < border {
            layers.push(Layer {
                thickness: border - low,
                conductivity: conductivity(run, material)?,
                capacity: capacity(run, material)?,
            });
            border = low;
        }
    }
    layers.reverse();
    let (ambient, film) = films(run)?;
    Ok(Disc {
        radius: number(run, "/body/cylinder/radius_m")?,
        bottom,
        layers,
        film,
        ambient,
        start: number(run, "/initial_temperature_k")?,
    })
}

/// The surroundings, and the films on the upper face and on the side.
fn films(run: &Finished) -> Result<(f64, [Property; 2]), LabError> {
    let none = || Property::read(&Value::from(0.0)).map_err(|what| fault(run, what));
    let mut found = [none()?, none()?];
    let mut ambient = f64::NAN;
    let boundaries = at(run, "/boundaries")?.as_array().map_or(0, Vec::len);
    for i in 0..boundaries {
        let pointer = format!("/boundaries/{i}/convection");
        let film = property(run, &format!("{pointer}/coefficient_w_m2_k"))?;
        ambient = number(run, &format!("{pointer}/ambient_k"))?;
        let steady = [(0.0, 300.0), (9.0, 1100.0)].map(|(time, temperature)| {
            film.value(&At {
                time,
                temperature,
                ..At::place([0.004, 0.003, 0.001])
            })
        });
        if (steady[0] - steady[1]).abs() > 0.0 {
            return Err(fault(run, format!("{pointer} must depend on place alone")));
        }
        for face in at(run, &format!("/boundaries/{i}/on"))?
            .as_array()
            .into_iter()
            .flatten()
        {
            match face.as_str() {
                Some("top") => found[0] = film.clone(),
                Some("side") => found[1] = film.clone(),
                _ => {
                    return Err(fault(
                        run,
                        "only top and side may be cooled here".to_owned(),
                    ));
                }
            }
        }
    }
    Ok((ambient, found))
}
