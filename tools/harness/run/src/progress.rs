//! Progress for people: a bar on a terminal, rows of fixed width elsewhere, or nothing.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::console::line;
use crate::plan::duration;

/// A number of the status: name, value, unit (`""` or `"1"` for none).
pub(crate) type Field = (&'static str, f64, &'static str);

/// Shortest time between two looks of the bar.
const BAR: Duration = Duration::from_millis(200);
/// Time between two rows: at least this, and a fiftieth of the run so far.
const ROW: Duration = Duration::from_secs(2);
/// Rows between two headings.
const PAGE: u32 = 30;

/// How progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Style {
    /// A bar on a terminal, rows elsewhere.
    Auto,
    /// Rows of fixed width.
    Plain,
    /// Nothing.
    None,
}

#[derive(Debug)]
enum Face {
    Bar(ProgressBar),
    Rows { shown: u32 },
    Nothing,
}

/// Shows how far a run has come.
#[derive(Debug)]
pub(crate) struct Progress {
    face: Face,
    /// When work began, and how much was done by then.
    began: Option<(Instant, u64)>,
    last: Option<Instant>,
}

impl Progress {
    pub(crate) fn new(style: Style) -> Self {
        let face = match style {
            Style::None => Face::Nothing,
            Style::Auto if std::io::stderr().is_terminal() => Face::Bar(bar()),
            Style::Auto | Style::Plain => Face::Rows { shown: 0 },
        };
        Self {
            face,
            began: None,
            last: None,
        }
    }

    /// Shows `done` of `total`; `fields` is only asked when something is shown.
    pub(crate) fn show(&mut self, done: u64, total: u64, fields: impl FnOnce() -> Vec<Field>) {
        if matches!(self.face, Face::Nothing) {
            return;
        }
        let now = Instant::now();
        let (began, first) = *self.began.get_or_insert((now, done));
        let wait = match self.face {
            Face::Bar(_) => BAR,
            _ => ROW.max(began.elapsed() / 50),
        };
        let due = self
            .last
            .is_none_or(|last| now.duration_since(last) >= wait);
        if !due && done < total {
            return;
        }
        self.last = Some(now);
        let left = time_left(
            began.elapsed().as_secs_f64(),
            done.saturating_sub(first),
            total.saturating_sub(done),
        );
        match &mut self.face {
            Face::Bar(bar) => {
                bar.set_length(total);
                bar.set_position(done);
                bar.set_message(format!("{}  left {}", words(&fields()), duration(left)));
            }
            Face::Rows { shown } => {
                let fields = fields();
                if shown.is_multiple_of(PAGE) {
                    line(&heading(&fields));
                }
                *shown += 1;
                line(&row(done, total, &fields, left));
            }
            Face::Nothing => {}
        }
    }

    /// Says a line without tearing the bar.
    pub(crate) fn say(&self, text: &str) {
        match &self.face {
            Face::Bar(bar) => bar.suspend(|| line(text)),
            _ => line(text),
        }
    }

    /// Removes the bar.
    pub(crate) fn end(&self) {
        if let Face::Bar(bar) = &self.face {
            bar.finish_and_clear();
        }
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{wide_bar} {percent:>3} %  {msg}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// Seconds left if the rest goes on as `done` units in `spent` seconds; infinite when unknown.
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
fn time_left(spent: f64, done: u64, rest: u64) -> f64 {
    if rest == 0 {
        0.0
    } else if done == 0 {
        f64::INFINITY
    } else {
        spent / done as f64 * rest as f64
    }
}

fn words(fields: &[Field]) -> String {
    let word = |(name, value, unit): &Field| match *unit {
        "" | "1" => format!("{name} {}", figure(*value)),
        unit => format!("{name} {} {unit}", figure(*value)),
    };
    fields.iter().map(word).collect::<Vec<_>>().join("  ")
}

fn heading(fields: &[Field]) -> String {
    let mut text = format!("{:>10} {:>10} {:>13}", "done", "of", "left");
    for (name, _, unit) in fields {
        let title = if matches!(*unit, "" | "1") {
            (*name).to_owned()
        } else {
            format!("{name} {unit}")
        };
        text += &format!(" {title:>16}");
    }
    text
}

fn row(done: u64, total: u64, fields: &[Field], left: f64) -> String {
    let mut text = format!("{done:>10} {total:>10} {:>13}", duration(left));
    for (_, value, _) in fields {
        text += &format!(" {:>16}", figure(*value));
    }
    text
}

/// A number in at most 12 characters: whole numbers as they are, others to 5 digits.
fn figure(x: f64) -> String {
    if x.abs() < 1e9 && x.fract().abs() < f64::EPSILON {
        format!("{x:.0}")
    } else if x.abs() >= 0.01 && x.abs() < 1e5 {
        format!("{x:.4}")
    } else {
        format!("{x:.4e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_follows_the_rate_of_this_process() {
        assert!((time_left(10.0, 5, 20) - 40.0).abs() < 1e-12);
        assert!(time_left(10.0, 0, 20).is_infinite());
        assert!(time_left(10.0, 7, 0).abs() < 1e-12);
    }

    #[test]
    fn rows_stand_under_their_heading() {
        let fields = [("time", 0.125, "s"), ("liquid", 1234.0, "1")];
        assert_eq!(words(&fields), "time 0.1250 s  liquid 1234");
        let (head, row) = (heading(&fields), row(10, 200, &fields, 3725.0));
        assert_eq!(head.len(), row.len());
        assert!(
            row.contains("1 h 02 min") && row.contains("0.1250") && row.ends_with(" 1234"),
            "{row}"
        );
        assert!(
            head.contains("time s") && head.ends_with("liquid"),
            "{head}"
        );
    }
}
