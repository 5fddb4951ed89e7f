//! A dielectric or conducting ellipsoid in a uniform electrostatic field.
//!
//! With `A_k(xi) = integral from xi of ds / ((s + a_k^2) R(s))`, `R^2` the product of all `s + a_j^2`, and `xi` the largest root
//! of `sum_j x_j^2 / (xi + a_j^2) = 1`, the potential around it is `- sum_k E_k x_k (1 - m_k A_k(xi))`, and the field in it
//! uniform, `E_k / (1 + (S - 1) N_k)` with `N_k = q A_k(0)` and `q` half the product of the semi-axes (Stratton 1941, sections
//! 3.25 to 3.29; Landau and Lifshitz 1960, sections 4 and 8). In a plane one semi-axis is infinite and left out of `R` and `q`.

/// An ellipsoid about the origin, its axes along those of space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// Semi-axes \[m\]; the last is infinite in a plane.
    pub half: [f64; 3],
    /// Permittivity inside over that outside; infinite for a conductor.
    pub ratio: f64,
    /// The far field \[V/m\].
    pub field: [f64; 3],
}

impl Ellipsoid {
    fn flat(&self) -> bool {
        self.half[2].is_infinite()
    }

    /// `A_k(xi)`.
    fn integral(&self, k: usize, xi: f64) -> f64 {
        let root = self.half.map(|h| xi + h * h);
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        match (self.flat(), k) {
            (true, 2) => 0.0,
            (true, _) => 2.0 / (root[k].sqrt() * (root[0].sqrt() + root[1].sqrt())),
            (false, _) => 2.0 / 3.0 * carlson(root[i], root[j], root[k]),
        }
    }

    /// `q`.
    fn half_product(&self) -> f64 {
        let ends = self.half.iter().filter(|h| h.is_finite());
        0.5 * ends.product::<f64>()
    }

    /// `N_k`: their sum is 1.
    #[must_use]
    pub fn depolarisation(&self, k: usize) -> f64 {
        self.half_product() * self.integral(k, 0.0)
    }

    /// `m_k`.
    fn moment(&self, k: usize) -> f64 {
        let factor = self.depolarisation(k);
        if self.ratio.is_infinite() {
            return if factor > 0.0 {
                self.half_product() / factor
            } else {
                0.0
            };
        }
        self.half_product() * (self.ratio - 1.0) / (1.0 + (self.ratio - 1.0) * factor)
    }

    /// Is the place inside?
    #[must_use]
    pub fn holds(&self, p: [f64; 3]) -> bool {
        self.filled(p, 0.0) <= 1.0
    }

    fn filled(&self, p: [f64; 3], xi: f64) -> f64 {
        (0..3)
            .map(|k| p[k] * p[k] / (xi + self.half[k] * self.half[k]))
            .sum()
    }

    /// `xi` of a place; zero inside.
    fn xi(&self, p: [f64; 3]) -> f64 {
        let (mut low, mut high) = (0.0, p.iter().map(|x| x * x).sum::<f64>());
        if self.holds(p) {
            return 0.0;
        }
        while high - low > 1e-15 * high {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.filled(p, middle) > 1.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Field inside \[V/m\].
    #[must_use]
    pub fn inside(&self) -> [f64; 3] {
        if self.ratio.is_infinite() {
            return [0.0; 3];
        }
        [0, 1, 2].map(|k| self.field[k] / (1.0 + (self.ratio - 1.0) * self.depolarisation(k)))
    }

    /// Potential \[V\], none in the middle.
    #[must_use]
    pub fn potential(&self, p: [f64; 3]) -> f64 {
        if self.holds(p) {
            let field = self.inside();
            return -(0..3).map(|k| field[k] * p[k]).sum::<f64>();
        }
        let xi = self.xi(p);
        let part = |k: usize| self.field[k] * p[k] * (1.0 - self.moment(k) * self.integral(k, xi));
        -(0..3).map(part).sum::<f64>()
    }

    /// Field outside, on the surface too \[V/m\].
    #[must_use]
    pub fn outside(&self, p: [f64; 3]) -> [f64; 3] {
        let xi = self.xi(p);
        let root = self.half.map(|h| xi + h * h);
        let all: f64 = root.iter().filter(|r| r.is_finite()).product();
        let square: f64 = (0..3).map(|k| (p[k] / root[k]).powi(2)).sum();
        let dipoles = (0..3).map(|k| self.field[k] * p[k] * self.moment(k) / root[k]);
        let dipoles = dipoles.sum::<f64>() / all.sqrt();
        [0, 1, 2].map(|i| {
            let rise = 2.0 * p[i] / (root[i] * square);
            self.field[i] * (1.0 - self.moment(i) * self.integral(i, xi)) + rise * dipoles
        })
    }

    /// Field \[V/m\].
    #[must_use]
    pub fn electric(&self, p: [f64; 3]) -> [f64; 3] {
        if self.holds(p) {
            self.inside()
        } else {
            self.outside(p)
        }
    }

    /// The potential of a unit field along the last axis of the scene as a formula of its places, for walls far away: about
    /// an axis or in space of a body round about z, with `r` and `z`; in a plane with `x` and `y`.
    ///
    /// # Errors
    /// Where the body is none of these, or a ball.
    pub fn formula(&self) -> Result<String, String> {
        let (across, along, k) = if self.flat() {
            ("x", "y", 1)
        } else {
            ("r", "z", 2)
        };
        if !self.flat() && (self.half[0] - self.half[1]).abs() > 1e-12 * self.half[0] {
            return Err("known is a formula of bodies round about z alone".to_owned());
        }
        let [a, b] = [self.half[0], self.half[k]].map(|h| h * h);
        let sum = format!("({across}^2 + {along}^2 - {:e})", a + b);
        let xi = format!(
            "0.5*({sum} + sqrt({sum}^2 + 4*({across}^2*{b:e} + {along}^2*{a:e} - {:e})))",
            a * b
        );
        let w = format!("sqrt({xi} + {b:e})");
        let focus = (b - a).abs().sqrt();
        let integral = if self.flat() {
            format!("2/({w}*({w} + sqrt({xi} + {a:e})))")
        } else if b > a {
            let cube = focus.powi(3);
            format!(
                "(ln(({w} + {focus:e})/({w} - {focus:e})) - {:e}/{w})/{cube:e}",
                2.0 * focus
            )
        } else if b < a {
            format!(
                "{:e}*({focus:e}/{w} - atan({focus:e}/{w}))",
                2.0 / focus.powi(3)
            )
        } else {
            return Err("a ball has another formula".to_owned());
        };
        Ok(format!("-{along}*(1 - {:e}*{integral})", self.moment(k)))
    }
}

/// Carlson's `R_D(x, y, z) = 3/2 integral from 0 of dt / ((t + z) sqrt((t + x)(t + y)(t + z)))` by doubling (Carlson 1979).
fn carlson(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut share) = (0.0, 1.0);
    loop {
        let mean = 0.2 * (x + y + 3.0 * z);
        let [dx, dy, dz] = [x, y, z].map(|v| (mean - v) / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let (ea, eb) = (dx * dy, dz * dz);
            let (ec, ed) = (ea - eb, ea - 6.0 * eb);
            let ee = ed + 2.0 * ec;
            let [c1, c2, c3, c4] = [3.0 / 14.0, 1.0 / 6.0, 9.0 / 22.0, 3.0 / 26.0];
            let series = 1.0
                + ed * (-c1 + 0.25 * c3 * ed - 1.5 * c4 * dz * ee)
                + dz * (c2 * ee + dz * (-c3 * ec + dz * c4 * ea));
            return 3.0 * sum + share * series / (mean * mean.sqrt());
        }
        let [rx, ry, rz] = [x, y, z].map(f64::sqrt);
        let more = rx * (ry + rz) + ry * rz;
        sum += share / (rz * (z + more));
        share *= 0.25;
        [x, y, z] = [x, y, z].map(|v| 0.25 * (v + more));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::em::dielectric::Sphere;
    use crate::heat::formula::At;
    use crate::heat::property::Property;
    use serde_json::json;

    fn body(half: [f64; 3], ratio: f64) -> Ellipsoid {
        Ellipsoid {
            half,
            ratio,
            field: [1.0, -0.5, 2.0],
        }
    }

    const SHAPES: [[f64; 3]; 4] = [
        [1.0, 1.0, 4.0],
        [3.0, 2.0, 1.0],
        [2.0, 2.0, 0.1],
        [1.0, 3.0, f64::INFINITY],
    ];

    #[test]
    fn factors_are_those_of_known_bodies() {
        let ball = body([2.0; 3], 5.0);
        assert!((ball.depolarisation(1) - 1.0 / 3.0).abs() < 1e-14);
        // Of a needle of aspect 4, `(1 - e^2) / e^3 (atanh e - e)`.
        let e = (15.0_f64 / 16.0).sqrt();
        let wanted = (1.0 - e * e) / e.powi(3) * (e.atanh() - e);
        assert!((body(SHAPES[0], 5.0).depolarisation(2) - wanted).abs() < 1e-14);
        assert!((body(SHAPES[3], 5.0).depolarisation(0) - 0.75).abs() < 1e-14);
        for half in SHAPES {
            let sum: f64 = (0..3).map(|k| body(half, 5.0).depolarisation(k)).sum();
            assert!((sum - 1.0).abs() < 1e-13, "{half:?} {sum}");
        }
    }

    #[test]
    fn a_ball_has_the_field_of_a_ball() {
        let ball = Ellipsoid {
            half: [2.0; 3],
            ratio: 80.0,
            field: [0.0, 0.0, -5.0],
        };
        let known = Sphere {
            radius: 2.0,
            ratio: 80.0,
            around: 1.0,
            field: -5.0,
            middle: 0.0,
        };
        for p in [[1.7, -1.1, 2.3], [0.3, 0.4, -0.2], [0.0, 0.0, 9.0]] {
            assert!((ball.potential(p) - known.potential(p)).abs() < 1e-12);
            for k in 0..3 {
                assert!((ball.electric(p)[k] - known.electric(p)[k]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_potential_and_the_displacement_are_continuous() {
        for half in SHAPES {
            for ratio in [0.1, 2.0, 80.0, 1e6, f64::INFINITY] {
                let own = body(half, ratio);
                let unit = [0.48, 0.6, 0.64];
                let mut p = [0, 1, 2].map(|k| unit[k] * half[k]);
                if half[2].is_infinite() {
                    p = [0.6 * half[0], 0.8 * half[1], 0.0];
                }
                let normal = [0, 1, 2].map(|k| p[k] / (half[k] * half[k]));
                let at = |s: f64| p.map(|x| x * s);
                let jump = own.potential(at(1.0 - 1e-12)) - own.potential(at(1.0 + 1e-12));
                assert!(jump.abs() < 1e-10, "{half:?} {ratio}: {jump}");
                let dot = |e: [f64; 3]| (0..3).map(|k| e[k] * normal[k]).sum::<f64>();
                let (within, beyond) = (own.inside(), own.outside(at(1.0 + 1e-12)));
                if ratio.is_finite() {
                    let (a, b) = (ratio * dot(within), dot(beyond));
                    assert!((a / b - 1.0).abs() < 1e-9, "{half:?} {ratio}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn the_field_is_minus_the_slope_of_the_potential() {
        for half in SHAPES {
            let own = body(half, 7.0);
            for p in [[1.7, -1.1, 4.3], [0.3, 0.1, -0.02], [3.1, 2.0, 0.0]] {
                for axis in 0..if half[2].is_infinite() { 2 } else { 3 } {
                    let h = 1e-5;
                    let [mut a, mut b] = [p, p];
                    a[axis] -= h;
                    b[axis] += h;
                    let slope = (own.potential(a) - own.potential(b)) / (2.0 * h);
                    let found = own.electric(p)[axis];
                    assert!(
                        (slope - found).abs() < 1e-8,
                        "{half:?} {p:?}: {slope} {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn formulas_are_the_potential() {
        for half in [SHAPES[0], SHAPES[2], SHAPES[3]] {
            let k = if half[2].is_infinite() { 1 } else { 2 };
            let mut own = body(half, 80.0);
            own.field = [0.0; 3];
            own.field[k] = 1.0;
            let formula = Property::read(&json!({"expr": own.formula().unwrap()})).unwrap();
            for p in [[9.0, 0.0, 3.0], [2.0, 0.0, 9.0], [5.0, 7.0, -3.0]] {
                let p = if k == 1 { [p[0], p[2], 0.0] } else { p };
                let found = formula.value(&At::place(p));
                assert!(
                    (found - own.potential(p)).abs() < 1e-12,
                    "{half:?} {p:?}: {found}"
                );
            }
        }
    }
}
