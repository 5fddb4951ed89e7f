//! `heat-exp-x-transient`: the plate of `heat-exp-x` heated suddenly on one side.

use super::heat_exp_x::{plate, square_spacing};
use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::bar::{Bar, Profiles, profiles};
use crate::heat::frames::{Frames, greater, worst};
use crate::heat::methods::{self, TRANSIENT};
use crate::heat::property::{capacity, fault, number};
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct HeatExpXTransient;

impl Case for HeatExpXTransient {
    fn name(&self) -> &'static str {
        "heat-exp-x-transient"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Fine finite volumes in one dimension, extrapolated"
    }

    fn methods(&self) -> &'static [&'static str] {
        TRANSIENT
    }

    fn targets(&self) -> Vec<Target> {
        let targets = vec![
            Target::error("temperature_linf", 2e-3).at_level(2),
            Target::error("temperature_linf", 5e-4).at_level(3),
        ];
        methods::also_jittered(targets, TRANSIENT)
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = square_spacing(level);
        let run = methods::run(self, lab, level, method, spacing)?;
        let frames = Frames::read(&run)?;
        let (bar, reference) = reference(&run, &frames, 200)?;
        let range = range(&bar);
        let mut worst_of_all = 0.0;
        for (i, (_, found)) in frames.after_start().enumerate() {
            let error = worst(&frames.position, found, range, |p| reference.value(i, p[0]));
            worst_of_all = greater(worst_of_all, error);
        }
        let errors = Errors::from([("temperature_linf".to_owned(), worst_of_all)]);
        Ok(Measurement::of(run, frames.points(), spacing, errors))
    }
}

/// The largest difference of the temperatures that a scene names \[K\].
pub(super) fn range(bar: &Bar) -> f64 {
    let all = [bar.plate.held[0], bar.plate.held[1], bar.start];
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    all.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
}

/// The bar of a scene and its profiles at the times of the frames after the start.
pub(super) fn reference(
    run: &Finished,
    frames: &Frames,
    intervals: usize,
) -> Result<(Bar, Profiles), LabError> {
    let bar = Bar {
        plate: plate(run)?,
        capacity: capacity(run, 0)?,
        start: number(run, "/initial_temperature_k")?,
    };
    let found = profiles(&bar, &frames.later(), intervals, 1e-6);
    let found = found.ok_or_else(|| fault(run, "the reference cannot be marched".to_owned()))?;
    Ok((bar, found))
}
