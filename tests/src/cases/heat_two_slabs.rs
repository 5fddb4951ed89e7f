//! `heat-two-slabs`: two slabs of different conductivities brought together.

use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::formula::At;
use crate::heat::frames::{Frames, greater, worst};
use crate::heat::methods::{self, TRANSIENT, over};
use crate::heat::property::{at, capacity, fault, number, property};
use crate::heat::slabs::{Half, Slabs};
use crate::lab::{Finished, Lab, LabError};

/// A pair of slabs.
struct Pair {
    name: &'static str,
    /// Conductivity of the left over that of the right; both have the same diffusivity.
    ratio: f64,
    /// \[m2 K/W\].
    resistance: f64,
    /// Where the interface lies after a column of points of the lattice, as a part of the spacing. An error is
    /// the worst of all: points shifted at random know no interface on the lattice, where errors cancel.
    shifts: &'static [f64],
}

const PAIRS: [Pair; 5] = [
    pair("10", 10.0, 0.0, &[0.0, 0.37]),
    pair("1e3", 1e3, 0.0, &[0.0, 0.37]),
    pair("1e6", 1e6, 0.0, &[0.0, 0.37]),
    pair("10-contact", 10.0, 0.3, &[0.5]),
    pair(UNEVEN, 10.0, 0.3, &[0.2]),
];

/// A contact that is not midway between columns: what the cell before it has behind it hangs on the next point,
/// whose own cell it lengthens on one side.
const UNEVEN: &str = "10-contact-uneven";

const fn pair(name: &'static str, ratio: f64, resistance: f64, shifts: &'static [f64]) -> Pair {
    Pair {
        name,
        ratio,
        resistance,
        shifts,
    }
}

/// Points within this many spacings of the interface tell its temperature and flux.
const NEAR: f64 = 5.5;
/// Largest part of the heat that may have come to the far end of a slab.
const REACH: f64 = 1e-6;

/// The case.
pub(super) struct HeatTwoSlabs;

impl Case for HeatTwoSlabs {
    fn name(&self) -> &'static str {
        "heat-two-slabs"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Two half spaces, Carslaw and Jaeger (1959), sections 2.7 and 2.15"
    }

    fn methods(&self) -> &'static [&'static str] {
        TRANSIENT
    }

    fn targets(&self) -> Vec<Target> {
        let pair = |pair: &Pair| {
            let most = if pair.name == UNEVEN { 2e-3 } else { 1e-3 };
            let target = |of| Target::error(format!("{of}_{}", pair.name), most);
            ["interface", "flux"].map(target)
        };
        methods::also_jittered(PAIRS.iter().flat_map(pair).collect(), TRANSIENT)
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 0.1 / f64::from(1 << (level.clamp(1, 6) - 1));
        let mut all = Vec::new();
        let mut errors = Errors::new();
        let mut points = 0;
        for (pair, shift) in PAIRS
            .iter()
            .flat_map(|p| p.shifts.iter().map(move |s| (p, *s)))
        {
            let patch = over(pair.patch(spacing, shift), &methods::patch(method));
            let label = format!("level{level}-{method}-{}-{shift}", pair.name);
            let run = lab.run(self.tool(), self.name(), &label, &patch)?;
            let frames = Frames::read(&run)?;
            for (quantity, error) in pair_errors(&run, &frames, spacing)? {
                let worst = errors.entry(format!("{quantity}_{}", pair.name));
                let worst = worst.or_insert(0.0);
                *worst = greater(*worst, error);
            }
            points = frames.points();
            all.push(run);
        }
        Ok(Measurement::over(all, points, spacing, errors))
    }
}

impl Pair {
    /// The left slab is the good conductor and stores as much more heat, so that both slabs warm to
    /// the same depth.
    fn patch(&self, spacing: f64, shift: f64) -> Value {
        let interface = shift * spacing;
        let contacts = if self.resistance > 0.0 {
            json!([{"between": ["left", "right"], "resistance_m2_k_w": self.resistance}])
        } else {
            json!([])
        };
        json!({
            "points": {"spacing_m": spacing},
            "materials": [
                {"name": "left", "density_kg_m3": self.ratio, "specific_heat_j_kg_k": 1,
                 "conductivity_w_m_k": self.ratio,
                 "region": {"box": {"min_m": [-9, -9], "max_m": [interface, 9]}}},
                {"name": "right", "density_kg_m3": 1, "specific_heat_j_kg_k": 1,
                 "conductivity_w_m_k": 1}
            ],
            "contacts": contacts,
            "initial_temperature_k": {"expr": format!("if({interface} - x, 1, 0)")}
        })
    }
}

/// Errors of the interface's temperatures and flux and of all temperatures, over the difference of
/// both slabs and over the flux.
fn pair_errors(
    run: &Finished,
    frames: &Frames,
    spacing: f64,
) -> Result<Vec<(&'static str, f64)>, LabError> {
    let exact = exact(run)?;
    let [left, right] = exact.half;
    let range = (left.temperature - right.temperature).abs();
    let ends = [
        exact.interface - number(run, "/body/box/min_m/0")?,
        number(run, "/body/box/max_m/0")? - exact.interface,
    ];
    let (mut interface, mut flux, mut linf) = (0.0, 0.0, 0.0);
    for (time, found) in frames.after_start() {
        if exact.reach(ends, time) > REACH {
            let what = format!("at {time} s the heat has reached the far end of a slab");
            return Err(fault(run, what));
        }
        for side in 0..2 {
            // What a parabola makes of the exact profile is not the solver's error.
            let misses = misses(frames, found, &exact, time, side, NEAR * spacing);
            let Some([value, slope]) = parabola(&misses) else {
                return Err(fault(run, "too few points beside the interface".to_owned()));
            };
            interface = greater(interface, value.abs() / range);
            // Across the good conductor the difference is lost in rounding of the poor one's.
            if exact.half[side].conductivity <= exact.half[1 - side].conductivity {
                let miss = exact.half[side].conductivity * slope;
                flux = greater(flux, (miss / exact.flux(time)).abs());
            }
        }
        let off = |p: &[f64; 3]| (p[0] - exact.interface).abs() > 1e-9 * spacing;
        let (places, values): (Vec<[f64; 3]>, Vec<f64>) = frames
            .position
            .iter()
            .zip(found)
            .filter(|(p, _)| off(p))
            .unzip();
        let error = worst(&places, &values, range, |p| exact.temperature(p[0], time));
        linf = greater(linf, error);
    }
    Ok(vec![
        ("interface", interface),
        ("flux", flux),
        ("temperature_linf", linf),
    ])
}

fn exact(run: &Finished) -> Result<Slabs, LabError> {
    let interface = number(run, "/materials/0/region/box/max_m/0")?;
    let start = property(run, "/initial_temperature_k")?;
    let half = |material: usize, end: &str| -> Result<Half, LabError> {
        let far = number(run, &format!("/body/box/{end}/0"))?;
        let place = At::place([far, 0.0, 0.0]);
        Ok(Half {
            conductivity: number(run, &format!("/materials/{material}/conductivity_w_m_k"))?,
            capacity: capacity(run, material)?,
            temperature: start.value(&place),
        })
    };
    let contacts = at(run, "/contacts")?.as_array().map_or(0, Vec::len);
    let resistance = if contacts > 0 {
        number(run, "/contacts/0/resistance_m2_k_w")?
    } else {
        0.0
    };
    Ok(Slabs {
        half: [half(0, "min_m")?, half(1, "max_m")?],
        interface,
        resistance,
    })
}

/// Distances along x from the interface and errors of the points beside it.
fn misses(
    frames: &Frames,
    found: &[f64],
    exact: &Slabs,
    time: f64,
    side: usize,
    reach: f64,
) -> Vec<[f64; 2]> {
    let sign = if side == 0 { -1.0 } else { 1.0 };
    let beside = |d: f64| sign * d > 1e-9 * reach && sign * d < reach;
    let all = frames.position.iter().zip(found);
    let all = all.map(|(p, t)| [p[0] - exact.interface, t - exact.temperature(p[0], time)]);
    all.filter(|[d, _]| beside(*d)).collect()
}

/// Value and slope at 0 of the parabola of least squares through the points; `None` of too few.
fn parabola(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let scale = points.iter().fold(0.0_f64, |m, p| m.max(p[0].abs()));
    let mut moments = [0.0; 5];
    let mut right = [0.0; 3];
    for [d, t] in points {
        let d = d / scale;
        for (n, moment) in moments.iter_mut().enumerate() {
            *moment += d.powi(n as i32);
        }
        for (n, sum) in right.iter_mut().enumerate() {
            *sum += t * d.powi(n as i32);
        }
    }
    let column = |n: usize| [moments[n], moments[n + 1], moments[n + 2]];
    let determinant = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let all = determinant(column(0), column(1), column(2));
    if points.len() < 3 || all.abs() < 1e-9 {
        return None;
    }
    Some([
        determinant(right, column(1), column(2)) / all,
        determinant(column(0), right, column(2)) / (all * scale),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_again() {
        let points: Vec<[f64; 2]> = (1..6)
            .map(|i| 0.01 * f64::from(i))
            .map(|d| [d, 3.0 - 2.0 * d + 7.0 * d * d])
            .collect();
        let [value, slope] = parabola(&points).unwrap();
        assert!((value - 3.0).abs() < 1e-10 && (slope + 2.0).abs() < 1e-8);
        assert!(parabola(&points[..2]).is_none());
    }
}
