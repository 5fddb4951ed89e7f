//! What currents of a scene are computed with.

use crate::cloud::Cloud;
use crate::scene::{EddyCurrents, Medium, Scene};
use crate::solve::diffusion::Conductors;
use crate::solve::enclosed::Enclosed;
use crate::solve::region::Region;
use crate::solve::sides::Sides;
use crate::solve::unknown::Unknown;
use crate::solve::winding::Windings;
use crate::source::Source;

/// What currents of a scene in `D` coordinates are computed with.
pub(super) struct Setting<'a, const D: usize> {
    pub(super) scene: &'a Scene,
    pub(super) cloud: &'a Cloud,
    pub(super) currents: &'a EddyCurrents,
    /// Angular frequency \[rad/s\]; none in a march in time.
    pub(super) omega: Option<f64>,
    pub(super) unknown: Unknown,
    pub(super) source: Source,
    pub(super) region: Region<D>,
    pub(super) sides: Sides<D>,
    pub(super) conductors: Conductors,
    /// Weights of points in integrals over conductors.
    pub(super) weights: Vec<f64>,
    /// Currents that are given in coils of points, where there are some.
    pub(super) windings: Option<Windings>,
    /// Surfaces around bodies.
    pub(super) enclosed: Vec<Enclosed<D>>,
}

/// A property of all media.
pub(super) fn media(scene: &Scene, of: impl Fn(Medium) -> f64) -> Vec<f64> {
    (0..=scene.bodies.len())
        .map(|m| of(scene.medium(m)))
        .collect()
}
