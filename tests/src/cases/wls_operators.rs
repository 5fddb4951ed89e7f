//! `wls-operators`: gradient and Laplacian by weighted least squares on clouds of every kind.
//!
//! The library is measured itself, as no scene asks for operators alone: the run time is that of
//! sorting the cloud and of all weights.

use std::sync::LazyLock;
use std::time::Instant;

use crate::case::{Case, Errors, Measurement, Target};
use crate::lab::{Finished, Lab, LabError};
use crate::operators::Points;
use crate::operators::measured::MEASURED;

/// Points per side of the unit square, by level.
const PLANE: [usize; 5] = [24, 48, 96, 144, 192];
/// Points per side of the unit cube, by level.
const SPACE: [usize; 5] = [12, 20, 32, 40, 48];
/// Runs of which the middle one's time counts, where the first is shorter than this \[s\].
const SHORT_S: f64 = 0.2;
/// As many of them.
const REPEATS: usize = 3;
/// Errors may be as many times those that were measured.
const TIMES: f64 = 1.2;
/// What an order may lack of that which was measured, or of that of the fit where it is less.
const MARGIN: f64 = 0.05;
/// Quantities in the order in which they were measured.
const QUANTITIES: [&str; 4] = [
    "gradient_l2",
    "gradient_linf",
    "laplacian_l2",
    "laplacian_linf",
];

/// Dimensions, order of the fit and kind of the cloud of each method.
static METHODS: LazyLock<Vec<&'static str>> =
    LazyLock::new(|| MEASURED.iter().map(|m| m.0).collect());

/// The case.
pub(super) struct WlsOperators;

/// Whether a method is one of a plane, the order of its fit and the kind of its cloud.
fn parts(method: &str) -> (bool, u8, &str) {
    let (space, rest) = method.split_once('-').unwrap_or(("plane", "2-regular"));
    let (order, kind) = rest.split_once('-').unwrap_or(("2", "regular"));
    (space == "plane", order.parse().unwrap_or(2), kind)
}

impl Case for WlsOperators {
    fn name(&self) -> &'static str {
        "wls-operators"
    }

    fn tool(&self) -> &'static str {
        "emfield"
    }

    fn reference(&self) -> &'static str {
        "derivatives of polynomials and of exp(x) sin(2y + 1) cos(z); Matsuzawa (2017), section 2.1"
    }

    fn methods(&self) -> &'static [&'static str] {
        &METHODS
    }

    fn targets(&self) -> Vec<Target> {
        let mut targets = Vec::new();
        for (method, errors, orders) in MEASURED {
            let p = f64::from(parts(method).1);
            targets.push(Target::error("polynomial", 1e-10).of(method));
            for (k, (error, order)) in errors.iter().zip(orders).enumerate() {
                let whole = if k < 2 { p } else { p - 1.0 };
                let name = QUANTITIES[k];
                // At the level at which it was measured.
                targets.push(Target::error(name, TIMES * error).at_level(3).of(method));
                targets.push(Target::order(name, order.min(whole) - MARGIN).of(method));
            }
        }
        targets
    }

    fn measure(&self, lab: &Lab, level: u32, method: &str) -> Result<Measurement, LabError> {
        let (plane, order, kind) = parts(method);
        let content = |what: String| LabError::Content {
            path: lab.out.join(self.name()).join(method),
            what,
        };
        let sides = if plane { PLANE } else { SPACE };
        let side = sides.get(level as usize - 1).copied();
        let side = side.ok_or_else(|| content(format!("there is no level {level}")))?;
        let found = if plane {
            timed(&Points::<2>::new(kind, side), order)
        } else {
            timed(&Points::<3>::new(kind, side), order)
        };
        found.map_err(|e| content(e.to_string()))
    }
}

/// Errors and run time of all operators of a cloud.
fn timed<const D: usize>(points: &Points<D>, order: u8) -> Result<Measurement, wls::Error> {
    let (mut times, mut errors) = (Vec::new(), Errors::new());
    while times.len() < REPEATS {
        let start = Instant::now();
        let stencils = points.stencils(order)?;
        times.push(start.elapsed().as_secs_f64());
        if times.len() == 1 {
            errors = points.smooth(&stencils, order);
            let worst = points.polynomial(&stencils, order);
            errors.insert("polynomial".to_owned(), worst);
        }
        if times[0] > SHORT_S {
            break;
        }
    }
    times.sort_by(f64::total_cmp);
    let run = Finished::here(times[times.len() / 2]);
    Ok(Measurement::of(
        run,
        points.count(),
        points.spacing(),
        errors,
    ))
}
