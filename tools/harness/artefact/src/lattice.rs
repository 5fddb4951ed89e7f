//! Grids whose cells are all alike: their steps, and where they stand in space.

use crate::cloud::{Pose, Quaternion, Vector3};
use crate::table::{Series, Table};

/// Step of an axis that ascends evenly, to a part in 10^9 of it; `None` where it does not, or where
/// there are fewer than two entries.
#[must_use]
pub fn even_step(axis: &[f64]) -> Option<f64> {
    let (first, last) = (axis.first()?, axis.last()?);
    if axis.len() < 2 {
        return None;
    }
    let step = (last - first) / (axis.len() - 1) as f64;
    let off = |(i, x): (usize, &f64)| (x - (first + step * i as f64)).abs();
    let even = axis.iter().enumerate().map(off).all(|d| d <= 1e-9 * step);
    (step > 0.0 && step.is_finite() && even).then_some(step)
}

/// A plane grid of equal cells in space. Rows run along the first axis of the table, columns along
/// the second, which is the one that runs fastest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lattice {
    /// Rows and columns.
    pub(crate) shape: [usize; 2],
    /// Size of a cell along the first and the second axis \[m\].
    pub(crate) cell: [f64; 2],
    /// Corner of the first cell \[m\]: half a cell before the first node.
    corner: [f64; 3],
    /// Directions of the two axes in space.
    along: [[f64; 3]; 2],
}

impl Lattice {
    /// The lattice of a grid; `None` where it is not plane, its cells are not alike, or its axes
    /// do not say where they run.
    pub(crate) fn of(table: &Table) -> Option<Self> {
        let [first, second] = table.axes.as_slice() else {
            return None;
        };
        let shape = [first.values.len(), second.values.len()];
        let along = [direction(first)?, direction(second)?];
        if cross(along[0], along[1]).iter().all(|e| *e == 0.0) || shape.contains(&0) {
            return None;
        }
        let step = |axis: &Series, other: &Series| match axis.values.len() {
            1 => even_step(&other.values),
            _ => even_step(&axis.values),
        };
        let cell = [step(first, second)?, step(second, first)?];
        let mut corner = standing(table, along);
        for (d, axis) in [first, second].into_iter().enumerate() {
            let start = axis.values[0] - 0.5 * cell[d];
            for (place, e) in corner.iter_mut().zip(along[d]) {
                *place += e * start;
            }
        }
        Some(Self {
            shape,
            cell,
            corner,
            along,
        })
    }

    /// Turns and shifts a plane whose x runs along the columns and whose y runs along the rows.
    pub(crate) fn pose(&self) -> Pose {
        let [x, y] = [self.along[1], self.along[0]];
        let [px, py, pz] = self.corner;
        Pose {
            position: Some(Vector3 {
                x: px,
                y: py,
                z: pz,
            }),
            orientation: Some(turn([x, y, cross(x, y)])),
        }
    }
}

/// Where an axis runs, by the first part of its name; `None` where it is no length.
fn direction(axis: &Series) -> Option<[f64; 3]> {
    if axis.unit != "m" {
        return None;
    }
    match axis.name.split('_').next()? {
        "x" | "radius" => Some([1.0, 0.0, 0.0]),
        "y" => Some([0.0, 1.0, 0.0]),
        "z" | "height" => Some([0.0, 0.0, 1.0]),
        "depth" => Some([0.0, 0.0, -1.0]),
        _ => None,
    }
}

/// Where the plane stands along its normal \[m\]: attribute `x_m`, `y_m` or `z_m`; 0 where it is absent.
fn standing(table: &Table, along: [[f64; 3]; 2]) -> [f64; 3] {
    let mut at = [0.0; 3];
    for (k, name) in ["x_m", "y_m", "z_m"].into_iter().enumerate() {
        let normal = along.iter().all(|e| e[k] == 0.0);
        if let Some(place) = table.attributes.get(name).filter(|_| normal) {
            at[k] = place.value;
        }
    }
    at
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The quaternion of the rotation that makes the three unit vectors `e` of x, y and z.
fn turn(e: [[f64; 3]; 3]) -> Quaternion {
    let diagonal = [e[0][0], e[1][1], e[2][2]];
    let trace: f64 = diagonal.iter().sum();
    if trace > 0.0 {
        let w = 0.5 * (1.0 + trace).sqrt();
        let part = |i: usize, k: usize| (e[i][k] - e[k][i]) / (4.0 * w);
        return Quaternion {
            x: part(1, 2),
            y: part(2, 0),
            z: part(0, 1),
            w,
        };
    }
    // The greatest entry of the diagonal keeps the divisor away from zero.
    let i = (1..3).fold(0, |best, k| {
        if diagonal[k] > diagonal[best] {
            k
        } else {
            best
        }
    });
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let main = 0.5 * (1.0 + diagonal[i] - diagonal[j] - diagonal[k]).sqrt();
    let mut vector = [0.0; 3];
    vector[i] = main;
    vector[j] = (e[i][j] + e[j][i]) / (4.0 * main);
    vector[k] = (e[i][k] + e[k][i]) / (4.0 * main);
    let [x, y, z] = vector;
    Quaternion {
        x,
        y,
        z,
        w: (e[j][k] - e[k][j]) / (4.0 * main),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_even_to_a_part_in_a_thousand_million() {
        let axis: Vec<f64> = (-7..5).map(|i| f64::from(i) * 0.0003).collect();
        assert!((even_step(&axis).unwrap() - 0.0003).abs() < 1e-18);
        assert_eq!(even_step(&[0.0, 1.0, 2.0 + 1e-8]), None);
        assert_eq!(even_step(&[1.0, 0.0]), None);
        assert_eq!(even_step(&[0.0, 0.0]), None);
        assert_eq!(even_step(&[0.0]), None);
        assert_eq!(even_step(&[0.0, f64::INFINITY]), None);
    }

    /// Turns a vector by a quaternion: q v q*.
    fn turned(q: Quaternion, v: [f64; 3]) -> [f64; 3] {
        let u = [q.x, q.y, q.z];
        let t = cross(u, v).map(|c| 2.0 * c);
        let s = cross(u, t);
        [0, 1, 2].map(|k| v[k] + q.w * t[k] + s[k])
    }

    const NAMES: [&str; 4] = ["x_m", "y_m", "z_m", "depth_m"];

    #[test]
    fn every_node_stands_where_its_axes_say() {
        let (first, second) = ([1.0, 3.0, 5.0], [-0.5, 0.0]);
        let mut planes = 0;
        for a in NAMES {
            for b in NAMES {
                let table = Table::grid(&[(a, "m", &first), (b, "m", &second)])
                    .attribute("x_m", "m", 7.0)
                    .attribute("y_m", "m", 8.0)
                    .attribute("z_m", "m", 9.0);
                let Some(lattice) = Lattice::of(&table) else {
                    continue;
                };
                planes += 1;
                let pose = lattice.pose();
                let (p, q) = (pose.position.unwrap(), pose.orientation.unwrap());
                for (i, u) in first.iter().enumerate() {
                    for (j, v) in second.iter().enumerate() {
                        // Centre of the cell in column j and row i.
                        let local = [(j as f64 + 0.5) * 0.5, (i as f64 + 0.5) * 2.0, 0.0];
                        let d = turned(q.clone(), local);
                        let found = [p.x + d[0], p.y + d[1], p.z + d[2]];
                        let mut expected = [7.0, 8.0, 9.0];
                        for (name, x) in [(a, u), (b, v)] {
                            let k = NAMES.iter().position(|n| *n == name).unwrap();
                            expected[k.min(2)] = if k == 3 { -x } else { *x };
                        }
                        for (x, y) in found.iter().zip(expected) {
                            assert!((x - y).abs() < 1e-12, "{a} {b}: {found:?} {expected:?}");
                        }
                    }
                }
            }
        }
        // Two axes of four, in order, but z and depth, which run along one line.
        assert_eq!(planes, 10);
    }

    #[test]
    fn what_has_no_place_in_space_is_no_lattice() {
        let even = [0.0, 1.0];
        for axes in [
            [("time_s", "s"), ("x_m", "m")],
            [("x_m", "1"), ("y_m", "m")],
            [("grain_m", "m"), ("y_m", "m")],
        ] {
            let [a, b] = axes.map(|(name, unit)| (name, unit, even.as_slice()));
            assert_eq!(Lattice::of(&Table::grid(&[a, b])), None, "{axes:?}");
        }
        let uneven = [0.0, 1.0, 3.0];
        let table = Table::grid(&[("x_m", "m", &even), ("y_m", "m", &uneven)]);
        assert_eq!(Lattice::of(&table), None);
        assert_eq!(Lattice::of(&Table::grid(&[("x_m", "m", &even)])), None);
        assert_eq!(Lattice::of(&Table::new(2)), None);
        let empty = Table::grid(&[("x_m", "m", &even), ("y_m", "m", &[])]);
        assert_eq!(Lattice::of(&empty), None);
    }

    #[test]
    fn a_single_row_has_square_cells() {
        let table = Table::grid(&[("x_m", "m", &[2.0]), ("y_m", "m", &[0.0, 0.5])]);
        let cell = Lattice::of(&table).unwrap().cell;
        assert!(cell.iter().all(|size| (size - 0.5).abs() < 1e-15));
    }
}
