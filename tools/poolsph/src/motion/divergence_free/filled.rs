//! What a row of the filled lattice has, by which others are measured.

use kernels::CubicSpline;

use particles::Matter;

/// Sums over the filled lattice.
#[derive(Debug, Clone, Copy)]
pub(super) struct Filled {
    /// Of W, the own one included \[1/m3\].
    pub(super) number: f64,
    /// Of w \[1/m5\].
    pub(super) weight: f64,
    /// Of w x^2 along one axis \[1/m3\].
    pub(super) moment: f64,
    /// Of w over the neighbours in a layer \[1/m5\].
    pub(super) level: f64,
    /// Of w over the neighbours on one side of a layer \[1/m5\], and the mean of r^2 by it \[m2\].
    pub(super) side: f64,
    pub(super) beside: f64,
    /// d \[m\].
    pub(super) spacing: f64,
}

impl Filled {
    /// The lattice of `metal`.
    pub(super) fn of(metal: Matter) -> Self {
        let kernel = CubicSpline::<3>::new(metal.smoothing_length);
        let d = metal.spacing;
        let reach = (kernel.support() / d).ceil() as i32;
        let mut filled = Self {
            number: kernel.value(0.0),
            weight: 0.0,
            moment: 0.0,
            level: 0.0,
            side: 0.0,
            beside: 0.0,
            spacing: d,
        };
        let axis = || -reach..=reach;
        let points = axis().flat_map(|i| axis().flat_map(move |j| axis().map(move |k| (i, j, k))));
        for (i, j, k) in points.filter(|point| *point != (0, 0, 0)) {
            let r = d * f64::from(i * i + j * j + k * k).sqrt();
            filled.number += kernel.value(r);
            filled.weight -= kernel.slope(r);
            filled.moment -= kernel.slope(r) * (d * f64::from(i)).powi(2);
            if i == 0 {
                filled.level -= kernel.slope(r);
            } else if i > 0 {
                filled.side -= kernel.slope(r);
                filled.beside -= kernel.slope(r) * r * r;
            }
        }
        filled.beside /= filled.side;
        filled
    }
}
