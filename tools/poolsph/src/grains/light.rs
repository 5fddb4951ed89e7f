//! Light of an arc on the wall of its cavity, and what the wall gives off.
//!
//! ```text
//! q dA = eps P g dA / integral of g dA,  g = cos(theta) / R^2      from a place at the distance R, theta from the wall's normal
//! q dA = -eps sigma (T^4 - T_0^4) dA                                                          (Komen 2019, eq. 5.33)
//! ```
//!
//! P is what falls on the wall; what the arc sends to the base metal is another part of it. The wall is divided into pieces, each borne by the grain that is nearest behind it (`pressure`), which takes what falls on
//! the piece and gives off what a piece of its temperature does. Pieces that none bears, such as the foot on the metal and the
//! place of the wire, have no part in it. What is not taken up, 1 - eps, is not followed; it is told, and so is what falls where
//! no grain is at all.

use run::Fault;
use run::property::{Arguments, Curve, OutOfRange, Property};
use schemars::JsonSchema;
use serde::Deserialize;
use shapes::frame::{Vector, difference, dot};
use shapes::surface::Piece;
use steps::Figure;

use super::pressure::Pressed;
use crate::mean;

/// Stefan and Boltzmann's constant \[W/(m2 K4)\].
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// Light on a wall.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LightScene {
    /// Power P of the light that falls on the wall, a number or a formula in t.
    #[schemars(extend("x-unit" = "W"))]
    pub power_w: Property,
    /// Place from which the light comes at the start; it moves with the wall.
    #[schemars(extend("x-unit" = "m"))]
    pub from_m: [f64; 3],
    /// eps of the grains.
    #[schemars(range(min = 0.0, max = 1.0), extend("x-unit" = "1"))]
    pub emissivity: f64,
    /// T_0 of the surroundings to which the wall radiates.
    #[schemars(range(min = 0.0, max = 1e4), extend("x-unit" = "K"))]
    pub surroundings_k: f64,
}

impl LightScene {
    /// Ready for use; `at` is its JSON pointer.
    ///
    /// # Errors
    /// A formula that cannot be read.
    pub(super) fn light(&self, at: &str) -> Result<Light, Fault> {
        Ok(Light {
            power: self.power_w.compile(&format!("{at}/power_w"), &["t"])?,
            from: self.from_m,
            emissivity: self.emissivity,
            surroundings: self.surroundings_k,
        })
    }
}

/// Light on a wall, ready.
#[derive(Debug, Clone)]
pub(super) struct Light {
    power: Curve,
    from: Vector,
    emissivity: f64,
    surroundings: f64,
}

impl Light {
    /// g dA of a piece.
    fn sees(&self, piece: &Piece) -> f64 {
        let way = difference(piece.place, self.from);
        let square = dot(way, way);
        // A piece that faces away is in its own shade.
        dot(way, piece.normal).max(0.0) * piece.area / (square * square.sqrt())
    }
}

/// A grain in the light.
#[derive(Debug, Clone, Copy)]
struct Lit {
    row: u32,
    /// Heat taken up \[W\].
    taken: f64,
    /// eps sigma dA \[W/K4\], and T_0^4 \[K4\].
    shines: f64,
    around: f64,
}

/// Grains in the light, and what has become of it \[J\].
#[derive(Debug, Clone, Default)]
pub(super) struct Lighting {
    /// Whether a wall is in the light.
    there: bool,
    lit: Vec<Lit>,
    /// Light that falls on grains, and where there are none \[W\].
    falls: [f64; 2],
    /// Whether something of a light that varies in time may have been missed.
    pub(super) missed: bool,
    /// Taken up, given off, fallen where no grain is, and not taken up \[J\].
    pub(super) sums: [f64; 4],
}

impl Lighting {
    /// No light yet; `there` where a wall has any.
    pub(super) fn new(there: bool) -> Self {
        Self {
            there,
            ..Self::default()
        }
    }

    /// What a checkpoint keeps.
    pub(super) fn saved(&self) -> [f64; 5] {
        let [taken, given, through, left] = self.sums;
        [
            f64::from(u8::from(self.missed)),
            taken,
            given,
            through,
            left,
        ]
    }

    /// Takes it back.
    pub(super) fn take_back(&mut self, [missed, sums @ ..]: [f64; 5]) {
        (self.missed, self.sums) = (missed > 0.0, sums);
    }

    /// Finds what falls on whom from `time` on, in the mean over `dt` \[s\].
    pub(super) fn fall<'a>(
        &mut self,
        walls: impl Iterator<Item = (&'a Light, &'a Pressed)>,
        [time, dt]: [f64; 2],
    ) -> Result<(), OutOfRange> {
        self.lit.clear();
        self.falls = [0.0; 2];
        for (light, wall) in walls {
            let at = Arguments::at([0.0; 3], time);
            let (power, found) = mean::in_time(&light.power, &at, dt)?;
            self.missed |= !found;
            let borne = || {
                let pieces = wall.pieces();
                pieces.filter_map(|(piece, bearer)| bearer.map(|row| (piece, row)))
            };
            let all: f64 = borne().map(|(piece, _)| light.sees(piece)).sum();
            let falls = if all > 0.0 { power } else { 0.0 };
            self.falls[0] += falls;
            self.falls[1] += power - falls;
            for (piece, row) in borne() {
                let share = if all > 0.0 {
                    light.sees(piece) / all
                } else {
                    0.0
                };
                self.lit.push(Lit {
                    row,
                    taken: light.emissivity * falls * share,
                    shines: light.emissivity * STEFAN_BOLTZMANN * piece.area,
                    around: light.surroundings.powi(4),
                });
            }
        }
        // One entry for each grain, in the order of rows.
        self.lit.sort_by_key(|lit| lit.row);
        self.lit.dedup_by(|next, first| {
            let same = next.row == first.row;
            if same {
                first.taken += next.taken;
                first.shines += next.shines;
            }
            same
        });
        Ok(())
    }

    /// Rows of the grains in the light.
    pub(super) fn rows(&self) -> impl Iterator<Item = u32> {
        self.lit.iter().map(|lit| lit.row)
    }

    /// Greatest rate \[1/s\] at which the shine cools a grain of the heat capacity `capacity` \[J/K\].
    pub(super) fn fastest(&self, temperature: &[f64], capacity: impl Fn(usize) -> f64) -> f64 {
        let rate = |lit: &Lit| {
            let a = lit.row as usize;
            4.0 * lit.shines * temperature[a].powi(3) / capacity(a)
        };
        self.lit.iter().map(rate).fold(0.0, f64::max)
    }

    /// Adds the heat of the light to `rates` \[W\], for a step of `step` \[s\].
    pub(super) fn heat(&mut self, temperature: &[f64], rates: &mut [f64], step: f64) {
        let (mut taken, mut given) = (0.0, 0.0);
        for lit in &self.lit {
            let a = lit.row as usize;
            let shine = lit.shines * (temperature[a].powi(4) - lit.around);
            rates[a] += lit.taken - shine;
            taken += lit.taken;
            given += shine;
        }
        let [on, through] = self.falls;
        for (sum, rate) in self
            .sums
            .iter_mut()
            .zip([taken, given, through, on - taken])
        {
            *sum += step * rate;
        }
    }

    /// Sums over the run; none where there is no light.
    pub(super) fn figures(&self) -> Vec<Figure> {
        let names = [
            "grain_light_taken_j",
            "grain_light_given_j",
            "grain_light_lost_j",
            "grain_light_not_taken_j",
        ];
        let figure = |(name, value)| Figure {
            name,
            unit: "J",
            value,
        };
        let named = names.into_iter().zip(self.sums).filter(|_| self.there);
        named.map(figure).collect()
    }
}
