//! Heat in a liquid that marches: from a scene to its start, its steps, and what is told and kept of it.

use artefact::{Checkpoint, Frame, Record};
use run::property::Arguments;
use run::{Failure, Fault, Session};
use wls::Stencils;

use super::acting::Acting;
use crate::liquid::drift::{self, Fitted};
use crate::liquid::effort::Effort;
use crate::liquid::heat::{Added, Flow, Melting, Warmed, Warmth, warmed};
use crate::liquid::parts::Parts;
use crate::liquid::step::{Ended, Liquid, Step};
use crate::liquid::surface::Patch;
use crate::liquid::told::Totals;
use crate::liquid::vector::{difference, dot, length};
use crate::scene::Liquid as Part;

/// Radiance of a black body over the fourth power of its temperature \[W/(m2 K4)\].
const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Share of the heat that may be put back before it is told.
const PUT_BACK: f64 = 1e-2;

/// Heat of a liquid.
pub(crate) struct Heated {
    warmth: Warmth,
    /// Whether heat alone marches.
    pub(crate) still: bool,
    /// By point \[J/kg\].
    pub(super) enthalpy: Vec<f64>,
    /// Parts of the drop that belong to its points, as they were when heat flowed last.
    parts: Option<Parts>,
    /// Volumes of these parts \[m3\].
    volumes: Vec<f64>,
    /// Volume \[m3\] and area of the drop \[m2\].
    size: [f64; 2],
    /// Heat that there is by what came and went \[J\]; none before it is counted.
    heat: Option<f64>,
    /// Heat that came since it was counted last, less what went \[J\].
    came: f64,
    /// Heat that came and went, and what fits lost and was put back, all in absolute value \[J\].
    passed: f64,
    put_back: f64,
    /// Power of currents, and what the surface radiates \[W\].
    power: f64,
    radiated: f64,
    /// Whether something froze.
    froze: bool,
}

impl Heated {
    /// That of a scene, at its start; none where heat is absent.
    ///
    /// # Errors
    /// Where a temperature is none, or a drop that is not molten is to flow.
    pub(crate) fn new(part: &Part, liquid: &Liquid<3>) -> Result<Option<Self>, Failure> {
        let Some(given) = &part.heat else {
            return Ok(None);
        };
        let warmth = Warmth {
            density: part.density_kg_m3,
            specific: given.specific_heat_j_kg_k,
            conductivity: given.thermal_conductivity_w_m_k,
            radiation: (given.radiation)
                .map(|r| [r.emissivity * STEFAN_BOLTZMANN, r.surroundings_k]),
            melting: given.melting.map(|m| Melting {
                point: m.melting_point_k,
                latent: m.latent_heat_j_kg,
            }),
        };
        const AT: &str = "/liquid/heat/temperature_k";
        let curve = given
            .temperature_k
            .compile_temperature(AT, &["x", "y", "z", "r"])?;
        let mut enthalpy = Vec::with_capacity(liquid.position.len());
        for x in &liquid.position {
            let t = curve.kelvin(&Arguments::at(*x, 0.0));
            let t = t.map_err(|e| Fault::at(AT, format!("{e}, at {x:?} m")))?;
            enthalpy.push(warmth.enthalpy(t));
        }
        let heated = Self {
            warmth,
            still: given.still,
            enthalpy,
            parts: None,
            volumes: Vec::new(),
            size: [0.0; 2],
            heat: None,
            came: 0.0,
            passed: 0.0,
            put_back: 0.0,
            power: 0.0,
            radiated: 0.0,
            froze: false,
        };
        if !heated.still && heated.frozen() {
            let what = "the liquid is not molten throughout at the start, so that it cannot flow: begin above the melting point, or take \"still\"";
            return Err(Fault::at(AT, what.to_owned()).into());
        }
        Ok(Some(heated))
    }

    fn frozen(&self) -> bool {
        let solid = |h: &f64| self.warmth.molten(*h).is_some_and(|m| m < 1.0);
        self.enthalpy.iter().any(solid)
    }

    /// Heat flows for a step in a drop that stands still.
    ///
    /// # Errors
    /// Where fits or equations cannot be made.
    pub(crate) fn rest(
        &mut self,
        liquid: &Liquid<3>,
        patches: &[Patch<3>],
        acting: &Acting,
        step: Step<'_>,
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let parts = self.parts.take();
        let parts = parts.unwrap_or_else(|| self.cut(liquid, patches, step.way.spacing));
        self.march(parts, &[], acting, step, effort)
    }

    /// Points have come and gone: parts of those that there are now.
    pub(super) fn divide(&mut self, liquid: &Liquid<3>, patches: &[Patch<3>], spacing: f64) {
        self.volumes = self.cut(liquid, patches, spacing).volume;
    }

    /// Parts of the drop as it is.
    fn cut(&self, liquid: &Liquid<3>, patches: &[Patch<3>], spacing: f64) -> Parts {
        Parts::new(&liquid.position, patches, spacing, self.size)
    }

    /// Heat flows for a step in a drop that has moved.
    ///
    /// # Errors
    /// Where fits or equations cannot be made.
    pub(crate) fn flow(
        &mut self,
        liquid: &Liquid<3>,
        ended: &Ended<3>,
        acting: &Acting,
        step: Step<'_>,
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let way = step.way;
        let Ended {
            moved,
            patches,
            rows,
            ..
        } = ended;
        let density = self.warmth.density;
        let field: Vec<[f64; 1]> = self.enthalpy.iter().map(|h| [density * h]).collect();
        let back = |i: usize| difference(&moved[i], &liquid.velocity[i]);
        let mut drift = drift::along_surface(patches, &field, back);
        if !liquid.follow.is_empty() {
            let fitted = Fitted {
                slopes: rows,
                values: rows,
            };
            let inside = patches.len()..field.len();
            drift.extend(drift::inside(fitted, &field, back, inside, way.spacing));
        }
        let parts = self.cut(liquid, patches, way.spacing);
        self.march(parts, drift.as_flattened(), acting, step, effort)?;
        self.froze |= self.frozen();
        Ok(())
    }

    fn march(
        &mut self,
        parts: Parts,
        drift: &[f64],
        acting: &Acting,
        step: Step<'_>,
        effort: &mut Effort,
    ) -> Result<(), Failure> {
        let mut heat = acting.heat.clone();
        self.power = acting.power();
        let whole: f64 = heat.iter().sum();
        if whole > 0.0 {
            heat.iter_mut().for_each(|q| *q *= self.power / whole);
        }
        let flow = Flow {
            parts: &parts,
            added: Added { heat: &heat, drift },
            rule: step.way.rule(),
            dt: step.dt,
        };
        let Warmed { enthalpy, radiated } = warmed(&self.warmth, flow, &self.enthalpy, effort)?;
        self.radiated = self.warmth.leaves(&parts, &enthalpy);
        self.came += step.dt * self.power - radiated;
        self.passed += step.dt * self.power + radiated.abs();
        self.enthalpy = enthalpy;
        self.volumes.clone_from(&parts.volume);
        self.parts = Some(parts);
        Ok(())
    }

    /// Points that were moved from where they were take the enthalpy of their new places.
    pub(crate) fn carry(&mut self, rows: &Stencils<3>, from: &[[f64; 3]], to: &[[f64; 3]]) {
        let old = self.enthalpy.clone();
        for (i, (a, b)) in from.iter().zip(to).enumerate() {
            let way = difference(b, a);
            if length(&way) > 0.0 {
                self.enthalpy[i] += dot(&rows.gradient_of(&old, i), &way);
            }
        }
    }

    /// Counts the heat, and puts back evenly what was lost of it where liquid passed points.
    pub(crate) fn keep(
        &mut self,
        totals: &Totals,
        liquid: &Liquid<3>,
        patches: &[Patch<3>],
        spacing: f64,
    ) {
        self.size = [totals.volume, totals.area];
        let start = self.heat.is_none();
        if start {
            let parts = self.cut(liquid, patches, spacing);
            self.radiated = self.warmth.leaves(&parts, &self.enthalpy);
            self.volumes = parts.volume;
        }
        let each = self.enthalpy.iter().zip(&self.volumes);
        let there = self.warmth.density * each.map(|(h, v)| h * v).sum::<f64>();
        let wanted = self.heat.map_or(there, |before| before + self.came);
        let lack = wanted - there;
        let share = lack / (self.warmth.density * totals.volume);
        self.enthalpy.iter_mut().for_each(|h| *h += share);
        self.put_back += lack.abs();
        (self.heat, self.came) = (Some(wanted), 0.0);
    }

    /// Adds what heat does to a row.
    pub(crate) fn row(&self, record: Record) -> Record {
        let t = |h: &f64| self.warmth.temperature(*h);
        let ([volume, _], volumes) = (self.size, &self.volumes);
        let mean = |of: &dyn Fn(&f64) -> f64| {
            let each = self.enthalpy.iter().zip(volumes);
            each.map(|(h, v)| v * of(h)).sum::<f64>() / volume
        };
        let record = record
            .with("temperature", "K", mean(&t))
            .with(
                "temperature_lowest",
                "K",
                self.enthalpy.iter().map(t).fold(f64::INFINITY, f64::min),
            )
            .with(
                "temperature_highest",
                "K",
                self.enthalpy.iter().map(t).fold(0.0, f64::max),
            )
            .with("heat", "J", self.heat.unwrap_or(0.0))
            .with("radiated", "W", self.radiated);
        if self.warmth.melting.is_some() {
            let molten = |h: &f64| self.warmth.molten(*h).unwrap_or(1.0);
            record.with("molten", "1", mean(&molten))
        } else {
            record
        }
    }

    /// Adds temperatures to a frame of the points, and the share that is molten where something melts.
    pub(crate) fn frame(&self, frame: Frame) -> Frame {
        let t = self.enthalpy.iter().map(|h| self.warmth.temperature(*h));
        let frame = frame.scalar("temperature", "K", t);
        if self.warmth.melting.is_none() {
            return frame;
        }
        let molten = self.enthalpy.iter();
        frame.scalar(
            "molten",
            "1",
            molten.map(|h| self.warmth.molten(*h).unwrap_or(1.0)),
        )
    }

    pub(crate) fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put_f64("enthalpy", &self.enthalpy);
        checkpoint.put_f64("heat_volumes", &self.volumes);
        let heat: Vec<f64> = self.heat.into_iter().collect();
        checkpoint.put_f64("heat", &heat);
        let froze = f64::from(u8::from(self.froze));
        let all = [
            self.size[0],
            self.size[1],
            self.came,
            self.passed,
            self.put_back,
            self.power,
            self.radiated,
            froze,
        ];
        checkpoint.put_f64("heat_counts", &all);
    }

    pub(crate) fn restore(&mut self, checkpoint: &mut Checkpoint) -> Result<(), Failure> {
        self.enthalpy = checkpoint.f64("enthalpy")?;
        self.volumes = checkpoint.f64("heat_volumes")?;
        self.heat = checkpoint.f64("heat")?.first().copied();
        if let [volume, area, came, passed, put_back, power, radiated, froze] =
            checkpoint.f64("heat_counts")?[..]
        {
            (self.size, self.came) = ([volume, area], came);
            (self.passed, self.put_back, self.power) = (passed, put_back, power);
            (self.radiated, self.froze) = (radiated, froze > 0.0);
        }
        Ok(())
    }

    pub(crate) fn close(&self, session: &mut Session) {
        session.closing("heat", "J", self.heat.unwrap_or(0.0));
        session.closing("heat_passed", "J", self.passed);
        session.closing("heat_put_back", "J", self.put_back);
        if self.put_back > PUT_BACK * self.passed && self.passed > 0.0 {
            session.warn(format!(
                "of {:.3e} J of heat that came and went fits lost or won {:.3e} J, which was put back evenly: take a smaller spacing or step",
                self.passed, self.put_back
            ));
        }
        if self.froze {
            session.warn("parts of the liquid froze, and flowed on as if they had not");
        }
    }
}
