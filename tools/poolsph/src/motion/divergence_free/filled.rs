//! What a row of the filled lattice has, by which others are measured.

use kernels::CubicSpline;

use particles::Matter;

/// Determinant of the moments, over that of the lattice's, up to which they span no space, and from which on they do.
const SPANNED: [f64; 2] = [0.05, 0.20];

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
    /// The inverse of moments that are the row's own in `part`, and the lattice's for the rest; the lattice's, too, where the
    /// row's own are those of a plane or line.
    pub(super) fn inverse(&self, moments: [f64; 6], part: f64) -> [f64; 6] {
        let spanned = determinant(moments, minors(moments)) / self.moment.powi(3);
        let part = part * within(spanned, SPANNED);
        let lattice = |i: usize| if i < 3 { self.moment } else { 0.0 };
        inverse(std::array::from_fn(|i| {
            part * moments[i] + (1.0 - part) * lattice(i)
        }))
    }

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
