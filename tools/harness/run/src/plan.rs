//! What a run would do: sizes, active stages, limits, what is left out.

use std::fmt;

use serde_json::{Map, Value, json};

use crate::ledger::{Bytes, LeftOut, Limit};

/// What a run would do. Built by [`crate::Tool::plan`], shown by `TOOL check` and at the head of
/// every run, and kept in the run record.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    pub(crate) stages: Vec<String>,
    pub(crate) counts: Vec<(String, u64)>,
    pub(crate) columns: Vec<(String, String)>,
    pub(crate) memory: Vec<Bytes>,
    pub(crate) output: Vec<Output>,
    pub(crate) limits: Vec<Limit>,
    pub(crate) left_out: Vec<LeftOut>,
    pub(crate) notes: Vec<String>,
    pub(crate) estimate: Option<Estimate>,
    pub(crate) grows: Option<&'static str>,
}

/// Messages of a channel, and their bytes before they are compressed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Output {
    pub(crate) channel: String,
    pub(crate) messages: u64,
    pub(crate) bytes: u64,
}

/// How long a run will take, told by `TOOL check`.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Wall time of the run \[s\].
    pub seconds: f64,
    /// What it rests on: "1.2 ms a step, as at the start".
    pub basis: String,
    /// Memory that the plan does not know, by name \[byte\]: with that of the plan the most that the run will hold.
    pub memory: Vec<(&'static str, u64)>,
}

impl Plan {
    /// An empty plan.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an active stage: `.stage("conduction")`.
    #[must_use]
    pub fn stage(mut self, name: &str) -> Self {
        self.stages.push(name.to_owned());
        self
    }

    /// Adds a size: `.count("particles", 12_000)`.
    #[must_use]
    pub fn count(mut self, name: &str, number: u64) -> Self {
        self.counts.push((name.to_owned(), number));
        self
    }

    /// Adds a column of the artefact: `.column("temperature", "K")`.
    #[must_use]
    pub fn column(mut self, name: &str, unit: &str) -> Self {
        self.columns.push((name.to_owned(), unit.to_owned()));
        self
    }

    /// Adds the memory of a column or table \[byte\].
    #[must_use]
    pub fn memory(mut self, name: &str, bytes: u64) -> Self {
        self.memory.push(Bytes {
            name: name.to_owned(),
            bytes,
        });
        self
    }

    /// Adds a channel of the artefact: how many messages it will hold, and at most how many bytes all of
    /// them are before they are compressed: `.output("/particles", 101, 101 * 52_000 * 40)`.
    #[must_use]
    pub fn output(mut self, channel: &str, messages: u64, bytes: u64) -> Self {
        self.output.push(Output {
            channel: channel.to_owned(),
            messages,
            bytes,
        });
        self
    }

    /// Memory that is known \[byte\].
    pub(crate) fn memory_bytes(&self) -> u64 {
        let all = self.memory.iter().map(|part| part.bytes);
        all.fold(0, u64::saturating_add)
    }

    /// Bytes of all output before it is compressed, at most.
    pub(crate) fn output_bytes(&self) -> u64 {
        let all = self.output.iter().map(|output| output.bytes);
        all.fold(0, u64::saturating_add)
    }

    /// Adds a stability limit: `.limit("step_viscosity", 1.2e-4, "s")`.
    #[must_use]
    pub fn limit(mut self, name: &str, value: f64, unit: &str) -> Self {
        self.limits.push(Limit {
            name: name.to_owned(),
            value,
            unit: unit.to_owned(),
        });
        self
    }

    /// Adds physics that the scene leaves out, or that is put to sleep.
    #[must_use]
    pub fn left_out(mut self, name: &str, why: &str) -> Self {
        self.left_out.push(LeftOut {
            name: name.to_owned(),
            why: why.to_owned(),
        });
        self
    }

    /// Adds a line for people.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(text.into());
        self
    }

    /// What is said of the output: the whole, and each channel.
    fn output_rows(&self) -> Vec<(&'static str, String)> {
        let channel = |output: &Output| {
            let Output {
                channel,
                messages,
                bytes: all,
            } = output;
            let each = bytes(all / (*messages).max(1));
            ("", format!("{channel:<28} {messages} x {each}"))
        };
        let whole = format!("at most {}, less as compressed", bytes(self.output_bytes()));
        let head = (!self.output.is_empty()).then_some(("output", whole));
        head.into_iter()
            .chain(self.output.iter().map(channel))
            .collect()
    }

    /// Sets the estimated run time, and why it is only the least where it is.
    pub(crate) fn estimate(
        mut self,
        estimate: Option<Estimate>,
        grows: Option<&'static str>,
    ) -> Self {
        let memory = estimate.iter().flat_map(|e| &e.memory);
        self.memory.extend(memory.map(|(name, bytes)| Bytes {
            name: (*name).to_owned(),
            bytes: *bytes,
        }));
        self.estimate = estimate;
        self.grows = grows;
        self
    }
}

impl Plan {
    /// What is told to programs: `TOOL check --json`. Where the time is only the least, `time_grows` says why.
    pub(crate) fn json(&self) -> Value {
        let counts: Map<String, Value> = self
            .counts
            .iter()
            .map(|(name, number)| (name.clone(), (*number).into()))
            .collect();
        json!({
            "kind": "plan",
            "version": "1.0",
            "stages": self.stages,
            "counts": counts,
            "memory_bytes": self.memory_bytes(),
            "memory": self.memory,
            "output_bytes": self.output_bytes(),
            "limits": self.limits,
            "left_out": self.left_out,
            "notes": self.notes,
            "time_s": self.estimate.as_ref().map(|estimate| estimate.seconds),
            "time_grows": self.grows,
        })
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut row = |name: &str, text: String| writeln!(f, "  {name:<20} {text}");
        if !self.stages.is_empty() {
            row("stages", self.stages.join(", "))?;
        }
        for (name, number) in &self.counts {
            row(name, number.to_string())?;
        }
        if !self.columns.is_empty() {
            let columns = self
                .columns
                .iter()
                .map(|(name, unit)| format!("{name} [{unit}]"));
            row("columns", columns.collect::<Vec<_>>().join(", "))?;
        }
        if !self.memory.is_empty() {
            row("memory", bytes(self.memory_bytes()))?;
            for part in &self.memory {
                row("", format!("{:<28} {}", part.name, bytes(part.bytes)))?;
            }
        }
        for (name, text) in self.output_rows() {
            row(name, text)?;
        }
        for limit in &self.limits {
            row(
                "limit",
                format!("{:<28} {:.4e} {}", limit.name, limit.value, limit.unit),
            )?;
        }
        for out in &self.left_out {
            row("left out", format!("{:<28} {}", out.name, out.why))?;
        }
        for note in &self.notes {
            row("note", note.clone())?;
        }
        match &self.estimate {
            Some(Estimate { seconds, basis, .. }) => {
                let told = duration(*seconds);
                row(
                    "time",
                    match self.grows {
                        None => format!("about {told} ({basis})"),
                        Some(why) => format!("at least {told} ({basis}; {why})"),
                    },
                )
            }
            None => Ok(()),
        }
    }
}

/// A number of bytes for people.
#[allow(clippy::cast_precision_loss, reason = "three digits are shown")]
pub(crate) fn bytes(bytes: u64) -> String {
    match bytes {
        0..10_000 => format!("{bytes} B"),
        10_000..10_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        10_000_000..10_000_000_000 => format!("{:.1} MB", bytes as f64 / 1e6),
        _ => format!("{:.2} GB", bytes as f64 / 1e9),
    }
}

/// A time span for people.
#[must_use]
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        "-".to_owned()
    } else if seconds < 1.0 {
        format!("{:.0} ms", 1e3 * seconds)
    } else if seconds < 60.0 {
        format!("{seconds:.1} s")
    } else if seconds < 3600.0 {
        format!(
            "{:.0} min {:02.0} s",
            (seconds / 60.0).floor(),
            (seconds % 60.0).floor()
        )
    } else {
        format!(
            "{:.0} h {:02.0} min",
            (seconds / 3600.0).floor(),
            (seconds % 3600.0 / 60.0).floor()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_read_like_a_clock() {
        assert_eq!(duration(0.0123), "12 ms");
        assert_eq!(duration(12.34), "12.3 s");
        assert_eq!(duration(125.0), "2 min 05 s");
        assert_eq!(duration(7322.0), "2 h 02 min");
        assert_eq!(duration(f64::INFINITY), "-");
    }
}
