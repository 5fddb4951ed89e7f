//! Memory of a solve.

/// Columns that a method works in, kept between solves.
#[derive(Debug, Clone, Default)]
pub struct Scratch<S> {
    pub(crate) columns: Vec<Vec<S>>,
    /// The least-squares problem of [`gmres`](crate::gmres).
    pub(crate) small: Vec<S>,
}

impl<S: Copy + Default> Scratch<S> {
    /// `count` columns of `n` numbers.
    pub(crate) fn fit(&mut self, count: usize, n: usize) -> &mut [Vec<S>] {
        if self.columns.len() < count {
            self.columns.resize_with(count, Vec::new);
        }
        for column in &mut self.columns[..count] {
            column.resize(n, S::default());
        }
        &mut self.columns[..count]
    }

    /// `K` columns of `n` numbers.
    pub(crate) fn columns<const K: usize>(&mut self, n: usize) -> [&mut [S]; K] {
        let mut columns = self.fit(K, n).iter_mut().map(Vec::as_mut_slice);
        std::array::from_fn(|_| columns.next().unwrap_or_default())
    }
}

/// The number of rows of a right side and a guess.
///
/// # Panics
/// When it is not `n`.
pub(crate) fn fits<T>(n: usize, rhs: &[T], x: &[T]) -> usize {
    let given = [rhs.len(), x.len()];
    assert!(given == [n; 2], "{n} rows, {given:?} given");
    n
}
