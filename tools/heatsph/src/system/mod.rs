//! The equations of all points: capacity times rate of temperature equals heat.
//!
//! ```text
//! C_i dT_i/dt = sum_j a_ij k_ij (T_j - T_i) + heat of its patches + Q V_i = W_i
//! ```
//!
//! Where rho c depends on temperature the left side is that of the heat itself, `dE_i(T_i)/dt`.

pub mod conduction;
mod matrix;
mod rates;
pub mod storage;

pub use rates::Rates;

use run::property::OutOfRange;

use crate::boundary::{Condition, Film, Passed, Surface};
use crate::cloud::Cloud;
use crate::material::{Law, Materials, arguments};
use crate::operator::Links;
use crate::source::Source;
use crate::torches::Torches;
use conduction::Conduction;
use shapes::frame::Vector;
use storage::Storage;

/// A body ready to conduct.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// Points.
    pub cloud: Cloud,
    /// Links.
    pub links: Links,
    /// Materials.
    pub materials: Materials,
    /// Surface.
    pub surface: Surface,
    /// What each point's cell holds.
    pub storage: Storage,
    /// Material of each point.
    pub material: Vec<u32>,
    /// Heat source.
    pub source: Option<Source>,
    /// Torches, where there are any.
    pub torches: Option<Torches>,
    /// What the scene asks for that the points do not show.
    pub doubts: Vec<String>,
    conduction: Conduction,
    /// First film of each point.
    films: Vec<u32>,
    /// Whether a point's temperature is prescribed.
    held: Vec<bool>,
    /// Whether anything depends on time itself.
    varies: bool,
    /// Difference of temperature below which conductivities are equal \[K\].
    blur: f64,
}

impl System {
    /// Puts a system together.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn new(
        cloud: Cloud,
        links: Links,
        materials: Materials,
        surface: Surface,
        storage: Storage,
        source: Option<Source>,
    ) -> Result<Self, OutOfRange> {
        let conduction = Conduction::new(&materials, &cloud.position, &links)?;
        let material = cloud
            .position
            .iter()
            .map(|x| materials.at(*x) as u32)
            .collect();
        let mut films = vec![0];
        let mut rest = surface.films.as_slice();
        for i in 0..links.len() {
            let own = rest.partition_point(|film| film.point as usize <= i);
            rest = &rest[own..];
            films.push(films[i] + own as u32);
        }
        let mut held = vec![false; links.len()];
        surface
            .held
            .iter()
            .for_each(|h| held[h.point as usize] = true);
        let varies =
            surface.varies() || source.as_ref().is_some_and(|source| source.depends_on("t"));
        let blurs = materials.conductors.iter().map(|c| c.blur());
        Ok(Self {
            varies,
            blur: blurs.fold(f64::MAX, f64::min),
            cloud,
            links,
            materials,
            surface,
            storage,
            material,
            source,
            torches: None,
            doubts: Vec::new(),
            conduction,
            films,
            held,
        })
    }

    /// Whether a source or a torch brings heat.
    #[must_use]
    pub fn has_source(&self) -> bool {
        self.source.is_some() || self.torches.is_some()
    }

    /// Whether something may take heat out whatever the temperature: a source or a flux that is not a positive number.
    #[must_use]
    pub fn takes(&self) -> bool {
        let flux = |condition: &Condition| match condition {
            Condition::Flux(flux) => flux.curve.constant().is_none_or(|value| value < 0.0),
            _ => false,
        };
        self.source.is_some() || self.surface.conditions.iter().any(flux)
    }

    /// The system with torches.
    #[must_use]
    pub fn under(mut self, torches: Option<Torches>) -> Self {
        self.varies |= torches.is_some();
        self.torches = torches;
        self
    }

    /// The system with doubts.
    #[must_use]
    pub fn doubted(mut self, doubts: Vec<String>) -> Self {
        self.doubts = doubts;
        self
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.links.len()
    }

    /// True without points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// Whether the temperature of point `i` is prescribed.
    #[must_use]
    pub fn is_held(&self, i: usize) -> bool {
        self.held[i]
    }

    /// Whether heat is linear in the temperatures and the matrix symmetric.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        let radiates =
            |c: &crate::boundary::Condition| matches!(c, crate::boundary::Condition::Radiation(..));
        self.conduction.is_fixed()
            && self.storage.varies().is_none()
            && self.source.is_none()
            && self.torches.is_none()
            && !self.surface.conditions.iter().any(radiates)
    }

    /// Whether anything depends on time itself.
    #[must_use]
    pub fn varies(&self) -> bool {
        self.varies
    }

    /// How links conduct.
    #[must_use]
    pub fn conduction(&self) -> &Conduction {
        &self.conduction
    }

    /// Gives the held points their temperatures at `time`.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn hold(&self, temperature: &mut [f64], time: f64) -> Result<(), OutOfRange> {
        for held in &self.surface.held {
            let i = held.point as usize;
            temperature[i] = self
                .surface
                .prescribed(*held, self.cloud.position[i], time)?;
        }
        Ok(())
    }

    /// Conductivity at a point \[W/(m K)\].
    #[must_use]
    pub fn conductivity(&self, i: usize, temperature: f64) -> f64 {
        let (material, x) = (self.material[i] as usize, self.cloud.position[i]);
        self.materials
            .conductivity(material, x, temperature)
            .unwrap_or(f64::NAN)
    }

    /// Mean conductivity at a point between two temperatures \[W/(m K)\].
    #[must_use]
    pub fn mean_conductivity(&self, i: usize, a: f64, b: f64) -> f64 {
        if self.conduction.is_fixed() || (b - a).abs() <= 1e-6 * (a.abs() + b.abs()) + self.blur {
            return self.conductivity(i, 0.5 * (a + b));
        }
        let (material, x) = (self.material[i] as usize, self.cloud.position[i]);
        match self.materials.law(material) {
            Law::Sum(parts) => parts
                .iter()
                .map(|part| {
                    let conductor = &self.materials.conductors[part.conductor];
                    let rise =
                        conductor.value_and_integral(b).1 - conductor.value_and_integral(a).1;
                    part.fraction
                        .value(&arguments(x, 0.0, 0.0))
                        .unwrap_or(f64::NAN)
                        * rise
                        / (b - a)
                })
                .sum(),
            Law::Formula(_) => {
                let at = |s: f64| self.conductivity(i, a + s * (b - a));
                (at(0.0) + 4.0 * at(0.5) + at(1.0)) / 6.0
            }
        }
    }

    /// Makes the tables of conductivity and heat span all temperatures; tells whether they did not.
    ///
    /// # Errors
    /// Where a property has no value.
    pub fn reach(&mut self, temperature: &[f64]) -> Result<bool, OutOfRange> {
        let (low, high) = extent(temperature);
        let mut grown = false;
        for conductor in &mut self.materials.conductors {
            let (from, to) = conductor.span();
            if low < from || high > to {
                conductor.widen(low.min(from), high.max(to))?;
                grown = true;
            }
        }
        if let Storage::Varies(content) = &mut self.storage {
            grown |= content.widen(low, high)?;
        }
        Ok(grown)
    }

    /// The greatest step of the explicit Euler method at which every new temperature is a mean of old ones \[s\]:
    /// it is stable, bounded and monotone. Where capacities depend on temperature, each point has the least between its
    /// own temperature and those of its neighbours.
    #[must_use]
    pub fn explicit_limit(&self, rates: &Rates) -> f64 {
        let capacity = match &self.storage {
            Storage::Fixed(capacity) => capacity,
            Storage::Varies(_) => &rates.capacity,
        };
        let each = capacity.iter().zip(&rates.stiffness).zip(&self.held);
        each.filter(|(_, held)| !**held)
            .map(|((c, s), _)| if *s > 0.0 { c / s } else { f64::INFINITY })
            .fold(f64::INFINITY, f64::min)
    }

    /// Heat that would be stored above 0 K with the capacities of now \[J\].
    #[must_use]
    pub fn stored(&self, temperature: &[f64]) -> f64 {
        let each = temperature.iter().enumerate();
        each.map(|(i, t)| self.storage.capacity(i, *t) * t).sum()
    }

    /// The difference of temperature that fluxes at the surface make over a spacing \[K\].
    #[must_use]
    pub fn skin(&self, temperature: &[f64], rates: &Rates) -> f64 {
        let of = |(film, passed): (&Film, &Passed)| {
            let i = film.point as usize;
            let k = self.conductivity(i, temperature[i]);
            (passed.heat / film.area).abs() * self.cloud.spacing[i] / k
        };
        self.surface
            .films
            .iter()
            .zip(&rates.passed)
            .map(of)
            .fold(0.0, f64::max)
    }

    /// Where a point is \[m\].
    #[must_use]
    pub fn place(&self, i: usize) -> Vector {
        self.cloud.position[i]
    }

    /// Number and place of a point, as messages name it.
    #[must_use]
    pub fn spot(&self, i: usize) -> String {
        let [x, y, z] = self.place(i);
        format!("point {i} at ({x:.4e}, {y:.4e}, {z:.4e}) m")
    }
}

/// Least and greatest value.
#[must_use]
pub fn extent(values: &[f64]) -> (f64, f64) {
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(*v), high.max(*v))
        })
}
