//! Charged particles: the screened Coulomb potential.
//!
//! Mason, Munn and Smith (1967), Phys. Fluids 10, 1827, tables I and II, in the reduced temperature
//! `T* = lambda_D / b`, `b = |Z_i Z_j| e^2 / (4 pi eps0 k T)`. With `F^(l,s) = T*^2 Omega^(l,s)*`,
//!
//! ```text
//! Q^(l,s) = pi lambda_D^2 Omega^(l,s)* = pi b^2 F^(l,s)(T*)
//! ```
//!
//! and the recursion of Hirschfelder, Curtiss and Bird (1954) for the integrals at fixed length of
//! screening, `Q^(l,s+1) = Q^(l,s) + T/(s+2) dQ^(l,s)/dT`, becomes with `u = ln T*`
//!
//! ```text
//! F^(l,s+1) = (s F^(l,s) + dF^(l,s)/du) / (s + 2).
//! ```
//!
//! The length of screening is that of the electrons alone (heavy ions move too slowly to screen an electron).

use std::f64::consts::PI;

use serde::Deserialize;
use serde_json::Value;

use super::Integrals;
use super::spline::Spline;
use crate::constants::{BOLTZMANN, ELEMENTARY_CHARGE, PERMITTIVITY};

/// Tables of the reduced integrals for both signs of the force.
#[derive(Debug, Clone)]
pub(super) struct Screened {
    attraction: Sign,
    repulsion: Sign,
}

#[derive(Debug, Clone)]
struct Sign {
    /// `F^(1,1)`, `F^(1,2)`, `F^(1,3)` over u.
    first: [Spline; 3],
    /// `F^(2,2)` over u.
    second: Spline,
}

#[derive(Deserialize)]
struct Tables {
    #[serde(rename = "tableI")]
    integrals: TableI,
    #[serde(rename = "tableII")]
    ratios: TableII,
}

#[derive(Deserialize)]
struct TableI {
    #[serde(rename = "Tstar")]
    t: Vec<f64>,
    #[serde(rename = "Omega11_t2_attraction")]
    f11_attraction: Vec<f64>,
    #[serde(rename = "Omega11_t2_repulsion")]
    f11_repulsion: Vec<f64>,
    #[serde(rename = "Omega22_t2_attraction")]
    f22_attraction: Vec<f64>,
    #[serde(rename = "Omega22_t2_repulsion")]
    f22_repulsion: Vec<f64>,
}

#[derive(Deserialize)]
struct TableII {
    #[serde(rename = "Bstar_attraction")]
    b_attraction: Vec<f64>,
    #[serde(rename = "Bstar_repulsion")]
    b_repulsion: Vec<f64>,
    #[serde(rename = "Cstar_attraction")]
    c_attraction: Vec<f64>,
    #[serde(rename = "Cstar_repulsion")]
    c_repulsion: Vec<f64>,
}

impl Screened {
    /// Reads the block `screened_coulomb`; None where it is not as expected.
    pub(super) fn read(block: &Value) -> Option<Self> {
        let tables = Tables::deserialize(block).ok()?;
        let u: Vec<f64> = tables.integrals.t.iter().map(|t| t.ln()).collect();
        let (i, r) = (&tables.integrals, &tables.ratios);
        Some(Self {
            attraction: Sign::new(
                &u,
                [&i.f11_attraction, &r.b_attraction, &r.c_attraction],
                &i.f22_attraction,
            )?,
            repulsion: Sign::new(
                &u,
                [&i.f11_repulsion, &r.b_repulsion, &r.c_repulsion],
                &i.f22_repulsion,
            )?,
        })
    }

    /// Integrals [m2] of charges `z1`, `z2` (in elementary charges) at `temperature` [K] with `electrons` [1/m3].
    pub(super) fn at(&self, z1: i32, z2: i32, temperature: f64, electrons: f64) -> Integrals {
        let charges = f64::from(z1) * f64::from(z2);
        let thermal = BOLTZMANN * temperature;
        let b = charges.abs() * ELEMENTARY_CHARGE.powi(2) / (4.0 * PI * PERMITTIVITY * thermal);
        // In logarithms, so that traces of electrons far below the square root of the smallest number do no harm.
        let screening = 0.5
            * ((PERMITTIVITY * thermal / ELEMENTARY_CHARGE.powi(2)).ln()
                - electrons.max(f64::MIN_POSITIVE).ln());
        let sign = if charges < 0.0 {
            &self.attraction
        } else {
            &self.repulsion
        };
        sign.at(screening - b.ln()).scaled(PI * b * b)
    }
}

impl Sign {
    fn new(u: &[f64], [f11, b, c]: [&Vec<f64>; 3], f22: &[f64]) -> Option<Self> {
        if [f11.len(), b.len(), c.len(), f22.len()]
            .iter()
            .any(|&n| n != u.len())
        {
            return None;
        }
        let f12 = (0..u.len()).map(|i| c[i] * f11[i]).collect();
        let f13 = (0..u.len())
            .map(|i| (5.0 * c[i] - b[i]) / 4.0 * f11[i])
            .collect();
        // Weak screening: F^(1,1) and F^(2,2) rise as ln(T*)/2, and by the recursion the others as ln(T*)/6, /12.
        let spline = |f: Vec<f64>, slope| Spline::new(u.to_vec(), f, [None, Some(slope)]);
        Some(Self {
            first: [
                spline(f11.clone(), 0.5)?,
                spline(f12, 1.0 / 6.0)?,
                spline(f13, 1.0 / 12.0)?,
            ],
            second: spline(f22.to_vec(), 0.5)?,
        })
    }

    /// `F^(l,s)` at `u = ln T*`. Above the table the logarithm goes on; below it (where a plasma is no longer ideal) all
    /// integrals fall with the last power law of `F^(1,1)`, which keeps their ratios.
    fn at(&self, u: f64) -> Integrals {
        let start = self.first[0].first();
        let inside = u.max(start);
        let f = self.first.each_ref().map(|spline| spline.at(inside));
        let f14 = (3.0 * f[2].value + f[2].slope) / 5.0;
        let f14_slope = (3.0 * f[2].slope + f[2].curvature) / 5.0;
        let f22 = self.second.at(inside);
        let f23 = (2.0 * f22.value + f22.slope) / 4.0;
        let f23_slope = (2.0 * f22.slope + f22.curvature) / 4.0;
        let integrals = Integrals {
            first: [
                f[0].value,
                f[1].value,
                f[2].value,
                f14,
                (4.0 * f14 + f14_slope) / 6.0,
            ],
            second: [f22.value, f23, (3.0 * f23 + f23_slope) / 5.0],
        };
        integrals.scaled((f[0].slope / f[0].value * (u - inside)).exp())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::testing;

    #[test]
    fn the_tables_keep_the_recursion() {
        let screened = Screened::read(&testing::data()["screened_coulomb"]).unwrap();
        for sign in [&screened.attraction, &screened.repulsion] {
            for u in [0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 7.0, 10.0, 15.0] {
                let f = sign.first[0].at(u);
                let second = sign.first[1].at(u);
                assert!(
                    ((f.value + f.slope) / 3.0 / second.value - 1.0).abs() < 6e-3,
                    "F12 at {u}"
                );
                let third = sign.first[2].at(u);
                let expected = (2.0 * second.value + second.slope) / 4.0;
                assert!((expected / third.value - 1.0).abs() < 1e-2, "F13 at {u}");
            }
        }
    }

    #[test]
    fn weak_screening_is_the_coulomb_logarithm() {
        // Liboff (1959), Phys. Fluids 2, 40: F^(1,1) = (ln(4 T*) - 2 gamma_E - 1/2)/2 for weak screening, of either sign;
        // the table is 0.005 above it, less than 0.1 % of the integral.
        let screened = Screened::read(&testing::data()["screened_coulomb"]).unwrap();
        let gamma = 0.577_215_664_901_532_9;
        for u in [15.0, 30.0, 300.0] {
            let f = screened.attraction.at(u);
            let expected = 0.5 * (u + 4f64.ln() - 2.0 * gamma - 0.5);
            assert!(
                (f.first[0] - expected).abs() < 6e-3,
                "{} {expected}",
                f.first[0]
            );
            // Pure Coulomb ratios of neighbours at leading order.
            assert!((f.first[4] / f.first[3] - 2.0 / 3.0).abs() < 1.0 / u);
            assert!((f.second[2] / f.second[1] - 3.0 / 5.0).abs() < 1.0 / u);
        }
    }

    #[test]
    fn integrals_stay_positive_and_fall_with_temperature() {
        let screened = Screened::read(&testing::data()["screened_coulomb"]).unwrap();
        for (z1, z2) in [(-1, 1), (1, 1), (3, 3), (-1, 3)] {
            let mut before = f64::INFINITY;
            for i in 0..100 {
                let q = screened.at(z1, z2, 300.0 * 1.05f64.powi(i), 1e22);
                assert!(q.first.iter().chain(&q.second).all(|&q| q > 0.0));
                if i > 60 {
                    assert!(q.first[0] < before);
                }
                before = q.first[0];
            }
            let trace = screened.at(z1, z2, 300.0, 1e-300);
            assert!(trace.first[4].is_finite() && trace.first[4] > 0.0);
        }
    }
}
