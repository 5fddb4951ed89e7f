//! Grains as contacts that conduct see them.

use std::sync::Arc;

use contact::{Grain, Meeting, Normal, heat as conductance};
use particles::{POSITION, Set};
use run::property::{Curve, OutOfRange};

use super::columns::{POWDER, SLAG, STATE};
use super::law::Law;
use super::{MASS, RADIUS};
use crate::heat::Caloric;

/// How the radius of a contact is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Radius {
    /// From the push, by the effective modulus \[Pa\].
    Force(f64),
    /// From the overlap; `printed` takes half of the conductance.
    Overlap { printed: bool },
}

/// What makes grains conduct.
pub(super) struct Conductor {
    pub(super) caloric: Arc<Caloric>,
    /// Push of a contact.
    pub(super) law: Law,
    pub(super) radius: Radius,
    /// k of the gas \[W/(m K)\].
    pub(super) gas: Option<Curve>,
    /// k of slag over that of powder.
    pub(super) slag: f64,
    /// Slag wets what it touches.
    pub(super) wets: bool,
}

impl Conductor {
    /// Grains of `set` with their enthalpies \[J/kg\] and temperatures \[K\].
    pub(super) fn sees<'a>(
        &'a self,
        set: &'a Set,
        [enthalpies, temperature]: [&'a [f64]; 2],
    ) -> Conducting<'a> {
        Conducting {
            conductor: self,
            places: set.column(&POSITION),
            radii: set.column(&RADIUS),
            masses: set.column(&MASS),
            enthalpies,
            temperature,
            states: self.wets.then(|| set.column(&STATE)),
        }
    }
}

/// Grains as what they touch sees them.
pub(super) struct Conducting<'a> {
    conductor: &'a Conductor,
    places: &'a [[f64; 3]],
    /// r \[m\].
    pub(super) radii: &'a [f64],
    masses: &'a [f64],
    enthalpies: &'a [f64],
    /// T \[K\].
    pub(super) temperature: &'a [f64],
    /// What grains are, where slag wets what it touches.
    states: Option<&'a [u8]>,
}

impl Conducting<'_> {
    pub(super) fn grain(&self, a: usize) -> Grain {
        Grain {
            position: self.places[a],
            velocity: [0.0; 3],
            spin: [0.0; 3],
            radius: self.radii[a],
            mass: self.masses[a],
        }
    }

    /// k \[W/(m K)\]; what is molten of a grain conducts as slag does.
    pub(super) fn conductivity(&self, a: usize) -> f64 {
        let k = self.conductor.caloric.conductivity(self.temperature[a]);
        let molten = self.conductor.caloric.molten(self.enthalpies[a]);
        k * (1.0 + (self.conductor.slag - 1.0) * molten)
    }

    /// k of the gas at `t` \[K\], if it conducts \[W/(m K)\].
    pub(super) fn gas(&self, t: f64) -> Result<Option<f64>, OutOfRange> {
        let gas = self.conductor.gas.as_ref();
        gas.map(|gas| gas.at_temperature(t)).transpose()
    }

    /// Push of a contact whose overlap stands still \[N\].
    pub(super) fn push(&self, meeting: &Meeting) -> f64 {
        match &self.conductor.law {
            Law::Linear(law) => law.push(&still(meeting)),
            Law::Hertz(law) => law.push(&still(meeting)),
        }
    }

    /// Whether slag has spread in the contact of grains: one of both is molten, or both have been.
    pub(super) fn joined(&self, a: usize, b: usize) -> bool {
        self.states.is_some_and(|states| {
            let pair = [states[a], states[b]];
            pair.contains(&SLAG) || !pair.contains(&POWDER)
        })
    }

    /// Whether slag has spread on the metal that it touches.
    pub(super) fn spread(&self, a: usize) -> bool {
        self.states.is_some_and(|states| states[a] != POWDER)
    }

    /// H of the contact \[W/K\] of the grains a and b.
    ///
    /// Where slag has spread the contact is as wide as the grain, and a row of equal grains conducts as cells of their diameter do:
    /// `4 k k/(k + k) r = k d^2/d`.
    pub(super) fn of_contact(
        &self,
        meeting: &Meeting,
        [a, b]: [usize; 2],
        k: [f64; 2],
        gas: Option<f64>,
    ) -> f64 {
        let (radius, wide) = (self.radii[a], 2.0 * meeting.radius);
        if self.joined(a, b) {
            return conductance::constriction(k, wide);
        }
        let arm = meeting.arms[0];
        let by_overlap = (radius * radius - arm * arm).max(0.0).sqrt();
        let (r_c, solid) = match self.conductor.radius {
            Radius::Force(modulus) => {
                let push = self.push(meeting);
                let r_c = conductance::radius_by_force(push, meeting.radius, modulus);
                (r_c, conductance::constriction(k, r_c))
            }
            Radius::Overlap { printed: false } => {
                (by_overlap, conductance::constriction(k, by_overlap))
            }
            Radius::Overlap { printed: true } => (
                by_overlap,
                conductance::constriction_as_printed(k, by_overlap),
            ),
        };
        solid + gas.map_or(0.0, |k_g| conductance::gas(k_g, wide, r_c))
    }

    /// How the radius of a contact is found.
    pub(super) fn radius(&self) -> Radius {
        self.conductor.radius
    }
}

/// What was last asked for. Most grains of a bed have one temperature to the bit, and properties cost more than contacts.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Recent {
    /// Temperature and enthalpy of a grain, by bits, and its k; of both sides of a contact.
    grains: [Option<([u64; 2], f64)>; 2],
    /// Temperature of the gas by bits, and its k.
    gas: Option<(u64, Option<f64>)>,
}

impl Recent {
    /// [`Conducting::conductivity`] of the grains a and b.
    pub(super) fn conductivities(&mut self, grains: &Conducting<'_>, pair: [usize; 2]) -> [f64; 2] {
        let mut k = [0.0; 2];
        for ((k, last), a) in k.iter_mut().zip(&mut self.grains).zip(pair) {
            let now = [
                grains.temperature[a].to_bits(),
                grains.enthalpies[a].to_bits(),
            ];
            *k = match *last {
                Some((then, k)) if then == now => k,
                _ => grains.conductivity(a),
            };
            *last = Some((now, *k));
        }
        k
    }

    /// [`Conducting::gas`] at `t` \[K\].
    pub(super) fn gas(
        &mut self,
        grains: &Conducting<'_>,
        t: f64,
    ) -> Result<Option<f64>, OutOfRange> {
        let k = match self.gas {
            Some((then, k)) if then == t.to_bits() => k,
            _ => grains.gas(t)?,
        };
        self.gas = Some((t.to_bits(), k));
        Ok(k)
    }
}

/// A contact whose overlap stands still.
fn still(meeting: &Meeting) -> Meeting {
    Meeting {
        approach: 0.0,
        ..*meeting
    }
}
