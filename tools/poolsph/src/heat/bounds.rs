//! Bounds of the step and of the temperature.

use kernels::CubicSpline;

use super::caloric::Caloric;
use crate::stage::StageError;
use crate::state::{Metal, State};
use crate::vector::squared;

/// The error of a temperature beyond the range of the properties.
pub(crate) fn outside(state: &State, a: usize, temperature: f64, caloric: &Caloric) -> StageError {
    let (low, high) = caloric.range();
    StageError::Diverged {
        step: state.step,
        particle: a,
        place: state.position[a],
        quantity: "temperature",
        value: temperature,
        limit: if temperature < low { low } else { high },
        unit: "K",
    }
}

/// sum r^2 W and sum W over the neighbours on the lattice \[1/m, 1/m3\].
pub(crate) fn moments(metal: Metal) -> (f64, f64) {
    let kernel = CubicSpline::<3>::new(metal.smoothing_length);
    let reach = (metal.support() / metal.spacing).ceil() as i32;
    let (mut second, mut zeroth) = (0.0, 0.0);
    for i in -reach..=reach {
        for j in -reach..=reach {
            for k in -reach..=reach {
                let offset = [i, j, k].map(|n| f64::from(n) * metal.spacing);
                let r = squared(offset);
                if (i, j, k) != (0, 0, 0) {
                    let weight = kernel.value(r.sqrt());
                    second += r * weight;
                    zeroth += weight;
                }
            }
        }
    }
    (second, zeroth)
}
