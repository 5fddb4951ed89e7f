//! What a resumed run needs of a magnetic field: the last solution, and where the liquid was when factors were made.

use artefact::Checkpoint;
use num_complex::Complex;
use run::Failure;

use super::{LEAST, Magnetic, WORN, outline};
use crate::liquid::air::{Place, Skin};

type C = Complex<f64>;

const SOLUTION: &str = "vector_potential";
const ORIGIN: [&str; 3] = ["field_surface", "field_normal", "field_centre"];
const COUNTS: &str = "field_factors";
const TOTALS: &str = "field_force";
const HEAT: &str = "field_heat";

/// Solution, and where the liquid was when factors were made.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct State {
    /// Reaction found last, by point \[V s/m\].
    pub(super) found: Vec<[C; 3]>,
    /// Surface, normals and centre for which factors were made.
    origin: [Vec<[f64; 3]>; 3],
    /// How often they were.
    pub(super) renewed: u64,
    /// Products of their first solve; none before it.
    first: u64,
    pub(super) worn: bool,
}

impl State {
    /// Begins with new factors; the last solution stays where there is one.
    pub(super) fn begin(&mut self, place: Place<'_>, centre: [f64; 3], points: usize) {
        let Skin { place, normal, .. } = place.skin;
        self.origin = [place.to_vec(), normal.to_vec(), vec![centre]];
        self.found.resize(points, [C::default(); 3]);
        self.renewed += 1;
        (self.first, self.worn) = (0, false);
    }

    /// Learns how well factors serve.
    pub(super) fn judge(&mut self, products: u64) {
        if self.first == 0 {
            self.first = products.max(1);
        } else {
            self.worn = products > WORN * self.first.max(LEAST);
        }
    }
}

impl Magnetic {
    /// Puts into a checkpoint what a resumed run needs.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        let state = &self.state;
        let parts = state.found.iter().flatten().flat_map(|a| [a.re, a.im]);
        checkpoint.put_f64(SOLUTION, &parts.collect::<Vec<f64>>());
        for (name, places) in ORIGIN.iter().zip(&state.origin) {
            checkpoint.put_vectors(name, places);
        }
        let worn = u64::from(state.worn);
        checkpoint.put_u64(COUNTS, &[state.renewed, state.first, worn]);
        checkpoint.put_vectors(TOTALS, &[self.totals.force_coil]);
        checkpoint.put_f64(HEAT, &[self.totals.heat_volume]);
    }

    /// Goes on from a checkpoint, of a surface whose points are so far apart \[m\].
    ///
    /// # Errors
    /// Where the checkpoint lacks something, and those of making factors.
    pub fn restore(&mut self, checkpoint: &mut Checkpoint, spacing: f64) -> Result<(), Failure> {
        let parts = checkpoint.f64(SOLUTION)?;
        let point = |p: &[f64]| [0, 1, 2].map(|k| C::new(p[2 * k], p[2 * k + 1]));
        self.state.found = parts.chunks_exact(6).map(point).collect();
        let [surface, normal, centre] = ORIGIN.map(|name| checkpoint.vectors(name));
        self.state.origin = [surface?, normal?, centre?];
        if let [renewed, first, worn] = checkpoint.u64(COUNTS)?[..] {
            self.state.renewed = renewed;
            (self.state.first, self.state.worn) = (first, worn > 0);
        }
        if let [force] = checkpoint.vectors(TOTALS)?[..] {
            self.totals.force_coil = force;
        }
        self.totals.heat_volume = checkpoint.f64(HEAT)?.first().copied().unwrap_or(0.0);
        let [place, normal, centre] = &self.state.origin;
        let skin = Skin {
            place,
            normal,
            spacing,
        };
        if let Some(centre) = centre.first() {
            let stood = self.stand(&outline(skin, *centre)?, *centre);
            let fitted = self.fit(&stood)?;
            self.system = Some(self.made(&stood.region, &fitted)?);
        }
        Ok(())
    }
}
