//! A uniform field.

use super::Phasor;

/// A uniform flux density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uniform {
    /// Flux density \[T\], rms.
    pub flux: Phasor,
    /// Where its vector potential is zero \[m\].
    pub origin: [f64; 3],
}

impl Uniform {
    /// Vector potential `B x (r - origin) / 2` \[V s/m\].
    #[must_use]
    pub fn potential(&self, p: [f64; 3]) -> Phasor {
        let d = [0, 1, 2].map(|k| 0.5 * (p[k] - self.origin[k]));
        let b = self.flux;
        [
            b[1] * d[2] - b[2] * d[1],
            b[2] * d[0] - b[0] * d[2],
            b[0] * d[1] - b[1] * d[0],
        ]
    }
}
