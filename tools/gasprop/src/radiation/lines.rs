//! The lines of an atom or ion: those that are known one by one, and the rest in lumps.
//!
//! `data/lines.json` lists the strongest lines; `radiation.lumps` of `data/species.json` holds all lines summed over
//! tenths of an electron-volt of upper energy, in three classes (far ultraviolet; strongly absorbed, from low levels
//! below 400 nm; other). What a lump holds beyond the listed lines of its class and bin is its remainder. It counts as
//! so many equal lines: in the first two classes they end at the ground state, in the last they have the mean photon of
//! the listed lines of that class and bin (of the whole class where the bin has none). Equal lines are absorbed less
//! than unequal ones of the same sum: an upper bound of what leaves.

use std::collections::BTreeMap;

use serde_json::Value;

use super::RadiationError;
use super::width::{Core, resonance};
use crate::constants::{ELECTRON_VOLT, LIGHT_SPEED, PLANCK};

/// A line, or several equal ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Vacuum wavelength, m.
    pub wavelength: f64,
    /// Energy of the lower state above the ground state, J.
    pub lower: f64,
    /// Energy of the upper state, J.
    pub upper: f64,
    /// `g_u A` of one of them, 1/s.
    pub rate: f64,
    /// How many of them there are.
    pub count: f64,
    /// Natural damping, 1/s.
    pub natural: f64,
    /// As [`Core::stark`].
    pub stark: f64,
    /// As [`Core::van_der_waals`].
    pub van_der_waals: f64,
    /// Resonance damping per number density of the ground level, m3/s.
    pub resonance: f64,
}

impl Line {
    /// Power of a line in the upper state's weight, `g_u A h nu` over all of them, W.
    #[must_use]
    pub fn power(&self) -> f64 {
        self.count * self.rate * PLANCK * LIGHT_SPEED / self.wavelength
    }
}

/// All lines of a species.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// The listed lines first, then remainders of lumps.
    pub lines: Vec<Line>,
    /// How many of them are listed one by one.
    pub listed: usize,
}

/// Energies of levels that are equal to this differ by rounding only, eV.
const SAME: f64 = 2e-5;
/// A remainder below this part of its lump is rounding.
const ROUNDING: f64 = 5e-4;
const CLASSES: [&str; 3] = ["vuv", "uvvis_strongly_absorbed", "other"];

struct Listed {
    wavelength: f64,
    lower: f64,
    upper: f64,
    weight: f64,
    rate: f64,
}

impl Listed {
    fn class(&self) -> &'static str {
        if self.wavelength < 200e-9 {
            CLASSES[0]
        } else if self.lower < 0.2 && self.wavelength < 400e-9 {
            CLASSES[1]
        } else {
            CLASSES[2]
        }
    }

    fn power(&self) -> f64 {
        self.weight * self.rate * PLANCK * LIGHT_SPEED / self.wavelength
    }
}

/// Reads the spectrum of species `name`; `None` where the data hold none.
///
/// # Errors
/// What in the data cannot be read.
pub fn spectrum(
    name: &str,
    species: &Value,
    lines: &Value,
) -> Result<Option<Spectrum>, RadiationError> {
    let lumps = &species["radiation"]["lumps"][name];
    let rows = &lines["species"][name]["lines"];
    if lumps.is_null() && rows.is_null() {
        return Ok(None);
    }
    let missing = |what: &str| RadiationError::Data(format!("{what} of {name}"));
    let own = &species["species"][name];
    let number = |key: &str| own[key].as_f64().ok_or_else(|| missing(key));
    let core = Core {
        charge: number("charge")? + 1.0,
        ionisation: number("ionisation_eV")? * ELECTRON_VOLT,
    };
    let ground = own["levels_eV_g"][0][1]
        .as_f64()
        .ok_or_else(|| missing("levels_eV_g"))?;
    let listed = listed(rows).ok_or_else(|| missing("lines"))?;
    let mut spectrum = Spectrum {
        lines: Vec::with_capacity(listed.len()),
        listed: listed.len(),
    };
    let damping = Damping::new(&listed, ground, core.charge < 1.5);
    for line in &listed {
        spectrum.lines.push(Line {
            natural: damping.natural(line),
            resonance: damping.resonance(line),
            ..line_of(
                &core,
                line.lower,
                line.upper,
                line.wavelength,
                line.weight * line.rate,
            )
        });
    }
    remainders(&mut spectrum, &core, &listed, lumps).ok_or_else(|| missing("lumps"))?;
    Ok(Some(spectrum))
}

fn listed(rows: &Value) -> Option<Vec<Listed>> {
    let read = |row: &Value| {
        Some(Listed {
            wavelength: row[0].as_f64()? * 1e-9,
            lower: row[1].as_f64()?,
            upper: row[2].as_f64()?,
            weight: row[3].as_f64()?,
            rate: row[4].as_f64()?,
        })
    };
    rows.as_array()
        .map_or(Some(Vec::new()), |rows| rows.iter().map(read).collect())
}

/// A line between energies in eV, without the damping that depends on other lines.
fn line_of(core: &Core, lower: f64, upper: f64, wavelength: f64, rate: f64) -> Line {
    let (lower, upper) = (lower * ELECTRON_VOLT, upper * ELECTRON_VOLT);
    Line {
        wavelength,
        lower,
        upper,
        rate,
        count: 1.0,
        natural: 0.0,
        stark: core.stark(lower, upper),
        van_der_waals: core.van_der_waals(lower, upper),
        resonance: 0.0,
    }
}

/// What the listed lines of a species say of each other's damping.
struct Damping<'a> {
    lines: &'a [Listed],
    /// Levels linked to the ground level of a neutral atom: energy, damping per number of the ground level.
    linked: Vec<(f64, f64)>,
}

impl<'a> Damping<'a> {
    fn new(lines: &'a [Listed], ground: f64, neutral: bool) -> Self {
        let from_ground = lines.iter().filter(|line| neutral && line.lower < SAME);
        let linked = from_ground.map(|line| {
            let rate = line.weight * line.rate;
            (
                line.upper,
                resonance(line.wavelength, rate, line.weight, ground),
            )
        });
        Self {
            lines,
            linked: linked.collect(),
        }
    }

    fn natural(&self, line: &Listed) -> f64 {
        let ends = |energy: f64| {
            let from = self
                .lines
                .iter()
                .filter(move |l| (l.upper - energy).abs() < SAME);
            from.map(|l| l.rate).sum::<f64>()
        };
        ends(line.upper) + ends(line.lower)
    }

    fn resonance(&self, line: &Listed) -> f64 {
        let touches =
            |energy: f64| (energy - line.upper).abs() < SAME || (energy - line.lower).abs() < SAME;
        self.linked
            .iter()
            .filter(|(energy, _)| touches(*energy))
            .map(|(_, damping)| damping)
            .sum()
    }
}

/// What is listed of a bin or class.
#[derive(Debug, Clone, Copy, Default)]
struct Known {
    /// `sum g_u A h nu`, W.
    power: f64,
    /// `sum g_u A`, 1/s.
    rate: f64,
    lines: f64,
}

impl Known {
    fn add(&mut self, line: &Listed) {
        self.power += line.power();
        self.rate += line.weight * line.rate;
        self.lines += 1.0;
    }
}

/// Adds what the lumps hold beyond the listed lines.
fn remainders(
    spectrum: &mut Spectrum,
    core: &Core,
    listed: &[Listed],
    lumps: &Value,
) -> Option<()> {
    let mut bins: BTreeMap<(&str, i64), Known> = BTreeMap::new();
    let mut other = Known::default();
    for line in listed {
        bins.entry((line.class(), bin(line.upper)))
            .or_default()
            .add(line);
        if line.class() == CLASSES[2] {
            other.add(line);
        }
    }
    for class in CLASSES {
        for entry in lumps[class].as_array().map_or(&[][..], Vec::as_slice) {
            let (energy, power, count) =
                (entry[0].as_f64()?, entry[1].as_f64()?, entry[2].as_f64()?);
            let known = bins.get(&(class, bin(energy))).copied().unwrap_or_default();
            let left = power - known.power;
            if left <= ROUNDING * power {
                continue;
            }
            let highest = energy * ELECTRON_VOLT;
            let photon = match (class == CLASSES[2], known.rate > 0.0, other.rate > 0.0) {
                (true, true, _) => known.power / known.rate,
                (true, false, true) => other.power / other.rate,
                _ => highest,
            };
            let photon = photon.min(highest);
            let count = (count - known.lines).max(1.0);
            let line = line_of(
                core,
                energy - photon / ELECTRON_VOLT,
                energy,
                PLANCK * LIGHT_SPEED / photon,
                left / count / photon,
            );
            spectrum.lines.push(Line { count, ..line });
        }
    }
    Some(())
}

/// Tenths of an electron-volt.
#[allow(clippy::cast_possible_truncation, reason = "energies are below 100 eV")]
fn bin(energy: f64) -> i64 {
    (energy * 10.0).floor() as i64
}
