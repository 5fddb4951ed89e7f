//! What a resumed run needs of an electric field: solutions to begin with, and that for which air and factors were made.

use artefact::Checkpoint;
use run::Failure;

use super::Electric;
use super::kept::Kept;
use crate::liquid::air::{Place, Skin};

/// Names of the potentials, and of what the air was made for.
const POTENTIALS: [&str; 2] = ["potential_applied", "potential_unit"];
const ORIGIN: [&str; 3] = ["air_surface", "air_normal", "air_inside"];
const COUNTS: &str = "air_counts";

/// Solutions, and where the liquid was when air and factors were made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Potentials found last, of the applied field and of a unit on the liquid, by point \[V, 1\].
    pub(super) potential: [Vec<f64>; 2],
    /// Places of surface, normals and points inside for which the air was made.
    origin: [Vec<[f64; 3]>; 3],
    /// How often the air was made.
    pub(super) renewed: u64,
}

impl State {
    /// Begins with new air.
    pub(super) fn begin(&mut self, place: Place<'_>, guess: Vec<f64>) {
        self.origin = [
            place.skin.place.to_vec(),
            place.skin.normal.to_vec(),
            place.inside.to_vec(),
        ];
        let none = vec![0.0; guess.len()];
        self.potential = [guess, none];
        self.renewed += 1;
    }
}

impl Electric {
    /// Puts into a checkpoint what a resumed run needs.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        let State {
            potential,
            origin,
            renewed,
        } = &self.state;
        for (name, values) in POTENTIALS.iter().zip(potential) {
            checkpoint.put_f64(name, values);
        }
        for (name, places) in ORIGIN.iter().zip(origin) {
            checkpoint.put_vectors(name, places);
        }
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
        let place = Place {
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
        (self.state.potential, self.state.origin) = ([applied?, unit?], origin);
        Ok(())
    }
}
