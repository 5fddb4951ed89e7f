//! Two half spaces of different temperatures brought together at time 0, in perfect contact or
//! across a resistance; and the share of a wall's heat that a finite slab of the same kind feels.
//!
//! With the effusivities `e = sqrt(k rho c)` perfect contact holds the interface at
//! `(ea Ta + eb Tb) / (ea + eb)` (Carslaw and Jaeger 1959, section 2.15). Across a resistance 1/H
//! Laplace's transformation gives the flux `H (Ta - Tb) exp(b^2 t) erfc(b sqrt t)`,
//! `b = H (1/ea + 1/eb)`, and each side cools as a half space with a medium beyond H (same work,
//! section 2.7).

use crate::special::{erfc, erfc_scaled};

/// One of the half spaces.
#[derive(Debug, Clone, Copy)]
pub struct Half {
    /// k \[W/(m K)\].
    pub conductivity: f64,
    /// rho c \[J/(m3 K)\].
    pub capacity: f64,
    /// At the start \[K\].
    pub temperature: f64,
}

impl Half {
    fn effusivity(&self) -> f64 {
        (self.conductivity * self.capacity).sqrt()
    }

    fn diffusivity(&self) -> f64 {
        self.conductivity / self.capacity
    }
}

/// Both, the first at x < `interface`.
#[derive(Debug, Clone, Copy)]
pub struct Slabs {
    /// Left and right.
    pub half: [Half; 2],
    /// x of the interface \[m\].
    pub interface: f64,
    /// Contact resistance \[m2 K/W\]; 0 for perfect contact.
    pub resistance: f64,
}

impl Slabs {
    /// Temperatures of both faces of the interface at `time` \[s\].
    #[must_use]
    pub fn faces(&self, time: f64) -> [f64; 2] {
        [self.side(0, 0.0, time), self.side(1, 0.0, time)]
    }

    /// Heat flux along x through the interface \[W/m2\].
    #[must_use]
    pub fn flux(&self, time: f64) -> f64 {
        let [a, b] = self.half;
        let drop = a.temperature - b.temperature;
        let inverse = 1.0 / a.effusivity() + 1.0 / b.effusivity();
        if self.resistance > 0.0 {
            let rate = inverse / self.resistance;
            return drop / self.resistance * erfc_scaled(rate * time.sqrt());
        }
        drop / (inverse * (std::f64::consts::PI * time).sqrt())
    }

    /// The temperature at x \[m\] and `time` \[s\]; at the interface itself the mean of both faces.
    #[must_use]
    pub fn temperature(&self, x: f64, time: f64) -> f64 {
        let distance = x - self.interface;
        if distance.abs() < 1e-12 {
            let [a, b] = self.faces(time);
            return 0.5 * (a + b);
        }
        self.side(usize::from(distance > 0.0), distance.abs(), time)
    }

    fn side(&self, side: usize, distance: f64, time: f64) -> f64 {
        let (own, other) = (self.half[side], self.half[1 - side]);
        let (e, f) = (own.effusivity(), other.effusivity());
        let drop = own.temperature - other.temperature;
        let depth = distance / (2.0 * (own.diffusivity() * time).sqrt());
        let mut part = erfc(depth);
        if self.resistance > 0.0 {
            let rate = (1.0 / e + 1.0 / f) / self.resistance;
            part -= (-depth * depth).exp() * erfc_scaled(rate * time.sqrt() + depth);
        }
        own.temperature - drop * f / (e + f) * part
    }

    /// The largest part of the heat that would have come as far as `distance` \[m\] from the
    /// interface on either side: the error of taking a slab for a half space.
    #[must_use]
    pub fn reach(&self, distance: [f64; 2], time: f64) -> f64 {
        let part = |side: usize| {
            erfc(distance[side] / (2.0 * (self.half[side].diffusivity() * time).sqrt()))
        };
        part(0).max(part(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slabs(resistance: f64) -> Slabs {
        Slabs {
            half: [
                Half {
                    conductivity: 40.0,
                    capacity: 3.0,
                    temperature: 500.0,
                },
                Half {
                    conductivity: 2.0,
                    capacity: 5.0,
                    temperature: 300.0,
                },
            ],
            interface: 0.3,
            resistance,
        }
    }

    /// -k dT/dx on each side of the interface, and rho c T_t - k T_xx away from it.
    fn equations(slabs: &Slabs, time: f64) -> ([f64; 2], [f64; 2]) {
        let mut flux = [0.0; 2];
        let mut rest = [0.0; 2];
        for side in 0..2 {
            let sign = if side == 0 { -1.0 } else { 1.0 };
            let k = slabs.half[side].conductivity;
            let h = 1e-4;
            let [t0, t1, t2] = [0.0, 1.0, 2.0].map(|i| slabs.side(side, i * h, time));
            flux[side] = -sign * k * (-3.0 * t0 + 4.0 * t1 - t2) / (2.0 * h);
            let (x, h) = (slabs.interface + 0.5 * sign, 1e-3);
            let at = |x: f64, t: f64| slabs.temperature(x, t);
            let rate = (at(x, time * 1.001) - at(x, time * 0.999)) / (0.002 * time);
            let bend = (at(x + h, time) - 2.0 * at(x, time) + at(x - h, time)) / (h * h);
            rest[side] = slabs.half[side].capacity * rate - k * bend;
        }
        (flux, rest)
    }

    #[test]
    fn both_contacts_keep_their_equations() {
        for resistance in [0.0, 0.05, 2.0] {
            let slabs = slabs(resistance);
            let time = 0.07;
            let (flux, rest) = equations(&slabs, time);
            let wanted = slabs.flux(time);
            let faces = slabs.faces(time);
            for side in 0..2 {
                assert!(
                    (flux[side] / wanted - 1.0).abs() < 1e-4,
                    "{flux:?} {wanted}"
                );
                assert!(rest[side].abs() < 1e-4 * 200.0 / time, "{rest:?}");
            }
            let jump = faces[0] - faces[1] - resistance * wanted;
            assert!(jump.abs() < 1e-9, "{jump:e}");
            assert!((slabs.temperature(-30.0, time) - 500.0).abs() < 1e-12);
            assert!((slabs.temperature(30.0, time) - 300.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_small_resistance_is_perfect_contact() {
        let (small, none) = (slabs(1e-7), slabs(0.0));
        assert!((small.flux(0.1) / none.flux(0.1) - 1.0).abs() < 1e-6);
        assert!((small.temperature(0.5, 0.1) - none.temperature(0.5, 0.1)).abs() < 1e-4);
    }
}
