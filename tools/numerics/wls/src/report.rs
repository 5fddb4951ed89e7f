//! What became of the rows of a set of stencils.

use crate::fit::Way;
use crate::ladder::Made;

/// Counts over the rows of a set of stencils.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Report {
    /// Rows that were made.
    pub rows: usize,
    /// Their neighbours, own points included.
    pub neighbours: usize,
    /// Rows that were solved for.
    pub solved: usize,
    /// Rows that share the weights of another one, their supports being equal up to scale.
    pub shared: usize,
    /// Solved rows that normal equations would have spoilt, taken by orthogonal factors.
    pub by_qr: usize,
    /// Solved rows whose support does not determine all monomials, but what is wanted of them.
    pub by_svd: usize,
    /// Solved rows whose support was ill-conditioned and was enlarged.
    pub enlarged: usize,
    /// Solved rows whose points weigh by the room that each has, since points crowd on one side.
    pub by_room: usize,
    /// Solved rows whose order was lowered, for want of a good support.
    pub lowered: usize,
    /// Solved rows that got positive weights in place of negative ones.
    pub positive_made: usize,
    /// Solved rows that kept negative weights, as no positive ones exist.
    pub positive_failed: usize,
    /// Greatest condition number of a solved row, those by singular values left out.
    pub worst_condition: f64,
}

impl Report {
    pub(crate) fn count(&mut self, made: &Made, order: u8) {
        self.solved += 1;
        self.by_qr += usize::from(made.way == Way::Orthogonal);
        self.by_svd += usize::from(made.way == Way::Spectrum);
        self.enlarged += usize::from(made.times > 0);
        self.by_room += usize::from(made.by_room);
        self.lowered += usize::from(made.order < order);
        self.positive_made += usize::from(made.positive == Some(true));
        self.positive_failed += usize::from(made.positive == Some(false));
        if made.way != Way::Spectrum {
            self.worst_condition = self.worst_condition.max(made.condition);
        }
    }

    /// With the counts of another set.
    #[must_use]
    pub fn with(self, other: &Self) -> Self {
        Self {
            rows: self.rows + other.rows,
            neighbours: self.neighbours + other.neighbours,
            solved: self.solved + other.solved,
            shared: self.shared + other.shared,
            by_qr: self.by_qr + other.by_qr,
            by_svd: self.by_svd + other.by_svd,
            enlarged: self.enlarged + other.enlarged,
            by_room: self.by_room + other.by_room,
            lowered: self.lowered + other.lowered,
            positive_made: self.positive_made + other.positive_made,
            positive_failed: self.positive_failed + other.positive_failed,
            worst_condition: self.worst_condition.max(other.worst_condition),
        }
    }
}
