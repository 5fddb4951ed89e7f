//! Fits that the points of a liquid take with them from stage to stage ([`wls::Moved`]).
//!
//! They are made anew where the liquid has strained about a point, or its points have gone each its own way, by more than a few
//! hundredths since they were made.

use std::sync::Arc;

use artefact::Checkpoint;
use rayon::prelude::*;
use wls::{Error, Moved, Stencils};

use super::matter::Way;
use super::operators::bearing;

/// Most strain, and most that neighbours stray over the distance of those that are near.
const STRAIN: f64 = 0.05;
const ROUGH: f64 = 0.02;
/// Neighbours are near within so many spacings.
const NEAR: f64 = 1.6;

/// Fits, and where points stood when they were made.
#[derive(Debug, Clone, Default)]
pub struct Borne<const D: usize> {
    place: Vec<[f64; D]>,
    /// Nothing before they are asked for in a run that was resumed.
    fits: Option<Arc<Stencils<D>>>,
}

/// Places say what fits are.
impl<const D: usize> PartialEq for Borne<D> {
    fn eq(&self, other: &Self) -> bool {
        self.place == other.place
    }
}

impl<const D: usize> Borne<D> {
    /// Forgets fits, as points are others.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Rows of derivatives at points that are now here.
    ///
    /// # Errors
    /// Where fits cannot be made.
    pub fn rows(&mut self, points: &[[f64; D]], way: &Way) -> Result<Stencils<D>, Error> {
        if self.place.len() == points.len() {
            let fits = match self.fits.take() {
                Some(fits) => fits,
                None => Arc::new(bearing(&self.place, way)?),
            };
            let moved = Moved::new(&fits, points);
            let near = NEAR * way.spacing;
            let both = [&self.place, points];
            let keeps = |i: usize| {
                let strain = moved.strain(i).is_some_and(|strain| strain <= STRAIN);
                strain && (moved.roughness(&fits, both, i, near)).is_some_and(|r| r <= ROUGH)
            };
            if (0..points.len()).into_par_iter().all(keeps) {
                let rows = moved.rows(&fits);
                self.fits = Some(fits);
                return Ok(rows);
            }
        }
        let fits = Arc::new(bearing(points, way)?);
        let rows = Moved::new(&fits, points).rows(&fits);
        *self = Self {
            place: points.to_vec(),
            fits: Some(fits),
        };
        Ok(rows)
    }

    /// Puts into a checkpoint where they were made.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        checkpoint.put_f64("fits_place", self.place.as_flattened());
    }

    /// Takes back what [`Self::save`] put.
    ///
    /// # Errors
    /// Where the checkpoint lacks something.
    pub fn restore(checkpoint: &mut Checkpoint) -> artefact::Result<Self> {
        let place = checkpoint.f64("fits_place")?;
        Ok(Self {
            place: place.as_chunks::<D>().0.to_vec(),
            fits: None,
        })
    }
}
