//! Heat within an iteration: how it is carried, the surfaces that answer to it, what warms each cell, and the solve.

use crate::case::{Case, HeatCase};
use crate::error::Error;
use crate::heat::energy::Step;
use crate::heat::reads::{Reads, Vapours};
use crate::heat::{Contact, Skin};
use crate::limits::check;
use crate::properties::Properties;
use crate::residual::{Unbalanced, part};
use crate::solver::{Arc, Electric, Heating};
use crate::vapour::field::Vapour;

/// Rounds of conduction and surfaces after which neither changes.
const ROUNDS: usize = 8;
/// Iterations between two looks at which surface sees which gas shine.
const VIEW_EVERY: usize = 20;
/// Temperature that no arc reaches \[K\].
const ABSURD_K: f64 = 1e5;

/// What the sources of heat read beside the heat itself.
struct Around<'a> {
    case: &'a Case,
    properties: &'a Properties,
    electric: Option<&'a Electric>,
    vapour: Option<&'a Vapour>,
    feed: f64,
}

impl<'a> Around<'a> {
    /// What the sources read at these temperatures of cells and surfaces \[K\].
    fn reads(&self, heat: &'a HeatCase, temperature: &'a [f64], skins: &'a [Skin]) -> Reads<'a> {
        Reads {
            case: self.case,
            heat,
            properties: self.properties,
            potential: self.electric.map(|e| &e.potential),
            temperature,
            skins,
            vapour: self
                .case
                .vapour
                .as_ref()
                .zip(self.vapour)
                .map(Vapours::from),
        }
    }
}

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
        let Self {
            case,
            properties,
            electric,
            flowing,
            heating,
            vapour,
            feed,
            ..
        } = self;
        let Some((heat, Heating { energy, .. })) = case.heat.as_ref().zip(heating.as_mut()) else {
            return;
        };
        if let Some(flowing) = flowing {
            energy
                .mass_radial
                .copy_from_slice(&flowing.flow.mass_radial);
            energy.mass_axial.copy_from_slice(&flowing.flow.mass_axial);
        }
        if let Some(wire) = case.wire {
            wire.carry(case, *feed, &mut energy.mass_axial);
        }
        energy.conduct(case, properties);
        if let Some(electric) = electric {
            energy.drift(case, &electric.potential);
        }
        if let Some((setup, vapour)) = case.vapour.as_ref().zip(vapour.as_ref()) {
            energy.mix(case, heat, setup, vapour);
        }
    }

    /// What surfaces absorb and, where they have temperatures of their own, those, with what evaporates at them.
    fn settle_surfaces(&mut self) {
        let anew = self.iteration % VIEW_EVERY == 1 || self.settings.view_always;
        let Some((heat, Heating { energy, sources }, around)) = self.heating_within() else {
            return;
        };
        let mut skins = std::mem::take(&mut energy.skins);
        let reads = around.reads(heat, &energy.temperature, &[]);
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
        let Some((heat, Heating { energy, sources }, around)) = self.heating_within() else {
            return;
        };
        let reads = around.reads(heat, &energy.temperature, &energy.skins);
        sources.update(reads, &mut energy.source);
        if let Some(wire) = around.case.wire {
            let enthalpy = &around.properties.enthalpy;
            wire.keep(around.case, around.feed, enthalpy, &mut energy.source);
        }
        energy.pass_surfaces(around.case);
    }

    /// The heat, to be changed, and what it reads beside itself.
    fn heating_within(&mut self) -> Option<(&HeatCase, &mut Heating, Around<'_>)> {
        let around = Around {
            case: &self.case,
            properties: &self.properties,
            electric: self.electric.as_ref(),
            vapour: self.vapour.as_ref(),
            feed: self.feed,
        };
        Some((self.case.heat.as_ref()?, self.heating.as_mut()?, around))
    }

    /// One solve of the energy; returns its residual, the worst cell and how many cells were limited.
    ///
    /// # Errors
    /// When temperatures leave the numbers.
    pub(crate) fn solve_heat(&mut self) -> Result<(f64, Unbalanced, usize), Error> {
        let Self {
            case,
            properties,
            heating,
            iteration,
            settings,
            ..
        } = self;
        let Some((heat, heating)) = case.heat.as_ref().zip(heating.as_mut()) else {
            return Ok((0.0, Unbalanced::default(), 0));
        };
        let Heating { energy, sources } = heating;
        let scale = sources.size() + energy.edges(case, heat, properties).size;
        let step = Step {
            relaxation: settings.heat_relaxation,
            limit: settings.heat_step,
        };
        let found = energy
            .solve(case, heat, properties, step)
            .map_err(|e| Error::solver("energy", *iteration, case, &e))?;
        check(
            case,
            "temperature",
            "K",
            *iteration,
            &energy.temperature,
            ABSURD_K,
        )?;
        if let Some(k) = energy.temperature.iter().position(|t| *t <= 0.0) {
            let what = format!("temperature {} K", energy.temperature[k]);
            return Err(Error::diverged("energy", *iteration, case.place(k), what));
        }
        Ok((part(found.heat.amount, scale), found.heat, found.limited))
    }
}
