//! What contacts remember beyond their list.

use contact::History;
use shapes::frame::Vector;

/// A contact that is remembered beyond its list.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Memory {
    /// Row of a grain.
    pub row: u32,
    /// Row of a higher one, or the number of a wall.
    pub other: u32,
    /// The spring across.
    pub history: History,
    /// Turning of one against the other, times the effective radius: springs of rolling and twisting \[m\].
    pub rolled: Vector,
}

impl Memory {
    /// As numbers.
    #[must_use]
    pub fn save(&self) -> [f64; 9] {
        let ([x, y, z], [p, q, r]) = (self.history.stretch, self.rolled);
        let rows = [f64::from(self.row), f64::from(self.other)];
        [rows[0], rows[1], x, y, z, self.history.stiffness, p, q, r]
    }

    /// From the numbers of [`Memory::save`].
    #[must_use]
    pub fn restored([row, other, x, y, z, stiffness, p, q, r]: [f64; 9]) -> Self {
        Self {
            row: row as u32,
            other: other as u32,
            history: History {
                stretch: [x, y, z],
                stiffness,
            },
            rolled: [p, q, r],
        }
    }

    /// The same contact, seen from the grain of the lower row.
    #[must_use]
    pub fn in_order(self) -> Self {
        if self.row > self.other {
            self.turned()
        } else {
            self
        }
    }

    /// The same contact seen from the other grain: the stretch of sliding is the opposite, and so is the turning.
    fn turned(self) -> Self {
        Self {
            row: self.other,
            other: self.row,
            history: History {
                stretch: self.history.stretch.map(|s| -s),
                ..self.history
            },
            rolled: self.rolled.map(|t| -t),
        }
    }
}

/// Gives contacts between grains, and those at walls, the new rows of their grains: `rows` has that of each old row, none
/// where a grain leaves.
pub fn renumber([between, at_walls]: &mut [Vec<Memory>; 2], rows: &[Option<u32>]) {
    let row = |row: u32| rows[row as usize];
    between.retain_mut(|m| match (row(m.row), row(m.other)) {
        (Some(a), Some(b)) => {
            (m.row, m.other) = (a, b);
            *m = m.in_order();
            true
        }
        _ => false,
    });
    between.sort_unstable_by_key(|m| (m.row, m.other));
    at_walls.retain_mut(|m| row(m.row).map(|a| m.row = a).is_some());
}

/// New rows of those that stay where some leave.
#[must_use]
pub fn closed_up(leaves: &[bool]) -> Vec<Option<u32>> {
    let mut next = 0;
    let each = leaves.iter().map(|leaves| {
        next += u32::from(!leaves);
        (!leaves).then(|| next - 1)
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn memory(row: u32, other: u32) -> Memory {
        Memory {
            row,
            other,
            history: History {
                stretch: [1.0, 2.0, 3.0],
                stiffness: 4.0,
            },
            rolled: [5.0, 6.0, 7.0],
        }
    }

    #[test]
    fn contacts_follow_their_grains_to_new_rows() {
        // Rows 0, 1, 2, 3 become 2, gone, 0, 1.
        let rows = [Some(2), None, Some(0), Some(1)];
        let mut memories = [
            vec![memory(0, 1), memory(0, 2), memory(2, 3)],
            vec![memory(1, 0), memory(3, 5)],
        ];
        renumber(&mut memories, &rows);
        let turned = memory(0, 2);
        let turned = Memory {
            history: History {
                stretch: [-1.0, -2.0, -3.0],
                ..turned.history
            },
            rolled: turned.rolled.map(|t| -t),
            ..turned
        };
        assert_eq!(memories[0], [memory(0, 1), turned]);
        assert_eq!(memories[1], [memory(1, 5)]);
        assert_eq!(closed_up(&[false, true, false]), [Some(0), None, Some(1)]);
    }
}
