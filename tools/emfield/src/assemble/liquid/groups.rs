//! From a scene to drops at their start.

use run::{Failure, Fault};
use shapes::Body;

use crate::liquid::groups::{Groups, Rule};
use crate::liquid::points::Liquid;
use crate::liquid::vector::spatial;
use crate::scene::{Groups as Given, Liquid as Part, Scene};

/// The drops of a scene, of its liquid at the start.
///
/// # Errors
/// Where a drop has too few points.
pub(crate) fn groups(scene: &Scene, part: &Part, liquid: &Liquid<3>) -> Result<Groups, Failure> {
    let (body, spacing) = (Body::new(&part.shape, 3), scene.points.spacing_m);
    let within = |x: &[f64; 3]| body.distance(spatial(x)) < 0.0;
    Groups::new(liquid, spacing, within).ok_or_else(|| {
        let what = format!("{spacing} m: a drop has too few points");
        vec![Fault::at("/points/spacing_m", what)].into()
    })
}

/// When they meet and part.
pub(crate) fn rule(given: &Given) -> Rule {
    Rule {
        join: given.join_within,
        part: given.part_below,
    }
}
