//! Fracture by what a box of the solid bears, on any spacing.
//!
//! ```text
//! C_l = sum_b w_ab C_b / sum_b w_ab,   C = F^T F,   w_ab the part of cell b in the box of length l around cell a
//! ```
//!
//! Strain at the tip of a crack rises as 1/sqrt(r), so that a cell bears the more the smaller it is. The mean over a length of
//! the solid does not (Neuber 1936; Novozhilov 1969). It gives a solid both a strength and an energy of cracks: after
//! Irwin the mean of the stress across a crack is at most 1.70 K/sqrt(2 pi l), 0.4 l before its tip, so that a crack of mode I takes
//!
//! ```text
//! G = 2.17 sigma^2 l (1 - nu^2)/E          in plane strain, by a principal stress sigma
//! ```
//!
//! With cells of the size l a box is a cell: the criterion is that of one cell. C is the same however pieces turn. What a
//! crack parts from the cell is not in its box. A box that bears too much breaks where it bears most, and of boxes that
//! overlap the one that bears most there breaks in a step: cracks are one cell wide.

use neighbours::Grid;
use particles::Rows;
use rayon::prelude::*;

use super::fracture::{Criterion, crossed};
use super::law::Law;
use super::tensor::Matrix;

/// Of two that bear the same but for this part the first particle breaks.
const EQUAL: f64 = 1e-9;

/// The box around each cell.
#[derive(Debug, Clone)]
pub(super) struct Boxes {
    /// l/2 in cells.
    half: [f64; 3],
    /// Middles of the cells, in cells.
    middles: Vec<[f64; 3]>,
    /// Whom a box may hold, beside its own cell.
    rows: Rows,
}

impl Boxes {
    /// Boxes of a length \[m\] around cells of a size with these middles \[m\], in `dimensions` axes.
    pub(super) fn new(
        middles: &[[f64; 3]],
        size: [f64; 3],
        length: f64,
        dimensions: usize,
    ) -> Self {
        let half = size.map(|d| 0.5 * (length / d).max(1.0));
        let far = half[..dimensions].iter().map(|h| (h + 0.5).powi(2));
        let reach = far.sum::<f64>().sqrt();
        let middles: Vec<[f64; 3]> = middles
            .iter()
            .map(|x| [0, 1, 2].map(|k| x[k] / size[k]))
            .collect();
        let (mut grid, mut rows) = (Grid::new(reach), Rows::new());
        grid.bin(&middles);
        rows.within(&middles, &grid, reach);
        Self {
            half,
            middles,
            rows,
        }
    }

    /// Part of cell `b` in the box around cell `a`.
    fn part(&self, a: usize, b: usize) -> f64 {
        let along = |k: usize| {
            let off = (self.middles[a][k] - self.middles[b][k]).abs();
            (self.half[k] + 0.5 - off).clamp(0.0, 1.0)
        };
        along(0) * along(1) * along(2)
    }

    /// Whether the boxes of two cells overlap.
    fn overlap(&self, a: usize, b: usize) -> bool {
        (0..3).all(|k| {
            let off = (self.middles[a][k] - self.middles[b][k]).abs();
            off < 2.0 * self.half[k] * (1.0 - EQUAL)
        })
    }

    /// Unbroken cells in the box around cell `a` that nothing broken parts from it, with their parts of a cell.
    fn members(&self, a: usize, broken: &[bool]) -> Vec<(usize, f64)> {
        let row = self.rows.row(a).iter().map(|b| *b as usize);
        let between: Vec<[f64; 3]> = row
            .clone()
            .filter(|b| broken[*b])
            .map(|b| self.middles[b])
            .collect();
        let is_parted = |b: usize| {
            let gaps = between.iter().copied();
            !between.is_empty() && crossed(self.middles[a], self.middles[b], gaps)
        };
        let others = row
            .filter(|b| !broken[*b])
            .map(|b| (b, self.part(a, b)))
            .filter(|(b, part)| *part > 0.0 && !is_parted(*b));
        std::iter::once((a, self.part(a, a)))
            .chain(others)
            .collect()
    }

    /// Those that break, in order; `squares` are C of completed deformations, and cells count by their `share`.
    pub(super) fn due(
        &self,
        criterion: &Criterion,
        law: &Law,
        broken: &[bool],
        squares: &[Matrix],
        share: impl Fn(usize) -> f64 + Sync,
    ) -> Vec<usize> {
        let all = || (0..squares.len()).into_par_iter().with_min_len(32);
        let is_near = |a: usize| !broken[a] && criterion.may_break(law, &squares[a]);
        if !all().any(is_near) {
            return Vec::new();
        }
        let weakest = |a: usize| {
            let members = self.members(a, broken);
            let mean = mean(&members, squares, &share);
            let bears_too_much =
                criterion.may_break(law, &mean) && criterion.load(law, &mean) >= 1.0;
            bears_too_much.then(|| {
                let loads = members
                    .iter()
                    .map(|(b, _)| (*b, criterion.load(law, &squares[*b])));
                let first = (a, criterion.load(law, &squares[a]));
                loads.fold(first, |most, one| if leads(one, most) { one } else { most })
            })
        };
        let mut found: Vec<(usize, f64)> =
            all().filter(|a| !broken[*a]).filter_map(weakest).collect();
        found.sort_by_key(|(a, _)| *a);
        found.dedup_by_key(|(a, _)| *a);
        let is_first = |one: &&(usize, f64)| {
            let others = found.iter().filter(|other| self.overlap(one.0, other.0));
            others
                .copied()
                .all(|other| other.0 == one.0 || leads(**one, other))
        };
        found.iter().filter(is_first).map(|(a, _)| *a).collect()
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.rows.bytes() + 24 * self.middles.len()
    }
}

/// Whether one breaks before another: it bears more, or as much and comes first.
fn leads(one: (usize, f64), other: (usize, f64)) -> bool {
    one.1 > other.1 * (1.0 + EQUAL) || (one.1 >= other.1 * (1.0 - EQUAL) && one.0 < other.0)
}

/// C_l; that of a cell alone is its own to the last bit.
fn mean(members: &[(usize, f64)], squares: &[Matrix], share: impl Fn(usize) -> f64) -> Matrix {
    if let [(a, _)] = members {
        return squares[*a];
    }
    let (mut sum, mut whole) = ([[0.0; 3]; 3], 0.0);
    for (b, part) in members {
        let weight = part * share(*b);
        whole += weight;
        for (sum, row) in sum.iter_mut().zip(&squares[*b]) {
            (0..3).for_each(|k| sum[k] += weight * row[k]);
        }
    }
    sum.map(|row| row.map(|x| x / whole))
}

#[cfg(test)]
mod tests {
    use super::super::law::{Elastic, Young};
    use super::super::tensor::UNIT;
    use super::*;

    fn sheet(n: u32, d: f64) -> Vec<[f64; 3]> {
        let place = |i: u32| d * (f64::from(i) + 0.5);
        (0..n * n)
            .map(|i| [place(i % n), place(i / n), 0.0])
            .collect()
    }

    fn law() -> Law {
        let young = Young {
            youngs_modulus_pa: 1e5,
            poisson_ratio: 0.3,
        };
        Law::new(&Elastic::Young(young), None)
    }

    #[test]
    fn boxes_have_the_mean_of_the_cells_in_them() {
        for (d, length) in [(0.1, 0.1), (0.1, 0.15), (0.05, 0.2), (0.03, 0.1)] {
            let middles = sheet(9, d);
            let boxes = Boxes::new(&middles, [d, d, 1.0], length, 2);
            let members = boxes.members(40, &[false; 81]);
            let area: f64 = members.iter().map(|(_, part)| part * d * d).sum();
            assert!((area / (length * length) - 1.0).abs() < 1e-12, "{d} {area}");
            // A linear field has the value of the middle.
            let squares: Vec<Matrix> = middles
                .iter()
                .map(|x| UNIT.map(|row| row.map(|u| u + x[0] + 2.0 * x[1])))
                .collect();
            let found = mean(&members, &squares, |_| 1.0);
            assert!((found[1][2] - squares[40][1][2]).abs() < 1e-12);
        }
    }

    #[test]
    fn a_box_breaks_where_it_bears_most_and_not_by_one_cell() {
        let (d, law, criterion) = (0.05, law(), Criterion::Strain(0.1));
        let middles = sheet(9, d);
        let mut squares = vec![UNIT; 81];
        squares[41][0][0] = 1.6;
        let broken = [false; 81];
        let due = |length: f64, squares: &[Matrix]| {
            let boxes = Boxes::new(&middles, [d, d, 1.0], length, 2);
            boxes.due(&criterion, &law, &broken, squares, |_| 1.0)
        };
        assert_eq!(due(d, &squares), [41]);
        assert!(due(3.0 * d, &squares).is_empty());
        for b in [30, 31, 32, 39, 40, 48, 49, 50] {
            squares[b][0][0] = 1.4;
        }
        assert_eq!(due(3.0 * d, &squares), [41]);
        assert_eq!(due(d, &squares).len(), 9);
    }

    #[test]
    fn a_crack_bears_what_irwin_says() {
        // The field of K = 1 at a tip in the middle of 61 by 61 cells, l = 20 cells: sigma = 1.70 K/sqrt(2 pi l) before it.
        let (law, length) = (law(), 20.0);
        let middles = sheet(61, 1.0);
        let field = |x: &[f64; 3]| {
            let (x, y) = (x[0] - 30.5, x[1] - 30.0);
            let (r, half) = (x.hypot(y), 0.5 * y.atan2(x));
            let scale = 1e-6 * half.cos() / (std::f64::consts::TAU * r).sqrt();
            let (both, along) = (
                half.sin() * (3.0 * half).sin(),
                half.sin() * (3.0 * half).cos(),
            );
            let (p, q) = (scale * (1.0 - both), scale * (1.0 + both));
            // Plane strain: e = (s - nu (tr s))/(2 mu), with nu = 0.3; C = 1 + 2 e.
            let nu = 0.3 * (p + q);
            let shear = scale * along;
            [
                [1.0 + p - nu, shear, 0.0],
                [shear, 1.0 + q - nu, 0.0],
                [0.0, 0.0, 1.0],
            ]
        };
        let squares: Vec<Matrix> = middles.iter().map(field).collect();
        let boxes = Boxes::new(&middles, [1.0, 1.0, 1.0], length, 2);
        let criterion = Criterion::Stress(1e-6 * law.shear);
        // The crack: its faces are between two rows, and all before the tip see both.
        let most = (30 * 61 + 31..30 * 61 + 50).map(|a| {
            let members = boxes.members(a, &vec![false; middles.len()]);
            criterion.load(&law, &mean(&members, &squares, |_| 1.0))
        });
        let most = most.fold(0.0, f64::max) * (std::f64::consts::TAU * length).sqrt();
        assert!((most / 1.70 - 1.0).abs() < 0.03, "{most}");
    }

    #[test]
    fn what_a_crack_parts_is_not_in_the_box() {
        let middles = sheet(9, 0.1);
        let boxes = Boxes::new(&middles, [0.1, 0.1, 1.0], 0.5, 2);
        let broken: Vec<bool> = (0..81).map(|a| a % 9 == 5).collect();
        let members = boxes.members(40, &broken);
        assert!(members.iter().all(|(b, _)| b % 9 < 5));
        assert_eq!(members.len(), 15);
    }
}
