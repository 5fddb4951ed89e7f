//! `heat-robin-square`: a square that cools by convection on two sides.

use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::frames::{Frames, greater, worst};
use crate::heat::methods::{self, TRANSIENT};
use crate::heat::property::{capacity, number};
use crate::heat::robin::Slab;
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct HeatRobinSquare;

impl Case for HeatRobinSquare {
    fn name(&self) -> &'static str {
        "heat-robin-square"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Series, Rong and Kisu (2010), eqs 8 to 10, after Ozisik (1993), p. 75"
    }

    fn methods(&self) -> &'static [&'static str] {
        TRANSIENT
    }

    fn targets(&self) -> Vec<Target> {
        let targets = vec![
            Target::error("temperature_linf", 5e-4),
            Target::order("temperature_linf", 1.8),
        ];
        methods::also_jittered(targets, TRANSIENT)
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = 0.005 / f64::from(1 << (level.clamp(1, 6) - 1));
        let run = methods::run(self, lab, level, method, spacing)?;
        let frames = Frames::read(&run)?;
        let exact = Cooling::of(&run, &frames)?;
        let mut errors = Errors::from([("temperature_linf".to_owned(), 0.0)]);
        for (time, found) in frames.after_start() {
            let range = (exact.start - exact.ambient).abs();
            let error = worst(&frames.position, found, range, |p| exact.value(p, time));
            errors.insert(format!("temperature_linf_{time}s"), error);
            let all = errors.entry("temperature_linf".to_owned()).or_insert(0.0);
            *all = greater(*all, error);
        }
        Ok(Measurement::of(run, frames.points(), spacing, errors))
    }
}

struct Cooling {
    slabs: [Slab; 2],
    start: f64,
    ambient: f64,
}

impl Cooling {
    fn of(run: &Finished, frames: &Frames) -> Result<Self, LabError> {
        let k = number(run, "/materials/0/conductivity_w_m_k")?;
        let diffusivity = k / capacity(run, 0)?;
        let film = number(run, "/boundaries/0/convection/coefficient_w_m2_k")?;
        let first = frames.later().first().copied().unwrap_or(1.0);
        let side = |axis: usize| {
            let length = number(run, &format!("/body/box/max_m/{axis}"))?;
            Ok::<_, LabError>(Slab::new(length, film / k, diffusivity, first))
        };
        Ok(Self {
            slabs: [side(0)?, side(1)?],
            start: number(run, "/initial_temperature_k")?,
            ambient: number(run, "/boundaries/0/convection/ambient_k")?,
        })
    }

    fn value(&self, place: &[f64; 3], time: f64) -> f64 {
        let left = self.slabs[0].value(place[0], time) * self.slabs[1].value(place[1], time);
        self.ambient + (self.start - self.ambient) * left
    }
}
