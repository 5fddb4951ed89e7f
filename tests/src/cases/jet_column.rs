//! `jet-column`: water without sound swings on an elastic bar, at densities from a tenth to ten times that of the bar.

use std::f64::consts::{FRAC_PI_2, TAU};

use artefact::Reader;
use serde_json::{Value, json};

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Lab, LabError};
use crate::solid::fault;

/// Periods that are run.
const PERIODS: f64 = 10.3;
/// Speed of the top at the start over that of sound in the bar.
const SPEED: f64 = 1e-3;
/// Way of sound in the bar in the longest step that contact with the walls allows, in spacings.
const LONGEST: f64 = 0.2;

/// A method: its name, the density of the water over that of the bar, the mass over that of the bar, the step over the longest, and
/// the length of the bar \[m\].
type Way = (&'static str, f64, f64, f64, f64);
/// All methods.
const METHODS: [Way; 8] = [
    ("light", 0.1, 0.5, 1.0, 0.1),
    ("equal", 1.0, 1.0, 1.0, 0.1),
    ("dense", 10.0, 10.0, 1.0, 0.1),
    ("equal-half-step", 1.0, 1.0, 0.5, 0.1),
    ("equal-quarter-step", 1.0, 1.0, 0.25, 0.1),
    ("dense-quarter-step", 10.0, 10.0, 0.25, 0.1),
    ("equal-small", 1.0, 1.0, 1.0, 1e-4),
    ("equal-large", 1.0, 1.0, 1.0, 10.0),
];

/// The case.
pub(super) struct JetColumn;

impl Case for JetColumn {
    fn name(&self) -> &'static str {
        "jet-column"
    }

    fn tool(&self) -> &'static str {
        "jetsph"
    }

    fn reference(&self) -> &'static str {
        "bar with a mass at its end: k L tan(k L) = m_bar/m_water"
    }

    fn methods(&self) -> &'static [&'static str] {
        &[
            "light",
            "equal",
            "dense",
            "equal-half-step",
            "equal-quarter-step",
            "dense-quarter-step",
            "equal-small",
            "equal-large",
        ]
    }

    fn levels(&self, method: &str, asked: &[u32]) -> Vec<u32> {
        // Short steps and other lengths at one resolution.
        let is_plain = !method.contains('-');
        let chosen = asked.iter().copied();
        chosen.filter(|level| is_plain || *level == 2).collect()
    }

    fn targets(&self) -> Vec<Target> {
        let each = METHODS.into_iter().flat_map(|(method, ..)| {
            let levels = if method.contains('-') { 2..=2 } else { 2..=3 };
            levels.flat_map(move |level| {
                [("period", 0.02), ("growth", 1e-3)]
                    .map(|(what, most)| Target::error(what, most).at_level(level).of(method))
            })
        });
        each.collect()
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let found = METHODS.into_iter().find(|(name, ..)| *name == method);
        let (_, density, mass, part, length) = found.unwrap_or(METHODS[1]);
        // 4, 8 and 16 rows.
        let rows = f64::from(2 << level.clamp(1, 4));
        let column = Column::new(length, rows, density, mass);
        let patch = column.patch(lab, self.name(), part)?;
        let run = lab.run("jetsph", self.name(), &format!("{method}-{level}"), &patch)?;
        let reader = Reader::open_kind(&run.artefact, "jet-frames", 1)?;
        let mut momentum = Vec::new();
        for (time, record) in reader.records("/balance")? {
            momentum.push((time, record.get("momentum_y")?));
        }
        let zeros = zeros(&momentum);
        let [first, .., last] = zeros[..] else {
            return Err(fault(&run, "does not swing"));
        };
        let period = 2.0 * (last - first) / (zeros.len() - 1) as f64;
        let most = |from: f64, to: f64| {
            let within = momentum
                .iter()
                .filter(|(time, _)| *time >= from && *time < to);
            within.map(|(_, p)| p.abs()).fold(0.0, f64::max)
        };
        let half = 0.5 * column.period;
        let (early, late) = (most(0.0, half), most(half, f64::INFINITY));
        let kept = most(9.5 * column.period, 10.0 * column.period) / early;
        let errors = Errors::from([
            ("period".to_owned(), (period / column.period - 1.0).abs()),
            ("growth".to_owned(), (late / early - 1.0).max(0.0)),
            ("lost_in_ten_periods".to_owned(), (1.0 - kept).abs()),
        ]);
        let points = reader.frame("/bar", 0)?.len() + reader.frame("/water", 0)?.len();
        Ok(Measurement::of(run, points as u64, column.spacing, errors))
    }
}

/// A bar with water on it.
struct Column {
    /// Length of the bar and spacing \[m\].
    length: f64,
    spacing: f64,
    density: f64,
    /// Height of the water \[m\].
    height: f64,
    /// k of the slowest motion \[1/m\], its period \[s\] and its speed at the top \[m/s\].
    wave_number: f64,
    period: f64,
    speed: f64,
}

/// Density of the bar \[kg/m3\] and its modulus \[Pa\].
const BAR: [f64; 2] = [1000.0, 1e5];

impl Column {
    fn new(length: f64, rows: f64, ratio: f64, mass: f64) -> Self {
        let [density, modulus] = BAR;
        let spacing = length / rows;
        // Whole rows of water.
        let height = (mass * length / ratio / spacing).round().max(1.0) * spacing;
        let wave_number = root(length / (ratio * height)) / length;
        let sound = (modulus / density).sqrt();
        Self {
            length,
            spacing,
            density: ratio * density,
            height,
            wave_number,
            period: TAU / (wave_number * sound),
            speed: SPEED * sound,
        }
    }

    /// The scene begins with the slowest motion, at its greatest speed; a step is a `part` of the longest.
    fn patch(&self, lab: &Lab, case: &str, part: f64) -> Result<Value, LabError> {
        let (length, width) = (self.length, 4.0 * self.spacing);
        let (k, speed) = (self.wave_number, self.speed);
        let at = speed / (k * length).sin();
        let mut patch = crate::solid::changed(lab, case, |solid| {
            solid["spacing_m"] = json!(self.spacing);
            solid["body"] = json!({"box": {"min_m": [0, 0], "max_m": [width, length]}});
            solid["velocity_m_s"] = json!([0, {"expr": format!("{at}*sin({k}*y)")}]);
        })?;
        let body = json!({"box": {"min_m": [0, length], "max_m": [width, length + self.height]}});
        patch["water"] = json!({"spacing_m": self.spacing, "density_kg_m3": self.density,
            "bodies": [{"body": body, "velocity_m_s": [0, speed]}]});
        let wall = |name: &str, x: f64, normal: f64| json!({"name": name, "body": {"half_space": {"point_m": [x, 0], "normal": [normal, 0]}}});
        patch["walls"] = json!([wall("left", 0.0, 1.0), wall("right", width, -1.0)]);
        patch["time"] = json!({"end_s": PERIODS * self.period});
        if part < 1.0 {
            let [density, modulus] = BAR;
            let longest = LONGEST * self.spacing / (modulus / density).sqrt();
            patch["time"]["step_s"] = json!(part * longest);
        }
        patch["output"] = json!({"frames_interval_s": PERIODS * self.period,
            "balance_interval_s": 0.01 * self.period});
        Ok(patch)
    }
}

/// The first x with x tan x = `ratio`.
fn root(ratio: f64) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..200 {
        let middle: f64 = 0.5 * (low + high);
        if middle * middle.tan() < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Times at which a series is zero, between two of its values.
fn zeros(series: &[(f64, f64)]) -> Vec<f64> {
    let pairs = series.windows(2).filter_map(|pair| {
        let [(t, p), (u, q)] = [pair[0], pair[1]];
        (p.signum() != q.signum()).then(|| t + (u - t) * p / (p - q))
    });
    pairs.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_bar_is_a_spring() {
        // omega^2 = E/(L m) of the water: k L = sqrt(m_bar/m_water).
        assert!((root(1e-4) / 1e-2 - 1.0).abs() < 1e-4);
        assert!((root(1e6) / FRAC_PI_2 - 1.0).abs() < 1e-5);
    }
}
