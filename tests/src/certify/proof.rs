//! Certificates of problems whose answers are exact: how often does the true value lie in the band?
//!
//! Plates, blocks and cylinders of heat, and spheres in electric fields, each with other parameters, are certified as a study
//! would be, by the same code on the same kinds of artefact. A band is worth its name where at least nine in ten hold the truth.

use std::path::PathBuf;
use std::time::Duration;

use serde::Serialize;
use serde_json::{Value, json};

use super::plan::Plan;
use super::{certify, verdict::Certified};
use crate::heat::cylinder::Cylinder;
use crate::lab::{Lab, LabError};

/// A figure with its band beside the truth.
#[derive(Debug, Clone, Serialize)]
pub struct Answer {
    /// Problem and its parameter.
    pub problem: String,
    /// Figure.
    pub figure: String,
    /// Exact value.
    pub exact: f64,
    /// What was certified.
    pub certified: Certified,
    /// Whether the exact value lies in the band.
    pub held: bool,
}

/// All answers together.
#[derive(Debug, Clone, Serialize)]
pub struct Proof {
    /// `certificate-proof`.
    pub kind: &'static str,
    /// Figures that were judged.
    pub judged: usize,
    /// Of these, how many hold the truth.
    pub held: usize,
    /// Each of them.
    pub answers: Vec<Answer>,
    /// Figures without a value or a band.
    pub lost: Vec<String>,
    /// Median of half the width of a band over the exact value.
    pub width: f64,
}

impl Proof {
    /// Whether every figure has a band, nine in ten bands hold the truth, and bands are no wider than they must be.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.lost.is_empty()
            && self.judged > 0
            && 10 * self.held >= 9 * self.judged
            && self.width <= WIDEST
    }
}

/// Greatest median of half the width of a band over the exact value: any band would hold the truth if it were wide enough. The errors
/// themselves are no measure, as some of these problems are solved to the last bits.
const WIDEST: f64 = 0.01;

/// Median of half the width over the exact value.
fn width(answers: &[Answer]) -> f64 {
    let of = |a: &Answer| a.certified.half_width.unwrap_or(f64::NAN) / a.exact.abs();
    let mut all: Vec<f64> = answers.iter().map(of).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
}

/// A problem with exact answers: a plan, a patch of its parameters, the figures' exact values.
struct Problem {
    plan: Value,
    parameters: Value,
    exact: Vec<(&'static str, f64)>,
}

/// Certifies every problem.
///
/// # Errors
/// When a program fails.
pub fn prove(lab: &Lab) -> Result<Proof, LabError> {
    let (mut answers, mut lost) = (Vec::new(), Vec::new());
    for problem in problems() {
        let plan = problem.plan(lab)?;
        let told = certify(lab, &plan, Duration::from_secs(600), None)?;
        for (figure, exact) in problem.exact {
            let certified = told.figures.get(figure);
            let Some((certified, half)) = certified.and_then(|c| Some((c, c.half_width?))) else {
                lost.push(format!("{} {figure}", plan.study));
                continue;
            };
            answers.push(Answer {
                problem: plan.study.clone(),
                figure: figure.to_owned(),
                exact,
                held: (certified.value - exact).abs() <= half,
                certified: certified.clone(),
            });
        }
    }
    Ok(Proof {
        kind: "certificate-proof",
        judged: answers.len(),
        held: answers.iter().filter(|a| a.held).count(),
        width: width(&answers),
        answers,
        lost,
    })
}

impl Problem {
    /// The plan, with the patch of its parameters in a file.
    fn plan(&self, lab: &Lab) -> Result<Plan, LabError> {
        let name = self.plan["study"].as_str().unwrap_or("problem").to_owned();
        let folder = lab.out.join(&name);
        let patch: PathBuf = folder.join("parameters.json");
        let io = |path: &PathBuf| {
            let path = path.clone();
            move |source| LabError::Io { path, source }
        };
        std::fs::create_dir_all(&folder).map_err(io(&folder))?;
        std::fs::write(&patch, self.parameters.to_string()).map_err(io(&patch))?;
        let mut plan = self.plan.clone();
        plan["stages"][0]["patches"] = json!([std::path::absolute(&patch).map_err(io(&patch))?]);
        serde_json::from_value(plan).map_err(|e| LabError::Content {
            path: patch,
            what: e.to_string(),
        })
    }
}

/// A plan of one stage, its figures, and its knobs of second order by default.
fn plan(study: String, tool: &str, case: &str, figures: Value, knobs: Value) -> Value {
    json!({
        "kind": "certify", "version": "1.0", "study": study, "figures": figures, "knobs": knobs,
        "stages": [{"name": "run", "tool": tool, "scene": format!("pipelines/verify/{case}/scene.json")}]
    })
}

/// A spacing of the run, refined to its base from twice and four times as wide.
fn spacings(base: f64, order: f64) -> Value {
    let point = |size: f64| json!({"size": size, "patch": {"points": {"spacing_m": size}}});
    json!({"name": "spacing", "stage": "run", "series": {"refined": {
        "order": order, "unit": "m", "base": base, "points": [point(4.0 * base), point(2.0 * base)]}}})
}

/// A fixed step of an implicit march, refined to its base likewise.
fn steps(base: f64) -> Value {
    let point =
        |size: f64| json!({"size": size, "patch": {"time": {"implicit": {"step_s": size}}}});
    json!({"name": "step", "stage": "run", "series": {"refined": {
        "order": 2, "unit": "s", "base": base, "points": [point(4.0 * base), point(2.0 * base)]}}})
}

fn temperature(at: [f64; 3]) -> Value {
    json!({"name": "temperature", "unit": "K", "stage": "run",
        "from": {"point": {"channel": "/points", "column": "temperature", "at_m": at}}})
}

fn heat_rate(face: &str) -> Value {
    json!({"name": "heat_rate", "unit": "W/m", "stage": "run",
        "from": {"record": {"channel": "/boundaries", "value": format!("{face}.heat_rate")}}})
}

fn material(conductivity: &str) -> Value {
    json!({"materials": [{"name": "plate", "density_kg_m3": 1, "specific_heat_j_kg_k": 1,
        "conductivity_w_m_k": {"expr": conductivity}}]})
}

fn problems() -> Vec<Problem> {
    let mut all = Vec::new();
    for b in [-2.0, -0.7, 0.5, 1.0, 2.0, 3.0] {
        all.push(graded(b));
    }
    for a in [-1.0, 0.5, 1.0, 2.0, 3.0, 4.0] {
        all.push(warmed(a, "heat-exp-t", [0.5, 0.5, 0.0], 0.0125));
    }
    for a in [-0.5, 0.7, 1.0, 1.5, 2.5, 3.5] {
        all.push(warmed(a, "heat-block-3d", [0.5, 0.5, 0.0], 0.0625));
    }
    for end in [0.05, 0.1, 0.15, 0.2, 0.3, 0.5] {
        all.push(slab(end));
    }
    for end in [0.5, 1.0, 2.0, 3.0, 5.0, 8.0] {
        all.push(cylinder(end));
    }
    for ratio in [0.5, 2.0, 5.0, 20.0, 80.0, 1000.0] {
        all.push(sphere(ratio));
    }
    all
}

/// A plate with k = exp(B x) between 0 and 1 K: `T = (1 - e^(-B x)) / (1 - e^(-B))`, heat `B / (1 - e^(-B))`.
fn graded(b: f64) -> Problem {
    let through = b / (1.0 - (-b).exp());
    Problem {
        plan: plan(
            format!("proof-graded-{b}"),
            "heatsph",
            "heat-exp-x",
            json!([temperature([0.5, 0.5, 0.0]), heat_rate("x+")]),
            json!([spacings(0.0125, 2.0)]),
        ),
        parameters: crate::heat::methods::over(
            material(&format!("exp({b}*x)")),
            &json!({"points": {"spacing_m": 0.0125}}),
        ),
        exact: vec![
            ("temperature", (1.0 - (-0.5 * b).exp()) / (1.0 - (-b).exp())),
            ("heat_rate", through),
        ],
    }
}

/// A plate or block with k = exp(a T) between 0 and 1 K: `T = ln(1 + x (e^a - 1)) / a`.
fn warmed(a: f64, case: &str, at: [f64; 3], spacing: f64) -> Problem {
    Problem {
        plan: plan(
            format!("proof-{case}-{a}"),
            "heatsph",
            case,
            json!([temperature(at)]),
            json!([spacings(spacing, 2.0)]),
        ),
        parameters: crate::heat::methods::over(
            material(&format!("exp({a}*T)")),
            &json!({"points": {"spacing_m": spacing}}),
        ),
        exact: vec![("temperature", (1.0 + at[0] * (a.exp() - 1.0)).ln() / a)],
    }
}

/// A slab that is heated suddenly on one side: the series of Carslaw and Jaeger (1959), p. 100, with k = rho c = 1.
fn slab(end: f64) -> Problem {
    let (x, pi) = (0.5, std::f64::consts::PI);
    let (mut rise, mut heat) = (x, 1.0);
    for n in 1..200 {
        let (m, sign) = (f64::from(n), if n % 2 == 0 { 1.0 } else { -1.0 });
        let decay = (-m * m * pi * pi * end).exp();
        rise += 2.0 / pi * sign / m * (m * pi * x).sin() * decay;
        heat += 2.0 * decay;
    }
    let step = end / 40.0;
    Problem {
        plan: plan(
            format!("proof-slab-{end}"),
            "heatsph",
            "heat-exp-x-transient",
            json!([temperature([0.5, 0.5, 0.0]), heat_rate("x+")]),
            json!([spacings(0.025, 2.0), steps(step)]),
        ),
        parameters: crate::heat::methods::over(
            material("1"),
            &json!({"points": {"spacing_m": 0.025},
                "time": {"end_s": end, "implicit": {"step_s": step, "tolerance": null}}, "output": {"at_s": [end]}}),
        ),
        exact: vec![("temperature", rise), ("heat_rate", heat)],
    }
}

/// A cylinder heated evenly on its side: Carslaw and Jaeger (1959), p. 203.
fn cylinder(end: f64) -> Problem {
    let exact = Cylinder::new(1.0, 41.26, 7860.0 * 0.1146, 10.0);
    let step = end / 40.0;
    Problem {
        plan: plan(
            format!("proof-cylinder-{end}"),
            "heatsph",
            "heat-cylinder-flux",
            json!([temperature([0.0, 0.0, 0.0])]),
            json!([spacings(0.05, 2.0), steps(step)]),
        ),
        parameters: json!({"points": {"spacing_m": 0.05},
            "time": {"end_s": end, "implicit": {"step_s": step, "tolerance": null}}, "output": {"at_s": [end]}}),
        exact: vec![("temperature", exact.rise(0.0, end))],
    }
}

/// A dielectric sphere of this ratio of permittivities in a uniform field: Matsuzawa (2017), eqs 3.3 to 3.11.
fn sphere(ratio: f64) -> Problem {
    let (field, beta, r) = (5e6, (ratio - 1.0) / (ratio + 2.0), 5e-5_f64);
    let outer = format!("2500 + {field}*z*(1 - {beta}*({r})^3/(x^2 + y^2 + z^2)^1.5)");
    let at = 1.5 * r;
    let value = |name: &str, probe: &str| {
        json!({"name": name, "unit": "V/m", "stage": "run",
            "from": {"record": {"channel": "/probes", "value": format!("{probe}.electric_field_z")}}})
    };
    Problem {
        plan: plan(
            format!("proof-sphere-{ratio}"),
            "emfield",
            "em-dielectric-sphere",
            json!([value("inside", "inside"), value("outside", "outside")]),
            json!([spacings(5e-6, 4.0)]),
        ),
        parameters: json!({
            "bodies": [{"name": "sphere", "shape": {"sphere": {"centre_m": [0, 0, 0], "radius_m": r}},
                "relative_permittivity": ratio}],
            "electrostatics": {"outer": [{"potential_v": {"expr": outer}}]},
            "output": {"probes": [{"name": "inside", "place_m": [0, 0, 0.3 * r]}, {"name": "outside", "place_m": [0, 0, at]}]}
        }),
        exact: vec![
            ("inside", -field * 3.0 / (ratio + 2.0)),
            ("outside", -field * (1.0 + 2.0 * beta * (r / at).powi(3))),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_proof_without_figures_or_with_bands_that_hold_anything_is_none() {
        let answer = |half: f64| Answer {
            problem: "a".to_owned(),
            figure: "b".to_owned(),
            exact: 1.0,
            certified: Certified {
                stage: "run".to_owned(),
                unit: "K".to_owned(),
                value: 1.001,
                extrapolated: None,
                half_width: Some(half),
                scatter: None,
                knobs: std::collections::BTreeMap::new(),
                not_judged: Vec::new(),
            },
            held: half > 0.001,
        };
        let proof = |answers: Vec<Answer>, lost: &[&str]| Proof {
            kind: "certificate-proof",
            judged: answers.len(),
            held: answers.iter().filter(|a| a.held).count(),
            width: width(&answers),
            answers,
            lost: lost.iter().map(|l| (*l).to_owned()).collect(),
        };
        assert!(proof(vec![answer(0.002)], &[]).is_good());
        assert!(!proof(vec![answer(0.002)], &["a c"]).is_good());
        assert!(
            !proof(vec![answer(0.4)], &[]).is_good() && !proof(vec![answer(0.0005)], &[]).is_good()
        );
        assert!(!proof(Vec::new(), &[]).is_good());
    }
}
