//! The wall of the domain as if there were none: the reaction there is that of the multipoles of the
//! currents found inside, so that nothing is truncated but multipoles beyond the third.

use crate::stencils::region::{Kind, Region};

/// Multipoles about a centre: how much of each a unit current at a point makes, and what each gives at
/// a point of the wall.
#[derive(Debug, Clone)]
pub struct Multipoles {
    /// About this place in the coordinates of the points \[m\]; `[0; 3]` beyond them.
    centre: [f64; 3],
    /// Volume for which each point stands \[m3; m2 in a plane\].
    pub weights: Vec<f64>,
    /// By multipole and point: moment per current (zero where nothing conducts).
    pub moments: Vec<Vec<f64>>,
    /// By multipole and point: `A` of a unit moment, over `mu`; zero off the walls.
    pub fields: Vec<Vec<f64>>,
}

impl Multipoles {
    /// Multipoles of the degrees 0 to 3 in space and in a plane, 1 to 5 about an axis of symmetry; `weights` are those
    /// of [`crate::stencils::quadrature`].
    #[must_use]
    pub fn new<const D: usize>(region: &Region<D>, weights: &[f64]) -> Self {
        let mut centre = centre(region, weights);
        if region.axial {
            centre[0] = 0.0;
        }
        let kind = kind(region);
        let count = kind(&[1.0; 3][..D]).len();
        let [mut moments, mut fields] = [(); 2].map(|()| vec![vec![0.0; region.len()]; count]);
        let off = |p: [f64; D]| -> [f64; D] { std::array::from_fn(|k| p[k] - centre[k]) };
        for i in 0..region.len() {
            if weights[i] != 0.0 {
                for (l, pair) in kind(&off(region.places[i])).iter().enumerate() {
                    moments[l][i] = weights[i] * pair[0];
                }
            }
            if let Kind::Wall { .. } = region.kinds[i] {
                for (l, pair) in kind(&off(region.places[i])).iter().enumerate() {
                    fields[l][i] = pair[1];
                }
            }
        }
        Self {
            centre: std::array::from_fn(|k| if k < D { centre[k] } else { 0.0 }),
            weights: weights.to_vec(),
            moments,
            fields,
        }
    }

    /// Each regular harmonic at a place, with its gradient.
    #[must_use]
    pub fn regular<const D: usize>(&self, region: &Region<D>, i: usize) -> Vec<(f64, [f64; D])> {
        let kind = kind(region);
        let off: [f64; D] = std::array::from_fn(|k| region.places[i][k] - self.centre[k]);
        let step = region.metrics[i].spacing();
        let mut found: Vec<(f64, [f64; D])> = kind(&off).iter().map(|h| (h[0], [0.0; D])).collect();
        for axis in 0..D {
            // Exact for polynomials of up to the sixth degree.
            for (n, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
                let at = |n: f64| {
                    let mut beside = off;
                    beside[axis] += n * step;
                    kind(&beside)
                };
                for ((found, up), down) in found.iter_mut().zip(at(n)).zip(at(-n)) {
                    found.1[axis] += weight * (up[0] - down[0]) / (60.0 * step);
                }
            }
        }
        found
    }
}

/// Regular harmonics at a place and the irregular ones that belong to them.
fn kind<const D: usize>(region: &Region<D>) -> fn(&[f64]) -> Vec<[f64; 2]> {
    match (D, region.axial) {
        (3, _) => solid,
        (_, true) => coaxial,
        _ => plane,
    }
}

/// Middle of all conductors.
fn centre<const D: usize>(region: &Region<D>, weights: &[f64]) -> [f64; D] {
    let total: f64 = weights.iter().sum();
    std::array::from_fn(|k| {
        let each = weights.iter().zip(&region.places);
        each.map(|(w, x)| w * x[k]).sum::<f64>() / total.max(f64::MIN_POSITIVE)
    })
}

/// Real solid harmonics in Racah's norm: `1/|x - x'| = sum R(x') R(x)/r^(2l+1)`; regular ones, and
/// irregular ones over `4 pi`.
fn solid(p: &[f64]) -> Vec<[f64; 2]> {
    let [x, y, z] = [p[0], p[1], p[2]];
    let s = x * x + y * y + z * z;
    let root = |v: f64| v.sqrt();
    let regular = [
        (0, 1.0),
        (1, x),
        (1, y),
        (1, z),
        (2, 1.5 * z * z - 0.5 * s),
        (2, root(3.0) * x * z),
        (2, root(3.0) * y * z),
        (2, root(3.0) * x * y),
        (2, root(0.75) * (x * x - y * y)),
        (3, 2.5 * z * z * z - 1.5 * z * s),
        (3, root(0.375) * x * (5.0 * z * z - s)),
        (3, root(0.375) * y * (5.0 * z * z - s)),
        (3, root(3.75) * z * (x * x - y * y)),
        (3, root(15.0) * x * y * z),
        (3, root(0.625) * x * (x * x - 3.0 * y * y)),
        (3, root(0.625) * y * (3.0 * x * x - y * y)),
    ];
    let r = s.sqrt();
    let far = 4.0 * std::f64::consts::PI;
    let pair = |(l, v): (i32, f64)| [v, v / (far * r.powi(2 * l + 1))];
    regular.into_iter().map(pair).collect()
}

/// `-1/(2 pi) ln|x - x'|` in a plane.
fn plane(p: &[f64]) -> Vec<[f64; 2]> {
    let turn = 2.0 * std::f64::consts::PI;
    let r = p[0].hypot(p[1]);
    let mut found = vec![[1.0, -r.ln() / turn]];
    let [mut c, mut s] = [1.0, 0.0];
    for l in 1..=3 {
        (c, s) = (c * p[0] - s * p[1], c * p[1] + s * p[0]);
        let far = turn * f64::from(l) * r.powi(2 * l);
        found.push([c, c / far]);
        found.push([s, s / far]);
    }
    found
}

/// `A_phi / rho` of coaxial currents: `d^l P_l^1` per volume of a full turn, and
/// `P_l^1 / (4 pi l (l+1) r^(l+1) rho)`.
fn coaxial(p: &[f64]) -> Vec<[f64; 2]> {
    let [rho, z] = [p[0], p[1]];
    let r = rho.hypot(z);
    let cosine = z / r.max(f64::MIN_POSITIVE);
    // P_l^1 / sin = P_l', which is smooth on the axis.
    let slope = [
        1.0,
        3.0 * cosine,
        7.5 * cosine * cosine - 1.5,
        17.5 * cosine.powi(3) - 7.5 * cosine,
        (315.0 * cosine.powi(4) - 210.0 * cosine * cosine + 15.0) / 8.0,
    ];
    slope
        .iter()
        .zip(1..)
        .map(|(s, l): (&f64, i32)| {
            let far = 4.0 * std::f64::consts::PI * f64::from(l * (l + 1)) * r.powi(l + 2);
            [r.powi(l - 1) * rho * s, s / far]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(of: fn(&[f64]) -> Vec<[f64; 2]>, near: &[f64], far: &[f64]) -> f64 {
        let pairs = of(near).into_iter().zip(of(far));
        pairs.map(|(a, b)| a[0] * b[1]).sum()
    }

    #[test]
    fn in_space_they_add_up_to_the_distance() {
        let [near, far]: [[f64; 3]; 2] = [[0.1, -0.05, 0.08], [1.0, 0.7, -0.9]];
        let d: f64 = (0..3).map(|k| (near[k] - far[k]).powi(2)).sum();
        let exact = 1.0 / (4.0 * std::f64::consts::PI * d.sqrt());
        assert!((sum(solid, &near, &far) / exact - 1.0).abs() < 1e-4);
    }

    #[test]
    fn in_a_plane_they_add_up_to_its_logarithm() {
        let [near, far]: [[f64; 2]; 2] = [[0.1, -0.05], [1.0, 0.7]];
        let d = (near[0] - far[0]).hypot(near[1] - far[1]);
        let exact = -d.ln() / (2.0 * std::f64::consts::PI);
        assert!((sum(plane, &near, &far) / exact - 1.0).abs() < 1e-4);
    }

    #[test]
    fn about_an_axis_they_add_up_to_a_loop() {
        let one = crate::magnetic::source::Loop {
            centre: [0.0, 0.0, 0.1],
            axis: [0.0, 0.0, 1.0],
            radius: 0.2,
            wire_radius: 1e-6,
            current: 1.0.into(),
        };
        let a = one.potential([0.9, 0.0, -0.7])[1];
        // A turn of 1 A has the volume 2 pi rho per section.
        let turn = 2.0 * std::f64::consts::PI * 0.2;
        let found =
            crate::magnetic::source::MU0 * turn * sum(coaxial, &[0.2, 0.1], &[0.9, -0.7]) * 0.9;
        assert!((found / a - 1.0).abs() < 1e-4, "{found} {a}");
    }
}
