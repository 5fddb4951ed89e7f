//! What the points of a study tell together.
//!
//! The band of a figure at the base is the sum of the bands of its knobs, since their errors do not cancel by law; what chance
//! does is told apart from it. A point meets a tolerance where its own value, the distance from what the knob tends to and the
//! bands of the other knobs together stay below.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use super::band::{Band, band, scatter};
use super::plan::{Figure, Knob, Plan, Series};
use super::runs::Point;

/// What a user asks of a figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// The figure.
    pub figure: String,
    /// Greatest error, in its unit.
    pub error: f64,
}

impl Tolerance {
    /// From words like `penetration 0.2 mm`; the unit must be that of the figure, or it with a prefix m, u or k.
    ///
    /// # Errors
    /// What does not fit.
    pub fn parse(words: &str, plan: &Plan) -> Result<Self, String> {
        let parts: Vec<&str> = words.split_whitespace().collect();
        let [name, number, unit] = parts[..] else {
            return Err(format!(
                "'{words}' must be a figure, a number and a unit, as in 'penetration 0.2 mm'"
            ));
        };
        let figure = plan.figures.iter().find(|f| f.name == name);
        let figure = figure.ok_or_else(|| {
            let known: Vec<&str> = plan.figures.iter().map(|f| f.name.as_str()).collect();
            format!(
                "there is no figure '{name}'; this study has {}",
                known.join(", ")
            )
        })?;
        let number: f64 = number
            .parse()
            .map_err(|_| format!("'{number}' is no number"))?;
        let scale = [("", 1.0), ("m", 1e-3), ("u", 1e-6), ("k", 1e3), ("c", 1e-2)]
            .iter()
            .find(|(prefix, _)| format!("{prefix}{}", figure.unit) == unit)
            .ok_or_else(|| {
                format!(
                    "'{unit}' is not the unit of {name}, which is {}",
                    figure.unit
                )
            })?
            .1;
        if !(number.is_finite() && number > 0.0) {
            return Err(format!("a tolerance must be above 0, not {number}"));
        }
        Ok(Self {
            figure: name.to_owned(),
            error: scale * number,
        })
    }
}

/// The figure with its band.
#[derive(Debug, Clone, Serialize)]
pub struct Certified {
    /// The stage that it comes from.
    pub stage: String,
    /// Unit.
    pub unit: String,
    /// Value of the study as it is.
    pub value: f64,
    /// What it tends to where every knob is refined; none where no series tells.
    pub extrapolated: Option<f64>,
    /// Half the width of the numerical band about the value; none where a knob could not be judged.
    pub half_width: Option<f64>,
    /// Half the width of the 95 % interval of the mean of runs that differ by chance, and that mean.
    pub scatter: Option<[f64; 2]>,
    /// Band by knob.
    pub knobs: BTreeMap<String, Band>,
    /// Knobs that could not be judged: too few sizes were run.
    pub not_judged: Vec<String>,
}

/// The least run that meets a tolerance.
#[derive(Debug, Clone, Serialize)]
pub struct Least {
    /// Figure.
    pub figure: String,
    /// Tolerance, in its unit.
    pub tolerance: f64,
    /// Name of the point; none where no point meets it.
    pub point: Option<String>,
    /// Its patch.
    pub patch: Value,
    /// What its error is believed to be at most.
    pub error: Option<f64>,
    /// Its run time \[s\].
    pub run_time_s: Option<f64>,
}

/// The record of a study.
#[derive(Debug, Clone, Serialize)]
pub struct Certificate {
    /// `certificate`.
    pub kind: &'static str,
    /// `1.0`.
    pub version: &'static str,
    /// Name of the study.
    pub study: String,
    /// Figures by name.
    pub figures: BTreeMap<String, Certified>,
    /// Every point, run or not.
    pub points: Vec<Point>,
    /// The least run, where a tolerance was asked for.
    pub least: Option<Least>,
}

impl Certificate {
    /// Whether there are figures, and each has a band.
    #[must_use]
    pub fn is_judged(&self) -> bool {
        let has = |figure: &Certified| figure.half_width.is_some_and(f64::is_finite);
        !self.figures.is_empty() && self.figures.values().all(has)
    }
}

/// Puts the record together.
#[must_use]
pub fn conclude(plan: &Plan, points: &[Point], tolerance: Option<&Tolerance>) -> Certificate {
    let figures: BTreeMap<String, Certified> = plan
        .figures
        .iter()
        .filter_map(|f| Some((f.name.clone(), certified(plan, points, f)?)))
        .collect();
    let least = tolerance.and_then(|t| Some(least(plan, points, figures.get(&t.figure)?, t)));
    Certificate {
        kind: "certificate",
        version: "1.0",
        study: plan.study.clone(),
        figures,
        points: points.to_vec(),
        least,
    }
}

/// Sizes and values of a figure along a refined knob, the base among them.
fn series(knob: &Knob, points: &[Point], figure: &str) -> Option<(Vec<f64>, Vec<f64>, f64, f64)> {
    let Series::Refined { base, order, .. } = &knob.series else {
        return None;
    };
    let mut found = vec![(*base, *points.first()?.figures.get(figure)?)];
    for point in points
        .iter()
        .filter(|p| p.knob.as_ref() == Some(&knob.name))
    {
        if let (Some(size), Some(value)) = (point.size, point.figures.get(figure)) {
            found.push((size, *value));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (sizes, values) = found.into_iter().unzip();
    Some((sizes, values, *base, *order))
}

fn certified(plan: &Plan, points: &[Point], figure: &Figure) -> Option<Certified> {
    let Figure {
        name: figure,
        unit,
        stage,
        ..
    } = figure;
    let value = *points.first()?.figures.get(figure)?;
    let mut knobs = BTreeMap::new();
    let mut not_judged = Vec::new();
    let mut by_chance = vec![value];
    for knob in &plan.knobs {
        if let Some((sizes, values, base, order)) = series(knob, points, figure) {
            match band(&sizes, &values, base, order) {
                Some(band) => {
                    knobs.insert(knob.name.clone(), band);
                }
                // What a knob does not reach is the same by its making, not by chance.
                None if !plan.reaches(&knob.stage, stage) && sizes.len() > 1 => {
                    knobs.insert(knob.name.clone(), Band::none_about(value));
                }
                None => not_judged.push(knob.name.clone()),
            }
        } else {
            let own = points
                .iter()
                .filter(|p| p.knob.as_ref() == Some(&knob.name));
            by_chance.extend(own.filter_map(|p| p.figures.get(figure)));
        }
    }
    let (mean, spread) = scatter(&by_chance);
    let refined: Vec<&Band> = knobs.values().collect();
    let judged = !refined.is_empty();
    Some(Certified {
        stage: stage.clone(),
        unit: unit.clone(),
        value,
        extrapolated: judged
            .then(|| value + refined.iter().map(|b| b.extrapolated - value).sum::<f64>()),
        half_width: (judged && not_judged.is_empty())
            .then(|| refined.iter().map(|b| b.half_width).sum()),
        scatter: spread.map(|half| [half, mean]),
        knobs,
        not_judged,
    })
}

/// The quickest point that has the figure and warned of nothing, whose error is within the tolerance.
fn least(plan: &Plan, points: &[Point], figure: &Certified, tolerance: &Tolerance) -> Least {
    let mut best = Least {
        figure: tolerance.figure.clone(),
        tolerance: tolerance.error,
        point: None,
        patch: Value::Null,
        error: None,
        run_time_s: None,
    };
    for point in points {
        let Some(time) = point.run_time_s else {
            continue;
        };
        if !point.figures.contains_key(&tolerance.figure) || !point.warnings.is_empty() {
            continue;
        }
        let Some(error) = error_of(plan, points, figure, point, &tolerance.figure) else {
            continue;
        };
        let quicker = best.run_time_s.is_none_or(|t| time < t);
        if error <= tolerance.error && quicker {
            best.point = Some(point.name.clone());
            best.patch = point.patch.clone();
            best.error = Some(error);
            best.run_time_s = Some(time);
        }
    }
    best
}

/// What the error of a point is believed to be at most: the band of its own knob at its own size, and those of the others.
fn error_of(
    plan: &Plan,
    points: &[Point],
    figure: &Certified,
    point: &Point,
    name: &str,
) -> Option<f64> {
    if !figure.not_judged.is_empty() || figure.knobs.is_empty() {
        return None;
    }
    let chance = figure.scatter.map_or(0.0, |[half, _]| half);
    let mut error = chance;
    for (knob, base) in &figure.knobs {
        let own = point.knob.as_ref() == Some(knob);
        error += match point.size {
            Some(size) if own => {
                let knob = plan.knobs.iter().find(|k| &k.name == knob)?;
                let (sizes, values, _, order) = series(knob, points, name)?;
                band(&sizes, &values, size, order)?.half_width
            }
            _ => base.half_width,
        };
    }
    Some(error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn plan() -> Plan {
        serde_json::from_value(json!({
            "kind": "certify", "version": "1.0", "study": "made-up",
            "stages": [{"name": "pool", "tool": "poolsph", "scene": "pool.json"}],
            "figures": [{"name": "depth", "unit": "m", "stage": "pool", "from": {"bead": "penetration"}}],
            "knobs": [
                {"name": "spacing", "stage": "pool", "series": {"refined": {"order": 2, "unit": "m", "base": 0.2, "points": [
                    {"size": 0.4, "patch": {"spacing_m": 0.4}}, {"size": 0.1, "patch": {"spacing_m": 0.1}}]}}},
                {"name": "start", "stage": "pool", "series": {"varied": {"patches": [{}, {}]}}}
            ]
        }))
        .unwrap()
    }

    fn point(name: &str, knob: Option<&str>, size: Option<f64>, depth: f64, time: f64) -> Point {
        Point {
            name: name.to_owned(),
            knob: knob.map(str::to_owned),
            size,
            patch: Value::Null,
            figures: [("depth".to_owned(), depth)].into(),
            run_time_s: Some(time),
            processor_s: None,
            peak_memory_bytes: None,
            points: None,
            missing: None,
            warnings: Vec::new(),
            scenes: BTreeMap::new(),
            frozen: BTreeMap::new(),
        }
    }

    fn points() -> Vec<Point> {
        let depth = |h: f64| 3.0 + h * h;
        vec![
            point("base", None, None, depth(0.2), 10.0),
            point("spacing-0.4", Some("spacing"), Some(0.4), depth(0.4), 1.0),
            point("spacing-0.1", Some("spacing"), Some(0.1), depth(0.1), 80.0),
            point("start-1", Some("start"), None, depth(0.2) + 0.001, 10.0),
            point("start-2", Some("start"), None, depth(0.2) - 0.001, 10.0),
        ]
    }

    #[test]
    fn a_figure_is_told_with_its_band_and_chance_apart() {
        let plan = plan();
        plan.check().unwrap();
        let told = conclude(&plan, &points(), None);
        let depth = &told.figures["depth"];
        assert!((depth.extrapolated.unwrap() - 3.0).abs() < 1e-4);
        assert!((depth.half_width.unwrap() - 1.25 * 0.04).abs() < 1e-3);
        let [half, mean] = depth.scatter.unwrap();
        assert!((mean - 3.04).abs() < 1e-12 && half > 1e-3 && half < 4e-3);
    }

    #[test]
    fn the_least_run_that_meets_a_tolerance_is_named() {
        let plan = plan();
        let least = |words: &str| {
            let tolerance = Tolerance::parse(words, &plan).unwrap();
            conclude(&plan, &points(), Some(&tolerance))
                .least
                .unwrap()
                .point
        };
        assert_eq!(least("depth 300 mm").as_deref(), Some("spacing-0.4"));
        assert_eq!(least("depth 0.06 m").as_deref(), Some("base"));
        assert_eq!(least("depth 0.02 m").as_deref(), Some("spacing-0.1"));
        assert_eq!(least("depth 1 um"), None);
        assert!(
            Tolerance::parse("width 1 mm", &plan)
                .unwrap_err()
                .contains("depth")
        );
        assert!(Tolerance::parse("depth 1 K", &plan).is_err());
    }

    #[test]
    fn a_run_without_the_figure_or_with_warnings_is_not_the_least() {
        let plan = plan();
        let tolerance = Tolerance::parse("depth 300 mm", &plan).unwrap();
        let least = |points: &[Point]| {
            conclude(&plan, points, Some(&tolerance))
                .least
                .unwrap()
                .point
        };
        let mut points = points();
        points.push(point("start-3", Some("start"), None, 0.0, 0.1));
        points[5].figures.clear();
        assert_eq!(least(&points).as_deref(), Some("spacing-0.4"));
        points[1]
            .warnings
            .push("pool: has not converged".to_owned());
        assert_eq!(least(&points).as_deref(), Some("base"));
    }

    #[test]
    fn a_figure_is_judged_where_it_has_a_band() {
        let plan = plan();
        let told = conclude(&plan, &points(), None);
        assert!(told.is_judged());
        let by_chance_alone = Plan {
            knobs: vec![plan.knobs[1].clone()],
            ..plan.clone()
        };
        let told = conclude(&by_chance_alone, &points(), None);
        assert!(told.figures["depth"].not_judged.is_empty() && !told.is_judged());
        assert!(!conclude(&plan, &points()[..1], None).is_judged());
    }

    #[test]
    fn a_knob_with_one_size_is_not_judged() {
        let points = &points()[..1];
        let depth = &conclude(&plan(), points, None).figures["depth"];
        assert_eq!(depth.not_judged, ["spacing"]);
        assert!(depth.half_width.is_none());
    }
}
