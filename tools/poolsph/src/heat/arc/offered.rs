//! What an arc offers to the ground under it, integrated apart from the particles.
//!
//! ```text
//! P = 2 pi int |q(r)| f(r) r dr        f(r): part of the circle of radius r around the axis that lies on the ground
//! ```
//!
//! The ground ends at open faces, beyond which the plate goes on and is not computed, and at a mirror that the axis stands upon.

use std::f64::consts::{FRAC_PI_2, PI};

use quadrature::THREE;

use super::super::flux::Flux;
use crate::rest::Plane;

/// Parts of a ring that the ground cuts.
const PARTS: u32 = 8;
/// First ring of a formula, in spacings; each next one is twice as wide.
const FIRST: f64 = 1.0 / 1_048_576.0;
/// Most rings, and rings with nothing after which a formula has ended.
const RINGS: u32 = 70;
const EMPTY: u32 = 6;
/// Part of what has been found that is nothing.
const NOTHING: f64 = 1e-6;

/// Where the ground ends in x and y, below and above \[m\]; at infinity where it does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ground([[f64; 2]; 2]);

impl Ground {
    /// Without an end.
    pub(super) const WHOLE: Self = Self([[f64::NEG_INFINITY, f64::INFINITY]; 2]);

    /// The ground within upright planes.
    pub(super) fn within(planes: &[Plane]) -> Self {
        let mut ground = Self::WHOLE;
        for plane in planes.iter().filter(|plane| plane.axis < 2) {
            ground.0[plane.axis][usize::from(plane.outward > 0.0)] = plane.at;
        }
        ground
    }

    /// The same that ends at the axis too, at the lower or the upper side in x and y where `upon` says so.
    pub(super) fn before(mut self, axis: [f64; 2], upon: [[bool; 2]; 2]) -> Self {
        for (k, side) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            if upon[k][side] {
                self.0[k][side] = axis[k];
            }
        }
        self
    }

    /// Part of the circle of radius `r` \[m\] around `axis` that lies on the ground.
    fn part(&self, axis: [f64; 2], r: f64) -> f64 {
        // Beyond an end at the distance d lie the angles within acos(d/r) around the way there.
        let (mut beyond, mut count) = ([[2.0 * PI; 2]; 8], 0);
        for (k, ends) in self.0.iter().enumerate() {
            for (side, end) in ends.iter().enumerate() {
                let outward = 2.0 * side as f64 - 1.0;
                let far = outward * (end - axis[k]);
                if far < r {
                    let half = (far / r).max(-1.0).acos();
                    let middle = FRAC_PI_2 * k as f64 + if side == 0 { PI } else { 0.0 };
                    let from = (middle - half).rem_euclid(2.0 * PI);
                    let to = from + 2.0 * half;
                    beyond[count] = [from, to.min(2.0 * PI)];
                    beyond[count + 1] = [0.0, (to - 2.0 * PI).max(0.0)];
                    count += 2;
                }
            }
        }
        beyond.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        let (mut covered, mut until) = (0.0, 0.0_f64);
        for [from, to] in beyond {
            covered += (to - from.max(until)).max(0.0);
            until = until.max(to);
        }
        1.0 - covered / (2.0 * PI)
    }

    /// What a flux around `axis` puts on it, as its mean from `time` over `dt` \[W\]; none of one that has no end, or that hangs on the
    /// temperature of the metal.
    pub(super) fn takes(
        &self,
        flux: &Flux,
        axis: [f64; 2],
        spacing: f64,
        [time, dt]: [f64; 2],
    ) -> Option<f64> {
        let ring = |from: f64, to: f64| -> Option<f64> {
            let (mut sum, wide) = (0.0, (to - from) / f64::from(PARTS));
            for part in 0..PARTS {
                for (place, weight) in THREE {
                    let r = from + (f64::from(part) + place) * wide;
                    let (value, _) = flux.at(r, 0.0, time, dt).ok()?;
                    sum += weight * wide * value.abs() * self.part(axis, r) * r;
                }
            }
            Some(2.0 * PI * sum)
        };
        if let Some(table) = flux.table() {
            let rows = table.nodes().windows(2).map(|row| ring(row[0], row[1]));
            return std::iter::once(ring(0.0, table.nodes()[0]))
                .chain(rows)
                .sum();
        }
        if !flux.is_formula() {
            return None;
        }
        let (mut sum, mut from, mut to, mut empty) = (0.0, 0.0, FIRST * spacing, 0);
        for _ in 0..RINGS {
            let more = ring(from, to)?;
            sum += more;
            empty = if more <= NOTHING * sum { empty + 1 } else { 0 };
            if sum > 0.0 && empty >= EMPTY {
                return Some(sum);
            }
            (from, to) = (to, 2.0 * to);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]

    use run::property::Property;

    use super::super::super::flux::Law;
    use super::*;

    const TIMES: [f64; 2] = [0.0, 1.0];

    /// A cone of the height 3 W/m2 over 15 m.
    fn cone() -> Flux {
        let (nodes, values) = (vec![0.0, 5.0, 10.0, 15.0], vec![3.0, 2.0, 1.0, 0.0]);
        Flux::new(
            "heat",
            Law::Table(props::Table::new(nodes, values).unwrap()),
        )
    }

    fn formula(text: &str) -> Flux {
        let property: Property = serde_json::from_value(serde_json::json!({"expr": text})).unwrap();
        Flux::new(
            "heat",
            Law::Curve(property.compile("", &["r", "t"]).unwrap()),
        )
    }

    fn plane(axis: usize, at: f64, outward: f64) -> Plane {
        Plane { axis, at, outward }
    }

    #[test]
    fn a_cone_gives_its_volume_and_half_of_it_on_half_a_plane() {
        let volume = PI * 15.0 * 15.0;
        let takes = |ground: Ground| ground.takes(&cone(), [2.0, -1.0], 1.0, TIMES).unwrap();
        assert!((takes(Ground::WHOLE) / volume - 1.0).abs() < 1e-12);
        for side in [plane(0, 2.0, 1.0), plane(0, 2.0, -1.0), plane(1, -1.0, 1.0)] {
            assert!((takes(Ground::within(&[side])) / volume - 0.5).abs() < 1e-12);
        }
        let upon = [[true, false], [false, true]];
        let quarter = Ground::WHOLE.before([2.0, -1.0], upon);
        assert!((takes(quarter) / volume - 0.25).abs() < 1e-12);
        // The axis beyond the end, or the whole cone within it.
        assert!(takes(Ground::within(&[plane(0, -13.5, 1.0)])) < 1e-9 * volume);
        let far = Ground::within(&[plane(0, 17.5, 1.0), plane(1, -16.5, -1.0)]);
        assert!((takes(far) / volume - 1.0).abs() < 1e-12);
    }

    #[test]
    fn parts_of_a_circle_beyond_two_ends_that_meet_count_once() {
        // Ends at a distance of r cos 60 degrees to the right and above: 120 degrees each, of which 30 are common.
        let ground = Ground::within(&[plane(0, 0.5, 1.0), plane(1, 0.5, 1.0)]);
        let part = 1.0 - (120.0 + 120.0 - 30.0) / 360.0;
        assert!((ground.part([0.0; 2], 1.0) - part).abs() < 1e-12);
        // Across the angle 0, and all around.
        let right = Ground::within(&[plane(0, 0.5, 1.0)]);
        assert!((right.part([0.0; 2], 1.0) - 2.0 / 3.0).abs() < 1e-12);
        assert!(right.part([3.0, 0.0], 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_gaussian_has_its_integral_at_any_width_and_a_plane_of_heat_has_none() {
        for width in [1e-5, 1.0, 1e4] {
            let gaussian = formula(&format!("7*exp(-(r/{width})^2)"));
            let exact = 7.0 * PI * width * width;
            let found = Ground::WHOLE.takes(&gaussian, [0.0; 2], 1.0, TIMES);
            assert!((found.unwrap() / exact - 1.0).abs() < 1e-4, "{width}");
            let half = Ground::within(&[plane(1, 0.0, 1.0)]);
            let found = half.takes(&gaussian, [0.0; 2], 1.0, TIMES).unwrap();
            assert!((found / exact - 0.5).abs() < 1e-4, "{width}");
        }
        for text in ["1e6", "sqrt(1 - r)", "1/(1 + r)"] {
            let found = Ground::WHOLE.takes(&formula(text), [0.0; 2], 1.0, TIMES);
            assert_eq!(found, None, "{text}");
        }
    }
}
