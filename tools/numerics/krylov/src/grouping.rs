//! Rows in groups: which group each row belongs to, and the rows of each group.

/// In no group.
pub(crate) const NONE: u32 = u32::MAX;

/// Which rows form which group.
#[derive(Debug, Clone, Default)]
pub(crate) struct Grouping {
    /// Group of each row, [`NONE`] for rows in no group.
    pub(crate) of: Vec<u32>,
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Grouping {
    /// From the group of each row, below `count` or [`NONE`].
    pub(crate) fn new(of: Vec<u32>, count: usize) -> Self {
        let mut starts = vec![0_u32; count + 1];
        for &g in of.iter().filter(|g| **g != NONE) {
            starts[g as usize + 1] += 1;
        }
        for g in 0..count {
            starts[g + 1] += starts[g];
        }
        let mut next = starts.clone();
        let mut members = vec![0; starts[count] as usize];
        for (i, &g) in of.iter().enumerate().filter(|(_, g)| **g != NONE) {
            members[next[g as usize] as usize] = i as u32;
            next[g as usize] += 1;
        }
        Self {
            of,
            starts,
            members,
        }
    }

    /// Number of groups.
    pub(crate) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Rows of group `g`, rising.
    pub(crate) fn members(&self, g: usize) -> &[u32] {
        &self.members[self.starts[g] as usize..self.starts[g + 1] as usize]
    }

    pub(crate) fn bytes(&self) -> usize {
        4 * (self.of.capacity() + self.starts.capacity() + self.members.capacity())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_of_a_group_is_its_member() {
        let grouping = Grouping::new(vec![1, NONE, 0, 1, 2, NONE, 1], 3);
        assert_eq!(grouping.len(), 3);
        assert_eq!(grouping.members(0), [2]);
        assert_eq!(grouping.members(1), [0, 3, 6]);
        assert_eq!(grouping.members(2), [4]);
        assert_eq!(Grouping::default().len(), 0);
    }
}
