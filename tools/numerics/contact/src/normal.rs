//! What every normal law answers.

use crate::meeting::Meeting;

/// A law of the push between two bodies that overlap.
///
/// The push is `elastic(overlap) + damping * approach`. It is never a pull where the law ends contacts at zero force.
pub trait Normal {
    /// Push along the normal, onto a, away from b \[N\].
    fn push(&self, meeting: &Meeting) -> f64;

    /// Stiffness dN/d(overlap) at this overlap \[N/m\].
    fn stiffness(&self, meeting: &Meeting) -> f64;

    /// Stiffness of the tangential spring at this overlap \[N/m\].
    fn tangential(&self, meeting: &Meeting) -> f64;

    /// Share of critical damping that the law gives, 0 (elastic) upward.
    fn damping_ratio(&self) -> f64;

    /// Whether the dashpot still pulls where a contact ends.
    fn pulls_at_the_end(&self) -> bool {
        false
    }

    /// Whether the tangential spring stiffens as the overlap grows: then what has been stretched before is stretched less.
    const STIFFENS: bool;
}
