//! Iron vapour within an iteration: what metal gives off, and where it goes.

use crate::error::Error;
use crate::fields::vapour::IronBalance;
use crate::heat::Surfaces;
use crate::residual::part;
use crate::solver::{Arc, Heating};
use crate::vaporising::Vaporising;

/// Surfaces of the heat, which follow a cavity, where it is solved.
fn surfaces_of(heating: Option<&Heating>) -> Option<&Surfaces> {
    heating.and_then(|h| h.setup.surfaces.as_ref())
}

impl Arc {
    /// Conductances and evaporation at the last state.
    pub(crate) fn settle_vapour(&mut self) {
        if let Some(vaporising) = &mut self.vaporising {
            let flow = self.flowing.as_ref().map(|f| &f.flow);
            let Vaporising { setup, vapour } = vaporising;
            vapour.carry(&self.case, setup, &self.properties, flow);
        }
        self.evaporate();
    }

    /// Evaporation at the present temperatures and fractions.
    pub(crate) fn evaporate(&mut self) {
        let Self {
            case,
            heating,
            vaporising,
            ..
        } = self;
        let Some(Vaporising { setup, vapour }) = vaporising else {
            return;
        };
        let (contacts, at) = match heating {
            Some(Heating {
                setup: heat,
                energy,
                ..
            }) => (
                heat.surfaces.as_ref().map(|s| s.contacts.as_slice()),
                (energy.skins.as_slice(), energy.temperature.as_slice()),
            ),
            None => (None, (&[][..], case.start.as_slice())),
        };
        let contacts = contacts.unwrap_or(&setup.contacts);
        vapour.evaporate(case, setup, contacts, at);
    }

    /// Solves for the iron; returns its residual.
    ///
    /// # Errors
    /// When the fractions leave the numbers.
    pub(crate) fn solve_vapour(&mut self) -> Result<f64, Error> {
        self.settle_vapour();
        let Self {
            case,
            heating,
            vaporising,
            iteration,
            settings,
            ..
        } = self;
        let Some(Vaporising { setup, vapour }) = vaporising else {
            return Ok(0.0);
        };
        let heat = surfaces_of(heating.as_ref());
        let contacts = heat.map_or(&setup.contacts, |s| &s.contacts);
        let scale = vapour.balance(case, setup, contacts).size;
        let found = vapour
            .solve(case, setup, settings.heat_relaxation)
            .map_err(|e| Error::solver("iron", *iteration, case, &e))?;
        self.evaporate();
        self.blow();
        Ok(part(found, scale))
    }

    /// Gives the flow the mass of the vapour, where it adds to the gas.
    pub(crate) fn blow(&mut self) {
        let Self {
            heating,
            vaporising,
            flowing,
            ..
        } = self;
        let (Some(vaporising), Some(flowing)) = (vaporising, flowing) else {
            return;
        };
        if vaporising.setup.adds {
            let contacts = vaporising.contacts(surfaces_of(heating.as_ref()));
            let source = &mut flowing.flow.mass_source;
            vaporising.vapour.mass_source(contacts, source);
        }
    }

    /// Iron that enters and leaves the gas, where there is vapour.
    #[must_use]
    pub fn iron_balance(&self) -> Option<IronBalance> {
        let vaporising = self.vaporising.as_ref()?;
        let contacts = vaporising.contacts(surfaces_of(self.heating.as_ref()));
        let Vaporising { setup, vapour } = vaporising;
        Some(vapour.balance(&self.case, setup, contacts))
    }
}
