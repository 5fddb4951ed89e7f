//! Heat within an iteration: how it is carried, the surfaces that answer to it, what warms each cell, and the solve.

use crate::error::Error;
use crate::heat::Contact;
use crate::heat::energy::Step;
use crate::heat::reads::{Around, Reads, Vapours};
use crate::limits::check;
use crate::residual::{Unbalanced, part};
use crate::solver::{Arc, Heating};

/// Rounds of conduction and surfaces after which neither changes.
const ROUNDS: usize = 8;
/// Iterations between two looks at which surface sees which gas shine.
const VIEW_EVERY: usize = 20;
/// Temperature that no arc reaches \[K\].
const ABSURD_K: f64 = 1e5;

impl Arc {
    /// Heat into every cell at the last temperatures.
    pub(crate) fn take_sources(&mut self) {
        if self.heating.is_none() {
            return;
        }
        self.carry_heat();
        self.settle_surfaces();
        self.warm();
    }

    /// Finds surfaces that have temperatures of their own where nothing but those of the middles is known yet: what the
    /// film conducts goes with them, and they with that.
    pub(crate) fn begin_surfaces(&mut self) {
        let own = |h: &Heating| !h.energy.skins.is_empty();
        if self.heating.as_ref().is_some_and(own) {
            for _ in 0..ROUNDS {
                self.carry_heat();
                self.settle_surfaces();
            }
        }
    }

    /// What conducts and carries heat.
    fn carry_heat(&mut self) {
        if let Some((Heating { energy, .. }, around)) = self.heating_within() {
            energy.conduct(around);
            energy.drift(around);
            energy.mix(around);
        }
    }

    /// What surfaces absorb and, where they have temperatures of their own, those, with what evaporates at them.
    fn settle_surfaces(&mut self) {
        let anew = self.iteration % VIEW_EVERY == 1;
        let Some((Heating { energy, sources }, around)) = self.heating_within() else {
            return;
        };
        let mut skins = std::mem::take(&mut energy.skins);
        let reads = Reads {
            around,
            temperature: &energy.temperature,
            skins: &[],
        };
        sources.look(reads, anew);
        if let Some(surfaces) = &around.case.surfaces {
            let through = |contact: &Contact| energy.conductance(contact) / contact.area;
            reads.settle(surfaces, sources.absorbed(), through, &mut skins);
        }
        energy.skins = skins;
        if !energy.skins.is_empty() {
            self.evaporate();
        }
    }

    /// What warms each cell.
    fn warm(&mut self) {
        let Some((Heating { energy, sources }, around)) = self.heating_within() else {
            return;
        };
        let reads = Reads {
            around,
            temperature: &energy.temperature,
            skins: &energy.skins,
        };
        sources.update(reads, &mut energy.source);
        if let Some(wire) = around.case.wire {
            let enthalpy = &around.properties.enthalpy;
            wire.keep(around.case, around.feed, enthalpy, &mut energy.source);
        }
        energy.pass_surfaces(around);
    }

    /// The heat, to be changed, and what it reads beside itself.
    pub(crate) fn heating_within(&mut self) -> Option<(&mut Heating, Around<'_>)> {
        let case = &self.case;
        let vapour = case.vapour.as_ref().zip(self.vapour.as_ref());
        let around = Around {
            case,
            heat: case.heat.as_ref()?,
            properties: &self.properties,
            potential: self.electric.as_ref().map(|e| &e.potential),
            flow: self.flowing.as_ref().map(|f| &f.flow),
            vapour: vapour.map(|(setup, vapour)| Vapours { setup, vapour }),
            feed: self.feed,
        };
        Some((self.heating.as_mut()?, around))
    }

    /// One solve of the energy; returns its residual, the worst cell and how many cells were limited.
    ///
    /// # Errors
    /// When temperatures leave the numbers.
    pub(crate) fn solve_heat(&mut self) -> Result<(f64, Unbalanced, usize), Error> {
        let iteration = self.iteration;
        let step = Step {
            relaxation: self.advance.heat,
            limit: self.advance.heat_step,
        };
        let Some((Heating { energy, sources }, around)) = self.heating_within() else {
            return Ok((0.0, Unbalanced::default(), 0));
        };
        let case = around.case;
        let scale = sources.size() + energy.edges(around).scale();
        let found = energy
            .solve(around, step)
            .map_err(|e| Error::solver("energy", iteration, case, &e))?;
        check(
            case,
            "temperature",
            "K",
            iteration,
            &energy.temperature,
            ABSURD_K,
        )?;
        if let Some(k) = energy.temperature.iter().position(|t| *t <= 0.0) {
            let what = format!("temperature {} K", energy.temperature[k]);
            return Err(Error::diverged("energy", iteration, case.place(k), what));
        }
        Ok((part(found.heat.amount, scale), found.heat, found.limited))
    }
}
