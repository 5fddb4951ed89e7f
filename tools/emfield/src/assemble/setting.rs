//! What currents of a scene are computed with.

use run::Fault;

use crate::cloud::Cloud;
use crate::magnetic::diffusion::Conductors;
use crate::magnetic::driven::bar::Bar;
use crate::magnetic::driven::winding::Windings;
use crate::magnetic::medium::law::{Curve, Law};
use crate::magnetic::source::{MU0, Source};
use crate::magnetic::unknown::Unknown;
use crate::magnetic::waves::weights::Waves;
use crate::scene::{EddyCurrents, Medium, Scene};
use crate::stencils::region::Region;
use crate::stencils::sides::Sides;
use crate::surface::fits::Enclosed;

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
    /// Permeability by medium.
    pub(super) laws: Vec<Law>,
    /// Weights of points in integrals over conductors.
    pub(super) weights: Vec<f64>,
    /// What conductors carry in a sinusoidal steady state in a plane; none elsewhere.
    pub(super) waves: Option<Waves>,
    /// Currents that are given in coils of points, where there are some.
    pub(super) windings: Option<Windings>,
    /// Bars whose net current is given.
    pub(super) bars: Vec<Bar>,
    /// Surfaces around bodies.
    pub(super) enclosed: Vec<Enclosed<D>>,
}

/// How the field of each medium follows its flux density.
///
/// # Errors
/// Where a curve is none.
pub(super) fn laws(scene: &Scene) -> Result<Vec<Law>, Fault> {
    let law = |m: usize| {
        let rows = match m.checked_sub(1) {
            None => None,
            Some(k) => {
                let at = format!("/bodies/{k}/relative_permeability");
                scene.bodies[k].relative_permeability.rows(&at)?
            }
        };
        let curve = rows.and_then(Curve::new).map(Law::Curve);
        let constant = Law::Constant(MU0 * scene.medium(m).relative_permeability);
        Ok(curve.unwrap_or(constant))
    };
    (0..=scene.bodies.len()).map(law).collect()
}

/// A property of all media.
pub(super) fn media(scene: &Scene, of: impl Fn(Medium) -> f64) -> Vec<f64> {
    (0..=scene.bodies.len())
        .map(|m| of(scene.medium(m)))
        .collect()
}
