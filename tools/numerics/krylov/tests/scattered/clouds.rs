//! Equations of weighted least squares on scattered points of a cube: quadratic Laplacian rows, a
//! ball of another material in the middle, one-sided rows of a jump on its surface.

use krylov::Rows;
use nalgebra::{SMatrix, SVector};
use num_complex::Complex;

pub(crate) type C64 = Complex<f64>;

/// Numbers in [0, 1) that are the same in every run.
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// What a point carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// In the ball or around it.
    Medium(u8),
    /// On the surface of the ball.
    Surface,
    /// On the outer wall.
    Wall,
}

/// A cube [-1, 1]^3 with a ball of radius `radius`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cloud {
    /// Points along an edge.
    pub(crate) side: usize,
    /// Displacement, in spacings.
    pub(crate) jitter: f64,
    /// Radius of the ball; 0: no ball.
    pub(crate) radius: f64,
    /// Permittivity of the ball over that around it.
    pub(crate) ratio: f64,
    /// The z axis is squeezed by this: anisotropic layers.
    pub(crate) squeeze: f64,
    /// `omega mu sigma` of the ball.
    pub(crate) shift: f64,
}

impl Cloud {
    pub(crate) fn plain(side: usize) -> Self {
        Self {
            side,
            jitter: 0.2,
            radius: 0.0,
            ratio: 1.0,
            squeeze: 1.0,
            shift: 0.0,
        }
    }

    pub(crate) fn ball(side: usize, ratio: f64) -> Self {
        Self {
            radius: 0.5,
            ratio,
            ..Self::plain(side)
        }
    }

    fn spacing(&self) -> f64 {
        2.0 / (self.side - 1) as f64
    }

    /// Points in lattice order, those of the surface last; the metric is that of the lattice.
    pub(crate) fn points(&self) -> (Vec<[f64; 3]>, Vec<Kind>) {
        let (m, h, mut numbers) = (self.side, self.spacing(), Numbers(7));
        let (mut points, mut kinds) = (Vec::new(), Vec::new());
        for i in 0..m * m * m {
            let at = [i % m, i / m % m, i / m / m];
            let wall = at.iter().any(|a| *a == 0 || *a == m - 1);
            let mut p = at.map(|a| -1.0 + h * a as f64);
            if wall {
                points.push(p);
                kinds.push(Kind::Wall);
                continue;
            }
            for x in &mut p {
                *x += h * self.jitter * (2.0 * numbers.next() - 1.0);
            }
            let r = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            if self.radius > 0.0 && (r - self.radius).abs() < 0.5 * h {
                continue;
            }
            points.push(p);
            kinds.push(Kind::Medium(u8::from(r < self.radius)));
        }
        if self.radius > 0.0 {
            // A spiral over the ball, about one point per square of the spacing.
            let count = (12.57 * (self.radius / h).powi(2)) as usize;
            for k in 0..count {
                let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
                let (s, turn) = ((1.0 - z * z).sqrt(), 2.399_963_229_728_653 * k as f64);
                points.push([s * turn.cos(), s * turn.sin(), z].map(|x| x * self.radius));
                kinds.push(Kind::Surface);
            }
        }
        (points, kinds)
    }

    /// Rows, complex diagonal (empty without a shift) and three right sides, one of them smooth,
    /// one noisy, one a field along x.
    pub(crate) fn build(&self) -> System {
        let (points, kinds) = self.points();
        let h = self.spacing();
        let cells = Cells::new(&points, 2.5 * h, self.side);
        let n = points.len();
        let rows = Rows::gathered(n, 0.0, |i, row| match kinds[i] {
            Kind::Wall => row.push((i as u32, 1.0)),
            Kind::Medium(side) => {
                let (mut fit, mut wide) = (Fit::default(), Vec::new());
                cells.near(&points, i, |j| sees(side, kinds[j]), &mut wide);
                let [_, _, _, xx, yy, zz, ..] = fit.solve(&points, i, &wide, 2.5 * h);
                let s = self.squeeze.powi(-2);
                for (k, &j) in wide.iter().enumerate() {
                    let v = xx[k] + yy[k] + s * zz[k];
                    row.push((j, v));
                    row.push((i as u32, -v));
                }
            }
            Kind::Surface => {
                let p = points[i];
                let (mut fit, mut wide) = (Fit::default(), Vec::new());
                for (side, factor) in [(1, self.ratio), (0, -1.0)] {
                    cells.near(&points, i, |j| sees(side, kinds[j]), &mut wide);
                    let g = fit.solve(&points, i, &wide, 2.5 * h);
                    let s = factor / (1.0 + self.ratio) / self.radius;
                    for (k, &j) in wide.iter().enumerate() {
                        let v = s * (p[0] * g[0][k] + p[1] * g[1][k] + p[2] * g[2][k]);
                        row.push((j, v));
                        row.push((i as u32, -v));
                    }
                }
            }
        });
        let shift = if self.shift == 0.0 {
            Vec::new()
        } else {
            let of = |k: &Kind| match k {
                Kind::Medium(1) => C64::new(0.0, -self.shift),
                _ => C64::new(0.0, 0.0),
            };
            kinds.iter().map(of).collect()
        };
        let rhs = sides(&points, &kinds, self.shift);
        System { rows, shift, rhs }
    }
}

/// Equations, in lattice order.
pub(crate) struct System {
    pub(crate) rows: Rows<f64>,
    pub(crate) shift: Vec<C64>,
    pub(crate) rhs: Vec<[C64; 3]>,
}

fn sides(points: &[[f64; 3]], kinds: &[Kind], shift: f64) -> Vec<[C64; 3]> {
    let side = |(p, k): (&[f64; 3], &Kind)| match k {
        Kind::Wall => [p[2], p[0] * p[1], p[0]].map(|v| C64::new(v, 0.0)),
        Kind::Medium(1) => {
            let field = [p[1], -p[0], 1.0];
            field.map(|v| C64::new(0.0, shift * v))
        }
        _ => [C64::new(0.0, 0.0); 3],
    };
    points.iter().zip(kinds).map(side).collect()
}

/// May a stencil of this side use a point?
fn sees(side: u8, kind: Kind) -> bool {
    match kind {
        Kind::Medium(m) => m == side,
        Kind::Surface => true,
        Kind::Wall => side == 0,
    }
}

/// Points by cells of a lattice.
struct Cells {
    size: f64,
    side: usize,
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Cells {
    fn new(points: &[[f64; 3]], size: f64, _side: usize) -> Self {
        let side = (2.0 / size).ceil() as usize + 1;
        let mut new = Self {
            size,
            side,
            starts: vec![0; side * side * side + 1],
            members: vec![0; points.len()],
        };
        for p in points {
            let c = new.index(new.cell(p));
            new.starts[c + 1] += 1;
        }
        for c in 1..new.starts.len() {
            new.starts[c] += new.starts[c - 1];
        }
        let mut next = new.starts.clone();
        for (i, p) in points.iter().enumerate() {
            let at = &mut next[new.index(new.cell(p))];
            new.members[*at as usize] = i as u32;
            *at += 1;
        }
        new
    }

    fn cell(&self, p: &[f64; 3]) -> [usize; 3] {
        p.map(|x| (((x + 1.0) / self.size).max(0.0) as usize).min(self.side - 1))
    }

    fn index(&self, c: [usize; 3]) -> usize {
        c[0] + self.side * (c[1] + self.side * c[2])
    }

    /// Neighbours of point `i` within the reach, without itself; enlarged until there are 14.
    fn near(
        &self,
        points: &[[f64; 3]],
        i: usize,
        allowed: impl Fn(usize) -> bool,
        out: &mut Vec<u32>,
    ) {
        let mut reach = 0.999 * self.size;
        loop {
            out.clear();
            let cells = (reach / self.size).ceil() as usize;
            let c = self.cell(&points[i]);
            let span = c.map(|c| c.saturating_sub(cells)..=(c + cells).min(self.side - 1));
            for z in span[2].clone() {
                for y in span[1].clone() {
                    for x in span[0].clone() {
                        let cell = self.index([x, y, z]);
                        let members = self.starts[cell] as usize..self.starts[cell + 1] as usize;
                        for &j in &self.members[members] {
                            let d = difference(points[j as usize], points[i]);
                            let near = d.iter().map(|d| d * d).sum::<f64>() < reach * reach;
                            if j as usize != i && near && allowed(j as usize) {
                                out.push(j);
                            }
                        }
                    }
                }
            }
            if out.len() >= 14 {
                return;
            }
            reach *= 1.2;
        }
    }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A quadratic fit that meets its own point; weights of the nine derivatives.
#[derive(Default)]
struct Fit {
    weights: [Vec<f64>; 9],
}

impl Fit {
    fn solve(&mut self, points: &[[f64; 3]], i: usize, near: &[u32], reach: f64) -> &[Vec<f64>; 9] {
        let basis = |j: u32| {
            let [x, y, z] = difference(points[j as usize], points[i]).map(|d| d / reach);
            let terms = [x, y, z, x * x, y * y, z * z, x * y, y * z, z * x];
            let q = (x * x + y * y + z * z).sqrt().min(0.98);
            let weight = 1.0 - 6.0 * q * q + 8.0 * q.powi(3) - 3.0 * q.powi(4);
            (SVector::<f64, 9>::from(terms), weight)
        };
        let mut moments = SMatrix::<f64, 9, 9>::zeros();
        for &j in near {
            let (b, w) = basis(j);
            moments += w * b * b.transpose();
        }
        let inverse = moments.try_inverse().unwrap();
        for column in &mut self.weights {
            column.clear();
        }
        for &j in near {
            let (b, w) = basis(j);
            let d = inverse * b * w;
            for (k, column) in self.weights.iter_mut().enumerate() {
                let scale = match k {
                    0..3 => 1.0 / reach,
                    3..6 => 2.0 / (reach * reach),
                    _ => 1.0 / (reach * reach),
                };
                column.push(d[k] * scale);
            }
        }
        &self.weights
    }
}
