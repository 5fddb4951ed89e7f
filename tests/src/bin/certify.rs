//! `certify`: the error of a study against its run time.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to its user"
)]

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::Parser;
use verification::certify::{self, Certificate, Tolerance, proof};
use verification::{keep::keep, lab::Lab};

/// Runs a study over spacings and steps, and gives each headline figure with its numerical error band.
///
/// Example: certify --study gmaw-quick --budget 30min --tolerance "penetration 0.2 mm"
#[derive(Parser)]
struct Arguments {
    /// The study, whose plan is pipelines/STUDY/certify.json.
    #[arg(long, required_unless_present = "proof")]
    study: Option<String>,
    /// Greatest time for new runs: a number with s, min or h. Runs that would take longer are left out, with a message; call again to continue.
    #[arg(long, default_value = "30min", value_parser = duration)]
    budget: Duration,
    /// A figure, an error and a unit, as in "penetration 0.2 mm": names the smallest run that meets it.
    #[arg(long)]
    tolerance: Option<String>,
    /// Certifies problems with exact answers instead, and counts how often the exact value lies in the band.
    #[arg(long)]
    proof: bool,
    /// Where records and artefacts go.
    #[arg(long, default_value = "build/certify")]
    out: PathBuf,
    /// Threads per run.
    #[arg(long, default_value_t = 2)]
    threads: usize,
}

fn duration(words: &str) -> Result<Duration, String> {
    let digits = words.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let scale = match &words[digits.len()..] {
        "" | "s" => 1.0,
        "min" => 60.0,
        "h" => 3600.0,
        other => return Err(format!("'{other}' is no unit of time: s, min or h")),
    };
    let number: f64 = digits
        .parse()
        .map_err(|_| format!("'{digits}' is no number"))?;
    Duration::try_from_secs_f64(number * scale).map_err(|e| e.to_string())
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(code) => code,
        Err((message, code)) => {
            eprintln!("certify: {message}");
            ExitCode::from(code)
        }
    }
}

fn run(arguments: &Arguments) -> Result<ExitCode, (String, u8)> {
    let failed = |message: String| (message, 1);
    let programs = std::env::current_exe().map_err(|e| failed(e.to_string()))?;
    let lab = Lab {
        root: std::env::current_dir().map_err(|e| failed(e.to_string()))?,
        programs: programs.parent().map(PathBuf::from).unwrap_or_default(),
        out: arguments.out.clone(),
        threads: arguments.threads,
        patch: None,
        repeat_s: 0.0,
    };
    std::fs::create_dir_all(&lab.out).map_err(|e| failed(format!("{}: {e}", lab.out.display())))?;
    let Some(study) = arguments.study.as_ref().filter(|_| !arguments.proof) else {
        return prove(&lab);
    };
    let plan = certify::plan_of(&lab.root, study).map_err(|e| (e.to_string(), 2))?;
    let tolerance = arguments.tolerance.as_ref();
    let tolerance = tolerance
        .map(|words| Tolerance::parse(words, &plan))
        .transpose();
    let tolerance = tolerance.map_err(|e| (e, 2))?;
    let told = certify::certify(&lab, &plan, arguments.budget, tolerance.as_ref())
        .map_err(|e| failed(e.to_string()))?;
    print!("{}", table(&told));
    let record = lab.out.join(format!("{study}.json"));
    keep(&record, &told).map_err(failed)?;
    let record = record.display();
    println!(
        "to show these bands on the study's page: cp {record} pipelines/{study}/certificate.json"
    );
    let warned = told
        .points
        .first()
        .is_some_and(|base| !base.warnings.is_empty());
    Ok(if told.is_judged() && !warned {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(3)
    })
}

fn prove(lab: &Lab) -> Result<ExitCode, (String, u8)> {
    let proof = proof::prove(lab).map_err(|e| (e.to_string(), 1))?;
    for answer in proof.answers.iter().filter(|a| !a.held) {
        println!(
            "{} {}: exact {:.6e}, found {:.6e} +- {:.1e}",
            answer.problem,
            answer.figure,
            answer.exact,
            answer.certified.value,
            answer.certified.half_width.unwrap_or(f64::NAN)
        );
    }
    println!("the truth lies in {} of {} bands", proof.held, proof.judged);
    keep(&lab.out.join("proof.json"), &proof).map_err(|e| (e, 1))?;
    println!(
        "half of the median band is {:.3} % of the value",
        100.0 * proof.width
    );
    for lost in &proof.lost {
        println!("no band: {lost}");
    }
    Ok(if proof.is_good() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// The figures and points for people.
fn table(told: &Certificate) -> String {
    let mut text = String::new();
    for (name, figure) in &told.figures {
        let half = figure
            .half_width
            .map_or("not judged".to_owned(), |h| format!("+- {h:.2e}"));
        let tends = figure
            .extrapolated
            .map_or(String::new(), |x| format!(", tends to {x:.4e}"));
        let chance = figure
            .scatter
            .map_or(String::new(), |[h, _]| format!(", by chance +- {h:.2e}"));
        text += &format!(
            "{name:<20} {:.4e} {} {half}{tends}{chance}\n",
            figure.value, figure.unit
        );
        for knob in &figure.not_judged {
            text += &format!(
                "{:<20} {knob}: not judged, too few of its sizes were run, have the figure, or differ in it\n",
                ""
            );
        }
        if figure.half_width.is_none() && figure.not_judged.is_empty() {
            text += &format!("{:<20} not judged: the plan refines no knob for it\n", "");
        }
    }
    for point in &told.points {
        let words = match (&point.missing, point.run_time_s) {
            (Some(why), _) => format!("not run: {why}"),
            (None, time) => {
                let work = point.processor_s;
                let work = work.map_or(String::new(), |s| format!(", {s:.1} s of processors"));
                format!("{:.1} s{work}", time.unwrap_or(f64::NAN))
            }
        };
        text += &format!("  {:<24} {words}\n", point.name);
        for warning in &point.warnings {
            text += &format!("    {warning}\n");
        }
    }
    if let Some(least) = &told.least {
        text += &match (&least.point, least.run_time_s) {
            (Some(point), Some(time)) => format!(
                "{} within {:.2e}: the least run is {point}, {time:.1} s, with the patch {}\n",
                least.figure, least.tolerance, least.patch
            ),
            _ => format!(
                "{} within {:.2e}: no run that warns of nothing comes near enough\n",
                least.figure, least.tolerance
            ),
        };
    }
    text
}
