//! What `sweep` left: its points, where their artefacts are, which figures are asked for.

use std::path::{Path, PathBuf};

use ::figures::From;
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

    /// The artefact of a stage, where it is made.
    fn file(&self, stage: &str) -> Option<&Path> {
        let own = self.made.iter().find(|made| made.stage == stage);
        own.map(|made| made.file.as_path())
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
        for (point, numbers) in self.points.iter().zip(all) {
            let of = |figure: &Figure| figure.of(point, numbers).map_err(Failure::Other);
            rows.push(self.figures.iter().map(of).collect::<Result<_, _>>()?);
        }
        self.must_be_anywhere(&rows, all)?;
        Ok(rows)
    }

    /// Refuses a figure, but of a bead, that no point has whose stage is made: a name that is not right.
    fn must_be_anywhere(
        &self,
        rows: &[Vec<Option<f64>>],
        all: &[Vec<Number>],
    ) -> Result<(), Failure> {
        for (number, figure) in self.figures.iter().enumerate() {
            let found = rows.iter().any(|row| row[number].is_some());
            let made = self.points.iter().position(|point| point.has(figure));
            if let (false, Some(point)) = (found, made)
                && let Some(what) = figure.missing(&self.points[point], &all[point])
            {
                return Err(Failure::Other(what));
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
    /// Its value at a point in the unit in which it is asked for; none where the point has it not.
    fn of(&self, point: &Point, numbers: &[Number]) -> Result<Option<f64>, String> {
        let Some((value, unit)) = self.found(point, numbers)? else {
            return Ok(None);
        };
        match self.factor {
            // A factor of powers of ten leaves no tail of digits.
            Some(factor) => Ok(Some(rounded(factor * value, 15))),
            None if unit == self.unit => Ok(Some(value)),
            None => {
                let (channel, name) = self.from.place();
                Err(format!(
                    "figure '{}' is asked for in '{}', and {name} of {channel} is in '{unit}': say \"factor\", by which it becomes so",
                    self.name, self.unit
                ))
            }
        }
    }

    /// Its value as the point has it, with the unit.
    fn found(&self, point: &Point, numbers: &[Number]) -> Result<Option<(f64, String)>, String> {
        let (channel, name) = match &self.from {
            From::Record { channel, value } => (channel.as_str(), value.as_str()),
            From::Bead(measure) if !figures::known(measure) => {
                return Err(format!(
                    "figure '{}': no measure of a weld is called '{measure}'",
                    self.name
                ));
            }
            From::Bead(measure) => (BEAD, measure.as_str()),
            other => {
                let read = point.file(&self.stage).map(|file| other.read(file));
                let found = read.and_then(Result::ok);
                return Ok(found.map(|reading| (reading.value, reading.unit)));
            }
        };
        let own = |n: &&Number| n.stage == self.stage && n.channel == channel && n.name == name;
        let number = numbers.iter().find(own);
        Ok(number.map(|number| (number.value, number.unit.clone())))
    }

    /// Why a point whose stage is made has it not; nothing of a bead, which only what has melted has.
    fn missing(&self, point: &Point, numbers: &[Number]) -> Option<String> {
        let (channel, name) = match &self.from {
            From::Record { channel, value } => (channel, value),
            From::Bead(_) => return None,
            other => {
                let what = other.read(point.file(&self.stage)?).err()?;
                return Some(format!("figure '{}': {what}", self.name));
            }
        };
        let own = numbers
            .iter()
            .filter(|n| n.stage == self.stage && n.channel == *channel);
        let known: Vec<&str> = own.map(|n| n.name.as_str()).collect();
        let meant = run::scene::nearest(name, &known);
        let meant = meant.map_or(String::new(), |n| format!("; did you mean '{n}'?"));
        Some(format!(
            "figure '{}': stage '{}' has no '{name}' in {channel}, which holds {}{meant}",
            self.name,
            self.stage,
            known.join(", ")
        ))
    }
}
