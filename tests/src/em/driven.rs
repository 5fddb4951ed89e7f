//! A conducting tube with a curve of magnetisation about a wire whose current changes: fields along the radius alone.
//!
//! With `A` along z and `B = -dA/dr` around the wire, `(1/r) d(r H)/dr = -sigma dA/dt` in the tube, `r H = I / (2 pi)` at its inner
//! radius, and `A(R) = A_s(R) = -mu_0 I ln(R) / (2 pi)` on the wall, to which `r H` stays what it is outside, so that
//! `A = A_s(R) + mu_0 r H ln(R/r)` at the outer radius. In balances of rings between the middles of even intervals, by the
//! second-order backward formula, with Newton's method in each step.

use std::f64::consts::PI;

use super::MU0;
use super::saturation::Law;

/// Intervals across the tube, and steps in time.
const INTERVALS: usize = 600;
const STEPS: usize = 2000;
/// Change of flux densities for a difference of their fields \[T\].
const SHIFT: f64 = 1e-6;

/// The tube and its wire.
#[derive(Debug, Clone)]
pub struct Driven {
    /// Inner and outer radius \[m\].
    pub radii: [f64; 2],
    /// Radius of the wall, where the reaction is zero \[m\].
    pub wall: f64,
    /// Conductivity \[S/m\].
    pub conductivity: f64,
    /// Its magnetisation.
    pub law: Law,
}

/// One ring in a step: own coefficient, that of the next ring, and what is left.
type Ring = [f64; 3];

impl Driven {
    /// Flux densities around the wire at the middles of even intervals across the tube at the end of a time \[s\], the
    /// current \[A\] being `wave(t)`.
    #[must_use]
    pub fn march(&self, end: f64, wave: impl Fn(f64) -> f64) -> Vec<f64> {
        let step = end / STEPS as f64;
        let mut now = vec![0.0; INTERVALS + 1];
        let mut before = now.clone();
        for n in 1..=STEPS {
            // (3 A - 4 A_1 + A_2) / 2 h; the first by one value before.
            let [share, kept]: [f64; 2] = match n {
                1 => [1.0, 0.0],
                _ => [1.5, 0.5],
            };
            let past = now.iter().zip(&before);
            let past: Vec<f64> = past.map(|(a, b)| (share + kept) * a - kept * b).collect();
            before.clone_from(&now);
            self.step(
                &mut now,
                &past,
                share / step,
                1.0 / step,
                wave(n as f64 * step),
            );
        }
        (0..INTERVALS).map(|k| self.flux(&now, k)).collect()
    }

    fn wide(&self) -> f64 {
        (self.radii[1] - self.radii[0]) / INTERVALS as f64
    }

    fn flux(&self, a: &[f64], k: usize) -> f64 {
        (a[k] - a[k + 1]) / self.wide()
    }

    /// Newton's method for one step: `r H` beyond each ring less that before it, and `sigma dA/dt` times its area.
    fn step(&self, a: &mut [f64], past: &[f64], rate: f64, last: f64, current: f64) {
        let wide = self.wide();
        let middle = |k: usize| self.radii[0] + (k as f64 + 0.5) * wide;
        let away = (self.wall / self.radii[1]).ln() * MU0;
        let source = -MU0 * current / (2.0 * PI) * self.wall.ln();
        for _ in 0..60 {
            let (mut rings, mut lower) = (Vec::<Ring>::new(), Vec::<f64>::new());
            let (mut inner, mut slope) = (current / (2.0 * PI), 0.0);
            for k in 0..=INTERVALS {
                let from = if k == 0 { self.radii[0] } else { middle(k - 1) };
                let to = if k == INTERVALS {
                    self.radii[1]
                } else {
                    middle(k)
                };
                let area = 0.5 * (to * to - from * from) * self.conductivity;
                // r H beyond the ring, and what it changes by with A here; with A of the next ring it falls as much.
                let (outer, rise) = if k == INTERVALS {
                    ((a[k] - source) / away, 1.0 / away)
                } else {
                    let b = self.flux(a, k);
                    let field = |b: f64| self.law.field(b.abs()).copysign(b);
                    let slope = (field(b + SHIFT) - field(b - SHIFT)) / (2.0 * SHIFT);
                    (middle(k) * field(b), middle(k) * slope / wide)
                };
                let left = outer - inner + area * (rate * a[k] - last * past[k]);
                rings.push([rise + slope + area * rate, -rise, -left]);
                lower.push(-slope);
                (inner, slope) = (outer, rise);
            }
            // Each ring eliminates itself from the next.
            for k in 1..=INTERVALS {
                let [own, next, left] = rings[k - 1];
                let share = lower[k] / own;
                rings[k][0] -= share * next;
                rings[k][2] -= share * left;
            }
            let (mut most, mut size) = (0.0_f64, 1e-30_f64);
            let mut beyond = 0.0;
            for k in (0..=INTERVALS).rev() {
                let next = if k == INTERVALS { 0.0 } else { rings[k][1] };
                beyond = (rings[k][2] - next * beyond) / rings[k][0];
                a[k] += beyond;
                most = most.max(beyond.abs());
                size = size.max(a[k].abs());
            }
            if most < 1e-12 * size {
                return;
            }
        }
    }

    /// The flux density at a radius in the tube, from those of [`Driven::march`].
    #[must_use]
    pub fn between(&self, all: &[f64], r: f64) -> f64 {
        let at = (r - self.radii[0]) / self.wide() - 0.5;
        let k = (at.floor().max(0.0) as usize).min(all.len() - 2);
        all[k] + (at - k as f64) * (all[k + 1] - all[k])
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn tube(conductivity: f64) -> Driven {
        Driven {
            radii: [0.01, 0.02],
            wall: 0.03,
            conductivity,
            law: Law::read(&json!({"expr": "1/(1 - 0.999/(1 + (B/2)^8)^0.125)"})).unwrap(),
        }
    }

    /// Without currents `H = I / (2 pi r)` at any time.
    #[test]
    fn what_hardly_conducts_has_the_field_of_the_wire() {
        let tube = tube(1e-3);
        let all = tube.march(0.01, |t| 1e5 * t);
        for r in [0.0101, 0.013, 0.0195] {
            let wanted = tube.law.flux(1e3 / (2.0 * PI * r));
            let found = tube.between(&all, r);
            assert!((found / wanted - 1.0).abs() < 1e-4, "{r}: {found} {wanted}");
        }
    }

    /// The depth of saturated iron in a plane, `x = sqrt(2 H t / (sigma B))` (MacLean 1954, J. Appl. Phys. 25, 1267); in a tube H
    /// falls outward, so that it is a little less.
    #[test]
    fn iron_saturates_layer_by_layer() {
        let tube = Driven {
            law: Law::read(&json!({"b_t": [0, 2.0, 2.1], "h_a_m": [0, 10, 100_000]})).unwrap(),
            ..tube(1e7)
        };
        let end = 2e-3;
        let all = tube.march(end, |_| 300.0);
        let field = 300.0 / (2.0 * PI * 0.01);
        let depth = (2.0 * field * end / (1e7 * 2.0)).sqrt();
        let front = all.iter().position(|b| *b < 1.0).unwrap() as f64 * tube.wide();
        assert!((front / depth - 1.0).abs() < 0.15, "{front} {depth}");
    }
}
