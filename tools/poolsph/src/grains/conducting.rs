//! Grains as contacts that conduct see them.

use contact::{Grain, Meeting, Normal, heat as conductance};
use particles::{POSITION, Set};
use run::property::OutOfRange;

use super::heat::{ENTHALPY, Heat, Radius, TEMPERATURE};
use super::parameters::Law;
use super::{MASS, RADIUS};

/// Grains as what they touch sees them.
pub(super) struct Conducting<'a> {
    heat: &'a Heat,
    places: &'a [[f64; 3]],
    /// r \[m\].
    pub(super) radii: &'a [f64],
    masses: &'a [f64],
    enthalpies: &'a [f64],
    /// T \[K\].
    pub(super) temperature: &'a [f64],
}

impl<'a> Conducting<'a> {
    pub(super) fn of(heat: &'a Heat, set: &'a Set) -> Self {
        Self {
            heat,
            places: set.column(&POSITION),
            radii: set.column(&RADIUS),
            masses: set.column(&MASS),
            enthalpies: set.column(&ENTHALPY),
            temperature: set.column(&TEMPERATURE),
        }
    }

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
        let k = self.heat.caloric.conductivity(self.temperature[a]);
        let molten = self.heat.caloric.molten(self.enthalpies[a]);
        k * (1.0 + (self.heat.slag - 1.0) * molten)
    }

    /// k of the gas at `t` \[K\], if it conducts \[W/(m K)\].
    pub(super) fn gas(&self, t: f64) -> Result<Option<f64>, OutOfRange> {
        let gas = self.heat.gas.as_ref();
        gas.map(|gas| gas.at_temperature(t)).transpose()
    }

    /// Push of a contact whose overlap stands still \[N\].
    pub(super) fn push(&self, meeting: &Meeting) -> f64 {
        match &self.heat.law {
            Law::Linear(law) => law.push(&still(meeting)),
            Law::Hertz(law) => law.push(&still(meeting)),
        }
    }

    /// H of a contact \[W/K\] of a grain of `radius` \[m\].
    pub(super) fn of_contact(
        &self,
        meeting: &Meeting,
        radius: f64,
        k: [f64; 2],
        gas: Option<f64>,
    ) -> f64 {
        let wide = 2.0 * meeting.radius;
        let arm = meeting.arms[0];
        let by_overlap = (radius * radius - arm * arm).max(0.0).sqrt();
        let (r_c, solid) = match self.heat.radius {
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
        self.heat.radius
    }
}

/// A contact whose overlap stands still.
fn still(meeting: &Meeting) -> Meeting {
    Meeting {
        approach: 0.0,
        ..*meeting
    }
}
