//! Room that grains take from the liquid: none of it is where they are.
//!
//! ```text
//! G_a = sum over grains of the integral of W(x_a - x) over the grain
//!     = sum over grains of the integral of 4 pi s^2 W(s) f(s) ds,      f = (1 - (r^2 + s^2 - R^2) / (2 r s)) / 2, from 0 to 1
//! ```
//!
//! r is the way from the particle a to the middle of the grain, f the part of the shell of radius s around a that lies in it. Liquid beside
//! a grain lacks neighbours on its side. Without G its density would seem too low there, particles would draw together at the grain's
//! surface, and a grain that floats would lie too deep. What keeps both apart is their contact; G only tells the projection how full
//! it is.

use kernels::CubicSpline;
use particles::Matter;
use quadrature::gauss;
use rayon::prelude::*;
use steps::Figure;

use super::Mirrors;
use super::around::Around;
use crate::near::Role;
use crate::stage::{Stage, StageError};
use crate::state::State;

/// Places of the rule of Gauss on each part of the shells.
const PLACES: usize = 8;

/// The room that grains take as a stage.
pub struct Displaced {
    kernel: CubicSpline<3>,
    rule: Vec<(f64, f64)>,
    around: Around,
    most: f64,
}

impl Displaced {
    /// The room that grains of at most `widest` \[m\] in radius, and their images in `mirrors`, take of the liquid of a metal.
    #[must_use]
    pub fn new(metal: Matter, widest: f64, mirrors: Mirrors) -> Self {
        Self {
            kernel: CubicSpline::new(metal.smoothing_length),
            rule: gauss(PLACES),
            around: Around::new(metal.support() + widest).beside(mirrors),
            most: 0.0,
        }
    }

    /// G of a place.
    fn taken(&self, place: [f64; 3]) -> f64 {
        let mut taken = 0.0;
        self.around.each(place, |square, radius| {
            taken += self.part(square.sqrt(), radius);
        });
        taken
    }

    /// The integral over one grain of radius `radius` \[m\] whose middle is `r` \[m\] away.
    fn part(&self, r: f64, radius: f64) -> f64 {
        let support = self.kernel.support();
        if r >= support + radius {
            return 0.0;
        }
        let r = r.max(f64::MIN_POSITIVE);
        let inside = |s: f64| {
            let cosine = (r * r + s * s - radius * radius) / (2.0 * r * s);
            0.5 * (1.0 - cosine.clamp(-1.0, 1.0))
        };
        // Nearer shells lie inside or outside as a whole, farther ones outside; the spline has its knot between.
        let (near, far) = ((r - radius).abs().min(support), (r + radius).min(support));
        let mut ends = [near, far, 0.5 * support, support];
        ends.sort_unstable_by(f64::total_cmp);
        let mut taken = 0.0;
        let mut from = 0.0;
        for end in ends {
            let half = 0.5 * (end - from);
            if half > 0.0 {
                for (x, weight) in &self.rule {
                    let s = from + half * (1.0 + x);
                    taken += half * weight * s * s * self.kernel.value(s) * inside(s);
                }
                from = end;
            }
        }
        4.0 * std::f64::consts::PI * taken
    }
}

impl Stage for Displaced {
    fn name(&self) -> &'static str {
        "displaced"
    }

    fn advance(&mut self, state: &mut State, _dt: f64) -> Result<(), StageError> {
        let flows = state.near.role.iter().zip(&state.near.position);
        let flows = flows.filter(|(role, _)| **role == Role::Liquid);
        self.around.look(state, flows.map(|(_, x)| *x));
        self.most = 0.0;
        if self.around.is_empty() {
            return Ok(());
        }
        let mut taken = std::mem::take(&mut state.near.taken);
        let near = &state.near;
        let members = near.role[..near.len()].par_iter().zip(&near.position);
        members
            .with_min_len(256)
            .map(|(role, x)| match role {
                Role::Liquid => self.taken(*x),
                _ => 0.0,
            })
            .collect_into_vec(&mut taken);
        self.most = taken.iter().copied().fold(0.0, f64::max);
        state.near.taken = taken;
        Ok(())
    }

    fn figures(&self) -> Vec<Figure> {
        vec![Figure {
            name: "grain_room_most",
            unit: "1",
            value: self.most,
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stage() -> Displaced {
        let metal = Matter {
            density: 7850.0,
            spacing: 1e-3,
            smoothing_length: 1e-3,
        };
        Displaced::new(metal, 1e-3, Mirrors::default())
    }

    #[test]
    fn a_grain_takes_all_room_within_and_none_far_away() {
        let stage = stage();
        assert!((stage.part(1e-9, 5e-3) - 1.0).abs() < 1e-9);
        assert!((stage.part(2e-3, 5e-3) - 1.0).abs() < 1e-9);
        assert!(stage.part(7e-3, 5e-3).abs() < 1e-300);
        // As far inside a face as outside of it another of the same grain: both together are the whole, but for its bend.
        let both = stage.part(999.6e-3, 1.0) + stage.part(1000.4e-3, 1.0);
        assert!((both - 1.0).abs() < 1e-3, "{both}");
    }

    #[test]
    fn a_small_grain_takes_its_volume_times_the_kernel() {
        let (stage, radius) = (stage(), 2e-5);
        let volume = 4.0 / 3.0 * std::f64::consts::PI * f64::powi(radius, 3);
        for r in [3e-4, 9e-4, 1.6e-3] {
            let wanted = volume * stage.kernel.value(r);
            let found = stage.part(r, radius);
            assert!((found / wanted - 1.0).abs() < 5e-3, "{r}: {found} {wanted}");
        }
    }

    #[test]
    fn a_flat_face_takes_what_lies_behind_it() {
        // The integral over planes behind the face, each by rings.
        let (stage, away) = (stage(), 0.5e-3);
        let n = 400;
        let support = stage.kernel.support();
        let mut wanted = 0.0;
        for i in 0..n {
            let z = away + (support - away) * (i as f64 + 0.5) / n as f64;
            for j in 0..n {
                let ring = support * (j as f64 + 0.5) / n as f64;
                let value = stage.kernel.value(z.hypot(ring));
                wanted += std::f64::consts::TAU * ring * value;
            }
        }
        wanted *= (support - away) * support / (n * n) as f64;
        let found = stage.part(1e3 + away, 1e3);
        assert!((found / wanted - 1.0).abs() < 1e-4, "{found} {wanted}");
    }
}
