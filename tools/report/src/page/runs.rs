//! How the study was computed: programs, active stages, memory, what was left out.

use run::duration;

use super::{Named, program};
use crate::html::{Rows, beside, escape, figure, note};
use crate::plot::{Line, Plot};
use crate::records::{RunRecord, bytes, figure as digits};

/// So many iterations are shown evenly.
const FEW: f64 = 200.0;

/// The section; nothing without records.
pub(super) fn section(records: &[Named]) -> String {
    let mut table = Rows::new(&[
        "Program",
        "Ended",
        "#Time",
        "#Steps",
        "#Threads",
        "#Peak memory",
        "Started",
    ]);
    for (name, record) in records {
        let program = program(records, name, record);
        let tool = format!("{} {}", record.tool, record.tool_version);
        table.row([
            escape(&program.replacen(&record.tool, &tool, 1)),
            escape(&record.outcome),
            duration(record.wall_s),
            record.steps.to_string(),
            record.threads.to_string(),
            record
                .peak_memory_bytes
                .map_or_else(|| "\u{2013}".to_owned(), bytes),
            escape(&record.start),
        ]);
    }
    let mut out = table.render();
    for (name, record) in records {
        out += &one(record, &program(records, name, record));
    }
    out
}

fn one(record: &RunRecord, title: &str) -> String {
    let mut out = String::new();
    for warning in &record.warnings {
        out += &note(&format!("Warning: {warning}"));
    }
    for text in &record.notes {
        out += &note(text);
    }
    out += &stages(record);
    let mut left_out = Rows::new(&["Left out", "Why"]);
    for absent in &record.left_out {
        left_out.row([escape(&absent.name), escape(&absent.why)]);
    }
    out += &beside(&[memory(record), limits(record), left_out.render()]);
    out += &history(record);
    out += &scene(record);
    if out.is_empty() {
        return out;
    }
    format!("<h3>{}</h3>\n{out}", escape(title))
}

fn stages(record: &RunRecord) -> String {
    let mut table = Rows::new(&["Active stage", "#Time", "#Share", "", "#Per step"]);
    for stage in &record.stages {
        let per_step = match record.steps {
            0 => "\u{2013}".to_owned(),
            n => format!("{:.3} ms", 1e3 * stage.wall_s / n as f64),
        };
        table.row([
            escape(&stage.name),
            duration(stage.wall_s),
            format!("{:.1} %", 100.0 * stage.share),
            format!(
                "<span class=\"bar\" style=\"width:{:.1}rem\"></span>",
                (10.0 * stage.share).clamp(0.0, 10.0)
            ),
            per_step,
        ]);
    }
    table.render()
}

fn memory(record: &RunRecord) -> String {
    let mut table = Rows::new(&["Memory of", "#Size"]);
    for part in &record.memory {
        table.row([escape(&part.name), bytes(part.bytes)]);
    }
    table.render()
}

fn limits(record: &RunRecord) -> String {
    let mut table = Rows::new(&["Limit", "#Value", "Unit"]);
    for limit in &record.limits {
        let unit = if limit.unit == "1" { "" } else { &limit.unit };
        table.row([
            escape(&limit.name.replace('_', " ")),
            digits(limit.value),
            escape(unit),
        ]);
    }
    table.render()
}

/// Residuals and other histories; residuals on a logarithmic axis, long ones on two.
fn history(record: &RunRecord) -> String {
    let empty = Plot::new("iteration", "residual");
    let last = record.history.iter().flat_map(|h| h.at.last()).copied();
    let mut residuals = match last.fold(0.0, f64::max) {
        few if few <= FEW => empty.log_y(),
        _ => empty.log_log(),
    };
    for history in record
        .history
        .iter()
        .filter(|h| h.name.contains("residual"))
    {
        let points = history
            .at
            .iter()
            .zip(&history.values)
            .map(|(a, v)| [*a, *v]);
        let name = history
            .name
            .trim_start_matches("residual_")
            .replace('_', " ");
        residuals.add(Line::new(&name, points.collect()));
    }
    if residuals.is_empty() {
        return String::new();
    }
    figure(
        &residuals.html(),
        "How the residuals of the equations fell: lower is closer to a solution.",
    )
}

fn scene(record: &RunRecord) -> String {
    if record.scene.is_null() {
        return String::new();
    }
    let text = serde_json::to_string_pretty(&record.scene).unwrap_or_default();
    format!(
        "<details>\n<summary>The scene</summary>\n<pre>{}</pre>\n</details>\n",
        escape(&text)
    )
}
