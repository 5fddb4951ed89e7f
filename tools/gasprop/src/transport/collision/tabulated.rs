//! Pairs with tables of their own: Wright et al. (2005), AIAA J. 43, 2558; Wright et al. (2007), AIAA J. 45, 281, and
//! what the data file names beside.
//!
//! A table gives `Q^(1,1)` and `Q^(2,2)` over temperature, some also
//! `B* = (5 Q^(1,2) - 4 Q^(1,3)) / Q^(1,1)` and `C* = Q^(1,2) / Q^(1,1)`. Between its points ln Q is a cubic spline in
//! ln T. Beyond its ends ln Q goes on as a straight line: a power law, as forces of one power of distance have it
//! (`Q ~ T^(-2/m)` for r^-m: -1/2 for the polarisation that slow ions feel, about -1/6 to -1/4 for the wall that fast
//! neutrals meet); B* and C* are held.
//!
//! What is not given follows from `Q^(l,s+1) = Q^(l,s) (1 + p/(s+2))`, `p = d ln Q^(l,s) / d ln T` (Hirschfelder,
//! Curtiss and Bird 1954), with p kept from one order to the next: the second derivatives of tables of three digits
//! mean nothing.

use std::f64::consts::PI;

use serde::Deserialize;
use serde_json::Value;

use super::spline::{Local, Spline};
use super::{Integrals, next_order};

/// A pair with tables of its own.
#[derive(Debug, Clone)]
pub(super) struct Tabulated {
    first: Area,
    second: Area,
    b_star: Option<Ratio>,
    c_star: Option<Ratio>,
}

/// An integral over temperature, as ln(Q/m2) over ln(T/K).
#[derive(Debug, Clone)]
enum Area {
    Spline(Spline),
    /// Cubic in ln T, the highest power first.
    Polynomial([f64; 4]),
}

/// A ratio of integrals over ln(T/K).
#[derive(Debug, Clone)]
enum Ratio {
    Constant(f64),
    Spline(Spline),
}

/// What the file holds for one quantity.
#[derive(Deserialize)]
#[serde(untagged)]
enum Entry {
    Constant {
        constant: f64,
    },
    Polynomial {
        coeffs: [f64; 4],
    },
    Table {
        #[serde(rename = "T_K")]
        temperature: Vec<f64>,
        value: Vec<f64>,
        times_pi: bool,
    },
}

impl Tabulated {
    /// Reads one entry of `collision_integrals.pairs`; None where it is not as expected. `polarising`: one particle is
    /// an ion and the other neutral.
    pub(super) fn read(entry: &Value, polarising: bool) -> Option<Self> {
        let ratio = |key: &str| match entry.get(key) {
            Some(value) => Ratio::read(value).map(Some),
            None => Some(None),
        };
        Some(Self {
            first: Area::read(&entry["Q11"], polarising)?,
            second: Area::read(&entry["Q22"], polarising)?,
            b_star: ratio("Bst")?,
            c_star: ratio("Cst")?,
        })
    }

    /// Integrals [m2] at `temperature` [K].
    pub(super) fn at(&self, temperature: f64) -> Integrals {
        let x = temperature.ln();
        let (q11, p11) = self.first.at(x);
        let power = |value| Local {
            value,
            slope: 0.0,
            curvature: 0.0,
        };
        let c = self
            .c_star
            .as_ref()
            .map_or_else(|| power(1.0 + p11 / 3.0), |ratio| ratio.at(x));
        let b = self
            .b_star
            .as_ref()
            .map_or_else(|| power(c.value * (1.0 - p11)), |ratio| ratio.at(x));
        let q12 = c.value * q11;
        let quarter = 5.0 * c.value - b.value;
        let q13 = 0.25 * quarter * q11;
        let p13 = p11 + (5.0 * c.slope - b.slope) / quarter;
        let q14 = next_order(q13, p13, 3);
        let (q22, p22) = self.second.at(x);
        let q23 = next_order(q22, p22, 2);
        Integrals {
            first: [q11, q12, q13, q14, next_order(q14, p13, 4)],
            second: [q22, q23, next_order(q23, p22, 3)],
        }
    }
}

impl Area {
    fn read(entry: &Value, polarising: bool) -> Option<Self> {
        match Entry::deserialize(entry).ok()? {
            Entry::Constant { .. } => None,
            Entry::Polynomial { mut coeffs } => {
                // The file gives A2. For ions it holds Langevin's law as 424.443 Z sqrt(a/T), which the exact average
                // over the r^-4 field shows to be Q/pi (the neutral pairs' polynomials fit Q itself).
                coeffs[3] += 1e-20f64.ln() + if polarising { PI.ln() } else { 0.0 };
                Some(Self::Polynomial(coeffs))
            }
            Entry::Table {
                temperature,
                value,
                times_pi,
            } => {
                let unit = 1e-20 * if times_pi { PI } else { 1.0 };
                let x = temperature.iter().map(|t| t.ln()).collect();
                let y = value.iter().map(|q| (q * unit).ln()).collect();
                Spline::new(x, y, [None, None]).map(Self::Spline)
            }
        }
    }

    /// Integral [m2] and its power of temperature.
    fn at(&self, x: f64) -> (f64, f64) {
        match self {
            Self::Spline(spline) => {
                let local = spline.at(x);
                (local.value.exp(), local.slope)
            }
            Self::Polynomial([a, b, c, d]) => (
                (((a * x + b) * x + c) * x + d).exp(),
                (3.0 * a * x + 2.0 * b) * x + c,
            ),
        }
    }
}

impl Ratio {
    fn read(entry: &Value) -> Option<Self> {
        match Entry::deserialize(entry).ok()? {
            Entry::Constant { constant } => Some(Self::Constant(constant)),
            Entry::Polynomial { .. } => None,
            // Ratios have no unit; where the file marks them as times pi, that is a fault of the file: the values
            // keep the recursion as they are.
            Entry::Table {
                temperature, value, ..
            } => {
                let x = temperature.iter().map(|t| t.ln()).collect();
                Spline::new(x, value, [None, None]).map(Self::Spline)
            }
        }
    }

    fn at(&self, x: f64) -> Local {
        match self {
            Self::Constant(value) => Local {
                value: *value,
                slope: 0.0,
                curvature: 0.0,
            },
            Self::Spline(spline) => spline.held(x),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::testing;

    fn read(one: &str, two: &str) -> Tabulated {
        let data = testing::data();
        let pairs = data["collision_integrals"]["pairs"].as_array().unwrap();
        let entry = pairs
            .iter()
            .find(|e| e["pair"][0] == one && e["pair"][1] == two)
            .unwrap();
        Tabulated::read(entry, one.ends_with('+') != two.ends_with('+')).unwrap()
    }

    #[test]
    fn points_are_met_and_ends_are_power_laws() {
        let argon = read("Ar", "Ar");
        assert!((argon.at(5000.0).first[0] / (6.16e-20 * PI) - 1.0).abs() < 1e-12);
        assert!((argon.at(300.0).second[0] / (12.88e-20 * PI) - 1.0).abs() < 1e-12);
        let hot = |t: f64| argon.at(t).second[0];
        assert!(
            (hot(24_000.0) * hot(30_000.0) / hot(24_000.0 * 1.25f64.sqrt()).powi(2) - 1.0).abs()
                < 1e-12
        );
        assert!(hot(30_000.0) < hot(20_000.0) && hot(30_000.0) > 0.8 * hot(20_000.0));
    }

    #[test]
    fn ratios_of_a_power_law_are_exact() {
        // Q ~ T^-1/2: C* = 5/6, B* = 5/6 x 3/2 = 5/4.
        let ion = read("C+", "C2");
        let q = ion.at(1000.0).first;
        assert!((q[1] / q[0] - 5.0 / 6.0).abs() < 1e-6);
        assert!(((5.0 * q[1] - 4.0 * q[2]) / q[0] - 1.25).abs() < 1e-6);
        // Langevin with the 3.395 A3 that the coefficients hold, as in the test of the potential.
        let t = 1000.0;
        let kt = crate::constants::BOLTZMANN * t / crate::constants::ELECTRON_VOLT;
        let exact = PI * 0.7343 * (2.0 * 3.395 * 14.3996 / kt).sqrt() * 1e-20;
        assert!((q[0] / exact - 1.0).abs() < 2e-3);
    }

    #[test]
    fn given_ratios_are_used_and_agree_with_the_recursion() {
        let carbon = read("e-", "C");
        let q = carbon.at(5000.0).first;
        assert!((q[1] / q[0] - 0.79).abs() < 1e-12);
        let recursive = 1.0
            + (carbon.at(5050.0).first[0] / carbon.at(4950.0).first[0]).ln()
                / (5050f64 / 4950.0).ln()
                / 3.0;
        assert!((q[1] / q[0] - recursive).abs() < 0.03);
        assert!(q.windows(2).all(|w| w[1] > 0.0));
    }
}
