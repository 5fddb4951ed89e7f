//! Faces through which heat leaves as if the plate went on (Komen 2019, section 4.3, eq. 4.12).
//!
//! Opposite to each neighbour b from which the way on, a spacing beyond a, leads out of the plate
//! stands an image of temperature 2 T_a - T_b, with the conductivity of that temperature.
//!
//! The image is never colder than the surroundings. Without this bound a face loses more than it
//! gains wherever the conductivity falls with temperature, and the more so the colder it gets: it
//! would run away to 0 K. All images of a particle together take heat and give none: where the plate is hotter the nearer
//! it comes to the face, as behind a torch that has left it, its continuation would be a source.

use shapes::frame::distance;

use super::caloric::Caloric;
use super::parameters::Parameters;
use crate::rest::{Link, Plane};

/// The open faces of the plate.
#[derive(Debug, Clone)]
pub(crate) struct Open {
    planes: Vec<Plane>,
    spacing: f64,
    /// Smaller differences of temperature \[K\] exchange no heat.
    tolerance: f64,
    /// T of the plate far away \[K\].
    surroundings: f64,
}

impl Open {
    pub(crate) fn new(planes: Vec<Plane>, spacing: f64, parameters: &Parameters) -> Self {
        let faces = parameters.faces.as_ref();
        Self {
            planes,
            spacing,
            tolerance: parameters.exchange_tolerance_k,
            surroundings: faces.map_or(0.0, |faces| faces.surroundings_k),
        }
    }

    /// True if there is such a face.
    pub(crate) fn any(&self) -> bool {
        !self.planes.is_empty()
    }

    /// Sum of weight, conductivity and temperature difference of particle `a` toward its images;
    /// `thermal` holds T and 1/k of each particle.
    pub(crate) fn lost(
        &self,
        position: &[[f64; 3]],
        thermal: &[[f64; 2]],
        row: &[Link],
        a: usize,
        caloric: &Caloric,
    ) -> f64 {
        let (at, d) = (position[a], self.spacing);
        let [temperature, resistivity] = thermal[a];
        let beyond = |plane: &Plane, x: f64| plane.outward * (x - plane.at) > 1e-9 * d;
        let over = |plane: &Plane| beyond(plane, at[plane.axis]);
        let beside = |plane: &Plane| beyond(plane, at[plane.axis] + plane.outward * d);
        // What has run over the edge of the plate is no part of it.
        if self.planes.iter().any(over) || !self.planes.iter().any(beside) {
            return 0.0;
        }
        let mut lost = 0.0;
        for link in row {
            let b = link.to as usize;
            let difference = thermal[b][0] - temperature;
            let (from, far) = (position[b], distance(at, position[b]));
            let onward = |k: usize| at[k] + d * (at[k] - from[k]) / far;
            let out = (self.planes.iter()).any(|plane| beyond(plane, onward(plane.axis)));
            if out && difference.abs() > self.tolerance {
                // An image colder than its particle takes heat, one warmer gives some.
                let image = (temperature - difference).max(self.surroundings.min(temperature));
                let resists = 1.0 / caloric.conductivity(image);
                lost += link.weight * 2.0 / (resistivity + resists) * (temperature - image);
            }
        }
        // Hotter metal farther in would be continued by a plate that is hotter still and heats: it only takes.
        lost.max(0.0)
    }
}
