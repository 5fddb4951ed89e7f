//! Area of a plane that lies within one particle's share of the space.

/// Most corners of a polygon: a square cut by every neighbour within reach.
const CORNERS: usize = 48;

/// A convex polygon in a plane, cut down by half-planes.
pub(super) struct Polygon {
    corners: [[f64; 2]; CORNERS],
    n: usize,
    /// Squared distance of the farthest corner from the origin.
    reach: f64,
}

impl Polygon {
    /// A square of half the edge `half` \[m\] around the origin.
    pub(super) fn square(half: f64) -> Self {
        let mut corners = [[0.0; 2]; CORNERS];
        corners[..4].copy_from_slice(&[[-half, -half], [half, -half], [half, half], [-half, half]]);
        Self {
            corners,
            n: 4,
            reach: 2.0 * half * half,
        }
    }

    /// Keeps what has `normal . y <= offset`.
    #[inline]
    pub(super) fn cut(&mut self, normal: [f64; 2], offset: f64) {
        // Most neighbours are too far to cut anything.
        let square = normal[0] * normal[0] + normal[1] * normal[1];
        if offset > 0.0 && offset * offset >= self.reach * square {
            return;
        }
        let height = |y: [f64; 2]| normal[0] * y[0] + normal[1] * y[1] - offset;
        let whole = &self.corners[..self.n];
        if whole.iter().all(|y| height(*y) <= 0.0) || self.n + 1 >= CORNERS {
            return;
        }
        let mut kept = [[0.0; 2]; CORNERS];
        let mut n = 0;
        let mut keep = |y| {
            kept[n] = y;
            n += 1;
        };
        for k in 0..self.n {
            let (a, b) = (whole[k], whole[(k + 1) % self.n]);
            let (p, q) = (height(a), height(b));
            if p <= 0.0 {
                keep(a);
            }
            if (p < 0.0 && q > 0.0) || (p > 0.0 && q < 0.0) {
                let part = p / (p - q);
                keep([a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]);
            }
        }
        self.corners[..n].copy_from_slice(&kept[..n]);
        self.n = n;
        let squares = kept[..n].iter().map(|y| y[0] * y[0] + y[1] * y[1]);
        self.reach = squares.fold(0.0, f64::max);
    }

    /// True if nothing is left.
    pub(super) fn is_empty(&self) -> bool {
        self.n < 3
    }

    /// Area \[m2\].
    pub(super) fn area(&self) -> f64 {
        let corners = &self.corners[..self.n];
        let mut twice = 0.0;
        for k in 0..self.n {
            let (a, b) = (corners[k], corners[(k + 1) % self.n]);
            twice += a[0] * b[1] - a[1] * b[0];
        }
        0.5 * twice
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_take_what_they_should() {
        let mut polygon = Polygon::square(1.0);
        polygon.cut([1.0, 0.0], 0.5);
        assert!((polygon.area() - 3.0).abs() < 1e-14);
        polygon.cut([1.0, 1.0], -5.0);
        assert!(polygon.is_empty());
        let mut diamond = Polygon::square(1.0);
        for normal in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            diamond.cut(normal, 1.0);
        }
        assert!((diamond.area() - 2.0).abs() < 1e-14);
        // Its corners are at 1: what passes just outside leaves it, what passes just inside does not.
        diamond.cut([2.0, 0.0], 2.0 + 1e-9);
        assert!((diamond.area() - 2.0).abs() < 1e-14);
        diamond.cut([2.0, 0.0], 1.0);
        assert!((diamond.area() - 1.75).abs() < 1e-14);
    }
}
