//! `heat-sin-xy`: a conductivity that varies along x and y, steady.

use super::heat_exp_x::{held, square_spacing};
use crate::case::{Case, Errors, Measurement, Target};
use crate::heat::frames::{Frames, heat_rate, worst};
use crate::heat::methods::{self, STEADY};
use crate::heat::property::{conductivity, fault, number};
use crate::heat::square::{Solution, Square, solve};
use crate::lab::{Finished, Lab, LabError};

/// The case.
pub(super) struct HeatSinXy;

impl Case for HeatSinXy {
    fn name(&self) -> &'static str {
        "heat-sin-xy"
    }

    fn tool(&self) -> &'static str {
        "heatsph"
    }

    fn reference(&self) -> &'static str {
        "Spectral elements of degree 12 (error below 1e-8)"
    }

    fn methods(&self) -> &'static [&'static str] {
        STEADY
    }

    fn targets(&self) -> Vec<Target> {
        let targets = vec![
            Target::error("temperature_linf", 2e-3).at_level(1),
            Target::error("temperature_linf", 5e-4).at_level(2),
            Target::error("flow", 5e-3).at_level(1),
            Target::error("flow", 5e-3).at_level(2),
        ];
        methods::also_jittered(targets, STEADY)
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let spacing = square_spacing(level);
        let run = methods::run(self, lab, level, method, spacing)?;
        let frames = Frames::read(&run)?;
        let held = held(&run)?;
        let exact = exact(&run, held)?;
        let linf = worst(
            &frames.position,
            frames.last(),
            (held[0] - held[1]).abs(),
            |p| exact.temperature(p[0], p[1]),
        );
        let mut flow = 0.0;
        for (boundary, sign) in [(0, 1.0), (1, -1.0)] {
            let found = sign * heat_rate(&run, boundary)?;
            flow = crate::heat::frames::greater(flow, (found / exact.flow - 1.0).abs());
        }
        let errors = Errors::from([
            ("temperature_linf".to_owned(), linf),
            ("flow".to_owned(), flow),
        ]);
        Ok(Measurement::of(run, frames.points(), spacing, errors))
    }
}

fn exact(run: &Finished, held: [f64; 2]) -> Result<Solution, LabError> {
    let corner = |which: &str| -> Result<[f64; 2], LabError> {
        Ok([
            number(run, &format!("/body/box/{which}/0"))?,
            number(run, &format!("/body/box/{which}/1"))?,
        ])
    };
    let problem = Square {
        corners: [corner("min_m")?, corner("max_m")?],
        conductivity: conductivity(run, 0)?,
        held,
    };
    solve(&problem, 12).ok_or_else(|| fault(run, "the reference does not converge".to_owned()))
}
