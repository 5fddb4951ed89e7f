//! Emissivities and coefficients of heat transfer: factors that have a range, as numbers and as formulas.

use run::Fault;
use run::property::{Arguments, Curve, OutOfRange};

use super::{Condition, Surface};

/// Times at which formulas in t are looked at before a march.
const LOOKS: usize = 64;
/// Part of the greatest value of a factor, or of its range, that is rounding.
const ROUNDED: f64 = 1e-9;

/// A factor of a condition: its key, its unit, its greatest value, and what keeps a formula within its range.
struct Factor<'a> {
    curve: &'a Curve,
    key: &'static str,
    unit: &'static str,
    most: f64,
    kept: &'static str,
}

impl Condition {
    /// Its factor, if it has one.
    fn factor(&self) -> Option<Factor<'_>> {
        match self {
            Self::Convection(curve, _) => Some(Factor {
                curve,
                key: "convection/coefficient_w_m2_k",
                unit: " W/(m2 K)",
                most: f64::INFINITY,
                kept: "at least 0 W/(m2 K); max(0, ...) keeps it there",
            }),
            Self::Radiation(curve, _) => Some(Factor {
                curve,
                key: "radiation/emissivity",
                unit: "",
                most: 1.0,
                kept: "from 0 to 1; min(1, max(0, ...)) keeps it there",
            }),
            Self::Temperature(_) | Self::Flux(_) => None,
        }
    }
}

impl Surface {
    /// The value of the factor of an entry that has one; greatest values at the start tell rounding from a wrong sign.
    ///
    /// # Errors
    /// Where it has no value, or one beyond its range.
    pub(super) fn factor(&self, entry: u32, at: &Arguments) -> Result<f64, OutOfRange> {
        let entry = entry as usize;
        let Some(factor) = self.conditions[entry].factor() else {
            return Ok(0.0);
        };
        let value = factor.curve.value(at)?;
        let usual = self.usual.get(entry).copied().unwrap_or(0.0);
        if value < -ROUNDED * usual || value > factor.most * (1.0 + ROUNDED) {
            return Err(OutOfRange::Formula { value, at: *at });
        }
        Ok(value)
    }

    /// Looks at all factors where they act and at some times until `end` \[s\], and keeps their greatest values.
    pub(super) fn look(&mut self, end: f64) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.usual = vec![0.0; self.conditions.len()];
        for entry in 0..self.conditions.len() {
            let Some(factor) = self.conditions[entry].factor() else {
                continue;
            };
            let varies = factor.curve.depends_on("t");
            let looks = if varies { LOOKS } else { 0 };
            let (mut least, mut most) = (None, None);
            for film in &self.films {
                if !film.entries.contains(&(entry as u32)) {
                    continue;
                }
                for look in 0..=looks {
                    let time = end * look as f64 / looks.max(1) as f64;
                    let at = Arguments::at(film.place, time);
                    // Where it has no value the march says so.
                    let Ok(value) = factor.curve.value(&at) else {
                        continue;
                    };
                    keep(&mut least, value, at, |found, kept| found < kept);
                    keep(&mut most, value, at, |found, kept| found > kept);
                }
                if ["x", "y", "z", "r"]
                    .iter()
                    .all(|name| !factor.curve.depends_on(name))
                {
                    break;
                }
            }
            let (Some((least, low)), Some((most, high))) = (least, most) else {
                continue;
            };
            self.usual[entry] = f64::max(least.abs(), most.abs());
            let above = (most > factor.most * (1.0 + ROUNDED)).then_some((most, high));
            let below = (least < -ROUNDED * self.usual[entry]).then_some((least, low));
            if let Some((value, at)) = below.or(above) {
                let [x, y, z] = [at.x, at.y, at.z];
                let what = format!(
                    "gives {value}{} at x = {x}, y = {y}, z = {z} m, t = {} s, which is out of range: {}",
                    factor.unit, at.time, factor.kept
                );
                faults.push(Fault::at(
                    &format!("/boundaries/{entry}/{}/expr", factor.key),
                    what,
                ));
            }
        }
        faults
    }
}

/// Keeps a value and where it is, if it passes what was kept.
fn keep(
    kept: &mut Option<(f64, Arguments)>,
    value: f64,
    at: Arguments,
    passes: fn(f64, f64) -> bool,
) {
    if kept.is_none_or(|(best, _)| passes(value, best)) {
        *kept = Some((value, at));
    }
}
