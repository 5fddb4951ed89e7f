//! What a resumed run needs of an electric field: solutions to begin with, and that for which air and factors were made.

use artefact::Checkpoint;
use run::Failure;

use super::Electric;
use super::kept::Kept;
use crate::liquid::air::{Place, Skin};

/// Names of the potentials, those of units one behind the other, and of what the air was made for.
const POTENTIALS: [&str; 2] = ["potential_applied", "potential_unit"];
const ORIGIN: [&str; 3] = ["air_surface", "air_normal", "air_inside"];
const DROPS: &str = "air_drops";
const COUNTS: &str = "air_counts";

/// Solutions, and where the liquid was when air and factors were made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Potentials found last, of the applied field and of a unit on each conductor, by point \[V, 1\].
    pub(super) potential: Vec<Vec<f64>>,
    /// Places of surface, normals and points inside for which the air was made.
    origin: [Vec<[f64; 3]>; 3],
    /// Numbers of the drops of these.
    of: Vec<u32>,
    /// How often the air was made.
    pub(super) renewed: u64,
}

impl State {
    /// Begins with new air.
    pub(super) fn begin(&mut self, place: Place<'_>, guess: Vec<f64>, units: usize) {
        self.origin = [
            place.skin.place.to_vec(),
            place.skin.normal.to_vec(),
            place.inside.to_vec(),
        ];
        self.of = place.of.to_vec();
        let none = vec![0.0; guess.len()];
        self.potential = vec![none; units + 1];
        self.potential[0] = guess;
        self.renewed += 1;
    }

    /// Whether solutions are those of as many points and conductors.
    pub(super) fn fits(&self, place: Place<'_>, units: usize) -> bool {
        self.origin[0].len() == place.skin.place.len()
            && self.origin[2].len() == place.inside.len()
            && self.of == place.of
            && self.potential.len() == units + 1
    }
}

impl Electric {
    /// Puts into a checkpoint what a resumed run needs.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        let State {
            potential,
            origin,
            of,
            renewed,
        } = &self.state;
        let (applied, units) = (potential.first(), potential.get(1..).unwrap_or_default());
        checkpoint.put_f64(POTENTIALS[0], applied.map_or(&[], |v| v));
        checkpoint.put_f64(POTENTIALS[1], &units.concat());
        for (name, places) in ORIGIN.iter().zip(origin) {
            checkpoint.put_vectors(name, places);
        }
        let of: Vec<u64> = of.iter().map(|k| u64::from(*k)).collect();
        checkpoint.put_u64(DROPS, &of);
        let kept = self.kept.as_ref();
        let first = kept.map_or(0, |kept| kept.first);
        let worn = kept.is_some_and(|kept| kept.worn);
        checkpoint.put_u64(COUNTS, &[*renewed, first, u64::from(worn)]);
    }

    /// Goes on from a checkpoint, of a surface whose points are so far apart \[m\].
    ///
    /// # Errors
    /// Where the checkpoint lacks something, and those of making the air.
    pub fn restore(&mut self, checkpoint: &mut Checkpoint, spacing: f64) -> Result<(), Failure> {
        let [applied, unit] = POTENTIALS.map(|name| checkpoint.f64(name));
        let [surface, normal, inside] = ORIGIN.map(|name| checkpoint.vectors(name));
        let origin = [surface?, normal?, inside?];
        let of = checkpoint.u64(DROPS)?.into_iter().map(|k| k as u32);
        self.state.of = of.collect();
        let place = Place {
            of: &self.state.of,
            skin: Skin {
                place: &origin[0],
                normal: &origin[1],
                spacing,
            },
            inside: &origin[2],
        };
        let mut kept = Kept::new(&self.applied, &self.form, place)?;
        if let [renewed, first, worn] = checkpoint.u64(COUNTS)?[..] {
            (kept.first, kept.worn) = (first, worn > 0);
            self.state.renewed = renewed;
        }
        self.kept = Some(kept);
        let (applied, units) = (applied?, unit?);
        let units = units.chunks(applied.len().max(1)).map(<[f64]>::to_vec);
        self.state.potential = units.collect();
        self.state.potential.insert(0, applied);
        self.state.origin = origin;
        Ok(())
    }
}
