//! Constants of the filled cubic lattice, on which the metal starts.
//!
//! The kernel sums of a lattice are not the integrals that they stand for; for h = d the density
//! sum is 1.0003 and the first moment of the gradient 1.0203 instead of 1. Dividing by them makes
//! a lattice at rest exactly dense and its pressure gradient exact.

use kernels::CubicSpline;
use particles::Matter;
use shapes::frame::{along, squared};

/// Waves per axis that the search for the stiffest mode tries.
const WAVES: u32 = 9;

/// Kernel sums over the points of a cubic lattice around one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Sum of W, the own one included \[1/m3\].
    pub number: f64,
    /// Sum of W over the points on one side of a layer \[1/m3\].
    pub beside: f64,
    /// -V sum of (dW/dr)/r x^2: 1 in the continuum.
    pub moment: f64,
    /// Sum of |grad W|^2 \[1/m8\].
    pub gradient_squared: f64,
    /// Largest of |sum of grad W sin(k.r)|^2 over all waves k, in parts of the sum above: the
    /// stiffest mode of the pressure, 2.8 for h = d.
    pub stiffest: f64,
}

impl Lattice {
    /// The lattice of `metal`.
    #[must_use]
    pub fn of(metal: Matter) -> Self {
        let kernel = CubicSpline::<3>::new(metal.smoothing_length);
        let d = metal.spacing;
        let reach = (kernel.support() / d).ceil() as i32;
        let (mut number, mut beside, mut moment, mut gradient_squared) = (0.0, 0.0, 0.0, 0.0);
        let mut points = Vec::new();
        for i in -reach..=reach {
            for j in -reach..=reach {
                for k in -reach..=reach {
                    let r = d * f64::from(i * i + j * j + k * k).sqrt();
                    number += kernel.value(r);
                    if i > 0 {
                        beside += kernel.value(r);
                    }
                    let slope = kernel.slope(r);
                    moment -= metal.volume() * slope * (d * f64::from(i)).powi(2);
                    gradient_squared += (slope * r).powi(2);
                    points.push(([i, j, k].map(f64::from), slope * d));
                }
            }
        }
        Self {
            number,
            beside,
            moment,
            gradient_squared,
            stiffest: stiffest(&points) / gradient_squared,
        }
    }
}

/// Largest |sum of grad W sin(k.r)|^2 over waves along and across the axes of the lattice, for
/// points (r/d, |grad W| d/r).
fn stiffest(points: &[([f64; 3], f64)]) -> f64 {
    let mut largest: f64 = 0.0;
    for wave in 0..WAVES.pow(3) {
        let index = [wave % WAVES, wave / WAVES % WAVES, wave / WAVES / WAVES];
        let k = index.map(|i| std::f64::consts::PI * f64::from(i) / f64::from(WAVES - 1));
        let mut sum = [0.0; 3];
        for (r, slope) in points {
            let phase = k[0] * r[0] + k[1] * r[1] + k[2] * r[2];
            sum = along(sum, slope * phase.sin(), *r);
        }
        largest = largest.max(squared(sum));
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_tend_to_the_integrals() {
        let with = |ratio: f64| {
            Lattice::of(Matter {
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
        assert!((narrow.stiffest - 2.8).abs() < 0.03, "{narrow:?}");
    }
}
