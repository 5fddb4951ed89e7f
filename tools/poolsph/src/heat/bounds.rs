//! Bounds of the step and of the temperature.

use kernels::CubicSpline;
use particles::Matter;
use shapes::frame::squared;

use super::caloric::Caloric;
use crate::stage::StageError;

/// The error of a temperature beyond the range of the properties, of a particle at a place \[m\].
pub(crate) fn outside(
    step: u64,
    particle: usize,
    place: [f64; 3],
    temperature: f64,
    caloric: &Caloric,
) -> StageError {
    let (low, high) = caloric.range();
    StageError::Diverged {
        step,
        particle,
        place,
        quantity: "temperature",
        value: temperature,
        limit: if temperature < low { low } else { high },
        unit: "K",
    }
}

/// sum r^2 W and sum W over the neighbours on the lattice \[1/m, 1/m3\].
pub(crate) fn moments(metal: Matter) -> (f64, f64) {
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
