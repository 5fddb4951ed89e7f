//! `heat-cylinder-flux`: a cylinder heated evenly on its side, in a plane.

use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::cylinder::Cylinder;
use crate::heat::frames::{Frames, greater, worst};
use crate::heat::methods::{self, TRANSIENT};
use crate::heat::property::{capacity, fault, number};
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct HeatCylinderFlux;

impl Case for HeatCylinderFlux {
    fn name(&self) -> &'static str {
        "heat-cylinder-flux"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Series, Rong and Kisu (2010), eq. 11 put right, after Carslaw and Jaeger (1959), p. 203"
    }

    fn methods(&self) -> &'static [&'static str] {
        TRANSIENT
    }

    fn targets(&self) -> Vec<Target> {
        let targets = vec![Target::error("temperature_linf", 5e-3)];
        let mut targets = methods::also_jittered(targets, TRANSIENT);
        targets.push(Target::error("mean", 1e-6));
        for method in TRANSIENT.iter().filter(|m| methods::is_jittered(m)) {
            targets.push(Target::error("mean", 1e-6).of(*method));
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        // 21, 41, 81 points across.
        let spacing = 0.1 / f64::from(1 << (level.clamp(1, 6) - 1));
        let run = methods::run(self, lab, level, method, spacing)?;
        let frames = Frames::read(&run)?;
        let errors = errors(&run, &frames)?;
        Ok(Measurement::of(run, frames.points(), spacing, errors))
    }
}

fn errors(run: &Finished, frames: &Frames) -> Result<Errors, LabError> {
    let exact = Cylinder::new(
        number(run, "/body/disc/radius_m")?,
        number(run, "/materials/0/conductivity_w_m_k")?,
        capacity(run, 0)?,
        number(run, "/boundaries/0/heat_flux_w_m2")?,
    );
    let start = number(run, "/initial_temperature_k")?;
    let centre = [
        number(run, "/body/disc/centre_m/0")?,
        number(run, "/body/disc/centre_m/1")?,
    ];
    let volume: f64 = frames.volume.iter().sum();
    let (mut linf, mut means) = (0.0, 0.0);
    for (time, found) in frames.after_start() {
        if time < exact.earliest() {
            let what = format!("the series needs times from {} s on", exact.earliest());
            return Err(fault(run, what));
        }
        let scale = exact.mean(time).abs();
        let radius = |p: &[f64; 3]| (p[0] - centre[0]).hypot(p[1] - centre[1]);
        let error = worst(&frames.position, found, scale, |p| {
            start + exact.rise(radius(p), time)
        });
        linf = greater(linf, error);
        let heat: f64 = found
            .iter()
            .zip(&frames.volume)
            .map(|(t, v)| (t - start) * v)
            .sum();
        means = greater(means, (heat / volume - exact.mean(time)).abs() / scale);
    }
    Ok(Errors::from([
        ("temperature_linf".to_owned(), linf),
        ("mean".to_owned(), means),
    ]))
}
