//! How offsets are measured at a point.

use crate::error::Error;

/// The local spacing, and how it differs between directions.
///
/// An offset dx becomes s = M dx / L with the spacing L and a symmetric matrix M: s = 1 is one
/// spacing away. Beside a surface that bends, s follows the surface: with its unit normal n and
/// curvatures K, offsets along the normal count from the surface through the point,
///
/// s = M (dx + n (dx . K dx) / 2) / L,
///
/// so that points of one layer lie level however thin the layers are. The metric decides which points
/// are near, how much they weigh, and in which coordinates the polynomial is fitted; of a straight one
/// the polynomials themselves are the same, of a bent one those of s. Derivatives are those along x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metric<const D: usize> {
    pub(crate) spacing: f64,
    pub(crate) layer: Option<Layer<D>>,
    /// Greatest distance of a point at |s| = 1, in spacings.
    pub(crate) widest: f64,
    /// Least one.
    pub(crate) narrowest: f64,
}

/// Thin layers along a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Layer<const D: usize> {
    normal: [f64; D],
    /// Spacing along the surface over that along its normal.
    ratio: f64,
    /// How the surface bends, where offsets follow it.
    bend: Option<Bend<D>>,
}

/// How a surface bends.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bend<const D: usize> {
    /// Direction of the first curvature.
    along: [f64; D],
    /// Principal curvatures, positive where the surface bends away from the normal \[1/m\].
    curvature: [f64; 2],
}

/// Offsets along the surface within which points count as straight above or below, in spacings.
const ABOVE: f64 = 0.4;

impl<const D: usize> Layer<D> {
    /// K v.
    #[inline]
    fn curved(&self, v: &[f64; D]) -> [f64; D] {
        let Some(bend) = &self.bend else {
            return [0.0; D];
        };
        let [first, second] = bend.curvature;
        let up = dot(&self.normal, v);
        let flat = (first - second) * dot(&bend.along, v);
        std::array::from_fn(|a| second * (v[a] - up * self.normal[a]) + flat * bend.along[a])
    }

    fn alike(&self, other: &Self, spacings: [f64; 2], limit: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < limit;
        let all = |a: &[f64; D], b: &[f64; D]| a.iter().zip(b).all(|(a, b)| near(*a, *b));
        let bent = match (&self.bend, &other.bend) {
            (None, None) => true,
            (Some(a), Some(b)) => {
                let same =
                    |k: usize| near(a.curvature[k] * spacings[0], b.curvature[k] * spacings[1]);
                all(&a.along, &b.along) && (0..2).all(same)
            }
            _ => false,
        };
        bent && near(self.ratio, other.ratio) && all(&self.normal, &other.normal)
    }
}

fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<const D: usize> Metric<D> {
    /// The same in all directions: `spacing` L_i \[m\].
    #[must_use]
    pub fn round(spacing: f64) -> Self {
        Self {
            spacing,
            layer: None,
            widest: 1.0,
            narrowest: 1.0,
        }
    }

    /// Thin layers along a surface: spacing `along_normal` \[m\] along the unit `normal`, and
    /// `along_surface` \[m\] across it.
    #[must_use]
    pub fn layered(normal: [f64; D], along_normal: f64, along_surface: f64) -> Self {
        let ratio = along_surface / along_normal;
        Self {
            spacing: along_surface,
            layer: Some(Layer {
                normal,
                ratio,
                bend: None,
            }),
            widest: 1.0_f64.max(ratio.recip()),
            narrowest: 1.0_f64.min(ratio.recip()),
        }
    }

    /// The same following a surface with principal `curvature`s \[1/m\], positive where it bends away from the normal; the
    /// first is that along the unit direction `along`. Points straight above and below weigh more than others, the more
    /// the thinner the layers are.
    #[must_use]
    pub fn bent(mut self, along: [f64; D], curvature: [f64; 2]) -> Self {
        if let Some(layer) = &mut self.layer {
            layer.bend = Some(Bend { along, curvature });
        }
        self
    }

    /// Whether offsets follow a surface.
    #[must_use]
    pub fn follows(&self) -> bool {
        self.layer.is_some_and(|l| l.bend.is_some())
    }

    /// The same with offsets along the tangent plane: as thick as the surface bends within a spacing, so that points of
    /// one layer are not layers apart.
    #[must_use]
    pub fn straight(self) -> Self {
        match self.layer {
            Some(layer) if self.follows() => {
                let bow = 0.5 * self.most_curved() * self.spacing;
                let across = layer.ratio.recip().max(bow).min(1.0) * self.spacing;
                Self::layered(layer.normal, across, self.spacing)
            }
            _ => self,
        }
    }

    /// How many times as wide as thick layers are; 1 where all directions are alike.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.layer.map_or(1.0, |layer| layer.ratio)
    }

    /// The greater principal curvature \[1/m\].
    fn most_curved(&self) -> f64 {
        let bend = self.layer.as_ref().and_then(|l| l.bend.as_ref());
        bend.map_or(0.0, |b| b.curvature[0].abs().max(b.curvature[1].abs()))
    }

    /// The same beside a surface that has turned, so that its unit normal is `normal`.
    #[must_use]
    pub fn beside(mut self, normal: [f64; D]) -> Self {
        if let Some(layer) = &mut self.layer {
            layer.normal = normal;
            if let Some(bend) = &mut layer.bend {
                let up = dot(&bend.along, &normal);
                let flat: [f64; D] = std::array::from_fn(|a| bend.along[a] - up * normal[a]);
                let length = dot(&flat, &flat).sqrt();
                bend.along = flat.map(|a| a / length);
            }
        }
        self
    }

    /// The same beyond a plane across `axis`.
    #[must_use]
    pub fn mirrored(mut self, axis: usize) -> Self {
        if let Some(layer) = &mut self.layer {
            layer.normal[axis] = -layer.normal[axis];
            if let Some(bend) = &mut layer.bend {
                bend.along[axis] = -bend.along[axis];
            }
        }
        self
    }

    /// Normal of the surface that layers follow; none where all directions are alike.
    #[must_use]
    pub fn normal(&self) -> Option<[f64; D]> {
        self.layer.as_ref().map(|layer| layer.normal)
    }

    /// Spacing \[m\]; along the surface, where there are layers.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Volume of the cell of a point, about \[m^D\].
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.spacing.powi(D as i32) * self.widest * self.narrowest
    }

    /// Distance within which all points at |s| <= `radius` lie \[m\].
    #[must_use]
    pub fn reach(&self, radius: f64) -> f64 {
        let plain = radius * self.widest * self.spacing;
        plain * (1.0 + 0.5 * self.most_curved() * radius * self.spacing)
    }

    /// The coordinates s of an offset.
    #[inline]
    #[must_use]
    pub fn scaled(&self, dx: [f64; D]) -> [f64; D] {
        let inverse = self.spacing.recip();
        let Some(layer) = &self.layer else {
            return dx.map(|x| x * inverse);
        };
        let bow = 0.5 * dot(&layer.curved(&dx), &dx);
        let more = (layer.ratio - 1.0) * dot(&layer.normal, &dx) + layer.ratio * bow;
        std::array::from_fn(|a| (dx[a] + more * layer.normal[a]) * inverse)
    }

    /// The direction in which the coordinates s rise where offsets do along the unit vector `n`: `n . dx` over the
    /// coordinates.
    pub(crate) fn upward(&self, n: [f64; D]) -> [f64; D] {
        let Some(layer) = &self.layer else {
            return n;
        };
        let less = (layer.ratio.recip() - 1.0) * dot(&layer.normal, &n);
        let form: [f64; D] = std::array::from_fn(|a| n[a] + less * layer.normal[a]);
        let length = dot(&form, &form).sqrt();
        form.map(|x| x / length)
    }

    /// What the derivative along `v` at the offset dx is along the coordinates s: `v . d s/dx L`.
    #[inline]
    pub(crate) fn turned(&self, v: [f64; D], dx: &[f64; D]) -> [f64; D] {
        let Some(layer) = &self.layer else {
            return v;
        };
        let tilt = dot(&layer.curved(dx), &v);
        let more = (layer.ratio - 1.0) * dot(&layer.normal, &v) + layer.ratio * tilt;
        std::array::from_fn(|a| v[a] + more * layer.normal[a])
    }

    /// What the second derivative along axes `a` and `b` has of first ones along the coordinates s: `d2 s/dx_a dx_b L^2`.
    #[inline]
    pub(crate) fn bend(&self, a: usize, b: usize) -> [f64; D] {
        let Some(layer) = &self.layer else {
            return [0.0; D];
        };
        let axis = std::array::from_fn(|c| f64::from(u8::from(c == a)));
        let curved = layer.curved(&axis)[b] * layer.ratio * self.spacing;
        layer.normal.map(|n| n * curved)
    }

    /// What weights of points straight above and below are multiplied by in a fit of this order.
    ///
    /// What a polynomial lacks along the surface, a part of the field that does not depend on how thin the layers are,
    /// reaches slopes along the normal over the thickness of a layer. Points straight above and below, which know these
    /// slopes by themselves, weigh so much more that it does not.
    pub(crate) fn above(&self, order: u8) -> f64 {
        let layer = self.layer.filter(|l| l.bend.is_some());
        let power = if order > 2 { 1.5 } else { 2.0 };
        layer.map_or(1.0, |l| l.ratio.max(1.0).powf(power))
    }

    /// What the weight of a point at `s` is multiplied by, if straight above it is by `above`.
    pub(crate) fn heavier(&self, s: &[f64; D], above: f64) -> f64 {
        let Some(layer) = &self.layer else {
            return 1.0;
        };
        let up = dot(&layer.normal, s);
        let aside = (dot(s, s) - up * up).max(0.0) / (ABOVE * ABOVE);
        1.0 + (above - 1.0) * (1.0 - aside).max(0.0)
    }

    /// Whether offsets of the same s are measured alike.
    pub(crate) fn alike(&self, other: &Self, limit: f64) -> bool {
        match (&self.layer, &other.layer) {
            (None, None) => true,
            (Some(a), Some(b)) => a.alike(b, [self.spacing, other.spacing], limit),
            _ => false,
        }
    }

    pub(crate) fn check(&self, point: usize) -> Result<(), Error> {
        let sum = |l: &Layer<D>| l.normal.iter().sum::<f64>() + l.ratio + self.most_curved();
        let sound = self.spacing > 0.0
            && self.spacing.is_finite()
            && self.widest > 0.0
            && self.widest.is_finite()
            && self.layer.as_ref().map_or(0.0, sum).is_finite();
        sound.then_some(()).ok_or(Error::BadSpacing {
            point,
            spacing: self.spacing,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_measure_across_and_along() {
        let root = 0.5_f64.sqrt();
        let metric = Metric::layered([root, root, 0.0], 0.04, 0.25);
        let across = metric.scaled([0.04 * root, 0.04 * root, 0.0]);
        let along = metric.scaled([0.25 * root, -0.25 * root, 0.0]);
        let length = |s: [f64; 3]| s.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length(across) - 1.0).abs() < 1e-12);
        assert!((length(along) - 1.0).abs() < 1e-12);
        assert!((length(metric.scaled([0.0, 0.0, 0.25])) - 1.0).abs() < 1e-12);
        assert!((metric.volume() / (0.04 * 0.25 * 0.25) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn bent_layers_follow_their_surface() {
        // A ball of radius 2 and a cylinder of radius 2 around z.
        let n = [0.6, 0.8, 0.0];
        for (flat, curvature) in [
            ([0.8, -0.6, 0.0], [0.5, 0.5]),
            ([0.8, -0.6, 0.0], [0.5, 0.0]),
        ] {
            let metric = Metric::layered(n, 0.01, 0.2).bent(flat, curvature);
            let away = 0.04;
            for angle in [0.02_f64, -0.1] {
                let d: [f64; 3] = std::array::from_fn(|k| {
                    (2.0 + away) * (n[k] * angle.cos() + flat[k] * angle.sin()) - 2.0 * n[k]
                });
                let s = metric.scaled(d);
                let up: f64 = (0..3).map(|k| s[k] * n[k]).sum();
                assert!((up * 0.01 / away - 1.0).abs() < angle * angle, "{up}");
            }
            let along = metric.scaled([0.0, 0.0, 0.2]);
            let up: f64 = (0..3).map(|k| along[k] * n[k]).sum();
            assert!((up * 0.01 - 0.5 * curvature[1] * 0.04).abs() < 1e-12);
            assert!((along[2] - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn points_straight_above_weigh_more() {
        let flat = Metric::layered([0.0, 0.0, 1.0], 0.05, 0.2);
        let bent = flat.bent([1.0, 0.0, 0.0], [0.0; 2]);
        let heavier = |metric: Metric<3>, aside: f64, order: u8| {
            metric.heavier(&[aside, 0.0, 1.0], metric.above(order))
        };
        assert!((heavier(bent, 0.0, 2) - 16.0).abs() < 1e-12);
        assert!((heavier(bent, 0.0, 4) - 8.0).abs() < 1e-12);
        assert!((heavier(bent, 0.5, 2) - 1.0).abs() < 1e-12);
        assert!((heavier(flat, 0.0, 2) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_straight_metric_is_as_thick_as_the_bent_one_bends() {
        let n = [0.0, 0.0, 1.0];
        let bent = |across: f64| Metric::layered(n, across, 0.2).bent([1.0, 0.0, 0.0], [0.5, 0.25]);
        // 0.2^2 / 4 = 0.01.
        for (across, thick) in [(0.001, 0.01), (0.03, 0.03)] {
            let straight = bent(across).straight();
            assert!(!straight.follows());
            assert!((straight.scaled(n)[2] * thick - 1.0).abs() < 1e-12);
        }
        let plain = Metric::layered(n, 0.001, 0.2);
        assert_eq!(plain.straight(), plain);
    }
}
