//! References for drops that swing, and what is read of them.

pub mod swing;
pub mod viscous;

use artefact::Reader;

use crate::lab::{Finished, LabError};

/// A column of the rows of a drop, with their times \[s\].
#[derive(Debug, Clone)]
pub struct Series {
    /// Times \[s\].
    pub time: Vec<f64>,
    /// Values.
    pub value: Vec<f64>,
}

impl Series {
    /// Reads it.
    ///
    /// # Errors
    /// When the artefact has none.
    pub fn read(run: &Finished, name: &str) -> Result<Self, LabError> {
        let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
        let (mut time, mut value) = (Vec::new(), Vec::new());
        for (at, record) in reader.records("/liquid")? {
            time.push(at);
            value.push(record.get(name)?);
        }
        Ok(Self { time, value })
    }
}

/// Points of the drop of a run.
///
/// # Errors
/// When it has no frame.
pub fn points(run: &Finished) -> Result<u64, LabError> {
    let reader = Reader::open_kind(&run.artefact, "point-fields", 1)?;
    Ok(reader.frame("/points", 0)?.len() as u64)
}
