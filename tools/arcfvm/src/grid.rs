//! The axisymmetric staggered grid (Komen 2019, figs 3.2 to 3.4).
//!
//! Cell `(i, j)` stands at `j * nr + i`. Radial face `i` of row `j` stands at `j * (nr + 1) + i`,
//! axial face `j` of column `i` at `j * nr + i`. Areas and volumes are those of the whole ring, so
//! that fluxes are in kg/s, A and W.

use std::f64::consts::PI;

/// Wanted spacing against position, piecewise linear, held beyond the ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Spacing {
    /// Positions \[m\], increasing.
    pub at: Vec<f64>,
    /// Spacing there \[m\].
    pub spacing: Vec<f64>,
}

impl Spacing {
    /// The same spacing everywhere.
    #[must_use]
    pub fn uniform(spacing: f64) -> Self {
        Self {
            at: vec![0.0],
            spacing: vec![spacing],
        }
    }

    fn value(&self, x: f64) -> f64 {
        let n = self.at.len();
        let k = self.at.partition_point(|a| *a <= x);
        if k == 0 {
            return self.spacing[0];
        }
        if k == n {
            return self.spacing[n - 1];
        }
        let part = (x - self.at[k - 1]) / (self.at[k] - self.at[k - 1]);
        self.spacing[k - 1] + part * (self.spacing[k] - self.spacing[k - 1])
    }

    /// Whether the spacing is one value between `a` and `b`.
    fn constant(&self, a: f64, b: f64) -> bool {
        let first = self.value(a);
        let inner = self
            .at
            .iter()
            .zip(&self.spacing)
            .filter(|(x, _)| **x > a && **x < b);
        inner
            .map(|(_, s)| *s)
            .chain([self.value(b)])
            .all(|s| (s - first).abs() <= 1e-12 * first)
    }
}

/// Steps of the integral of 1 / spacing in a graded interval.
const STEPS: usize = 4000;

/// Faces along one direction: every break is a face, and between two breaks cells grow as the
/// spacing asks, as many as keep it an upper bound.
#[must_use]
pub fn faces(breaks: &[f64], spacing: &Spacing) -> Vec<f64> {
    let mut faces = vec![breaks[0]];
    for pair in breaks.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if spacing.constant(a, b) {
            let n = cells((b - a) / spacing.value(a));
            faces.extend((1..n).map(|k| a + (b - a) * k as f64 / n as f64));
        } else {
            graded(a, b, spacing, &mut faces);
        }
        faces.push(b);
    }
    faces
}

/// Whole number of cells for a wanted, possibly fractional number.
fn cells(wanted: f64) -> usize {
    // Rounding in the sixth place must not add a cell.
    ((wanted - 1e-6).ceil() as usize).max(1)
}

/// How many cells [`faces`] would make, before any is made; may be infinite.
#[must_use]
pub fn wanted(breaks: &[f64], spacing: &Spacing) -> f64 {
    let between = breaks.windows(2).map(|pair| {
        let (a, b) = (pair[0], pair[1]);
        let integral = if spacing.constant(a, b) {
            (b - a) / spacing.value(a)
        } else {
            let step = (b - a) / STEPS as f64;
            let place = |k: usize| a + (k as f64 + 0.5) * step;
            (0..STEPS).map(|k| step / spacing.value(place(k))).sum()
        };
        integral.max(1.0)
    });
    between.sum()
}

fn graded(a: f64, b: f64, spacing: &Spacing, faces: &mut Vec<f64>) {
    let step = (b - a) / STEPS as f64;
    let mut sum = vec![0.0];
    for k in 0..STEPS {
        let middle = a + (k as f64 + 0.5) * step;
        sum.push(sum[k] + step / spacing.value(middle));
    }
    let n = cells(sum[STEPS]);
    for k in 1..n {
        let want = sum[STEPS] * k as f64 / n as f64;
        let at = sum.partition_point(|s| *s <= want) - 1;
        let part = (want - sum[at]) / (sum[at + 1] - sum[at]);
        faces.push(a + (at as f64 + part) * step);
    }
}

/// A face of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceIndex {
    /// Radial face.
    Radial(usize),
    /// Axial face.
    Axial(usize),
}

/// Faces, centres and sizes of all cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Radial number of cells.
    pub nr: usize,
    /// Axial number of cells.
    pub nz: usize,
    /// Radial faces \[m\], `[nr + 1]`.
    pub rf: Vec<f64>,
    /// Radial centres \[m\], `[nr]`.
    pub rc: Vec<f64>,
    /// Radial widths \[m\], `[nr]`.
    pub dr: Vec<f64>,
    /// Axial faces \[m\], `[nz + 1]`.
    pub zf: Vec<f64>,
    /// Axial centres \[m\], `[nz]`.
    pub zc: Vec<f64>,
    /// Axial widths \[m\], `[nz]`.
    pub dz: Vec<f64>,
    /// Area of the axial faces of column `i` \[m2\], `[nr]`.
    pub ring: Vec<f64>,
}

fn centres(faces: &[f64]) -> (Vec<f64>, Vec<f64>) {
    faces
        .windows(2)
        .map(|f| (0.5 * (f[0] + f[1]), f[1] - f[0]))
        .unzip()
}

impl Grid {
    /// Builds the grid from its faces.
    #[must_use]
    pub fn new(rf: Vec<f64>, zf: Vec<f64>) -> Self {
        let (rc, dr) = centres(&rf);
        let (zc, dz) = centres(&zf);
        let ring = rf
            .windows(2)
            .map(|r| PI * (r[1] * r[1] - r[0] * r[0]))
            .collect();
        Self {
            nr: rc.len(),
            nz: zc.len(),
            rf,
            rc,
            dr,
            zf,
            zc,
            dz,
            ring,
        }
    }

    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nr * self.nz
    }

    /// Whether there is no cell.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Index of cell `(i, j)`.
    #[must_use]
    #[inline]
    pub fn cell(&self, i: usize, j: usize) -> usize {
        j * self.nr + i
    }

    /// Cells that share a face with cell `k`.
    pub(crate) fn beside(&self, k: usize) -> impl Iterator<Item = usize> {
        let (i, j) = (k % self.nr, k / self.nr);
        let sides = [
            (i + 1 < self.nr).then(|| k + 1),
            (i > 0).then(|| k - 1),
            (j + 1 < self.nz).then(|| k + self.nr),
            (j > 0).then(|| k - self.nr),
        ];
        sides.into_iter().flatten()
    }

    /// Index of radial face `i` of row `j`.
    #[must_use]
    #[inline]
    pub fn radial_face(&self, i: usize, j: usize) -> usize {
        j * (self.nr + 1) + i
    }

    /// Index of axial face `j` of column `i`.
    #[must_use]
    #[inline]
    pub fn axial_face(&self, i: usize, j: usize) -> usize {
        j * self.nr + i
    }

    /// Number of radial faces.
    #[must_use]
    pub fn radial_faces(&self) -> usize {
        (self.nr + 1) * self.nz
    }

    /// Number of axial faces.
    #[must_use]
    pub fn axial_faces(&self) -> usize {
        self.nr * (self.nz + 1)
    }

    /// Area of radial face `i` of row `j` \[m2\].
    #[must_use]
    #[inline]
    pub fn area(&self, i: usize, j: usize) -> f64 {
        2.0 * PI * self.rf[i] * self.dz[j]
    }

    /// Volume of cell `(i, j)` \[m3\].
    #[must_use]
    #[inline]
    pub fn volume(&self, i: usize, j: usize) -> f64 {
        self.ring[i] * self.dz[j]
    }

    /// Values of every cell in the order of a grid table, the height running fastest.
    pub(crate) fn by_height(&self, value: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        (0..self.nr)
            .flat_map(|i| (0..self.nz).map(move |j| (i, j)))
            .map(|(i, j)| value(i, j))
            .collect()
    }

    /// The row whose cells hold height `z`.
    #[must_use]
    pub fn row_of(&self, z: f64) -> usize {
        self.zf.partition_point(|f| *f <= z).clamp(1, self.nz) - 1
    }

    /// The column whose cells hold radius `r`.
    #[must_use]
    pub fn column_of(&self, r: f64) -> usize {
        self.rf.partition_point(|f| *f <= r).clamp(1, self.nr) - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_break_is_a_face_and_spacing_is_an_upper_bound() {
        let graded = Spacing {
            at: vec![0.0, 6e-3, 20e-3],
            spacing: vec![1e-4, 1e-4, 5e-4],
        };
        for wire in [0.4e-3, 0.45e-3, 0.6e-3, 2e-3] {
            let f = faces(&[0.0, wire, 8e-3, 20e-3], &graded);
            for b in [0.0, wire, 8e-3, 20e-3] {
                assert!(f.iter().any(|x| (x - b).abs() < 1e-15), "{b}");
            }
            for w in f.windows(2) {
                let bound = graded.value(w[0]).max(graded.value(w[1]));
                assert!(w[1] > w[0] && w[1] - w[0] <= 1.001 * bound, "{w:?}");
            }
        }
    }

    #[test]
    fn cells_are_counted_before_they_are_made() {
        let graded = Spacing {
            at: vec![0.0, 6e-3, 20e-3],
            spacing: vec![1e-4, 1e-4, 5e-4],
        };
        let breaks = [0.0, 0.6e-3, 8e-3, 20e-3];
        let (made, told) = (
            faces(&breaks, &graded).len() as f64 - 1.0,
            wanted(&breaks, &graded),
        );
        assert!(told <= made && made < told + 3.0, "{told} {made}");
        assert!(wanted(&[0.0, 1e300], &Spacing::uniform(1e-300)).is_infinite());
    }

    #[test]
    fn uniform_faces_are_exact() {
        let f = faces(&[0.0, 1.0], &Spacing::uniform(0.1));
        assert_eq!(f.len(), 11);
        assert!(
            f.iter()
                .enumerate()
                .all(|(k, x)| (x - k as f64 / 10.0).abs() < 1e-15)
        );
    }

    #[test]
    fn volumes_sum_to_the_cylinder() {
        let g = Grid::new(
            faces(&[0.0, 0.3, 1.0], &Spacing::uniform(0.07)),
            vec![0.0, 0.5, 2.0],
        );
        let sum: f64 = (0..g.nz)
            .flat_map(|j| (0..g.nr).map(move |i| (i, j)))
            .map(|(i, j)| g.volume(i, j))
            .sum();
        assert!((sum - PI * 2.0).abs() < 1e-13);
        assert_eq!(g.row_of(0.6), 1);
        assert_eq!(g.column_of(-0.1), 0);
    }
}
