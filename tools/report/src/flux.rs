//! A moment of a weld under flux: metal, grains, and where the wire is.

use artefact::Reader;
use serde_json::Value;

use crate::mirror::Mirror;
use crate::weld::{Way, Weld};

/// Channel of the grains.
pub(crate) const GRAINS: &str = "/grains";

/// States of a grain: powder and slag; what is neither is frozen slag.
pub(crate) const POWDER: u8 = 0;
pub(crate) const SLAG: u8 = 1;

/// The wire as the section along the weld cuts it: along the weld (y) and up (z) \[mm\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wire {
    pub(crate) y: [f64; 2],
    pub(crate) z: [f64; 2],
}

/// Metal and grains of one frame.
#[derive(Debug, Clone)]
pub(crate) struct Flux {
    /// The metal.
    pub(crate) weld: Weld,
    /// Places of the grains \[m\].
    pub(crate) position: Vec<[f64; 3]>,
    /// Temperatures of the grains \[K\], where they have any.
    pub(crate) temperature: Option<Vec<f64>>,
    /// Radii of the grains \[m\].
    pub(crate) radius: Vec<f64>,
    /// States of the grains; none where they cannot melt.
    pub(crate) state: Vec<u8>,
    /// Where the wire is, if the scene has one.
    pub(crate) wire: Option<Wire>,
}

impl Flux {
    /// Frame `index` of metal, and the grains of the same time; none where there are none.
    ///
    /// # Errors
    /// A message that cannot be read.
    pub(crate) fn read(
        reader: &Reader,
        scene: &Value,
        index: usize,
    ) -> artefact::Result<Option<Self>> {
        let count = reader.count(GRAINS);
        if index >= count {
            return Ok(None);
        }
        let weld = Weld::read(reader, index)?;
        // Both are written at the same times, unless the scene says otherwise.
        let mut frame = reader.frame(GRAINS, index)?;
        if (frame.time_s - weld.time).abs() > 1e-9 {
            let nearest = (0..count).map(|k| reader.frame(GRAINS, k));
            for other in nearest {
                let other = other?;
                if (other.time_s - weld.time).abs() < (frame.time_s - weld.time).abs() {
                    frame = other;
                }
            }
        }
        let melts = frame.has("state");
        let mut flux = Self {
            position: frame.position_vectors()?,
            temperature: if frame.has("temperature") {
                Some(frame.f64("temperature")?)
            } else {
                None
            },
            state: if melts {
                frame.u8("state")?.to_vec()
            } else {
                Vec::new()
            },
            radius: frame.f64("radius")?,
            wire: wire(scene, weld.time, &weld.way),
            weld,
        };
        if let Some(mirror) = flux.weld.mirror {
            flux.complete(mirror);
        }
        let way = flux.weld.way;
        flux.position.iter_mut().for_each(|p| way.turn(p));
        Ok(Some(flux))
    }

    /// Adds the image of the half that was computed.
    fn complete(&mut self, mirror: Mirror) {
        mirror.places(&mut self.position);
        mirror.values(&mut self.radius);
        mirror.values(&mut self.state);
        self.temperature.iter_mut().for_each(|t| mirror.values(t));
    }

    /// Number of grains in a state.
    pub(crate) fn number(&self, state: u8) -> usize {
        self.state.iter().filter(|s| **s == state).count()
    }
}

/// The first upright round wall that is fed along itself, at a time \[s\], in the coordinates of the weld.
fn wire(scene: &Value, time: f64, way: &Way) -> Option<Wire> {
    let walls = scene.pointer("/grains/walls")?.as_array()?;
    let fed = walls.iter().find(|wall| {
        wall.get("surface_m_s").is_some_and(Value::is_array)
            && wall.pointer("/shape/cylinder").is_some()
    })?;
    let cylinder = fed.pointer("/shape/cylinder")?;
    let number = |of: &Value, at: &str| of.pointer(at).and_then(Value::as_f64);
    let moved = |k: usize| number(fed, &format!("/velocity_m_s/{k}")).unwrap_or(0.0) * time;
    let at = |k: usize| Some(number(cylinder, &format!("/centre_m/{k}"))? + moved(k));
    let mut place = [at(0)?, at(1)?, number(cylinder, "/centre_m/2")?];
    way.turn(&mut place);
    let [_, y, z] = place;
    let (radius, half) = (
        number(cylinder, "/radius_m")?,
        0.5 * number(cylinder, "/length_m")?,
    );
    let around = |at: f64, half: f64| [1e3 * (at - half), 1e3 * (at + half)];
    Some(Wire {
        y: around(y, radius),
        z: around(z, half),
    })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_wire_is_the_wall_that_is_fed_and_moves_with_the_weld() {
        let scene = json!({"grains": {"walls": [
            {"shape": {"box": {"min_m": [0, 0, 0], "max_m": [1, 1, 1]}}, "hollow": true},
            {"shape": {"cylinder": {"centre_m": [0, 0.01, 0.0229], "radius_m": 2e-3, "length_m": 0.04}},
             "velocity_m_s": [0, 0.005, 0], "surface_m_s": [0, 0, -0.021]}
        ]}});
        let wire = wire(&scene, 2.0, &Way::default()).unwrap();
        let close = |a: [f64; 2], b: [f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() < 1e-9);
        assert!(
            close(wire.y, [18.0, 22.0]) && close(wire.z, [2.9, 42.9]),
            "{wire:?}"
        );
        assert_eq!(
            super::wire(&json!({"grains": {"walls": []}}), 0.0, &Way::default()),
            None
        );
    }
}
