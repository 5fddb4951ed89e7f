//! How deep below the surface a place lies, from the colour there.
//!
//! A half-space of metal smoothed by the kernel has at the depth s the colour
//!
//! ```text
//! C(s) = 1/2 + integral of w from 0 to s,    w(s) = 2 pi integral of W(r) r from |s| to 2h
//! ```
//!
//! where w is the kernel integrated over planes. C rises with s, so that s follows from C.

use kernels::CubicSpline;
use props::Table;

/// Steps of the integration over one smoothing length.
const STEPS: usize = 512;
/// Largest depth told apart, in smoothing lengths; the colour hardly changes beyond.
const DEEPEST: f64 = 1.9;

/// Depth as a function of the colour.
#[derive(Debug, Clone)]
pub(super) struct Depth {
    /// None only if the kernel were degenerate.
    table: Option<Table>,
    deepest: f64,
}

impl Depth {
    pub(super) fn new(kernel: CubicSpline<3>) -> Self {
        let h = kernel.smoothing_length();
        let step = h / STEPS as f64;
        let middle = |k: usize| (k as f64 + 0.5) * step;
        let nodes = (DEEPEST * STEPS as f64) as usize;
        // w at the middles of the steps, from the outside in; midpoint rule throughout.
        let mut plane = vec![0.0; 2 * STEPS + 1];
        for k in (0..2 * STEPS).rev() {
            let r = middle(k);
            plane[k] = plane[k + 1] + std::f64::consts::TAU * kernel.value(r) * r * step;
        }
        let mut colour = vec![0.5];
        for k in 0..nodes {
            let density = 0.5 * (plane[k] + plane[k + 1]);
            colour.push(colour[k] + density * step);
        }
        let mirrored = (1..=nodes)
            .rev()
            .map(|k| (1.0 - colour[k], -(k as f64) * step));
        let rows = mirrored.chain((0..=nodes).map(|k| (colour[k], k as f64 * step)));
        let (x, y) = rows.unzip();
        Self {
            table: Table::new(x, y).ok(),
            deepest: DEEPEST * h,
        }
    }

    /// Depth \[m\], positive inside the metal.
    #[inline]
    pub(super) fn at(&self, colour: f64) -> f64 {
        self.table
            .as_ref()
            .map_or(self.deepest, |table| table.held(colour))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colour of a half-space of fine points at the depth s.
    fn colour(kernel: CubicSpline<3>, s: f64) -> f64 {
        let n = 30;
        let d = kernel.smoothing_length() / f64::from(n);
        let mut sum = 0.0;
        for i in -2 * n..2 * n {
            for j in -2 * n..2 * n {
                for k in 0..4 * n {
                    let at = |m: i32| (f64::from(m) + 0.5) * d;
                    let (x, y, z) = (at(i), at(j), at(k) - s);
                    sum += d * d * d * kernel.value((x * x + y * y + z * z).sqrt());
                }
            }
        }
        sum
    }

    #[test]
    fn depth_undoes_the_colour_of_a_half_space() {
        let kernel = CubicSpline::<3>::new(0.7);
        let depth = Depth::new(kernel);
        for s in [-0.6, 0.0, 0.35, 0.9] {
            let found = depth.at(colour(kernel, s));
            assert!((found - s).abs() < 1e-3, "{found} for {s}");
        }
    }
}
