//! Heat through the surface.
//!
//! Each patch of surface has the conditions of the scene's entries that name its face. The heat into the body is
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

mod compile;

use run::property::{Arguments, Curve, OutOfRange};

use shapes::frame::Vector;

pub use compile::compile;

/// Constant of Stefan and Boltzmann \[W/(m2 K4)\] (exact in the SI of 2019).
pub const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Iterations for the temperature of a radiating surface.
const NEWTON: usize = 40;

/// What happens on a face.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// Temperature \[K\].
    Temperature(Curve),
    /// Heat flux into the body \[W/m2\].
    Flux(Curve),
    /// Coefficient \[W/(m2 K)\] and temperature of the surroundings \[K\].
    Convection(Curve, Curve),
    /// Emissivity and temperature of the surroundings \[K\].
    Radiation(Curve, Curve),
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
    /// Conditions, one per entry of the scene.
    pub conditions: Vec<Condition>,
    /// Names of the entries.
    pub names: Vec<String>,
    /// Patches with a condition, in the order of their points.
    pub films: Vec<Film>,
    /// Points of prescribed temperature, in rising order.
    pub held: Vec<Held>,
    /// Area of each entry \[m2\].
    pub area: Vec<f64>,
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
            Condition::Temperature(curve) | Condition::Flux(curve) => curve.depends_on("t"),
            Condition::Convection(a, b) | Condition::Radiation(a, b) => {
                a.depends_on("t") || b.depends_on("t")
            }
        })
    }

    /// A range of temperature \[K\] widened by that of constant surroundings.
    #[must_use]
    pub fn extent(&self, (mut low, mut high): (f64, f64)) -> (f64, f64) {
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
        let mut sum = Balance::default();
        for entry in &film.entries {
            match &self.conditions[*entry as usize] {
                Condition::Temperature(curve) => {
                    let surface = curve.kelvin(&Arguments::at(film.above, time))?;
                    let across = film.area * conductivity(temperature, surface) / film.depth;
                    return Ok(Passed {
                        heat: across * (surface - temperature),
                        slope: -film.area * conductivity(temperature, temperature) / film.depth,
                        temperature: surface,
                    });
                }
                Condition::Flux(curve) => sum.flux += curve.value(&at)?,
                Condition::Convection(coefficient, ambient) => {
                    let h = coefficient.value(&at)?;
                    sum.coefficient += h;
                    sum.ambient += h * ambient.kelvin(&at)?;
                }
                Condition::Radiation(emissivity, surroundings) => {
                    let e = STEFAN_BOLTZMANN * emissivity.value(&at)?;
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
            });
        }
        let across = conductivity(temperature, temperature) / film.depth;
        let surface = skin(&sum, across, temperature);
        let (q, slope) = sum.flux(surface);
        Ok(Passed {
            heat: film.area * q,
            slope: film.area * slope * across / (across - slope),
            temperature: surface,
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
            Condition::Flux(curve) => film.area * curve.value(&at)?,
            Condition::Convection(coefficient, ambient) => {
                film.area * coefficient.value(&at)? * (ambient.kelvin(&at)? - t)
            }
            Condition::Radiation(emissivity, surroundings) => {
                let difference = surroundings.kelvin(&at)?.powi(4) - t.powi(4);
                film.area * STEFAN_BOLTZMANN * emissivity.value(&at)? * difference
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
mod tests {
    use super::*;

    fn film(depth: f64, entries: Vec<u32>) -> Film {
        Film {
            point: 0,
            depth,
            area: 2.0,
            place: [0.0; 3],
            above: [0.0; 3],
            entries,
        }
    }

    fn surface(conditions: Vec<Condition>) -> Surface {
        Surface {
            conditions,
            ..Surface::default()
        }
    }

    fn number(value: f64) -> Curve {
        Curve::Constant(value)
    }

    #[test]
    fn conditions_add_on_a_surface() {
        let all = surface(vec![
            Condition::Flux(number(10.0)),
            Condition::Convection(number(3.0), number(400.0)),
            Condition::Radiation(number(0.5), number(1000.0)),
        ]);
        let film = film(0.0, vec![0, 1, 2]);
        let passed = all.pass(&film, 300.0, 0.0, |_, _| 1.0).unwrap();
        let radiant = 0.5 * STEFAN_BOLTZMANN * (1e12 - 300.0_f64.powi(4));
        let exact = 2.0 * (10.0 + 300.0 + radiant);
        assert!((passed.heat - exact).abs() < 1e-9 * exact);
        let sum: f64 = (0..3)
            .map(|e| all.part(&film, e, passed, 0.0).unwrap())
            .sum();
        assert!((sum - exact).abs() < 1e-9 * exact);
    }

    #[test]
    fn a_deep_point_and_its_surface_are_resistances_in_series() {
        let robin = surface(vec![Condition::Convection(number(4.0), number(100.0))]);
        let passed = robin
            .pass(&film(0.5, vec![0]), 0.0, 0.0, |_, _| 2.0)
            .unwrap();
        // 1/h + d/k = 1/4 + 1/4.
        assert!((passed.heat - 2.0 * 100.0 / 0.5).abs() < 1e-12);
        assert!((passed.slope + 2.0 / 0.5).abs() < 1e-12);
        assert!((passed.temperature - 50.0).abs() < 1e-12);
        let held = surface(vec![Condition::Temperature(number(100.0))]);
        let passed = held
            .pass(&film(0.5, vec![0]), 0.0, 0.0, |_, _| 2.0)
            .unwrap();
        assert!((passed.heat - 800.0).abs() < 1e-12);
    }

    #[test]
    fn a_radiating_surface_finds_its_temperature() {
        let hot = surface(vec![Condition::Radiation(number(1.0), number(3000.0))]);
        for (t, k) in [(300.0, 1e-3), (300.0, 1e4), (4000.0, 1.0)] {
            let passed = hot.pass(&film(0.01, vec![0]), t, 0.0, |_, _| k).unwrap();
            let through = 2.0 * k / 0.01 * (passed.temperature - t);
            assert!(
                (through - passed.heat).abs() < 1e-9 * passed.heat.abs(),
                "{t} {k}: {passed:?}"
            );
            let step = 1e-3 * t;
            let near = |t: f64| {
                hot.pass(&film(0.01, vec![0]), t, 0.0, |_, _| k)
                    .unwrap()
                    .heat
            };
            let slope = (near(t + step) - near(t - step)) / (2.0 * step);
            assert!((slope - passed.slope).abs() < 1e-3 * slope.abs());
        }
    }
}
