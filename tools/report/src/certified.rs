//! Figures of studies with their numerical bands: error against run time of the study itself.

use std::collections::BTreeMap;
use std::path::Path;

use run::Failure;
use serde::Deserialize;

use crate::html::{Rows, escape, figure, note, paragraph, side_by_side};
use crate::plot::{Line, Plot};
use crate::records::{bytes, figure as digits};

/// What `make certify STUDY=name` writes.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Certificate {
    study: String,
    figures: BTreeMap<String, Certified>,
    points: Vec<Point>,
}

/// What `make certify` writes of problems with exact answers.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Proof {
    judged: u64,
    held: u64,
}

/// A scene that was run: the name of its run, and its hash.
pub(crate) type Ran = (String, String);

/// Half widths of numerical bands by measure.
pub(crate) type Bands = BTreeMap<String, f64>;

/// A figure with its band.
#[derive(Debug, Clone, Deserialize)]
struct Certified {
    #[serde(default)]
    stage: String,
    unit: String,
    value: f64,
    extrapolated: Option<f64>,
    half_width: Option<f64>,
    scatter: Option<[f64; 2]>,
    knobs: BTreeMap<String, Band>,
    not_judged: Vec<String>,
}

/// What a knob tells of a figure.
#[derive(Debug, Clone, Deserialize)]
struct Band {
    order: Option<f64>,
    extrapolated: f64,
    half_width: f64,
    trusted: bool,
}

/// A run of the study.
#[derive(Debug, Clone, Deserialize)]
struct Point {
    name: String,
    knob: Option<String>,
    size: Option<f64>,
    figures: BTreeMap<String, f64>,
    run_time_s: Option<f64>,
    #[serde(default)]
    processor_s: Option<f64>,
    peak_memory_bytes: Option<u64>,
    missing: Option<String>,
    #[serde(default)]
    warnings: Vec<String>,
    #[serde(default)]
    scenes: BTreeMap<String, String>,
}

impl Certificate {
    /// Reads the certificate of a study (kind `certificate`, version 1).
    ///
    /// # Errors
    /// When the file cannot be read or is of another kind or version.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        Ok(artefact::json_artefact(path, "certificate", 1)?)
    }

    /// What a figure may be off, by numbers and by chance, where its scene is among those that ran: under its name, and under
    /// NAME/figure with the name of the run.
    pub(crate) fn bands(&self, ran: &[Ran]) -> Bands {
        let mut bands = Bands::new();
        for (figure, told) in &self.figures {
            let hash = self.hash(&told.stage);
            let own = ran.iter().find(|(_, other)| Some(other) == hash);
            if let (Some((run, _)), Some(half)) = (own, told.half_width) {
                let whole = half + told.scatter.map_or(0.0, |[by_chance, _]| by_chance);
                bands.insert(figure.clone(), whole);
                bands.insert(format!("{run}/{figure}"), whole);
            }
        }
        bands
    }

    /// Whether it has a band for a measure of a bead, or for NAME/figure of the stage NAME.
    pub(crate) fn tells(&self, measure: &str) -> bool {
        let (stage, figure) = match measure.split_once('/') {
            Some((stage, figure)) => (Some(stage), figure),
            None => (None, measure),
        };
        let told = self.figures.get(figure);
        told.is_some_and(|told| told.half_width.is_some() && stage.is_none_or(|s| s == told.stage))
    }

    /// The study that it belongs to.
    pub(crate) fn study(&self) -> &str {
        &self.study
    }

    /// The hash of the scene of a stage, as the study has it.
    fn hash(&self, stage: &str) -> Option<&String> {
        let base = self.points.iter().find(|p| p.knob.is_none())?;
        base.scenes.get(stage)
    }

    /// The part of a study's page, which says where what is shown is not what was certified.
    pub(crate) fn of_study(&self, ran: &[Ran]) -> String {
        let base = self.points.iter().filter(|p| p.knob.is_none());
        let stages = base.flat_map(|p| &p.scenes);
        let strange = stages.filter(|(_, hash)| ran.iter().all(|(_, own)| own != *hash));
        let names: Vec<&str> = strange.map(|(stage, _)| stage.as_str()).collect();
        let mut out = String::new();
        if !names.is_empty() {
            out += &note(&format!(
                "These bands were found with other scenes than those of this page ({}): `make certify STUDY={}` finds them anew.",
                names.join(", "),
                self.study
            ));
        }
        out + &told(self)
    }
}

/// How often the truth lay in the band.
pub(crate) fn proved(proof: &Proof) -> String {
    paragraph(&format!(
        "On problems with exact answers the truth lies in {} of {} bands.",
        proof.held, proof.judged
    ))
}

/// Figures with bands, error over run time by knob, and every run.
pub(crate) fn section(certificate: &Certificate) -> String {
    let name = escape(&certificate.study);
    format!("<h3 id=\"certified-{name}\">{name}</h3>\n") + &told(certificate)
}

fn told(certificate: &Certificate) -> String {
    let mut out = figures(certificate);
    let plots: Vec<String> = certificate
        .figures
        .iter()
        .filter_map(|(name, told)| plot(name, told, &certificate.points))
        .collect();
    out += &side_by_side(&plots);
    out += &runs(&certificate.points);
    for point in &certificate.points {
        if let Some(why) = &point.missing {
            out += &note(&format!("{} was not run: {why}", point.name));
        }
        for warning in &point.warnings {
            out += &note(&format!("{}, {warning}", point.name));
        }
    }
    out
}

fn figures(certificate: &Certificate) -> String {
    let mut table = Rows::new(&[
        "Figure",
        "#Value",
        "#Numerical band",
        "#Tends to",
        "#By chance",
        "Unit",
        "By knob",
    ]);
    let dash = || "\u{2013}".to_owned();
    let half = |value: f64| format!("\u{b1} {}", digits(value));
    for (name, told) in &certificate.figures {
        let knob = |(name, band): (&String, &Band)| {
            let order = band
                .order
                .map_or("order assumed".to_owned(), |p| format!("order {p:.1}"));
            let trust = if band.trusted {
                ""
            } else {
                ", does not approach it as its order says"
            };
            format!("{name} {} ({order}{trust})", half(band.half_width))
        };
        let mut knobs: Vec<String> = told.knobs.iter().map(knob).collect();
        knobs.extend(
            told.not_judged
                .iter()
                .map(|k| format!("{k}: not judged, its sizes were not run")),
        );
        table.row([
            escape(&title(name, &told.unit)),
            digits(told.value),
            told.half_width.map_or("not judged".to_owned(), half),
            told.extrapolated.map_or_else(dash, digits),
            told.scatter.map_or_else(dash, |[h, _]| half(h)),
            escape(&told.unit),
            escape(&knobs.join("; ")),
        ]);
    }
    table.render()
}

/// A name for people: without underscores, and without the unit that stands beside it.
fn title(name: &str, unit: &str) -> String {
    let ending = format!("_{}", unit.to_lowercase().replace(['/', ' '], "_"));
    name.strip_suffix(&ending).unwrap_or(name).replace('_', " ")
}

/// Distance of each run from what its knob tends to, over its time; nothing where no knob was refined.
fn plot(name: &str, told: &Certified, points: &[Point]) -> Option<String> {
    let title = format!("error of {} [{}]", title(name, &told.unit), told.unit);
    // Other work on the machine hardly changes the time of processors.
    let ran = || points.iter().filter(|p| p.missing.is_none());
    let told_by_processors = ran().all(|p| p.processor_s.is_some());
    let (axis, time): (_, fn(&Point) -> Option<f64>) = match told_by_processors {
        true => ("processor time [s]", |p| p.processor_s),
        false => ("run time [s]", |p| p.run_time_s),
    };
    let mut plot = Plot::new(axis, &title).log_log();
    for (knob, band) in &told.knobs {
        let base = |p: &&Point| p.knob.is_none();
        let own = |p: &&Point| p.knob.as_ref() == Some(knob) && p.size.is_some();
        let at = |p: &Point| {
            let value = p.figures.get(name)?;
            Some([time(p)?, (value - band.extrapolated).abs()])
        };
        let chosen = points.iter().filter(|p| base(p) || own(p));
        let mut shown: Vec<[f64; 2]> = chosen.filter_map(at).collect();
        shown.sort_by(|a, b| a[0].total_cmp(&b[0]));
        plot.add(Line::new(knob, shown).marked());
    }
    (!plot.is_empty()).then(|| {
        let caption = "Distance from what each knob tends to, over the time of the run.";
        figure(&plot.html(), caption)
    })
}

fn runs(points: &[Point]) -> String {
    let mut table = Rows::new(&[
        "Run",
        "#Size",
        "#Run time",
        "#Processor time",
        "#Peak memory",
    ]);
    let dash = || "\u{2013}".to_owned();
    let seconds = |s: f64| format!("{} s", digits(s));
    for point in points.iter().filter(|p| p.missing.is_none()) {
        table.row([
            escape(&point.name),
            point.size.map_or_else(dash, digits),
            point.run_time_s.map_or_else(dash, seconds),
            point.processor_s.map_or_else(dash, seconds),
            point.peak_memory_bytes.map_or_else(dash, bytes),
        ]);
    }
    table.render()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn certificate() -> Certificate {
        let point = |name: &str, knob: Option<&str>, size: f64, value: f64, seconds: f64| {
            serde_json::json!({"name": name, "knob": knob, "size": size, "patch": {},
                "figures": {"depth": value}, "run_time_s": seconds, "peak_memory_bytes": 1000, "missing": null,
                "scenes": {"pool": "abc"}})
        };
        let missing = serde_json::json!({"name": "spacing 3", "knob": "spacing", "size": 0.25, "patch": {},
            "figures": {}, "run_time_s": null, "peak_memory_bytes": null, "missing": "over the budget"});
        serde_json::from_value(serde_json::json!({"kind": "certificate", "version": "1.0", "study": "weld",
            "figures": {"depth": {"stage": "pool", "unit": "m", "value": 3.8, "extrapolated": 4.0, "half_width": 0.25,
                "scatter": null, "not_judged": ["step"], "knobs": {"spacing": {"order": 1.0,
                    "extrapolated": 4.0, "half_width": 0.25, "trusted": false}}}},
            "points": [point("base", None, 1.0, 3.8, 8.0), point("spacing 1", Some("spacing"), 2.0, 3.6, 1.0), missing]}))
        .unwrap()
    }

    #[test]
    fn a_figure_stands_with_its_band_and_error_over_run_time() {
        let html = section(&certificate());
        for told in [
            "\u{b1} 0.25",
            "order 1.0",
            "does not approach",
            "step: not judged",
            "over the budget",
        ] {
            assert!(html.contains(told), "{told} in {html}");
        }
        assert!(html.contains("<svg") && html.contains("error of depth [m]"));
    }

    #[test]
    fn names_leave_their_unit_to_its_column() {
        assert_eq!(title("base_total_w", "W"), "base total");
        assert_eq!(title("wire_feed_m_s", "m/s"), "wire feed");
        assert_eq!(title("penetration", "m"), "penetration");
    }

    #[test]
    fn bands_belong_to_the_scenes_that_were_certified() {
        let ran = |hash: &str| [("weld".to_owned(), hash.to_owned())];
        let own = certificate();
        let bands = own.bands(&ran("abc"));
        assert_eq!(bands.get("depth"), Some(&0.25));
        assert_eq!(bands.get("weld/depth"), Some(&0.25));
        assert!(own.bands(&ran("other")).is_empty());
        assert!(
            own.of_study(&ran("other"))
                .contains("other scenes than those of this page (pool)")
        );
        assert!(!own.of_study(&ran("abc")).contains("other scenes"));
    }

    #[test]
    fn a_study_whose_knobs_were_not_run_has_no_plot() {
        let mut bare = certificate();
        bare.figures.values_mut().for_each(|f| f.knobs.clear());
        assert!(!section(&bare).contains("<svg"));
    }
}
