//! The arcs of a scene, and what each stage takes of their tables.

use std::sync::Arc as Shared;

use run::{Failure, Fault, Inputs};

use crate::forces::arc_pressure::{self, Pressure};
use crate::forces::gas_shear::Gas;
use crate::forces::lorentz::{self, Force};
use crate::heat::{self, ArcParameters, Caloric};
use crate::scene::Scene;
use crate::source::arc::ArcSource;
use crate::source::arcs::{Burning, OneArc};

/// An arc: where it burns, its own heat, and its tables where they are there.
struct One {
    /// What its heat is said by.
    heat_at: String,
    heat: Option<ArcParameters>,
    input: &'static str,
    burning: Burning,
    tables: Option<ArcSource>,
}

/// All arcs; one of the input `arc` where a scene does not list them.
pub(super) struct Arcs(Vec<One>);

impl Arcs {
    /// Reads the inputs of a scene.
    pub(super) fn read(scene: &Scene, inputs: &Inputs) -> Result<Self, Failure> {
        let pressed = scene.arc_pressure.as_ref();
        let pulled = scene.lorentz.as_ref();
        let wanted = scene.gas_shear.is_some()
            || pulled.is_some_and(|pulled| pulled.force_n_m3.is_none())
            || pressed.is_some_and(|pressed| pressed.pressure_pa.is_none());
        let alone = [OneArc::default()];
        let arcs = match scene.arcs.as_slice() {
            [] => &alone,
            several => several,
        };
        let read = |(number, arc): (usize, &OneArc)| {
            let input = arc.input.name();
            let path = match wanted {
                true => Some(inputs.path(input)?),
                false => inputs.get(input),
            };
            Ok(One {
                heat_at: match arc.heat {
                    Some(_) => format!("/arcs/{number}/heat"),
                    None => "/arc".to_owned(),
                },
                heat: arc.heat.clone(),
                input,
                burning: arc.burning(),
                tables: path.map(ArcSource::read).transpose()?,
            })
        };
        let read: Result<_, Failure> = arcs.iter().enumerate().map(read).collect();
        Ok(Self(read?))
    }

    /// Their heat by `arc`, or by what each of them says itself.
    pub(super) fn heat(
        &self,
        arc: &ArcParameters,
        scene: &Scene,
        caloric: Shared<Caloric>,
    ) -> Result<heat::Arc, Fault> {
        let open = scene.heat.as_ref().map(|heat| heat.planes().1);
        let stage = heat::Arc::without_arcs(caloric, scene.metal(), arc.on);
        let mut stage = stage.within(&open.unwrap_or_default());
        for one in &self.0 {
            let surface = one.tables.as_ref().map(ArcSource::surface);
            let own = one.heat.as_ref().unwrap_or(arc);
            let added = stage.burn(own, one.burning.clone(), surface);
            added.map_err(|fault| fault.within(&one.heat_at))?;
        }
        Ok(stage)
    }

    /// The gas of each.
    pub(super) fn gases(&self) -> Result<Vec<(Gas, Burning)>, Failure> {
        self.each(|tables, _| {
            Ok(Gas {
                speed: tables.radial("gas_radial_velocity_m_s")?,
                height: tables.scalar("gas_velocity_height_m")?,
                temperature: tables.radial("gas_temperature_k")?,
            })
        })
    }

    /// The Lorentz force of each, by its tables or by formulas.
    pub(super) fn lorentz(
        &self,
        pulled: &lorentz::Parameters,
    ) -> Result<Vec<(Force, Burning)>, Failure> {
        if pulled.force_n_m3.is_none() {
            return self.each(|tables, input| {
                let what = || format!("the input '{input}' holds no Lorentz force");
                let table = tables.lorentz()?.map(Force::Table);
                Ok(table.ok_or_else(|| Fault::at("/lorentz", what()))?)
            });
        }
        let mut forces = Vec::new();
        for one in &self.0 {
            let formula = pulled.formula().map_err(|fault| fault.within("/lorentz"))?;
            forces.extend(formula.map(|force| (force, one.burning.clone())));
        }
        Ok(forces)
    }

    /// The pressure of each, by its tables or by a formula.
    pub(super) fn pressures(
        &self,
        pressed: &arc_pressure::Parameters,
    ) -> Result<Vec<(Pressure, Burning)>, Failure> {
        if pressed.pressure_pa.is_none() {
            return self.each(|tables, _| Ok(Pressure::Table(tables.radial("arc_pressure_pa")?)));
        }
        let formula = || {
            pressed
                .formula()
                .map_err(|fault| fault.within("/arc_pressure"))
        };
        let mut pressures = Vec::new();
        for one in &self.0 {
            pressures.extend(formula()?.map(|pressure| (pressure, one.burning.clone())));
        }
        Ok(pressures)
    }

    /// Something of the tables of each.
    fn each<T>(
        &self,
        of: impl Fn(&ArcSource, &str) -> Result<T, Failure>,
    ) -> Result<Vec<(T, Burning)>, Failure> {
        let one = |one: &One| {
            let missing = || Failure::Usage(format!("this scene needs --input {}=FILE", one.input));
            let tables = one.tables.as_ref().ok_or_else(missing)?;
            Ok((of(tables, one.input)?, one.burning.clone()))
        };
        self.0.iter().map(one).collect()
    }
}
