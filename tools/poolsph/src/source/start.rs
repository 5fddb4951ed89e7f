//! Metal as an earlier run has left it.

use std::path::Path;

use artefact::{Frame, Reader};
use run::{Failure, Fault};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::heat::Caloric;
use crate::state::slag::SLAG;
use crate::state::{DROPLET, FUSED, LIQUID, Particle, State, phase};

/// The particles of an earlier run begin this one, in place of those of the bodies: the last ones of the input `start`. Of the bodies
/// the first solid one is still the base metal, whose corners pictures and averages go by.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Temperature \[K\] to which all metal has cooled between the two runs: it is then solid and at rest. Absent: temperatures and
    /// velocities are those at the end of the earlier run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "K", "exclusiveMinimum" = 0.0))]
    pub cooled_to_k: Option<f64>,
}

/// What is needed of `/plate`.
#[derive(Deserialize)]
struct Lattice {
    spacing_m: f64,
}

/// The last particles of an earlier run.
pub struct Earlier {
    /// Their spacing \[m\].
    spacing: f64,
    frame: Frame,
}

/// Part of the melting point within which a temperature of a frame is that: more than the rounding of its narrow floats.
const AT_POINT: f64 = 1e-6;

/// The particles that a file holds.
///
/// # Errors
/// A file that is no artefact of particles, or holds no metal.
pub fn read(path: &Path) -> Result<Earlier, Failure> {
    let reader = Reader::open_kind(path, "particle-frames", 1)?;
    let frames = reader.count("/particles");
    let plates = if reader.has("/plate") {
        reader.json::<Lattice>("/plate")?
    } else {
        Vec::new()
    };
    let (Some((_, plate)), Some(last)) = (plates.first(), frames.checked_sub(1)) else {
        let what = format!("{}: the input 'start' holds no metal", path.display());
        return Err(Failure::Other(what));
    };
    Ok(Earlier {
        spacing: plate.spacing_m,
        frame: reader.frame("/particles", last)?,
    })
}

impl Earlier {
    /// Puts the particles into `state`; `caloric` gives their enthalpy, and is absent where the scene has no heat.
    ///
    /// # Errors
    /// A fault at the key that does not fit them; a frame that lacks a column.
    pub fn fill(
        &self,
        state: &mut State,
        scene: Parameters,
        caloric: Option<&Caloric>,
    ) -> Result<(), Failure> {
        let (own, d) = (state.metal.matter.spacing, self.spacing);
        if (own / d - 1.0).abs() > 1e-9 {
            let what = format!("{own} m is not the spacing of the input 'start', {d} m");
            return Err(Fault::at("/spacing_m", what).into());
        }
        let frame = &self.frame;
        if frame.has(SLAG.name) {
            let what = "the input 'start' holds slag, with which no run can begin yet";
            return Err(Fault::at("/start", what).into());
        }
        let (positions, velocities) = (frame.position_vectors()?, frame.vectors("velocity")?);
        let molten = frame.u8("molten")?;
        let marks = |name| frame.has(name).then(|| frame.u8(name)).transpose();
        let (droplet, wall) = (marks("droplet")?, marks("wall")?);
        // Where nothing has melted, what is liquid has always been.
        let known = frame.has("fused");
        let fused = frame.f64(if known { "fused" } else { "molten" })?;
        if known {
            state.metal.declare(&FUSED);
        }
        if droplet.is_some() {
            state.metal.declare(&DROPLET);
        }
        let warm = self.temperatures(scene, caloric)?;
        for (a, position) in positions.into_iter().enumerate() {
            let wall = wall.is_some_and(|wall| wall[a] == 1);
            let flows = molten[a] == 1 && scene.cooled_to_k.is_none();
            let temperature = warm.as_ref().map_or(0.0, |warm| warm[a]);
            let enthalpy = |caloric: &Caloric| {
                let enthalpy = caloric.enthalpy(temperature);
                let point = caloric.melting_point().filter(|_| !wall);
                let at_point = |t: &f64| (temperature - t).abs() <= AT_POINT * t;
                match point.filter(at_point) {
                    Some(_) => caloric.halfway(share(flows, fused[a])),
                    None => enthalpy,
                }
            };
            state.push(Particle {
                position,
                velocity: if flows { velocities[a] } else { [0.0; 3] },
                phase: if flows { phase::LIQUID } else { phase::SOLID },
                droplet: droplet.is_some_and(|droplet| droplet[a] == 1),
                wall,
                temperature,
                enthalpy: caloric.map_or(0.0, enthalpy),
            });
            state.metal.set(&FUSED, a, fused[a]);
        }
        Ok(())
    }

    /// T of all particles \[K\]; none where the scene has no heat.
    fn temperatures(
        &self,
        scene: Parameters,
        caloric: Option<&Caloric>,
    ) -> Result<Option<Vec<f64>>, Failure> {
        let Some(caloric) = caloric else {
            return Ok(None);
        };
        let warm = match scene.cooled_to_k {
            Some(kelvin) => vec![kelvin; self.frame.len()],
            None if self.frame.has("temperature") => self.frame.f64("temperature")?,
            None => {
                let what = "the input 'start' holds no temperatures: give 'cooled_to_k' in K";
                return Err(Fault::at("/start", what).into());
            }
        };
        if let Some(kelvin) = warm.iter().find(|t| !caloric.covers(**t)) {
            let (low, high) = caloric.range();
            let what = format!("{kelvin} K is outside of the properties, {low} K to {high} K");
            return Err(Fault::at("/start", what).into());
        }
        if let (Some(kelvin), Some(point)) = (scene.cooled_to_k, caloric.melting_point())
            && kelvin >= point
        {
            let what = format!("{kelvin} K is not below the melting point, {point} K");
            return Err(Fault::at("/start/cooled_to_k", what).into());
        }
        Ok(Some(warm))
    }
}

/// Part of its latent heat that a particle at the melting point holds: what it has ever held, where that fits its state, as it does
/// while it melts; else the middle of what fits.
fn share(flows: bool, fused: f64) -> f64 {
    match (flows, fused < 1.0 && (fused >= LIQUID) == flows) {
        (_, true) => fused,
        (true, false) => 0.5 * (1.0 + LIQUID),
        (false, false) => 0.5 * LIQUID,
    }
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn what_melts_goes_on_from_where_it_was_and_what_sets_from_the_middle() {
        let cases = [
            (false, 0.3, 0.3),
            (true, 0.8, 0.8),
            (false, 1.0, 0.25),
            (true, 1.0, 0.75),
        ];
        for (flows, fused, wanted) in cases {
            assert!((share(flows, fused) - wanted).abs() < 1e-15);
        }
    }
}
