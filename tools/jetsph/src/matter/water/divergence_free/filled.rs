//! What a row of the filled lattice has, by which others are measured.

use kernels::Kernel;

/// Determinant of the moments, over that of the lattice's, up to which they span no space, and from which on they do.
const SPANNED: [f64; 2] = [0.05, 0.20];

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

    /// The inverse of moments that are the row's own in `part`, and the lattice's for the rest; the lattice's, too, where
    /// the row's own are those of a plane or line.
    pub(super) fn inverse(&self, moments: [f64; 6], part: f64) -> [f64; 6] {
        let spanned = determinant(moments, minors(moments)) / self.moment.powi(3);
        let part = part * within(spanned, SPANNED);
        let lattice = |i: usize| if i < 3 { self.moment } else { 0.0 };
        inverse(std::array::from_fn(|i| {
            part * moments[i] + (1.0 - part) * lattice(i)
        }))
    }
}

/// Inverse of a symmetric matrix.
fn inverse(matrix: [f64; 6]) -> [f64; 6] {
    let minors = minors(matrix);
    let determinant = determinant(matrix, minors);
    minors.map(|x| x / determinant)
}

fn minors([a, b, c, d, e, f]: [f64; 6]) -> [f64; 6] {
    [
        b * c - f * f,
        a * c - e * e,
        a * b - d * d,
        e * f - d * c,
        d * f - e * b,
        d * e - a * f,
    ]
}

fn determinant([a, _, _, d, e, _]: [f64; 6], minors: [f64; 6]) -> f64 {
    a * minors[0] + d * minors[3] + e * minors[4]
}

/// How far `x` is on its way through a range, 0 to 1.
pub(super) fn within(x: f64, [from, to]: [f64; 2]) -> f64 {
    ((x - from) / (to - from)).clamp(0.0, 1.0)
}
