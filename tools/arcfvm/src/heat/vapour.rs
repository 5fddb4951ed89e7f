//! Heat that vapour takes off metal and into the gas (Komen 2019, the last term of eqs 5.16 and 5.19).
//!
//! Metal that evaporates gives off the latent heat, `q = J L`, and its vapour enters the gas as warm as the
//! metal, with the enthalpy `h(T_metal, Y = 1)`. Vapour that condenses leaves as warm as the gas and brings
//! the metal what it is warmer, beside the latent heat. What a boiling metal vents takes along its latent heat.
//! What the vapour displaces leaves with the enthalpy of the gas where vapour adds to its mass, else with that of the gas without iron: so the balance
//! of the energy goes with that of the iron. At the wall of a cavity in flux iron changes places with gas as warm.

use std::borrow::Cow;

use crate::heat::reads::{Reads, Vapours};
use crate::heat::sources::Sources;
use crate::heat::{Contact, Electrode, Surfaces};
use crate::vapour::evaporation::Evaporated;

/// Heat with the vapour of one contact.
pub(crate) struct Carried {
    /// Into the metal \[W/m2\].
    pub(crate) metal: f64,
    /// Into the gas, less what is displaced \[W/m2\].
    gas: f64,
    /// Slope of the latter with the temperature of the gas \[W/(m2 K)\], never positive.
    slope: f64,
    /// Into the domain with the vapour \[W/m2\].
    enters: f64,
}

impl Reads<'_> {
    /// The electrode of contact `n`: one whose ionisation voltage is that of the gas beside it, linear in the
    /// fraction of iron (Komen 2019, text under eq. 5.21), at the edge of the film where that has a thickness.
    pub(crate) fn electrode<'s>(&self, surfaces: &'s Surfaces, n: usize) -> Cow<'s, Electrode> {
        let contact = &surfaces.contacts[n];
        let electrode = &surfaces.electrodes[contact.electrode];
        let Some(Vapours { setup, vapour }) = self.around.vapour else {
            return Cow::Borrowed(electrode);
        };
        let Some(iron) = setup.ionisation else {
            return Cow::Borrowed(electrode);
        };
        let own = vapour.iron[contact.gas];
        let surface = vapour.passed.get(n).map_or(own, |passed| passed.surface);
        let layer = surfaces.layers.get(n);
        let beside = layer.map_or(own, |layer| layer.at(surface, &vapour.iron));
        let fraction = iron.fraction(setup.molar, beside);
        Cow::Owned(electrode.beside(fraction, iron.voltage))
    }

    /// Heat with what passes a contact whose surface is at `surface` \[K\].
    pub(crate) fn carried(
        &self,
        of: Vapours<'_>,
        contact: &Contact,
        passed: &Evaporated,
        surface: f64,
    ) -> Option<Carried> {
        let Vapours { setup, vapour } = of;
        let metal = setup.metals[contact.electrode].as_ref()?;
        let law = self.around.case.of(contact.gas).enthalpy.as_ref()?;
        let gas = self.temperature[contact.gas];
        let (flux, iron) = (passed.flux, vapour.iron[contact.gas]);
        let held = if setup.adds { iron } else { 0.0 };
        let displaced = law.within(gas, held);
        let (vapour_k, warmer, slope) = if flux > 0.0 {
            (surface, 0.0, -flux * law.slope_within(gas, held))
        } else {
            (gas, law.within(gas, 1.0) - law.within(surface, 1.0), 0.0)
        };
        let brought = law.within(vapour_k, 1.0);
        let leaves = if setup.adds { 0.0 } else { displaced };
        Some(Carried {
            metal: -flux * (metal.latent_heat + warmer) - passed.vented * metal.latent_heat,
            gas: flux * (brought - displaced),
            slope,
            enters: flux * (brought - leaves),
        })
    }
}

impl Sources {
    /// Adds the heat of the vapour of every contact; returns what enters the gas with it \[W\].
    pub(crate) fn take_vapour(
        &mut self,
        reads: Reads<'_>,
        surfaces: &Surfaces,
        of: Vapours<'_>,
        out: &mut [[f64; 2]],
    ) -> f64 {
        let mut enters = 0.0;
        for (n, contact) in surfaces.contacts.iter().enumerate() {
            let skin = reads.skin(n, contact);
            let passed = &of.vapour.passed[n];
            let Some(carried) = reads.carried(of, contact, passed, skin.temperature) else {
                continue;
            };
            let (surface, gas) = (skin.temperature, reads.temperature);
            let slope = of
                .vapour
                .slope(reads.around.case, of.setup, contact, surface, gas);
            self.contacts[n].parts.vapour += carried.metal;
            self.take_up(out, contact, n, skin, [carried.metal, -slope]);
            out[contact.gas][0] += contact.area * carried.gas;
            out[contact.gas][1] += contact.area * carried.slope;
            enters += contact.area * carried.enters;
        }
        enters + self.take_up_at_wall(reads, of, out)
    }

    /// Slag takes up iron as warm as the gas beside it and gives off as much gas, as warm; returns what
    /// enters the gas with both \[W\].
    fn take_up_at_wall(&self, reads: Reads<'_>, of: Vapours<'_>, out: &mut [[f64; 2]]) -> f64 {
        let mut enters = 0.0;
        of.vapour.walls(reads.around.case, of.setup, |k, rate| {
            if let Some(law) = &reads.around.case.of(k).enthalpy {
                let t = reads.temperature[k];
                let heat = rate * (law.within(t, 1.0) - law.within(t, 0.0));
                out[k][0] += heat;
                enters += heat;
            }
        });
        enters
    }
}
