//! Published values and how far the study is from them.
//!
//! A targets file lists measures of the bead, or of the balance of an arc, with their published
//! values. A row with a tolerance is judged, a row without one is shown for comparison only. The bead of an experiment is frozen:
//! while nothing of the weld has frozen, its measures are shown but nothing is judged.

mod check;
mod people;
mod published;

use std::path::Path;

use artefact::Record;
use run::Failure;
use run::scene::{Merged, located};
use serde::Deserialize;

use self::people::people;
use crate::certified::Bands;
use crate::weld::Stretch;

/// Balances of arcs, each with the name of its arc.
pub(crate) type Balances = [(String, Record)];

/// Where a published value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    /// Measured.
    Experiment,
    /// Computed by others.
    Simulation,
}

impl Kind {
    /// The word for people.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Kind::Experiment => "experiment",
            Kind::Simulation => "simulation",
        }
    }
}

/// Which side of the value is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Bound {
    /// Value - tolerance to value + tolerance.
    #[default]
    Within,
    /// Up to value + tolerance.
    AtMost,
    /// From value - tolerance on.
    AtLeast,
}

/// One published value.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Target {
    /// Measure: penetration, fused_width, fused_half_width, reinforcement, bead_width, toe_angle, area_above,
    /// area_below or dilution; or ARC/NAME, a value of the balance of the arc that is called ARC.
    pub(crate) measure: String,
    /// What the measure is called in the source.
    pub(crate) title: String,
    /// Published value.
    pub(crate) value: f64,
    /// Its unit, as the measure has it.
    pub(crate) unit: String,
    /// Where it is published.
    pub(crate) source: String,
    /// Experiment or simulation.
    pub(crate) kind: Kind,
    /// Greatest difference allowed, in the unit; absent: shown, not judged.
    #[serde(default)]
    pub(crate) tolerance: Option<f64>,
    /// Which side is allowed.
    #[serde(default)]
    pub(crate) bound: Bound,
}

/// A targets file.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Targets {
    /// The rows.
    pub(crate) targets: Vec<Target>,
}

impl Targets {
    /// Reads a targets file (kind `targets`, version 1) for arcs with these balances.
    ///
    /// # Errors
    /// When the file cannot be read, is of another kind or version, or does not fit; every target
    /// whose measure is not known, whose unit is not that of the measure, or whose tolerance is negative.
    pub(crate) fn read(path: &Path, arcs: &Balances) -> Result<Self, Failure> {
        let targets: Self = artefact::json_artefact(path, "targets", 1)?;
        let faults = check::faults(&targets, arcs);
        if faults.is_empty() {
            return Ok(targets);
        }
        let places = Merged::read(path)?;
        Err(Failure::Scene(located(faults, &places)))
    }
}

/// What became of a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Inside the tolerance.
    Holds,
    /// Outside the tolerance.
    Missed,
    /// Without a tolerance: for comparison.
    Shown,
    /// Nothing of the weld has frozen yet.
    NotYet,
    /// The measure could not be taken.
    Unknown,
}

/// A target with what was measured.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    /// The target.
    pub(crate) target: Target,
    /// Measured value.
    pub(crate) measured: Option<f64>,
    /// Least and greatest value along the weld.
    pub(crate) range: Option<[f64; 2]>,
    /// What became of it.
    pub(crate) verdict: Verdict,
    /// Half the width of its numerical band, where the study is certified.
    pub(crate) band: Option<f64>,
}

/// Gives rows their numerical bands.
pub(crate) fn with_bands(rows: &mut [Row], bands: &Bands) {
    for row in rows {
        row.band = bands.get(&row.target.measure).copied();
    }
}

/// Compares every target with a stretch of weld, `None` where there is no weld, and with arcs.
pub(crate) fn compare(targets: &Targets, stretch: Option<&Stretch>, arcs: &Balances) -> Vec<Row> {
    let row = |target: &Target| {
        let bead = stretch.and_then(|s| s.get(&target.measure));
        let of_arc = target.measure.split_once('/').and_then(|(arc, name)| {
            let (_, balance) = arcs.iter().find(|(own, _)| own == arc)?;
            balance.get(name).ok()
        });
        let measured = bead.map(|m| m.value).or(of_arc);
        // An arc is as it stays; a bead must have frozen.
        let settled = of_arc.is_some() || stretch.is_some_and(|s| s.frozen);
        Row {
            target: target.clone(),
            measured,
            range: bead.map(|m| m.range),
            verdict: judge(target, measured, settled),
            band: None,
        }
    };
    targets.targets.iter().map(row).collect()
}

fn judge(target: &Target, measured: Option<f64>, settled: bool) -> Verdict {
    let Some(measured) = measured.filter(|m| m.is_finite()) else {
        return Verdict::Unknown;
    };
    let Some(tolerance) = target.tolerance else {
        return Verdict::Shown;
    };
    if !settled {
        return Verdict::NotYet;
    }
    let off = measured - target.value;
    // A trillionth of the value forgives the last bits of decimal numbers.
    let room = tolerance + 1e-12 * target.value.abs();
    let holds = match target.bound {
        Bound::Within => off.abs() <= room,
        Bound::AtMost => off <= room,
        Bound::AtLeast => -off <= room,
    };
    if holds {
        Verdict::Holds
    } else {
        Verdict::Missed
    }
}

impl Row {
    /// The value in the unit for people, without the unit.
    pub(crate) fn shown(&self, value: f64) -> String {
        let (factor, _, digits) = people(&self.target);
        let scaled = factor * value;
        let text = format!("{scaled:.digits$}");
        text.replace('-', "\u{2212}")
    }

    /// A numerical band in the unit for people, with two digits.
    pub(crate) fn fine(&self, half: f64) -> String {
        let (factor, _, digits) = people(&self.target);
        let scaled = factor * half;
        // Two digits that count, and no fewer than the value has.
        let first = 1 - scaled.log10().floor() as i32;
        let digits = digits.max(usize::try_from(first).unwrap_or(0)).min(6);
        format!("{scaled:.digits$}")
    }

    /// What the tolerance has left, below 0 where it is missed; none where nothing is judged.
    fn room(&self) -> Option<f64> {
        let off = self.measured? - self.target.value;
        let tolerance = self.target.tolerance?;
        Some(match self.target.bound {
            Bound::Within => tolerance - off.abs(),
            Bound::AtMost => tolerance - off,
            Bound::AtLeast => tolerance + off,
        })
    }

    /// Whether the numerical band reaches over the edge of the tolerance: another spacing might give another verdict.
    pub(crate) fn is_open(&self) -> bool {
        let reach = self.band.zip(self.room());
        reach.is_some_and(|(band, room)| band > room.abs())
    }

    /// The unit for people.
    pub(crate) fn unit(&self) -> &str {
        people(&self.target).1
    }

    /// Measured less published, with its sign and unit.
    pub(crate) fn difference(&self) -> String {
        match self.measured {
            None => "\u{2013}".to_owned(),
            Some(m) => {
                let off = m - self.target.value;
                let sign = if off >= 0.0 { "+" } else { "" };
                format!("{sign}{} {}", self.shown(off), self.unit())
            }
        }
    }

    /// The tolerance in words.
    pub(crate) fn tolerance(&self) -> String {
        let Some(tolerance) = self.target.tolerance else {
            return "\u{2013}".to_owned();
        };
        let (value, unit) = (self.target.value, self.unit());
        match self.target.bound {
            Bound::Within => format!("\u{b1} {} {unit}", self.shown(tolerance)),
            Bound::AtMost => format!("at most {} {unit}", self.shown(value + tolerance)),
            Bound::AtLeast => format!("at least {} {unit}", self.shown(value - tolerance)),
        }
    }

    /// The verdict in plain words, and whether the target holds where it is judged.
    pub(crate) fn words(&self) -> (String, Option<bool>) {
        match self.verdict {
            Verdict::Holds if self.is_open() => {
                let words = "agrees within the tolerance, but its numerical band reaches beyond";
                (words.to_owned(), None)
            }
            Verdict::Missed if self.is_open() => {
                let words = "misses the tolerance by less than its numerical band";
                (words.to_owned(), None)
            }
            Verdict::Holds => ("agrees within the tolerance".to_owned(), Some(true)),
            Verdict::Missed => {
                let large = self.measured.is_some_and(|m| m > self.target.value);
                let side = if large { "too large" } else { "too small" };
                (format!("misses the tolerance: {side}"), Some(false))
            }
            Verdict::Shown => ("for comparison, not judged".to_owned(), None),
            Verdict::NotYet => (
                "not judged: no part of this weld has frozen yet".to_owned(),
                None,
            ),
            Verdict::Unknown => ("could not be measured".to_owned(), None),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bead::Bead;

    fn target(bound: Bound, tolerance: Option<f64>) -> Target {
        Target {
            measure: "penetration".to_owned(),
            title: "penetration".to_owned(),
            value: 2.9e-3,
            unit: "m".to_owned(),
            source: "somewhere".to_owned(),
            kind: Kind::Experiment,
            tolerance,
            bound,
        }
    }

    fn stretch(depth: f64, frozen: bool) -> Stretch {
        let bead = Bead {
            penetration: depth,
            ..Bead::default()
        };
        Stretch {
            frozen,
            beads: vec![(0.0, bead); 3],
        }
    }

    fn verdict(target: Target, depth: f64, frozen: bool) -> Verdict {
        let targets = Targets {
            targets: vec![target],
        };
        compare(&targets, Some(&stretch(depth, frozen)), &[])[0].verdict
    }

    #[test]
    fn the_tolerance_decides_and_its_end_belongs_to_it() {
        let within = || target(Bound::Within, Some(0.5e-3));
        assert_eq!(verdict(within(), 2.4e-3, true), Verdict::Holds);
        assert_eq!(verdict(within(), 2.39e-3, true), Verdict::Missed);
        assert_eq!(verdict(within(), 3.41e-3, true), Verdict::Missed);
        let most = || target(Bound::AtMost, Some(0.5e-3));
        assert_eq!(verdict(most(), 1e-3, true), Verdict::Holds);
        assert_eq!(verdict(most(), 3.5e-3, true), Verdict::Missed);
        let least = || target(Bound::AtLeast, Some(0.5e-3));
        assert_eq!(verdict(least(), 9e-3, true), Verdict::Holds);
        assert_eq!(verdict(least(), 2.3e-3, true), Verdict::Missed);
    }

    #[test]
    fn what_cannot_be_judged_is_not() {
        assert_eq!(
            verdict(target(Bound::Within, None), 9.0, true),
            Verdict::Shown
        );
        assert_eq!(
            verdict(target(Bound::Within, Some(1.0)), 2.9e-3, false),
            Verdict::NotYet
        );
        let mut unknown = target(Bound::Within, Some(1.0));
        unknown.measure = "beauty".to_owned();
        assert_eq!(verdict(unknown, 2.9e-3, true), Verdict::Unknown);
        let none = compare(
            &Targets {
                targets: vec![target(Bound::Within, Some(1.0))],
            },
            None,
            &[],
        );
        assert_eq!(none[0].verdict, Verdict::Unknown);
    }

    #[test]
    fn a_balance_is_judged_by_the_name_of_its_arc() {
        let mut feed = target(Bound::Within, Some(0.001));
        feed.measure = "dcen/wire_feed_m_s".to_owned();
        feed.unit = "m/s".to_owned();
        feed.value = 1.94 / 60.0;
        let targets = Targets {
            targets: vec![feed],
        };
        let balance = |speed: f64| Record::new().with("wire_feed_m_s", "m/s", speed);
        let arcs = [
            ("dcep".to_owned(), balance(0.02)),
            ("dcen".to_owned(), balance(0.033)),
        ];
        let row = &compare(&targets, None, &arcs)[0];
        assert_eq!(row.verdict, Verdict::Holds);
        assert_eq!(row.difference(), "+0.04 m/min");
        let row = &compare(&targets, None, &arcs[..1])[0];
        assert_eq!(row.verdict, Verdict::Unknown);
    }

    #[test]
    fn gas_moves_by_the_second() {
        let mut jet = target(Bound::Within, Some(100.0));
        jet.measure = "tungsten/fastest_m_s".to_owned();
        jet.unit = "m/s".to_owned();
        jet.value = 300.0;
        let targets = Targets { targets: vec![jet] };
        let balance = Record::new().with("fastest_m_s", "m/s", 323.7);
        let row = &compare(&targets, None, &[("tungsten".to_owned(), balance)])[0];
        assert_eq!(row.difference(), "+24 m/s");
        assert_eq!(row.tolerance(), "\u{b1} 100 m/s");
    }

    #[test]
    fn rows_speak_millimetres() {
        let targets = Targets {
            targets: vec![target(Bound::Within, Some(0.5e-3))],
        };
        let row = &compare(&targets, Some(&stretch(2.2e-3, true)), &[])[0];
        assert_eq!(row.difference(), "\u{2212}0.7 mm");
        assert_eq!(row.tolerance(), "\u{b1} 0.5 mm");
        assert_eq!(row.words().0, "misses the tolerance: too small");
    }

    #[test]
    fn the_targets_of_every_study_can_be_read_and_measured() {
        let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../pipelines");
        let files: Vec<_> = std::fs::read_dir(studies)
            .unwrap()
            .map(|entry| entry.unwrap().path().join("targets.json"))
            .filter(|path| path.is_file())
            .collect();
        assert!(!files.is_empty());
        for path in files {
            let targets = Targets::read(&path, &[]).unwrap();
            for row in compare(&targets, Some(&stretch(2e-3, true)), &[]) {
                // What an arc tells stands in its file.
                let of_arc = row.target.measure.contains('/');
                assert!(
                    of_arc || row.verdict != Verdict::Unknown,
                    "{}",
                    row.target.measure
                );
            }
        }
    }

    #[test]
    fn a_numerical_band_may_leave_a_verdict_open() {
        let targets = Targets {
            targets: vec![target(Bound::Within, Some(0.5e-3))],
        };
        let row = |depth: f64, band: f64| {
            let mut rows = compare(&targets, Some(&stretch(depth, true)), &[]);
            let bands = [("penetration".to_owned(), band)].into();
            with_bands(&mut rows, &bands);
            rows.remove(0)
        };
        // 3.2 mm lies 0.2 mm within 2.9 +- 0.5 mm, 3.5 mm 0.1 mm beyond.
        assert_eq!(row(3.2e-3, 0.1e-3).words().1, Some(true));
        assert_eq!(row(3.2e-3, 0.3e-3).words().1, None);
        assert_eq!(row(3.5e-3, 0.05e-3).words().1, Some(false));
        assert!(
            row(3.5e-3, 0.2e-3)
                .words()
                .0
                .contains("less than its numerical band")
        );
        assert_eq!(row(3.5e-3, 0.2e-3).fine(0.234e-3), "0.23");
    }
}
