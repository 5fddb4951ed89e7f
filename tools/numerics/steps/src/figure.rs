//! Numbers that a stage wants shown and recorded.

/// A number that a stage wants shown and recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure<Name = &'static str> {
    /// For example `density_error_mean`.
    pub name: Name,
    /// SI unit, `1` for none.
    pub unit: &'static str,
    /// Value after the last step.
    pub value: f64,
}
