//! The Gaussian spots of heat in the scenes of `poolsph`.

use crate::lab::{Finished, LabError};
use crate::special::erf;

/// q = peak exp(-r^2 / (2 sigma^2)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spot {
    /// Largest flux \[W/m2\].
    pub(crate) peak: f64,
    /// Radius at which it has fallen to exp(-1/2) \[m\].
    pub(crate) sigma: f64,
}

impl Spot {
    /// The spot of a scene.
    pub(crate) fn of(run: &Finished) -> Result<Self, LabError> {
        let expression = run.scene.pointer("/arc/flux_w_m2/expr");
        let text = expression.and_then(|e| e.as_str()).unwrap_or_default();
        Self::parse(text).ok_or_else(|| LabError::Content {
            path: run.artefact.clone(),
            what: format!("its flux '{text}' is not peak*exp(-r^2/(2*sigma^2))"),
        })
    }

    fn parse(text: &str) -> Option<Self> {
        let (peak, rest) = text.split_once("*exp(-r^2/(2*")?;
        let sigma = rest.strip_suffix("^2))")?;
        Some(Self {
            peak: peak.parse().ok()?,
            sigma: sigma.parse().ok()?,
        })
    }

    /// Heat that falls within a circle around the axis in a second \[W\].
    pub(crate) fn power(&self, radius: f64) -> f64 {
        let square = self.sigma * self.sigma;
        let part = 1.0 - (-0.5 * radius * radius / square).exp();
        std::f64::consts::TAU * square * self.peak * part
    }

    /// Heat that falls within a square around the axis in a second \[W\]; `half`: half the length of its sides \[m\].
    pub(crate) fn power_on_square(&self, half: f64) -> f64 {
        let side = erf(half / (self.sigma * std::f64::consts::SQRT_2));
        self.power(f64::INFINITY) * side * side
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spot_is_read_and_integrated() {
        let spot = Spot::parse("1.5e7*exp(-r^2/(2*0.0015^2))").unwrap();
        assert!((spot.peak - 1.5e7).abs() < 1e-9 && (spot.sigma - 1.5e-3).abs() < 1e-15);
        assert!((spot.power(1.0) - 212.057_504).abs() < 1e-5);
        // Narrow spots fall on the square as a whole; wide ones are even over it.
        assert!((spot.power_on_square(0.05) / spot.power(1.0) - 1.0).abs() < 1e-14);
        let wide = Spot {
            sigma: 10.0,
            ..spot
        };
        assert!((wide.power_on_square(0.01) / (spot.peak * 4e-4) - 1.0).abs() < 1e-6);
        assert!(Spot::parse("3*exp(-r)").is_none());
    }
}
