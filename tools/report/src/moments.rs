//! Which of many frames are taken.

/// The first frame, each `every`-th after it, and the last: what a course ends with is never left out.
pub(crate) fn every(count: usize, every: usize) -> Vec<usize> {
    let mut taken: Vec<usize> = (0..count).step_by(every.max(1)).collect();
    if let Some(last) = count
        .checked_sub(1)
        .filter(|last| taken.last() != Some(last))
    {
        taken.push(last);
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_frame_is_always_among_them() {
        assert_eq!(every(0, 3), [0_usize; 0]);
        assert_eq!(every(7, 3), [0, 3, 6]);
        assert_eq!(every(9, 3), [0, 3, 6, 8]);
        assert_eq!(every(3, 10), [0, 2]);
        assert_eq!(every(2, 1), [0, 1]);
    }
}
