//! The scene: what a person writes, typed. Optional physics is an absent key.

mod arcs;
mod body;
mod check;
mod lattice;
mod odd;
mod older;
mod output;
mod size;
mod slag;
mod time;

use particles::{Column, Matter};
use run::Fault;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use torch::Torch;

pub use body::{BodyScene, CutScene, Material, StartState};
pub use check::faults;
pub use lattice::Lattice;
pub use odd::{doubts, notes};
pub use older::MIGRATIONS;
pub use output::{Output, PoolOutput};
pub use time::{Adaptive, Time};

use crate::domain::{bounds, droplet};
use crate::forces::{
    arc_pressure, buoyancy, gas_shear, lorentz, marangoni, surface_stress, tension,
};
use crate::heat::received;
use crate::{faces, grains, heat, motion, source};

/// Kind and version of the scenes that this tool reads.
pub const KIND: (&str, u32) = ("poolsph.scene", 2);

/// A weld pool, or any part of its physics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What it shows, in a line.
    #[serde(default)]
    pub title: String,
    /// Particle diameter d = spacing of the lattice \[m\]; needed where there are bodies of metal. Along each axis the lattice is
    /// fitted to them.
    #[serde(default)]
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub spacing_m: f64,
    /// h of the kernel, whose support is 2h \[m\]; d if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "m", "exclusiveMinimum" = 0.0))]
    pub smoothing_length_m: Option<f64>,
    /// Length of the steps, and end of the run.
    pub time: Time,
    /// rho of the metal \[kg/m3\]; needed where there are bodies of metal.
    #[serde(default)]
    #[schemars(extend("x-unit" = "kg/m3", "exclusiveMinimum" = 0.0))]
    pub density_kg_m3: f64,
    /// Metal at the start. Where two bodies overlap, the earlier one of the list fills the place. Empty in a scene of grains alone.
    #[serde(default)]
    pub bodies: Vec<BodyScene>,
    /// The run begins with the metal of an earlier run, the input `start`; absent: with that of the bodies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<source::start::Parameters>,
    /// Motion of the liquid; absent: nothing moves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow: Option<motion::Parameters>,
    /// A second liquid that does not mix with the metal, such as slag upon a pool; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slag: Option<motion::slag::Parameters>,
    /// When the liquid begins to move; absent: at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow_start: Option<heat::FlowStart>,
    /// Surface tension; absent: the surface pulls nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension: Option<tension::Parameters>,
    /// Marangoni stress: the surface is pulled towards greater surface tension; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub marangoni: Option<marangoni::Parameters>,
    /// A given stress on the surface; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface_stress: Option<surface_stress::Parameters>,
    /// Buoyancy; absent: the density does not depend on the temperature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub buoyancy: Option<buoyancy::Parameters>,
    /// The moving axis of the arc; absent: no arc.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<source::Parameters>,
    /// Several arcs, or one that pulses or alternates; absent: one arc, from the input `arc`, on the axis of the source.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 64))]
    pub arcs: Vec<source::arcs::OneArc>,
    /// Shear by the gas of the input `arc`; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gas_shear: Option<gas_shear::Parameters>,
    /// Lorentz force of the input `arc`; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lorentz: Option<lorentz::Parameters>,
    /// Pressure of the arc on the surface, of the input `arc` or of a formula; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arc_pressure: Option<arc_pressure::Parameters>,
    /// Flat faces at which the flow ends or repeats: periodic faces, mirrors, lids, walls; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<faces::Parameters>,
    /// Box in which metal is followed; absent: everywhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounds: Option<bounds::Parameters>,
    /// Droplets from the wire; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub droplets: Option<droplet::Parameters>,
    /// Heat conduction and melting; absent: no temperatures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heat: Option<heat::Parameters>,
    /// Heat of the arc on the surface; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arc: Option<heat::ArcParameters>,
    /// Torches of welding that move along paths; absent: none. They need heat.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub torches: Vec<Torch>,
    /// Heat that the surface gives off; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub losses: Option<heat::LossParameters>,
    /// Grains beside the metal or alone; absent: none.
    #[serde(default, skip_serializing)]
    pub grains: Option<grains::Parameters>,
    /// What is written, and when.
    pub output: Output,
}

/// A wire that gives droplets.
#[derive(Debug, Clone, PartialEq)]
pub struct Wire {
    /// The key that says so.
    pub at: String,
    /// Its droplets.
    pub droplets: droplet::Parameters,
    /// From the axis of the source \[m\].
    pub offset_m: [f64; 3],
}

impl Scene {
    /// True if the flow is without divergence: single particles then have pressures that mean something.
    #[must_use]
    pub fn even(&self) -> bool {
        let flow = self.flow.as_ref();
        flow.is_some_and(|flow| flow.method == motion::Method::DivergenceFree)
    }

    /// The metal with its lattice.
    #[must_use]
    pub fn metal(&self) -> Matter {
        // Where there is no metal, its lattice is of no account.
        let spacing = if self.bodies.is_empty() {
            1.0
        } else {
            self.lattice().spacing()
        };
        Matter {
            density: self.density_kg_m3,
            spacing,
            smoothing_length: self.smoothing_length_m.unwrap_or(spacing),
        }
    }

    /// Whether there is metal, and not grains alone.
    #[must_use]
    pub fn has_metal(&self) -> bool {
        !self.bodies.is_empty()
    }

    /// Whether the run is to end when grains rest.
    #[must_use]
    pub fn waits(&self) -> bool {
        self.grains
            .as_ref()
            .is_some_and(|grains| grains.until.is_some())
    }

    /// The faces beside which the flow goes on; none where the scene has none.
    ///
    /// # Errors
    /// A fault at the key that is wrong.
    pub fn flow_faces(&self) -> Result<faces::Faces, Fault> {
        let Some(faces) = &self.faces else {
            return Ok(faces::Faces::default());
        };
        let compiled = faces.faces(self.metal().support(), self.heat.is_some());
        compiled.map_err(|fault| fault.within("/faces"))
    }

    /// The wires that give droplets: that of the source, then those of arcs.
    pub fn wires(&self) -> impl Iterator<Item = Wire> {
        let own = self.droplets.map(|droplets| Wire {
            at: "/droplets".to_owned(),
            droplets,
            offset_m: [0.0; 3],
        });
        let arcs = self.arcs.iter().enumerate();
        let others = arcs.filter_map(|(number, arc)| {
            Some(Wire {
                at: format!("/arcs/{number}/droplets"),
                droplets: arc.droplets?,
                offset_m: arc.offset_m,
            })
        });
        own.into_iter().chain(others)
    }

    /// The mirror plane that halves the droplets of a wire; none where no mirror lies along its way.
    ///
    /// # Errors
    /// A mirror that would cut a droplet.
    pub fn halving(&self, wire: &Wire) -> Result<Option<droplet::Mirror>, Fault> {
        let (Some(source), Some(faces)) = (self.source, &self.faces) else {
            return Ok(None);
        };
        let mirrors = faces.mirror.iter().map(|face| {
            let (axis, below) = face.side();
            let corner = if below { faces.max_m } else { faces.min_m };
            (droplet::Mirror { axis, below }, corner[axis])
        });
        let mirrors: Vec<_> = mirrors.collect();
        let start = std::array::from_fn(|k| source.start_m[k] + wire.offset_m[k]);
        wire.droplets.mirror(start, source.velocity_m_s, &mirrors)
    }

    /// Time between two droplets of a wire \[s\], if it says how often they come.
    #[must_use]
    pub fn droplet_period(&self, wire: &Wire) -> Option<f64> {
        let mirror = self.halving(wire).ok()?;
        wire.droplets.period(self.metal().spacing, mirror)
    }

    /// Columns of the heat that the metal gets and loses, one for each way that there is.
    #[must_use]
    pub fn heat_ways(&self) -> Vec<Column<f64>> {
        let grains = self.grains.as_ref().and_then(|grains| grains.heat.as_ref());
        let ways = [
            (self.arc.is_some(), received::FROM_ARC),
            (!self.torches.is_empty(), received::FROM_TORCHES),
            (grains.is_some(), received::FROM_POWDER),
            (grains.is_some(), received::FROM_SLAG),
            (self.losses.is_some(), received::LOST),
        ];
        ways.into_iter()
            .filter_map(|(there, way)| there.then_some(way))
            .collect()
    }

    /// Number of steps.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.time.steps()
    }

    /// Step dt \[s\] that is taken.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.time.step()
    }
}
