//! How far the equations are from holding.

/// Residuals as parts of their scales; absent physics has none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residuals {
    /// Charge: unbalanced over mean current.
    pub charge: Option<f64>,
    /// Momentum: unbalanced force over the sum of forces.
    pub force: Option<f64>,
    /// Mass: unbalanced over mean mass flow.
    pub mass: Option<f64>,
    /// Heat: unbalanced over the power put in and taken out.
    pub heat: Option<f64>,
    /// Iron: unbalanced over what metal gives off and edges exchange.
    pub iron: Option<f64>,
    /// Change that the speed of the wire still wants.
    pub feed: Option<f64>,
    /// Part of the bed of flux that still boils or comes back.
    pub cavity: Option<f64>,
    /// Cells whose temperature step was limited.
    pub limited: usize,
}

impl Residuals {
    /// The residuals that exist, by name.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let all = [
            ("residual_charge", self.charge),
            ("residual_force", self.force),
            ("residual_mass", self.mass),
            ("residual_heat", self.heat),
            ("residual_iron", self.iron),
            ("residual_feed", self.feed),
            ("residual_cavity", self.cavity),
        ];
        all.into_iter()
            .filter_map(|(name, value)| Some((name, value?)))
    }

    /// The greatest residual.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.named().map(|(_, v)| v).fold(0.0, f64::max)
    }

    /// Whether every residual is within `tolerance` and no step was limited.
    #[must_use]
    pub fn within(&self, tolerance: f64) -> bool {
        self.limited == 0 && self.worst() <= tolerance
    }
}

/// `amount / scale`; nothing of nothing is nothing.
#[must_use]
pub fn part(amount: f64, scale: f64) -> f64 {
    if amount == 0.0 {
        0.0
    } else {
        amount / scale.max(f64::MIN_POSITIVE)
    }
}
