//! Grains of `poolsph` for exact cases: frames, and what is known of an impact.

use std::f64::consts::PI;
use std::path::Path;

use artefact::{Frame, Reader};

use crate::lab::{Finished, LabError};

/// All frames of `/grains`.
pub(crate) fn frames(artefact: &Path) -> Result<Vec<Frame>, LabError> {
    let reader = Reader::open_kind(artefact, "particle-frames", 1)?;
    let frames = reader.frames("/grains")?;
    Ok(frames.collect::<artefact::Result<_>>()?)
}

/// What is wrong with a run.
pub(crate) fn fault(run: &Finished, what: &str) -> LabError {
    LabError::Content {
        path: run.artefact.clone(),
        what: what.to_owned(),
    }
}

/// Mass of a sphere \[kg\].
pub(crate) fn mass(density: f64, radius: f64) -> f64 {
    4.0 / 3.0 * PI * density * radius.powi(3)
}

/// A swing with damping: `x'' + 2 zeta x' + x = 0` from x = 0 with speed 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Swing {
    zeta: f64,
    /// Whether it ends where the force, not the overlap, is zero.
    at_zero_force: bool,
}

impl Swing {
    /// The swing that ends with the speed `e`.
    pub(crate) fn of(e: f64, at_zero_force: bool) -> Self {
        let swing = |zeta: f64| Self {
            zeta,
            at_zero_force,
        };
        let (mut low, mut high) = (0.0, 1.0);
        while swing(high).restitution() > e {
            high *= 2.0;
        }
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if swing(middle).restitution() > e {
                low = middle;
            } else {
                high = middle;
            }
        }
        swing(0.5 * (low + high))
    }

    /// x and its slope at a time.
    fn at(self, t: f64) -> [f64; 2] {
        let z = self.zeta;
        let d = (1.0 - z * z).abs().sqrt();
        // sin(d t) / d and cos(d t), or their like beyond critical damping
        let (s, c) = if d < 1e-9 {
            (t, 1.0)
        } else if z < 1.0 {
            ((d * t).sin() / d, (d * t).cos())
        } else {
            ((d * t).sinh() / d, (d * t).cosh())
        };
        let fade = (-z * t).exp();
        [fade * s, fade * (c - z * s)]
    }

    /// Share of critical damping.
    pub(crate) fn damping_ratio(self) -> f64 {
        self.zeta
    }

    /// Whether it ends where the force is zero.
    pub(crate) fn ends_at_force(self) -> bool {
        self.at_zero_force
    }

    /// When it ends, by halving: no formula.
    pub(crate) fn duration(self) -> f64 {
        let over = |t: f64| {
            let [x, u] = self.at(t);
            let force = if self.at_zero_force {
                x + 2.0 * self.zeta * u
            } else {
                x
            };
            force <= 0.0
        };
        let mut t = 1e-3;
        while !over(t) && t < 1e4 {
            t *= 1.001;
        }
        let (mut low, mut high) = (t / 1.001, t);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if over(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        low
    }

    fn restitution(self) -> f64 {
        if !self.at_zero_force && self.zeta >= 1.0 {
            return 0.0;
        }
        -self.at(self.duration())[1]
    }

    /// The greatest x.
    pub(crate) fn deepest(self) -> f64 {
        let (mut low, mut high) = (0.0, self.duration());
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.at(middle)[1] > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.at(low)[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swing_that_ends_at_zero_overlap_is_that_of_the_textbook() {
        for e in [0.05, 0.75, 0.99] {
            let swing = Swing::of(e, false);
            let zeta = -f64::ln(e) / PI.hypot(f64::ln(e));
            assert!((swing.zeta - zeta).abs() < 1e-9);
            assert!((swing.duration() - PI / (1.0 - zeta * zeta).sqrt()).abs() < 1e-9);
        }
        assert!((Swing::of(1.0, true).deepest() - 1.0).abs() < 1e-9);
    }
}
