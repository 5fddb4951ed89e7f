//! What `sweep` left: its points, where their artefacts are, which figures are asked for.

use std::path::{Path, PathBuf};

use run::Failure;
use serde::Deserialize;

use crate::csv::rounded;
use crate::figures;
use crate::page::beside::numbers::{BEAD, Number};

/// The record of a sweep.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Points {
    pub(super) study: String,
    pub(super) title: Option<String>,
    pub(super) parameters: Vec<Parameter>,
    pub(super) figures: Vec<Figure>,
    /// Stages that are shown whole for each point.
    pub(super) whole: Vec<String>,
    pub(super) points: Vec<Point>,
}

/// What is swept.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) unit: String,
}

impl Parameter {
    /// Its name for people.
    pub(super) fn words(&self) -> String {
        self.name.replace('_', " ")
    }
}

/// A figure that is asked for.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Figure {
    pub(super) name: String,
    pub(super) unit: String,
    factor: Option<f64>,
    stage: String,
    from: From,
}

#[derive(Debug, Clone, Deserialize)]
struct From {
    record: Option<Recorded>,
    bead: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
struct Recorded {
    channel: String,
    value: String,
}

/// A point.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Point {
    pub(super) name: String,
    pub(super) values: Vec<Value>,
    made: Vec<Made>,
    pub(super) failed: Option<Failed>,
}

/// A value of a parameter.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Value {
    pub(super) name: String,
    pub(super) number: Option<f64>,
}

#[derive(Debug, Clone, Deserialize)]
struct Made {
    stage: String,
    file: PathBuf,
}

/// Why a point is not there.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Failed {
    pub(super) stage: String,
    pub(super) what: String,
}

impl Point {
    /// Whether the stage of a figure is made.
    fn has(&self, figure: &Figure) -> bool {
        self.made.iter().any(|made| made.stage == figure.stage)
    }

    /// Artefacts by the names of their stages.
    pub(super) fn files(&self) -> Vec<(String, PathBuf)> {
        let made = self.made.iter();
        made.map(|m| (m.stage.clone(), m.file.clone())).collect()
    }
}

impl Points {
    /// Reads the record.
    ///
    /// # Errors
    /// When it cannot be read.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        Ok(artefact::json_artefact(path, "sweep-points", 1)?)
    }

    /// A point in words: `300 A`, or `current 300 A, speed 0.01 m/s`.
    pub(super) fn label(&self, point: &Point) -> String {
        let part = |(p, v): (&Parameter, &Value)| {
            let unit = match p.unit.as_str() {
                "1" => String::new(),
                unit => format!(" {unit}"),
            };
            match self.parameters.len() {
                1 if !unit.is_empty() => format!("{}{unit}", v.name),
                _ => format!("{} {}{unit}", p.words(), v.name),
            }
        };
        let parts = self.parameters.iter().zip(&point.values).map(part);
        parts.collect::<Vec<_>>().join(", ")
    }

    /// The value of each figure at each point, in the unit in which it is asked for.
    ///
    /// # Errors
    /// When no point has what is asked for, or one has it in another unit and no factor is given.
    pub(super) fn figures(&self, all: &[Vec<Number>]) -> Result<Vec<Vec<Option<f64>>>, Failure> {
        let mut rows = Vec::new();
        for numbers in all {
            let mut row = Vec::new();
            for figure in &self.figures {
                let found = figure.of(numbers).map_err(Failure::Other)?;
                if let Some(name) = figure
                    .from
                    .bead
                    .as_deref()
                    .filter(|name| !figures::known(name))
                {
                    return Err(Failure::Other(format!(
                        "figure '{}': no measure of a weld is called '{name}'",
                        figure.name
                    )));
                }
                row.push(found);
            }
            rows.push(row);
        }
        self.must_be_anywhere(&rows, all)?;
        Ok(rows)
    }

    /// Refuses a figure of a record that no point has whose stage is made: a name that is not right.
    fn must_be_anywhere(
        &self,
        rows: &[Vec<Option<f64>>],
        all: &[Vec<Number>],
    ) -> Result<(), Failure> {
        for (number, figure) in self.figures.iter().enumerate() {
            let found = rows.iter().any(|row| row[number].is_some());
            let made = self.points.iter().position(|point| point.has(figure));
            if let (false, Some(point), Some(_)) = (found, made, &figure.from.record) {
                return Err(Failure::Other(figure.missing(&all[point])));
            }
        }
        Ok(())
    }
}

impl Points {
    /// Figures that points lack although their stages are made, such as a depth where nothing has melted.
    pub(super) fn lacking(&self, figures: &[Vec<Option<f64>>]) -> Vec<String> {
        let mut told = Vec::new();
        for (number, figure) in self.figures.iter().enumerate() {
            let lacks = |(point, row): &(&Point, &Vec<Option<f64>>)| {
                point.has(figure) && row[number].is_none()
            };
            let each = self.points.iter().zip(figures);
            let names: Vec<String> = each.filter(lacks).map(|(p, _)| self.label(p)).collect();
            if !names.is_empty() {
                told.push(format!(
                    "'{}' is of '{}', which is made and has none at: {}. These points are in no curve of it.",
                    figure.name,
                    figure.stage,
                    names.join("; ")
                ));
            }
        }
        told
    }
}

impl Figure {
    /// Channel and name of its value.
    fn place(&self) -> (&str, &str) {
        match (&self.from.record, &self.from.bead) {
            (Some(record), _) => (&record.channel, &record.value),
            (None, bead) => (BEAD, bead.as_deref().unwrap_or_default()),
        }
    }

    fn of(&self, numbers: &[Number]) -> Result<Option<f64>, String> {
        let (channel, name) = self.place();
        let own = |n: &&Number| n.stage == self.stage && n.channel == channel && n.name == name;
        let Some(number) = numbers.iter().find(own) else {
            return Ok(None);
        };
        match self.factor {
            // A factor of powers of ten leaves no tail of digits.
            Some(factor) => Ok(Some(rounded(factor * number.value, 15))),
            None if number.unit == self.unit => Ok(Some(number.value)),
            None => Err(format!(
                "figure '{}' is asked for in '{}', and {name} of {channel} is in '{}': say \"factor\", by which it becomes so",
                self.name, self.unit, number.unit
            )),
        }
    }

    fn missing(&self, numbers: &[Number]) -> String {
        let (channel, name) = self.place();
        let own = numbers
            .iter()
            .filter(|n| n.stage == self.stage && n.channel == channel);
        let known: Vec<&str> = own.map(|n| n.name.as_str()).collect();
        let meant = run::scene::nearest(name, &known);
        let meant = meant.map_or(String::new(), |n| format!("; did you mean '{n}'?"));
        format!(
            "figure '{}': stage '{}' has no '{name}' in {channel}, which holds {}{meant}",
            self.name,
            self.stage,
            known.join(", ")
        )
    }
}
