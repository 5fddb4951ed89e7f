//! Heat through the surface.
//!
//! Each patch of surface has the conditions of the entries that name its face. The heat into the body is
//! (Rong and Kisu 2010, eq. 2, with the normal that the errata ask for)
//!
//! ```text
//! q = q0                                  Neumann
//! q = psi (T_s - T)                       Robin
//! q = eps sigma (T_s^4 - T^4)             radiation
//! ```
//!
//! at the temperature T of the surface. A point on the surface has that temperature; where the point lies at a
//! depth d, surface and point are d/k apart, and `k (T - T_i) / d = q(T)` gives the temperature of the surface.
//! No shape factor (zeta of eq. 5) is needed, on faces or on curves.

mod cover;
mod factor;
mod part;
pub mod setup;
pub(crate) mod shade;
mod tangent;

use run::property::{Arguments, Curve, OutOfRange};

use crate::source::cubature::{Piece, When, ends};
use part::Extent;
use shapes::frame::Vector;

/// Constant of Stefan and Boltzmann \[W/(m2 K4)\] (exact in the SI of 2019).
pub const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Iterations for the temperature of a radiating surface.
const NEWTON: usize = 40;

/// A heat flux into the body.
#[derive(Debug, Clone, PartialEq)]
pub struct Flux {
    /// \[W/m2\].
    pub curve: Curve,
    /// The box that holds its patches, where it depends on place \[m\].
    around: Option<[Vector; 2]>,
}

impl Flux {
    /// The flux of a curve, still of no place.
    #[must_use]
    pub fn new(curve: Curve) -> Self {
        Self {
            curve,
            around: None,
        }
    }

    /// Mean over a patch, however narrow the flux is \[W/m2\]; whether its peaks were resolved.
    ///
    /// # Errors
    /// Where the curve has no value.
    pub fn mean(&self, film: &Film, time: f64) -> Result<(f64, bool), OutOfRange> {
        let Some(around) = self.around else {
            let value = self.curve.value(&Arguments::at(film.place, time))?;
            return Ok((value, true));
        };
        let when = When::even(time, 0.0);
        let [from, to] = ends(around, time, [0.0; 2]);
        let greatest = self.curve.bounds(&from, &to).most();
        let mean = film.piece.mean(&self.curve, when, greatest)?;
        Ok((mean.above + mean.below, mean.resolved))
    }
}

/// What happens on a face.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// Temperature \[K\].
    Temperature(Curve),
    /// Heat flux into the body \[W/m2\].
    Flux(Flux),
    /// Coefficient \[W/(m2 K)\] and temperature of the surroundings \[K\].
    Convection(Curve, Curve),
    /// Emissivity and temperature of the surroundings \[K\].
    Radiation(Curve, Curve),
}

/// A condition, its name, and where it holds.
struct Entry {
    name: String,
    condition: Condition,
    extent: Extent,
}

/// A condition on a patch of surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// The point that owns the patch.
    pub point: u32,
    /// Depth of the point below the patch \[m\]; 0 on the surface.
    pub depth: f64,
    /// Area \[m2\]; length \[m\] in a plane scene.
    pub area: f64,
    /// Middle of the patch: where fluxes are evaluated \[m\].
    pub place: Vector,
    /// Place above the point: where temperatures are prescribed \[m\].
    pub above: Vector,
    /// The patch.
    pub piece: Piece,
    /// Numbers of the entries that hold here.
    pub entries: Vec<u32>,
}

/// A point whose temperature is prescribed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// The point.
    pub point: u32,
    /// Number of the entry.
    pub entry: u32,
}

/// All that happens at the surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surface {
    /// Conditions, one per entry.
    pub conditions: Vec<Condition>,
    /// Names of the entries.
    pub names: Vec<String>,
    /// Patches with a condition, in the order of their points.
    pub films: Vec<Film>,
    /// Points of prescribed temperature, in rising order.
    pub held: Vec<Held>,
    /// Area of each entry \[m2\].
    pub area: Vec<f64>,
    /// Area of the faces within the shape of each entry \[m2\]; held points stand for whole patches, and may hold another.
    pub asked: Vec<f64>,
    /// Greatest value of the factor of each entry at the start, beside which others are rounding; 0 of one without.
    pub usual: Vec<f64>,
}

/// Heat through a film.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Passed {
    /// Heat into the body \[W\].
    pub heat: f64,
    /// Its derivative by the temperature of the point \[W/K\]; never positive.
    pub slope: f64,
    /// Temperature of the surface \[K\].
    pub temperature: f64,
    /// Whether peaks of a flux were too narrow to be found.
    pub hidden: bool,
}

/// `q = constant - slope T - radiant T^4` of a patch, and the parts of each entry.
#[derive(Debug, Clone, Copy, Default)]
struct Balance {
    flux: f64,
    coefficient: f64,
    ambient: f64,
    radiant: f64,
    surroundings: f64,
}

impl Balance {
    fn flux(&self, t: f64) -> (f64, f64) {
        let q = self.flux
            + (self.ambient - self.coefficient * t)
            + (self.surroundings - self.radiant * t.powi(4));
        (q, -self.coefficient - 4.0 * self.radiant * t.powi(3))
    }
}

impl Surface {
    /// Whether nothing at all happens at the surface.
    #[must_use]
    pub fn is_insulated(&self) -> bool {
        self.films.is_empty() && self.held.is_empty()
    }

    /// Whether a condition depends on time.
    #[must_use]
    pub fn varies(&self) -> bool {
        self.conditions.iter().any(|condition| match condition {
            Condition::Temperature(curve) => curve.depends_on("t"),
            Condition::Flux(flux) => flux.curve.depends_on("t"),
            Condition::Convection(a, b) | Condition::Radiation(a, b) => {
                a.depends_on("t") || b.depends_on("t")
            }
        })
    }

    /// A range of temperature \[K\] widened by that of constant surroundings.
    #[must_use]
    pub fn extent(&self, range: (f64, f64)) -> (f64, f64) {
        let (mut low, mut high) = range;
        for condition in &self.conditions {
            let curve = match condition {
                Condition::Temperature(curve)
                | Condition::Convection(_, curve)
                | Condition::Radiation(_, curve) => curve.constant(),
                Condition::Flux(_) => None,
            };
            if let Some(value) = curve {
                (low, high) = (low.min(value), high.max(value));
            }
        }
        (low, high)
    }

    /// The prescribed temperature of a held point at `x` \[K\].
    ///
    /// # Errors
    /// Where the property has no value.
    pub fn prescribed(&self, held: Held, x: Vector, time: f64) -> Result<f64, OutOfRange> {
        match &self.conditions[held.entry as usize] {
            Condition::Temperature(curve) => curve.kelvin(&Arguments::at(x, time)),
            _ => Ok(f64::NAN),
        }
    }

    /// Heat through a film above a point of the given temperature, of conductivity `k(T_point, T_surface)`.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn pass(
        &self,
        film: &Film,
        temperature: f64,
        time: f64,
        conductivity: impl Fn(f64, f64) -> f64,
    ) -> Result<Passed, OutOfRange> {
        let at = Arguments::at(film.place, time);
        let (mut sum, mut hidden) = (Balance::default(), false);
        for entry in &film.entries {
            match &self.conditions[*entry as usize] {
                Condition::Temperature(curve) => {
                    let surface = curve.kelvin(&Arguments::at(film.above, time))?;
                    let across = film.area * conductivity(temperature, surface) / film.depth;
                    return Ok(Passed {
                        heat: across * (surface - temperature),
                        slope: -film.area * conductivity(temperature, temperature) / film.depth,
                        temperature: surface,
                        hidden: false,
                    });
                }
                Condition::Flux(flux) => {
                    let (mean, resolved) = flux.mean(film, time)?;
                    sum.flux += mean;
                    hidden |= !resolved;
                }
                Condition::Convection(_, ambient) => {
                    let h = self.factor(*entry, &at)?;
                    sum.coefficient += h;
                    sum.ambient += h * ambient.kelvin(&at)?;
                }
                Condition::Radiation(_, surroundings) => {
                    let e = STEFAN_BOLTZMANN * self.factor(*entry, &at)?;
                    sum.radiant += e;
                    sum.surroundings += e * surroundings.kelvin(&at)?.powi(4);
                }
            }
        }
        if film.depth <= 0.0 {
            let (q, slope) = sum.flux(temperature);
            return Ok(Passed {
                heat: film.area * q,
                slope: film.area * slope,
                temperature,
                hidden,
            });
        }
        let across = conductivity(temperature, temperature) / film.depth;
        let surface = skin(&sum, across, temperature);
        let (q, slope) = sum.flux(surface);
        Ok(Passed {
            heat: film.area * q,
            slope: film.area * slope * across / (across - slope),
            temperature: surface,
            hidden,
        })
    }

    /// The part of a film's heat that an entry brings, at the temperature of the surface \[W\].
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn part(
        &self,
        film: &Film,
        entry: u32,
        passed: Passed,
        time: f64,
    ) -> Result<f64, OutOfRange> {
        let at = Arguments::at(film.place, time);
        let t = passed.temperature;
        Ok(match &self.conditions[entry as usize] {
            Condition::Temperature(_) => passed.heat,
            Condition::Flux(flux) => film.area * flux.mean(film, time)?.0,
            Condition::Convection(_, ambient) => {
                film.area * self.factor(entry, &at)? * (ambient.kelvin(&at)? - t)
            }
            Condition::Radiation(_, surroundings) => {
                let difference = surroundings.kelvin(&at)?.powi(4) - t.powi(4);
                film.area * STEFAN_BOLTZMANN * self.factor(entry, &at)? * difference
            }
        })
    }
}

/// Temperature of a surface `across` \[W/(m2 K)\] away from a point: `across (T - T_i) = q(T)`.
fn skin(sum: &Balance, across: f64, temperature: f64) -> f64 {
    let linear = (across * temperature + sum.flux + sum.ambient) / (across + sum.coefficient);
    if sum.radiant <= 0.0 {
        return linear;
    }
    // The rest rises with T and is convex: from above, Newton's method falls onto the root.
    let far = (sum.surroundings / sum.radiant).powf(0.25);
    let mut t = temperature.max(far).max(linear);
    for _ in 0..NEWTON {
        let (q, slope) = sum.flux(t);
        let step = (across * (t - temperature) - q) / (across - slope);
        t -= step;
        if step.abs() < 1e-14 * t.abs() {
            break;
        }
    }
    t
}

#[cfg(test)]
mod tests;
