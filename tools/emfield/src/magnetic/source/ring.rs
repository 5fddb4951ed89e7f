//! A circular loop of thin wire.

use shapes::frame::{cross, difference, dot};

use super::elliptic::loop_integral;
use super::{C, MU0};

/// A circular loop. Inside the wire the fields are those on its surface, turned to zero linearly:
/// no place has an infinite field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loop {
    /// Centre \[m\].
    pub centre: [f64; 3],
    /// Unit vector along the axis; the current turns around it by the right hand.
    pub axis: [f64; 3],
    /// Radius \[m\].
    pub radius: f64,
    /// Radius of the wire \[m\].
    pub wire_radius: f64,
    /// Current \[A\], rms.
    pub current: C,
}

/// Parts along the loop, away from its axis and along the axis.
struct Around {
    away: [f64; 3],
    /// Distance from the axis \[m\].
    rho: f64,
    /// Height above the plane of the loop \[m\].
    height: f64,
}

impl Loop {
    /// The same current spread evenly over the round wire: seven filaments, exact for polynomials
    /// of degree 5 over its section (Abramowitz and Stegun 1964, eq. 25.4.61).
    #[must_use]
    pub fn filaments(self) -> [Self; 7] {
        let off = (2.0_f64 / 3.0).sqrt() * self.wire_radius;
        let thin = self.wire_radius / 7.0_f64.sqrt();
        let mut found = [Self {
            wire_radius: thin,
            current: self.current * 0.25,
            ..self
        }; 7];
        for (k, filament) in found.iter_mut().enumerate().skip(1) {
            let (s, c) = (std::f64::consts::FRAC_PI_3 * k as f64).sin_cos();
            filament.radius += off * c;
            filament.centre = [0, 1, 2].map(|i| self.centre[i] + off * s * self.axis[i]);
            filament.current = self.current * 0.125;
        }
        found
    }

    fn around(&self, p: [f64; 3]) -> Around {
        let d = difference(p, self.centre);
        let height = dot(d, self.axis);
        let off = [0, 1, 2].map(|k| d[k] - height * self.axis[k]);
        let rho = dot(off, off).sqrt();
        let away = if rho > 0.0 {
            off.map(|x| x / rho)
        } else {
            [0.0; 3]
        };
        Around { away, rho, height }
    }

    /// The place is moved out to the surface of the wire if it lies within; the second is how far
    /// from the core it was, as a part of the wire's radius (1 outside).
    fn outside(&self, rho: f64, height: f64) -> (f64, f64, f64) {
        let [x, z] = [rho - self.radius, height];
        let distance = x.hypot(z);
        if distance >= self.wire_radius {
            return (rho, height, 1.0);
        }
        if distance <= 1e-12 * self.wire_radius {
            return (self.radius, self.wire_radius, 0.0);
        }
        let stretch = self.wire_radius / distance;
        (
            self.radius + x * stretch,
            z * stretch,
            distance / self.wire_radius,
        )
    }

    /// Vector potential of 1 A \[V s/(m A)\] along the loop:
    /// `mu0 a / (pi beta) G(m)`, `beta^2 = (a + rho)^2 + z^2`, `m = 4 a rho / beta^2`
    /// (Jackson 1998, eq. 5.37, with its integral G).
    #[must_use]
    pub fn potential(&self, p: [f64; 3]) -> [f64; 3] {
        let at = self.around(p);
        let (rho, z, _) = self.outside(at.rho, at.height);
        let (beta, m, complement) = self.parameter(rho, z);
        let (g, _) = loop_integral(m, complement);
        let along = cross(self.axis, at.away);
        let size = MU0 * self.radius / (std::f64::consts::PI * beta) * g;
        along.map(|x| x * size)
    }

    /// Flux density of 1 A \[T/A\]: `B_rho = -dA/dz`, `B_z = A/rho + dA/drho`.
    #[must_use]
    pub fn flux(&self, p: [f64; 3]) -> [f64; 3] {
        let at = self.around(p);
        let (rho, z, share) = self.outside(at.rho, at.height);
        let (beta, m, complement) = self.parameter(rho, z);
        let (g, slope) = loop_integral(m, complement);
        let a = self.radius;
        let size = share * MU0 * a / (std::f64::consts::PI * beta);
        let outward = size * z / (beta * beta) * (g + 2.0 * slope);
        // dm/drho = m (1/rho - 2 (a + rho)/beta^2); m/rho = 4 a / beta^2 on the axis too.
        let over_rho = |x: f64| {
            if m > 0.0 {
                x / m * (4.0 * a / (beta * beta))
            } else {
                0.25 * std::f64::consts::FRAC_PI_2 * 0.5 * (4.0 * a / (beta * beta))
            }
        };
        let along =
            size * (over_rho(g) + over_rho(slope) - (a + rho) / (beta * beta) * (g + 2.0 * slope));
        [0, 1, 2].map(|k| outward * at.away[k] + along * self.axis[k])
    }

    /// `beta`, `m` and `1 - m` (without cancellation near the wire).
    fn parameter(&self, rho: f64, z: f64) -> (f64, f64, f64) {
        let far = (self.radius + rho).powi(2) + z * z;
        let near = (self.radius - rho).powi(2) + z * z;
        (far.sqrt(), 4.0 * self.radius * rho / far, near / far)
    }

    /// Places along the loop with the tangent times the length that each stands for \[m\].
    #[must_use]
    pub fn pieces(&self, count: usize) -> Vec<([f64; 3], [f64; 3])> {
        let [u, v] = frame(self.axis);
        let length = 2.0 * std::f64::consts::PI * self.radius / count as f64;
        (0..count)
            .map(|k| {
                let angle = 2.0 * std::f64::consts::PI * (k as f64 + 0.5) / count as f64;
                let (s, c) = angle.sin_cos();
                let place = [0, 1, 2].map(|i| self.centre[i] + self.radius * (c * u[i] + s * v[i]));
                let along = [0, 1, 2].map(|i| length * (c * v[i] - s * u[i]));
                (place, along)
            })
            .collect()
    }
}

/// Two unit vectors that make a right-handed frame with `axis`.
fn frame(axis: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).fold(0, |m, k| if axis[k].abs() < axis[m].abs() { k } else { m });
    let mut other = [0.0; 3];
    other[least] = 1.0;
    let along = dot(other, axis);
    let off = [0, 1, 2].map(|k| other[k] - along * axis[k]);
    let size = dot(off, off).sqrt();
    let u = off.map(|x| x / size);
    [u, cross(axis, u)]
}
