//! Interpolation, restriction and the products that make the next level.

use crate::grouping::{Grouping, NONE};
use crate::{Coefficient, Rows, Scalar};

/// A row that is being summed: where each column stands.
struct Sum<T> {
    place: Vec<u32>,
    entries: Vec<(u32, T)>,
}

impl<T: Scalar> Sum<T> {
    fn new(columns: usize) -> Self {
        Self {
            place: vec![NONE; columns],
            entries: Vec::new(),
        }
    }

    fn add(&mut self, column: u32, value: T) {
        let place = &mut self.place[column as usize];
        if *place == NONE {
            *place = self.entries.len() as u32;
            self.entries.push((column, value));
        } else {
            self.entries[*place as usize].1 += value;
        }
    }

    /// Appends the row, columns rising.
    fn flush<U>(&mut self, columns: &mut Vec<u32>, values: &mut Vec<U>, each: impl Fn(T) -> U) {
        self.entries.sort_unstable_by_key(|e| e.0);
        for &(j, v) in &self.entries {
            self.place[j as usize] = NONE;
            columns.push(j);
            values.push(each(v));
        }
        self.entries.clear();
    }
}

/// `(1 - step D^-1 A) P`, `P` being one on the groups.
pub(crate) fn interpolation<T: Scalar>(a: &Rows<T>, groups: &Grouping, step: f64) -> Rows<f32> {
    Rows::made(
        a.len(),
        || Sum::<f64>::new(groups.len()),
        |i, sum, columns, values| {
            if groups.of[i] != NONE {
                sum.add(groups.of[i], 1.0);
                let factor = step / a.diagonal(i).real_part();
                for (j, v) in a.pairs(i) {
                    if groups.of[j] != NONE {
                        sum.add(groups.of[j], -factor * v.real_part());
                    }
                }
            }
            sum.flush(columns, values, |v| v as f32);
        },
    )
}

/// `P^T (1 - step A D^-1)`.
pub(crate) fn restriction<T: Scalar>(a: &Rows<T>, groups: &Grouping, step: f64) -> Rows<f32> {
    let diagonal: Vec<f64> = (0..a.len()).map(|i| a.diagonal(i).real_part()).collect();
    Rows::made(
        groups.len(),
        || Sum::<f64>::new(a.len()),
        |g, sum, columns, values| {
            for &i in groups.members(g) {
                sum.add(i, 1.0);
                for (j, v) in a.pairs(i as usize) {
                    if groups.of[j] != NONE {
                        sum.add(j as u32, -step * v.real_part() / diagonal[j]);
                    }
                }
            }
            sum.flush(columns, values, |v| v as f32);
        },
    )
}

/// `A P`.
pub(crate) fn times<T: Scalar>(a: &Rows<T>, up: &Rows<f32>, groups: usize) -> Rows<T>
where
    f32: Coefficient<T>,
{
    Rows::made(
        a.len(),
        || Sum::<T>::new(groups),
        |i, sum, columns, values| {
            for (j, v) in a.pairs(i) {
                for (g, p) in up.pairs(j) {
                    sum.add(g as u32, p.times(v));
                }
            }
            sum.flush(columns, values, |v| v);
        },
    )
}

/// `R (A P)`.
pub(crate) fn coarse<T: Scalar>(down: &Rows<f32>, image: &Rows<T>, groups: usize) -> Rows<T>
where
    f32: Coefficient<T>,
{
    Rows::made(
        groups,
        || Sum::<T>::new(groups),
        |g, sum, columns, values| {
            sum.add(g as u32, T::ZERO);
            for (i, r) in down.pairs(g) {
                for (h, v) in image.pairs(i) {
                    sum.add(h as u32, r.times(v));
                }
            }
            sum.flush(columns, values, |v| v);
        },
    )
}
