//! Iron vapour within an iteration: what metal gives off, and where it goes.

use crate::error::Error;
use crate::residual::part;
use crate::solver::Arc;
use crate::vapour::balance::IronBalance;

impl Arc {
    /// Conductances and evaporation at the last state.
    pub(crate) fn settle_vapour(&mut self) {
        if let Some((setup, vapour)) = self.case.vapour.as_ref().zip(self.vapour.as_mut()) {
            vapour.conduct(&self.case, setup, &self.properties);
        }
        self.evaporate();
    }

    /// Evaporation at the present temperatures and fractions.
    pub(crate) fn evaporate(&mut self) {
        let Some((setup, vapour)) = self.case.vapour.as_ref().zip(self.vapour.as_mut()) else {
            return;
        };
        let (skins, temperature) = match &self.heating {
            Some(heating) => (
                heating.energy.skins.as_slice(),
                heating.energy.temperature.as_slice(),
            ),
            None => (&[][..], self.case.start.as_slice()),
        };
        vapour.evaporate(&self.case, setup, skins, temperature);
    }

    /// Solves for the iron; returns its residual.
    ///
    /// # Errors
    /// When the fractions leave the numbers.
    pub(crate) fn solve_vapour(&mut self) -> Result<f64, Error> {
        self.settle_vapour();
        let (case, relaxation) = (&self.case, self.advance.heat);
        let Some((setup, vapour)) = case.vapour.as_ref().zip(self.vapour.as_mut()) else {
            return Ok(0.0);
        };
        let flow = self.flowing.as_ref().map(|f| &f.flow);
        let scale = vapour.balance(case, setup, flow).size;
        let found = vapour
            .solve(case, setup, flow, relaxation)
            .map_err(|e| Error::solver("iron", self.iteration, case, &e))?;
        self.evaporate();
        self.blow();
        Ok(part(found, scale))
    }

    /// Gives the flow the mass of the vapour, where it adds to the gas.
    pub(crate) fn blow(&mut self) {
        let adds = self.case.vapour.as_ref().is_some_and(|setup| setup.adds);
        if let (Some(vapour), Some(flowing), true) = (&self.vapour, &mut self.flowing, adds) {
            vapour.mass_source(self.case.contacts(), &mut flowing.flow.mass_source);
        }
    }

    /// Iron that enters and leaves the gas, where there is vapour.
    #[must_use]
    pub fn iron_balance(&self) -> Option<IronBalance> {
        let (setup, vapour) = self.case.vapour.as_ref().zip(self.vapour.as_ref())?;
        let flow = self.flowing.as_ref().map(|f| &f.flow);
        Some(vapour.balance(&self.case, setup, flow))
    }
}
