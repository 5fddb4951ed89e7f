//! How deep below the surface a place lies, from the colour there and its gradient.
//!
//! A half-space of metal smoothed by the kernel has at the depth s the colour
//!
//! ```text
//! C(s) = 1/2 + integral of w from 0 to s,    |grad C| = w(s) = 2 pi integral of W(r) r from |s| to 2h
//! ```
//!
//! where w is the kernel integrated over planes. Both s(C) and s(C / |grad C|) follow. The first
//! knows the inside by C = 1, but asks for metal as dense as it should be; a flow that is kept at one
//! density draws its surface layer together until C is 1 there too. The second does not know how
//! densely the metal is packed, but takes every unevenness of the inside for a surface. So the second
//! is believed where |grad C| is that of a surface, and the first where it is not.

use kernels::CubicSpline;
use props::Table;

/// Steps of the integration over one smoothing length.
const STEPS: usize = 512;
/// Largest depth told apart, in smoothing lengths; the colour hardly changes beyond.
const DEEPEST: f64 = 1.9;
/// h |grad C| up to which it may be unevenness of the inside.
const UNEVEN: f64 = 0.2;
/// h |grad C| from which on it is a surface; the outermost layer of a lattice has 0.49.
const CERTAIN: f64 = 0.35;

/// Depth as a function of the colour and its gradient.
#[derive(Debug, Clone)]
pub(super) struct Depth {
    /// Over the colour; none only if the kernel were degenerate.
    dense: Option<Table>,
    /// Over the colour divided by the length of its gradient.
    packed: Option<Table>,
    smoothing_length: f64,
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
        let depth = (-(nodes as i64)..=nodes as i64).map(|k| k as f64 * step);
        let outside = (1..=nodes).rev().map(|k| (1.0 - colour[k], plane[k]));
        let inside = (0..=nodes).map(|k| (colour[k], plane[k]));
        let (colours, slopes): (Vec<f64>, Vec<f64>) = outside.chain(inside).unzip();
        let ratios = colours.iter().zip(slopes).map(|(c, w)| c / w).collect();
        Self {
            dense: Table::new(colours, depth.clone().collect()).ok(),
            packed: Table::new(ratios, depth.collect()).ok(),
            smoothing_length: h,
        }
    }

    /// Depth \[m\], positive inside the metal, from the colour and the length of its gradient \[1/m\].
    #[inline]
    pub(super) fn at(&self, colour: f64, slope: f64) -> f64 {
        let (Some(dense), Some(packed)) = (&self.dense, &self.packed) else {
            return DEEPEST * self.smoothing_length;
        };
        let steep = slope * self.smoothing_length;
        let trust = ((steep - UNEVEN) / (CERTAIN - UNEVEN)).clamp(0.0, 1.0);
        let mut depth = (1.0 - trust) * dense.held(colour);
        if trust > 0.0 {
            depth += trust * packed.held(colour / slope);
        }
        depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colour, and its slope, of a half-space of fine points at the depth s.
    fn colour(kernel: CubicSpline<3>, s: f64) -> (f64, f64) {
        let n = 30;
        let d = kernel.smoothing_length() / f64::from(n);
        let (mut sum, mut slope) = (0.0, 0.0);
        for i in -2 * n..2 * n {
            for j in -2 * n..2 * n {
                for k in 0..4 * n {
                    let at = |m: i32| (f64::from(m) + 0.5) * d;
                    let (x, y, z) = (at(i), at(j), at(k) - s);
                    let sample = kernel.sample((x * x + y * y + z * z).sqrt());
                    sum += d * d * d * sample.value;
                    slope -= d * d * d * sample.slope * z;
                }
            }
        }
        (sum, slope)
    }

    #[test]
    fn depth_undoes_the_colour_of_a_half_space() {
        let kernel = CubicSpline::<3>::new(0.7);
        let depth = Depth::new(kernel);
        for s in [-0.6, 0.0, 0.35, 0.9] {
            let (colour, slope) = colour(kernel, s);
            let found = depth.at(colour, slope);
            assert!((found - s).abs() < 1e-3, "{found} for {s}");
        }
    }

    #[test]
    fn the_outermost_layer_may_be_packed_densely() {
        let kernel = CubicSpline::<3>::new(0.7);
        let depth = Depth::new(kernel);
        for s in [0.0, 0.2, 0.35] {
            let (colour, slope) = colour(kernel, s);
            for packing in [0.9, 1.2, 1.5] {
                let found = depth.at(packing * colour, packing * slope);
                assert!((found - s).abs() < 1e-3, "{found} for {s}");
            }
        }
    }

    #[test]
    fn unevenness_of_the_inside_is_no_surface() {
        let depth = Depth::new(CubicSpline::<3>::new(0.7));
        for slope in [0.0, 0.1, 0.2] {
            assert!(depth.at(1.0, slope / 0.7) > 1.3);
        }
    }
}
