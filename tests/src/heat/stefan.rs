//! Melting of a half space from a hot wall (Neumann; Carslaw and Jaeger 1959, section 11.2).
//!
//! Both phases alike; temperatures from 0 (the solid at first) to 1 (the wall), `lambda` from
//!
//! ```text
//! lambda sqrt(pi) L = (1 - Tm) exp(-lambda^2) / erf(lambda) - Tm exp(-lambda^2) / erfc(lambda)
//! ```

use crate::neumann::front;
use crate::special::{erf, erfc};

/// A half space that melts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Melting {
    /// Of both phases \[m2/s\].
    pub diffusivity: f64,
    /// Latent heat over the specific heat and the range of temperature.
    pub latent: f64,
    /// Melting point as a part of the range.
    pub melting: f64,
}

impl Melting {
    /// Where the front is after `time` \[m\]: `2 lambda sqrt(alpha t)`.
    #[must_use]
    pub fn front(&self, time: f64) -> f64 {
        2.0 * self.lambda() * (self.diffusivity * time).sqrt()
    }

    /// The temperature at `x` after `time`, as a part of the range.
    #[must_use]
    pub fn temperature(&self, x: f64, time: f64) -> f64 {
        let s = x / (2.0 * (self.diffusivity * time).sqrt());
        let lambda = self.lambda();
        if s < lambda {
            1.0 - (1.0 - self.melting) * erf(s) / erf(lambda)
        } else {
            self.melting * erfc(s) / erfc(lambda)
        }
    }

    fn lambda(&self) -> f64 {
        let over = |range: f64| range / self.latent;
        front([over(1.0 - self.melting), over(self.melting)], 1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_is_balanced_at_the_front() {
        let melting = Melting {
            diffusivity: 0.7,
            latent: 2.0,
            melting: 0.5,
        };
        let (time, h) = (0.3, 1e-5);
        let s = melting.front(time);
        let speed = (melting.front(time + h) - melting.front(time - h)) / (2.0 * h);
        let slope = |a: f64, b: f64| {
            (melting.temperature(b, time) - melting.temperature(a, time)) / (b - a)
        };
        let flux = slope(s, s + h) - slope(s - h, s);
        let wanted = 0.7 * flux / (2.0 * speed);
        assert!((wanted - 1.0).abs() < 1e-3, "{wanted}");
        assert!((melting.temperature(s, time) - 0.5).abs() < 1e-12);
    }
}
