//! What a row of the filled lattice has, by which others are measured.

use kernels::Kernel;

/// Sums over the filled lattice, each particle counting by its volume.
#[derive(Debug, Clone, Copy)]
pub(super) struct Filled {
    /// Of W, the own one included \[1\].
    pub(super) number: f64,
    /// Of w = -(dW/dr)/r \[1/m2\].
    pub(super) weight: f64,
    /// Of w x^2 along one axis \[1\].
    pub(super) moment: f64,
    /// Mean of r^2 by w over the neighbours on one side of a layer \[m2\].
    pub(super) beside: f64,
    /// d \[m\].
    pub(super) spacing: f64,
}

impl Filled {
    /// The lattice of spacing `d` \[m\] in `axes` axes.
    pub(super) fn of(kernel: &impl Kernel, d: f64, axes: usize) -> Self {
        let reach = (kernel.support() / d).ceil() as i32;
        let volume = d.powi(axes as i32);
        let mut filled = Self {
            number: volume * kernel.value(0.0),
            weight: 0.0,
            moment: 0.0,
            beside: 0.0,
            spacing: d,
        };
        let (mut side, deep) = (0.0, if axes == 3 { reach } else { 0 });
        let axis = || -reach..=reach;
        let points =
            axis().flat_map(|i| axis().flat_map(move |j| (-deep..=deep).map(move |k| [i, j, k])));
        for [i, j, k] in points.filter(|point| *point != [0; 3]) {
            let r = d * f64::from(i * i + j * j + k * k).sqrt();
            let w = -volume * kernel.slope(r);
            filled.number += volume * kernel.value(r);
            filled.weight += w;
            filled.moment += w * (d * f64::from(i)).powi(2);
            if i > 0 {
                side += w;
                filled.beside += w * r * r;
            }
        }
        filled.beside /= side;
        filled
    }
}
