//! Steady conduction through a plate whose conductivity is `A exp(B x + a T)`.
//!
//! The flux `-k dT/dx` is the same everywhere, so that `exp(a T)` is linear in
//! `theta = (1 - exp(-B s)) / (1 - exp(-B L))`, s measured from the first face:
//!
//! `T = T1 + ln(1 + (exp(a (T2 - T1)) - 1) theta) / a`
//!
//! It is Rong and Kisu (2010), eq. 6 (with the T1 that is lost in print), where a = 0, and eq. 7
//! where B = 0.

use super::property::Exponential;

/// Below this the exponent is its own value to double precision.
const SMALL: f64 = 1e-9;

/// A plate with both faces held.
#[derive(Debug, Clone, Copy)]
pub struct Plate {
    /// k.
    pub conductivity: Exponential,
    /// x of the faces \[m\].
    pub faces: [f64; 2],
    /// Their temperatures \[K\].
    pub held: [f64; 2],
}

impl Plate {
    /// theta, from 0 at the first face to 1 at the second.
    fn theta(&self, x: f64) -> f64 {
        let [from, to] = self.faces;
        let b = self.conductivity.along_x;
        if (b * (to - from)).abs() < SMALL {
            return (x - from) / (to - from);
        }
        (-b * (x - from)).exp_m1() / (-b * (to - from)).exp_m1()
    }

    /// The temperature at x \[K\].
    #[must_use]
    pub fn temperature(&self, x: f64) -> f64 {
        let [cold, hot] = self.held;
        let a = self.conductivity.with_temperature;
        let theta = self.theta(x);
        if (a * (hot - cold)).abs() < SMALL {
            return cold + (hot - cold) * theta;
        }
        cold + ((a * (hot - cold)).exp_m1() * theta).ln_1p() / a
    }

    /// The heat flux along x \[W/m2\].
    #[must_use]
    pub fn flux(&self) -> f64 {
        let [from, to] = self.faces;
        let [cold, hot] = self.held;
        let k = self.conductivity;
        let (a, b) = (k.with_temperature, k.along_x);
        let drop = if (a * (hot - cold)).abs() < SMALL {
            hot - cold
        } else {
            (a * (hot - cold)).exp_m1() / a
        };
        let length = if (b * (to - from)).abs() < SMALL {
            to - from
        } else {
            -(-b * (to - from)).exp_m1() / b
        };
        -k.value(from, cold) * drop / length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plate(b: f64, a: f64) -> Plate {
        Plate {
            conductivity: Exponential {
                scale: 3.0,
                along_x: b,
                with_temperature: a,
            },
            faces: [0.2, 1.7],
            held: [0.4, -0.9],
        }
    }

    #[test]
    fn it_is_the_papers_equations() {
        let paper = Plate {
            faces: [0.0, 1.0],
            held: [0.0, 1.0],
            ..plate(0.5, 0.0)
        };
        let six = ((-0.15_f64).exp() - 1.0) / ((-0.5_f64).exp() - 1.0);
        assert!((paper.temperature(0.3) - six).abs() < 1e-14);
        let paper = Plate {
            faces: [0.0, 1.0],
            held: [0.0, 1.0],
            ..plate(0.0, 4.0)
        };
        let seven = ((4.0_f64.exp() - 1.0) * 0.3 + 1.0).ln() / 4.0;
        assert!((paper.temperature(0.3) - seven).abs() < 1e-14);
    }

    #[test]
    fn the_flux_is_the_same_everywhere() {
        for (b, a) in [(0.5, 0.0), (-2.0, 1.3), (0.0, -3.0), (0.0, 8.0), (0.0, 0.0)] {
            let plate = plate(b, a);
            for x in [0.2001, 0.5, 1.1, 1.5] {
                let h = 1e-5;
                let slope = (plate.temperature(x + h) - plate.temperature(x - h)) / (2.0 * h);
                let here = -plate.conductivity.value(x, plate.temperature(x)) * slope;
                let miss = (here / plate.flux() - 1.0).abs();
                assert!(miss < 1e-6, "B {b}, a {a}, x {x}: {miss:e}");
            }
            assert!((plate.temperature(0.2) - 0.4).abs() < 1e-13);
            assert!((plate.temperature(1.7) + 0.9).abs() < 1e-13);
        }
    }

    #[test]
    fn a_small_exponent_meets_the_limit() {
        for small in [1e-6, 1e-8, 1e-10, 0.0] {
            let (found, limit) = (plate(small, small), plate(0.0, 0.0));
            assert!((found.temperature(0.9) - limit.temperature(0.9)).abs() < 2e-6);
            assert!((found.flux() / limit.flux() - 1.0).abs() < 2e-6);
        }
        // Across the threshold nothing jumps.
        let jump = plate(0.7e-9, 0.7e-9).temperature(0.9) - plate(0.6e-9, 0.8e-9).temperature(0.9);
        assert!(jump.abs() < 1e-9);
    }
}
