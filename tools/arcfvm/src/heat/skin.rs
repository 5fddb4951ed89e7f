//! The surface of an electrode, where it emits, shines and evaporates.
//!
//! Half a cell of metal lies between the middle of its cell and the surface, with the resistance `R`. The surface
//! takes up `q(T_s)` by electrons, ions, radiation and vapour, and from the gas what the way between both
//! middles conducts; it stores nothing:
//!
//! ```text
//! (T_s - T_c) / R = (T_g - T_s) / R_g + q(T_s).
//! ```
//!
//! With `G = 1 / (R + R_g)` and the share `w = 1 - R G` of what a surface takes up that goes on into the metal,
//!
//! ```text
//! T_s = T_c + R (G (T_g - T_c) + w q(T_s)):
//! ```
//!
//! the metal takes up `G (T_g - T_c) + w q`, the gas loses `G (T_g - T_c) - (1 - w) q`. As q falls with the
//! temperature there is one such surface. Its slopes with both middles are
//! `dT_s/dT_c = w / (1 - R w q')` and `dT_s/dT_g = (1 - w) / (1 - R w q')`. With `R = 0` the electrode answers at the
//! middle of its cell, as in Komen (2019), eqs 5.16 to 5.21, which name no other temperature of the metal.
//!
//! A wire that is fed to its tip and melts off there leaves with the enthalpy of the cell at the tip, `rho v (h - h_0) = q`
//! on any cells: that cell is as warm as the surface, and there too `R = 0`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::grid::FaceIndex;
use crate::heat::{Contact, Surfaces};

/// Newton steps that are enough, halvings among them.
const STEPS: usize = 100;
/// Least temperature of a surface \[K\].
const LEAST_K: f64 = 1.0;
/// Part of its temperature to which a surface is found.
const ROUNDING: f64 = 1e-13;

/// Temperature of the metal at which electrodes emit, shine and evaporate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ElectrodeAt {
    /// That of the surface, found from its balance with half a cell of metal; the edge of a film within the first cell
    /// of gas is as warm as what reaches it.
    #[default]
    Surface,
    /// That of the middle of the cell at the surface, as in Komen (2019): what comes out follows the cells.
    Centre,
}

/// The surface of one contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Skin {
    /// Its face.
    pub face: FaceIndex,
    /// Temperature at which the electrode answers \[K\].
    pub temperature: f64,
    /// Resistance between it and the middle of the metal's cell \[m2 K/W\].
    pub resistance: f64,
    /// Part of what it takes up that goes on into the metal.
    pub share: f64,
    /// Temperature of the gas at the edge of a film that ends before the middle of the first cell \[K\].
    pub edge: Option<f64>,
}

impl Skin {
    /// The surface of contact `n` among `skins`, if there are any; else the middle of its metal's cell.
    #[must_use]
    pub fn of(skins: &[Self], n: usize, contact: &Contact, temperature: &[f64]) -> Self {
        let centre = || Self::centre(contact.face, temperature[contact.metal]);
        skins.get(n).copied().unwrap_or_else(centre)
    }

    /// All surfaces, those of `known` faces as they were and new ones as warm as their metal; none where electrodes
    /// answer at the middles of their cells.
    #[must_use]
    pub fn all(surfaces: Option<&Surfaces>, known: &[Self], temperature: &[f64]) -> Vec<Self> {
        let of = surfaces.filter(|s| s.at == ElectrodeAt::Surface);
        let contacts = of.iter().flat_map(|s| &s.contacts);
        let laid = contacts.map(|contact| {
            let before = known.iter().find(|skin| skin.face == contact.face);
            let new = || Self::centre(contact.face, temperature[contact.metal]);
            before.copied().unwrap_or_else(new)
        });
        laid.collect()
    }

    /// The middle of the metal's cell, at `t` \[K\].
    #[must_use]
    pub fn centre(face: FaceIndex, t: f64) -> Self {
        Self {
            face,
            temperature: t,
            resistance: 0.0,
            share: 1.0,
            edge: None,
        }
    }

    /// Slopes of the heat into the metal with the temperature of its cell, and of that into the gas with the
    /// temperature of the gas \[W/(m2 K)\], `slope` being that of the heat of the surface, never positive.
    #[must_use]
    pub fn slopes(&self, slope: f64) -> [f64; 2] {
        let answer = slope / (1.0 - self.resistance * self.share * slope);
        [self.share, 1.0 - self.share].map(|part| part * part * answer)
    }

    /// Finds the temperature between a metal at `metal` and a gas at `gas` \[K\] with the conductance `through`
    /// between both \[W/(m2 K)\]; `heat` gives q and its slope at a temperature of the surface.
    pub fn settle(&mut self, [metal, gas]: [f64; 2], through: f64, heat: impl Fn(f64) -> [f64; 2]) {
        self.share = (1.0 - self.resistance * through).max(0.0);
        let rest = metal + self.resistance * through * (gas - metal);
        let weight = self.resistance * self.share;
        self.temperature = root(self.temperature.max(LEAST_K), |t| {
            let [q, slope] = heat(t);
            [t - rest - weight * q, 1.0 - weight * slope.min(0.0)]
        });
    }
}

/// Zero of a function that rises by 1 or more; `of` gives value and slope.
fn root(first: f64, of: impl Fn(f64) -> [f64; 2]) -> f64 {
    let mut t = first;
    let (mut low, mut high) = (LEAST_K, f64::INFINITY);
    let mut step = f64::INFINITY;
    for _ in 0..STEPS {
        let [value, slope] = of(t);
        // A slope of 1 or more brackets the zero.
        if value > 0.0 {
            (low, high) = (low.max(t - value), high.min(t));
        } else {
            (low, high) = (low.max(t), high.min(t - value));
        }
        let newton = t - value / slope;
        // Where emission grows by powers of e, Newton creeps down its slope.
        let fast = (newton - t).abs() <= 0.5 * step;
        let next = if fast && (low..=high).contains(&newton) {
            newton
        } else {
            0.5 * (low + high)
        };
        step = (next - t).abs();
        if step <= ROUNDING * t {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    fn skin(resistance: f64) -> Skin {
        Skin {
            resistance,
            ..Skin::centre(FaceIndex::Axial(0), 400.0)
        }
    }

    #[test]
    fn a_surface_that_shines_is_as_warm_as_its_balance_says() {
        // 1500 K at the surface, sigma T^4 and 3e6 W/m2 from gas at 9000 K by G between both middles.
        let (sigma, r, r_g) = (5.67e-8, 2e-4, 4e-3);
        let shine = |t: f64| [5e6 - sigma * t.powi(4), -4.0 * sigma * t.powi(3)];
        let into = (9000.0 - 1500.0) / r_g + shine(1500.0)[0];
        let mut found = skin(r);
        found.settle([1500.0 - r * into, 9000.0], 1.0 / (r + r_g), shine);
        assert!((found.temperature - 1500.0).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn a_steep_law_is_found_from_anywhere() {
        // Emission that grows by e every 10 K.
        let law = |t: f64| {
            let q = -1e7 * ((t - 3000.0) / 10.0).exp();
            [1e8 + q, q / 10.0]
        };
        let at = |first: f64| {
            let mut found = skin(1e-5);
            found.temperature = first;
            found.settle([2500.0, 8000.0], 2e4, law);
            found.temperature
        };
        let one = at(2500.0);
        for first in [1.0, 300.0, 3100.0, 9000.0] {
            assert!(
                (at(first) / one - 1.0).abs() < 1e-12,
                "{first}: {}",
                at(first)
            );
        }
        let rest = 2500.0 + 0.2 * 5500.0 + 0.8e-5 * law(one)[0];
        assert!((one / rest - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_slopes_are_those_of_what_both_sides_take_up() {
        let law = |t: f64| [-3e-5 * t.powi(4), -12e-5 * t.powi(3)];
        let (r, through) = (3e-4, 900.0);
        let into = |metal: f64, gas: f64| {
            let mut found = skin(r);
            found.settle([metal, gas], through, law);
            (found, law(found.temperature)[0])
        };
        let (found, _) = into(700.0, 2000.0);
        let [metal, gas] = found.slopes(law(found.temperature)[1]);
        let by = |a: (Skin, f64), b: (Skin, f64)| (a.1 - b.1) / 0.02;
        let want = found.share * by(into(700.01, 2000.0), into(699.99, 2000.0));
        assert!((metal / want - 1.0).abs() < 1e-6, "{metal} {want}");
        let want = (1.0 - found.share) * by(into(700.0, 2000.01), into(700.0, 1999.99));
        assert!((gas / want - 1.0).abs() < 1e-6, "{gas} {want}");
    }

    #[test]
    fn without_resistance_the_middle_of_the_cell_answers() {
        let mut found = skin(0.0);
        found.settle([812.5, 9000.0], 1e5, |_| [1e9, -1e7]);
        assert_eq!(found.temperature.to_bits(), 812.5_f64.to_bits());
        assert_eq!(
            found.slopes(-7.3).map(f64::to_bits),
            [-7.3_f64, -0.0].map(f64::to_bits)
        );
    }
}
