//! What the unknown of eddy currents is, and the vectors that it stands for.

use super::source::C;

/// What the unknown is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unknown {
    /// Cartesian components of A: three in space, `A_z` in a plane.
    Potential,
    /// `A_phi / r` about an axis of symmetry, which is smooth on it.
    Around,
    /// `H_z` in a plane, held where nothing conducts and on interfaces with it, but for holes.
    Axial,
}

impl Unknown {
    /// How many times `1/r d/dr` its equation has about an axis, beside the Laplacian in r and z.
    #[must_use]
    pub fn around(self) -> f64 {
        match self {
            Self::Around => 3.0,
            Self::Potential | Self::Axial => 1.0,
        }
    }
}

/// A current or potential in space as the unknown has it: over the distance from an axis of symmetry.
pub(crate) fn component<const D: usize, const K: usize>(
    unknown: Unknown,
    place: &[f64; D],
    vector: &[C; 3],
) -> [C; K] {
    let zero = C::new(0.0, 0.0);
    match unknown {
        Unknown::Potential if K == 3 => std::array::from_fn(|k| vector[k]),
        Unknown::Potential => [vector[2]; K],
        Unknown::Around if vector[1] == zero => [zero; K],
        Unknown::Around => [vector[1] / place[0]; K],
        Unknown::Axial => [zero; K],
    }
}

/// A value of the unknown as a vector in space; nothing of `H_z`.
pub(crate) fn along<const D: usize, const K: usize>(
    unknown: Unknown,
    place: &[f64; D],
    value: &[C; K],
) -> [C; 3] {
    let zero = C::new(0.0, 0.0);
    match unknown {
        Unknown::Potential if K == 3 => std::array::from_fn(|k| value[k]),
        Unknown::Potential => [zero, zero, value[0]],
        Unknown::Around => [zero, value[0] * place[0], zero],
        Unknown::Axial => [zero; 3],
    }
}

/// Potential of all, and curl of the reaction, in space; `H_z` as it is.
pub(crate) fn local<const D: usize, const K: usize>(
    unknown: Unknown,
    place: &[f64; D],
    total: &[C; K],
    reaction: &[C; K],
    slopes: &[[C; D]; K],
) -> ([C; 3], [C; 3]) {
    let zero = C::new(0.0, 0.0);
    let curl = match unknown {
        Unknown::Potential if K == 3 => {
            let d = |of: usize, along: usize| slopes[of][along];
            [d(2, 1) - d(1, 2), d(0, 2) - d(2, 0), d(1, 0) - d(0, 1)]
        }
        Unknown::Potential => [slopes[0][1], -slopes[0][0], zero],
        Unknown::Around => {
            let r = place[0];
            let axial = reaction[0] * 2.0 + slopes[0][0] * r;
            [-slopes[0][1] * r, zero, axial]
        }
        Unknown::Axial => [zero, zero, total[0]],
    };
    (along(unknown, place, total), curl)
}
