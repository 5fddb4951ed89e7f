//! A cross-section of the weld as two smooth fields: share of metal, share of fused metal.
//!
//! At a point of the plane `y = const` the share of metal is `sum V W(r)` over all particles, the
//! share of fused metal the same sum of `f V W(r)`, where `f` is the greatest part of its latent heat
//! that a particle has ever held, the part of it that the front of melting has passed. `W` is Wendland's C2
//! function with a support of two spacings, `21/(2 pi R^3) (1 - r/R)^4 (1 + 4 r/R)`, whose integral
//! over space is 1. Where metal ends in a plane the share is exactly one half on the plane, by
//! symmetry: surfaces and fusion lines are the lines of one half, not the outermost particles.

use std::f64::consts::PI;

/// Support of the smoothing in particle spacings.
pub(crate) const SUPPORT: f64 = 2.0;
/// Grid points per particle spacing.
const FINENESS: f64 = 8.0;

/// Particles as the measures need them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Metal<'a> {
    /// Positions x, y, z \[m\].
    pub(crate) position: &'a [[f64; 3]],
    /// Greatest part of the latent heat that each has ever held.
    pub(crate) fused: &'a [f64],
    /// Particle spacing d \[m\]; a particle stands for the volume d^3.
    pub(crate) spacing: f64,
}

/// Shares of metal on a grid in a plane.
#[derive(Debug, Clone)]
pub(crate) struct Section {
    /// Where the plane stands \[m\].
    pub(crate) place: f64,
    /// Horizontal coordinate of the columns \[m\], ascending.
    pub(crate) across: Vec<f64>,
    /// Height of the rows \[m\], ascending.
    pub(crate) up: Vec<f64>,
    /// Share of metal `[across][up]`.
    pub(crate) metal: Vec<f64>,
    /// Share of fused metal `[across][up]`.
    pub(crate) fused: Vec<f64>,
}

/// Which plane is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Plane {
    /// y = const: across the weld.
    Across,
    /// x = const: along the weld.
    Along,
}

impl Plane {
    /// Indices of the horizontal coordinate and of the normal.
    fn axes(self) -> (usize, usize) {
        match self {
            Plane::Across => (0, 1),
            Plane::Along => (1, 0),
        }
    }
}

impl Section {
    /// Cuts the metal at `place` \[m\].
    pub(crate) fn cut(metal: &Metal<'_>, plane: Plane, place: f64) -> Self {
        let (flat, normal) = plane.axes();
        let reach = SUPPORT * metal.spacing;
        let near = |p: &[f64; 3]| (p[normal] - place).abs() < reach;
        let step = metal.spacing / FINENESS;
        let across = axis(
            metal.position.iter().filter(|p| near(p)).map(|p| p[flat]),
            reach,
            step,
        );
        let up = axis(
            metal.position.iter().filter(|p| near(p)).map(|p| p[2]),
            reach,
            step,
        );
        let size = across.len() * up.len();
        let mut section = Self {
            place,
            across,
            up,
            metal: vec![0.0; size],
            fused: vec![0.0; size],
        };
        let volume = metal.spacing.powi(3);
        for (p, fused) in metal.position.iter().zip(metal.fused) {
            if near(p) {
                section.spread([p[flat], p[2]], p[normal] - place, reach, volume, *fused);
            }
        }
        section
    }

    /// Adds one particle to the fields.
    fn spread(&mut self, at: [f64; 2], off: f64, reach: f64, volume: f64, fused: f64) {
        let rows = self.up.len();
        let (Some(a0), Some(u0)) = (self.across.first().copied(), self.up.first().copied()) else {
            return;
        };
        let step = self.up[1] - u0;
        let range = |middle: f64, origin: f64, count: usize| {
            let low = ((middle - reach - origin) / step).ceil().max(0.0) as usize;
            let high = ((middle + reach - origin) / step).floor().max(0.0) as usize;
            low..(high + 1).min(count)
        };
        for i in range(at[0], a0, self.across.len()) {
            for k in range(at[1], u0, rows) {
                let (da, du) = (self.across[i] - at[0], self.up[k] - at[1]);
                let w = volume * wendland((da * da + du * du + off * off).sqrt(), reach);
                self.metal[i * rows + k] += w;
                self.fused[i * rows + k] += fused * w;
            }
        }
    }

    /// Share of the metal that has been fused, `[across][up]`; 0 where there is no metal.
    pub(crate) fn fused_fraction(&self) -> Vec<f64> {
        self.metal
            .iter()
            .zip(&self.fused)
            .map(|(all, fused)| if *all > 1e-3 { fused / all } else { 0.0 })
            .collect()
    }
}

/// Grid points at whole multiples of `step` around the values.
fn axis(values: impl Iterator<Item = f64>, reach: f64, step: f64) -> Vec<f64> {
    let (low, high) = values
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
            (l.min(v), h.max(v))
        });
    if low > high {
        return Vec::new();
    }
    let first = ((low - reach) / step).floor() as i64;
    let last = ((high + reach) / step).ceil() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// Wendland's C2 function in three dimensions with support `reach`.
fn wendland(r: f64, reach: f64) -> f64 {
    let q = r / reach;
    if q >= 1.0 {
        return 0.0;
    }
    21.0 / (2.0 * PI * reach.powi(3)) * (1.0 - q).powi(4) * (1.0 + 4.0 * q)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smoothing_adds_up_to_one() {
        let n = 4000;
        let sum: f64 = (0..n)
            .map(|i| (f64::from(i) + 0.5) / f64::from(n) * 2.0)
            .map(|r| 4.0 * PI * r * r * wendland(r, 2.0) * 2.0 / f64::from(n))
            .sum();
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    }

    #[test]
    fn the_share_is_one_half_on_a_plane_surface() {
        let d = 1.0;
        let mut position = Vec::new();
        for i in -6..6 {
            for j in -6..6 {
                for k in -6..0 {
                    position.push([f64::from(i) + 0.5, f64::from(j) + 0.5, f64::from(k) + 0.5]);
                }
            }
        }
        let fused = vec![0.0; position.len()];
        let metal = Metal {
            position: &position,
            fused: &fused,
            spacing: d,
        };
        let section = Section::cut(&metal, Plane::Across, 0.3);
        let row = section.up.iter().position(|z| z.abs() < 1e-9).unwrap();
        for i in 0..section.across.len() {
            if section.across[i].abs() < 3.0 {
                let share = section.metal[i * section.up.len() + row];
                assert!((share - 0.5).abs() < 0.02, "{share}");
            }
        }
    }
}
