//! Collision integrals: how strongly each pair of species hinders each other's flight.
//!
//! `Q^(l,s)` [m2] is the mean cross-section `pi sigma^2 Omega^(l,s)*` of Hirschfelder, Curtiss and Bird (1954): the
//! average of the cross-section for the loss of cos^l of the angle over a Maxwellian weighted with energy to the power
//! s + 1, with hard spheres of diameter sigma at `pi sigma^2` for every l and s.
//!
//! Each pair takes the best that there is, in this order:
//!
//! 1. charged with charged: the screened Coulomb potential (`screened.rs`);
//! 2. electron with argon: moments of the measured cross-section (`electron.rs`);
//! 3. electron with iron, and other neutrals without data: a constant cross-section of [`Uncertain`];
//! 4. argon with its own ion: moments of what drifting ions and beams have told (`resonant.rs`);
//! 5. tables of the pair (`tabulated.rs`), which for carbon and oxygen with their own ions hold the exchange of an
//!    electron;
//! 6. the phenomenological potential (`potential.rs`), with the exchange of an electron between iron and its ion
//!    (`exchange.rs`).

mod electron;
mod exchange;
mod moments;
mod particle;
mod potential;
mod resonant;
mod screened;
mod spline;
mod tabulated;

use serde_json::Value;

use super::{TransportError, Uncertain};
use crate::mixture::Kind;
use electron::CrossSection;
use exchange::Exchange;
pub(crate) use particle::Particle;
use potential::{Fits, Potential};
use resonant::Resonant;
use screened::Screened;
use tabulated::Tabulated;

/// Orders of the first kind, s = 1 to 5.
pub(crate) const FIRST_ORDERS: usize = 5;
/// No integral falls faster with temperature than this power, whatever noise a table holds.
const STEEPEST: f64 = -2.0;

/// Collision integrals of one pair [m2].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Integrals {
    /// `Q^(1,1)` to `Q^(1,5)`.
    pub(crate) first: [f64; FIRST_ORDERS],
    /// `Q^(2,2)` to `Q^(2,4)`.
    pub(crate) second: [f64; 3],
}

impl Integrals {
    /// The same for all orders: hard spheres of this `pi sigma^2` [m2].
    pub(crate) fn hard(area: f64) -> Self {
        Self {
            first: [area; FIRST_ORDERS],
            second: [area; 3],
        }
    }

    /// `A* = Q^(2,2) / Q^(1,1)`.
    pub(crate) fn a_star(&self) -> f64 {
        self.second[0] / self.first[0]
    }

    /// `B* = (5 Q^(1,2) - 4 Q^(1,3)) / Q^(1,1)`.
    pub(crate) fn b_star(&self) -> f64 {
        (5.0 * self.first[1] - 4.0 * self.first[2]) / self.first[0]
    }

    fn scaled(self, factor: f64) -> Self {
        Self {
            first: self.first.map(|q| q * factor),
            second: self.second.map(|q| q * factor),
        }
    }
}

/// `Q^(l,s+1)` from `Q^(l,s)` and its power `p` of temperature.
fn next_order(q: f64, p: f64, s: u32) -> f64 {
    q * (1.0 + p.max(STEEPEST) / (f64::from(s) + 2.0))
}

/// How one pair collides.
#[derive(Debug, Clone)]
enum Encounter {
    Coulomb(i32, i32),
    CrossSection(Box<CrossSection>),
    Constant(f64),
    Resonant(Box<Resonant>),
    Tabulated(Box<Tabulated>),
    Potential(Box<Potential>),
    Exchange(Box<Potential>, Exchange),
}

/// The collisions of all pairs of a mixture.
#[derive(Debug, Clone)]
pub(crate) struct Collisions {
    /// Pairs (i, j) with j <= i, row by row.
    encounters: Vec<Encounter>,
    screened: Screened,
}

/// The integrals of all pairs at one state.
#[derive(Debug, Clone)]
pub(crate) struct Pairs {
    /// As in [`Collisions`].
    integrals: Vec<Integrals>,
}

impl Pairs {
    /// Integrals of every pair of `size` species.
    pub(crate) fn from_fn(size: usize, pair: impl Fn(usize, usize) -> Integrals) -> Self {
        let integrals = (0..size).flat_map(|i| (0..=i).map(move |j| (i, j)));
        Self {
            integrals: integrals.map(|(i, j)| pair(i, j)).collect(),
        }
    }

    /// Integrals of the pair (i, j) in any order.
    pub(crate) fn get(&self, i: usize, j: usize) -> &Integrals {
        &self.integrals[place(i, j)]
    }
}

fn place(i: usize, j: usize) -> usize {
    let (high, low) = (i.max(j), i.min(j));
    high * (high + 1) / 2 + low
}

impl Collisions {
    /// The collisions of `particles`, from the blocks of the data file.
    pub(crate) fn new(
        data: &Value,
        particles: &[Particle],
        uncertain: &Uncertain,
    ) -> Result<Self, TransportError> {
        let screened = Screened::read(&data["screened_coulomb"])
            .ok_or(TransportError::Block("screened_coulomb"))?;
        let sources = Sources {
            fits: Fits::read(&data["phenomenological_potential"])
                .ok_or(TransportError::Block("phenomenological_potential"))?,
            argon: CrossSection::read(&data["e_Ar_momentum_transfer"])
                .ok_or(TransportError::Block("e_Ar_momentum_transfer"))?,
            argon_ion: &data["Ar_Ar+_momentum_transfer"],
            tables: data["collision_integrals"]["pairs"]
                .as_array()
                .ok_or(TransportError::Block("collision_integrals"))?,
            uncertain,
        };
        let mut encounters = Vec::with_capacity(particles.len() * (particles.len() + 1) / 2);
        for (i, one) in particles.iter().enumerate() {
            for two in &particles[..=i] {
                encounters.push(sources.encounter(one, two)?);
            }
        }
        Ok(Self {
            encounters,
            screened,
        })
    }

    /// All integrals at `temperature` [K] with `electrons` [1/m3].
    pub(crate) fn at(&self, temperature: f64, electrons: f64) -> Pairs {
        let integrals = self.encounters.iter().map(|encounter| match encounter {
            Encounter::Coulomb(z1, z2) => self.screened.at(*z1, *z2, temperature, electrons),
            Encounter::CrossSection(measured) => measured.moments(temperature),
            Encounter::Constant(area) => Integrals::hard(*area),
            Encounter::Resonant(resonant) => resonant.at(temperature),
            Encounter::Tabulated(table) => table.at(temperature),
            Encounter::Potential(potential) => potential.at(temperature),
            Encounter::Exchange(potential, exchange) => {
                let mut q = potential.at(temperature);
                for (elastic, exchanged) in q.first.iter_mut().zip(exchange.at(temperature)) {
                    *elastic = elastic.hypot(exchanged);
                }
                q
            }
        });
        Pairs {
            integrals: integrals.collect(),
        }
    }
}

/// What the encounters are made from.
struct Sources<'a> {
    fits: Fits,
    argon: CrossSection,
    argon_ion: &'a Value,
    tables: &'a [Value],
    uncertain: &'a Uncertain,
}

impl Sources<'_> {
    fn encounter(&self, one: &Particle, two: &Particle) -> Result<Encounter, TransportError> {
        if one.charge != 0 && two.charge != 0 {
            return Ok(Encounter::Coulomb(one.charge, two.charge));
        }
        if one.is_electron() || two.is_electron() {
            let neutral = if one.is_electron() { two } else { one };
            if neutral.name == "Ar" {
                return Ok(Encounter::CrossSection(Box::new(self.argon.clone())));
            }
            if neutral.has_iron {
                return Ok(Encounter::Constant(self.uncertain.electron_iron_m2));
            }
            return Ok(match self.table(one, two)? {
                Some(table) => Encounter::Tabulated(Box::new(table)),
                None => Encounter::Constant(self.uncertain.electron_other_m2),
            });
        }
        if let Some(table) = self.table(one, two)? {
            let names = [one.name.as_str(), two.name.as_str()];
            if names.contains(&"Ar") && names.contains(&"Ar+") {
                return Resonant::read(self.argon_ion, table)
                    .map(|resonant| Encounter::Resonant(Box::new(resonant)))
                    .ok_or(TransportError::Block("Ar_Ar+_momentum_transfer"));
            }
            return Ok(Encounter::Tabulated(Box::new(table)));
        }
        let potential = Box::new(Potential::new(&self.fits, one, two));
        let (atom, ion) = if one.charge == 0 {
            (one, two)
        } else {
            (two, one)
        };
        let own_ion =
            atom.kind == Kind::Atom && ion.charge == 1 && ion.name == format!("{}+", atom.name);
        if !own_ion {
            return Ok(Encounter::Potential(potential));
        }
        let reduced_mass = one.mass * two.mass / (one.mass + two.mass);
        let factor = if atom.has_iron {
            self.uncertain.iron_exchange_factor
        } else {
            1.0
        };
        let exchange = Exchange::empirical(atom.ionisation(ion), reduced_mass, factor);
        Ok(Encounter::Exchange(potential, exchange))
    }

    /// The table of this pair, if there is one.
    fn table(&self, one: &Particle, two: &Particle) -> Result<Option<Tabulated>, TransportError> {
        let names = (one.name.as_str(), two.name.as_str());
        let found = self.tables.iter().find(|entry| {
            let name = |i: usize| entry["pair"][i].as_str().unwrap_or_default();
            (name(0), name(1)) == names || (name(1), name(0)) == names
        });
        let Some(entry) = found else {
            return Ok(None);
        };
        let polarising =
            !one.is_electron() && !two.is_electron() && (one.charge != 0) != (two.charge != 0);
        let table = Tabulated::read(entry, polarising)
            .ok_or_else(|| TransportError::Pair(one.name.clone(), two.name.clone()))?;
        Ok(Some(table))
    }
}
