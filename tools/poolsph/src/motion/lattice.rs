//! Constants of the filled cubic lattice, on which the metal starts.
//!
//! The kernel sums of a lattice are not the integrals that they stand for; for h = d the density
//! sum is 1.0003 and the first moment of the gradient 1.0203 instead of 1. Dividing by them makes
//! a lattice at rest exactly dense and its pressure gradient exact.

use kernels::CubicSpline;

use crate::state::Metal;

/// Kernel sums over the points of a cubic lattice around one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Sum of W, the own one included \[1/m3\].
    pub number: f64,
    /// -V sum of (dW/dr)/r x^2: 1 in the continuum.
    pub moment: f64,
    /// Sum of |grad W|^2 \[1/m8\].
    pub gradient_squared: f64,
}

impl Lattice {
    /// The lattice of `metal`.
    #[must_use]
    pub fn of(metal: Metal) -> Self {
        let kernel = CubicSpline::<3>::new(metal.smoothing_length);
        let d = metal.spacing;
        let reach = (kernel.support() / d).ceil() as i32;
        let (mut number, mut moment, mut gradient_squared) = (0.0, 0.0, 0.0);
        for i in -reach..=reach {
            for j in -reach..=reach {
                for k in -reach..=reach {
                    let r = d * f64::from(i * i + j * j + k * k).sqrt();
                    number += kernel.value(r);
                    let slope = kernel.slope(r);
                    moment -= metal.volume() * slope * (d * f64::from(i)).powi(2);
                    gradient_squared += (slope * r).powi(2);
                }
            }
        }
        Self {
            number,
            moment,
            gradient_squared,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_tend_to_the_integrals() {
        let with = |ratio: f64| {
            Lattice::of(Metal {
                density: 1.0,
                spacing: 1.0,
                smoothing_length: ratio,
            })
        };
        let wide = with(3.0);
        assert!(
            (wide.number - 1.0).abs() < 1e-4 && (wide.moment - 1.0).abs() < 1e-3,
            "{wide:?}"
        );
        let narrow = with(1.0);
        assert!(
            (narrow.number - 1.0003).abs() < 1e-3 && (narrow.moment - 1.0203).abs() < 1e-3,
            "{narrow:?}"
        );
    }
}
